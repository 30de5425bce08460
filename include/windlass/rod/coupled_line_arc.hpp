#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "windlass/bvp/collocation_table.hpp"
#include "windlass/rod/dense_arc.hpp"
#include "windlass/rod/layered_line.hpp"

namespace windlass::rod {

/// Line contact on the unit cylinder that slips along the rod, where the friction turns the rod about its centre line, acting `arm` = r
/// below it, or stretches it, by k = 1/EA: force p (e_r + mu d) and moment r mu p (d_b t − d_t b) a length (PHYSICS, "The moment of the
/// friction", "Stretch while sliding"). With w = mu d_t (r + k B cos²ψ)/E
///
///     n_a' = −mu p d_θ (1 − r),   n_z' = −mu p d_z,   M' = −r mu p d_b,   (w p)' = (1 − α) p − p₀,
///
/// p₀ the pressure of (ψ, χ, n) on a cylinder that stands, α and E as of LayeredSection, ψ as on a cylinder that stands. p is carried
/// against the sign of w and decays within |w|: a discontinuous polynomial of degree M − 1 an element, its flux w p̂ taken from where it
/// comes from. Where it comes from beyond an end it is the force F there, the end's third coordinate (contact::spatial::CoupledEdge).
///
/// Count: 2(NM − 1) interior unknowns (ψ, χ) and as many equations; p (NM) and n (2NM) follow from them, n(0) and the fluxes in, by as
/// many equations, linear where k = 0. The gradient's third entry at an end is ∓n_N there, without what flows in: the force along the
/// normal that the edge balances.
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
  double energy(const bvp::ArcPoint& at) const override;
  std::vector<double> resolution(const bvp::ArcPoint& at) const override;
  std::unique_ptr<bvp::Arc> remeshed(const std::vector<double>& mesh, int stages) const override {
    return std::make_unique<CoupledLineArc>(rod_, mesh, stages);
  }
  Eigen::VectorXd transfer(const bvp::ArcPoint& at, const bvp::Arc& target) const override {
    return still_->transfer(at, target);
  }

 private:
  /// Forms of the change of something with the arc's list, as rows.
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  /// The arc at a state: what is at its Gauss points, and where elements end.
  struct State {
    Eigen::Matrix2Xd q, slope, n;
    Eigen::VectorXd p;
    std::vector<LayeredSection> at;
    std::vector<double> tilt;                     ///< w E where elements end
    Eigen::VectorXd flux;                         ///< w p̂ there
    Eigen::PartialPivLU<Eigen::MatrixXd> system;  ///< of p's equations, n following
    Rows n_by_p;                                  ///< 2(NM + 1) × NM, the last two rows at the end
    Eigen::Vector2d n_end;
    Eigen::MatrixXd nodal;  ///< gradient at all nodes, 2 × (NM + 1)
    Eigen::Vector2d displacement;
  };

  static constexpr int own = LayeredSection::around;  ///< variables of a section before n and ω
  int points() const { return elements() * stages(); }
  double step(const bvp::ArcPoint& at, int element) const {
    return (mesh_[element + 1] - mesh_[element]) * at.length;
  }
  static Friction friction(const bvp::ArcPoint& at) {
    return {at.friction, at.arm, at.compliance, at.travel};
  }
  const double* node(const bvp::ArcPoint& at, int k) const;
  /// Place of component j of node k in the arc's list (interior, q_a, q_b, n, ℓ, ω, nothing).
  int place(int k, int j) const;
  /// Share of what p drags at point k in the force at point g, over ℓ; of that at the end for g = points().
  double share(int g, int k) const;
  /// Does p flow in at an end, from beyond it?
  bool flows_in_at_start(const State& state) const { return state.tilt.front() < -narrowest_layer; }
  bool flows_in_at_end(const State& state) const { return state.tilt.back() > narrowest_layer; }
  bool flows_in(const State& state, int element_end) const {
    return (element_end == 0 && flows_in_at_start(state)) ||
           (element_end == elements() && flows_in_at_end(state));
  }

  State evaluate(const bvp::ArcPoint& at) const;
  void place_points(const bvp::ArcPoint& at, State& out) const;
  /// p and n at given (q, q'), by Newton's method.
  void solve_pressure(const bvp::ArcPoint& at, State& out) const;
  void look(const bvp::ArcPoint& at, State& out) const;
  /// One step of it. @returns how far p and n move
  double improve(const bvp::ArcPoint& at, State& out) const;
  /// n at the points and at the end by p and what drags there.
  Eigen::Matrix2Xd dragged_force(const bvp::ArcPoint& at, const State& state) const;
  void add_balance(const bvp::ArcPoint& at, State& out) const;
  /// ∂L/∂q at an element's Gauss points, less the moment that p has about t.
  Eigen::Matrix2Xd loads(const State& state, int element) const;
  /// Slopes at the Gauss points from the momentum, which is given at the start.
  void sharpen(const bvp::ArcPoint& at, Eigen::Vector2d momentum, State& state) const;
  /// The section at an end of the arc, by the momentum there.
  LayeredSection end_section(const bvp::ArcPoint& at, const State& state, bool start) const;
  /// Of changes of w p at the points the flux where elements end, from upwind; nothing where it flows in.
  Rows upwind(const State& state, const Rows& carried) const;
  /// p's equations, or their change, of w p and h w_j ((1 − α) p − p₀) at the points and of the flux where elements end.
  Rows pressure_rows(const Rows& carried, const Rows& sources, const Rows& flux) const;
  /// What n answers to `rhs`, at the points and at the end, where the drag there depends on it.
  Rows respond(const bvp::ArcPoint& at, const State& state, Rows rhs) const;
  /// ∫ of forms a length at the points, up to each point and to the end.
  Rows integrated(const bvp::ArcPoint& at, const std::vector<Rows>& rates) const;

  void linearise(const bvp::ArcPoint& at) const override;
  /// Changes of the variables ψ, ψ', χ' of a Gauss point's section.
  Rows motion(const bvp::ArcPoint& at, const State& state, int point) const;
  /// Change of a number of a Gauss point's section, n given by forms, ω in the list.
  Eigen::RowVectorXd change(const LayeredSection::Number& number, const Rows& motion,
                            const Eigen::Ref<const Rows>& n) const;
  void balance_rows(const bvp::ArcPoint& at, const State& state, const std::vector<Rows>& motions,
                    const Rows& n, const Rows& p) const;
  void end_rows(const bvp::ArcPoint& at, const State& state, const Rows& n, const Rows& flux) const;

  SurfaceDensity rod_;
  std::unique_ptr<bvp::Arc> still_;  ///< the same arc on a cylinder that stands
  std::vector<double> mesh_;
  const bvp::CollocationTable& table_;
  Eigen::MatrixXd stage_;              ///< as of DraggedLineArc
  Eigen::VectorXd at_start_, at_end_;  ///< basis of the Gauss points at an element's ends
  Eigen::MatrixXd rate_;               ///< (j, k): slope of the j-th of them at the k-th point
};

}  // namespace windlass::rod
