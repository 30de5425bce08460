#include <cmath>
#include <stdexcept>

#include "neutral_turn.hpp"
#include "windlass/chain/chain.hpp"
#include "windlass/chain/singular_matrix.hpp"

namespace windlass::chain {

namespace {

/// What rounding leaves of forces out of the plane of a flat rod.
constexpr double nothing = 1e-8;

}  // namespace

void Chain::factor(const VectorXd& x, const Loads& loads, const MatrixXd& b_asked, const MatrixXd& c_asked,
                   const MatrixXd& d_asked) {
  std::vector<Placed> placed;
  VectorXd scratch(size_);
  for (int i = 0; i < link_count(); ++i) {
    placed.push_back(place(x, loads, i));
    links_[i].arc->gradient(placed[i].point(), scratch.data() + interior_row_[i], gradients_[i]);
    links_[i].arc->factor(placed[i].point(), condensed_[i]);
  }
  MatrixXd b = b_asked, c = c_asked, d = d_asked;
  asked_ = d.rows();
  const auto add_border = [&](const VectorXd& column, double corner) {
    const Eigen::Index last = d.rows();
    b.conservativeResize(size_, last + 1);
    c.conservativeResize(size_, last + 1);
    d.conservativeResize(last + 1, last + 1);
    b.col(last) = c.col(last) = column;
    d.row(last).setZero();
    d.col(last).setZero();
    d(last, last) = corner;
  };
  if (gauges_.phase && spins(Purpose::even))  // J + g gᵀ
    add_border(phase_motion(Purpose::equilibrium, numbering_, x, loads), -1.0);
  for (int i = 0; i < link_count(); ++i)
    for (const bvp::Held& held : links_[i].arc->held()) {
      VectorXd column = VectorXd::Zero(size_);
      column.segment(interior_row_[i] + held.first, held.direction.size()) = held.direction;
      add_border(column, 1.0);
    }
  borders_ = d.rows();
  flat_ = is_flat(placed, flat_to);
  for (Eigen::Index j = 0; j < asked_; ++j)
    flat_ = flat_ && outside(b.col(j)) < nothing && outside(c.col(j)) < nothing;
  const Eigen::Index n = dense_size_, k = borders_;
  Block& dense = block_;
  dense.reset(n + k);
  for (int i = 0; i < link_count(); ++i) {
    locals_[i] = local(Purpose::equilibrium, numbering_, x, loads, i);
    const Local& l = locals_[i];
    const MatrixXd share =
        l.rows.transpose() * with_commutator(*links_[i].arc, condensed_[i], gradients_[i]) * l.columns;
    for (std::size_t r = 0; r < l.dofs.size(); ++r)
      for (std::size_t s = 0; s < l.dofs.size(); ++s) dense(l.dofs[r], l.dofs[s]) += share(r, s);
    add_joint_terms(Purpose::equilibrium, numbering_, x, loads, i, gradients_[i], dense);
  }
  add_locations(x, loads, dense);
  add_couplings(Purpose::equilibrium, numbering_, x, dense);
  add_dragged_pushes(x, loads, dense);

  border_b_ = b;
  border_c_ = c;
  interior_b_.resize(size_, k);
  interior_c_.resize(size_, k);
  for (Eigen::Index j = 0; j < k; ++j) {
    VectorXd column = b.col(j), row = c.col(j);
    reduce(column, false);
    reduce(row, true);
    border_b_.col(j) = column;
    border_c_.col(j) = row;
    interior_b_.col(j) = interior_solve(column, false);
    interior_c_.col(j) = interior_solve(row, true);
  }
  if (k > 0) {
    dense.block(0, n, n, k) += border_b_.topRows(n);
    dense.block(n, 0, k, n) += border_c_.topRows(n).transpose();
    dense.block(n, n, k, k) += d - interior_c_.transpose() * b;
  }
  if (!dense.all_finite()) throw std::domain_error("the chain's matrix is not finite");
  // Made regular, its solutions have no part along a turn that costs nothing, so that Newton does not wander along it.
  const VectorXd turn = neutral_turn(Purpose::equilibrium, numbering_, x, loads, dense, asked_);
  if (turn.size() > 0) hold(dense, turn, usual_size(dense));
  if (dense.rows() > 0) dense_.compute(dense);
  int negative = 0;
  for (const Link& link : links_) negative += link.arc->negative_pivots();
  determinant_sign_ = negative % 2 == 0 ? 1 : -1;
  if (dense.rows() > 0) {
    if (dense_.determinant_sign() == 0) throw SingularMatrix("the chain's matrix is singular");
    determinant_sign_ *= dense_.determinant_sign();
  }
}

void Chain::reduce(VectorXd& f, bool transposed) const {
  bvp::EndsVector ends;
  for (int i = 0; i < link_count(); ++i) {
    const Arc& arc = *links_[i].arc;
    if (arc.interior_nodes() == 0) continue;
    ends.setZero(arc.ends());
    double* interior = f.data() + interior_row_[i];
    transposed ? arc.reduce_transposed(interior, ends) : arc.reduce(interior, ends);
    const Local& l = locals_[i];
    const VectorXd share = (transposed ? l.columns : l.rows).transpose() * ends;
    for (std::size_t r = 0; r < l.dofs.size(); ++r) f(l.dofs[r]) += share(r);
  }
}

void Chain::expand(VectorXd& f, bool transposed) const {
  VectorXd y;
  for (int i = 0; i < link_count(); ++i) {
    const Arc& arc = *links_[i].arc;
    if (arc.interior_nodes() == 0) continue;
    const Local& l = locals_[i];
    y.resize(l.dofs.size());
    for (std::size_t r = 0; r < l.dofs.size(); ++r) y(r) = f(l.dofs[r]);
    const bvp::EndsVector ends = (transposed ? l.rows : l.columns) * y;
    double* interior = f.data() + interior_row_[i];
    transposed ? arc.expand_transposed(interior, ends) : arc.expand(interior, ends);
  }
}

VectorXd Chain::interior_solve(VectorXd reduced, bool transposed) const {
  reduced.head(dense_size_).setZero();
  bvp::EndsVector ends;
  for (int i = 0; i < link_count(); ++i) {
    const Arc& arc = *links_[i].arc;
    if (arc.interior_nodes() == 0) continue;
    ends.setZero(arc.ends());
    double* interior = reduced.data() + interior_row_[i];
    transposed ? arc.expand_transposed(interior, ends) : arc.expand(interior, ends);
  }
  return reduced;
}

VectorXd Chain::solve(const VectorXd& f, const VectorXd& g, bool transposed) const {
  const Eigen::Index n = dense_size_, k = borders_;
  const MatrixXd& column = transposed ? border_c_ : border_b_;
  VectorXd rhs(n + k);
  if (k > 0) {
    rhs.tail(k) = -(transposed ? interior_b_ : interior_c_).transpose() * f;
    rhs.segment(n, asked_) += g;
  }
  VectorXd out(size_ + asked_);
  VectorXd x = f;
  reduce(x, transposed);
  rhs.head(n) = x.head(n);
  VectorXd y(n + k);
  if (n + k > 0) y = dense_.solve(rhs, transposed);
  if (k > 0) x.tail(size_ - n) -= column.bottomRows(size_ - n) * y.tail(k);
  x.head(n) = y.head(n);
  expand(x, transposed);
  if (flat_ && outside(f) < nothing)
    for (const Eigen::Index at : outside_) x(at) = 0.0;
  out.head(size_) = x;
  out.tail(asked_) = y.segment(n, asked_);
  return out;
}

}  // namespace windlass::chain
