#include "windlass/pull/friction.hpp"

#include "windlass/pull/rounded.hpp"

namespace windlass::pull {

using Eigen::Matrix2d;
using Eigen::Vector2d;

Coulomb::Traction Coulomb::operator()(const Vector2d& g) const {
  const double size = g.norm(), x = size / slip;
  if (x <= 1.0 - corner) return {-friction / slip * g, -friction / slip * Matrix2d::Identity(), true};
  const auto [short_of, slope] = rounded(1.0 - x, corner);
  const double part = 1.0 - short_of;
  const Vector2d along = g / size;
  const Matrix2d both = along * along.transpose();
  return {-friction * part * along,
          -friction * (slope / slip * both + part / size * (Matrix2d::Identity() - both)), x < 1.0 + corner};
}

Vector2d Coulomb::kept(const Vector2d& g) const {
  const double size = g.norm(), most = (1.0 + corner) * slip;
  return size <= most ? g : Vector2d(most / size * g);
}

}  // namespace windlass::pull
