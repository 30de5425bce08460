#include "windlass/contact/planar_joints.hpp"

#include <cmath>

namespace windlass::contact::planar {

namespace {

using obstacle::Cylinder;

SmallVector place(double a) { return Cylinder::outward(a).head<2>(); }
SmallVector place_slope(double a) { return Cylinder::around(a).head<2>(); }

Attachment fixed(double theta, const SmallVector& x, int coordinates = 0) {
  Attachment at;
  at.q = Coordinates::Constant(1, theta);
  at.dq = SmallMatrix::Zero(1, coordinates);
  at.x = x;
  at.dx = SmallMatrix::Zero(x.size(), coordinates);
  return at;
}

}  // namespace

Attachment Touch::attach(Side, const double* w, const Loads&) const {
  Attachment at = fixed(w[1], place(w[0]), 2);
  at.dq(0, 1) = 1.0;
  at.dx.col(0) = place_slope(w[0]);
  return at;
}

void Touch::curvature(Side, const double* w, const Loads&, const SmallVector&, const SmallVector& f,
                      SmallMatrix& out) const {
  out(0, 0) -= f.dot(place(w[0]));
}

Joint::Location Touch::location(const double* w, const SmallVector&, const SmallVector&) const {
  Location c;  // N(a)·d₃(θ)
  c.value = std::sin(w[0] - w[1]);
  c.by_w.resize(2);
  c.by_w << std::cos(w[0] - w[1]), -std::cos(w[0] - w[1]);
  return c;
}

Attachment Edge::attach(Side side, const double* w, const Loads&) const {
  if (side == line_) {
    Attachment at;
    at.q = Coordinates(0);
    at.dq = SmallMatrix(0, 1);
    at.x = SmallVector::Constant(1, w[0]);
    at.dx = SmallMatrix::Ones(1, 1);
    return at;
  }
  Attachment at = fixed(w[0], place(w[0]), 1);
  at.dq(0, 0) = 1.0;
  at.dx.col(0) = place_slope(w[0]);
  return at;
}

void Edge::curvature(Side side, const double* w, const Loads&, const SmallVector&, const SmallVector& f,
                     SmallMatrix& out) const {
  if (side != line_) out(0, 0) -= f.dot(place(w[0]));
}

Joint::Location Edge::location(const double*, const SmallVector& g_left, const SmallVector& g_right) const {
  Location c;
  c.by_w = SmallVector::Zero(1);
  if (line_ == Side::left) {  // the free arc starts here: ∂S/∂θ_a = −m
    c.side = Side::right;
    c.value = -g_right(0) - line_moment_;
    c.by_gradient = SmallVector::Constant(1, -1.0);
  } else {
    c.side = Side::left;
    c.value = g_left(0) - line_moment_;
    c.by_gradient = SmallVector::Constant(1, 1.0);
  }
  return c;
}

std::optional<Joint::Stretching> Edge::stretching(const double* w, const SmallVector& n,
                                                  double compliance) const {
  const double each = -stiffness_ * compliance;  // the circle's curvature a reference length is 1 + ε
  const Eigen::Vector2d t(std::cos(w[0]), std::sin(w[0])), force = n;
  return Stretching{each * force.dot(t), SmallVector::Constant(1, each * (force(1) * t(0) - force(0) * t(1))),
                    each * t};
}

Attachment SurfaceSection::attach(Side, const double* w, const Loads&) const {
  Attachment at;
  at.q = Coordinates(0);
  at.dq = SmallMatrix(0, 1);
  at.x = SmallVector::Constant(1, w[0]);
  at.dx = SmallMatrix::Ones(1, 1);
  return at;
}

Attachment FreeSection::attach(Side, const double* w, const Loads&) const {
  SmallVector x(2);
  x << w[0], w[1];
  Attachment at = fixed(w[2], x, 3);
  at.dx(0, 0) = at.dx(1, 1) = 1.0;
  at.dq(0, 2) = 1.0;
  return at;
}

Attachment FarEnd::attach(Side, const double*, const Loads&) const {
  Attachment at;
  at.q = Coordinates::Zero(configuration_ == 3 ? 4 : configuration_);
  at.dq = SmallMatrix(configuration_, 0);
  at.x = SmallVector::Zero(forces_);
  at.dx = SmallMatrix(forces_, 0);
  return at;
}

Attachment End::attach(Side, const double* w, const Loads& loads) const {
  const double along = arc_ == Side::left ? 0.5 * loads.angle : -0.5 * loads.angle;
  Attachment at = fixed(clamped_ ? along : w[0], SmallVector::Zero(2), tangent());
  if (!clamped_) at.dq(0, 0) = 1.0;
  return at;
}

}  // namespace windlass::contact::planar
