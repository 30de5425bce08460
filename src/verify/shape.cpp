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

std::vector<Shape> shapes_of(const scene::Scene& scene) {
  if (scene.has_cylinder) return {Shape::cylinder()};
  std::vector<Shape> shapes;
  for (const scene::Wall& wall : scene.walls) shapes.push_back(Shape::of(wall));
  return shapes;
}

}  // namespace windlass::verify
