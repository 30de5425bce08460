#include "windlass/bvp/collocation_table.hpp"

#include <algorithm>
#include <boost/math/special_functions/legendre.hpp>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

namespace windlass::bvp {

namespace {

/// Legendre polynomial of degree n on [0, 1].
double shifted_legendre(int n, double x) { return boost::math::legendre_p(n, 2.0 * x - 1.0); }

Eigen::VectorXd symmetric_points(const std::vector<double>& nonnegative_zeros) {
  std::vector<double> points;
  for (double z : nonnegative_zeros) {
    points.push_back(0.5 * (1.0 + z));
    if (z != 0.0) points.push_back(0.5 * (1.0 - z));
  }
  std::sort(points.begin(), points.end());
  return Eigen::Map<Eigen::VectorXd>(points.data(), static_cast<Eigen::Index>(points.size()));
}

}  // namespace

Eigen::VectorXd lagrange_basis(const Eigen::VectorXd& nodes, double x) {
  Eigen::VectorXd phi = Eigen::VectorXd::Ones(nodes.size());
  for (Eigen::Index i = 0; i < nodes.size(); ++i)
    for (Eigen::Index j = 0; j < nodes.size(); ++j)
      if (j != i) phi(i) *= (x - nodes(j)) / (nodes(i) - nodes(j));
  return phi;
}

Eigen::VectorXd lagrange_slopes(const Eigen::VectorXd& nodes, double x) {
  Eigen::VectorXd slopes = Eigen::VectorXd::Zero(nodes.size());
  for (Eigen::Index i = 0; i < nodes.size(); ++i)
    for (Eigen::Index k = 0; k < nodes.size(); ++k) {
      if (k == i) continue;
      double term = 1.0 / (nodes(i) - nodes(k));
      for (Eigen::Index j = 0; j < nodes.size(); ++j)
        if (j != i && j != k) term *= (x - nodes(j)) / (nodes(i) - nodes(j));
      slopes(i) += term;
    }
  return slopes;
}

Eigen::VectorXd gauss_points(int stages) {
  return symmetric_points(boost::math::legendre_p_zeros<double>(stages));
}

Eigen::VectorXd lobatto_points(int stages) {
  // The interior points are the zeros of P'_stages; they interlace with the Gauss points, which bracket them.
  const Eigen::VectorXd bracket = gauss_points(stages);
  Eigen::VectorXd points(stages + 1);
  points(0) = 0.0;
  points(stages) = 1.0;
  for (int i = 1; i < stages; ++i) {
    double low = bracket(i - 1), high = bracket(i);
    const auto slope = [&](double x) { return boost::math::legendre_p_prime(stages, 2.0 * x - 1.0); };
    const bool rising = slope(low) < 0.0;
    while (true) {
      const double middle = 0.5 * (low + high);
      if (middle <= low || middle >= high) break;
      ((slope(middle) < 0.0) == rising ? low : high) = middle;
    }
    points(i) = 0.5 * (low + high);
  }
  for (int i = 0; i <= stages / 2; ++i) {  // exact mirror symmetry
    const double x = 0.5 * (points(i) + 1.0 - points(stages - i));
    points(i) = x;
    points(stages - i) = 1.0 - x;
  }
  return points;
}

namespace {

double gauss_weight(int stages, double x) {
  const double z = 2.0 * x - 1.0, dp = boost::math::legendre_p_prime(stages, z);
  return 1.0 / ((1.0 - z * z) * dp * dp);
}

CollocationTable build(int m) {
  CollocationTable t;
  t.stages = m;
  t.lobatto = lobatto_points(m);
  t.gauss = gauss_points(m);
  t.weight.resize(m);
  t.value.resize(m, m + 1);
  t.slope.resize(m, m + 1);
  for (int g = 0; g < m; ++g) {
    t.weight(g) = gauss_weight(m, t.gauss(g));
    t.value.row(g) = lagrange_basis(t.lobatto, t.gauss(g)).transpose();
    t.slope.row(g) = lagrange_slopes(t.lobatto, t.gauss(g)).transpose();
  }
  t.integral = Eigen::MatrixXd::Zero(m + 1, m);
  t.end_slope.resize(m + 1, m + 1);
  for (int i = 0; i <= m; ++i) {
    // Exact for the interpolant (degree M-1): Gauss quadrature of it on [0, lobatto(i)].
    for (int g = 0; g < m; ++g)
      t.integral.row(i) +=
          t.lobatto(i) * t.weight(g) * lagrange_basis(t.gauss, t.lobatto(i) * t.gauss(g)).transpose();
    t.end_slope.row(i) = lagrange_slopes(t.lobatto, t.lobatto(i)).transpose();
  }
  // c_M = (2M+1) ∫ f P_M; a Gauss rule of higher order integrates degree 2M exactly.
  const Eigen::VectorXd fine = gauss_points(m + 2);
  t.highest = Eigen::RowVectorXd::Zero(m + 1);
  for (double x : fine)
    t.highest += (2 * m + 1) * gauss_weight(m + 2, x) * shifted_legendre(m, x) *
                 lagrange_basis(t.lobatto, x).transpose();
  return t;
}

}  // namespace

const CollocationTable& CollocationTable::get(int stages) {
  if (stages < min_stages || stages > max_stages + 1)
    throw std::invalid_argument("collocation stages must be " + std::to_string(min_stages) + " to " +
                                std::to_string(max_stages + 1));
  static const std::vector<CollocationTable> tables = [] {
    std::vector<CollocationTable> all;
    for (int m = min_stages; m <= max_stages + 1; ++m) all.push_back(build(m));
    return all;
  }();
  return tables[stages - min_stages];
}

Eigen::MatrixXd gauss_stages(const CollocationTable& table) {
  const int m = table.stages;
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(m, m);
  for (int g = 0; g < m; ++g)
    for (int j = 0; j < m; ++j)  // exact: a polynomial of degree M − 1 on [0, gauss(g)]
      a.row(g) += table.gauss(g) * table.weight(j) *
                  lagrange_basis(table.gauss, table.gauss(g) * table.gauss(j)).transpose();
  return a;
}

}  // namespace windlass::bvp
