#include "neutral_turn.hpp"

#include <algorithm>
#include <cmath>

#include "windlass/chain/chain.hpp"
#include "windlass/rod/quaternion.hpp"

namespace windlass::chain {

using contact::Attachment;
using contact::JointKind;
using contact::Parity;
using contact::Side;
using Eigen::Vector3d;

double median(VectorXd values) {
  const auto middle = values.begin() + values.size() / 2;
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

namespace {

/// Of a frame, in body components, as half the angle; see rod::turn_increment.
Vector3d increment(const rod::Quaternion& q, const Vector3d& turn, double spin) {
  return 0.5 * (rod::directors(q).transpose() * turn + spin * Vector3d::UnitZ());
}

}  // namespace

double Chain::spin_at_clamps(const VectorXd& x, const Loads& loads, const Vector3d& turn) const {
  for (const int j : {0, joint_count() - 1}) {
    if (joints_[j]->kind() != JointKind::end) continue;
    const Attachment end = attachment(Purpose::equilibrium, x, loads, j, j == 0 ? Side::right : Side::left);
    if (end.dq.isZero(0.0)) return -turn.dot(rod::directors(Eigen::Vector4d(end.q)).col(2));
  }
  return 0.0;
}

VectorXd Chain::turn_of_joints(Purpose purpose, const Numbering& numbering, const VectorXd& x,
                               const Loads& loads, const Vector3d& turn, double spin) const {
  VectorXd motion = VectorXd::Zero(numbering.size);
  for (int j = 0; j < joint_count(); ++j) {
    const Attachment at = attachment(purpose, x, loads, j, j < link_count() ? Side::right : Side::left);
    const Eigen::Index count = at.dx.cols();
    if (count == 0) continue;
    MatrixXd by(6, count);
    Eigen::Matrix<double, 6, 1> change;
    by << at.dq, at.dx;
    change << increment(at.q, turn, spin), turn.cross(Vector3d(at.x));
    motion.segment(numbering.coordinate[j], count) = by.colPivHouseholderQr().solve(change);
  }
  for (int i = 0; i < link_count(); ++i)
    if (numbering.force[i] >= 0)
      motion.segment<3>(numbering.force[i]) = turn.cross(Vector3d(force(x, loads, i)));
  return motion;
}

VectorXd Chain::neutral_turn(Purpose purpose, const Numbering& numbering, const VectorXd& x,
                             const Loads& loads, const MatrixXd& dense, Eigen::Index asked) const {
  if (dense.rows() == 0 || !may_turn(purpose == Purpose::odd ? Parity::odd : Parity::even, x, loads))
    return {};
  const Vector3d turn = *neutral_turn_ == Parity::odd ? Vector3d::UnitX() : Vector3d::UnitY();
  const double spin = spin_at_clamps(x, loads, turn);
  VectorXd motion = VectorXd::Zero(dense.rows());
  motion.head(numbering.size) = turn_of_joints(purpose, numbering, x, loads, turn, spin);
  Eigen::Index row = numbering.size + asked;
  for (int i = 0; i < link_count(); ++i)
    for (const bvp::Held& held : links_[i].arc->held()) {
      const double* node = interior(x, i) + held.first / links_[i].arc->tangent() * links_[i].arc->ambient();
      const Vector3d moved = increment(Eigen::Map<const Eigen::Vector4d>(node), turn, spin);
      motion(row++) = -held.direction.dot(moved);
    }
  motion.normalize();
  VectorXd resisted = dense * motion;
  resisted.segment(numbering.size, asked).setZero();
  if (!(resisted.cwiseAbs().maxCoeff() < nearly_zero * usual_size(dense))) return {};
  return motion;
}

double usual_size(const MatrixXd& dense) { return median(dense.cwiseAbs().rowwise().maxCoeff()); }

}  // namespace windlass::chain
