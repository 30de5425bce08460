#pragma once

#include "windlass/bvp/arc.hpp"

/// The arc of no length between two joints at one place.
namespace windlass::rod {

/// Both ends of it are one section, whose unknowns the two joints share (chain::Link::weld): its force n acts on that section twice,
/// with opposite signs, and drops out. S = −½|n|² sets it to zero, with one negative direction a component, as multipliers have.
class WeldArc final : public bvp::Arc {
 public:
  /// @param like  an arc between such joints
  explicit WeldArc(const bvp::Arc& like)
      : ambient_(like.ambient()), tangent_(like.tangent()), forces_(like.forces()) {}
  int ambient() const override { return ambient_; }
  int tangent() const override { return tangent_; }
  int forces() const override { return forces_; }
  void gradient(const bvp::ArcPoint& at, double* interior, bvp::EndsVector& ends) const override;
  void factor(const bvp::ArcPoint& at, bvp::EndsMatrix& condensed) override;
  void hessian(const bvp::ArcPoint& at, std::vector<Eigen::Triplet<double>>& entries) const override;
  Eigen::VectorXd metric(const bvp::ArcPoint&) const override { return Eigen::VectorXd::Zero(ends()); }
  bvp::ArcSamples sample(const bvp::ArcPoint& at) const override;
  double energy(const bvp::ArcPoint&) const override { return 0.0; }
  std::unique_ptr<bvp::Arc> remeshed(const std::vector<double>&, int) const override {
    return std::make_unique<WeldArc>(*this);
  }
  Eigen::VectorXd transfer(const bvp::ArcPoint&, const bvp::Arc&) const override { return {}; }

 private:
  int ambient_, tangent_, forces_;
};

}  // namespace windlass::rod
