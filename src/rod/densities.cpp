#include "windlass/rod/extensible_density.hpp"
#include "windlass/rod/kirchhoff_density.hpp"
#include "windlass/rod/planar_density.hpp"
#include "windlass/rod/plane_density.hpp"
#include "windlass/rod/surface_density.hpp"

namespace windlass::rod {

namespace {

/// Right multiplication by the pure quaternion c: q ⊗ (0, c) = right_form(c)·q. Antisymmetric.
Eigen::Matrix4d right_form(const Eigen::Vector3d& c) {
  Eigen::Matrix4d b;
  b << 0.0, -c(0), -c(1), -c(2),  //
      c(0), 0.0, c(2), -c(1),     //
      c(1), -c(2), 0.0, c(0),     //
      c(2), c(1), -c(0), 0.0;
  return b;
}

}  // namespace

double KirchhoffDensity::first(const Quaternion& q, const Quaternion& slope, const Eigen::Vector3d& n,
                               Vector8& gz, Eigen::Vector3d& d) const {
  const double inverse = 1.0 / q.squaredNorm();
  const Eigen::Vector3d u = strain(q, slope), moment = stiffness.cwiseProduct(u - natural);
  const Quaternion bq = increments(q) * moment, bp = increments(slope) * moment, dq = direction_form(n) * q;
  const double g = 2.0 * slope.dot(bq) - q.dot(dq);
  d = direction(q);
  gz.head<4>() = inverse * (-2.0 * (bp + dq) - 2.0 * g * inverse * q);
  gz.tail<4>() = 2.0 * inverse * bq;
  return 0.5 * moment.dot(u - natural) - n.dot(d);
}

void KirchhoffDensity::second(const Quaternion& q, const Quaternion& slope, const Eigen::Vector3d& n,
                              Vector8& gz, Matrix8& hz, Eigen::Vector3d& d,
                              Eigen::Matrix<double, 3, 4>& dd) const {
  const double inverse = 1.0 / q.squaredNorm(), inverse2 = inverse * inverse;
  const Eigen::Matrix<double, 4, 3> tq = increments(q), tp = increments(slope);
  const Eigen::Vector3d u = 2.0 * inverse * (tq.transpose() * slope);
  const Eigen::Vector3d moment = stiffness.cwiseProduct(u - natural);
  const Eigen::Matrix4d form = direction_form(n);
  const Quaternion bq = tq * moment, bp = tp * moment, dq = form * q;
  const double g = 2.0 * slope.dot(bq) - q.dot(dq);
  const Quaternion gq = -2.0 * (bp + dq);
  d = direction(q);
  gz.head<4>() = inverse * gq - 2.0 * g * inverse2 * q;
  gz.tail<4>() = 2.0 * inverse * bq;

  Eigen::Matrix<double, 8, 3> du;  // ∇u_i
  du.topRows<4>() = -2.0 * inverse * (tp + q * u.transpose());
  du.bottomRows<4>() = 2.0 * inverse * tq;
  hz.noalias() = du * stiffness.asDiagonal() * du.transpose();
  hz.topLeftCorner<4, 4>() += -2.0 * inverse * form -
                              2.0 * inverse2 * (gq * q.transpose() + q * gq.transpose()) +
                              8.0 * g * inverse2 * inverse * q * q.transpose();
  hz.topLeftCorner<4, 4>().diagonal().array() -= 2.0 * g * inverse2;
  const Eigen::Matrix4d mixed = -2.0 * inverse * right_form(moment) - 4.0 * inverse2 * q * bq.transpose();
  // ∂²(2 q'·Bq)/∂q∂q' = 2Bᵀ = −2B, rows q, columns q'.
  hz.topRightCorner<4, 4>() += mixed;
  hz.bottomLeftCorner<4, 4>() += mixed.transpose();

  dd.row(0) = direction_form(Eigen::Vector3d::UnitX()) * q;
  dd.row(1) = direction_form(Eigen::Vector3d::UnitY()) * q;
  dd.row(2) = direction_form(Eigen::Vector3d::UnitZ()) * q;
  dd = 2.0 * inverse * (dd - d * q.transpose()).eval();
}

}  // namespace windlass::rod

namespace windlass::bvp {

template class LagrangianOf<rod::PlanarDensity>;
template class LagrangianOf<rod::SurfaceDensity>;
template class LagrangianOf<rod::PlaneDensity>;
template class LagrangianOf<rod::KirchhoffDensity>;
template class LagrangianOf<rod::Extensible<rod::PlanarDensity>>;
template class LagrangianOf<rod::Extensible<rod::SurfaceDensity>>;
template class LagrangianOf<rod::Extensible<rod::PlaneDensity>>;
template class LagrangianOf<rod::Extensible<rod::KirchhoffDensity>>;

}  // namespace windlass::bvp
