// 10⁶ evaluations of a spline through ten points, as in curve.scene.
#version 3.7;
global_settings { assumed_gamma 1.0 }
camera { location <0,0,-5> look_at <0,0,0> }
#ifndef (T) #declare T = 3; #end
#declare Sp = spline { #switch (T) #case (0) linear_spline #break #case (1) quadratic_spline #break #case (2) cubic_spline #break #else natural_spline #end
  #for (K,0,9) K, <K, sin(K*1.3), cos(K*0.7)>, #end }
#local S = <0,0,0>;
#for (I, 1, 1000000)
  #local S = S + Sp(mod(I*0.000009,9));
#end
#debug concat("S = ", vstr(3,S,",",0,6), "\n")
