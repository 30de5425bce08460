#include "collocation_arc.ipp"

template class windlass::bvp::CollocationArc<windlass::bvp::Coordinates<1>, 2>;
template class windlass::bvp::CollocationArc<windlass::bvp::Coordinates<2>, 2>;
