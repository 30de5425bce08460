#include "windlass/rod/closed_form_arcs.hpp"

#include <cmath>

#include "windlass/rod/kirchhoff_density.hpp"

namespace windlass::rod {

using bvp::ArcPoint;
using bvp::ArcSamples;
using bvp::EndsMatrix;
using bvp::EndsVector;

void PlanarLineArc::gradient(const ArcPoint& at, double*, EndsVector& ends) const {
  ends.resize(2);
  ends << -at.length, 0.5 * stiffness_ - at.n[0];
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

/// Action, and its gradient and Hessian in the increments of the configuration at the joint.
struct TailArc::Derivatives {
  Eigen::VectorXd gradient;
  Eigen::MatrixXd hessian;
};

TailArc::Derivatives TailArc::derivatives(const ArcPoint& at) const {
  const double* q = starts_here_ ? at.q_a : at.q_b;
  if (dimension_ == 2) {
    const double tension = std::hypot(at.n[0], at.n[1]), root = std::sqrt(stiffness_ * tension);
    const double psi = std::remainder(q[0] - std::atan2(at.n[1], at.n[0]), 2.0 * M_PI);
    return {Eigen::VectorXd::Constant(1, 2.0 * root * std::sin(0.5 * psi)),
            Eigen::MatrixXd::Constant(1, 1, root * std::cos(0.5 * psi))};
  }
  const Eigen::Map<const Quaternion> frame(q);
  const Eigen::Map<const Eigen::Vector3d> n(at.n);
  const double tension = n.norm(), root = std::sqrt(stiffness_ * tension);
  const Eigen::Matrix4d form = direction_form(n / tension);
  const Eigen::Matrix<double, 4, 3> t = increments(frame);
  const double c = frame.dot(form * frame);        // cos ψ
  const double half = std::sqrt(0.5 * (1.0 + c));  // cos(ψ/2)
  const Eigen::Vector3d dc = 2.0 * t.transpose() * (form * frame);
  const Eigen::Matrix3d d2c = 2.0 * t.transpose() * form * t - 2.0 * c * Eigen::Matrix3d::Identity();
  const double s1 = -root / half, s2 = -0.25 * root / (half * half * half);
  return {s1 * dc, s1 * d2c + s2 * dc * dc.transpose()};
}

void TailArc::gradient(const ArcPoint& at, double*, EndsVector& ends) const {
  ends.setZero(this->ends());
  ends.segment(starts_here_ ? 0 : tangent(), tangent()) = derivatives(at).gradient;
}

void TailArc::factor(const ArcPoint& at, EndsMatrix& condensed) {
  // Only the configuration at the joint varies: n is the dead pull, and the far end carries nothing.
  condensed.setZero(ends(), ends());
  const int first = starts_here_ ? 0 : tangent();
  condensed.block(first, first, tangent(), tangent()) = derivatives(at).hessian;
}

void TailArc::hessian(const ArcPoint& at, std::vector<Eigen::Triplet<double>>& entries) const {
  const Eigen::MatrixXd h = derivatives(at).hessian;
  const int first = starts_here_ ? 0 : tangent();
  for (int i = 0; i < tangent(); ++i)
    for (int j = 0; j < tangent(); ++j) entries.emplace_back(first + i, first + j, h(i, j));
}

Eigen::VectorXd TailArc::metric(const ArcPoint& at) const {
  // A mode's tail decays as exp(−√(T/B) s); its share ∫ e^{−2√(T/B)s} ds is carried by the joint.
  const Eigen::Map<const Eigen::VectorXd> n(at.n, dimension_);
  Eigen::VectorXd mass = Eigen::VectorXd::Zero(ends());
  const double scale = dimension_ == 3 ? 4.0 : 1.0;
  mass.segment(starts_here_ ? 0 : tangent(), tangent())
      .setConstant(0.5 * scale * std::sqrt(stiffness_ / n.norm()));
  return mass;
}

double TailArc::energy(const ArcPoint& at) const {
  // ½ B ψ'² = 2 T sin²(ψ/2): half of the action.
  const Eigen::Map<const Eigen::VectorXd> n(at.n, dimension_);
  const double tension = n.norm();
  const double* q = starts_here_ ? at.q_a : at.q_b;
  const double c = dimension_ == 2
                       ? std::cos(q[0] - std::atan2(at.n[1], at.n[0]))
                       : KirchhoffDensity{}.direction(Eigen::Map<const Quaternion>(q)).dot(n) / tension;
  return 2.0 * std::sqrt(stiffness_ * tension) * (1.0 - std::sqrt(0.5 * (1.0 + c)));
}

ArcSamples TailArc::sample(const ArcPoint& at) const {
  constexpr int count = 81;
  ArcSamples out{Eigen::VectorXd(count),
                 Eigen::MatrixXd(ambient(), count),
                 Eigen::MatrixXd::Zero(tangent(), count),
                 Eigen::MatrixXd(forces(), count),
                 {}};
  const double* q0 = starts_here_ ? at.q_a : at.q_b;
  const Eigen::Map<const Eigen::VectorXd> n(at.n, dimension_);
  const double rate = std::sqrt(n.norm() / stiffness_);
  const Eigen::VectorXd pull = n / n.norm();
  Eigen::VectorXd t0(dimension_);
  if (dimension_ == 2)
    t0 << std::cos(q0[0]), std::sin(q0[0]);
  else
    t0 = KirchhoffDensity{}.direction(Eigen::Map<const Quaternion>(q0));
  const double psi0 = std::acos(std::clamp(t0.dot(pull), -1.0, 1.0));
  const double quarter = std::tan(0.25 * psi0);
  Eigen::VectorXd side = t0 - t0.dot(pull) * pull;  // the curve's plane is spanned by the pull and this
  if (side.norm() > 0.0) side.normalize();
  // Offsets from the joint, outward: with E = tan(ψ₀/4) e^{−rate d},
  // ∫cos ψ = d − (4/rate)(1/(1+E²))|, ∫sin ψ = (4/rate)(E/(1+E²))|.
  const auto shape = [&](double d, double& psi, double& ahead, double& aside) {
    const double e = quarter * std::exp(-rate * d);
    psi = 4.0 * std::atan(e);
    ahead = d - 4.0 / rate * (1.0 / (1.0 + e * e) - 1.0 / (1.0 + quarter * quarter));
    aside = 4.0 / rate * (quarter / (1.0 + quarter * quarter) - e / (1.0 + e * e));
  };
  for (int k = 0; k < count; ++k) {
    const int column = starts_here_ ? k : count - 1 - k;
    const double x = static_cast<double>(k) / (count - 1), d = at.length * x * x;  // dense near the joint
    double psi = 0.0, ahead = 0.0, aside = 0.0;
    shape(d, psi, ahead, aside);
    out.sigma(column) = starts_here_ ? d / at.length : 1.0 - d / at.length;
    const double sign = starts_here_ ? 1.0 : -1.0;  // displacement from the arc's start, fixed below
    out.displacement.col(column) = sign * (ahead * pull + aside * side);
    const double bending = 2.0 * std::sqrt(stiffness_ * n.norm()) * std::sin(0.5 * psi);  // |m|
    if (dimension_ == 2) {
      const double signed_psi = std::remainder(q0[0] - std::atan2(n(1), n(0)), 2.0 * M_PI);
      const double turn = std::copysign(psi, signed_psi) - signed_psi;
      out.q(0, column) = q0[0] + turn;
      out.momentum(0, column) = -sign * std::copysign(bending, signed_psi);
    } else {
      const Eigen::Map<const Quaternion> frame(q0);
      Eigen::Vector3d axis = Eigen::Vector3d(t0).cross(Eigen::Vector3d(pull));
      const double norm = axis.norm();
      if (norm > 0.0) axis /= norm;
      out.q.col(column) = product(rotation(axis, psi0 - psi), Quaternion(frame));
      const Eigen::Vector3d m_world = sign * bending * axis;
      out.momentum.col(column) = 2.0 * directors(out.q.col(column)).transpose() * m_world;
    }
  }
  const Eigen::VectorXd start = out.displacement.col(0);
  out.displacement.colwise() -= start;
  for (int i = 0; i < count; ++i) out.nodes.push_back(i);
  return out;
}

}  // namespace windlass::rod
