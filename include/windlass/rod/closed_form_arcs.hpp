#pragma once

#include "windlass/bvp/arc.hpp"

/// Arcs whose action is known exactly: no mesh where a formula will do.
namespace windlass::rod {

/// Line contact of the planar rod with the unit circle: S = ℓ (½ EI (1 − κ̂)² − n_a); no configuration of its own.
/// n_a is the conserved axial torque, n_a = n_t + EI (1 − κ̂) on the circle; the pressure is p = n_t.
class PlanarLineArc final : public bvp::Arc {
 public:
  explicit PlanarLineArc(double bending_stiffness = 1.0, double natural_curvature = 0.0)
      : stiffness_(bending_stiffness), strain_(1.0 - natural_curvature) {}
  int ambient() const override { return 0; }
  int tangent() const override { return 0; }
  int forces() const override { return 1; }
  void gradient(const bvp::ArcPoint& at, double* interior, bvp::EndsVector& ends) const override;
  void factor(const bvp::ArcPoint& at, bvp::EndsMatrix& condensed) override;
  void hessian(const bvp::ArcPoint& at, std::vector<Eigen::Triplet<double>>& entries) const override;
  Eigen::VectorXd metric(const bvp::ArcPoint& at) const override;
  bvp::ArcSamples sample(const bvp::ArcPoint& at) const override;
  double energy(const bvp::ArcPoint& at) const override {
    return 0.5 * stiffness_ * strain_ * strain_ * at.length;
  }
  std::unique_ptr<bvp::Arc> remeshed(const std::vector<double>&, int) const override {
    return std::make_unique<PlanarLineArc>(*this);
  }
  Eigen::VectorXd transfer(const bvp::ArcPoint&, const bvp::Arc&) const override { return {}; }

 private:
  double stiffness_, strain_;
};

/// The same of a rod that stretches by λ, k = 1/EA: on the circle its curvature is λ a reference length, and
/// S/ℓ = stat_λ [½ B (λ − κ̂)² + (λ − 1)²/2k − λ n_a]. With N = n_a + B κ̂:
///
///     λ = (1 + k N)/(1 + k B),   S = ℓ [½ B κ̂² + ½ (B − 2N − k N²)/(1 + k B)],   n_t = (λ − 1)/k = (N − B)/(1 + k B),   p = λ n_t.
class ExtensiblePlanarLineArc final : public bvp::Arc {
 public:
  explicit ExtensiblePlanarLineArc(double bending_stiffness = 1.0, double natural_curvature = 0.0)
      : stiffness_(bending_stiffness), natural_(natural_curvature) {}
  int ambient() const override { return 0; }
  int tangent() const override { return 0; }
  int forces() const override { return 1; }
  void gradient(const bvp::ArcPoint& at, double* interior, bvp::EndsVector& ends) const override;
  void factor(const bvp::ArcPoint& at, bvp::EndsMatrix& condensed) override;
  void hessian(const bvp::ArcPoint& at, std::vector<Eigen::Triplet<double>>& entries) const override;
  Eigen::VectorXd metric(const bvp::ArcPoint&) const override { return Eigen::VectorXd::Zero(2); }
  bvp::ArcSamples sample(const bvp::ArcPoint& at) const override;
  double energy(const bvp::ArcPoint& at) const override;
  std::unique_ptr<bvp::Arc> remeshed(const std::vector<double>&, int) const override {
    return std::make_unique<ExtensiblePlanarLineArc>(*this);
  }
  Eigen::VectorXd transfer(const bvp::ArcPoint&, const bvp::Arc&) const override { return {}; }

 private:
  double stiffness_, natural_;
};
/// λ of a planar rod on the unit circle under the axial torque n_a.
inline double stretch_on_circle(double bending_stiffness, double natural_curvature, double torque,
                                double compliance) {
  return (1.0 + compliance * (torque + bending_stiffness * natural_curvature)) /
         (1.0 + compliance * bending_stiffness);
}

/// Tail without torsion under the dead pull n, infinite or with a moment-free end: the elastica in the plane of n and the
/// first tangent. With ψ the angle between them and R = √(B T), the infinite tail is the homoclinic one, tan(ψ/4) falls as
/// exp(−√(T/B) s), and the action over the straight rod is
///
///     S = 4 R (1 − cos(ψ/2)),   dS/dψ = −m = 2 R sin(ψ/2).
///
/// A tail of length ℓ ends at the angle ψ_e with sin²(ψ_e/2) = ρ sin²(ψ/2) (free_end.hpp), and
///
///     ∂S/∂ψ = 2 R sin(ψ/2) √(1 − ρ),   ∂S/∂ℓ = −T cos ψ_e.
///
/// `dimension` 2: configuration θ; 3: unit quaternion. The end of the arc (q_b, or q_a of a tail to the left) carries
/// nothing; derivatives by n are not made, since it is given. A finite tail is a minimum of its energy for |ψ| < π, so
/// nothing unstable hides in it (Sturm: the variation that leaves its end free does not vanish before ψ = π).
class TailArc final : public bvp::Arc {
 public:
  enum class End { infinite, moment_free };
  explicit TailArc(int dimension, double bending_stiffness = 1.0, bool starts_here = true,
                   End end = End::infinite)
      : dimension_(dimension), stiffness_(bending_stiffness), starts_here_(starts_here), end_(end) {}
  int ambient() const override { return dimension_ == 2 ? 1 : 4; }
  int tangent() const override { return dimension_ == 2 ? 1 : 3; }
  int forces() const override { return dimension_; }
  void gradient(const bvp::ArcPoint& at, double* interior, bvp::EndsVector& ends) const override;
  void factor(const bvp::ArcPoint& at, bvp::EndsMatrix& condensed) override;
  void hessian(const bvp::ArcPoint& at, std::vector<Eigen::Triplet<double>>& entries) const override;
  Eigen::VectorXd metric(const bvp::ArcPoint& at) const override;
  bvp::ArcSamples sample(const bvp::ArcPoint& at) const override;
  double energy(const bvp::ArcPoint& at) const override;
  std::unique_ptr<bvp::Arc> remeshed(const std::vector<double>&, int) const override {
    return std::make_unique<TailArc>(*this);
  }
  Eigen::VectorXd transfer(const bvp::ArcPoint&, const bvp::Arc&) const override { return {}; }

  /// Configurations at distances from the joint, ascending from zero [ρ]; ambient × N. For a mesh in the formula's place.
  Eigen::MatrixXd configurations(const bvp::ArcPoint& at, const Eigen::VectorXd& distances) const;
  /// √(B/T): what a tail that is almost straight decays over [ρ].
  double decay_length(const bvp::ArcPoint& at) const;
  bool starts_at_joint() const { return starts_here_; }
  bool infinite() const { return end_ == End::infinite; }

 private:
  struct State;
  struct Place;
  struct FromEnd;
  State state(const bvp::ArcPoint& at) const;
  Place place(const State& state, double length, int sample) const;
  double half_sine_squared(const State& state, double length, double distance, FromEnd& near) const;
  bvp::EndsMatrix ends_hessian(const bvp::ArcPoint& at) const;

  int dimension_;
  double stiffness_;
  bool starts_here_;  ///< true: runs from a joint outward, s growing; false: from s = −∞, or −L/2, to a joint
  End end_;
};

}  // namespace windlass::rod
