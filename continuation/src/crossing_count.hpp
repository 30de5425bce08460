#pragma once

#include "continuation/segment.hpp"

namespace continuation {

/// Eigenvalues that crossed the imaginary axis between two samples, net.
struct CrossingCount {
  int real = 0;  ///< through zero, without sign; −1: unknown
  int hopf = 0;  ///< complex pairs
};

/// Real zeros z, pairs through the imaginary axis h and pairs of negative real part that turned complex, c, obey
/// Δreal = z − 2c, Δcomplex = 2h + 2c: the least eventful solution is taken.
CrossingCount count_between(const Sample& lo, const Sample& hi);

}  // namespace continuation
