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

ArcSamples PlanarLineArc::sample(const ArcPoint& at) const {
  constexpr int count = 33;
  ArcSamples out{Eigen::VectorXd::LinSpaced(count, 0.0, 1.0),
                 Eigen::MatrixXd(0, count),
                 Eigen::MatrixXd(0, count),
                 Eigen::MatrixXd(1, count),
                 {}};
  out.displacement.row(0) = at.length * out.sigma.transpose();
  for (int i = 0; i < count; ++i) out.nodes.push_back(i);
  return out;
}

}  // namespace windlass::rod
