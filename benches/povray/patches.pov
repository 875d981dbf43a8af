// 64 bicubic patches that share seams: one uniform B-spline surface over an 11 × 11 net, each converted to Bézier points.
// Type 1, with enough steps that its triangles are as true as a quarter pixel of a picture 1024 wide: each patch is 1 long, bends by at most
// 2.6 per unit, and 16 steps leave (1/16)² · 2.6 / 8 = 0.0013, where a pixel is 0.0077.
#version 3.7;
global_settings { assumed_gamma 1.0 }
camera { perspective location <0, 4.5, -8> look_at <0, -0.3, 0> angle 50 right x*image_width/image_height up y }
background { color rgb <0.3, 0.4, 0.6> }
light_source { <6, 7, -4> color rgb 1 }
plane { y, -1.5 pigment { color rgb 0.5 } finish { ambient 0 diffuse 0.7 } }
#macro Net(I, J) <(I) - 5, 0.9 * sin(1.3 * (I) + 0.4) * cos(1.1 * (J)), (J) - 5> #end
#declare BW = array[4][4] { {1/6, 4/6, 1/6, 0}, {0, 4/6, 2/6, 0}, {0, 2/6, 4/6, 0}, {0, 1/6, 4/6, 1/6} };
#macro Ctl(A, B, U, V)
  #local S = <0, 0, 0>;
  #for (P, 0, 3) #for (Q, 0, 3)
    #if (BW[U][P] * BW[V][Q] != 0) #local S = S + BW[U][P] * BW[V][Q] * Net(A + P, B + Q); #end
  #end #end
  S
#end
union {
#for (A, 0, 7) #for (B, 0, 7)
  bicubic_patch { type 1 flatness 0 u_steps 4 v_steps 4
    #for (U, 0, 3) #for (V, 0, 3)
      Ctl(A, B, U, V) #if (U * 4 + V < 15) , #end
    #end #end
  }
#end #end
  texture { pigment { color rgb <0.85, 0.75, 0.5> } finish { ambient 0.05 diffuse 0.75 specular 0.5 roughness 0.02 } }
}
