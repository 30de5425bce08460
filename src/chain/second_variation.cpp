#include <algorithm>

#include "windlass/chain/chain.hpp"

namespace windlass::chain {

using contact::Parity;
using contact::Side;
using contact::SmallMatrix;
using contact::SmallVector;
using Sparse = Eigen::SparseMatrix<double>;
using Triplet = Eigen::Triplet<double>;

namespace {

/// What the arcs of a chain add up to, in time that grows with their entries: summed one by one, matrices would be copied for each.
class SparseSum {
 public:
  explicit SparseSum(Eigen::Index size) : size_(size) {}
  void operator+=(const Sparse& more) {
    for (Eigen::Index c = 0; c < more.outerSize(); ++c)
      for (Sparse::InnerIterator at(more, c); at; ++at) entries_.emplace_back(at.row(), c, at.value());
  }
  Sparse sum() const {
    Sparse out(size_, size_);
    out.setFromTriplets(entries_.begin(), entries_.end());
    return out;
  }

 private:
  Eigen::Index size_;
  std::vector<Triplet> entries_;
};

}  // namespace

Sparse Chain::scatter(const MatrixXd& ends, const Local& local, Eigen::Index dense, int link) const {
  const Eigen::Index interior = links_[link].arc->interior_tangent(), shift = dense - dense_size_;
  std::vector<Triplet> entries;
  for (Eigen::Index k = 0; k < interior; ++k) entries.emplace_back(k, interior_row_[link] + shift + k, 1.0);
  for (Eigen::Index e = 0; e < ends.rows(); ++e)
    for (Eigen::Index c = 0; c < ends.cols(); ++c)
      if (ends(e, c) != 0.0) entries.emplace_back(interior + e, local.dofs[c], ends(e, c));
  Sparse map(interior + ends.rows(), size_ + shift);
  map.setFromTriplets(entries.begin(), entries.end());
  return map;
}

Sparse Chain::sparse_hessian(Purpose purpose, const Placed& placed, int link) const {
  const Arc& arc = *links_[link].arc;
  std::vector<Triplet> entries;
  arc.hessian(placed.point(), entries);
  const int interior = arc.interior_tangent(), ends = arc.ends();
  bvp::EndsMatrix commutator = with_commutator(arc, bvp::EndsMatrix::Zero(ends, ends), gradients_[link]);
  // Odd variations at a symmetry point: the other half carries the opposite moment, the commutators cancel.
  if (purpose == Purpose::odd && link == 0 && arc.ambient() == 4) commutator.topLeftCorner(3, 3).setZero();
  for (int i = 0; i < ends; ++i)
    for (int j = 0; j < ends; ++j)
      if (commutator(i, j) != 0.0) entries.emplace_back(interior + i, interior + j, commutator(i, j));
  Sparse h(interior + ends, interior + ends);
  h.setFromTriplets(entries.begin(), entries.end());
  return h;
}

Chain::SecondVariation Chain::second_variation(const VectorXd& x, const Loads& loads, Parity parity) const {
  const Purpose purpose = parity == Parity::odd && half() ? Purpose::odd : Purpose::even;
  residual(x, loads);  // leaves the arcs' gradients
  const Numbering numbering = number(purpose);
  const Eigen::Index total = size_ - dense_size_ + numbering.size;
  SecondVariation out;
  out.constraints = numbering.constraints;
  SparseSum matrix(total), metric(total);
  const Block dense = variation_matrix(purpose, numbering, x, loads);
  for (int i = 0; i < link_count(); ++i) {
    const Placed placed = place(x, loads, i);
    const Local l = local(purpose, numbering, x, loads, i);
    const Sparse map = scatter(l.columns, l, numbering.size, i);
    matrix += Sparse(map.transpose() * sparse_hessian(purpose, placed, i) * map);
    metric += material_metric(numbering, placed, map, i);
  }
  out.matrix = matrix.sum(), out.metric = metric.sum();
  std::vector<Triplet> entries = dense.entries();
  if (holds_knot(numbering)) {
    const VectorXd slid = slid_by(purpose, numbering, x, loads);
    for (Eigen::Index k = 0; k < total; ++k) {
      if (slid(k) == 0.0) continue;
      entries.emplace_back(k, numbering.slide, slid(k));
      entries.emplace_back(numbering.slide, k, slid(k));
    }
  }
  if (numbering.phase >= 0) {
    // K + τ M g gᵀ M, g of unit size: moves the phase out of the way and, as K g = 0, leaves all other eigenvectors as
    // they are. A straight rod has no such motion.
    constexpr double straight = 1e-6;  // [rad √length]
    VectorXd motion = phase_motion(purpose, numbering, x, loads);
    const double size = std::sqrt(motion.dot(out.metric * motion));
    const double stiffest = out.matrix.diagonal().cwiseAbs().maxCoeff();
    motion = size > straight ? VectorXd(out.metric * motion * (std::sqrt(stiffest) / size))
                             : VectorXd(VectorXd::Zero(total));
    for (Eigen::Index k = 0; k < total; ++k) {
      if (motion(k) == 0.0) continue;
      entries.emplace_back(k, numbering.phase, motion(k));
      entries.emplace_back(numbering.phase, k, motion(k));
    }
  }
  Sparse joints(total, total);
  joints.setFromTriplets(entries.begin(), entries.end());
  out.matrix += joints;
  out.matrix = Sparse(0.5 * (out.matrix + Sparse(out.matrix.transpose())));
  return out;
}

/// ∫ |δq at fixed material point|² ds. Where a touch moves along the rod by δs, the arc's samples move with it, and the
/// variation of the material there is δq − q' δs; a mere shift of the touch then has no weight, as it has no shape.
Sparse Chain::material_metric(const Numbering& numbering, const Placed& placed, const Sparse& map,
                              int link) const {
  const Arc& arc = *links_[link].arc;
  const VectorXd mass = arc.metric(placed.point());
  Sparse material = map;
  const Eigen::Index left = numbering.location[link], right = numbering.location[link + 1];
  const bvp::ArcSamples samples = left >= 0 || right >= 0 ? arc.sample(placed.point()) : bvp::ArcSamples{};
  if (samples.slope.size() > 0) {
    const int d = arc.tangent(), interior = arc.interior_tangent();
    std::vector<Triplet> shift;
    for (Eigen::Index k = 0; k < samples.sigma.size(); ++k) {
      const bool first = k == 0, last = k + 1 == samples.sigma.size();
      const Eigen::Index row = first ? interior : last ? interior + d : (k - 1) * d;
      for (int i = 0; i < d; ++i) {
        if (left >= 0) shift.emplace_back(row + i, left, -(1.0 - samples.sigma(k)) * samples.slope(i, k));
        if (right >= 0) shift.emplace_back(row + i, right, -samples.sigma(k) * samples.slope(i, k));
      }
    }
    Sparse moved(map.rows(), map.cols());
    moved.setFromTriplets(shift.begin(), shift.end());
    material += moved;
  }
  return Sparse(material.transpose() * mass.asDiagonal() * material);
}

/// What does work on the difference of the pulls T ± τ: by how much more one end comes along its pull than the other. The
/// conjugate of τ's column: with another row in its place K v = λ M v has a λ that goes through infinity.
VectorXd Chain::held_at_ends(const VectorXd& x, const Loads& loads) const {
  VectorXd row = VectorXd::Zero(size_);
  for (int i = 0; i < link_count(); ++i) {
    if (links_[i].pull == 0) continue;
    const Arc& arc = *links_[i].arc;
    const SmallVector by_travel = force_by_travel(loads, i);
    const Local l = local(Purpose::equilibrium, numbering_, x, loads, i);
    VectorXd along = VectorXd::Zero(arc.interior_tangent() + arc.ends());
    along.segment(arc.interior_tangent() + 2 * arc.tangent(), arc.forces()) = by_travel;
    row += scatter(l.columns, l, dense_size_, i).transpose() *
           VectorXd(sparse_hessian(Purpose::equilibrium, place(x, loads, i), i) * along);
    for (const Side side : {Side::right, Side::left}) {
      const int joint = side == Side::right ? i : i + 1;
      const SmallMatrix dx = attachment(Purpose::equilibrium, x, loads, joint, side).dx;
      row.segment(numbering_.coordinate[joint], dx.cols()) +=
          (side == Side::right ? -1.0 : 1.0) * dx.transpose() * by_travel;
    }
  }
  for (const int j : {0, joint_count() - 1}) {
    const SmallVector pulled = by_pull(x, loads, j);
    for (std::size_t k = 0; k < kept_[j].size(); ++k)
      row(numbering_.coordinate[j] + static_cast<Eigen::Index>(k)) += pulled(kept_[j][k]);
  }
  return row;
}

/// Not the arclength of the outermost contacts, but what moves past them.
VectorXd Chain::held_at_contacts(const VectorXd& x) const {
  VectorXd row = VectorXd::Zero(size_);
  for (int j = 0; j < joint_count() && slide_row() >= 0; ++j) {
    const double share = slide_share(j);
    if (share == 0.0) continue;
    row(numbering_.coordinate[j]) += share;
    if (numbering_.location[j] >= 0)
      row(numbering_.location[j]) -= share * joints_[j]->slide(coordinates(x, j));
  }
  return row;
}

Chain::DraggedVariation Chain::dragged_variation(const VectorXd& x, const Loads& loads) const {
  // A line may as well end a little earlier or later: its edge moves nothing to first order, and stays.
  Numbering numbering = numbering_;
  std::vector<Eigen::Index> place(size_, 0);
  for (int j = 0; j < joint_count(); ++j) {
    if (joints_[j]->kind() != contact::JointKind::edge || numbering.location[j] < 0) continue;
    place[numbering.location[j]] = -1;
    numbering.location[j] = -1;
  }
  Eigen::Index count = 0;
  for (Eigen::Index& at : place)
    if (at >= 0) at = count++;
  const Sparse matrix = jacobian(x, loads);  // first: joints take their drag from the gradients it leaves
  SparseSum sum(size_);
  for (int i = 0; i < link_count(); ++i) {
    const Local l = local(Purpose::equilibrium, numbering_, x, loads, i);
    sum += material_metric(numbering, this->place(x, loads, i), scatter(l.columns, l, dense_size_, i), i);
  }
  Sparse metric = sum.sum();
  const auto kept = [&](const Sparse& all, std::vector<Triplet> entries) {
    for (Eigen::Index c = 0; c < all.outerSize(); ++c)
      for (Sparse::InnerIterator at(all, c); at; ++at)
        if (place[at.row()] >= 0 && place[c] >= 0 && at.row() != slide_row())
          entries.emplace_back(place[at.row()], place[c], at.value());
    Sparse out(count, count);
    out.setFromTriplets(entries.begin(), entries.end());
    return out;
  };
  std::vector<Triplet> held;
  const VectorXd row = travel() == Travel::blocked ? held_at_ends(x, loads) : held_at_contacts(x);
  for (Eigen::Index k = 0; k < size_ && slide_row() >= 0; ++k)
    if (place[k] >= 0 && row(k) != 0.0) held.emplace_back(place[slide_row()], place[k], row(k));
  // The row of a place is a condition of contact, tangency, which holds in all motions: no inertia is in it.
  std::vector<bool> geometric(static_cast<std::size_t>(size_), false);
  for (int j = 0; j < joint_count(); ++j)
    if (numbering.location[j] >= 0) geometric[static_cast<std::size_t>(numbering.location[j])] = true;
  metric.prune(
      [&](Eigen::Index row, Eigen::Index, double) { return !geometric[static_cast<std::size_t>(row)]; });
  return {kept(matrix, held), kept(metric, {})};
}

VectorXd Chain::as_increment(const VectorXd& variation, Parity parity) const {
  const Purpose purpose = parity == Parity::odd && half() ? Purpose::odd : Purpose::even;
  const Numbering numbering = number(purpose);
  VectorXd dx = VectorXd::Zero(size_);
  for (int j = parity == Parity::odd && half() ? 1 : 0; j < joint_count(); ++j) {
    const std::vector<int>& varied = kept(purpose, j);
    for (std::size_t k = 0; k < kept_[j].size(); ++k) {
      const auto found = std::find(varied.begin(), varied.end(), kept_[j][k]);
      if (found == varied.end()) continue;
      const auto at = found - varied.begin();
      dx(numbering_.coordinate[j] + static_cast<Eigen::Index>(k)) = variation(numbering.coordinate[j] + at);
    }
  }
  dx.tail(size_ - dense_size_) = variation.tail(size_ - dense_size_);
  return dx;
}

Sparse Chain::jacobian(const VectorXd& x, const Loads& loads) const {
  residual(x, loads);
  SparseSum out(size_);
  Block dense(dense_size_);
  for (int i = 0; i < link_count(); ++i) {
    const Local l = local(Purpose::equilibrium, numbering_, x, loads, i);
    const Sparse columns = scatter(l.columns, l, dense_size_, i), rows = scatter(l.rows, l, dense_size_, i);
    out += Sparse(rows.transpose() * sparse_hessian(Purpose::equilibrium, place(x, loads, i), i) * columns);
    add_joint_terms(Purpose::equilibrium, numbering_, x, loads, i, gradients_[i], dense);
  }
  add_locations(x, loads, dense);
  add_couplings(Purpose::equilibrium, numbering_, x, dense);
  add_dragged_pushes(x, loads, dense);
  const std::vector<Triplet> entries = dense.entries();
  Sparse joints(size_, size_);
  joints.setFromTriplets(entries.begin(), entries.end());
  return out.sum() + joints;
}

}  // namespace windlass::chain
