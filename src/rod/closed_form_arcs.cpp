#include "windlass/rod/closed_form_arcs.hpp"

#include <cmath>

namespace windlass::rod {

using bvp::ArcPoint;
using bvp::ArcSamples;
using bvp::EndsMatrix;
using bvp::EndsVector;

void PlanarLineArc::gradient(const ArcPoint& at, double*, EndsVector& ends) const {
  ends.resize(2);
  ends << -at.length, 0.5 * stiffness_ * strain_ * strain_ - at.n[0];
}

void PlanarLineArc::factor(const ArcPoint&, EndsMatrix& condensed) {
  condensed.resize(2, 2);
  condensed << 0.0, -1.0, -1.0, 0.0;
}

void PlanarLineArc::hessian(const ArcPoint&, std::vector<Eigen::Triplet<double>>& entries) const {
  entries.emplace_back(0, 1, -1.0);
  entries.emplace_back(1, 0, -1.0);
}

Eigen::VectorXd PlanarLineArc::metric(const ArcPoint&) const { return Eigen::VectorXd::Zero(2); }

namespace {

/// Round the unit circle, by this much an arclength.
ArcSamples round_circle(double rate, double length) {
  constexpr int count = 33;
  ArcSamples out{Eigen::VectorXd::LinSpaced(count, 0.0, 1.0),
                 Eigen::MatrixXd(0, count),
                 Eigen::MatrixXd(0, count),
                 Eigen::MatrixXd(1, count),
                 {}};
  out.displacement.row(0) = rate * length * out.sigma.transpose();
  for (int i = 0; i < count; ++i) out.nodes.push_back(i);
  return out;
}

}  // namespace

ArcSamples PlanarLineArc::sample(const ArcPoint& at) const { return round_circle(1.0, at.length); }

void ExtensiblePlanarLineArc::gradient(const ArcPoint& at, double*, EndsVector& ends) const {
  const double k = at.compliance, b = stiffness_, force = at.n[0] + b * natural_;
  ends.resize(2);
  ends << -at.length * stretch_on_circle(b, natural_, at.n[0], k),
      0.5 * b * natural_ * natural_ + 0.5 * (b - 2.0 * force - k * force * force) / (1.0 + k * b);
}

void ExtensiblePlanarLineArc::factor(const ArcPoint& at, EndsMatrix& condensed) {
  const double stretch = stretch_on_circle(stiffness_, natural_, at.n[0], at.compliance);
  condensed.resize(2, 2);
  condensed << -at.length * at.compliance / (1.0 + at.compliance * stiffness_), -stretch, -stretch, 0.0;
}

void ExtensiblePlanarLineArc::hessian(const ArcPoint& at,
                                      std::vector<Eigen::Triplet<double>>& entries) const {
  const double stretch = stretch_on_circle(stiffness_, natural_, at.n[0], at.compliance);
  entries.emplace_back(0, 0, -at.length * at.compliance / (1.0 + at.compliance * stiffness_));
  entries.emplace_back(0, 1, -stretch);
  entries.emplace_back(1, 0, -stretch);
}

ArcSamples ExtensiblePlanarLineArc::sample(const ArcPoint& at) const {
  return round_circle(stretch_on_circle(stiffness_, natural_, at.n[0], at.compliance), at.length);
}

double ExtensiblePlanarLineArc::energy(const ArcPoint& at) const {
  const double k = at.compliance, b = stiffness_, stretch = stretch_on_circle(b, natural_, at.n[0], k),
               tension = (at.n[0] + b * (natural_ - 1.0)) / (1.0 + k * b);
  return at.length * (0.5 * b * (stretch - natural_) * (stretch - natural_) + 0.5 * k * tension * tension);
}

}  // namespace windlass::rod
