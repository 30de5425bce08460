#include "windlass/rod/surface_density.hpp"

#include "../bvp/collocation_arc.ipp"

template class windlass::bvp::CollocationArc<windlass::rod::SurfaceDensity>;
