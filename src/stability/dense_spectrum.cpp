#include "dense_spectrum.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>
#include <vector>

namespace windlass::stability {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using SymmetricSolver = Eigen::SelfAdjointEigenSolver<MatrixXd>;

namespace {

/// Relative to the largest: below it an eigenvalue of M or of Wᵀ K⁻¹ W is rounding.
constexpr double negligible = 1e-13;

/// W of full column rank with M = W Wᵀ.
MatrixXd full_rank_factor(const MatrixXd& metric) {
  const SymmetricSolver solver(metric);
  const VectorXd& d = solver.eigenvalues();
  const double cut = d.size() > 0 ? negligible * d.cwiseAbs().maxCoeff() : 0.0;
  const Index rank = (d.array() > cut).count();
  const VectorXd root = d.tail(rank).cwiseSqrt();
  return solver.eigenvectors().rightCols(rank) * root.asDiagonal();
}

}  // namespace

EigenPairs dense_spectrum(const chain::Chain::SecondVariation& variation) {
  const MatrixXd k = variation.matrix, metric = variation.metric;
  EigenPairs out;
  out.vectors.resize(k.rows(), 0);
  if (k.rows() == 0) return out;
  VectorXd pivots = SymmetricSolver(k, Eigen::EigenvaluesOnly).eigenvalues();
  // Away from zero a little if K is singular: (K − σM)⁻¹M v = v/(μ − σ).
  const double shift = pivots.cwiseAbs().minCoeff() < 1e-14 * pivots.cwiseAbs().maxCoeff() ? -1e-7 : 0.0;
  if (shift != 0.0) pivots = SymmetricSolver(k - shift * metric, Eigen::EigenvaluesOnly).eigenvalues();
  out.shift = shift;
  out.inertia_index = static_cast<int>((pivots.array() < 0.0).count()) - variation.constraints;
  const MatrixXd w = full_rank_factor(metric);
  if (w.cols() == 0) return out;
  const MatrixXd inverse_w = Eigen::PartialPivLU<MatrixXd>(k - shift * metric).solve(w);
  const MatrixXd reduced = w.transpose() * inverse_w;
  const SymmetricSolver solver(0.5 * (reduced + reduced.transpose()));
  const VectorXd& theta = solver.eigenvalues();
  const double cut = negligible * theta.cwiseAbs().maxCoeff();
  std::vector<Index> finite;
  for (Index i = 0; i < theta.size(); ++i)
    if (std::abs(theta(i)) > cut) finite.push_back(i);
  out.values.resize(finite.size());
  out.vectors.resize(k.rows(), finite.size());
  for (std::size_t i = 0; i < finite.size(); ++i) {
    out.values(i) = shift + 1.0 / theta(finite[i]);
    out.vectors.col(i) = inverse_w * solver.eigenvectors().col(finite[i]) / theta(finite[i]);  // vᵀMv = 1
  }
  return out;
}

}  // namespace windlass::stability
