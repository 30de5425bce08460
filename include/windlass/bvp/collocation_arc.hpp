#pragma once

#include <memory>

#include "windlass/bvp/arc.hpp"
#include "windlass/bvp/collocation_table.hpp"
#include "windlass/bvp/lagrangian.hpp"
#include "windlass/bvp/partial_elimination.hpp"

namespace windlass::bvp {

/// An arc discretised by Gauss collocation of a Lagrangian density
///
///     L(q, q', n) = W(q, q') − n·d(q)
///
/// given with first and second derivatives (LagrangianOf<Density>). `Configuration` says what a q is: `basis(q)`
/// (ambient × tangent) spans its increments, and `radial(q, g)` is the second derivative of the retraction contracted
/// with an ambient gradient g (unit quaternions have one, plain coordinates have none). A density that says `stretches`
/// is evaluated with the compliance 1/EA, too; its d = −∂L/∂n then depends on q' and n as well, and n may fall along the
/// arc by a known force w a length, n(s) = n − w s (PHYSICS, "Rods that stretch").
///
/// With N elements of M stages: (N·M − 1)·tangent interior unknowns, condensed to 2·tangent + forces + 1 at the ends,
/// element by element and then node by node. Nothing is allocated after construction.
template <class Configuration, int P>
class CollocationArc final : public Arc {
 public:
  static constexpr int A = Configuration::ambient;
  static constexpr int D = Configuration::tangent;
  static constexpr int E = 2 * D + P + 1;  ///< ends of an element: left node, right node, n, ℓ
  using Density = Lagrangian<A, P>;

  CollocationArc(std::shared_ptr<const Density> density, std::vector<double> mesh, int stages);

  int ambient() const override { return A; }
  int tangent() const override { return D; }
  int forces() const override { return P; }
  int interior_nodes() const override { return elements() * stages() - 1; }
  int elements() const override { return static_cast<int>(mesh_.size()) - 1; }
  int stages() const override { return table_.stages; }
  std::vector<double> mesh() const override { return mesh_; }

  void gradient(const ArcPoint& at, double* interior, EndsVector& ends) const override;
  void factor(const ArcPoint& at, EndsMatrix& condensed) override;
  void reduce(double* rhs_interior, EndsVector& rhs_ends) const override;
  void expand(double* interior, const EndsVector& solution_ends) const override;
  int negative_pivots() const override { return negative_; }
  std::span<const Held> held() const override { return {held_.data(), held_count_}; }
  void hessian(const ArcPoint& at, std::vector<Eigen::Triplet<double>>& entries) const override;
  Eigen::VectorXd metric(const ArcPoint& at) const override;
  ArcSamples sample(const ArcPoint& at) const override;
  double energy(const ArcPoint& at) const override;
  std::vector<double> resolution(const ArcPoint& at) const override;
  std::unique_ptr<Arc> remeshed(const std::vector<double>& mesh, int stages) const override;
  Eigen::VectorXd transfer(const ArcPoint& at, const Arc& target) const override;

 private:
  using Nodes = typename Sections<A, P>::Columns;  ///< one element's configurations
  using Ambient = Eigen::Matrix<double, A, 1>;
  using Force = Eigen::Matrix<double, P, 1>;
  using Firsts = std::array<typename Density::First, max_sections>;
  using Seconds = std::array<typename Density::Second, max_sections>;

  /// How far along the arc Gauss point g of an element is.
  double along(const ArcPoint& at, int element, int g) const {
    return at.length * (mesh_[element] + (mesh_[element + 1] - mesh_[element]) * table_.gauss(g));
  }
  /// Pointer to the k-th configuration of the arc (0 the start, interior_nodes() + 1 the end).
  const double* node(const ArcPoint& at, int k) const;
  void gather(const ArcPoint& at, int element, Nodes& q) const;
  /// The element's Gauss points.
  void gauss_sections(const Nodes& q, const ArcPoint& at, int element, Sections<A, P>& out) const;
  /// Gradient of one element's action, one ambient column a Lagrange point; force and length parts are added to.
  /// @param sections  its Gauss points, used up
  /// @param first     the density there
  void element_gradient(Sections<A, P>& sections, const Firsts& first, const ArcPoint& at, int element,
                        Nodes& g, Force& g_n, double& g_length) const;
  /// Hessian of one element's action, ordered interior, left, right, n, ℓ; lower triangle valid.
  void element_hessian(const Nodes& q, const ArcPoint& at, int element, Eigen::MatrixXd& k) const;
  void vector_hessian(const Nodes& q, const ArcPoint& at, int element, Eigen::MatrixXd& k) const;
  /// The same for A = 1, where a product for each pair of Lagrange points is all there is.
  void scalar_hessian(const Nodes& q, const ArcPoint& at, int element, Eigen::MatrixXd& k) const
      requires(Configuration::ambient == 1);
  /// Stiffens the last node, about to be eliminated, where all that resists a motion of it has cancelled.
  /// @param parts  the size of the terms that its block is a sum of
  void hold_node(Eigen::MatrixXd& block, double parts);
  int inner() const { return D * (stages() - 1); }  ///< interior unknowns of an element
  /// Column of an element matrix where the unknowns of Lagrange point i start.
  int column(int i) const { return i == 0 ? inner() : i == stages() ? inner() + D : (i - 1) * D; }
  /// Place of unknown `column` of element e in the arc's list (interior, q_a, q_b, n, ℓ).
  int place(int element, int column) const;

  std::shared_ptr<const Density> density_;
  std::vector<double> mesh_;
  const CollocationTable& table_;
  std::vector<PartialElimination> element_factors_, node_factors_;
  int negative_ = 0;
  std::array<Held, D> held_;
  std::size_t held_count_ = 0;
  // Work space, so that Newton's inner loop allocates nothing.
  mutable Eigen::MatrixXd element_, node_;
};

/// Builds a CollocationArc of a density with `stages` stages.
/// @throws std::invalid_argument outside [min_stages, max_stages + 1].
template <class Density>
std::unique_ptr<Arc> make_collocation_arc(const Density& density, const std::vector<double>& mesh,
                                          int stages) {
  return std::make_unique<CollocationArc<typename Density::Configuration, Density::forces>>(
      std::make_shared<LagrangianOf<Density>>(density), mesh, stages);
}

}  // namespace windlass::bvp

extern template class windlass::bvp::CollocationArc<windlass::bvp::Coordinates<1>, 2>;
extern template class windlass::bvp::CollocationArc<windlass::bvp::Coordinates<2>, 2>;
