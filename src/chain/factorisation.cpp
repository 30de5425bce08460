#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "windlass/chain/chain.hpp"

/// LAPACK: Bunch-Kaufman factorisation of a symmetric matrix. Reaches the program through PETSc.
extern "C" void dsytrf_(const char* uplo, const int* n, double* a, const int* lda, int* pivot, double* work,
                        const int* work_size, int* info);

namespace windlass::chain {

using contact::Attachment;
using contact::JointKind;
using contact::Parity;
using contact::Side;
using contact::SmallMatrix;
using contact::SmallVector;

namespace {

/// Number of eigenvalues of a symmetric matrix below zero, by Bunch-Kaufman factorisation (LAPACK dsytrf).
int negative_eigenvalues(MatrixXd a) {
  int n = static_cast<int>(a.rows()), info = 0, work_size = 64 * std::max(n, 1);
  if (n == 0) return 0;
  std::vector<int> pivot(n);
  VectorXd work(work_size);
  dsytrf_("L", &n, a.data(), &n, pivot.data(), work.data(), &work_size, &info);
  int negative = 0;
  for (int k = 0; k < n; ++k) {
    if (pivot[k] > 0) {
      negative += a(k, k) < 0.0;
    } else {  // a 2×2 pivot has one eigenvalue of each sign
      ++negative;
      ++k;
    }
  }
  return negative;
}

/// What a neutral motion leaves of a pivot, as a part of the others: the error that Newton's method has left.
constexpr double nearly_zero = 1e-6;

/// What rounding leaves of forces out of the plane of a flat rod.
constexpr double nothing = 1e-8;

/// Size of the entries in the middle: an arc that is singular by itself leaves one of 1e10.
double median(VectorXd values) {
  const auto middle = values.begin() + values.size() / 2;
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

bool is_singular(const Eigen::PartialPivLU<MatrixXd>& lu) {
  const VectorXd pivots = lu.matrixLU().diagonal().cwiseAbs();
  return pivots.minCoeff() < nearly_zero * median(pivots);
}

/// The vector of a null space (orthonormal columns) with the least part in the rows of location conditions.
/// @param locations  those rows, −1: none
struct Least {
  Least(const MatrixXd& null_space, const std::vector<Eigen::Index>& locations) {
    MatrixXd part = MatrixXd::Zero(static_cast<Eigen::Index>(locations.size()), null_space.cols());
    for (std::size_t j = 0; j < locations.size(); ++j)
      if (locations[j] >= 0) part.row(static_cast<Eigen::Index>(j)) = null_space.row(locations[j]);
    const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(part.transpose() * part);
    vector = null_space * eigen.eigenvectors().col(0);
    constexpr double little = 0.1;
    is_turn = std::sqrt(std::abs(eigen.eigenvalues()(0))) < little * vector.cwiseAbs().maxCoeff();
  }
  VectorXd vector;
  bool
      is_turn;  ///< a turn of a flat rod moves no contact along it; the rest is a touch about to flatten or to leave
};

/// A matrix that a neutral turn v makes singular, made regular with v and the left null vector u: its solutions are those
/// of the singular system, without a part along v, so that Newton does not wander along it.
MatrixXd without_turn(const MatrixXd& singular, const std::vector<Eigen::Index>& locations) {
  const Eigen::JacobiSVD<MatrixXd> svd(singular, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double usual = median(svd.singularValues());
  const Eigen::Index nullity = (svd.singularValues().array() < nearly_zero * usual).count();
  if (nullity == 0) return singular;
  const Least left(svd.matrixU().rightCols(nullity), locations);
  if (!left.is_turn) return singular;
  const VectorXd u = left.vector, v = Least(svd.matrixV().rightCols(nullity), locations).vector;
  // The determinant's sign must not depend on that of u.
  const double orientation = u.dot(v) < 0.0 ? -1.0 : 1.0;
  return singular + orientation * usual * u * v.transpose();
}

/// Eigenvalues below zero, without one that is zero up to rounding and belongs to the turn. An arc that is singular by
/// itself leaves an entry as large as 1e10, and its rounding to the others.
int negative_but_turn(const MatrixXd& dense, const std::vector<Eigen::Index>& locations) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(dense);
  const VectorXd& values = eigen.eigenvalues();
  const double zero = 3e-9 + 1e-14 * values.cwiseAbs().maxCoeff();
  const auto negative = (values.array() < 0.0).count();
  if (negative == 0) return 0;
  const bool turns =
      values(negative - 1) > -zero && Least(eigen.eigenvectors().col(negative - 1), locations).is_turn;
  return static_cast<int>(negative) - turns;
}

}  // namespace

Attachment Chain::attachment(Purpose purpose, const VectorXd& x, const Loads& loads, int joint,
                             Side side) const {
  if (purpose == Purpose::odd && joint == 0) return joints_[0]->attach_odd(coordinates(x, 0), loads);
  return joints_[joint]->attach(side, coordinates(x, joint), loads);
}

bvp::EndsMatrix Chain::with_commutator(const Arc& arc, const bvp::EndsMatrix& symmetric,
                                       const bvp::EndsVector& gradient) {
  bvp::EndsMatrix full = symmetric;
  if (arc.ambient() != 4) return full;
  // D_{w'} D_w S − D_w D_{w'} S = 2 g·(w' × w) for increments on the right of a quaternion.
  for (int at : {0, 3}) {
    const Eigen::Vector3d g = gradient.segment(at, 3);
    Eigen::Matrix3d cross;
    cross << 0.0, -g(2), g(1), g(2), 0.0, -g(0), -g(1), g(0), 0.0;
    full.block(at, at, 3, 3) += cross;
  }
  return full;
}

Chain::Local Chain::local(Purpose purpose, const Numbering& numbering, const VectorXd& x, const Loads& loads,
                          int link) const {
  const Arc& arc = *links_[link].arc;
  const int d = arc.tangent(), forces = arc.forces(), ends = arc.ends();
  Local l;
  const SmallMatrix left = attachment(purpose, x, loads, link, Side::right).dq;
  const SmallMatrix right = attachment(purpose, x, loads, link + 1, Side::left).dq;
  l.columns = MatrixXd::Zero(ends, left.cols() + right.cols() + 2 + forces);
  l.rows = l.columns;
  Eigen::Index k = 0;
  const auto coordinates_of = [&](const SmallMatrix& dq, int joint, int first_end) {
    for (Eigen::Index c = 0; c < dq.cols(); ++c, ++k) {
      l.dofs.push_back(numbering.coordinate[joint] + c);
      l.columns.col(k).segment(first_end, d) = dq.col(c);
      l.rows.col(k).segment(first_end, d) = dq.col(c);
    }
  };
  const auto arclength_of = [&](int joint, double sign, Side arc_side, int first_end) {
    if (numbering.location[joint] < 0) return;
    if (purpose == Purpose::equilibrium && !joints_[joint]->locates()) return;
    l.dofs.push_back(numbering.location[joint]);
    l.columns(ends - 1, k) = sign;
    if (purpose != Purpose::equilibrium) {
      l.rows(ends - 1, k) = sign;
    } else {
      const Joint::Location c = location(x, joint);
      if (c.side == arc_side && c.by_gradient.size() == d)
        l.rows.col(k).segment(first_end, d) = c.by_gradient;
    }
    ++k;
  };
  coordinates_of(left, link, 0);
  arclength_of(link, -1.0, Side::right, 0);
  if (links_[link].pull == 0)
    for (int i = 0; i < forces; ++i, ++k) {
      l.dofs.push_back(numbering.force[link] + i);
      l.columns(2 * d + i, k) = l.rows(2 * d + i, k) = 1.0;
    }
  coordinates_of(right, link + 1, d);
  arclength_of(link + 1, 1.0, Side::left, d);
  l.columns.conservativeResize(ends, k);
  l.rows.conservativeResize(ends, k);
  return l;
}

void Chain::add_joint_terms(Purpose purpose, const Numbering& numbering, const VectorXd& x,
                            const Loads& loads, int link, const bvp::EndsVector& gradient,
                            MatrixXd& dense) const {
  const Arc& arc = *links_[link].arc;
  const int d = arc.tangent();
  const SmallVector n = force(x, loads, link);
  for (const Side side :
       {Side::right, Side::left}) {  // of the joint: the arc starts at its right, ends at its left
    const int joint = side == Side::right ? link : link + 1;
    const double sign = side == Side::right ? -1.0 : 1.0;
    const Attachment at = attachment(purpose, x, loads, joint, side);
    const Eigen::Index first = numbering.coordinate[joint], count = at.dx.cols();
    SmallMatrix bend = SmallMatrix::Zero(count, count);
    const SmallVector g = gradient.segment(side == Side::right ? 0 : d, d), f = sign * n;
    if (purpose == Purpose::odd && joint == 0)
      joints_[joint]->curvature_odd(coordinates(x, joint), f, bend);
    else
      joints_[joint]->curvature(side, coordinates(x, joint), loads, g, f, bend);
    dense.block(first, first, count, count) += bend;
    if (links_[link].pull != 0) continue;
    const Eigen::Index row = numbering.force[link];
    dense.block(row, first, n.size(), count) += sign * at.dx;
    dense.block(first, row, count, n.size()) += sign * at.dx.transpose();
  }
}

void Chain::add_locations(const VectorXd& x, MatrixXd& dense) const {
  for (int j = 0; j < joint_count(); ++j) {
    const Eigen::Index row = numbering_.location[j];
    if (row < 0) continue;
    dense.row(row).segment(numbering_.coordinate[j], joints_[j]->tangent()) +=
        location(x, j).by_w.transpose();
    if (joints_[j]->held()) dense(numbering_.coordinate[j], row) += 1.0;
  }
}

void Chain::add_pins(const Numbering& numbering, const VectorXd& x, MatrixXd& dense) const {
  for (int j = 0; j < joint_count(); ++j) {
    const Eigen::Index row = numbering.pin[j], first = numbering.coordinate[j], s = numbering.location[j];
    if (row < 0) continue;
    dense(row, first) = dense(first, row) = 1.0;
    dense(row, s) = dense(s, row) = -joints_[j]->slide(coordinates(x, j));
  }
}

void Chain::factor(const VectorXd& x, const Loads& loads, const MatrixXd& b, const MatrixXd& c,
                   const MatrixXd& d) {
  std::vector<Placed> placed;
  VectorXd scratch(size_);
  for (int i = 0; i < link_count(); ++i) {
    placed.push_back(place(x, loads, i));
    links_[i].arc->gradient(placed[i].point(), scratch.data() + interior_row_[i], gradients_[i]);
    links_[i].arc->factor(placed[i].point(), condensed_[i]);
  }
  borders_ = d.rows();
  flat_ = is_flat(placed);
  for (Eigen::Index j = 0; j < borders_; ++j)
    flat_ = flat_ && outside(b.col(j)) < nothing && outside(c.col(j)) < nothing;
  const Eigen::Index n = dense_size_, k = borders_;
  MatrixXd dense = MatrixXd::Zero(n + k, n + k);
  for (int i = 0; i < link_count(); ++i) {
    locals_[i] = local(Purpose::equilibrium, numbering_, x, loads, i);
    const Local& l = locals_[i];
    const MatrixXd share =
        l.rows.transpose() * with_commutator(*links_[i].arc, condensed_[i], gradients_[i]) * l.columns;
    for (std::size_t r = 0; r < l.dofs.size(); ++r)
      for (std::size_t s = 0; s < l.dofs.size(); ++s) dense(l.dofs[r], l.dofs[s]) += share(r, s);
    add_joint_terms(Purpose::equilibrium, numbering_, x, loads, i, gradients_[i], dense);
  }
  add_locations(x, dense);

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
    interior_b_.col(j) = interior_solve(column);
    interior_c_.col(j) = interior_solve(row);
  }
  if (k > 0) {
    dense.topRightCorner(n, k) = border_b_.topRows(n);
    dense.bottomLeftCorner(k, n) = border_c_.topRows(n).transpose();
    dense.bottomRightCorner(k, k) = d - interior_c_.transpose() * b;
  }
  if (!dense.allFinite()) throw std::domain_error("the chain's matrix is not finite");
  if (dense.rows() > 0) dense_.compute(dense);
  const bool may_turn = neutral_turn_ && (!half() || *neutral_turn_ == Parity::even);
  if (may_turn && dense.rows() > 0 && is_singular(dense_))
    dense_.compute(without_turn(dense, numbering_.location));
  int negative = 0;
  for (const Link& link : links_) negative += link.arc->negative_pivots();
  determinant_sign_ = negative % 2 == 0 ? 1 : -1;
  if (dense.rows() > 0) {
    const auto diagonal = dense_.matrixLU().diagonal();
    if (diagonal.cwiseAbs().minCoeff() == 0.0) throw std::runtime_error("the chain's matrix is singular");
    if ((diagonal.array() < 0.0).count() % 2 == 1) determinant_sign_ = -determinant_sign_;
    determinant_sign_ *= static_cast<int>(dense_.permutationP().determinant());
  }
}

void Chain::reduce(VectorXd& f, bool transposed) const {
  bvp::EndsVector ends;
  for (int i = 0; i < link_count(); ++i) {
    const Arc& arc = *links_[i].arc;
    if (arc.interior_nodes() == 0) continue;
    ends.setZero(arc.ends());
    arc.reduce(f.data() + interior_row_[i], ends);
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
    arc.expand(f.data() + interior_row_[i], ends);
  }
}

VectorXd Chain::interior_solve(VectorXd reduced) const {
  reduced.head(dense_size_).setZero();
  bvp::EndsVector ends;
  for (int i = 0; i < link_count(); ++i) {
    const Arc& arc = *links_[i].arc;
    if (arc.interior_nodes() == 0) continue;
    ends.setZero(arc.ends());
    arc.expand(reduced.data() + interior_row_[i], ends);
  }
  return reduced;
}

VectorXd Chain::solve(const VectorXd& f, const VectorXd& g, bool transposed) const {
  const Eigen::Index n = dense_size_, k = borders_;
  const MatrixXd& column = transposed ? border_c_ : border_b_;
  VectorXd rhs(n + k);
  if (k > 0) rhs.tail(k) = g - (transposed ? interior_b_ : interior_c_).transpose() * f;
  VectorXd out(size_ + k);
  VectorXd x = f;
  reduce(x, transposed);
  rhs.head(n) = x.head(n);
  VectorXd y(n + k);
  if (n + k > 0) y = transposed ? VectorXd(dense_.transpose().solve(rhs)) : VectorXd(dense_.solve(rhs));
  if (k > 0) x.tail(size_ - n) -= column.bottomRows(size_ - n) * y.tail(k);
  x.head(n) = y.head(n);
  expand(x, transposed);
  if (flat_ && outside(f) < nothing)
    for (const Eigen::Index at : outside_) x(at) = 0.0;
  out.head(size_) = x;
  out.tail(k) = y.tail(k);
  return out;
}

MatrixXd Chain::variation_matrix(Purpose purpose, const Numbering& numbering, const VectorXd& x,
                                 const Loads& loads) const {
  MatrixXd dense = MatrixXd::Zero(numbering.size, numbering.size);
  for (int i = 0; i < link_count(); ++i)
    add_joint_terms(purpose, numbering, x, loads, i, gradients_[i], dense);
  add_pins(numbering, x, dense);
  return dense;
}

int Chain::index(const VectorXd& x, const Loads& loads, Parity parity) const {
  if (parity == Parity::odd && !half()) return 0;
  const Purpose purpose = parity == Parity::odd ? Purpose::odd : Purpose::even;
  const Numbering numbering = number(purpose);
  MatrixXd dense = variation_matrix(purpose, numbering, x, loads);
  int negative = 0;
  for (int i = 0; i < link_count(); ++i) {
    negative += links_[i].arc->negative_pivots();
    const Local l = local(purpose, numbering, x, loads, i);
    bvp::EndsMatrix hessian = with_commutator(*links_[i].arc, condensed_[i], gradients_[i]);
    if (purpose == Purpose::odd && i == 0 && links_[0].arc->ambient() == 4)  // see Joint::attach_odd
      hessian.block(0, 0, 3, 3) = condensed_[0].block(0, 0, 3, 3);
    const MatrixXd share = l.columns.transpose() * hessian * l.columns;
    for (std::size_t r = 0; r < l.dofs.size(); ++r)
      for (std::size_t s = 0; s < l.dofs.size(); ++s) dense(l.dofs[r], l.dofs[s]) += share(r, s);
  }
  dense = (0.5 * (dense + dense.transpose())).eval();
  negative += neutral_turn_ ? negative_but_turn(dense, numbering.location) : negative_eigenvalues(dense);
  return negative - numbering.constraints;
}

}  // namespace windlass::chain
