#include "windlass/contact/spatial_joints.hpp"

#include <cmath>

namespace windlass::contact::spatial {

namespace {

using Eigen::Vector3d;

Vector3d place(double a, double z) { return {std::sin(a), -std::cos(a), z}; }
Vector3d along(double a) { return {std::cos(a), std::sin(a), 0.0}; }
Vector3d outward(double a) { return {std::sin(a), -std::cos(a), 0.0}; }

/// Frame at the south pole: d1 = −e_y (outward), d2 = −e_z, d3 = e_x.
rod::Quaternion base_frame() {
  static const rod::Quaternion q = [] {
    Eigen::Matrix3d r;
    r.col(0) = -Vector3d::UnitY();
    r.col(1) = -Vector3d::UnitZ();
    r.col(2) = Vector3d::UnitX();
    const Eigen::Quaterniond e(r);
    return rod::Quaternion(e.w(), e.x(), e.y(), e.z());
  }();
  return q;
}

Attachment sized(int configuration, int tangent, int position, int coordinates) {
  Attachment at;
  at.q = Coordinates::Zero(configuration);
  at.dq = SmallMatrix::Zero(tangent, coordinates);
  at.x = SmallVector::Zero(position);
  at.dx = SmallMatrix::Zero(position, coordinates);
  return at;
}

/// Tangency d₃·N(a) = 0 of a touch whose degrees of freedom are a first and the spins last.
Joint::Location tangency(double a, const rod::Quaternion& q, int tangent, int spins) {
  const Eigen::Matrix3d r = rod::directors(q);
  Joint::Location c;
  c.value = r.col(2).dot(outward(a));
  c.by_w = SmallVector::Zero(tangent);
  c.by_w(0) = r.col(2).dot(along(a));
  const Vector3d by_spin = 2.0 * Vector3d::UnitZ().cross(r.transpose() * outward(a));
  c.by_w.tail(spins) = by_spin.head(spins);
  return c;
}

}  // namespace

rod::Quaternion surface_frame(double a, double psi, double chi) {
  using rod::product, rod::rotation;
  return product(
      rotation(Vector3d::UnitZ(), a),
      product(base_frame(), product(rotation(Vector3d::UnitX(), psi), rotation(Vector3d::UnitZ(), chi))));
}

Eigen::Matrix3d surface_spins(double psi, double chi) {
  Eigen::Matrix3d v;
  v.col(0) << -std::cos(psi) * std::sin(chi), -std::cos(psi) * std::cos(chi), std::sin(psi);
  v.col(1) << std::cos(chi), -std::sin(chi), 0.0;
  v.col(2) << 0.0, 0.0, 1.0;
  return 0.5 * v;
}

Vector3d surface_coordinates(const rod::Quaternion& q, double a) {
  const rod::Quaternion local =
      rod::product(rod::conjugate(rod::product(rod::rotation(Vector3d::UnitZ(), a), base_frame())), q);
  const Eigen::Matrix3d r = rod::directors(local);  // R₁(ψ) R₃(χ)
  return {a, std::atan2(-r(1, 2), r(2, 2)), std::atan2(-r(0, 1), r(0, 0))};
}

Attachment Touch::attach(Side, const double* w, const Loads&) const {
  Attachment at = sized(4, 3, 3, tangent());
  at.q = Eigen::Map<const Eigen::Vector4d>(w + 2);
  at.dq.rightCols(3).setIdentity();
  at.x = place(w[0], w[1]);
  at.dx.col(0) = along(w[0]);
  at.dx(2, 1) = 1.0;
  return at;
}

void Touch::curvature(Side, const double* w, const Loads&, const SmallVector&, const SmallVector& f,
                      SmallMatrix& out) const {
  out(0, 0) -= f.dot(outward(w[0]));
}

Joint::Location Touch::location(const double* w, const SmallVector&, const SmallVector&) const {
  return tangency(w[0], Eigen::Map<const Eigen::Vector4d>(w + 2), tangent(), 3);
}

void Touch::retract(const double* w, const double* dw, double* out) const {
  out[0] = w[0] + dw[0];
  out[1] = w[1] + dw[1];
  Eigen::Map<Eigen::Vector4d>(out + 2) =
      rod::retract(Eigen::Map<const Eigen::Vector4d>(w + 2), Vector3d(dw + 2));
}

Attachment Edge::attach(Side side, const double* w, const Loads&) const {
  constexpr int psi = 2;  // place of ψ among the coordinates
  if (side == line_) {
    Attachment at = sized(2, 2, 2, tangent());
    at.q << w[2], w[3];
    at.dq.rightCols(2).setIdentity();
    at.x << w[0], w[1];
    at.dx(0, 0) = 1.0;
    at.dx(1, 1) = 1.0;
    return at;
  }
  Attachment at = sized(4, 3, 3, tangent());
  at.q = surface_frame(w[0], w[2], w[3]);
  const Eigen::Matrix3d spins = surface_spins(w[2], w[3]);
  at.dq.col(0) = spins.col(0);
  at.dq.col(psi) = spins.col(1);
  at.dq.col(psi + 1) = spins.col(2);
  at.x = place(w[0], w[1]);
  at.dx.col(0) = along(w[0]);
  at.dx(2, 1) = 1.0;
  return at;
}

void Edge::curvature(Side side, const double* w, const Loads&, const SmallVector& g_q, const SmallVector& f,
                     SmallMatrix& out) const {
  if (side == line_) return;
  constexpr int i = 2;  // place of ψ among the coordinates
  const double cp = std::cos(w[2]), sp = std::sin(w[2]), cc = std::cos(w[3]), sc = std::sin(w[3]);
  const Vector3d g = g_q;
  out(0, i) += 0.5 * g.dot(Vector3d(sp * sc, sp * cc, cp));
  out(0, i + 1) += 0.5 * g.dot(Vector3d(-cp * cc, cp * sc, 0.0));
  out(i, i + 1) += 0.5 * g.dot(Vector3d(-sc, -cc, 0.0));
  out(0, 0) -= f.dot(outward(w[0]));
}

Joint::Location Edge::location(const double* w, const SmallVector& g_left, const SmallVector& g_right) const {
  constexpr int i = 2;  // place of ψ among the coordinates
  const bool free_right = line_ == Side::left;
  const double factor = free_right ? -0.5 : 0.5;  // the gradient is ∓2 m in the body frame
  const Vector3d moment = factor * (free_right ? g_right : g_left);
  const double cp = std::cos(w[2]), sp = std::sin(w[2]), cc = std::cos(w[3]), sc = std::sin(w[3]);
  const Vector3d binormal(sc, cc, 0.0);
  Location c;
  c.side = free_right ? Side::right : Side::left;
  c.value = moment.dot(binormal) + stiffness_ * cp * cp;
  c.by_gradient = factor * binormal;
  c.by_w = SmallVector::Zero(tangent());
  c.by_w(i) = -2.0 * stiffness_ * cp * sp;
  c.by_w(i + 1) = moment.dot(Vector3d(cc, -sc, 0.0));
  return c;
}

void Edge::retract(const double* w, const double* dw, double* out) const {
  constexpr int i = 2;  // place of ψ among the coordinates
  out[0] = w[0] + dw[0];
  out[1] = w[1] + dw[1];
  out[2] = w[2] + dw[i];
  out[3] = w[3] + dw[i + 1];
}

Attachment SurfaceSection::attach(Side, const double* w, const Loads&) const {
  Attachment at = sized(2, 2, 2, tangent());
  at.q << w[2], w[3];
  at.dq.rightCols(2).setIdentity();
  at.x << w[0], w[1];
  at.dx.leftCols(2).setIdentity();
  return at;
}

Attachment FreeSection::attach(Side, const double* w, const Loads&) const {
  Attachment at = sized(4, 3, 3, tangent());
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
  out.tail(3) = rod::turn_increment(Eigen::Map<const Eigen::Vector4d>(w + 3), turn, spin);
  return out;
}

Attachment End::attach(Side, const double* w, const Loads& loads) const {
  Attachment at = sized(4, 3, 3, tangent());
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

Attachment FreeRodEnd::attach(Side, const double* w, const Loads& loads) const {
  Attachment at = sized(4, 3, 3, tangent());
  const double sign = arc_ == Side::left ? 1.0 : -1.0;  // the arc that ends here is the right half
  if (pinned_) {
    at.q = Eigen::Map<const Eigen::Vector4d>(w + under_thrust_);
    at.dq.rightCols(3).setIdentity();
  } else {
    at.q = rod::product(surface_frame(0.0, 0.0, 0.0),
                        rod::rotation(Vector3d::UnitZ(), 0.5 * sign * loads.twist));
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
  w[0] = place.angle;
  w[1] = place.r(2);
  Eigen::Map<Eigen::Vector4d>{w + 2} = place.q;
}

void Edge::adopt(const Place& place, double* w) const {
  const Vector3d c = surface_coordinates(place.q, place.angle);
  w[0] = place.angle;
  w[1] = place.r(2);
  w[2] = c(1);
  w[3] = c(2);
  if (surface_frame(w[0], w[2], w[3]).dot(place.q) < 0.0) w[3] += 2.0 * M_PI;  // the quaternion of this sign
}

void SurfaceSection::adopt(const Place& place, double* w) const {
  const Vector3d c = surface_coordinates(place.q, place.angle);
  w[0] = place.angle, w[1] = place.r(2), w[2] = c(1), w[3] = 0.0;
}

void FreeSection::adopt(const Place& place, double* w) const {
  Eigen::Map<Vector3d>{w} = place.r;
  Eigen::Map<Eigen::Vector4d>{w + 3} = place.q;
}

void End::adopt(const Place& place, double* w) const {
  if (!clamped_) Eigen::Map<Eigen::Vector4d>{w} = place.q;
}

void FreeRodEnd::adopt(const Place& place, double* w) const {
  if (under_thrust_) w[0] = place.r(0);
  if (pinned_) Eigen::Map<Eigen::Vector4d>{w + under_thrust_} = place.q;
}

void FreeRodEnd::retract(const double* w, const double* dw, double* out) const {
  if (under_thrust_) out[0] = w[0] + dw[0];
  if (!pinned_) return;
  Eigen::Map<Eigen::Vector4d>{out + under_thrust_} = rod::retract(
      Eigen::Map<const Eigen::Vector4d>(w + under_thrust_), Vector3d(dw + static_cast<int>(under_thrust_)));
}

SmallVector FreeRodEnd::turned(const double* w, double turn, double spin) const {
  SmallVector out = SmallVector::Zero(tangent());
  if (pinned_)
    out.tail(3) = rod::turn_increment(Eigen::Map<const Eigen::Vector4d>(w + under_thrust_), turn, spin);
  return out;
}

}  // namespace windlass::contact::spatial
