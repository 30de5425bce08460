#include "windlass/pull/friction.hpp"

namespace windlass::pull {

using Eigen::Matrix2d;
using Eigen::Vector2d;

Coulomb::Traction Coulomb::operator()(const Vector2d& g) const {
  const double size = g.norm();
  if (size <= slip) return {-friction / slip * g, -friction / slip * Matrix2d::Identity(), true};
  const Vector2d along = g / size;
  return {-friction * along, -friction / size * (Matrix2d::Identity() - along * along.transpose()), false};
}

Vector2d Coulomb::kept(const Vector2d& g) const {
  const double size = g.norm();
  return size <= slip ? g : Vector2d(slip / size * g);
}

}  // namespace windlass::pull
