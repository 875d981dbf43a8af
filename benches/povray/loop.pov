// 10⁶ turns of a loop of arithmetic; no object.
#version 3.7;
global_settings { assumed_gamma 1.0 }
camera { location <0,0,-5> look_at 0 }
#ifndef (N) #declare N = 1000000; #end
#local S = 0;
#for (I, 1, N)
  #local S = S + sin(I*0.001)*0.5 + sqrt(I)/(I+1);
#end
