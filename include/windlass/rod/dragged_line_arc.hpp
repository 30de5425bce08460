#pragma once

#include <array>

#include "windlass/bvp/collocation_table.hpp"
#include "windlass/rod/dense_arc.hpp"
#include "windlass/rod/surface_density.hpp"

namespace windlass::rod {

/// Direction of slip d = (e_z − ω t)/|e_z − ω t| on the unit cylinder that moves along +e_z, in (e_θ, e_z), of a rod with the
/// inclination ψ that runs along itself at ω times the cylinder's speed; with its derivatives.
struct Slip {
  Eigen::Vector2d d, by_psi, by_travel;
};
Slip slip(double psi, double travel);

/// Pressure p of a line contact on the unit cylinder as a function of (ψ, χ, ψ', χ') and of n = (n_a, n_z) there [EI/ρ³].
struct LinePressure {
  double p = 0.0;
  Eigen::Vector4d by_z;
  Eigen::Vector2d by_n;
};
LinePressure line_pressure(const SurfaceDensity& rod, const Eigen::Vector2d& q, const Eigen::Vector2d& slope,
                           const Eigen::Vector2d& n);

/// Line contact on the unit cylinder that slips along the rod: the contact force per length is p (e_r + mu d). The equations of
/// ψ and χ are those of SurfaceDensity with the forces of the place, and
///
///     n_a' = −mu p d_θ,   n_z' = −mu p d_z,
///
/// p a function of state and n. Collocated at the Gauss points like the rest (bvp/collocation_table.hpp): order 2M at the
/// nodes. Count: 2(NM − 1) interior unknowns (ψ, χ) and as many equations; n follows along the arc, element by element, from
/// n(0), so that its derivatives reach all that lies before: the matrix is full, and not symmetric.
class DraggedLineArc final : public DenseArc {
 public:
  DraggedLineArc(const SurfaceDensity& rod, const std::vector<double>& mesh, int stages);

  int ambient() const override { return 2; }
  int tangent() const override { return 2; }
  int forces() const override { return 2; }
  int carried() const override { return 2; }
  int interior_nodes() const override { return still_->interior_nodes(); }
  int elements() const override { return still_->elements(); }
  int stages() const override { return still_->stages(); }
  std::vector<double> mesh() const override { return still_->mesh(); }

  void gradient(const bvp::ArcPoint& at, double* interior, bvp::EndsVector& ends) const override;
  Eigen::VectorXd metric(const bvp::ArcPoint& at) const override;
  bvp::ArcSamples sample(const bvp::ArcPoint& at) const override;
  double energy(const bvp::ArcPoint& at) const override { return still_->energy(at); }
  std::vector<double> resolution(const bvp::ArcPoint& at) const override { return still_->resolution(at); }
  std::unique_ptr<bvp::Arc> remeshed(const std::vector<double>& mesh, int stages) const override {
    return std::make_unique<DraggedLineArc>(rod_, mesh, stages);
  }
  Eigen::VectorXd transfer(const bvp::ArcPoint& at, const bvp::Arc& target) const override {
    return still_->transfer(at, target);
  }

 private:
  static constexpr int max_points = bvp::max_stages + 2, max_local = 2 * max_points + 1;
  /// One element at a state: forces at the Gauss points and what the density says there.
  struct Element {
    Eigen::Matrix<double, 2, Eigen::Dynamic, 0, 2, max_points> nodes, q, slope, n, rate;
    std::array<LinePressure, max_points> pressure;
    std::array<Slip, max_points> slips;
    Eigen::Vector2d n_end;
  };
  const double* node(const bvp::ArcPoint& at, int k) const;
  /// Place of component j of node k in the arc's list (interior, q_a, q_b, n, ℓ, ω, nothing).
  int place(int k, int j) const;
  void evaluate(const bvp::ArcPoint& at, int element, const Eigen::Vector2d& n, Element& out) const;
  void element_gradient(const bvp::ArcPoint& at, int element, const Element& state,
                        Eigen::Matrix<double, 2, Eigen::Dynamic, 0, 2, max_points>& g,
                        Eigen::Vector2d& displacement) const;
  void linearise(const bvp::ArcPoint& at) const override;
  /// Adds an element's share; carry_: change of n at its start, and on return at its end.
  void linearise(const bvp::ArcPoint& at, int element, const Element& state) const;

  SurfaceDensity rod_;
  std::unique_ptr<bvp::Arc> still_;  ///< the same arc on a cylinder that stands
  std::vector<double> mesh_;
  const bvp::CollocationTable& table_;
  Eigen::MatrixXd stage_;  ///< a(g, k): ∫₀^gauss(g) of the interpolant of values at the Gauss points
  mutable Eigen::MatrixXd carry_, at_stages_;  // work space
};

}  // namespace windlass::rod
