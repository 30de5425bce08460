#include "/work/main/src/bvp/collocation_arc.ipp"
#include "windlass/rod/kirchhoff_density.hpp"
