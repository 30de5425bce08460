#include "windlass/rod/weld_arc.hpp"

namespace windlass::rod {

void WeldArc::gradient(const bvp::ArcPoint& at, double*, bvp::EndsVector& ends) const {
  ends.setZero(this->ends());
  for (int i = 0; i < forces_; ++i) ends(2 * tangent_ + i) = -at.n[i];
}

void WeldArc::factor(const bvp::ArcPoint&, bvp::EndsMatrix& condensed) {
  condensed.setZero(ends(), ends());
  for (int i = 2 * tangent_; i < 2 * tangent_ + forces_; ++i) condensed(i, i) = -1.0;
}

void WeldArc::hessian(const bvp::ArcPoint&, std::vector<Eigen::Triplet<double>>& entries) const {
  for (int i = 2 * tangent_; i < 2 * tangent_ + forces_; ++i) entries.emplace_back(i, i, -1.0);
}

bvp::ArcSamples WeldArc::sample(const bvp::ArcPoint& at) const {
  bvp::ArcSamples out{Eigen::Vector2d(0.0, 1.0),
                      Eigen::MatrixXd(ambient_, 2),
                      Eigen::MatrixXd::Zero(tangent_, 2),
                      Eigen::MatrixXd::Zero(forces_, 2),
                      {}};
  out.q.colwise() = Eigen::Map<const Eigen::VectorXd>(at.q_a, ambient_);
  out.nodes = {0, 1};
  return out;
}

}  // namespace windlass::rod
