#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <vector>

#include "windlass/contact/joint.hpp"

namespace windlass::discrete_rod {

/// The energy of `minimise`: value, gradient, Hessian. Unknowns: y_0, then (x, y) of every other node.
class Energy {
 public:
  using Vector = Eigen::VectorXd;
  using Sparse = Eigen::SparseMatrix<double>;

  /// Stiffnesses are set before anything is evaluated.
  Energy(const contact::Loads& loads, int edges, bool clamped);

  Eigen::Index size() const { return 2 * edges_ + 1; }
  void set_stiffness(double stretching, double penalty) { stretching_ = stretching, penalty_ = penalty; }

  Vector first_guess() const;
  double value(const Vector& x) const;
  Vector gradient(const Vector& x) const;
  /// Every entry of the pattern is stored, zeros too.
  Sparse hessian(const Vector& x) const;

  double bending(const Vector& x) const;
  double contact_force(const Vector& x) const;
  double last_contact_angle(const Vector& x) const;

 private:
  struct Sum;  ///< value and, where wanted, derivatives
  void add_stretching(const Vector& x, Sum& sum) const;
  void add_bending(const Vector& x, Sum& sum) const;
  void add_contact(const Vector& x, Sum& sum) const;
  Sum evaluate(const Vector& x, bool derivatives) const;
  Eigen::Vector2d node(const Vector& x, int k) const;
  Eigen::Vector2d edge(const Vector& x, int e) const { return node(x, e + 1) - node(x, e); }
  /// Place of node k's coordinate c among the unknowns; −1: held (x_0 = 0).
  static Eigen::Index place(int k, int c) { return k == 0 ? c - 1 : 2 * k - 1 + c; }
  double share(int k) const { return k == 0 ? 0.5 * h_ : h_; }  ///< length of half rod a node stands for

  int edges_;
  bool clamped_;
  double h_, angle_, stretching_ = 0.0, penalty_ = 0.0;
  Eigen::Vector2d pull_;
};

}  // namespace windlass::discrete_rod
