#include <algorithm>
#include <cmath>

#include "thick_sum.hpp"
#include "windlass/discrete_rod/strand_term.hpp"

namespace windlass::discrete_rod {

using Eigen::Matrix3d;
using Eigen::Vector3d;

void ThickEnergy::add_cylinder(const Vector& x, Sum& sum) const {
  if (penalties.cylinder <= 0.0) return;
  for (int e = 0; e < rod_.elements(); ++e) {
    const SplineRod::Controls controls = rod_.controls(x, e);
    for (int q = 0; q < Quadrature::points; ++q) {
      const double t = Quadrature::place[q],
                   weight = Quadrature::weight[q] * rod_.length(e) * penalties.cylinder;
      Vector3d out = controls * cubic_weights(t, 0);
      out(2) = 0.0;
      const double distance = out.norm(), depth = 1.0 - distance;
      if (depth <= 0.0) continue;
      sum.value += 0.5 * weight * depth * depth;
      if (!sum.derivatives) continue;
      out /= distance;
      Matrix3d round = -out * out.transpose();
      round(0, 0) += 1.0, round(1, 1) += 1.0;
      const Shape place = shape(t, 0);
      const Eigen::Matrix<double, 12, 1> gradient = -weight * depth * place.transpose() * out;
      const Eigen::Matrix<double, 12, 12> hessian =
          weight * place.transpose() * (out * out.transpose() - depth / distance * round) * place;
      Local({e}).add(gradient, hessian, sum);
    }
  }
}

std::vector<StrandPair> ThickEnergy::touching(const Vector& x) const {
  return strand_pairs(rod_, x, 2.0 * radius_ + penalties.strand_shift, M_PI * radius_);
}

void ThickEnergy::add_strands(const Vector& x, Sum& sum) const {
  if (penalties.strands <= 0.0) return;
  using Vector24 = Eigen::Matrix<double, 24, 1>;
  for (const StrandPair& pair : touching(x)) {
    const double d = pair.distance, depth = 2.0 * radius_ + penalties.strand_shift - d,
                 weight = 0.5 * pair.weight * penalties.strands;
    sum.value += 0.5 * weight * depth * depth;
    if (!sum.derivatives) continue;
    const StrandDistance of = discrete_rod::strand_distance(rod_.controls(x, pair.element), pair.t,
                                                            rod_.controls(x, pair.other), pair.other_t, d);
    const Eigen::Matrix<double, 24, 24> hessian =
        weight * (of.slope * of.slope.transpose() - depth * of.curvature);
    Local({pair.element, pair.other}).add(Vector24(-weight * depth * of.slope), hessian, sum);
  }
}

bool ThickEnergy::strands_pass(const Vector& from, const Vector& to) const {
  double way = std::abs(to(0) - from(0));  // of the control point that goes farthest, and so of any place
  for (Eigen::Index k = 1; k + 2 < size(); k += 3)
    way = std::max(way, (to.segment<3>(k) - from.segment<3>(k)).norm());
  constexpr double long_way = 0.5;
  if (way > long_way) return true;
  // Nearest places of two strands, taken along: they have passed where the one lies on the other's other side.
  const auto gap = [&](const Vector& x, const StrandPair& pair) {
    return Vector3d(rod_.position(x, pair.element, pair.t) - rod_.position(x, pair.other, pair.other_t));
  };
  const std::vector<StrandPair> near = strand_pairs(rod_, from, 2.0 * way, M_PI * radius_);
  return std::any_of(near.begin(), near.end(),
                     [&](const StrandPair& pair) { return gap(from, pair).dot(gap(to, pair)) < 0.0; });
}

double ThickEnergy::cylinder_force(const Vector& x) const {
  double force = 0.0;
  for (int e = 0; e < rod_.elements(); ++e)
    for (int q = 0; q < Quadrature::points; ++q) {
      const double distance = rod_.position(x, e, Quadrature::place[q]).head<2>().norm();
      force +=
          2.0 * Quadrature::weight[q] * rod_.length(e) * penalties.cylinder * std::max(0.0, 1.0 - distance);
    }
  return force;
}

double ThickEnergy::strand_force(const Vector& x) const {
  double force = 0.0;  // each half sees every touch once: half of the rod, but from both strands
  for (const StrandPair& pair : touching(x))
    force += pair.weight * penalties.strands * (2.0 * radius_ + penalties.strand_shift - pair.distance);
  return force;
}

double ThickEnergy::strand_distance(const Vector& x) const {
  double least = 2.0 * radius_ + penalties.strand_shift;
  for (const StrandPair& pair : touching(x)) least = std::min(least, pair.distance);
  return least;
}

}  // namespace windlass::discrete_rod
