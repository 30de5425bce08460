#include "windlass/rod/plate_line_arc.hpp"

#include <cmath>

namespace windlass::rod {

using bvp::ArcPoint;

double PlateLineArc::growth(const ArcPoint& at) {
  return at.friction * at.travel / std::sqrt(1.0 + at.travel * at.travel);
}

PlateLineArc::Stretched PlateLineArc::stretched(const ArcPoint& at) const {
  const double k = at.compliance, n = at.n[0], b = bending_, soft = k / (1.0 + k * b);
  const double stretch = (1.0 + k * n) / (1.0 + k * b), around = n - b * stretch;
  Stretched out{stretch, soft, around, 0.5 * (b - 2.0 * n - k * n * n) / (1.0 + k * b), 0.0, 0.0};
  out.drag = at.friction * stretch * stretch * around;
  out.drag_by_n = at.friction * stretch * (2.0 * soft * around + stretch * (1.0 - b * soft));
  return out;
}

void PlateLineArc::gradient(const ArcPoint& at, double*, bvp::EndsVector& ends) const {
  const double turn = (at.q_b[0] - at.q_a[0]) / at.length, pressure = at.n[0] - bending_;
  ends.setZero(this->ends());
  if (at.compliance != 0.0) {
    const Stretched by = stretched(at);
    ends << -twisting_ * turn, twisting_ * turn, -by.stretch * at.length,
        by.action - 0.5 * twisting_ * turn * turn, at.travel * by.drag * at.length;
    return;
  }
  ends << -twisting_ * turn, twisting_ * turn, -at.length,
      0.5 * bending_ - 0.5 * twisting_ * turn * turn - at.n[0], pressure * std::expm1(growth(at) * at.length);
}

bvp::EndsMatrix PlateLineArc::matrix(const ArcPoint& at) const {
  const double c = twisting_ / at.length, turn = (at.q_b[0] - at.q_a[0]) / at.length;
  const double lambda = growth(at), pressure = at.n[0] - bending_, size = 1.0 + at.travel * at.travel;
  const double grown = std::exp(lambda * at.length), by_travel = at.friction / (size * std::sqrt(size));
  bvp::EndsMatrix h = bvp::EndsMatrix::Zero(ends(), ends());
  h.topLeftCorner(2, 2) << c, -c, -c, c;
  h(0, 3) = h(3, 0) = c * turn;
  h(1, 3) = h(3, 1) = -c * turn;
  h(3, 3) = c * turn * turn;
  if (at.compliance != 0.0) {
    const Stretched by = stretched(at);
    h(2, 2) = -by.soft * at.length;
    h(2, 3) = h(3, 2) = -by.stretch;
    h(4, 2) = at.travel * by.drag_by_n * at.length;
    h(4, 3) = at.travel * by.drag;
    h(4, 4) = by.drag * at.length;
    return h;
  }
  h(2, 3) = h(3, 2) = -1.0;
  h(4, 2) = grown - 1.0;
  h(4, 3) = pressure * lambda * grown;
  h(4, 4) = pressure * grown * at.length * by_travel;  // with ω
  return h;
}

void PlateLineArc::hessian(const ArcPoint& at, std::vector<Eigen::Triplet<double>>& entries) const {
  const bvp::EndsMatrix h = matrix(at);
  for (int i = 0; i < h.rows(); ++i)
    for (int j = 0; j < h.cols(); ++j)
      if (h(i, j) != 0.0) entries.emplace_back(i, j, h(i, j));
}

Eigen::VectorXd PlateLineArc::metric(const ArcPoint& at) const {
  Eigen::VectorXd mass = Eigen::VectorXd::Zero(ends());
  mass.head(2).setConstant(0.5 * at.length);
  return mass;
}

bvp::ArcSamples PlateLineArc::sample(const ArcPoint& at) const {
  constexpr int count = 33;
  const double turn = (at.q_b[0] - at.q_a[0]) / at.length, pressure = at.n[0] - bending_;
  bvp::ArcSamples out;
  out.sigma = Eigen::VectorXd::LinSpaced(count, 0.0, 1.0);
  out.q = out.momentum = out.displacement = out.force = Eigen::MatrixXd::Zero(2, count);
  out.q.row(1) = at.q_a[0] + (at.q_b[0] - at.q_a[0]) * out.sigma.transpose().array();
  out.momentum.row(1).setConstant(twisting_ * turn);
  out.displacement.row(0) = at.length * out.sigma.transpose();
  out.force.row(0) = bending_ + pressure * (growth(at) * at.length * out.sigma.transpose().array()).exp();
  out.force.row(1).setConstant(twisting_ * turn);
  if (at.compliance != 0.0) {
    const Stretched by = stretched(at);
    out.displacement.row(0) *= by.stretch;
    out.force.row(0) = at.n[0] + at.travel * by.drag * at.length * out.sigma.transpose().array();
  }
  for (int i = 0; i < count; ++i) out.nodes.push_back(i);
  return out;
}

double PlateLineArc::energy(const ArcPoint& at) const {
  const double turn = (at.q_b[0] - at.q_a[0]) / at.length;
  if (at.compliance != 0.0) {
    const Stretched by = stretched(at);
    return 0.5 * at.length *
           (bending_ * by.stretch * by.stretch + at.compliance * by.around * by.around +
            twisting_ * turn * turn);
  }
  return 0.5 * at.length * (bending_ + twisting_ * turn * turn);
}

}  // namespace windlass::rod
