// A glass ball over a floor under a point of light. Declare=SP=0.02: the spacing of its photons.
// The light falls off by the square of the distance, 2/(1 + (d/0.1)^2), and is 1.2 where it is 7 away, at the world's origin.
#version 3.7;
#ifndef (SP) #declare SP = 0.02; #end
global_settings { assumed_gamma 1.0 max_trace_level 8 photons { spacing SP } }
camera { perspective location <0,3.5,-6> look_at <0,0.5,0> angle 45 right x*image_width/image_height up y }
background { color rgb <0.1,0.12,0.2> }
light_source { <3,6,-2> color rgb 1.2*49*50 fade_distance 0.1 fade_power 2 photons { refraction on reflection on } }
plane { y,0 pigment { color rgb 0.8 } finish { ambient 0 diffuse 0.8 } photons { collect on } }
sphere { <0,1.2,0>,1 pigment { color rgbf 1 } finish { ambient 0 diffuse 0 reflection { 0,1 fresnel on } conserve_energy } interior { ior 1.5 }
  photons { target refraction on reflection on collect off } }
