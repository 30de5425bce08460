#include <algorithm>

#include "neutral_turn.hpp"
#include "symmetric_factors.hpp"
#include "windlass/chain/chain.hpp"

namespace windlass::chain {

using contact::JointKind;
using contact::Parity;

namespace {

/// Number of eigenvalues below zero of a symmetric matrix where as many eigenvalues as `neutral` are zero but for rounding, which do not count.
int negative_but_neutral(const MatrixXd& dense, int neutral) {
  constexpr double rounding =
      1e-7;  // of the middle one: states are good to 1e-10, and the arcs' own singularity adds to it
  VectorXd values = Eigen::SelfAdjointEigenSolver<MatrixXd>(dense, Eigen::EigenvaluesOnly).eigenvalues();
  std::sort(values.begin(), values.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
  // An arc that is singular by itself leaves an entry as large as 1e10, and its rounding to the others.
  const double zero =
      rounding * std::abs(values(values.size() / 2)) + 1e-14 * std::abs(values(values.size() - 1));
  int negative = 0;
  for (Eigen::Index k = 0; k < values.size(); ++k) negative += values(k) < (k < neutral ? -zero : 0.0);
  return negative;
}

}  // namespace

void Chain::add_gauges(const Numbering& numbering, Purpose purpose, const VectorXd& x,
                       MatrixXd& dense) const {
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
    hold(numbering.slide, 0, share / joints_[j]->slide(coordinates(x, j)));
    if (s >= 0 && numbering.slide >= 0) dense(numbering.slide, s) = dense(s, numbering.slide) = -share;
    hold(numbering.height, joints_[j]->height_coordinate(), share);
    // A frame's increment is half the angle.
    const bool edge = joints_[j]->kind() == JointKind::edge;
    hold(numbering.spin, joints_[j]->spin_coordinate(), edge ? share : 2.0 * share);
  }
  if (numbering.phase >= 0) dense(numbering.phase, numbering.phase) = -1.0;
}

MatrixXd Chain::variation_matrix(Purpose purpose, const Numbering& numbering, const VectorXd& x,
                                 const Loads& loads) const {
  MatrixXd dense = MatrixXd::Zero(numbering.size, numbering.size);
  for (int i = 0; i < link_count(); ++i)
    add_joint_terms(purpose, numbering, x, loads, i, gradients_[i], dense);
  add_gauges(numbering, purpose, x, dense);
  // A touch costs −½ F g'' δs² as it shifts: it is where the gap is least. One that carries nothing, as where it opens, costs
  // nothing, and its sign would be rounding's.
  constexpr double nothing = 1e-7;  // [EI/ρ²], [EI/ρ³]
  for (int j = 0; j < joint_count(); ++j) {
    const Eigen::Index row = numbering.location[j];
    if (row < 0) continue;
    const VectorXd normal = joints_[j]->chart(coordinates(x, j)).normal;
    VectorXd jump = -force(x, loads, j);
    if (j > 0) jump += force(x, loads, j - 1);
    const double carried = jump.dot(normal.head(jump.size()));
    if (carried < nothing) dense(row, row) -= nothing;
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
                                              const std::vector<Coupled>& coupled, MatrixXd& dense) {
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

std::vector<Chain::Coupled> Chain::held_by(const Arc& arc, MatrixXd& dense) {
  std::vector<Coupled> out;
  for (const bvp::Held& held : arc.held()) {
    const Eigen::Index row = dense.rows();
    out.push_back({row, VectorXd::Zero(arc.interior_tangent())});
    out.back().along.segment(held.first, held.direction.size()) = held.direction;
    dense.conservativeResize(row + 1, row + 1);
    dense.row(row).setZero();
    dense.col(row).setZero();
    dense(row, row) = 1.0;
  }
  return out;
}

MatrixXd Chain::condensed_variation(Purpose purpose, const Numbering& numbering, const VectorXd& x,
                                    const Loads& loads) const {
  MatrixXd dense = variation_matrix(purpose, numbering, x, loads);
  const VectorXd motion = numbering.phase >= 0 ? phase_motion(purpose, numbering, x, loads) : VectorXd();
  for (int i = 0; i < link_count(); ++i) {
    const Arc& arc = *links_[i].arc;
    const Local l = local(purpose, numbering, x, loads, i);
    const MatrixXd share = condensed_share(purpose, l, arc, condensed_[i], i);
    for (std::size_t r = 0; r < l.dofs.size(); ++r)
      for (std::size_t s = 0; s < l.dofs.size(); ++s) dense(l.dofs[r], l.dofs[s]) += share(r, s);
    std::vector<Coupled> coupled = held_by(arc, dense);
    if (numbering.phase >= 0 && arc.interior_nodes() > 0)
      coupled.push_back({numbering.phase, motion.segment(interior_row_[i] + numbering.size - dense_size_,
                                                         arc.interior_tangent())});
    add_borders(arc, l, coupled, dense);
  }
  return 0.5 * (dense + dense.transpose());
}

Chain::Inertia Chain::inertia(const VectorXd& x, const Loads& loads, Parity parity) const {
  if (parity == Parity::odd && !half()) return {};
  const Purpose purpose = parity == Parity::odd ? Purpose::odd : Purpose::even;
  const Numbering numbering = number(purpose);
  const MatrixXd dense = condensed_variation(purpose, numbering, x, loads);
  int negative = 0;
  for (const Link& link : links_) negative += link.arc->negative_pivots();
  negative -= numbering.constraints;
  // The arc between a clamp and a line along it is about to buckle by itself, see spatial::FreeRodEnd.
  const auto neutral = static_cast<int>(std::count_if(joints_.begin(), joints_.end(), [](const auto& joint) {
    return !joint->fixed_in_variations().empty();
  }));
  if (may_turn(parity, x, loads)) return {negative + negative_but_turn(dense, numbering.location), false};
  if (neutral > 0) return {negative + negative_but_neutral(dense, neutral), false};
  constexpr double close_to_rounding = 1e-9;  // of the largest entry
  const SymmetricFactors factors(dense);
  const bool near =
      dense.size() > 0 && factors.least_pivot() < close_to_rounding * dense.cwiseAbs().maxCoeff();
  return {negative + factors.negative(), near};
}

double Chain::sliding_stiffness(const VectorXd& x, const Loads& loads) const {
  const Purpose purpose = half() ? Purpose::odd : Purpose::even;
  const Numbering numbering = number(purpose);
  if (numbering.slide < 0) return 0.0;
  // K v + Φᵀμ = 0, Φ v = 1: the slide of size one that costs least, and −μ = v·K v. A half chain has half the energy.
  const MatrixXd dense = condensed_variation(purpose, numbering, x, loads);
  const VectorXd v = dense.partialPivLu().solve(VectorXd::Unit(dense.rows(), numbering.slide));
  return -(half() ? 2.0 : 1.0) * v(numbering.slide);
}

}  // namespace windlass::chain
