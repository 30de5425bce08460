#include "windlass/rod/plane_density.hpp"

#include "../bvp/collocation_arc.ipp"

template class windlass::bvp::CollocationArc<windlass::rod::PlaneDensity>;
