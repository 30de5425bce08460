// The equations of a chain: balance at its joints, geometry of its arcs, gauges.
#include "windlass/chain/chain.hpp"

namespace windlass::chain {

using contact::Joint;
using contact::Side;
using contact::SmallVector;

VectorXd Chain::residual(const VectorXd& x, const Loads& loads) const {
  VectorXd f = VectorXd::Zero(size_);
  for (int i = 0; i < link_count(); ++i) {
    const Arc& arc = *links_[i].arc;
    const Placed p = place(x, loads, i);
    bvp::EndsVector& g = gradients_[i];
    arc.gradient(p.point(), f.data() + interior_row_[i], g);
    const int d = arc.tangent(), forces = arc.forces();
    const Eigen::Index left = numbering_.coordinate[i], right = numbering_.coordinate[i + 1];
    f.segment(left, p.left.dq.cols()) += p.left.dq.transpose() * g.head(d) - p.left.test().transpose() * p.n;
    f.segment(right, p.right.dq.cols()) += p.right.dq.transpose() * g.segment(d, d) +
                                           p.right.test().transpose() * force_at_end(x, loads, i, p.n, g);
    for (const Side side : {Side::right, Side::left})
      if (const auto drag = drag_at(x, loads, i, side))
        add_kept(drag->value, side == Side::right ? i : i + 1, f);
    if (links_[i].pull == 0)
      f.segment(numbering_.force[i], forces) = g.segment(2 * d, forces) + rise(x, p, i);
  }
  for (int j = 0; j < joint_count(); ++j) {
    add_kept(joints_[j]->dead_load(coordinates(x, j), pulled(x, loads, j)), j, f);
    if (numbering_.location[j] < 0 || coupling_of_[j] >= 0) continue;
    const Joint::Location c = location(x, j);
    f(numbering_.location[j]) = c.value;
    if (const auto lift = joints_[j]->lift(coordinates(x, j), loaded(x, loads, j)))
      f(numbering_.location[j]) += lift->value;
    if (const auto stretched = stretching(x, loads, j, c.side)) f(numbering_.location[j]) += stretched->value;
  }
  add_strand_forces(x, loads, f);
  add_dragged_pushes(x, loads, f);
  if (slide_at_ < 0) return f;
  f(numbering_.slide) = slides_ ? x(slide_at_ + 1) : -x(slide_at_);
  for (int j = 0; j < joint_count(); ++j) {
    const double share = slide_share(j);
    if (share == 0.0) continue;
    if (!slides_) f(numbering_.slide) += share * arclength(x, loads, j);
    if (gauges_.travel == Travel::none) f(numbering_.coordinate[j]) += share * x(slide_at_ + 1);
  }
  return f;
}

Loads Chain::pulled(const VectorXd& x, const Loads& loads, int joint) const {
  if (travel() != Travel::blocked) return loads;
  Loads out = loads;
  out.tension += (joint == 0 ? -1.0 : 1.0) * travelled(x);
  return out;
}

SmallVector Chain::force_at_end(const VectorXd& x, const Loads& loads, int link, const SmallVector& n,
                                const bvp::EndsVector& gradient) const {
  const Arc& arc = *links_[link].arc;
  if (arc.carried() > 0) return n + gradient.tail(arc.carried());
  return loads.weighs() ? SmallVector(n - length(x, loads, link) * weight_on(loads, link)) : n;
}

std::optional<Joint::Stretching> Chain::stretching(const VectorXd& x, const Loads& loads, int joint,
                                                   Side side) const {
  if (loads.compliance == 0.0) return std::nullopt;
  const SmallVector n = side == Side::right ? force(x, loads, joint) : end_force(x, loads, joint - 1);
  return joints_[joint]->stretching(coordinates(x, joint), n, loads.compliance);
}

std::optional<Joint::Drag> Chain::drag_at(const VectorXd& x, const Loads& loads, int link, Side side) const {
  if (gauges_.travel == Travel::none) return std::nullopt;
  const int d = links_[link].arc->tangent(), joint = side == Side::right ? link : link + 1;
  return joints_[joint]->drag(side, coordinates(x, joint), loaded(x, loads, joint),
                              gradients_[link].segment(side == Side::right ? 0 : d, d));
}

void Chain::add_kept(const SmallVector& by_w, int joint, VectorXd& f) const {
  for (std::size_t k = 0; k < kept_[joint].size(); ++k)
    f(numbering_.coordinate[joint] + static_cast<Eigen::Index>(k)) += by_w(kept_[joint][k]);
}

}  // namespace windlass::chain
