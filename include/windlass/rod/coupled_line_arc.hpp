#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "windlass/rod/dense_arc.hpp"
#include "windlass/rod/dragged_line_arc.hpp"

namespace windlass::rod {

/// Line contact on the unit cylinder that slips along the rod, whose friction acts at the rod's surface, `arm` = r below the centre
/// line: force p (e_r + mu d) and moment r mu p (d_b t − d_t b) a length (PHYSICS, "The moment of the friction"). With w = r mu d_t
///
///     n_a' = −mu p d_θ (1 − r),   n_z' = −mu p d_z,   M' = −r mu p d_b,   (w p)' = (1 − r mu d_b ψ') p − p₀,
///
/// p₀ the pressure of (ψ, χ, n) without moment (line_pressure), ψ as on a cylinder that stands. p is carried against the sign of w
/// and decays within |w|: a discontinuous polynomial of degree M − 1 an element, its flux w p̂ taken from where it comes from. Where
/// it comes from beyond an end it is the force F there, the end's third coordinate (contact::spatial::CoupledEdge).
///
/// Count: 2(NM − 1) interior unknowns (ψ, χ) and as many equations; p (NM) and n follow from them, n(0) and the fluxes in, by a
/// linear system. The gradient's third entry at an end is what flows out there: w p̂ at the start, −w p̂ at the end, or 0.
class CoupledLineArc final : public DenseArc {
 public:
  CoupledLineArc(const SurfaceDensity& rod, const std::vector<double>& mesh, int stages);

  int ambient() const override { return 3; }
  int tangent() const override { return 3; }
  int node_ambient() const override { return 2; }
  int node_tangent() const override { return 2; }
  int forces() const override { return 2; }
  int carried() const override { return 2; }
  int interior_nodes() const override { return still_->interior_nodes(); }
  int elements() const override { return still_->elements(); }
  int stages() const override { return still_->stages(); }
  std::vector<double> mesh() const override { return mesh_; }

  void gradient(const bvp::ArcPoint& at, double* interior, bvp::EndsVector& ends) const override;
  Eigen::VectorXd metric(const bvp::ArcPoint& at) const override;
  /// Widths |w| of the layers of pressure at its start and its end, 0 where it flows out [ρ].
  std::pair<double, double> layers(const bvp::ArcPoint& at) const;
  bvp::ArcSamples sample(const bvp::ArcPoint& at) const override;
  double energy(const bvp::ArcPoint& at) const override { return still_->energy(at); }
  std::vector<double> resolution(const bvp::ArcPoint& at) const override;
  std::unique_ptr<bvp::Arc> remeshed(const std::vector<double>& mesh, int stages) const override {
    return std::make_unique<CoupledLineArc>(rod_, mesh, stages);
  }
  Eigen::VectorXd transfer(const bvp::ArcPoint& at, const bvp::Arc& target) const override {
    return still_->transfer(at, target);
  }

 private:
  /// The arc at a state: what is at its Gauss points, and fluxes at the ends of elements.
  struct State {
    Eigen::Matrix2Xd q, slope, n, drag;                         ///< drag: −n' over p
    Eigen::VectorXd p, lever, lever_psi, lever_travel, across;  ///< w, its derivatives; r mu d_b
    Eigen::VectorXd node_lever, flux;                           ///< w and w p̂ where elements end
    std::vector<LinePressure> free;                             ///< p₀ and its derivatives
    std::vector<Slip> slips;
    Eigen::PartialPivLU<Eigen::MatrixXd> system;  ///< of p
    Eigen::Vector2d n_end;
    Eigen::MatrixXd nodal;  ///< gradient at all nodes, 2 × (NM + 1)
    Eigen::Vector2d displacement;
  };
  /// Forms of the change of something with the arc's list, as rows.
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  int points() const { return elements() * stages(); }
  double step(const bvp::ArcPoint& at, int element) const {
    return (mesh_[element + 1] - mesh_[element]) * at.length;
  }
  const double* node(const bvp::ArcPoint& at, int k) const;
  /// Place of component j of node k in the arc's list (interior, q_a, q_b, n, ℓ, ω, nothing).
  int place(int k, int j) const;
  /// Share of what p drags at point k in the force at point g, over ℓ; of that at the end for g = points().
  double share(int g, int k) const;
  /// Does p flow in at an end, from beyond it?
  static bool flows_in_at_start(double lever) { return lever < 0.0; }
  static bool flows_in_at_end(double lever) { return lever > 0.0; }

  State evaluate(const bvp::ArcPoint& at) const;
  void place_points(const bvp::ArcPoint& at, State& out) const;
  void solve_pressure(const bvp::ArcPoint& at, State& out) const;
  void add_balance(const bvp::ArcPoint& at, State& out) const;
  /// ∂L/∂q at an element's Gauss points, less the moment that p has about t.
  Eigen::Matrix2Xd loads(const State& state, int element) const;
  /// Slopes at the Gauss points from the momentum, which is given at the start.
  void sharpen(const bvp::ArcPoint& at, Eigen::Vector2d momentum, State& state) const;
  /// w p̂ where elements end, as forms in p.
  Rows fluxes(const State& state) const;
  void linearise(const bvp::ArcPoint& at) const override;
  /// Changes of (q, q') at a Gauss point.
  Eigen::Matrix<double, 4, Eigen::Dynamic> motion(const bvp::ArcPoint& at, const State& state,
                                                  int point) const;
  /// Residual of p's equations at given p and n, its change with the list.
  Rows pressure_rows(const bvp::ArcPoint& at, const State& state, const std::vector<Rows>& motions) const;
  /// Of the forces at the Gauss points and at the end, given those of what is dragged a length.
  Rows force_rows(const bvp::ArcPoint& at, const std::vector<Rows>& dragged) const;
  void balance_rows(const bvp::ArcPoint& at, const State& state, const std::vector<Rows>& motions,
                    const Rows& n, const Rows& p) const;

  SurfaceDensity rod_;
  std::unique_ptr<bvp::Arc> still_;  ///< the same arc on a cylinder that stands
  std::vector<double> mesh_;
  const bvp::CollocationTable& table_;
  Eigen::MatrixXd stage_;              ///< as of DraggedLineArc
  Eigen::VectorXd at_start_, at_end_;  ///< basis of the Gauss points at an element's ends
  Eigen::MatrixXd rate_;               ///< (j, k): slope of the j-th of them at the k-th point
};

}  // namespace windlass::rod
