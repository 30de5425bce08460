#pragma once

#include "windlass/bvp/arc.hpp"

/// Arcs whose action is known exactly: no mesh where a formula will do.
namespace windlass::rod {

/// Line contact of the planar rod with the unit circle: S = ℓ (½ EI − n_a); no configuration of its own.
/// n_a is the conserved axial torque, n_a = n_t + EI on the circle; the pressure is p = n_t.
class PlanarLineArc final : public bvp::Arc {
 public:
  explicit PlanarLineArc(double bending_stiffness = 1.0) : stiffness_(bending_stiffness) {}
  int ambient() const override { return 0; }
  int tangent() const override { return 0; }
  int forces() const override { return 1; }
  void gradient(const bvp::ArcPoint& at, double* interior, bvp::EndsVector& ends) const override;
  void factor(const bvp::ArcPoint& at, bvp::EndsMatrix& condensed) override;
  void hessian(const bvp::ArcPoint& at, std::vector<Eigen::Triplet<double>>& entries) const override;
  Eigen::VectorXd metric(const bvp::ArcPoint& at) const override;
  bvp::ArcSamples sample(const bvp::ArcPoint& at) const override;
  double energy(const bvp::ArcPoint& at) const override { return 0.5 * stiffness_ * at.length; }
  std::unique_ptr<bvp::Arc> remeshed(const std::vector<double>&, int) const override {
    return std::make_unique<PlanarLineArc>(stiffness_);
  }
  Eigen::VectorXd transfer(const bvp::ArcPoint&, const bvp::Arc&) const override { return {}; }

 private:
  double stiffness_;
};

/// Infinite tail without torsion under the dead pull n: the homoclinic elastica in the plane of n and the first
/// tangent. With ψ the angle between them, tan(ψ/4) falls as exp(−√(T/B) s), and the action over the straight rod is
///
///     S = 4 √(B T) (1 − cos(ψ/2)),   dS/dψ = −m = 2 √(B T) sin(ψ/2).
///
/// `dimension` 2: configuration θ; 3: unit quaternion. The end of the arc (q_b, ℓ) carries nothing.
class TailArc final : public bvp::Arc {
 public:
  explicit TailArc(int dimension, double bending_stiffness = 1.0, bool starts_here = true)
      : dimension_(dimension), stiffness_(bending_stiffness), starts_here_(starts_here) {}
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
    return std::make_unique<TailArc>(dimension_, stiffness_, starts_here_);
  }
  Eigen::VectorXd transfer(const bvp::ArcPoint&, const bvp::Arc&) const override { return {}; }

 private:
  struct Derivatives;
  Derivatives derivatives(const bvp::ArcPoint& at) const;

  int dimension_;
  double stiffness_;
  bool starts_here_;  ///< true: runs from a joint to s = +∞; false: from s = −∞ to a joint
};

}  // namespace windlass::rod
