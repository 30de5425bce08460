#include "windlass/contact/coupled_edge.hpp"

#include <cmath>

#include "windlass/rod/dragged_line_arc.hpp"

namespace windlass::contact::spatial {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

constexpr int psi = 2, force = 4;  // places among the coordinates

Loads without_friction(const Loads& loads) {
  Loads out = loads;
  out.friction = out.arm = 0.0;
  return out;
}

}  // namespace

CoupledEdge::Inflow CoupledEdge::inflow(double at, const Loads& loads) const {
  const rod::Slip slip = rod::slip(at, loads.travel);
  const Vector2d t(std::cos(at), std::sin(at)), b(-t(1), t(0));
  const double size = side() * loads.friction, soft = loads.compliance * stiffness_;
  const double lever = loads.arm + soft * t(0) * t(0), lever_psi = -2.0 * soft * t(0) * t(1);
  return {size * lever * t.dot(slip.d),
          size * (lever * (b.dot(slip.d) + t.dot(slip.by_psi)) + lever_psi * t.dot(slip.d)),
          size * lever * t.dot(slip.by_travel)};
}

Attachment CoupledEdge::attach(Side side, const double* w, const Loads& loads) const {
  const Attachment four = edge_.attach(side, w, without_friction(loads));
  const bool line = side == line_;
  Attachment at = line ? Attachment::zero(3, 3, 2, 5) : Attachment::zero(4, 3, 3, 5);
  at.q.head(four.q.size()) = four.q;
  at.dq.topLeftCorner(four.dq.rows(), 4) = four.dq;
  at.x = four.x;
  at.dx.leftCols<4>() = four.dx;
  if (line) {
    at.q(2) = w[force];
    at.dq(2, force) = 1.0;
  } else {
    at.tested = at.dx;
    at.tested->col(force) = chart(w).normal;
  }
  return at;
}

void CoupledEdge::curvature(Side side, const double* w, const Loads& loads, const SmallVector& g_q,
                            const SmallVector& f, SmallMatrix& out) const {
  if (side == line_) return;
  SmallMatrix four = SmallMatrix::Zero(4, 4);
  edge_.curvature(side, w, without_friction(loads), g_q, f, four);
  out.topLeftCorner<4, 4>() += four;
  out.block<1, 2>(force, 0) += chart(w).normal_slope(Vector3d(f)).transpose();
}

std::optional<Joint::Drag> CoupledEdge::drag(Side side, const double* w, const Loads& loads,
                                             const SmallVector&) const {
  if (side != line_) return std::nullopt;
  Drag out{SmallVector::Zero(5), SmallMatrix::Zero(5, 5), SmallMatrix::Zero(5, 3)};
  // The line's own force along the normal is in its gradient.
  out.value(force) = -w[force];
  out.by_w(force, force) = -1.0;
  if (inflow(w[psi], loads).any()) return out;
  // Work of a point force's friction on displacements (u, ψ, χ).
  const rod::Slip slip = rod::slip(w[psi], loads.travel);
  const double mu = -loads.friction, r = loads.arm;
  const Vector2d t(std::cos(w[psi]), std::sin(w[psi])), b(-t(1), t(0));
  const auto work = [&](const Vector2d& d, double across) {
    SmallVector e = SmallVector::Zero(5);
    e << mu * (1.0 - r) * d(0), mu * d(1), 0.0, mu * r * across, 0.0;
    return e;
  };
  const SmallVector e = work(slip.d, b.dot(slip.d));
  out.value += w[force] * e;
  out.by_w.col(psi) += w[force] * work(slip.by_psi, b.dot(slip.by_psi) - t.dot(slip.d));
  out.by_w.col(force) += e;
  return out;
}

Joint::Location CoupledEdge::location(const double* w, const SmallVector& g_left,
                                      const SmallVector& g_right) const {
  Location c = edge_.location(w, g_left, g_right);
  c.by_w.conservativeResize(5);
  c.by_w(force) = 0.0;
  return c;
}

std::optional<Joint::Lift> CoupledEdge::lift(const double* w, const Loads& loads) const {
  const Inflow in = inflow(w[psi], loads);
  if (in.any()) return std::nullopt;
  Lift out{in.value * w[force], SmallVector::Zero(5), in.by_travel * w[force]};
  out.by_w(psi) = in.by_psi * w[force];
  out.by_w(force) = in.value;
  return out;
}

std::optional<Joint::Stretching> CoupledEdge::stretching(const double* w, const SmallVector& n,
                                                         double compliance) const {
  Stretching out = *edge_.stretching(w, n, compliance);
  out.by_w.conservativeResize(5);
  out.by_w(force) = 0.0;
  return out;
}

double CoupledEdge::flux(const double* w, const Loads& loads) const {
  return inflow(w[psi], loads).any() ? w[force] : 0.0;
}

void CoupledEdge::retract(const double* w, const double* dw, double* out) const {
  for (int i = 0; i < 5; ++i) out[i] = w[i] + dw[i];
}

void CoupledEdge::adopt(const Place& place, double* w) const {
  edge_.adopt(place, w);
  w[force] = 0.0;
}

}  // namespace windlass::contact::spatial
