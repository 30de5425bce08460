#include "../bvp/collocation_arc.ipp"
#include "windlass/rod/quaternion.hpp"

template class windlass::bvp::CollocationArc<windlass::rod::UnitQuaternions, 3>;
