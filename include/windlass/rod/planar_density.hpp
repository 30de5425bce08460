#pragma once

#include <Eigen/Dense>
#include <cmath>

#include "windlass/bvp/lagrangian.hpp"

namespace windlass::rod {

/// Planar elastica under end loads only:  L(θ, θ', n) = ½ EI (θ' − κ̂)² − n·(cos θ, sin θ).
///
/// θ is the angle of the tangent to e_x [rad]; n the internal force in the plane [EI/ρ²], constant on the arc.
/// Stationarity gives θ' = κ̂ + m/EI, m' = n_x sin θ − n_y cos θ (PHYSICS, planar elastica).
struct PlanarDensity {
  using Configuration = bvp::Coordinates<1>;
  static constexpr int ambient = 1, forces = 2;
  using Scalar = Eigen::Matrix<double, 1, 1>;

  double bending_stiffness = 1.0;
  double natural_curvature = 0.0;  ///< κ̂ [1/ρ]

  Eigen::Vector2d direction(const Scalar& q) const { return {std::cos(q(0)), std::sin(q(0))}; }
  double elastic(const Scalar&, const Scalar& slope) const {
    const double strain = slope(0) - natural_curvature;
    return 0.5 * bending_stiffness * strain * strain;
  }
  double first(const Scalar& q, const Scalar& slope, const Eigen::Vector2d& n, Eigen::Vector2d& gz,
               Eigen::Vector2d& d) const {
    d = direction(q);
    gz << n(0) * d(1) - n(1) * d(0), bending_stiffness * (slope(0) - natural_curvature);
    return elastic(q, slope) - n.dot(d);
  }
  void second(const Scalar& q, const Scalar& slope, const Eigen::Vector2d& n, Eigen::Vector2d& gz,
              Eigen::Matrix2d& hz, Eigen::Vector2d& d, Eigen::Matrix<double, 2, 1>& dd) const {
    first(q, slope, n, gz, d);
    hz << n.dot(d), 0.0, 0.0, bending_stiffness;
    dd << -d(1), d(0);
  }
};

}  // namespace windlass::rod

extern template class windlass::bvp::LagrangianOf<windlass::rod::PlanarDensity>;
