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

Shape Shape::of(const scene::Plate& plate) {
  const double up = plate.side == scene::PlateSide::above ? 1.0 : -1.0;
  Shape shape;
  shape.normal_ = Vector3d(0.0, 0.0, -up);
  shape.distance_ = up * plate.height;
  shape.outer_radius_ = plate.outer_radius;
  return shape;
}

Shape Shape::slipping(double friction, double travel, double arm) {
  Shape shape;
  shape.friction_ = friction;
  shape.travel_ = travel;
  shape.arm_ = arm;
  return shape;
}

Shape Shape::beside_plate() const {
  Shape shape = *this;
  shape.plate_takes_ = true;
  return shape;
}

Vector3d Shape::push(const Vector3d& r, const Vector3d& t) const {
  Vector3d drag = friction_ * (Vector3d::UnitZ() - travel_ * t).normalized();
  if (plate_takes_) drag.z() = 0.0;
  return outward(r) + drag;
}

double Shape::gap(const Vector3d& r) const {
  return normal_ ? distance_ + normal_->dot(r) : std::hypot(r.x(), r.y()) - 1.0;
}

Vector3d Shape::outward(const Vector3d& r) const {
  return normal_ ? *normal_ : Vector3d(r.x(), r.y(), 0.0).normalized();
}

double Shape::bend(const Vector3d& r, const Vector3d& t) const {
  if (normal_) return 0.0;
  const double rate = outward(r).dot(t);
  return (t.head<2>().squaredNorm() - rate * rate) / std::hypot(r.x(), r.y());
}

std::vector<Shape> shapes_of(const scene::Scene& scene, double travel) {
  if (scene.has_cylinder) {
    std::vector<Shape> shapes{Shape::slipping(scene.dragging_friction(), travel, scene.friction_arm())};
    if (scene.plate) shapes.push_back(Shape::of(*scene.plate));
    return shapes;
  }
  std::vector<Shape> shapes;
  for (const scene::Wall& wall : scene.walls) shapes.push_back(Shape::of(wall));
  return shapes;
}

}  // namespace windlass::verify
