#include <algorithm>

#include "neutral_turn.hpp"
#include "windlass/chain/chain.hpp"
#include "windlass/chain/frontal_inertia.hpp"

namespace windlass::chain {

using contact::JointKind;
using contact::Parity;

bool Chain::neutral(const VectorXd& x, const Loads& loads, int link) const {
  constexpr double free_of_moment =
      1e-5;  // of √(B n), what a quarter of a wave carries, times the slope's size 1
  for (const int end : {link, link + 1}) {
    if (!joints_[end]->fixed_in_variations().empty()) return true;
    const int other = end == link ? link + 1 : link, d = links_[link].arc->tangent();
    if (joints_[end]->kind() != JointKind::end || joints_[other]->kind() != JointKind::touch) continue;
    const contact::Side side = end == link ? contact::Side::right : contact::Side::left;
    const bool clamped = joints_[end]->attach(side, coordinates(x, end), loads).dq.isZero(0.0);
    // A long tail has no moment at its clamp either, but one at its touch.
    const auto moments = gradients_[link].head(2 * d);
    if (clamped && moments.norm() < free_of_moment * std::sqrt(force(x, loads, link).norm())) return true;
  }
  return false;
}

std::unique_ptr<Arc> Chain::shortened(const VectorXd& x, const Loads& loads, int link,
                                      bvp::EndsMatrix& condensed) const {
  std::unique_ptr<Arc> arc = links_[link].arc->remeshed(links_[link].arc->mesh(), links_[link].arc->stages());
  const Placed placed = place(x, loads, link);
  bvp::ArcPoint point = placed.point();
  point.length *= 1.0 - shortened_by;
  arc->factor(point, condensed);
  return arc;
}

double Chain::neutral_size(const VectorXd& x, const Loads& loads) const {
  double largest = 0.0;
  for (int i = 0; i < link_count(); ++i)
    if (neutral(x, loads, i)) largest = std::max(largest, 4.0 * shortened_by * force(x, loads, i).norm());
  return largest;
}

void Chain::add_gauges(const Numbering& numbering, Purpose purpose, const VectorXd& x, Block& dense) const {
  for (int j = 0; j < joint_count(); ++j) {
    const double share = slide_share(j);
    if (share == 0.0) continue;
    const Eigen::Index first = numbering.coordinate[j], s = numbering.location[j];
    const std::vector<int>& kept = this->kept(purpose, j);
    const auto hold = [&](Eigen::Index row, int coordinate, double weight) {
      if (row < 0) return;
      const auto at = first + (std::find(kept.begin(), kept.end(), coordinate) - kept.begin());
      dense(row, at) = dense(at, row) = weight;
    };
    // The material of the outermost contacts stays: mean of δa/a' − δs.
    if (gauges_.slide) hold(numbering.slide, 0, share / joints_[j]->slide(coordinates(x, j)));
    if (s >= 0 && numbering.slide >= 0 && gauges_.slide)
      dense(numbering.slide, s) = dense(s, numbering.slide) = -share;
    hold(numbering.height, joints_[j]->height_coordinate(), share);
    // A frame's increment is half the angle.
    const bool edge = joints_[j]->kind() == JointKind::edge;
    hold(numbering.spin, joints_[j]->spin_coordinate(), edge ? share : 2.0 * share);
  }
  if (numbering.phase >= 0) dense(numbering.phase, numbering.phase) = -1.0;
}

Block Chain::variation_matrix(Purpose purpose, const Numbering& numbering, const VectorXd& x,
                              const Loads& loads) const {
  Block dense(numbering.size);
  for (int i = 0; i < link_count(); ++i)
    add_joint_terms(purpose, numbering, x, loads, i, gradients_[i], dense);
  add_gauges(numbering, purpose, x, dense);
  add_couplings(purpose, numbering, x, dense);
  // A touch costs −½ F g'' δs² as it shifts: it is where the gap is least. One that carries nothing, as where it opens, costs
  // nothing, and its sign would be rounding's.
  constexpr double nothing = 1e-7, stiff = 1e3;  // [EI/ρ²], [EI/ρ³]
  for (int j = 0; j < joint_count(); ++j) {
    const Eigen::Index row = numbering.location[j];
    if (row < 0 || row == numbering.together || shares_place(j) || !(touch_force(x, loads, j) < nothing))
      continue;
    // One of a line may pull with what opens the strands by no height: it stays where it is.
    dense(row, row) -= along_strand(j) ? stiff : nothing;
  }
  return dense;
}

MatrixXd Chain::condensed_share(Purpose purpose, const Local& local, const Arc& arc,
                                const bvp::EndsMatrix& condensed, int link) const {
  bvp::EndsMatrix hessian = with_commutator(arc, condensed, gradients_[link]);
  // Odd variations at a symmetry point: the other half carries the opposite moment, the commutators cancel.
  if (purpose == Purpose::odd && link == 0 && arc.ambient() == 4)
    hessian.block(0, 0, 3, 3) = condensed.block(0, 0, 3, 3);
  return local.columns.transpose() * hessian * local.columns;
}

std::vector<Chain::Border> Chain::add_borders(const Arc& arc, const Local& local,
                                              const std::vector<Coupled>& coupled, Block& dense) {
  std::vector<Border> borders;
  for (const Coupled& coupling : coupled) {
    Border border{coupling.row, coupling.along, coupling.along};
    bvp::EndsVector ends = bvp::EndsVector::Zero(arc.ends());
    arc.reduce(border.reduced.data(), ends);
    border.solved = border.reduced;
    arc.expand(border.solved.data(), bvp::EndsVector::Zero(arc.ends()));
    const VectorXd column = local.columns.transpose() * ends;
    for (std::size_t r = 0; r < local.dofs.size(); ++r) {
      dense(local.dofs[r], border.row) += column(r);
      dense(border.row, local.dofs[r]) += column(r);
    }
    for (const Coupled& other : coupled) dense(other.row, border.row) -= other.along.dot(border.solved);
    borders.push_back(std::move(border));
  }
  return borders;
}

std::vector<Chain::Coupled> Chain::held_by(const Arc& arc, Block& dense) {
  std::vector<Coupled> out;
  for (const bvp::Held& held : arc.held()) {
    const Eigen::Index row = dense.rows();
    out.push_back({row, VectorXd::Zero(arc.interior_tangent())});
    out.back().along.segment(held.first, held.direction.size()) = held.direction;
    dense.grow();
    dense(row, row) = 1.0;
  }
  return out;
}

std::vector<const Arc*> Chain::arcs() const {
  std::vector<const Arc*> out;
  for (const Link& link : links_) out.push_back(link.arc.get());
  return out;
}

Block Chain::condensed_variation(Purpose purpose, const Numbering& numbering, const VectorXd& x,
                                 const Loads& loads, const std::vector<const Arc*>& arcs,
                                 const std::vector<bvp::EndsMatrix>& condensed) const {
  Block dense = variation_matrix(purpose, numbering, x, loads);
  const VectorXd motion = numbering.phase >= 0 ? phase_motion(purpose, numbering, x, loads) : VectorXd();
  const VectorXd slid = holds_knot(numbering) ? slid_by(purpose, numbering, x, loads) : VectorXd();
  for (Eigen::Index k = 0; k < numbering.size && slid.size() > 0; ++k)
    dense(numbering.slide, k) = dense(k, numbering.slide) = slid(k);
  for (int i = 0; i < link_count(); ++i) {
    const Arc& arc = *arcs[i];
    const Local l = local(purpose, numbering, x, loads, i);
    const MatrixXd share = condensed_share(purpose, l, arc, condensed[i], i);
    for (std::size_t r = 0; r < l.dofs.size(); ++r)
      for (std::size_t s = 0; s < l.dofs.size(); ++s) dense(l.dofs[r], l.dofs[s]) += share(r, s);
    std::vector<Coupled> coupled = held_by(arc, dense);
    const auto inside = [&](const VectorXd& all) {
      return all.segment(interior_row_[i] + numbering.size - dense_size_, arc.interior_tangent());
    };
    if (numbering.phase >= 0 && arc.interior_nodes() > 0)
      coupled.push_back({numbering.phase, inside(motion)});
    if (slid.size() > 0 && arc.interior_nodes() > 0) coupled.push_back({numbering.slide, inside(slid)});
    add_borders(arc, l, coupled, dense);
  }
  dense.symmetrise();
  return dense;
}

Chain::Inertia Chain::inertia(const VectorXd& x, const Loads& loads, Parity parity) const {
  if (parity == Parity::odd && !half()) return {};
  const Purpose purpose = parity == Parity::odd ? Purpose::odd : Purpose::even;
  const Numbering numbering = number(purpose);
  std::vector<const Arc*> arcs = this->arcs();
  std::vector<bvp::EndsMatrix> condensed = condensed_;
  std::vector<std::unique_ptr<Arc>> replaced;
  int negative = -numbering.constraints;
  for (int i = 0; i < link_count(); ++i) {
    if (neutral(x, loads, i)) {
      replaced.push_back(shortened(x, loads, i, condensed[i]));
      arcs[i] = replaced.back().get();
    }
    negative += arcs[i]->negative_pivots();
  }
  Block dense = condensed_variation(purpose, numbering, x, loads, arcs, condensed);
  const VectorXd turn = neutral_turn(purpose, numbering, x, loads, dense);
  if (turn.size() > 0) hold(dense, turn, usual_size(dense));
  constexpr double close_to_rounding = 1e-9;  // of the largest entry
  const PivotSigns signs = pivot_signs(dense);
  const bool near = replaced.empty() && dense.rows() > 0 && signs.least < close_to_rounding * dense.largest();
  return {negative + signs.negative, near};
}

}  // namespace windlass::chain
