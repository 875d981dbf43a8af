// Sphereflake by a recursive macro: Declare=D=5 gives 66,430 mirrors.
#version 3.7;
global_settings { assumed_gamma 1.0 max_trace_level 5 adc_bailout 0 }
camera { perspective location <2.6,2.2,-3.8> look_at <0,0.1,0> angle 40 right x*image_width/image_height up y }
light_source { <4,6,-3> color rgb 1 }
background { color rgb <0.078,0.361,0.753> }
plane { y,-1 pigment { color rgb <1,0.75,0.33> } finish { ambient 0 diffuse 0.75 } }
#ifndef (D) #declare D = 4; #end
#declare Tex = texture { pigment { color rgb <1,0.9,0.7> } finish { ambient 0 diffuse 0.5 reflection 0.5 } }
#macro Flake(C, R, A, T, Lev)
  sphere { C, R texture { Tex } }
  #if (Lev > 0)
    #local B = vcross(A, T);
    #for (K, 0, 8)
      #if (K < 6) #local EL = 0; #local AZ = radians(K*60); #else #local EL = radians(55); #local AZ = radians(30+(K-6)*120); #end
      #local Dir = cos(EL)*(cos(AZ)*T + sin(AZ)*B) + sin(EL)*A;
      Flake(C + Dir*R*4/3, R/3, Dir, vnormalize(vcross(Dir, A)), Lev-1)
    #end
  #end
#end
Flake(<0,0,0>, 1, y, x, D)
