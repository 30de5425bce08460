#include "windlass/contact/spatial_joints.hpp"

#include <cmath>

#include "slipping.hpp"
#include "windlass/rod/dragged_line_arc.hpp"

namespace windlass::contact::spatial {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// A line arc on a joint with the coordinates (u, ψ, χ).
Attachment lying(const double* w) {
  Attachment at = Attachment::zero(2, 2, 2, 4);
  at.q << w[2], w[3];
  at.dq.rightCols(2).setIdentity();
  at.x << w[0], w[1];
  at.dx.leftCols(2).setIdentity();
  return at;
}

rod::Quaternion frame_at(const double* q) { return Eigen::Map<const Eigen::Vector4d>(q); }

}  // namespace

rod::Quaternion surface_frame(const rod::Quaternion& base, double psi, double chi) {
  using rod::product, rod::rotation;
  return product(base, product(rotation(Vector3d::UnitX(), psi), rotation(Vector3d::UnitZ(), chi)));
}

rod::Quaternion surface_frame(double a, double psi, double chi) {
  return surface_frame(obstacle::Cylinder().base_frame({a, 0.0}), psi, chi);
}

Eigen::Matrix3d surface_spins(double curvature, double psi, double chi) {
  Eigen::Matrix3d v;
  v.col(0) << -std::cos(psi) * std::sin(chi), -std::cos(psi) * std::cos(chi), std::sin(psi);
  v.col(0) *= curvature;
  v.col(1) << std::cos(chi), -std::sin(chi), 0.0;
  v.col(2) << 0.0, 0.0, 1.0;
  return 0.5 * v;
}

Eigen::Vector2d surface_coordinates(const rod::Quaternion& q, const rod::Quaternion& base) {
  const Eigen::Matrix3d r = rod::directors(rod::product(rod::conjugate(base), q));  // R₁(ψ) R₃(χ)
  return {std::atan2(-r(1, 2), r(2, 2)), std::atan2(-r(0, 1), r(0, 0))};
}

Attachment Touch::attach(Side, const double* w, const Loads& loads) const {
  Attachment at = Attachment::zero(4, 3, 3, tangent());
  const obstacle::Chart here = chart(w);
  at.q = frame_at(w + 2);
  at.dq.rightCols(3).setIdentity();
  at.x = here.r;
  at.dx.leftCols<2>() = here.tangents;
  if (!(loads.friction > 0.0) || !surface_->slips()) return at;
  const Eigen::Matrix3d directors = rod::directors(frame_at(w + 2));
  const TouchSlip slip = slip_at(here, directors, loads.travel);
  at.tested = slipping(at.dx, here, loads.friction, slip.d);
  if (loads.arm != 0.0) add_couple(here, loads.friction, loads.arm, directors, slip, *at.tested);
  return at;
}

void Touch::curvature(Side, const double* w, const Loads& loads, const SmallVector&, const SmallVector& f,
                      SmallMatrix& out) const {
  const obstacle::Chart here = chart(w);
  out.topLeftCorner<2, 2>() += here.second(f);
  if (!(loads.friction > 0.0) || !surface_->slips()) return;
  const Eigen::Matrix3d directors = rod::directors(frame_at(w + 2));
  const TouchSlip slip = slip_at(here, directors, loads.travel);
  add_slipping(here, loads.friction, slip.d, slip.by_w, f, out);
  if (loads.arm != 0.0) add_couple_slope(here, loads.friction, loads.arm, directors, slip, f, out);
}

Joint::Location Touch::location(const double* w, const SmallVector&, const SmallVector&) const {
  const Eigen::Matrix3d d = rod::directors(frame_at(w + 2));
  const obstacle::Chart here = chart(w);
  Location c;
  c.value = d.col(2).dot(here.normal);
  c.by_w = SmallVector::Zero(tangent());
  c.by_w.head<2>() = here.normal_slope(d.col(2));
  c.by_w.tail<3>() = 2.0 * Vector3d::UnitZ().cross(d.transpose() * here.normal);
  return c;
}

double Touch::slide(const double* w) const {
  return rod::directors(frame_at(w + 2)).col(2).dot(chart(w).tangents.col(0));
}

void Touch::retract(const double* w, const double* dw, double* out) const {
  out[0] = w[0] + dw[0];
  out[1] = w[1] + dw[1];
  Eigen::Map<Eigen::Vector4d>(out + 2) =
      rod::retract(Eigen::Map<const Eigen::Vector4d>(w + 2), Vector3d(dw + 2));
}

Attachment Edge::attach(Side side, const double* w, const Loads& loads) const {
  constexpr int psi = 2;  // place of ψ among the coordinates
  if (side == line_) return lying(w);
  Attachment at = Attachment::zero(4, 3, 3, tangent());
  const obstacle::Chart here = chart(w);
  at.q = surface_frame(surface_->base_frame(on_surface(w)), w[2], w[3]);
  const Eigen::Matrix3d spins = surface_spins(surface_->curvature(), w[2], w[3]);
  at.dq.col(0) = spins.col(0);
  at.dq.col(psi) = spins.col(1);
  at.dq.col(psi + 1) = spins.col(2);
  at.x = here.r;
  at.dx.leftCols<2>() = here.tangents;
  if (loads.friction > 0.0 && surface_->slips())
    at.tested = slipping(at.dx, here, loads.friction, rod::slip(w[psi], loads.travel).d);
  return at;
}

std::optional<Joint::Drag> Edge::drag(Side side, const double* w, const Loads& loads,
                                      const SmallVector& g) const {
  if (side != line_ || !(loads.friction > 0.0) || !surface_->slips()) return std::nullopt;
  // n₁ = ψ'(m₃ − 3B sin ψ cos ψ) of rod/line_contact.cpp, the moments ±g: of f = N·(n_left − n_right) the line's share.
  const double moment_sign = side == Side::left ? 1.0 : -1.0, c = std::cos(w[2]), s = std::sin(w[2]);
  const double bend = moment_sign * g(0) / stiffness_, twisting = moment_sign * g(1);
  const double n1 = bend * (twisting - 3.0 * stiffness_ * s * c);
  const double by_psi = -3.0 * stiffness_ * bend * (c * c - s * s);
  const Vector2d by_g(moment_sign / stiffness_ * (twisting - 3.0 * stiffness_ * s * c), moment_sign * bend);
  const rod::Slip slip = rod::slip(w[2], loads.travel);
  const double mu = -loads.friction * moment_sign;
  Drag out{SmallVector::Zero(4), SmallMatrix::Zero(4, 4), SmallMatrix::Zero(4, 2)};
  out.value.head<2>() = mu * n1 * slip.d;
  out.by_w.block<2, 1>(0, 2) = mu * (by_psi * slip.d + n1 * slip.by_psi);
  out.by_gradient.topRows<2>() = mu * slip.d * by_g.transpose();
  return out;
}

void Edge::curvature(Side side, const double* w, const Loads& loads, const SmallVector& g_q,
                     const SmallVector& f, SmallMatrix& out) const {
  if (side == line_) return;
  if (loads.friction > 0.0 && surface_->slips()) {
    const rod::Slip slip = rod::slip(w[2], loads.travel);
    SlipSlope by_w;
    by_w.setZero(2, 4);
    by_w.col(2) = slip.by_psi;
    add_slipping(chart(w), loads.friction, slip.d, by_w, f, out);
  }
  constexpr int i = 2;  // place of ψ among the coordinates
  const double cp = std::cos(w[2]), sp = std::sin(w[2]), cc = std::cos(w[3]), sc = std::sin(w[3]);
  const Vector3d g = surface_->curvature() * g_q;
  out(0, i) += 0.5 * g.dot(Vector3d(sp * sc, sp * cc, cp));
  out(0, i + 1) += 0.5 * g.dot(Vector3d(-cp * cc, cp * sc, 0.0));
  out(i, i + 1) += 0.5 * Vector3d(g_q).dot(Vector3d(-sc, -cc, 0.0));
  out.topLeftCorner<2, 2>() += chart(w).second(f);
}

Joint::Location Edge::location(const double* w, const SmallVector& g_left, const SmallVector& g_right) const {
  constexpr int i = 2;  // place of ψ among the coordinates
  const bool free_right = line_ == Side::left;
  const double factor = free_right ? -0.5 : 0.5;  // the gradient is ∓2 m in the body frame
  const Vector3d moment = factor * (free_right ? g_right : g_left);
  const Vector3d strain = compliance_.cwiseProduct(moment) + natural_;  // B u
  const double cp = std::cos(w[2]), sp = std::sin(w[2]), cc = std::cos(w[3]), sc = std::sin(w[3]);
  const double curvature = stiffness_ * surface_->curvature();
  Location c;
  c.side = free_right ? Side::right : Side::left;
  c.value = strain.dot(Vector3d(sc, cc, 0.0)) + curvature * cp * cp;
  c.by_gradient = factor * compliance_.cwiseProduct(Vector3d(sc, cc, 0.0));
  c.by_w = SmallVector::Zero(tangent());
  c.by_w(i) = -2.0 * curvature * cp * sp;
  c.by_w(i + 1) = strain.dot(Vector3d(cc, -sc, 0.0));
  return c;
}

std::optional<Joint::Stretching> Edge::stretching(const double* w, const SmallVector& n,
                                                  double compliance) const {
  constexpr int i = 2;  // place of ψ among the coordinates
  const obstacle::Chart here = chart(w);
  const double c = std::cos(w[i]), s = std::sin(w[i]);
  const double each = stiffness_ * surface_->curvature() * compliance;
  const Vector3d force = n, t = here.tangents * Vector2d(c, s);
  Stretching out{each * c * c * force.dot(t), SmallVector::Zero(tangent()), each * c * c * t};
  out.by_w.head<2>() = -each * c * c * force.dot(here.normal) * (here.bend * Vector2d(c, s));
  out.by_w(i) = each * (c * c * force.dot(here.tangents * Vector2d(-s, c)) - 2.0 * c * s * force.dot(t));
  return out;
}

void Edge::retract(const double* w, const double* dw, double* out) const {
  constexpr int i = 2;  // place of ψ among the coordinates
  out[0] = w[0] + dw[0];
  out[1] = w[1] + dw[1];
  out[2] = w[2] + dw[i];
  out[3] = w[3] + dw[i + 1];
}

Attachment SurfaceSection::attach(Side, const double* w, const Loads&) const { return lying(w); }

Attachment FreeSection::attach(Side, const double* w, const Loads&) const {
  Attachment at = Attachment::zero(4, 3, 3, tangent());
  at.q = Eigen::Map<const Eigen::Vector4d>(w + 3);
  at.dq.rightCols(3).setIdentity();
  at.x = Eigen::Map<const Vector3d>(w);
  at.dx.leftCols(3).setIdentity();
  return at;
}

void FreeSection::retract(const double* w, const double* dw, double* out) const {
  for (int i = 0; i < 3; ++i) out[i] = w[i] + dw[i];
  Eigen::Map<Eigen::Vector4d>(out + 3) =
      rod::retract(Eigen::Map<const Eigen::Vector4d>(w + 3), Vector3d(dw + 3));
}

SmallVector FreeSection::turned(const double* w, double turn, double spin) const {
  SmallVector out(tangent());
  out.head(3) = turn * Vector3d::UnitX().cross(Eigen::Map<const Vector3d>(w));
  out.tail(3) = rod::turn_increment(Eigen::Map<const Eigen::Vector4d>(w + 3), turn * Vector3d::UnitX(), spin);
  return out;
}

Centreline Strand::centreline(const double* w) const {
  const Eigen::Matrix3d d = rod::directors(frame_at(w + 3));
  Centreline line{Eigen::Map<const Vector3d>(w), d.col(2), {}, {}};
  line.dr.setZero(3, tangent());
  line.dr.leftCols<3>().setIdentity();
  line.dt.setZero(3, tangent());
  line.dt.col(3) = -2.0 * d.col(1);  // frames' increments are half the angle
  line.dt.col(4) = 2.0 * d.col(0);
  return line;
}

Attachment Pressed::attach(Side, const double* w, const Loads&) const { return lying(w); }

std::optional<Joint::Drag> Pressed::drag_of_push(const double* w, const Loads& loads,
                                                 const Vector3d& force) const {
  if (!(loads.friction > 0.0) || !surface_->slips()) return std::nullopt;
  const obstacle::Chart here = chart(w);
  const rod::Slip slip = rod::slip(w[2], loads.travel);
  const double mu = -loads.friction, pressed = here.normal.dot(force);
  Drag out{SmallVector::Zero(4), SmallMatrix::Zero(4, 4), SmallMatrix::Zero(4, 3)};
  out.value.head<2>() = mu * pressed * slip.d;
  out.by_w.topLeftCorner<2, 2>() = mu * slip.d * here.normal_slope(force).transpose();
  out.by_w.block<2, 1>(0, 2) = mu * pressed * slip.by_psi;
  out.by_gradient.topRows<2>() = mu * slip.d * here.normal.transpose();
  return out;
}

Centreline Pressed::centreline(const double* w) const {
  const obstacle::Chart here = chart(w);
  const double c = std::cos(w[2]), s = std::sin(w[2]);
  Centreline line{here.r, here.tangents * Eigen::Vector2d(c, s), {}, {}};
  line.dr.setZero(3, tangent());
  line.dr.leftCols<2>() = here.tangents;
  line.dt.setZero(3, tangent());
  line.dt.leftCols<2>() = -here.normal * (here.bend * Eigen::Vector2d(c, s)).transpose();
  line.dt.col(2) = here.tangents * Eigen::Vector2d(-s, c);
  return line;
}

void Pressed::place_curvature(const double* w, const Vector3d& f, SmallMatrix& out) const {
  out.topLeftCorner<2, 2>() += chart(w).second(f);
}

void Pressed::adopt(const Place& place, double* w) const { Edge(Side::left, 1.0, surface_).adopt(place, w); }

Attachment End::attach(Side, const double* w, const Loads& loads) const {
  Attachment at = Attachment::zero(4, 3, 3, tangent());
  if (clamped_) {
    const double a = arc_ == Side::left ? 0.5 * loads.angle : -0.5 * loads.angle;
    at.q = surface_frame(a, 0.0, 0.0);
  } else {
    at.q = Eigen::Map<const Eigen::Vector4d>(w);
    at.dq.topLeftCorner(tangent(), tangent()).setIdentity();
  }
  return at;
}

void End::retract(const double* w, const double* dw, double* out) const {
  if (clamped_) return;
  const Vector3d v(dw[0], dw[1], dw[2]);
  Eigen::Map<Eigen::Vector4d> turned(out);
  turned = rod::retract(Eigen::Map<const Eigen::Vector4d>(w), v);
}

namespace {

/// Frame of an end in a universal joint.
rod::Quaternion jointed_frame(const double* w) {
  return rod::product(rod::rotation(Vector3d::UnitZ(), w[0]),
                      rod::product(surface_frame(0.0, 0.0, 0.0), rod::rotation(Vector3d::UnitX(), w[1])));
}

}  // namespace

Attachment HeldEnd::attach(Side, const double* w, const Loads&) const {
  Attachment at = Attachment::zero(4, 3, 3, tangent());
  at.q = jointed_frame(w);
  at.dq.col(0) = 0.5 * rod::directors(at.q).transpose() * Vector3d::UnitZ();
  at.dq(0, 1) = 0.5;
  return at;
}

void HeldEnd::curvature(Side, const double* w, const Loads&, const SmallVector& g_q, const SmallVector&,
                        SmallMatrix& out) const {
  const Vector3d axis = rod::directors(jointed_frame(w)).transpose() * Vector3d::UnitZ();
  out(0, 1) += 0.5 * Vector3d(g_q).dot(axis.cross(Vector3d::UnitX()));
}

void HeldEnd::retract(const double* w, const double* dw, double* out) const {
  out[0] = w[0] + dw[0];
  out[1] = w[1] + dw[1];
}

Attachment FreeRodEnd::attach(Side, const double* w, const Loads& loads) const {
  Attachment at = Attachment::zero(4, 3, 3, tangent());
  const double sign = arc_ == Side::left ? 1.0 : -1.0;  // the arc that ends here is the right half
  if (pinned_) {
    at.q = Eigen::Map<const Eigen::Vector4d>(w + under_thrust_);
    at.dq.rightCols(3).setIdentity();
  } else {
    at.q = rod::product(surface_frame(0.0, 0.0, 0.0),
                        rod::rotation(Vector3d::UnitZ(), 0.5 * sign * loads.twist));
  }
  if (hinge_) {
    at.q = rod::product(rod::rotation(*hinge_, w[under_thrust_]), at.q);
    at.dq.col(under_thrust_) = 0.5 * rod::directors(at.q).transpose() * *hinge_;
  }
  at.x(0) = under_thrust_ ? w[0] : sign * (1.0 - loads.shortening) * loads.half_length;
  if (under_thrust_) at.dx(0, 0) = 1.0;
  return at;
}

SmallVector FreeRodEnd::dead_load(const double*, const Loads& loads) const {
  // Potential of the thrust: −F·r_end with F = ∓thrust e_x.
  SmallVector load = SmallVector::Zero(tangent());
  if (under_thrust_) load(0) = (arc_ == Side::left ? 1.0 : -1.0) * loads.thrust;
  return load;
}

void Touch::adopt(const Place& place, double* w) const {
  Eigen::Map<Eigen::Vector2d>{w} = surface_->coordinates(place.r, place.angle);
  Eigen::Map<Eigen::Vector4d>{w + 2} = place.q;
}

void adopt_sign(const rod::Quaternion& q, const rod::Quaternion& base, double* w) {
  if (surface_frame(base, w[0], w[1]).dot(q) < 0.0) w[1] += 2.0 * M_PI;
}

void Edge::adopt(const Place& place, double* w) const {
  Eigen::Map<Eigen::Vector2d>{w} = surface_->coordinates(place.r, place.angle);
  const rod::Quaternion base = surface_->base_frame(on_surface(w));
  Eigen::Map<Eigen::Vector2d>{w + 2} = surface_coordinates(place.q, base);
  adopt_sign(place.q, base, w + 2);
}

void SurfaceSection::adopt(const Place& place, double* w) const {
  Eigen::Map<Eigen::Vector2d> u(w);
  u = surface_->coordinates(place.r, place.angle);
  const rod::Quaternion base = surface_->base_frame(u);
  const Eigen::Vector2d turned = surface_coordinates(place.q, base);
  // The half-turn about N keeps frames with d₁ = ±N, the mirror those of a rod along u₀.
  const bool mirrored = symmetry_ == Symmetry::mirror;
  w[2] = mirrored ? 0.0 : turned(0);
  w[3] = mirrored ? turned(1) : M_PI * std::round(turned(1) / M_PI);
  adopt_sign(place.q, base, w + 2);
}

void FreeSection::adopt(const Place& place, double* w) const {
  Eigen::Map<Vector3d>{w} = place.r;
  Eigen::Map<Eigen::Vector4d>{w + 3} = place.q;
}

void End::adopt(const Place& place, double* w) const {
  if (!clamped_) Eigen::Map<Eigen::Vector4d>{w} = place.q;
}

void HeldEnd::adopt(const Place& place, double* w) const {
  const Vector3d t = rod::directors(place.q).col(2);
  w[0] = place.heading;
  w[1] = std::atan2(t.z(), std::hypot(t.x(), t.y()));
  if (jointed_frame(w).dot(place.q) < 0.0) w[0] += 2.0 * M_PI;
}

void FreeRodEnd::adopt(const Place& place, double* w) const {
  if (under_thrust_) w[0] = place.r(0);
  if (hinge_) w[under_thrust_] = 0.0;
  if (pinned_) Eigen::Map<Eigen::Vector4d>{w + under_thrust_} = place.q;
}

void FreeRodEnd::retract(const double* w, const double* dw, double* out) const {
  if (under_thrust_) out[0] = w[0] + dw[0];
  if (hinge_) out[under_thrust_] = w[under_thrust_] + dw[under_thrust_];
  if (!pinned_) return;
  Eigen::Map<Eigen::Vector4d>{out + under_thrust_} = rod::retract(
      Eigen::Map<const Eigen::Vector4d>(w + under_thrust_), Vector3d(dw + static_cast<int>(under_thrust_)));
}

SmallVector FreeRodEnd::turned(const double* w, double turn, double spin) const {
  SmallVector out = SmallVector::Zero(tangent());
  if (pinned_)
    out.tail(3) = rod::turn_increment(Eigen::Map<const Eigen::Vector4d>(w + under_thrust_),
                                      turn * Vector3d::UnitX(), spin);
  return out;
}

}  // namespace windlass::contact::spatial
