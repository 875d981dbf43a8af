// 10⁶ calls of a macro of two arguments that gives a number.
#version 3.7;
global_settings { assumed_gamma 1.0 }
camera { location <0,0,-5> look_at 0 }
#macro Acc(A, B)
  (A*0.5 + B)
#end
#local S = 0;
#for (I, 1, 1000000)
  #local S = Acc(S, I);
#end
#debug concat("S = ", str(S,0,9), "\n")
