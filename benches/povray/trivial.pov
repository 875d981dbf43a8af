// One sphere, a plane and a point light: start-up cost.
#version 3.7;
global_settings { assumed_gamma 1.0 }
camera { perspective location <0,1,-5> look_at <0,0,0> angle 50 right x*image_width/image_height up y }
light_source { <5,10,-5> color rgb 1 }
plane  { y,-1 pigment { color rgb 0.8 } finish { ambient 0 diffuse 0.8 } }
sphere { 0,1  pigment { color rgb <0.8,0.2,0.2> } finish { ambient 0 diffuse 0.8 } }
