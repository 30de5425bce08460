#include "continuation/small_eigenvalues.hpp"

#include <algorithm>
#include <cmath>

namespace continuation {
namespace {

Matrix orthonormal_basis(const Matrix& columns) {
  return Eigen::HouseholderQR<Matrix>(columns).householderQ() *
         Matrix::Identity(columns.rows(), columns.cols());
}

}  // namespace

std::optional<SmallEigenvalues> small_eigenvalues(Problem& problem, const Vector& t_x, double t_p,
                                                  const Matrix& start) {
  const Eigen::Index n = problem.size();
  if (n == 0 || t_p == 0.0) return std::nullopt;
  constexpr Eigen::Index wanted = 4;
  const Eigen::Index m = std::min(n, wanted);
  Matrix basis = start;
  const bool cold = basis.rows() != n || basis.cols() != m;
  if (cold) {
    basis.resize(n, m);
    for (Eigen::Index j = 0; j < m; ++j)
      for (Eigen::Index i = 0; i < n; ++i)
        basis(i, j) = std::cos(1.0 + 2.399963229728653 * static_cast<double>(i) +
                               1.7 * static_cast<double>(j * (i + 1)));
    basis = orthonormal_basis(basis);
  }
  // J⁻¹f from [J F_p; cᵀ d] (x, y) = (f, 0), with J⁻¹F_p = −t_x / t_p.
  const auto inverse = [&](const Matrix& columns) {
    Matrix result(n, m);
    for (Eigen::Index j = 0; j < m; ++j) {
      const Vector solution = problem.solve(columns.col(j), Vector::Zero(1));
      result.col(j) = solution.head(n) - (solution[n] / t_p) * t_x;
    }
    return result;
  };
  const int passes = cold ? 8 : 2;
  for (int pass = 0; pass < passes; ++pass) {
    const Matrix image = inverse(basis);
    if (!image.allFinite()) return std::nullopt;
    basis = orthonormal_basis(image);
  }
  const Matrix image = inverse(basis);
  if (!image.allFinite()) return std::nullopt;
  const Matrix projected = basis.transpose() * image;
  const Eigen::EigenSolver<Matrix> solver(projected);
  if (solver.info() != Eigen::Success) return std::nullopt;
  SmallEigenvalues small{Vector(m), Matrix(n, m), basis};
  Eigen::Index found = 0;
  for (Eigen::Index j = 0; j < m; ++j) {
    const std::complex<double> theta = solver.eigenvalues()[j];
    if (theta.imag() != 0.0 || theta.real() == 0.0) continue;
    small.values[found] = 1.0 / theta.real();
    small.vectors.col(found) = (basis * solver.eigenvectors().col(j).real()).normalized();
    ++found;
  }
  small.values.conservativeResize(found);
  small.vectors.conservativeResize(n, found);
  return small;
}

int sign_changes(const SmallEigenvalues& from, const SmallEigenvalues& to) {
  if (from.vectors.rows() != to.vectors.rows()) return 0;
  // Each with one of the other, the nearest first: next to a fold several vectors are nearly parallel.
  constexpr double same = 0.8;  // cosine
  Matrix cosines = (to.vectors.transpose() * from.vectors).cwiseAbs();
  int changes = 0;
  Eigen::Index i = 0, j = 0;
  while (cosines.size() > 0 && cosines.maxCoeff(&i, &j) > same) {
    changes += (to.values[i] < 0.0) != (from.values[j] < 0.0);
    cosines.row(i).setZero();
    cosines.col(j).setZero();
  }
  return changes;
}

}  // namespace continuation
