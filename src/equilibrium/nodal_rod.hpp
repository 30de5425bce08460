#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <vector>

#include "windlass/equilibrium/discovery.hpp"

namespace windlass::equilibrium {

/// The complementarity problem of discover_contacts(): residual, Jacobian, first guess.
///
/// Unknowns of node k: θ, x, y, λ; of element e (from node e to e + 1): n_x, n_y. Residuals in the same places:
/// balance of moment, balance of force (2), gap; closure of the element (2).
class NodalRod {
 public:
  using Vector = Eigen::VectorXd;
  using Sparse = Eigen::SparseMatrix<double>;

  NodalRod(const contact::Loads& loads, const DiscoveryOptions& options);

  Eigen::Index size() const { return stride * nodes() - 2; }
  int nodes() const { return static_cast<int>(s_.size()); }
  const std::vector<double>& s() const { return s_; }
  double tension() const { return loads_.tension; }
  void set_tension(double tension) { loads_.tension = tension; }
  /// Nodes lifted by less than this do not part a contact in two: just inside a line's edge some rise by O(h³).
  double near_contact() const { return 0.5 * length(0) * length(0); }
  /// Number of nodes within reach of the cylinder; those of the coarse tail come after.
  int near_nodes() const { return near_nodes_; }

  static Eigen::Index theta(int node) { return stride * node; }
  static Eigen::Index position(int node) { return stride * node + 1; }
  static Eigen::Index contact_force(int node) { return stride * node + 3; }
  static Eigen::Index internal_force(int element) { return stride * element + 4; }

  /// The planar state with infinite tails in closed form: line contact up to the edge, then the homoclinic tail.
  /// Exact but for the mesh where line contact exists, T >= line_contact_limit().
  Vector first_guess() const;
  Vector residual(const Vector& x) const;
  Sparse jacobian(const Vector& x) const;

 private:
  static constexpr Eigen::Index stride = 6;
  using Triplets = std::vector<Eigen::Triplet<double>>;

  double length(int element) const { return s_[element + 1] - s_[element]; }
  Eigen::Vector2d pull() const;
  /// Unknowns whose place or direction is given: symmetry at s = 0, a clamped end.
  std::vector<std::pair<Eigen::Index, double>> held() const;
  void add_element(const Vector& x, int element, Vector& f) const;
  void add_element(const Vector& x, int element, Triplets& entries) const;

  contact::Loads loads_;
  bool clamped_;
  int near_nodes_ = 0;
  std::vector<double> s_;
};

}  // namespace windlass::equilibrium
