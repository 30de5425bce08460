#pragma once

#include <Eigen/Dense>

/// Tables of Gauss-Legendre collocation with M stages, on the reference element [0, 1].
///
/// An element carries a polynomial of degree M through M + 1 Gauss-Lobatto points; the action is integrated with the
/// M Gauss points. The stationary points of that discrete action are exactly the Gauss collocation solutions of the
/// canonical equations (Hairer, Lubich & Wanner, *Geometric Numerical Integration*, VI.6): order 2M at the nodes,
/// and a symmetric Newton matrix.
namespace windlass::bvp {

struct CollocationTable {
  int stages = 0;           ///< M
  Eigen::VectorXd gauss;    ///< M Gauss points in (0, 1)
  Eigen::VectorXd weight;   ///< their weights, sum 1
  Eigen::VectorXd lobatto;  ///< M + 1 Lagrange points, lobatto(0) = 0, lobatto(M) = 1
  Eigen::MatrixXd value;    ///< value(g, i) = φ_i(gauss(g)); M × (M+1)
  Eigen::MatrixXd slope;    ///< slope(g, i) = φ_i'(gauss(g)); M × (M+1)
  Eigen::MatrixXd integral;  ///< ∫₀^lobatto(i) of the interpolant of values at the Gauss points; (M+1) × M
  Eigen::RowVectorXd highest;  ///< coefficient of the Legendre polynomial of degree M; M+1
  Eigen::MatrixXd end_slope;   ///< φ_i' at the Lagrange points, (M+1) × (M+1)

  /// The table for `stages` stages; built on first use, immutable after.
  /// @throws std::invalid_argument outside [min_stages, max_stages + 1].
  static const CollocationTable& get(int stages);
};

inline constexpr int min_stages = 2;
inline constexpr int max_stages = 8;

/// Values of the Lagrange basis through `nodes` at x. Shape nodes.size().
Eigen::VectorXd lagrange_basis(const Eigen::VectorXd& nodes, double x);
/// Its derivatives.
Eigen::VectorXd lagrange_slopes(const Eigen::VectorXd& nodes, double x);
/// Gauss-Legendre points on [0, 1], ascending.
Eigen::VectorXd gauss_points(int stages);
/// Gauss-Lobatto points on [0, 1], ascending, stages + 1 of them.
Eigen::VectorXd lobatto_points(int stages);

/// ∫₀^gauss(g) φ_k over [0, 1], φ the Lagrange basis of the Gauss points: the stages of Gauss' method. M × M
Eigen::MatrixXd gauss_stages(const CollocationTable& table);

}  // namespace windlass::bvp
