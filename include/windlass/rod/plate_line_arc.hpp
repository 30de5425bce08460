#pragma once

#include "windlass/bvp/arc.hpp"

namespace windlass::rod {

/// Line contact of a rod with the unit cylinder and a plate z = const at once: an arc of the circle, ψ = 0. Configuration χ, the
/// twist; force n_a round the axis. With u₃ = χ' constant,
///
///     S = ½ B ℓ + ½ C (χ_b − χ_a)²/ℓ − n_a ℓ,   p = n_a − B,   n_a' = −mu p d_θ,   d = (−ω, 1)/√(1 + ω²),
///
/// so that p grows as exp(λ s), λ = mu ω/√(1 + ω²). The plate takes what friction pushes up, mu p d_z [EI/ρ³]; n_z = m₃.
///
/// Of a rod that stretches by λ = (1 + k n_a)/(1 + kB) a reference length, a' = λ and p = λ n_θ, n_θ = n_a − Bλ the tension:
///
///     S = ½ ℓ (B − 2 n_a − k n_a²)/(1 + kB) + ½ C (χ_b − χ_a)²/ℓ,
///
/// where it does not run along itself, ω = 0; n_a' = mu ω λ p is of first order in ω, for Newton's method towards that
/// (PHYSICS, "Stretch while sliding").
class PlateLineArc final : public bvp::Arc {
 public:
  PlateLineArc(double bending_stiffness, double twisting_stiffness)
      : bending_(bending_stiffness), twisting_(twisting_stiffness) {}
  int ambient() const override { return 1; }
  int tangent() const override { return 1; }
  int forces() const override { return 1; }
  int carried() const override { return 1; }
  void gradient(const bvp::ArcPoint& at, double* interior, bvp::EndsVector& ends) const override;
  void factor(const bvp::ArcPoint& at, bvp::EndsMatrix& condensed) override { condensed = matrix(at); }
  void hessian(const bvp::ArcPoint& at, std::vector<Eigen::Triplet<double>>& entries) const override;
  Eigen::VectorXd metric(const bvp::ArcPoint& at) const override;
  /// As a line on the cylinder has them: q = (ψ, χ), momenta of both, displacement and force round and along the axis.
  bvp::ArcSamples sample(const bvp::ArcPoint& at) const override;
  double energy(const bvp::ArcPoint& at) const override;
  std::unique_ptr<bvp::Arc> remeshed(const std::vector<double>&, int) const override {
    return std::make_unique<PlateLineArc>(*this);
  }
  Eigen::VectorXd transfer(const bvp::ArcPoint&, const bvp::Arc&) const override { return {}; }

 private:
  /// What stretch makes of an arc.
  struct Stretched {
    double stretch, soft;    ///< λ and its derivative with n_a
    double around;           ///< n_θ
    double action;           ///< S a length, but for the twist
    double drag, drag_by_n;  ///< n_a' over ω, and its derivative
  };
  Stretched stretched(const bvp::ArcPoint& at) const;
  static double growth(const bvp::ArcPoint& at);  ///< λ
  bvp::EndsMatrix matrix(const bvp::ArcPoint& at) const;
  double bending_, twisting_;
};

}  // namespace windlass::rod
