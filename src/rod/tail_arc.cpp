#include <algorithm>
#include <cmath>

#include "free_end.hpp"
#include "windlass/rod/closed_form_arcs.hpp"
#include "windlass/rod/kirchhoff_density.hpp"

namespace windlass::rod {

using bvp::ArcPoint;
using bvp::ArcSamples;
using bvp::EndsMatrix;
using bvp::EndsVector;

/// The tail at its joint, and its action S as a function of c = cos ψ and ℓ.
struct TailArc::State {
  double tension, root, rate;  ///< T, √(B T), √(T/B)
  double psi;                  ///< signed in the plane
  double c, q;                 ///< cos ψ, sin²(ψ/2)
  FreeEnd end;
  double decay() const { return std::sqrt(end.ratio.deficit / (1.0 - q)); }
  double by_c() const { return -root * decay(); }
  double by_cc() const { return 0.25 * root * decay() * (1.0 / (1.0 - q) - end.by_q / end.ratio.deficit); }
  double by_length() const { return -tension * (1.0 - 2.0 * end.ratio.rho * q); }
  double by_c_length() const { return -tension * (end.ratio.rho + q * end.by_q); }
  double by_length_twice() const { return 2.0 * tension * q * end.by_u * rate; }
};

TailArc::State TailArc::state(const ArcPoint& at) const {
  const double* q = starts_here_ ? at.q_a : at.q_b;
  const Eigen::Map<const Eigen::VectorXd> n(at.n, dimension_);
  State s{};
  s.tension = n.norm();
  s.root = std::sqrt(stiffness_ * s.tension);
  s.rate = std::sqrt(s.tension / stiffness_);
  if (dimension_ == 2) {
    s.psi = std::remainder(q[0] - std::atan2(n(1), n(0)), 2.0 * M_PI);
    s.c = std::cos(s.psi);
    s.q = std::pow(std::sin(0.5 * s.psi), 2);
  } else {
    const Eigen::Vector3d t = KirchhoffDensity{}.direction(Eigen::Map<const Quaternion>(q)),
                          pull = n / s.tension;
    s.c = t.dot(pull);
    s.q = 0.25 * (t - pull).squaredNorm();  // without cancellation
    s.psi = 2.0 * std::asin(std::min(1.0, std::sqrt(s.q)));
  }
  if (end_ == End::moment_free) s.end = free_end(s.rate * at.length, s.q);
  return s;
}

void TailArc::gradient(const ArcPoint& at, double*, EndsVector& ends) const {
  ends.setZero(this->ends());
  const State s = state(at);
  const int first = starts_here_ ? 0 : tangent();
  if (end_ == End::moment_free) ends(this->ends() - 1) = s.by_length();
  if (dimension_ == 2) {
    ends(first) = -std::sin(s.psi) * s.by_c();
    return;
  }
  const Eigen::Map<const Quaternion> frame(starts_here_ ? at.q_a : at.q_b);
  const Eigen::Matrix4d form = direction_form(Eigen::Map<const Eigen::Vector3d>(at.n) / s.tension);
  ends.segment(first, 3) = s.by_c() * 2.0 * increments(frame).transpose() * (form * frame);
}

EndsMatrix TailArc::ends_hessian(const ArcPoint& at) const {
  const State s = state(at);
  const int first = starts_here_ ? 0 : tangent(), last = ends() - 1;
  EndsMatrix h = EndsMatrix::Zero(ends(), ends());
  Eigen::VectorXd dc(tangent());
  if (dimension_ == 2) {
    dc(0) = -std::sin(s.psi);
    h(first, first) = -s.c * s.by_c() + dc(0) * dc(0) * s.by_cc();
  } else {
    const Eigen::Map<const Quaternion> frame(starts_here_ ? at.q_a : at.q_b);
    const Eigen::Matrix4d form = direction_form(Eigen::Map<const Eigen::Vector3d>(at.n) / s.tension);
    const Eigen::Matrix<double, 4, 3> t = increments(frame);
    dc = 2.0 * t.transpose() * (form * frame);
    const Eigen::Matrix3d d2c = 2.0 * t.transpose() * form * t - 2.0 * s.c * Eigen::Matrix3d::Identity();
    h.block(first, first, 3, 3) = s.by_c() * d2c + s.by_cc() * dc * dc.transpose();
  }
  if (end_ == End::infinite) return h;
  h.block(first, last, tangent(), 1) = s.by_c_length() * dc;
  h.block(last, first, 1, tangent()) = s.by_c_length() * dc.transpose();
  h(last, last) = s.by_length_twice();
  return h;
}

void TailArc::factor(const ArcPoint& at, EndsMatrix& condensed) { condensed = ends_hessian(at); }

void TailArc::hessian(const ArcPoint& at, std::vector<Eigen::Triplet<double>>& entries) const {
  const EndsMatrix h = ends_hessian(at);
  for (int i = 0; i < h.rows(); ++i)
    for (int j = 0; j < h.cols(); ++j)
      if (h(i, j) != 0.0) entries.emplace_back(i, j, h(i, j));
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
  const State s = state(at);
  return 2.0 * s.root * bending(s.end.ratio, s.end.log_slope, s.q, s.rate * at.length);
}

/// One sample: distance from the joint, angle to the pull, way made along the pull and across, size of the moment.
struct TailArc::Place {
  double distance, psi, ahead, aside, moment;
};

namespace {

constexpr int samples = 33;

}  // namespace

/// A place on a tail, from its free end: √(T/B) times the distance, and v with sin²(ψ/2) = sin²(ψ_e/2) cosh²v.
struct TailArc::FromEnd {
  double u, v;
};

/// Dense near the joint. With the energy between joint and sample, ∫ cos ψ ds = cos ψ_e d − E/T, since the Hamiltonian is
/// constant; ∫ sin ψ ds is the fall of the moment over T.
TailArc::Place TailArc::place(const State& s, double length, int sample) const {
  const double x = static_cast<double>(sample) / (samples - 1), rho = s.end.ratio.rho;
  const double start = std::abs(s.psi), moment = 2.0 * s.root * std::sqrt(s.q * s.end.ratio.deficit);
  if (sample == 0) return {0.0, start, 0.0, 0.0, moment};
  Place p{length * x * x, 0.0, 0.0, 0.0, 0.0};
  double q = 0.0, slope = -0.5, from_end = HUGE_VAL;
  EndRatio ratio;
  if (rho > 0.0) {
    // A straight tail has sin²(ψ/2) ∝ cosh²u; near it that spaces the samples, and u is exact for each.
    const double v = s.end.ratio.growth() * (1.0 - x * x), grown = std::cosh(v);
    ratio = EndRatio::of_growth(v);
    q = s.q * rho * grown * grown;
    p.distance = length;
    if (sample + 1 < samples) {
      const Elapsed rest = elapsed(ratio, q);
      p.distance = length - rest.u / s.rate;
      slope = rest.log_slope;
      from_end = rest.u;
    }
  } else {
    const double e = std::tan(0.25 * start) * std::exp(-s.rate * p.distance), wide = 1.0 + e * e;
    q = 4.0 * e * e / (wide * wide);
  }
  p.psi = 2.0 * std::asin(std::sqrt(q));
  p.moment = 2.0 * s.root * std::sqrt(q * ratio.deficit);
  const double rest = ratio.deficit > 0.0 ? bending(ratio, slope, q, from_end) : 0.0;
  const double spent = bending(s.end.ratio, s.end.log_slope, s.q, s.rate * length) - rest;
  p.ahead = (1.0 - 2.0 * rho * s.q) * p.distance - 2.0 * s.root / s.tension * spent;
  p.aside = (moment - p.moment) / s.tension;
  return p;
}

ArcSamples TailArc::sample(const ArcPoint& at) const {
  ArcSamples out{Eigen::VectorXd(samples),
                 Eigen::MatrixXd(ambient(), samples),
                 Eigen::MatrixXd::Zero(tangent(), samples),
                 Eigen::MatrixXd(forces(), samples),
                 {}};
  const State s = state(at);
  const double* q0 = starts_here_ ? at.q_a : at.q_b;
  const Eigen::VectorXd pull = Eigen::Map<const Eigen::VectorXd>(at.n, dimension_) / s.tension;
  Eigen::VectorXd t0(dimension_);
  if (dimension_ == 2)
    t0 << std::cos(q0[0]), std::sin(q0[0]);
  else
    t0 = KirchhoffDensity{}.direction(Eigen::Map<const Quaternion>(q0));
  Eigen::VectorXd side = t0 - t0.dot(pull) * pull;  // the curve's plane is spanned by the pull and this
  if (side.norm() > 0.0) side.normalize();
  const double sign = starts_here_ ? 1.0 : -1.0;  // displacement from the arc's start, fixed below
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();
  if (dimension_ == 3) axis = Eigen::Vector3d(t0).cross(Eigen::Vector3d(pull));
  if (axis.norm() > 0.0) axis.normalize();
  for (int k = 0; k < samples; ++k) {
    const int column = starts_here_ ? k : samples - 1 - k;
    const Place p = place(s, at.length, k);
    out.sigma(column) = starts_here_ ? p.distance / at.length : 1.0 - p.distance / at.length;
    out.displacement.col(column) = sign * (p.ahead * pull + p.aside * side);
    if (dimension_ == 2) {
      out.q(0, column) = q0[0] + std::copysign(p.psi, s.psi) - s.psi;
      out.momentum(0, column) = -sign * std::copysign(p.moment, s.psi);
    } else {
      const Eigen::Map<const Quaternion> frame(q0);
      out.q.col(column) = product(rotation(axis, s.psi - p.psi), Quaternion(frame));
      const Eigen::Vector3d m_world = sign * p.moment * axis;
      out.momentum.col(column) = 2.0 * directors(out.q.col(column)).transpose() * m_world;
    }
  }
  const Eigen::VectorXd start = out.displacement.col(0);
  out.displacement.colwise() -= start;
  for (int i = 0; i < samples; ++i) out.nodes.push_back(i);
  return out;
}

double TailArc::decay_length(const ArcPoint& at) const {
  return std::sqrt(stiffness_ / Eigen::Map<const Eigen::VectorXd>(at.n, dimension_).norm());
}

/// sin²(ψ/2) at a distance from the joint, (ρ q) cosh²v with dv/du = cos(ψ/2), u counted from the end; v by Newton's method.
/// @param near  u and v of a place nearer to the joint; left as those of this one
double TailArc::half_sine_squared(const State& s, double length, double distance, FromEnd& near) const {
  const double rho = s.end.ratio.rho;
  if (rho <= 0.0) {
    const double e = std::tan(0.25 * std::abs(s.psi)) * std::exp(-s.rate * distance), wide = 1.0 + e * e;
    return 4.0 * e * e / (wide * wide);
  }
  const double goal = s.rate * (length - distance);
  if (!(goal > 0.0)) return s.q * rho;
  const auto q_at = [&](double v) { return std::min(s.q, s.q * rho * std::pow(std::cosh(v), 2)); };
  double v = std::max(0.5 * near.v, near.v + (goal - near.u) * std::sqrt(1.0 - q_at(near.v)));
  for (int k = 0; k < 20; ++k) {
    const double q = q_at(v);
    const double step = (goal - time_from_end(EndRatio::of_growth(v), q)) * std::sqrt(1.0 - q);
    v = std::max(0.5 * v, v + step);
    if (std::abs(step) < 1e-7 * (1.0 + v)) break;  // squared by the last step
  }
  near = {goal, v};
  return s.q * rho * std::pow(std::cosh(v), 2);
}

Eigen::MatrixXd TailArc::configurations(const ArcPoint& at, const Eigen::VectorXd& distances) const {
  const State s = state(at);
  const double* q0 = starts_here_ ? at.q_a : at.q_b;
  Eigen::MatrixXd out(ambient(), distances.size());
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();
  if (dimension_ == 3) {
    const Eigen::Map<const Eigen::Vector3d> n(at.n);
    axis = KirchhoffDensity{}.direction(Eigen::Map<const Quaternion>(q0)).cross(n / s.tension);
    if (axis.norm() > 0.0) axis.normalize();
  }
  FromEnd near{s.rate * at.length, s.end.ratio.rho > 0.0 ? s.end.ratio.growth() : 0.0};
  for (Eigen::Index k = 0; k < distances.size(); ++k) {
    const double q = half_sine_squared(s, at.length, distances(k), near);
    const double psi = 2.0 * std::asin(std::sqrt(q)), start = std::abs(s.psi);
    if (dimension_ == 2)
      out(0, k) = q0[0] + std::copysign(psi, s.psi) - s.psi;
    else
      out.col(k) = product(rotation(axis, start - psi), Quaternion(Eigen::Map<const Quaternion>(q0)));
  }
  return out;
}

}  // namespace windlass::rod
