#include "windlass/verify/shadow.hpp"

#include <algorithm>
#include <cmath>

namespace windlass::verify {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Section <-> vector of the quantities that the arc integrates, each divided by its natural size so that least
/// squares weighs them alike: r and q by 1, m by √T, n by T.
class Packing {
 public:
  Packing(equilibrium::ArcKind kind, const Section& reference, double growth)
      : reference_(reference),
        size_(kind == equilibrium::ArcKind::line ? 13 : 10),
        moment_(std::max(1.0, growth)),
        force_(moment_ * moment_) {}

  Index size() const { return size_; }
  VectorXd pack(const Section& section) const {
    VectorXd x(size_);
    x.head<3>() = section.r;
    // of the two quaternions of a frame, the one near the reference's
    x.segment<4>(3) = section.q.dot(reference_.q) < 0.0 ? Eigen::Vector4d(-section.q) : section.q;
    x.segment<3>(7) = section.m / moment_;
    if (size_ == 13) x.tail<3>() = section.n / force_;
    return x;
  }
  Section unpack(const VectorXd& x) const {
    Section section = reference_;  // keeps n of a free arc
    section.r = x.head<3>();
    section.q = x.segment<4>(3);
    section.m = x.segment<3>(7) * moment_;
    if (size_ == 13) section.n = x.tail<3>() * force_;
    return section;
  }

 private:
  Section reference_;
  Index size_;
  double moment_, force_;
};

/// State of the Gauss-Newton iteration: stations, where each leads, and how.
struct Shooting {
  const Packing& packing;
  RodFlow& flow;
  double piece;                    // length of a piece
  std::vector<VectorXd> stations;  // M + 1

  VectorXd lead(const VectorXd& x) const {
    flow.restart(packing.unpack(x));
    return packing.pack(flow.advance(piece));
  }
  MatrixXd derivative(const VectorXd& x) const {
    constexpr double step = 1e-6;
    MatrixXd jacobian(packing.size(), packing.size());
    const VectorXd there = lead(x);
    for (Index j = 0; j < packing.size(); ++j) {
      VectorXd moved = x;
      moved[j] += step;
      jacobian.col(j) = (lead(moved) - there) / step;
    }
    return jacobian;
  }
  /// One step: with A the linearised matching, min |W(x+δ) - data|² subject to Aδ = -c as one saddle-point system.
  /// @return size of the step
  double improve(const VectorXd& first, const VectorXd& last);
};

double Shooting::improve(const VectorXd& first, const VectorXd& last) {
  const Index size = packing.size(), pieces = static_cast<Index>(stations.size()) - 1;
  const Index states = size * (pieces + 1), total = states + size * pieces;
  MatrixXd K = MatrixXd::Zero(total, total);
  VectorXd right = VectorXd::Zero(total);
  K.topLeftCorner(size, size).setIdentity();
  K.block(states - size, states - size, size, size).setIdentity();
  right.head(size) = first - stations.front();
  right.segment(states - size, size) = last - stations.back();
  for (Index k = 0; k < pieces; ++k) {
    const auto here = static_cast<std::size_t>(k);
    MatrixXd A(size, 2 * size);
    A << derivative(stations[here]), -MatrixXd::Identity(size, size);
    K.block(states + k * size, k * size, size, 2 * size) = A;
    K.block(k * size, states + k * size, 2 * size, size) = A.transpose();
    right.segment(states + k * size, size) = stations[here + 1] - lead(stations[here]);
  }
  const VectorXd step = K.partialPivLu().solve(right);
  for (Index k = 0; k <= pieces; ++k) stations[static_cast<std::size_t>(k)] += step.segment(k * size, size);
  return step.head(states).lpNorm<Eigen::Infinity>();
}

/// Cubic through the two samples where rates are known (position, frame), straight lines elsewhere.
Section guess(const Section& a, const Section& b, double h, double x) {
  const double h00 = (1 + 2 * x) * (1 - x) * (1 - x), h10 = x * (1 - x) * (1 - x), h01 = x * x * (3 - 2 * x),
               h11 = x * x * (x - 1);
  Section section;
  section.r = h00 * a.r + h * h10 * tangent(a) + h01 * b.r + h * h11 * tangent(b);
  const Eigen::Quaterniond qa(a.q[0], a.q[1], a.q[2], a.q[3]), qb(b.q[0], b.q[1], b.q[2], b.q[3]);
  const Eigen::Quaterniond q = qa.slerp(x, qb);
  section.q << q.w(), q.x(), q.y(), q.z();
  section.m = h00 * a.m + h * h10 * a.n.cross(tangent(a)) + h01 * b.m + h * h11 * b.n.cross(tangent(b));
  section.n = (1 - x) * a.n + x * b.n;
  return section;
}

}  // namespace

Shadow find_shadow(RodFlow& flow, equilibrium::ArcKind kind, const Section& first, const Section& last,
                   double h, double growth) {
  constexpr int most_pieces = 40, most_iterations = 8;
  const int pieces = std::clamp(static_cast<int>(std::ceil(growth * h / 3.0)), 2, most_pieces);
  const Packing packing(kind, first, growth);
  Shooting shooting{packing, flow, h / pieces, {}};
  for (int k = 0; k <= pieces; ++k) {
    shooting.stations.push_back(packing.pack(guess(first, last, h, static_cast<double>(k) / pieces)));
  }
  shooting.stations.back() = packing.pack(last);
  Shadow shadow;
  for (int iteration = 0; iteration < most_iterations && !shadow.converged; ++iteration) {
    shadow.converged = shooting.improve(packing.pack(first), packing.pack(last)) < 1e-10;
  }
  for (std::size_t k = 0; k < shooting.stations.size(); ++k) {
    shadow.stations.push_back(packing.unpack(shooting.stations[k]));
    if (k + 1 == shooting.stations.size()) break;
    shooting.lead(shooting.stations[k]);
    shadow.contact_force += flow.contact_force();
  }
  shadow.start = shadow.stations.front();
  shadow.end = shadow.stations.back();
  return shadow;
}

}  // namespace windlass::verify
