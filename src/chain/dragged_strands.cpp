// Strands that press on each other where a cylinder slips along one of them: what the point reaction drags.
#include "windlass/chain/chain.hpp"

namespace windlass::chain {

using contact::Joint;
using contact::SmallMatrix;
using contact::SmallVector;
using Eigen::Matrix3d;
using Eigen::Vector3d;

void Chain::add_dragged_pushes(const VectorXd& x, const Loads& loads, VectorXd& f) const {
  if (gauges_.travel == Travel::none) return;
  for (std::size_t k = 0; k < couplings_.size(); ++k) {
    const Crossing at = crossing(x, static_cast<int>(k));
    const double push = strand_force(x, static_cast<int>(k));
    for (const int joint : {at.coupling.first, at.coupling.second}) {
      const Vector3d force = -push * at.push_on(joint);
      if (const auto drag =
              joints_[joint]->drag_of_push(coordinates(x, joint), loaded(x, loads, joint), force))
        add_kept(drag->value, joint, f);
    }
  }
}

void Chain::add_dragged_pushes(const VectorXd& x, const Loads& loads, Block& dense) const {
  if (gauges_.travel == Travel::none) return;
  constexpr double h = 1e-5;  // smooth in ω, and a matter of a few numbers: by differences
  for (std::size_t k = 0; k < couplings_.size(); ++k) {
    const Crossing at = crossing(x, static_cast<int>(k));
    const Coupling& c = at.coupling;
    const double push = strand_force(x, static_cast<int>(k));
    const Matrix3d turn = (Matrix3d::Identity() - at.direction * at.direction.transpose()) / at.distance;
    for (const int joint : {c.first, c.second}) {
      const Vector3d way = at.push_on(joint);
      Loads here = loaded(x, loads, joint);
      const auto drag = joints_[joint]->drag_of_push(coordinates(x, joint), here, -push * way);
      if (!drag) continue;
      const Eigen::Index row = numbering_.coordinate[joint];
      const std::vector<int>& kept = kept_[joint];
      const auto add = [&](const SmallMatrix& by, Eigen::Index column, const std::vector<int>* columns) {
        const Eigen::Index count = columns ? static_cast<Eigen::Index>(columns->size()) : by.cols();
        for (std::size_t r = 0; r < kept.size(); ++r)
          for (Eigen::Index s = 0; s < count; ++s)
            dense(row + static_cast<Eigen::Index>(r), column + s) +=
                by(kept[r], columns ? (*columns)[static_cast<std::size_t>(s)] : s);
      };
      add(drag->by_w, row, &kept);
      // Of −λ e on the first, λ e on the second: both turn with D = r_first − r_second.
      const double side = joint == c.first ? -push : push;
      add(drag->by_gradient * (side * turn) * at.first.dr, numbering_.coordinate[c.first], &kept_[c.first]);
      add(drag->by_gradient * (-side * turn) * at.second.dr, numbering_.coordinate[c.second],
          &kept_[c.second]);
      add(drag->by_gradient * -way, numbering_.strand[k], nullptr);
      if (travel() != Travel::free) continue;
      const auto with = [&](double travel) {
        here.travel = travel;
        return joints_[joint]->drag_of_push(coordinates(x, joint), here, -push * way)->value;
      };
      const double travel = here.travel;
      const SmallVector above = with(travel + h), below = with(travel - h);
      add((above - below) / (2.0 * h), numbering_.slide, nullptr);
    }
  }
}

}  // namespace windlass::chain
