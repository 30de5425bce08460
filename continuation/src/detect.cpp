#include "continuation/detect.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace continuation {
namespace {

double tolerance(Segment& segment) {
  return segment.options().location_tolerance * std::max(1.0, std::abs(segment.parameter(segment.base())));
}

// Precision of the parameter from the parameter's values at the bracket's ends.
double width(Segment& segment, double lo, double hi) {
  const Sample* a = segment.at(lo, false);
  const Sample* b = segment.at(hi, false);
  return a && b ? std::abs(segment.parameter(*a) - segment.parameter(*b)) : hi - lo;
}

const EventFunction* find(const std::vector<EventFunction>& events, const std::string& name) {
  const auto it =
      std::find_if(events.begin(), events.end(), [&](const auto& event) { return event.name == name; });
  return it == events.end() ? nullptr : &*it;
}

int sign_of(const EventSigns& signs, const std::string& name) {
  const auto it = signs.find(name);
  return it == signs.end() || it->second == 0 ? 1 : it->second;
}

}  // namespace

bool is_vertical(const Sample& lo, const Sample& hi) {
  constexpr double rounding = 1e-9, slope = 1e-3;
  return (hi.it.p - lo.it.p).cwiseAbs().maxCoeff() <= rounding * std::abs(hi.s - lo.s) &&
         std::max(std::abs(lo.tangent.p), std::abs(hi.tangent.p)) < slope;
}

Located locate_fold(Segment& segment, const Sample& lo, const Sample& hi) {
  const Bracket bracket = find_zero(lo.s, lo.tangent.p, hi.s, hi.tangent.p, tolerance(segment),
                                    [&](double s) -> std::optional<double> {
                                      const Sample* sample = segment.at(s, true);
                                      if (!sample) return std::nullopt;
                                      return sample->tangent.p;
                                    });
  Located fold;
  fold.type = PointType::fold;
  fold.s = bracket.best;
  const Sample* best = segment.at(bracket.best, true);
  fold.sample = best ? *best : lo;
  fold.lo = bracket.lo;
  fold.hi = bracket.hi;
  // p is flat at a fold: its error is half the slope at the end times the bracket.
  const double slope = std::max(std::abs(fold.sample.tangent.p), bracket.hi - bracket.lo);
  fold.precision =
      std::max(slope * (bracket.hi - bracket.lo), 1e-15 * std::abs(segment.parameter(fold.sample)));
  fold.index = lo.index;
  fold.index_after = hi.index;
  if (!bracket.converged) fold.note = "bracket not converged: " + segment.failure();
  return fold;
}

std::optional<Located> locate_first_event(Segment& segment, const Sample& hi, const EventSigns& signs) {
  const double zero = segment.options().event_zero;
  const std::vector<EventFunction>& at_base = segment.base().events;
  const Sample* top = &hi;
  std::optional<Located> found;
  // Functions that vanish close together: where one has its zero in a place that cannot be solved, another comes before it.
  std::vector<std::string> unsolved;
  for (int round = 0; round < 20; ++round) {
    const EventFunction* first = nullptr;
    double first_s = top->s;
    for (const EventFunction& event : top->events) {
      const EventFunction* base = find(at_base, event.name);
      if (!base || (found && event.name == found->event)) continue;
      if (std::find(unsolved.begin(), unsolved.end(), event.name) != unsolved.end()) continue;
      const int sign = sign_of(signs, event.name);
      const double f_base = sign * base->value, f_top = sign * event.value;
      if (f_top >= -zero) continue;
      const double estimate = f_base <= 0.0 ? 0.0 : top->s * f_base / (f_base - f_top);
      if (!first || estimate < first_s) {
        first = base;
        first_s = estimate;
      }
    }
    if (!first) return found;
    const std::string name = first->name;
    const int sign = sign_of(signs, name);
    Located event;
    event.type = PointType::event;
    event.event = name;
    event.which = static_cast<std::size_t>(first - at_base.data());
    event.index = segment.base().index;
    if (sign * first->value <= 0.0) {
      event.sample = segment.base();
      return event;
    }
    const auto value = [&](double s) -> std::optional<double> {
      Sample* sample = segment.at(s, false);
      if (!sample) return std::nullopt;
      if (sample->events.empty()) segment.add_events(*sample);
      const EventFunction* function = find(sample->events, name);
      return function ? std::optional(sign * function->value) : std::nullopt;
    };
    const Bracket bracket = find_zero(0.0, sign * first->value, top->s, sign * find(top->events, name)->value,
                                      tolerance(segment), value);
    event.s = bracket.lo;  // the state before the event is the valid one
    Sample* best = segment.at(event.s, false);
    event.sample = best ? *best : segment.base();
    event.lo = bracket.lo;
    event.hi = bracket.hi;
    event.precision = width(segment, bracket.lo, bracket.hi);
    constexpr double narrow = 1e-5;
    if (!bracket.converged && event.precision > narrow) {
      event.note = "bracket not converged: " + segment.failure();
    }
    if (!bracket.converged) {
      unsolved.push_back(name);
      if (!found) found = std::move(event);
      continue;
    }
    if (found && event.s > found->hi) return found;
    found = std::move(event);
    // Another event may have changed sign before this one.
    Sample* below = segment.at(bracket.lo, false);
    if (!below) return found;
    if (below->events.empty()) segment.add_events(*below);
    top = below;
  }
  return found;
}

namespace {

// Multiplicity of the branch points between two samples, net of one fold where the tangent turns; 0: none
// seen.
int branch_points_between(const Sample& lo, const Sample& hi) {
  if (lo.index >= 0 && hi.index >= 0) {
    const int change = std::abs(hi.index - lo.index);
    if (is_vertical(lo, hi)) return std::max(change - 1, 0);  // the branch's own direction is neutral
    if (lo.tangent.p * hi.tangent.p >= 0.0) return change;
    // A fold changes the index by one; unchanged across a turn, the side branch of a pitchfork goes through
    // it.
    return change == 1 ? 0 : std::max(change, 1);
  }
  return lo.determinant * hi.determinant < 0 ? 1 : 0;
}

void search(Segment& segment, const Sample& lo, const Sample& hi, int depth, std::vector<Located>& found) {
  const int multiplicity = branch_points_between(lo, hi);
  if (multiplicity == 0) return;
  std::string why;
  // The reduced equations cost about five factorisations, a halving two: they are tried early, then now and
  // then.
  const bool attempt = depth == 0 || depth == 2 || depth % 4 == 0;
  if (attempt) {
    std::optional<BranchPoint> point = polish_branch_point(segment, lo, hi, multiplicity, why);
    if (point) {
      const Eigen::Index parameter = segment.options().parameter;
      Located located;
      located.type = PointType::branch_point;
      located.lo = lo.s;
      located.hi = hi.s;
      const double ds = segment.path_length(point->u, point->p[parameter] - lo.it.p[parameter]);
      const double part = ds / (hi.s - lo.s);
      constexpr double same = 1e-5;  // the state is free along the null vector, to within its curvature
      const bool again = std::any_of(found.begin(), found.end(), [&](const Located& other) {
        return other.branch_point &&
               (other.branch_point->x - point->x).norm() <= same * (1.0 + point->x.norm()) &&
               std::abs(other.branch_point->p[parameter] - point->p[parameter]) <= 1e3 * tolerance(segment);
      });
      // A little slack only: of two points close together each bracket must yield its own. Where p is monotonic it says
      // better than the chord whether the point is inside.
      const double slack = 0.01 + 1e-7 / (hi.s - lo.s);
      const double p_lo = lo.it.p[parameter], p_hi = hi.it.p[parameter], p_here = point->p[parameter];
      const bool monotonic = lo.tangent.p * hi.tangent.p > 0.0;
      const double margin = 1e-4 * std::abs(p_hi - p_lo) + 1e-7;
      const bool inside =
          !monotonic || (p_here > std::min(p_lo, p_hi) - margin && p_here < std::max(p_lo, p_hi) + margin);
      if (part > -slack && part < 1.0 + slack && inside && !again) {
        located.s = lo.s + std::clamp(part, 0.0, 1.0) * (hi.s - lo.s);
        located.precision = point->precision;
        located.index = lo.index;
        located.index_after = hi.index;
        located.multiplicity = multiplicity;
        located.sample.it.x = point->x;
        located.sample.it.p = point->p;
        located.sample.tangent = lo.tangent;
        if (!point->tangents.empty()) {
          Tangent along = point->tangents[0];
          if (inner(*segment.problem(), along, lo.tangent, segment.options().parameter_scale) < 0.0) {
            along.x = -along.x;
            along.p = -along.p;
          }
          located.sample.tangent = std::move(along);
        }
        located.branch_point = std::move(point);
        found.push_back(std::move(located));
        return;
      }
      why = "the branch point equations lead out of the bracket";
    }
  }
  const Sample* middle = nullptr;
  if (hi.s - lo.s > tolerance(segment) && depth < 60) {
    for (const double part : {0.5, 0.35, 0.65}) {  // right on the branch point the solve may fail
      middle = segment.at(lo.s + part * (hi.s - lo.s), true);
      if (middle) break;
    }
  }
  if (!middle) return found.push_back(unpolished(segment, lo, hi, multiplicity, why));
  // Where halving makes the change vanish, the count at one end was roundoff close to an eigenvalue's touch.
  search(segment, lo, *middle, depth + 1, found);
  search(segment, *middle, hi, depth + 1, found);
}

}  // namespace

Located unpolished(Segment& segment, const Sample& lo, const Sample& hi, int multiplicity,
                   const std::string& why) {
  Located located;
  located.type = PointType::branch_point;
  located.s = 0.5 * (lo.s + hi.s);
  located.lo = lo.s;
  located.hi = hi.s;
  located.sample = lo;
  located.precision = std::abs(segment.parameter(hi) - segment.parameter(lo));
  located.index = lo.index;
  located.index_after = hi.index;
  located.multiplicity = multiplicity;
  located.note = "not polished: " + (why.empty() ? segment.failure() : why);
  return located;
}

std::vector<Located> locate_branch_points(Segment& segment, const Sample& lo, const Sample& hi) {
  std::vector<Located> found;
  search(segment, lo, hi, 0, found);
  return found;
}

}  // namespace continuation
