#include "windlass/rod/kirchhoff_density.hpp"

#include "../bvp/collocation_arc.ipp"

template class windlass::bvp::CollocationArc<windlass::rod::KirchhoffDensity>;
