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

Chain::Turn Chain::turn_to_expect(const VectorXd& x, const Loads& loads) const {
  const bool mirrored = half() && !contact::reverses_height(*gauges_.symmetry);
  const bool about_x = (*neutral_turn_ == Parity::odd) != mirrored;
  Turn turn{about_x ? Vector3d::UnitX() : Vector3d::UnitY(), 0.0};
  for (const int j : {0, joint_count() - 1}) {
    if (joints_[j]->kind() != JointKind::end) continue;
    const Attachment end = attachment(Purpose::equilibrium, x, loads, j, j == 0 ? Side::right : Side::left);
    const bool cannot_spin = end.dq.cols() < 3;
    if (cannot_spin) turn.spin = -turn.axis.dot(rod::directors(Eigen::Vector4d(end.q)).col(2));
  }
  return turn;
}

VectorXd Chain::turn_of_joints(Purpose purpose, const Numbering& numbering, const VectorXd& x,
                               const Loads& loads, const Turn& turn) const {
  VectorXd motion = VectorXd::Zero(numbering.size);
  for (int j = 0; j < joint_count(); ++j) {
    const Attachment at = attachment(purpose, x, loads, j, j < link_count() ? Side::right : Side::left);
    const Eigen::Index count = at.dx.cols();
    if (count == 0) continue;
    MatrixXd by(6, count);
    VectorXd change(6);
    by << at.dq, at.dx;
    change << rod::turn_increment(at.q, turn.axis, turn.spin), turn.axis.cross(Vector3d(at.x));
    motion.segment(numbering.coordinate[j], count) = by.colPivHouseholderQr().solve(change);
  }
  for (int i = 0; i < link_count(); ++i)
    if (numbering.force[i] >= 0)
      motion.segment<3>(numbering.force[i]) = turn.axis.cross(Vector3d(force(x, loads, i)));
  return motion;
}

VectorXd Chain::neutral_turn(Purpose purpose, const Numbering& numbering, const VectorXd& x,
                             const Loads& loads, const Block& dense, Eigen::Index asked) const {
  if (dense.rows() == 0 || !may_turn(purpose == Purpose::odd ? Parity::odd : Parity::even, x, loads))
    return {};
  const Turn turn = turn_to_expect(x, loads);
  VectorXd motion = VectorXd::Zero(dense.rows());
  motion.head(numbering.size) = turn_of_joints(purpose, numbering, x, loads, turn);
  Eigen::Index row = numbering.size + asked;
  for (int i = 0; i < link_count(); ++i)
    for (const bvp::Held& held : links_[i].arc->held()) {
      const double* node = interior(x, i) + held.first / links_[i].arc->tangent() * links_[i].arc->ambient();
      const Vector3d moved =
          rod::turn_increment(Eigen::Map<const Eigen::Vector4d>(node), turn.axis, turn.spin);
      motion(row++) = -held.direction.dot(moved);
    }
  motion.normalize();
  VectorXd resisted = dense * motion;
  resisted.segment(numbering.size, asked).setZero();
  if (!(resisted.cwiseAbs().maxCoeff() < nearly_zero * usual_size(dense))) return {};
  return motion;
}

VectorXd Chain::nearly_neutral_turn(const VectorXd& x, const Loads& loads) const {
  constexpr double nearly = 0.1;  // out of the plane by a, the turn costs some a² of the usual
  if (!may_turn(Parity::even, x, loads, nearly)) return {};
  const Turn turn = turn_to_expect(x, loads);
  VectorXd motion = VectorXd::Zero(size_);
  motion.head(dense_size_) = turn_of_joints(Purpose::equilibrium, numbering_, x, loads, turn);
  for (int i = 0; i < link_count(); ++i)
    for (int k = 0; k < links_[i].arc->interior_nodes(); ++k)
      motion.segment<3>(interior_row_[i] + 3 * k) = rod::turn_increment(
          Eigen::Map<const Eigen::Vector4d>(interior(x, i) + 4 * k), turn.axis, turn.spin);
  return motion.normalized();
}

double usual_size(const Block& dense) { return median(dense.largest_rows()); }

void hold(Block& dense, const VectorXd& d, double by) {
  dense.block(0, 0, d.size(), d.size()) += by * d * d.transpose();
}

}  // namespace windlass::chain
