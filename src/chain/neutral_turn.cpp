#include "neutral_turn.hpp"

#include <algorithm>
#include <cmath>

namespace windlass::chain {

using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

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

}  // namespace

double median(VectorXd values) {
  const auto middle = values.begin() + values.size() / 2;
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

bool is_singular(const Eigen::PartialPivLU<MatrixXd>& lu) {
  const VectorXd pivots = lu.matrixLU().diagonal().cwiseAbs();
  return pivots.minCoeff() < nearly_zero * median(pivots);
}

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

int negative_but_turn(const MatrixXd& dense, const std::vector<Eigen::Index>& locations) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(dense);
  const VectorXd& values = eigen.eigenvalues();
  // An arc that is singular by itself leaves an entry as large as 1e10, and its rounding to the others.
  const double zero = 3e-9 + 1e-14 * values.cwiseAbs().maxCoeff();
  const auto negative = (values.array() < 0.0).count();
  if (negative == 0) return 0;
  const bool turns =
      values(negative - 1) > -zero && Least(eigen.eigenvectors().col(negative - 1), locations).is_turn;
  return static_cast<int>(negative) - turns;
}

}  // namespace windlass::chain
