// The Cornell box by radiosity, inside [-1, 1]^3, open in front. The lamp is a surface that shines; there is no light_source, so that all light is gathered.
// Declare=Q=0: radiosity {} as it comes; Q=1: medium; Q=2: high.
#version 3.7;
#ifndef (Q) #declare Q = 0; #end
global_settings { assumed_gamma 1.0
#if (Q = 0) radiosity { } #end
#if (Q = 1) radiosity { pretrace_start 0.08 pretrace_end 0.01 count 200 nearest_count 10 error_bound 0.5 recursion_limit 3
   low_error_factor 0.5 minimum_reuse 0.01 maximum_reuse 0.2 brightness 1 adc_bailout 0.005 always_sample off } #end
#if (Q = 2) radiosity { pretrace_start 0.08 pretrace_end 0.004 count 800 nearest_count 15 error_bound 0.25 recursion_limit 4
   low_error_factor 0.5 gray_threshold 0 minimum_reuse 0.003 maximum_reuse 0.15 brightness 1 adc_bailout 0.005 always_sample off } #end
}
camera { perspective location <0,0,-3.8> look_at <0,0,0> angle 39.3 right x*image_width/image_height up y }
#macro M(C) texture { pigment { color rgb C } finish { ambient 0 diffuse 1 } } #end
#declare E = 0.01;
box { <-1-E,-1-E,-1>,<1+E,-1,1> M(0.75) }
box { <-1-E,1,-1>,<1+E,1+E,1> M(0.75) }
box { <-1-E,-1-E,1>,<1+E,1+E,1+E> M(0.75) }
box { <-1-E,-1,-1>,<-1,1,1> M(<0.63,0.065,0.05>) }
box { <1,-1,-1>,<1+E,1,1> M(<0.14,0.45,0.091>) }
box { <-0.3,0,-0.3>,<0.3,0.6,0.3> rotate y*17 translate <0.33,-1,-0.35> M(0.75) }
box { <-0.3,0,-0.3>,<0.3,1.2,0.3> rotate y*-18 translate <-0.33,-1,0.3> M(0.75) }
polygon { 5, <-0.25,0.998,-0.25>,<0.25,0.998,-0.25>,<0.25,0.998,0.25>,<-0.25,0.998,0.25>,<-0.25,0.998,-0.25>
  texture { pigment { color rgb 1 } finish { ambient 0 diffuse 0 emission 15 } } no_shadow }
