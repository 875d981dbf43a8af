// A displaced sphere of a million triangles from an include file; shadows on.
#version 3.7;
global_settings { assumed_gamma 1.0 }
camera { perspective location <0,0.8,-3.2> look_at <0,0,0> angle 45 right x*image_width/image_height up y }
light_source { <4,6,-5> color rgb 1 }
plane { y,-1.2 pigment { color rgb 0.7 } finish { ambient 0 diffuse 0.8 } }
#include "mesh.inc"
