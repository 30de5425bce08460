#include "windlass/verify/shape.hpp"

#include <cmath>

namespace windlass::verify {

using Eigen::Vector3d;

Shape Shape::of(const scene::Wall& wall) {
  Shape shape;
  shape.normal_ = -Vector3d(wall.normal[0], wall.normal[1], wall.normal[2]).normalized();
  shape.distance_ = wall.distance;
  return shape;
}

Shape Shape::of(const scene::Plate& plate, double rod_radius) {
  const double up = plate.side == scene::PlateSide::above ? 1.0 : -1.0;
  Shape shape;
  shape.normal_ = Vector3d(0.0, 0.0, -up);
  shape.distance_ = up * plate.height;
  shape.outer_radius_ = plate.outer_radius;
  shape.rod_radius_ = rod_radius;
  return shape;
}

Shape Shape::slipping(double friction, double travel, double arm) {
  Shape shape;
  shape.friction_ = friction;
  shape.travel_ = travel;
  shape.arm_ = arm;
  return shape;
}

Shape Shape::beside_plate(double curvature) const {
  Shape shape = *this;
  shape.left_by_plate_ = arm_ * curvature;
  return shape;
}

Vector3d Shape::drag(const Vector3d& t) const {
  return friction_ * (Vector3d::UnitZ() - travel_ * t).normalized();
}

Vector3d Shape::push(const Vector3d& r, const Vector3d& t) const {
  Vector3d along = drag(t);
  if (left_by_plate_) along.z() *= *left_by_plate_;
  return outward(r, t) + along;
}

Eigen::Vector2d Shape::beside(const Vector3d& r) const {
  return {std::hypot(r.x(), r.y()) - outer_radius_, distance_ + normal_->dot(r) + rod_radius_};
}

double Shape::gap(const Vector3d& r) const {
  if (has_edge()) {
    const Eigen::Vector2d from = beside(r);
    return (from.minCoeff() > 0.0 ? from.norm() : from.maxCoeff()) - rod_radius_;
  }
  return normal_ ? distance_ + normal_->dot(r) : std::hypot(r.x(), r.y()) - 1.0;
}

Vector3d Shape::outward(const Vector3d& r, const Vector3d& t) const {
  if (has_edge()) {
    constexpr double on_edge = 1e-8;
    const Vector3d radial = Vector3d(r.x(), r.y(), 0.0).normalized();
    Eigen::Vector2d n = beside(r);
    if (n.norm() < on_edge) {
      const Eigen::Vector2d way(radial.dot(t), normal_->dot(t));
      n = Eigen::Vector2d(-way(1), way(0)) * (way(0) < 0.0 ? -1.0 : 1.0);
    } else if (n.minCoeff() <= 0.0) {
      n = n(1) >= n(0) ? Eigen::Vector2d::UnitY() : Eigen::Vector2d::UnitX();
    }
    n.normalize();
    return n(0) * radial + n(1) * *normal_;
  }
  return normal_ ? *normal_ : Vector3d(r.x(), r.y(), 0.0).normalized();
}

double Shape::bend(const Vector3d& r, const Vector3d& t) const {
  if (has_edge()) {
    const Eigen::Vector2d from = beside(r);
    if (from(0) <= 0.0 || from.norm() < 1e-8) return 0.0;
    const Vector3d radial = Vector3d(r.x(), r.y(), 0.0).normalized(), n = outward(r, t);
    const double around = Vector3d::UnitZ().cross(radial).dot(t),
                 along = n.cross(Vector3d::UnitZ().cross(radial)).dot(t);
    return n.dot(radial) * around * around / std::hypot(r.x(), r.y()) +
           (from(1) > 0.0 ? along * along / from.norm() : 0.0);
  }
  if (normal_) return 0.0;
  const double rate = outward(r, t).dot(t);
  return (t.head<2>().squaredNorm() - rate * rate) / std::hypot(r.x(), r.y());
}

std::vector<Shape> shapes_of(const scene::Scene& scene, double travel) {
  if (scene.has_cylinder) {
    std::vector<Shape> shapes{Shape::slipping(scene.dragging_friction(), travel, scene.friction_arm())};
    for (const scene::Plate& plate : scene.plates()) {
      shapes.push_back(Shape::of(plate, scene.rod_radius));
      if (shapes.back().has_edge()) shapes.push_back(shapes.back());  // named apart
    }
    return shapes;
  }
  std::vector<Shape> shapes;
  for (const scene::Wall& wall : scene.walls) shapes.push_back(Shape::of(wall));
  return shapes;
}

}  // namespace windlass::verify
