// What a change of the index between two points of a step means.

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "continuation/detect.hpp"
#include "crossing_count.hpp"

namespace continuation {
namespace {

int zeros_between(const Sample& lo, const Sample& hi) { return count_between(lo, hi).real; }

bool turns(const Sample& lo, const Sample& hi) { return lo.tangent.p * hi.tangent.p < 0.0; }

/// A little apart, in path length: a turn and a branch point closer than that are the same.
double together(const Segment& segment) {
  constexpr double part = 1e-4, rounding = 1e-7;
  return part * segment.reach() + rounding;
}

Located bracketed(Segment& segment, const Sample& lo, const Sample& hi, PointType type) {
  Located located;
  located.type = type;
  located.s = 0.5 * (lo.s + hi.s);
  located.lo = lo.s;
  located.hi = hi.s;
  located.sample = lo;
  located.precision = std::abs(segment.parameter(hi) - segment.parameter(lo));
  located.index = lo.index;
  located.index_after = hi.index;
  return located;
}

class Search {
 public:
  Search(Segment& segment, double edge, bool may_refuse)
      : segment_(segment),
        options_(segment.options()),
        tolerance_(options_.location_tolerance *
                   std::max(1.0, std::abs(segment.parameter(segment.base())) / options_.parameter_scale)),
        edge_(edge),
        may_refuse_(may_refuse) {}

  /// @param depth  halvings since the interval held `shared` points
  void branch_points(const Sample& lo, const Sample& hi, int depth = 0, int shared = 0) {
    const int multiplicity = multiplicity_between(lo, hi);
    if (multiplicity <= 0 || !found.refusal.empty() || counts_are_rounding) return;
    if (multiplicity != shared) depth = 0;
    // The reduced equations cost about five factorisations, a halving two: they are tried early, then now and then.
    std::string why;
    if (depth == 0 || depth == 2 || depth % 4 == 0) {
      if (std::optional<Located> point = polished(lo, hi, multiplicity, why)) {
        found.points.push_back(std::move(*point));
        return;
      }
      if (depth >= 4 && multiplicity % 2 == 0 && regular(lo, hi)) return;
    }
    // On a branch the two ends come together as fast as the interval shrinks; on two branches they stay apart.
    if (may_refuse_ && hi.s < edge_ && apart(lo, hi)) {
      found.refusal = "the corrector has left the branch: the index changes where no branch point is";
      return;
    }
    // Counts that rounding changes from sample to sample, as on a branch that is nearly vertical, would be halved without end.
    constexpr int most = 150;
    if (++halvings_ > most) {
      counts_are_rounding = true;
      return found.points.push_back(unpolished(segment_, lo, hi, multiplicity, why));
    }
    const Sample* middle = halfway(lo, hi, depth);
    constexpr double narrow = 1e-3;  // right on a singular point the solve may fail, elsewhere it does not
    if (!middle && may_refuse_ && hi.s < edge_ && hi.s - lo.s > narrow * segment_.reach()) {
      found.refusal =
          "the index changes, and the branch in between cannot be solved for: " + segment_.failure();
      return;
    }
    if (!middle) return found.points.push_back(unpolished(segment_, lo, hi, multiplicity, why));
    // Where halving makes the change vanish, the count at one end was roundoff close to an eigenvalue's touch.
    branch_points(lo, *middle, depth + 1, multiplicity);
    branch_points(*middle, hi, depth + 1, multiplicity);
  }

  /// A complex pair that crosses the imaginary axis, by halving.
  void hopf_points(const Sample& from, const Sample& to) {
    const Sample *lo = &from, *hi = &to;
    if (count_between(*lo, *hi).hopf == 0) return;
    for (int depth = 0; hi->s - lo->s > tolerance_; ++depth) {
      const Sample* middle = halfway(*lo, *hi, depth);
      if (!middle) break;
      if (count_between(*lo, *middle).hopf != 0) {
        hi = middle;
      } else if (count_between(*middle, *hi).hopf != 0) {
        lo = middle;
      } else {
        return;  // the pair met the axis through other ways: it turned real in between
      }
    }
    found.points.push_back(bracketed(segment_, *lo, *hi, PointType::hopf));
  }

  /// Is the turn a fold, given what was found between samples on its two sides? An odd number of eigenvalues goes
  /// through zero there; on the side branch of a pitchfork, which turns at its branch point, an even one.
  bool fold(const Sample& lo, const Sample& hi, const Located& turn) {
    const int zeros = zeros_between(lo, hi);
    if (zeros < 0 || zeros % 2 == 1) return true;
    // The bracket of a turn ends wide where Newton's method fails close to a branch point.
    for (const Located& point : found.points) {
      if (point.type != PointType::branch_point || point.s < lo.s || point.s > hi.s) continue;
      // Near a turn p tells no places apart: s is known to the root of p's precision. The slope by which the turn is found
      // has the error of its sample divided by the distance from the branch point.
      const double solved_to =
          std::max(point.precision / options_.parameter_scale, options_.newton_tolerance);
      const double slack = together(segment_) + std::sqrt(solved_to);
      if (point.s > turn.lo - slack && point.s < turn.hi + slack) return false;
      // Apart from each other the two enclose an interval where the index has the other parity.
      const Sample* middle = segment_.at(0.5 * (point.s + turn.s), true);
      return middle && zeros_between(*middle, point.s < turn.s ? hi : lo) % 2 == 1;
    }
    return false;
  }

  Crossings found;
  bool counts_are_rounding = false;  ///< the search ended without an end

 private:
  int multiplicity_between(const Sample& lo, const Sample& hi) const {
    const int change = zeros_between(lo, hi);
    if (change < 0) return 0;
    if (is_vertical(segment_, lo, hi))
      return std::max(change - 1, 0);  // the branch's own direction is neutral
    if (!turns(lo, hi)) return change;
    // A fold changes the index by one; unchanged across a turn, the side branch of a pitchfork goes through it.
    return change == 1 ? 0 : std::max(change, 1);
  }

  /// Is the one end farther from the other's tangent than a circle that turns by max_angle in between would be?
  bool apart(const Sample& lo, const Sample& hi) const {
    const double rounding = 1e3 * options_.newton_tolerance;
    if (hi.s - lo.s < rounding) return false;
    const Problem& problem = *segment_.problem();
    Tangent way{hi.it.u - lo.it.u, hi.it.y[0] - lo.it.y[0]};
    const double along = inner(problem, way, lo.tangent, options_.scales());
    way.x -= along * lo.tangent.x;
    way.p -= along * lo.tangent.p;
    const double off = std::sqrt(inner(problem, way, way, options_.scales()));
    return off > std::tan(0.5 * options_.max_angle) * std::abs(along);
  }

  const Sample* halfway(const Sample& lo, const Sample& hi, int depth) {
    if (hi.s - lo.s <= tolerance_ || depth >= 60) return nullptr;
    for (const double part : {0.5, 0.35, 0.65}) {  // right on the branch point the solve may fail
      if (const Sample* middle = segment_.at(lo.s + part * (hi.s - lo.s), true)) return middle;
    }
    return nullptr;
  }

  /// The smallest singular value of J changes by less than half of itself and keeps its sign.
  bool regular(const Sample& lo, const Sample& hi) {
    Problem& problem = *segment_.problem();
    try {
      const NullVectors null = null_vectors(problem, lo.it.x, lo.it.p, 1, options_);
      const double a = nearness(problem, lo.it.x, lo.it.p, null, options_);
      const double b = nearness(problem, hi.it.x, hi.it.p, null, options_);
      return std::abs(b - a) < 0.5 * std::abs(a);
    } catch (const std::domain_error&) {
    } catch (const std::runtime_error&) {  // singular even with one border
    }
    return false;
  }

  bool known(const BranchPoint& point) const {
    constexpr double same = 1e-5;  // the state is free along the null vector, to within its curvature
    const Eigen::Index parameter = options_.parameter;
    return std::any_of(found.points.begin(), found.points.end(), [&](const Located& other) {
      return other.branch_point &&
             (other.branch_point->x - point.x).norm() <= same * (options_.state_scale + point.x.norm()) &&
             std::abs(other.branch_point->p[parameter] - point.p[parameter]) <=
                 1e3 * options_.parameter_scale * tolerance_;
    });
  }

  std::optional<Located> polished(const Sample& lo, const Sample& hi, int multiplicity, std::string& why) {
    std::optional<BranchPoint> point = polish_branch_point(segment_, lo, hi, multiplicity, why);
    if (!point) return std::nullopt;
    const double p_lo = segment_.parameter(lo), p_hi = segment_.parameter(hi),
                 p = point->p[options_.parameter];
    const double part = segment_.path_length(point->u, p - p_lo) / (hi.s - lo.s);
    // A little slack only: of two points close together each bracket must yield its own. Where p is monotonic it says
    // better than the chord whether the point is inside.
    const double slack = 0.01 + 1e-7 / (hi.s - lo.s);
    const double margin = 1e-4 * std::abs(p_hi - p_lo) + 1e-7 * options_.parameter_scale;
    const bool inside =
        turns(lo, hi) || (p > std::min(p_lo, p_hi) - margin && p < std::max(p_lo, p_hi) + margin);
    if (!(part > -slack && part < 1.0 + slack && inside) || known(*point)) {
      why = "the branch point equations lead out of the bracket";
      return std::nullopt;
    }
    Located located = bracketed(segment_, lo, hi, PointType::branch_point);
    located.s = lo.s + std::clamp(part, 0.0, 1.0) * (hi.s - lo.s);
    located.precision = point->precision;
    located.multiplicity = multiplicity;
    located.sample.it.x = point->x;
    located.sample.it.p = point->p;
    located.sample.tangent = lo.tangent;
    if (!point->tangents.empty()) {
      Tangent along = point->tangents[0];
      if (inner(*segment_.problem(), along, lo.tangent, options_.scales()) < 0.0) {
        along.x = -along.x;
        along.p = -along.p;
      }
      located.sample.tangent = std::move(along);
    }
    located.branch_point = std::move(point);
    return located;
  }

  Segment& segment_;
  const Options& options_;
  double tolerance_, edge_;
  bool may_refuse_;
  int halvings_ = 0;
};

}  // namespace

Located unpolished(Segment& segment, const Sample& lo, const Sample& hi, int multiplicity,
                   const std::string& why) {
  Located located = bracketed(segment, lo, hi, PointType::branch_point);
  located.multiplicity = multiplicity;
  located.note = "not polished: " + (why.empty() ? segment.failure() : why);
  return located;
}

Crossings locate_crossings(Segment& segment, const Sample& lo, const Sample& hi, const Located* turn,
                           double edge, bool may_refuse) {
  Search search(segment, edge, may_refuse);
  if (!turn) {
    search.branch_points(lo, hi);
    search.hopf_points(lo, hi);
    return std::move(search.found);
  }
  // The samples that located the turn enclose it: no more are needed.
  const double beyond = 10.0 * together(segment);
  const Sample* before = segment.complete_beside(turn->s, beyond, -1);
  const Sample* after = segment.complete_beside(turn->s, beyond, 1);
  const Sample& a = before && before->s > lo.s ? *before : lo;
  const Sample& b = after && after->s < hi.s ? *after : hi;
  search.branch_points(lo, a);
  search.branch_points(a, b);
  if (search.found.refusal.empty()) search.found.fold = search.fold(a, b, *turn);
  search.branch_points(b, hi);
  search.hopf_points(lo, hi);
  return std::move(search.found);
}

std::optional<std::vector<Located>> locate_branch_points(Segment& segment, const Sample& lo,
                                                         const Sample& hi) {
  Search search(segment, std::numeric_limits<double>::infinity(), false);
  search.branch_points(lo, hi);
  if (search.counts_are_rounding) return std::nullopt;
  return std::move(search.found.points);
}

}  // namespace continuation
