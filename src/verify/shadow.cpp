#include "windlass/verify/shadow.hpp"

#include <algorithm>
#include <cmath>

#include "continuation/eigen_sparse_instances.hpp"

namespace windlass::verify {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

/// Section <-> vector of the quantities that the arc integrates, each divided by its natural size so that least
/// squares weighs them alike: r and q by 1, m by √T, n by T.
class Packing {
 public:
  /// @param constant  does n stay what it is?
  Packing(bool constant, const Section& reference, double growth)
      : reference_(reference),
        size_(constant ? 10 : 13),
        moment_(std::max(1.0, growth)),
        force_(moment_ * moment_) {}

  Index size() const { return size_; }
  VectorXd pack(const Section& section) const {
    VectorXd x(size_);
    x.head<3>() = section.r;
    x.segment<4>(3) = section.q;
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
  std::vector<Eigen::Triplet<double>> entries;
  const auto both = [&](Index row, Index column, double value) {
    entries.emplace_back(row, column, value);
    entries.emplace_back(column, row, value);
  };
  for (Index i = 0; i < size; ++i) {
    entries.emplace_back(i, i, 1.0);
    entries.emplace_back(states - size + i, states - size + i, 1.0);
  }
  VectorXd right = VectorXd::Zero(total);
  right.head(size) = first - stations.front();
  right.segment(states - size, size) = last - stations.back();
  for (Index k = 0; k < pieces; ++k) {
    const VectorXd& here = stations[static_cast<std::size_t>(k)];
    const MatrixXd A = derivative(here);
    for (Index i = 0; i < size; ++i) {
      for (Index j = 0; j < size; ++j) both(states + k * size + i, k * size + j, A(i, j));
      both(states + k * size + i, (k + 1) * size + i, -1.0);
    }
    right.segment(states + k * size, size) = stations[static_cast<std::size_t>(k + 1)] - lead(here);
  }
  Eigen::SparseMatrix<double> K(total, total);
  K.setFromTriplets(entries.begin(), entries.end());
  Eigen::SparseLU<Eigen::SparseMatrix<double>> factors(K);
  if (factors.info() != Eigen::Success) return HUGE_VAL;
  const VectorXd step = factors.solve(right);
  if (!step.allFinite()) return HUGE_VAL;
  for (Index k = 0; k <= pieces; ++k) stations[static_cast<std::size_t>(k)] += step.segment(k * size, size);
  return step.head(states).lpNorm<Eigen::Infinity>();
}

/// Value at x in [0, 1] of the cubic over a length h with the given values and rates at its ends.
template <class Value>
Value cubic(const Value& a, const Value& rate_a, const Value& b, const Value& rate_b, double h, double x) {
  return (1 + 2 * x) * (1 - x) * (1 - x) * a + h * x * (1 - x) * (1 - x) * rate_a + x * x * (3 - 2 * x) * b +
         h * x * x * (x - 1) * rate_b;
}

/// First guess beside a cylinder or on a plane. By `turn` the frame turns about the tangent on the way, which where samples are
/// far apart may be more than half a turn.
Section guess_free(const Section& a, const Section& b, double turn, double h, double x) {
  const auto about_tangent = [](double angle) {
    return Eigen::Quaterniond(Eigen::AngleAxisd(angle, Vector3d::UnitZ()));
  };
  Section section;
  section.r = cubic<Vector3d>(a.r, tangent(a), b.r, tangent(b), h, x);
  const Eigen::Quaterniond qa(a.q[0], a.q[1], a.q[2], a.q[3]), qb(b.q[0], b.q[1], b.q[2], b.q[3]);
  const Eigen::Quaterniond q = qa.slerp(x, qb * about_tangent(-turn)) * about_tangent(x * turn);
  section.q << q.w(), q.x(), q.y(), q.z();
  section.m = cubic<Vector3d>(a.m, a.n.cross(tangent(a)), b.m, b.n.cross(tangent(b)), h, x);
  section.n = a.n;
  return section;
}

/// A section of a line arc as seen on the cylinder: the Darboux frame is (N, t×N, t).
struct OnSurface {
  double angle, height, inclination, turn;  // turn of the material frame about t against the Darboux frame
  Vector3d m, n;                            // components in the Darboux frame

  static Eigen::Matrix3d darboux(double angle, double inclination) {
    const Vector3d N(std::sin(angle), -std::cos(angle), 0.0);
    const Vector3d t(std::cos(inclination) * std::cos(angle), std::cos(inclination) * std::sin(angle),
                     std::sin(inclination));
    Eigen::Matrix3d frame;
    frame << N, t.cross(N), t;
    return frame;
  }
  explicit OnSurface(const Section& x) : angle(std::atan2(x.r.x(), -x.r.y())), height(x.r.z()) {
    const Vector3d t = tangent(x);
    inclination = std::atan2(t.z(), Vector3d(std::cos(angle), std::sin(angle), 0.0).dot(t));
    const Eigen::Matrix3d frame = darboux(angle, inclination);
    const Vector3d d1 = rotation(x.q).col(0);
    turn = std::atan2(d1.dot(frame.col(1)), d1.dot(frame.col(0)));
    m = frame.transpose() * x.m;
    n = frame.transpose() * x.n;
  }
  Section section() const {
    const Eigen::Matrix3d frame = darboux(angle, inclination);
    const Eigen::Quaterniond q(frame * Eigen::AngleAxisd(turn, Vector3d::UnitZ()).toRotationMatrix());
    return {Vector3d(std::sin(angle), -std::cos(angle), height),
            {q.w(), q.x(), q.y(), q.z()},
            frame * m,
            frame * n};
  }
};

/// `value` plus the multiple of a full turn that brings it nearest to `expected`.
double unrolled(double value, double expected) {
  return value + 2.0 * M_PI * std::round((expected - value) / (2.0 * M_PI));
}

/// First guesses on a line arc stay on the cylinder, also where the samples are several turns apart.
std::vector<Section> guesses_line(const Section& first, const Section& last, double turn, double h,
                                  int pieces) {
  OnSurface a(first), b(last);
  const auto round = [](const OnSurface& x) { return std::cos(x.inclination); };
  // the Darboux frame turns about t at the rate sin ψ cos ψ; an untwisted rod does not
  const auto turning = [](const OnSurface& x) { return -std::sin(x.inclination) * std::cos(x.inclination); };
  b.angle = unrolled(b.angle, a.angle + 0.5 * h * (round(a) + round(b)));
  b.turn = unrolled(b.turn, a.turn + turn + 0.5 * h * (turning(a) + turning(b)));
  std::vector<Section> sections;
  for (int k = 0; k <= pieces; ++k) {
    const double x = static_cast<double>(k) / pieces;
    OnSurface at = a;
    at.angle = cubic(a.angle, round(a), b.angle, round(b), h, x);
    at.height = cubic(a.height, std::sin(a.inclination), b.height, std::sin(b.inclination), h, x);
    at.inclination = (1 - x) * a.inclination + x * b.inclination;
    at.turn = (1 - x) * a.turn + x * b.turn;
    at.m = (1 - x) * a.m + x * b.m;
    at.n = (1 - x) * a.n + x * b.n;
    sections.push_back(at.section());
    // consecutive quaternions of the same sign, as the flow keeps it
    const Eigen::Vector4d before = k == 0 ? first.q : sections[sections.size() - 2].q;
    if (sections.back().q.dot(before) < 0.0) sections.back().q = -sections.back().q;
  }
  return sections;
}

std::vector<Section> guesses(bool round_cylinder, const Section& first, const Section& last, double turn,
                             double h, int pieces) {
  if (round_cylinder) return guesses_line(first, last, turn, h, pieces);
  std::vector<Section> sections;
  for (int k = 0; k <= pieces; ++k)
    sections.push_back(guess_free(first, last, turn, h, static_cast<double>(k) / pieces));
  return sections;
}

}  // namespace

Shadow find_shadow(RodFlow& flow, equilibrium::ArcKind kind, const Section& first, const Section& last,
                   double h, double growth) {
  constexpr int most_pieces = 2000, most_iterations = 8;
  const int pieces = std::clamp(static_cast<int>(std::ceil(growth * h / 3.0)), 2, most_pieces);
  const Packing packing(kind == equilibrium::ArcKind::free && !flow.stiffness().weighs(), first, growth);
  Shooting shooting{packing, flow, h / pieces, {}};
  const bool round_cylinder = kind == equilibrium::ArcKind::line && !flow.on_wall();
  const double turn = 0.5 * h * (flow.stiffness().strain(first)(2) + flow.stiffness().strain(last)(2));
  for (const Section& section : guesses(round_cylinder, first, last, turn, h, pieces))
    shooting.stations.push_back(packing.pack(section));
  // of the two quaternions of the last frame, the one that the trajectory arrives at
  Section goal = last;
  if (goal.q.dot(shooting.stations.back().segment<4>(3)) < 0.0) goal.q = -goal.q;
  Shadow shadow;
  for (int iteration = 0; iteration < most_iterations && !shadow.converged; ++iteration) {
    shadow.converged = shooting.improve(packing.pack(first), packing.pack(goal)) < 5e-10;
  }
  for (std::size_t k = 0; k < shooting.stations.size(); ++k) {
    shadow.stations.push_back(packing.unpack(shooting.stations[k]));
    if (k + 1 == shooting.stations.size()) break;
    shooting.lead(shooting.stations[k]);
    shadow.contact_force += flow.contact_force();
    shadow.virial += flow.virial();
  }
  shadow.start = shadow.stations.front();
  shadow.end = shadow.stations.back();
  return shadow;
}

}  // namespace windlass::verify
