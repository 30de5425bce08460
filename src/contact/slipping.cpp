#include "slipping.hpp"

namespace windlass::contact::spatial {

using Eigen::Vector2d;
using Eigen::Vector3d;

SmallMatrix slipping(const SmallMatrix& along, const obstacle::Chart& here, double friction,
                     const Vector2d& d) {
  SmallMatrix tested = along;
  tested.leftCols<2>() -= friction * here.normal * d.transpose();
  return tested;
}

void add_slipping(const obstacle::Chart& here, double friction, const Vector2d& d, const SlipSlope& by_w,
                  const SmallVector& f, SmallMatrix& out) {
  const Vector3d force = f;
  out.topRows<2>() -= friction * here.normal.dot(force) * by_w;
  out.topLeftCorner<2, 2>() -= friction * d * here.normal_slope(force).transpose();
}

TouchSlip slip_at(const obstacle::Chart& here, const Eigen::Matrix3d& directors, double travel) {
  const Vector3d v = Vector3d::UnitZ() - travel * directors.col(2);
  const double size = v.norm();
  const Vector3d d = v / size;
  Eigen::Matrix3d turned;  // of the tangent, with increments of half the angle
  turned << -2.0 * directors.col(1), 2.0 * directors.col(0), Vector3d::Zero();
  TouchSlip out;
  out.d = here.tangents.transpose() * d;
  out.by_w.setZero(2, 5);
  out.by_w.leftCols<2>() = here.second(d);
  out.by_w.rightCols<3>() = here.tangents.transpose() * (Eigen::Matrix3d::Identity() - d * d.transpose()) *
                            (-travel / size) * turned;
  out.direction = d;
  out.direction_by_v = (Eigen::Matrix3d::Identity() - d * d.transpose()) * (-travel / size) * turned;
  return out;
}

void add_couple(const obstacle::Chart& here, double friction, double arm, const Eigen::Matrix3d& directors,
                const TouchSlip& slip, SmallMatrix& tested) {
  const Vector3d axis = here.normal.cross(slip.direction);
  tested.rightCols<3>() += 2.0 * friction * arm * here.normal * (directors.transpose() * axis).transpose();
}

void add_couple_slope(const obstacle::Chart& here, double friction, double arm,
                      const Eigen::Matrix3d& directors, const TouchSlip& slip, const SmallVector& f,
                      SmallMatrix& out) {
  const Vector3d force = f, axis = here.normal.cross(slip.direction), turned = directors.transpose() * axis;
  const Eigen::Matrix<double, 3, 2> normal_by_u = here.tangents * here.bend;
  const double size = 2.0 * friction * arm, pressed = here.normal.dot(force);
  out.bottomLeftCorner<3, 2>() += size * turned * here.normal_slope(force).transpose();
  for (int i = 0; i < 2; ++i)
    out.block<3, 1>(2, i) +=
        size * pressed * directors.transpose() * normal_by_u.col(i).cross(slip.direction);
  for (int i = 0; i < 3; ++i) {  // the directors turn with the increments, too
    out.block<3, 1>(2, 2 + i) +=
        size * pressed * directors.transpose() * here.normal.cross(slip.direction_by_v.col(i));
    out.block<3, 1>(2, 2 + i) -= 2.0 * size * pressed * Vector3d(Vector3d::Unit(i).cross(turned));
  }
}

}  // namespace windlass::contact::spatial
