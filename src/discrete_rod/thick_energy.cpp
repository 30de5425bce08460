#include "windlass/discrete_rod/thick_energy.hpp"

#include <cmath>

#include "thick_sum.hpp"
#include "windlass/discrete_rod/bending_density.hpp"

namespace windlass::discrete_rod {

using Eigen::Matrix3d;
using Eigen::Vector3d;

ThickEnergy::ThickEnergy(const SplineRod& rod, double tension, double angle, double radius)
    : rod_(rod),
      radius_(radius),
      pull_(tension * Vector3d(std::cos(0.5 * angle), std::sin(0.5 * angle), 0.0)) {
  penalties.tension.assign(static_cast<std::size_t>(rod.elements()), tension);
}

void ThickEnergy::add_bending(const Vector& x, Sum& sum) const {
  for (int e = 0; e < rod_.elements(); ++e) {
    const SplineRod::Controls controls = rod_.controls(x, e);
    const Local local({e});
    for (int q = 0; q < Quadrature::points; ++q) {
      const double t = Quadrature::place[q], weight = Quadrature::weight[q];
      const BendingDensity density(controls * cubic_weights(t, 1), controls * cubic_weights(t, 2));
      sum.value += weight * density.value;
      if (!sum.derivatives) continue;
      Eigen::Matrix<double, 6, 12> both;
      both << shape(t, 1), shape(t, 2);
      const Eigen::Matrix<double, 12, 1> gradient = weight * both.transpose() * density.gradient;
      const Eigen::Matrix<double, 12, 12> hessian = weight * both.transpose() * density.hessian * both;
      local.add(gradient, hessian, sum);
    }
  }
}

double ThickEnergy::element_length(const Vector& x, int element) const {
  const SplineRod::Controls controls = rod_.controls(x, element);
  double length = 0.0;
  for (int q = 0; q < Quadrature::points; ++q)
    length += Quadrature::weight[q] * (controls * cubic_weights(Quadrature::place[q], 1)).norm();
  return length;
}

void ThickEnergy::add_lengths(const Vector& x, Sum& sum) const {
  for (int e = 0; e < rod_.elements(); ++e) {
    const double rest = rod_.length(e), excess = element_length(x, e) - rest,
                 multiplier = penalties.tension[static_cast<std::size_t>(e)];
    sum.value += multiplier * excess + 0.5 * penalties.stretching * excess * excess / rest;
    if (!sum.derivatives) continue;
    const SplineRod::Controls controls = rod_.controls(x, e);
    Eigen::Matrix<double, 12, 1> slope = Eigen::Matrix<double, 12, 1>::Zero();
    Eigen::Matrix<double, 12, 12> curvature = Eigen::Matrix<double, 12, 12>::Zero();
    for (int q = 0; q < Quadrature::points; ++q) {
      const Vector3d along = controls * cubic_weights(Quadrature::place[q], 1);
      const double norm = along.norm();
      const Vector3d t = along / norm;
      const Shape first = shape(Quadrature::place[q], 1);
      slope += Quadrature::weight[q] * first.transpose() * t;
      curvature += Quadrature::weight[q] / norm * first.transpose() *
                   (Matrix3d::Identity() - t * t.transpose()) * first;
    }
    const double force = multiplier + penalties.stretching * excess / rest;
    const Eigen::Matrix<double, 12, 12> hessian =
        penalties.stretching / rest * slope * slope.transpose() + force * curvature;
    Local({e}).add(Eigen::Matrix<double, 12, 1>(force * slope), hessian, sum);
  }
}

/// The pull, and what holds the last control point: a free end is straight, at no cost.
void ThickEnergy::add_end(const Vector& x, Sum& sum) const {
  const int last = rod_.elements() - 1;
  const SplineRod::Controls controls = rod_.controls(x, last);
  const double stiffness = 1.0 / std::pow(rod_.length(last), 3);
  const Vector3d bend = controls * cubic_weights(1.0, 2);
  sum.value += 0.5 * stiffness * bend.squaredNorm() - pull_.dot(controls * cubic_weights(1.0, 0));
  if (!sum.derivatives) return;
  const Shape end = shape(1.0, 0), second = shape(1.0, 2);
  const Eigen::Matrix<double, 12, 1> gradient =
      stiffness * second.transpose() * bend - end.transpose() * pull_;
  const Eigen::Matrix<double, 12, 12> hessian = stiffness * second.transpose() * second;
  Local({last}).add(gradient, hessian, sum);
}

void ThickEnergy::add_mid_point(const Vector& x, Sum& sum) const {
  const Eigen::Index y = SplineRod::place(0, 1).index;
  sum.value += 0.5 * penalties.mid_point * x(y) * x(y);
  if (!sum.derivatives) return;
  sum.gradient(y) += penalties.mid_point * x(y);
  sum.entries.emplace_back(y, y, penalties.mid_point);
}

ThickEnergy::Sum ThickEnergy::evaluate(const Vector& x, bool derivatives) const {
  Sum sum;
  sum.derivatives = derivatives;
  if (derivatives) {
    sum.gradient = Vector::Zero(size());
    sum.entries.reserve(1400 * static_cast<std::size_t>(rod_.elements()));
  }
  add_bending(x, sum);
  add_lengths(x, sum);
  add_end(x, sum);
  add_mid_point(x, sum);
  add_cylinder(x, sum);
  add_strands(x, sum);
  return sum;
}

double ThickEnergy::value(const Vector& x) const { return evaluate(x, false).value; }

ThickEnergy::Vector ThickEnergy::gradient(const Vector& x) const { return evaluate(x, true).gradient; }

ThickEnergy::Sparse ThickEnergy::hessian(const Vector& x) const {
  const Sum sum = evaluate(x, true);
  Sparse out(size(), size());
  out.setFromTriplets(sum.entries.begin(), sum.entries.end());
  return out;
}

double ThickEnergy::bending(const Vector& x) const {
  Sum sum;
  add_bending(x, sum);
  return 2.0 * sum.value;
}

double ThickEnergy::stretch(const Vector& x) const {
  double most = 0.0;
  for (int e = 0; e < rod_.elements(); ++e)
    most = std::max(most, std::abs(element_length(x, e) / rod_.length(e) - 1.0));
  return most;
}

void ThickEnergy::raise_tension(const Vector& x) {
  for (int e = 0; e < rod_.elements(); ++e)
    penalties.tension[static_cast<std::size_t>(e)] +=
        penalties.stretching * (element_length(x, e) / rod_.length(e) - 1.0);
}

}  // namespace windlass::discrete_rod
