// Declare=N=… spheres made in a loop on low-discrepancy points, each with a colour of its own.
#version 3.7;
global_settings { assumed_gamma 1.0 }
camera { perspective location <0,0,-28> look_at <0,0,0> angle 45 right x*image_width/image_height up y }
light_source { <20,30,-30> color rgb 1 }
#ifndef (N) #declare N = 100000; #end
#local R = 20/pow(N,1/3)*0.25;
#for (I, 1, N)
  #local FX = mod(I*0.7548776662466927,1);
  #local FY = mod(I*0.5698402909980532,1);
  #local FZ = mod(I*0.4301597090019468,1);
  sphere { <FX*20-10,FY*20-10,FZ*20-10>, R pigment { color rgb <FX,FY,FZ> } finish { ambient 0 diffuse 0.8 } }
#end
