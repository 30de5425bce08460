#include "windlass/rod/dense_arc.hpp"

namespace windlass::rod {

void DenseArc::factor(const bvp::ArcPoint& at, bvp::EndsMatrix& condensed) {
  linearise(at);
  const int inner = interior_tangent(), outer = ends();
  weighted_ = matrix_.bottomLeftCorner(outer, inner);
  inner_.compute(matrix_.topLeftCorner(inner, inner));
  solved_ = inner_.solve(matrix_.topRightCorner(inner, outer));
  solved_left_ = inner_.transpose().solve(weighted_.transpose());
  condensed = matrix_.bottomRightCorner(outer, outer) - weighted_ * solved_;
  const auto pivots = inner_.matrixLU().diagonal();
  const bool odd = ((pivots.array() < 0.0).count() % 2 == 1) != (inner_.permutationP().determinant() < 0);
  negative_ = odd;  // its parity is all that a matrix without symmetry has
}

void DenseArc::reduce(double* rhs, bvp::EndsVector& ends) const {
  Eigen::Map<Eigen::VectorXd> interior(rhs, interior_tangent());
  ends -= solved_left_.transpose() * interior;
  interior = inner_.solve(interior).eval();
}

void DenseArc::reduce_transposed(double* rhs, bvp::EndsVector& ends) const {
  Eigen::Map<Eigen::VectorXd> interior(rhs, interior_tangent());
  ends -= solved_.transpose() * interior;
  interior = inner_.transpose().solve(interior).eval();
}

void DenseArc::expand(double* x, const bvp::EndsVector& ends) const {
  Eigen::Map<Eigen::VectorXd>(x, interior_tangent()) -= solved_ * ends;
}

void DenseArc::expand_transposed(double* x, const bvp::EndsVector& ends) const {
  Eigen::Map<Eigen::VectorXd>(x, interior_tangent()) -= solved_left_ * ends;
}

void DenseArc::hessian(const bvp::ArcPoint& at, std::vector<Eigen::Triplet<double>>& entries) const {
  linearise(at);
  for (Eigen::Index c = 0; c < matrix_.cols(); ++c)
    for (Eigen::Index r = 0; r < matrix_.rows(); ++r)
      if (matrix_(r, c) != 0.0) entries.emplace_back(static_cast<int>(r), static_cast<int>(c), matrix_(r, c));
}

}  // namespace windlass::rod
