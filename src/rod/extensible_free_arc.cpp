#include "../bvp/collocation_arc.ipp"
#include "windlass/rod/extensible_density.hpp"

template class windlass::bvp::CollocationArc<windlass::rod::Extensible<windlass::rod::PlanarDensity>>;
template class windlass::bvp::CollocationArc<windlass::rod::Extensible<windlass::rod::KirchhoffDensity>>;
