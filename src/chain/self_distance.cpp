#include "windlass/chain/self_distance.hpp"

#include <algorithm>
#include <cmath>

#include "windlass/chain/guess.hpp"
#include "windlass/rod/quaternion.hpp"

namespace windlass::chain {

using Eigen::Vector3d;

namespace {

/// d₃ of a frame (w, x, y, z).
Vector3d tangent(const Eigen::Vector4d& q) {
  return {2.0 * (q[1] * q[3] + q[0] * q[2]), 2.0 * (q[2] * q[3] - q[0] * q[1]),
          1.0 - 2.0 * (q[1] * q[1] + q[2] * q[2])};
}

struct Jet {
  Vector3d r, t, k;  ///< position, dr/ds, d²r/ds²
};

/// The centreline element by element.
class Curve {
 public:
  explicit Curve(const Profile& whole) : whole_(whole) {
    if (whole.material.compliance != 0.0)
      for (const Piece& piece : whole.pieces)
        for (Eigen::Index k = 0; k < piece.s.size(); ++k) longest = std::max(longest, stretch(piece, k));
    for (std::size_t i = 0; i < whole.pieces.size(); ++i) {
      const Piece& piece = whole.pieces[i];
      begins.push_back(static_cast<int>(s.size()));
      const int last = static_cast<int>(piece.s.size()) - 1;
      for (int first = 0; first + piece.stride <= last && !piece.weld; first += piece.stride)
        add_element(piece, static_cast<int>(i), first);
    }
    begins.push_back(static_cast<int>(s.size()));
    const Piece& end = whole.pieces.back();
    const Eigen::Index last = end.s.size() - 1;
    s.push_back(end.s(last)), r.push_back(end.r.col(last)), t.push_back(tangent(end.q.col(last)));
    turned.push_back(0.0);
    double sum = 0.0;
    for (int e = 0; e < size(); ++e) {  // chord of the tangents: a little less than their angle
      turned[e] = sum;
      sum += (middle[e].t - t[e]).norm() + (t[e + 1] - middle[e].t).norm();
    }
    turned.back() = sum;
  }

  int size() const { return static_cast<int>(middle.size()); }

  Jet at(int element, double place) const {
    const auto [i, first] = where_[element];
    const Piece& piece = whole_.pieces[i];
    int k = first;
    while (k + 1 < first + piece.stride && place > piece.s(k + 1)) ++k;
    return quintic(knot(piece, k), knot(piece, k + 1), piece.s(k + 1) - piece.s(k), place - piece.s(k));
  }

  std::vector<int> begins;     ///< first element of each piece, and their number
  std::vector<double> s;       ///< where elements begin, and the end
  std::vector<Vector3d> r, t;  ///< there
  std::vector<double> turned;  ///< angle by which the rod has turned up to there [rad]
  struct Middle {
    double s;
    Vector3d r, t;
  };
  std::vector<Middle> middle;  ///< a sample inside each element
  double longest = 1.0;        ///< length of the centre line a unit of s, at most

 private:
  void add_element(const Piece& piece, int index, int first) {
    const int inside = first + piece.stride / 2;
    s.push_back(piece.s(first)), r.push_back(piece.r.col(first)), t.push_back(tangent(piece.q.col(first)));
    turned.push_back(0.0);
    middle.push_back({piece.s(inside), piece.r.col(inside), tangent(piece.q.col(inside))});
    where_.push_back({index, first});
  }

  [[gnu::noinline]] double stretch(const Piece& piece, Eigen::Index k) const {
    return whole_.material.stretch(piece.n.col(k).dot(tangent(piece.q.col(k))));
  }

  Jet knot(const Piece& piece, int k) const {
    if (whole_.material.compliance != 0.0) return stretched_knot(piece, k);
    return {piece.r.col(k), tangent(piece.q.col(k)), curvature(whole_.material, piece, k)};
  }

  /// r' = λ t, λ' = n'·t/EA + λ n·κ/EA, κ the curvature; contacts push across t. A function of its own, or the compiler rounds the
  /// other way otherwise.
  [[gnu::noinline]] Jet stretched_knot(const Piece& piece, int k) const {
    const rod::Material& rod = whole_.material;
    const Vector3d t = tangent(piece.q.col(k)), bend = curvature(rod, piece, k);
    const double by = stretch(piece, k);
    const double rate = rod.compliance * (by * piece.n.col(k).dot(bend) - rod.weight.dot(t));
    return {piece.r.col(k), by * t, by * by * bend + rate * t};
  }

  static Jet quintic(const Jet& a, const Jet& b, double h, double place) {
    const double x = place / h;
    const Vector3d rise = b.r - a.r, v0 = h * a.t, v1 = h * b.t, a0 = h * h * a.k, a1 = h * h * b.k;
    const Vector3d c3 = 10.0 * rise - 6.0 * v0 - 4.0 * v1 - 1.5 * a0 + 0.5 * a1,
                   c4 = -15.0 * rise + 8.0 * v0 + 7.0 * v1 + 1.5 * a0 - a1,
                   c5 = 6.0 * rise - 3.0 * v0 - 3.0 * v1 - 0.5 * a0 + 0.5 * a1;
    return {a.r + x * (v0 + x * (0.5 * a0 + x * (c3 + x * (c4 + x * c5)))),
            (v0 + x * (a0 + x * (3.0 * c3 + x * (4.0 * c4 + x * 5.0 * c5)))) / h,
            (a0 + x * (6.0 * c3 + x * (12.0 * c4 + x * 20.0 * c5))) / (h * h)};
  }

  struct Where {
    int piece, first;
  };
  const Profile& whole_;
  std::vector<Where> where_;
};

/// f = |r(s2) − r(s1)|²/2 with its derivatives at a pair of places.
struct Square {
  Eigen::Vector2d at, gradient;
  Eigen::Matrix2d hessian;
  double value = 0.0;
};

Square square(const Curve& curve, int e1, int e2, const Eigen::Vector2d& at) {
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

class Search {
 public:
  Search(const Curve& curve, double least_separation) : curve_(curve), separation_(least_separation) {}
  /// @param cutoff  only what is nearer counts
  /// @param known   pairs of places that do not
  Search(const Curve& curve, double least_separation, double cutoff, const std::vector<Touch>& known)
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
      const Curve::Middle& m = curve_.middle[a];
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

  const Curve& curve_;
  double separation_, cutoff_ = HUGE_VAL;
  std::vector<Touch> known_;
  std::optional<SelfDistance> best_;
};

/// Places of the touches between strands, of the whole rod: first place < second place.
std::vector<Touch> touches(const Profile& profile, const Topology& topology) {
  // Two touches so close are told apart by their curvature; that of a line's end says nothing [ρ].
  constexpr double same_touch = 1e-2, same_end = 2e-3;
  std::vector<Touch> out;
  const Strands strands(topology);
  const auto add = [&](double a, double b, double reach) {
    out.push_back({{std::min(a, b), std::max(a, b)}, reach});
  };
  const auto place = [&](int joint) {
    return std::find_if(profile.contacts.begin(), profile.contacts.end(),
                        [&](const Contact& c) { return c.joint == joint; })
        ->s;
  };
  for (const Coupling& c : topology.couplings()) {
    const double a = place(c.first), b = c.mirrored ? -place(c.second) : place(c.second);
    const int line = strands.line_of(c.first);
    const double reach = line >= 0 && !strands.lines()[line].on_obstacles ? same_end : same_touch;
    add(a, b, reach);
    if (topology.half) add(-a, -b, reach);
  }
  return out;
}

}  // namespace

std::vector<Approach> approaches(const Profile& profile, const Topology& topology) {
  std::vector<Approach> out;
  if (profile.radius == 0.0) return out;
  Profile image;
  if (topology.half) image = chain::mirrored(profile);
  const Profile& whole = topology.half ? image : profile;
  const Curve curve(whole);
  const std::vector<Touch> known = touches(profile, topology);
  const double separation = M_PI * profile.radius;
  constexpr double as_far_again = 2.0;  // nobody asks how far strands are that are this far
  const double cutoff = 2.0 * profile.radius * (1.0 + as_far_again);
  const int links = static_cast<int>(profile.pieces.size()), first = topology.half ? links : 0;
  // Touches of a line are where they are laid, not where strands are nearest: right beside they may be nearer.
  const std::vector<Touch> none;
  const auto least =
      [&](int i, int j, bool line) -> std::optional<SelfDistance> {  // of two pieces of the whole rod, i <= j
    for (const int piece : {i, j})
      if (curve.begins[piece] == curve.begins[piece + 1]) return std::nullopt;  // of no length
    Search search(curve, separation, cutoff, line ? none : known);
    if (i == j)
      search.within(curve.begins[i], curve.begins[i + 1]);
    else
      search.between(curve.begins[i], curve.begins[i + 1], curve.begins[j], curve.begins[j + 1]);
    return search.best();
  };
  const auto add = [&](int i, int j, bool mirrored, bool line) {
    const auto found = mirrored ? least(links - 1 - j, first + i, line) : least(first + j, first + i, line);
    Approach near{i, j, mirrored, cutoff};
    if (found) {
      near.distance = found->distance;
      near.s = found->s2;
      near.s_other = mirrored ? -found->s1 : found->s1;
    }
    out.push_back(near);
  };
  const Strands strands(topology);
  std::vector<int> in_line(links);
  for (int i = 0; i < links; ++i) in_line[i] = strands.line_along(i);
  for (int i = 0; i < links; ++i)
    for (int j = 0; j <= i; ++j) {
      // Of two lines between strands a link is near what faces it only.
      const bool along = in_line[i] >= 0 && in_line[j] >= 0;
      const auto look = [&](bool image) {
        const Strands::Facing* faced = strands.facing(i, j, image);
        if (faced || !along)
          add(i, j, image, faced && faced->line >= 0 && !strands.lines()[faced->line].on_obstacles);
      };
      look(false);
      if (topology.half) look(true);
    }
  return out;
}

std::optional<SelfDistance> self_distance(const Profile& whole, double radius) {
  if (whole.pieces.empty() || whole.pieces.front().s.size() < 2) return std::nullopt;
  const Curve curve(whole);
  Search search(curve, M_PI * radius);
  search.within(0, curve.size());
  return search.best();
}

}  // namespace windlass::chain
