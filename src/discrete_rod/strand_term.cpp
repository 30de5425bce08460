#include "windlass/discrete_rod/strand_term.hpp"

#include "thick_sum.hpp"

namespace windlass::discrete_rod {

StrandDistance strand_distance(const SplineRod::Controls& here, double t, const SplineRod::Controls& there,
                               double foot, double distance) {
  using Eigen::Vector3d;
  using Vector24 = Eigen::Matrix<double, 24, 1>;
  using Shape24 = Eigen::Matrix<double, 3, 24>;
  const Vector3d gap = here * cubic_weights(t, 0) - there * cubic_weights(foot, 0),
                 slope = there * cubic_weights(foot, 1), bend = there * cubic_weights(foot, 2);
  Shape24 apart, turn = Shape24::Zero();  // of the gap, and of its derivative along the other strand
  apart << shape(t, 0), -shape(foot, 0);
  turn.rightCols<12>() = -shape(foot, 1);
  // f = ½ d² has its minimum over the other's place: f_cc − f_cσ f_σc/f_σσ is its second derivative.
  const Vector24 mixed = turn.transpose() * gap - apart.transpose() * slope;
  StrandDistance out;
  out.slope = apart.transpose() * gap / distance;
  out.curvature =
      (apart.transpose() * apart - mixed * mixed.transpose() / (slope.squaredNorm() - gap.dot(bend)) -
       out.slope * out.slope.transpose()) /
      distance;
  return out;
}

}  // namespace windlass::discrete_rod
