#include "windlass/contact/plate_joints.hpp"

#include <cmath>

namespace windlass::contact::spatial {

using Eigen::Vector2d;

namespace {

/// A line on cylinder and plate on a joint with the coordinates (u₀, χ).
Attachment lying_flat(const double* w) {
  Attachment at = Attachment::zero(1, 1, 1, 2);
  at.q << w[1];
  at.dq(0, 1) = 1.0;
  at.x << w[0];
  at.dx(0, 0) = 1.0;
  return at;
}

double height_of(const obstacle::Surface& plate) { return plate.chart(Vector2d::Zero()).r(2); }

/// Place round the axis and twist of a rod that lies on the cylinder there.
Vector2d flat_coordinates(const SurfacePointer& line, const Place& place) {
  double all[4];
  Edge(Side::left, 1.0, line).adopt(place, all);
  return {all[0], all[3]};
}

Vector2d on_plate(const obstacle::Surface& line, const obstacle::Surface& plate, double around,
                  double height) {
  const Vector2d on_line(around, height);
  return plate.coordinates(line.chart(on_line).r, line.turn(on_line));
}

/// Of the four coordinates of an edge, those that a flat line leaves: u₀ and χ.
SmallMatrix flat_columns(const SmallMatrix& of_edge) {
  SmallMatrix out(of_edge.rows(), 2);
  if (of_edge.rows() > 0) out << of_edge.col(0), of_edge.col(3);
  return out;
}

}  // namespace

Stopped::Stopped(SurfacePointer line, SurfacePointer plate, bool in_the_middle)
    : line_(std::move(line)), plate_(std::move(plate)), in_the_middle_(in_the_middle) {}

Attachment Stopped::attach(Side, const double* w, const Loads&) const {
  Attachment at = Attachment::zero(2, 2, 2, tangent());
  at.q << w[1], w[2];
  at.dq.rightCols(2).setIdentity();
  at.x << w[0], height();
  at.dx(0, 0) = 1.0;
  return at;
}

Joint::Location Stopped::location(const double* w, const SmallVector&, const SmallVector&) const {
  Location c;
  c.value = std::sin(w[1]);
  c.by_w = SmallVector::Zero(tangent());
  c.by_w(1) = std::cos(w[1]);
  return c;
}

Vector2d Stopped::on_surface(const double* w) const { return on_plate(*line_, *plate_, w[0], height()); }

void Stopped::adopt(const Place& place, double* w) const {
  const Vector2d flat = flat_coordinates(line_, place);
  w[0] = flat(0), w[1] = 0.0, w[2] = flat(1);
}

FlatSection::FlatSection(SurfacePointer line, const SurfacePointer& plate)
    : line_(std::move(line)), height_(height_of(*plate)) {}

Attachment FlatSection::attach(Side, const double* w, const Loads&) const { return lying_flat(w); }

void FlatSection::adopt(const Place& place, double* w) const {
  Eigen::Map<Vector2d>{w} = flat_coordinates(line_, place);
}

FlatEdge::FlatEdge(Side line_side, double bending_stiffness, SurfacePointer line, const SurfacePointer& plate)
    : line_(line_side), edge_(line_side, bending_stiffness, std::move(line)), height_(height_of(*plate)) {}

Attachment FlatEdge::attach(Side side, const double* w, const Loads& loads) const {
  if (side == line_) return lying_flat(w);
  Attachment at = edge_.attach(side, on_edge(w).data(), loads);
  at.dq = flat_columns(at.dq);
  at.dx = flat_columns(at.dx);
  if (at.tested) at.tested = flat_columns(*at.tested);
  return at;
}

void FlatEdge::curvature(Side side, const double* w, const Loads& loads, const SmallVector& g_q,
                         const SmallVector& f, SmallMatrix& out) const {
  SmallMatrix all = SmallMatrix::Zero(4, 4);
  if (side != line_) edge_.curvature(side, on_edge(w).data(), loads, g_q, f, all);
  for (int r = 0; r < 2; ++r)
    for (int c = 0; c < 2; ++c) out(r, c) += all(3 * r, 3 * c);
}

Joint::Location FlatEdge::location(const double* w, const SmallVector& g_left,
                                   const SmallVector& g_right) const {
  Location c = edge_.location(on_edge(w).data(), g_left, g_right);
  const SmallVector all = c.by_w;
  c.by_w.resize(2);
  c.by_w << all(0), all(3);
  return c;
}

std::optional<Joint::Stretching> FlatEdge::stretching(const double* w, const SmallVector& n,
                                                      double compliance) const {
  std::optional<Stretching> out = edge_.stretching(on_edge(w).data(), n, compliance);
  const SmallVector all = out->by_w;
  out->by_w.resize(2);
  out->by_w << all(0), all(3);
  return out;
}

void FlatEdge::adopt(const Place& place, double* w) const {
  double all[4];
  edge_.adopt(place, all);
  w[0] = all[0], w[1] = all[3];
}

FlatTouch::FlatTouch(SurfacePointer cylinder, SurfacePointer plate)
    : touch_(std::move(cylinder)), base_(plate->base_frame(Vector2d::Zero())), height_(height_of(*plate)) {}

std::array<double, 6> FlatTouch::as_touch(const double* w) const {
  const rod::Quaternion q = surface_frame(base_, w[1], w[2]);
  return {w[0], height_, q(0), q(1), q(2), q(3)};
}

SmallMatrix FlatTouch::by_own(const double* w) const {
  constexpr double no_curvature = 0.0;
  SmallMatrix out = SmallMatrix::Zero(touch_.tangent(), tangent());
  out(0, 0) = 1.0;
  out.bottomRightCorner<3, 2>() = surface_spins(no_curvature, w[1], w[2]).rightCols<2>();
  return out;
}

double FlatTouch::slide(const double* w) const { return touch_.slide(as_touch(w).data()); }

Attachment FlatTouch::attach(Side side, const double* w, const Loads& loads) const {
  const SmallMatrix own = by_own(w);
  Attachment at = touch_.attach(side, as_touch(w).data(), loads);
  at.dq = (at.dq * own).eval();
  at.dx = (at.dx * own).eval();
  if (at.tested) at.tested = (*at.tested * own).eval();
  return at;
}

void FlatTouch::curvature(Side side, const double* w, const Loads& loads, const SmallVector& g_q,
                          const SmallVector& f, SmallMatrix& out) const {
  const SmallMatrix own = by_own(w);
  SmallMatrix all = SmallMatrix::Zero(touch_.tangent(), touch_.tangent());
  touch_.curvature(side, as_touch(w).data(), loads, g_q, f, all);
  out += own.transpose() * all * own;
  Eigen::Vector3d turning = g_q;
  if (loads.arm != 0.0)
    turning +=
        touch_.attach(side, as_touch(w).data(), loads).test().rightCols<3>().transpose() * Eigen::Vector3d(f);
  out(1, 2) += 0.5 * turning.dot(Eigen::Vector3d(-std::sin(w[2]), -std::cos(w[2]), 0.0));
}

Joint::Location FlatTouch::location(const double* w, const SmallVector& g_left,
                                    const SmallVector& g_right) const {
  Location c = touch_.location(as_touch(w).data(), g_left, g_right);
  c.by_w = (by_own(w).transpose() * c.by_w).eval();
  return c;
}

void FlatTouch::adopt(const Place& place, double* w) const {
  w[0] = touch_.surface()->coordinates(place.r, place.angle)(0);
  Eigen::Map<Vector2d>{w + 1} = surface_coordinates(place.q, base_);
  adopt_sign(place.q, base_, w + 1);
}

FlatPressed::FlatPressed(SurfacePointer line, const SurfacePointer& plate)
    : line_(line), pressed_(std::move(line)), height_(height_of(*plate)) {}

Attachment FlatPressed::attach(Side, const double* w, const Loads&) const { return lying_flat(w); }

std::optional<Joint::Drag> FlatPressed::drag_of_push(const double* w, const Loads& loads,
                                                     const Eigen::Vector3d& force) const {
  const std::optional<Drag> all = pressed_.drag_of_push(on_line(w).data(), loads, force);
  if (!all) return std::nullopt;
  Drag out{SmallVector(2), flat_columns(flat_columns(all->by_w).transpose()).transpose(),
           flat_columns(all->by_gradient.transpose()).transpose()};
  out.value << all->value(0), all->value(3);
  return out;
}

Centreline FlatPressed::centreline(const double* w) const {
  Centreline at = pressed_.centreline(on_line(w).data());
  const SmallMatrix dr = at.dr, dt = at.dt;
  at.dr = flat_columns(dr);
  at.dt = flat_columns(dt);
  return at;
}

void FlatPressed::place_curvature(const double* w, const Eigen::Vector3d& f, SmallMatrix& out) const {
  SmallMatrix all = SmallMatrix::Zero(4, 4);
  pressed_.place_curvature(on_line(w).data(), f, all);
  out(0, 0) += all(0, 0);
}

void FlatPressed::adopt(const Place& place, double* w) const {
  const Vector2d flat = flat_coordinates(line_, place);
  w[0] = flat(0), w[1] = flat(1);
}

LiftOff::LiftOff(Side flat_side, SurfacePointer line, SurfacePointer plate)
    : flat_(flat_side), line_(std::move(line)), plate_(std::move(plate)), height_(height_of(*plate_)) {}

Attachment LiftOff::attach(Side side, const double* w, const Loads&) const {
  if (side == flat_) return lying_flat(w);
  Attachment at = Attachment::zero(2, 2, 2, tangent());
  at.q << 0.0, w[1];
  at.dq(1, 1) = 1.0;
  at.x << w[0], height_;
  at.dx(0, 0) = 1.0;
  return at;
}

Joint::Location LiftOff::location(const double*, const SmallVector& g_left,
                                  const SmallVector& g_right) const {
  Location c;
  c.side = flat_ == Side::left ? Side::right : Side::left;
  c.value = (c.side == Side::right ? g_right : g_left)(0);
  c.by_w = SmallVector::Zero(tangent());
  c.by_gradient = SmallVector::Unit(2, 0);
  return c;
}

Vector2d LiftOff::on_surface(const double* w) const { return on_plate(*line_, *plate_, w[0], height_); }

void LiftOff::adopt(const Place& place, double* w) const {
  const Vector2d flat = flat_coordinates(line_, place);
  w[0] = flat(0), w[1] = flat(1);
}

}  // namespace windlass::contact::spatial
