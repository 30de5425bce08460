#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "centreline.hpp"
#include "windlass/chain/self_distance.hpp"

namespace windlass::chain {

/// f = |r(s2) − r(s1)|²/2 with its derivatives at a pair of places.
struct Square {
  Eigen::Vector2d at, gradient;
  Eigen::Matrix2d hessian;
  double value = 0.0;
};

inline Square square(const Centreline& curve, int e1, int e2, const Eigen::Vector2d& at) {
  const Jet a = curve.at(e1, at(0)), b = curve.at(e2, at(1));
  const Vector3d w = b.r - a.r;
  Square f;
  f.at = at;
  f.value = 0.5 * w.squaredNorm();
  f.gradient = {-w.dot(a.t), w.dot(b.t)};
  f.hessian << a.t.squaredNorm() - w.dot(a.k), -a.t.dot(b.t), -a.t.dot(b.t), b.t.squaredNorm() + w.dot(b.k);
  return f;
}

/// Two places that touch, and how near to both nothing else counts.
struct Touch {
  Eigen::Vector2d at;
  double reach;
};

/// The closest pair of places of a rod, by halving it: balls about its stretches bound how near two of them can be.
class ClosestPair {
 public:
  ClosestPair(const Centreline& curve, double least_separation)
      : curve_(curve), separation_(least_separation) {}
  /// @param cutoff  only what is nearer counts
  /// @param known   pairs of places that do not
  ClosestPair(const Centreline& curve, double least_separation, double cutoff,
              const std::vector<Touch>& known)
      : curve_(curve), separation_(least_separation), cutoff_(cutoff), known_(known) {}

  /// Pairs within the elements a … b − 1.
  void within(int a, int b) {
    if (b - a < 2 || curve_.turned[b] - curve_.turned[a] < least_turn) return;
    const int middle = (a + b) / 2;
    between(a, middle, middle, b);
    within(a, middle);
    within(middle, b);
  }

  std::optional<SelfDistance> best() const { return best_; }

  /// Pairs of a place in a … b − 1 with one in c … d − 1.
  void between(int a, int b, int c, int d) {
    if (curve_.turned[d] - curve_.turned[a] < least_turn || curve_.s[d] - curve_.s[a] < separation_) return;
    const Ball first = ball(a, b), second = ball(c, d);
    const Vector3d w = second.r - first.r;
    const double distance = w.norm(), slack = first.radius + second.radius;
    if (distance - slack >= cutoff_) return;
    if (best_ && (distance - slack >= best_->distance || best_->distance <= coincident)) return;
    if (distance > slack && (slopes(first, w / distance, slack / distance, a == 0) ||
                             slopes(second, w / distance, slack / distance, d == curve_.size())))
      return;
    if (b == a + 1 && d == c + 1) return refine(a, c);
    if (d == c + 1 || (b > a + 1 && first.radius >= second.radius)) {
      const int m = (a + b) / 2;
      between(m, b, c, d);
      between(a, m, c, d);
    } else {
      const int m = (c + d) / 2;
      between(a, b, c, m);
      between(a, b, m, d);
    }
  }

 private:
  /// Half of what Fenchel asks for, so that the sum of chords, which is a little small, errs on the safe side; enough
  /// for pairs with an end of the rod.
  static constexpr double least_turn = 0.5 * M_PI;

  struct Ball {
    Vector3d r, t;
    double radius, turn;  ///< the tangents lie within `turn` of t
  };

  Ball ball(int a, int b) const {
    const double turn = curve_.turned[b] - curve_.turned[a];
    if (b == a + 1) {
      const Centreline::Middle& m = curve_.middle[a];
      return {m.r, m.t, curve_.longest * std::max(m.s - curve_.s[a], curve_.s[b] - m.s), turn};
    }
    const int m = (a + b) / 2;
    const double reach = curve_.longest * std::max(curve_.s[m] - curve_.s[a], curve_.s[b] - curve_.s[m]);
    return {curve_.r[m], curve_.t[m], reach, turn};
  }

  /// Does the distance change monotonically along the stretch, and not end in a minimum at the end of the rod? Chords
  /// lie within asin(spread) of w, tangents within `turn` of t.
  /// The chord runs from s1 to s2: where a tangent goes along with it, the end of the rod is no minimum, at either place.
  static bool slopes(const Ball& stretch, const Vector3d& w, double spread, bool at_end) {
    const double angle = stretch.turn + std::asin(spread);
    if (angle >= 0.5 * M_PI) return false;
    const double along = w.dot(stretch.t), least = std::sin(angle);
    return along > least || (!at_end && along < -least);
  }

  void refine(int e1, int e2) {
    const Eigen::Vector2d low(curve_.s[e1], curve_.s[e2]), high(curve_.s[e1 + 1], curve_.s[e2 + 1]);
    Square f = square(curve_, e1, e2, {curve_.middle[e1].s, curve_.middle[e2].s});
    constexpr int most_steps = 40;
    double damping = 0.0;
    for (int step = 0; step < most_steps; ++step) {
      if (settled(f, low, high)) return accept(f, low, high);
      const Square next = square(curve_, e1, e2, newton(f, low, high, damping));
      if (next.value <= f.value * (1.0 + 1e-15)) {
        f = next;
        damping = 0.1 * damping;
      } else {
        damping = std::max(10.0 * damping, 1e-3);
      }
    }
    accept(f, low, high);
  }

  /// Components of the gradient that can still be followed.
  static Eigen::Vector2d free_gradient(const Square& f, const Eigen::Vector2d& low,
                                       const Eigen::Vector2d& high) {
    Eigen::Vector2d g = f.gradient;
    for (int i : {0, 1})
      if ((f.at(i) <= low(i) && g(i) > 0.0) || (f.at(i) >= high(i) && g(i) < 0.0)) g(i) = 0.0;
    return g;
  }

  static bool settled(const Square& f, const Eigen::Vector2d& low, const Eigen::Vector2d& high) {
    return free_gradient(f, low, high).norm() <= 1e-14 * (1.0 + f.at.norm());
  }

  static Eigen::Vector2d newton(const Square& f, const Eigen::Vector2d& low, const Eigen::Vector2d& high,
                                double damping) {
    const Eigen::Vector2d g = free_gradient(f, low, high);
    Eigen::Matrix2d h = f.hessian;
    for (int i : {0, 1})
      if (g(i) == 0.0 && f.gradient(i) != 0.0) h(0, 1) = h(1, 0) = 0.0;  // held at its bound
    const double mean = 0.5 * h.trace(),
                 low_eigenvalue = mean - std::sqrt(std::max(0.0, mean * mean - h.determinant()));
    // Along strands that keep their distance the lower eigenvalue vanishes, and the gradient with it.
    const double shift = std::max(0.0, -2.0 * low_eigenvalue) + damping + 1e-12;
    const Eigen::Vector2d step = -(h + shift * Eigen::Matrix2d::Identity()).inverse() * g;
    return (f.at + step).cwiseMax(low).cwiseMin(high);
  }

  /// A minimum at the border of the two elements belongs to their neighbours, unless the rod ends there.
  void accept(const Square& f, const Eigen::Vector2d& low, const Eigen::Vector2d& high) {
    const double rounding = 1e-9 * (1.0 + std::sqrt(2.0 * f.value));
    for (int i : {0, 1}) {
      const bool leaves_down = f.at(i) <= low(i) && f.gradient(i) > rounding,
                 leaves_up = f.at(i) >= high(i) && f.gradient(i) < -rounding;
      if (leaves_down && low(i) > curve_.s.front()) return;
      if (leaves_up && high(i) < curve_.s.back()) return;
    }
    if (free_gradient(f, low, high).norm() > rounding) return;
    const double distance = std::sqrt(2.0 * f.value);
    // Where two neighbouring elements meet a place is at no distance from itself.
    const double itself = 1e-9 * (1.0 + f.at.cwiseAbs().maxCoeff());
    if (f.at(1) - f.at(0) <= std::max(separation_, itself) || (best_ && distance >= best_->distance)) return;
    for (const Touch& touch : known_)
      if ((f.at - touch.at).cwiseAbs().maxCoeff() < touch.reach) return;
    best_ = SelfDistance{distance, f.at(0), f.at(1)};
  }

  static constexpr double coincident = 1e-12;  ///< nothing is nearer [ρ]

  const Centreline& curve_;
  double separation_, cutoff_ = HUGE_VAL;
  std::vector<Touch> known_;
  std::optional<SelfDistance> best_;
};

}  // namespace windlass::chain
