#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <vector>

#include "windlass/chain/chain.hpp"

namespace windlass::test {

/// All finite eigenvalues of an assembled second variation by dense algebra, ascending: the second opinion. With
/// M = W Wᵀ of full column rank, Wᵀ K⁻¹ W y = y/μ.
inline Eigen::VectorXd dense_spectrum(const chain::Chain::SecondVariation& variation) {
  using Eigen::MatrixXd;
  using Eigen::VectorXd;
  constexpr double negligible = 1e-13;  // of the largest: rounding
  const MatrixXd k = variation.matrix, metric = variation.metric;
  const Eigen::SelfAdjointEigenSolver<MatrixXd> mass(metric);
  const Eigen::Index rank = (mass.eigenvalues().array() > negligible * mass.eigenvalues().maxCoeff()).count();
  const MatrixXd w =
      mass.eigenvectors().rightCols(rank) * mass.eigenvalues().tail(rank).cwiseSqrt().asDiagonal();
  const MatrixXd reduced = w.transpose() * Eigen::PartialPivLU<MatrixXd>(k).solve(w);
  const Eigen::SelfAdjointEigenSolver<MatrixXd> inverse(0.5 * (reduced + reduced.transpose()),
                                                        Eigen::EigenvaluesOnly);
  const double cut = negligible * inverse.eigenvalues().cwiseAbs().maxCoeff();
  std::vector<double> values;
  for (const double theta : inverse.eigenvalues())
    if (std::abs(theta) > cut) values.push_back(1.0 / theta);
  std::sort(values.begin(), values.end());
  return Eigen::Map<VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

}  // namespace windlass::test
