// Interiors eliminated element by element, and what is left at the ends: part of collocation_arc.ipp.
#pragma once

#include "windlass/bvp/collocation_arc.hpp"

namespace windlass::bvp {

template <class Configuration, int P>
void CollocationArc<Configuration, P>::hold_node(Eigen::MatrixXd& block, double parts) {
  constexpr double cancelled = 1e-4;  // digits that a pivot may lose: 4 of 16
  using Square = Eigen::Matrix<double, D, D>;
  const Square pivot = Square(block.template topLeftCorner<D, D>()).template selfadjointView<Eigen::Lower>();
  Square vectors = Square::Identity();
  Eigen::Matrix<double, D, 1> values = pivot.diagonal();
  if constexpr (D > 1) {  // closed forms: a direction that is not quite the eigenvector's serves as well
    Eigen::SelfAdjointEigenSolver<Square> eigen;
    eigen.computeDirect(pivot);
    vectors = eigen.eigenvectors(), values = eigen.eigenvalues();
  }
  for (int k = 0; k < D; ++k) {
    if (std::abs(values(k)) > cancelled * parts) continue;
    Held& held = held_[held_count_++];
    held.first = interior_tangent() - stages() * D;
    held.direction = std::sqrt(parts) * vectors.col(k);
    block.template topLeftCorner<D, D>() += held.direction * held.direction.transpose();
  }
}

template <class Configuration, int P>
void CollocationArc<Configuration, P>::factor(const ArcPoint& at, EndsMatrix& condensed) {
  constexpr int F = P + 1;  // n and ℓ
  negative_ = 0;
  held_count_ = 0;
  Nodes q;
  Eigen::Matrix<double, E, E> carry, s;  // on (first node, current node, n, ℓ), lower triangles
  for (int e = 0; e < elements(); ++e) {
    gather(at, e, q);
    element_hessian(q, at, e, element_);
    element_factors_[e].factor(element_);
    negative_ += element_factors_[e].negative_pivots();
    s = element_.template bottomRightCorner<E, E>();  // on (left, right, n, ℓ)
    if (e == 0) {
      carry = s;
      continue;
    }
    // Eliminate the node shared with the previous elements: order (shared, first, right, n, ℓ).
    auto& node = node_;
    node.setZero();
    node.template block<D, D>(0, 0) = carry.template block<D, D>(D, D) + s.template block<D, D>(0, 0);
    node.template block<D, D>(D, 0) = carry.template block<D, D>(D, 0).transpose();
    node.template block<D, D>(2 * D, 0) = s.template block<D, D>(D, 0);
    node.template block<F, D>(3 * D, 0) =
        carry.template block<F, D>(2 * D, D) + s.template block<F, D>(2 * D, 0);
    node.template block<D, D>(D, D) = carry.template block<D, D>(0, 0);
    node.template block<F, D>(3 * D, D) = carry.template block<F, D>(2 * D, 0);
    node.template block<D, D>(2 * D, 2 * D) = s.template block<D, D>(D, D);
    node.template block<F, D>(3 * D, 2 * D) = s.template block<F, D>(2 * D, D);
    node.template block<F, F>(3 * D, 3 * D) =
        carry.template block<F, F>(2 * D, 2 * D) + s.template block<F, F>(2 * D, 2 * D);
    if (e + 1 == elements())
      hold_node(node, carry.template block<D, D>(D, D).diagonal().cwiseAbs().maxCoeff() +
                          s.template block<D, D>(0, 0).diagonal().cwiseAbs().maxCoeff());
    node_factors_[e - 1].factor(node);
    negative_ += node_factors_[e - 1].negative_pivots();
    carry = node.template bottomRightCorner<E, E>();
  }
  condensed = carry.template selfadjointView<Eigen::Lower>();
}

template <class Configuration, int P>
void CollocationArc<Configuration, P>::reduce(double* rhs, EndsVector& ends) const {
  using NodeMap = Eigen::Map<Eigen::Matrix<double, D, 1>>;
  const int m = stages();
  Eigen::Matrix<double, E, 1> g;
  const auto distribute = [&](int left, int right) {  // shares of an elimination to its left and right node
    if (left == 0)
      ends.template head<D>() += g.template head<D>();
    else
      NodeMap(rhs + (left * m - 1) * D) += g.template head<D>();
    if (right == elements())
      ends.template segment<D>(D) += g.template segment<D>(D);
    else
      NodeMap(rhs + (right * m - 1) * D) += g.template segment<D>(D);
    ends.template tail<P + 1>() += g.template tail<P + 1>();
  };
  for (int e = 0; e < elements(); ++e) {
    g.setZero();
    element_factors_[e].reduce(rhs + e * m * D, g.data());
    distribute(e, e + 1);
  }
  for (int e = 1; e < elements(); ++e) {
    g.setZero();
    node_factors_[e - 1].reduce(rhs + (e * m - 1) * D, g.data());
    distribute(0, e + 1);
  }
}

template <class Configuration, int P>
void CollocationArc<Configuration, P>::expand(double* x, const EndsVector& ends) const {
  using NodeMap = Eigen::Map<Eigen::Matrix<double, D, 1>>;
  const int m = stages();
  Eigen::Matrix<double, E, 1> y = ends;
  for (int e = elements() - 1; e >= 1; --e) {
    if (e + 1 < elements()) y.template segment<D>(D) = NodeMap(x + ((e + 1) * m - 1) * D);
    node_factors_[e - 1].expand(x + (e * m - 1) * D, y.data());
  }
  for (int e = 0; e < elements(); ++e) {
    y = ends;
    if (e > 0) y.template head<D>() = NodeMap(x + (e * m - 1) * D);
    if (e + 1 < elements()) y.template segment<D>(D) = NodeMap(x + ((e + 1) * m - 1) * D);
    element_factors_[e].expand(x + e * m * D, y.data());
  }
}

template <class Configuration, int P>
int CollocationArc<Configuration, P>::place(int element, int column) const {
  const int interior = interior_tangent(), in = inner(), m = stages();
  if (column >= in + 2 * D) return interior + 2 * D + column - (in + 2 * D);
  const bool left = column >= in && column < in + D, right = column >= in + D;
  const int point = element * m + (left ? 0 : right ? m : column / D + 1);
  const int part = left || right ? (column - in) % D : column % D;
  if (point == 0) return interior + part;
  if (point == elements() * m) return interior + D + part;
  return (point - 1) * D + part;
}

template <class Configuration, int P>
void CollocationArc<Configuration, P>::hessian(const ArcPoint& at,
                                               std::vector<Eigen::Triplet<double>>& entries) const {
  Nodes q;
  for (int e = 0; e < elements(); ++e) {
    gather(at, e, q);
    element_hessian(q, at, e, element_);
    for (int i = 0; i < element_.rows(); ++i)
      for (int j = 0; j <= i; ++j) {
        if (element_(i, j) == 0.0) continue;
        const int row = place(e, i), col = place(e, j);
        entries.emplace_back(row, col, element_(i, j));
        if (i != j) entries.emplace_back(col, row, element_(i, j));
      }
  }
}

}  // namespace windlass::bvp
