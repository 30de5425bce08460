// Branch points that a problem posed on symmetric states passes by: bracketed by its count of the directions
// that break the symmetry, located in the problem without the restriction.

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>

#include "continuation/detect.hpp"

namespace continuation {
namespace {

/// The piece of the branch between two samples, on the unrestricted problem.
struct Piece {
  std::shared_ptr<Problem> problem;
  std::vector<Located> found;
};

/// @param counts  becomes false where its directions are counted with more error than they change by: it is not asked again
std::optional<Piece> in_the_large(Segment& segment, const Sample& lo, const Sample& hi, bool& counts,
                                  std::string& why) {
  const double from = segment.parameter(lo), to = segment.parameter(hi);
  try {
    const std::optional<Unrestricted> start = segment.problem()->unrestricted(lo.it.x, lo.it.p);
    if (!start) return why = "the state was not found on the unrestricted problem", std::nullopt;
    Tangent tangent =
        first_tangent(*start->problem, start->x, lo.it.p, segment.options(), to < from ? -1 : 1);
    if (tangent.p == 0.0) return why = "the parameter stands still", std::nullopt;
    const double length = std::abs((to - from) / tangent.p);
    Segment large(start->problem, segment.options(), start->x, lo.it.p, std::move(tangent));
    Sample* base = large.at(0.0, true);
    const Sample* beyond = base ? large.at(length, false) : nullptr;
    const Sample* end = beyond ? large.at_parameter(to, *base, *beyond, true) : nullptr;
    if (!end) return why = large.failure(), std::nullopt;
    auto points = locate_branch_points(large, *base, *end);
    counts = points.has_value();
    if (!points) return why = "on the unrestricted problem the count of directions is rounding", std::nullopt;
    return Piece{start->problem, std::move(*points)};
  } catch (const std::domain_error& error) {
    why = error.what();
  } catch (const std::runtime_error& error) {
    why = error.what();
  }
  return std::nullopt;
}

bool is_polished(const Located& located) { return located.branch_point.has_value(); }

/// Adds what the piece holds, placed on the segment.
void add(Segment& segment, const Sample& lo, const Sample& hi, const Piece& piece,
         std::vector<Located>& found) {
  const double from = segment.parameter(lo), to = segment.parameter(hi);
  for (Located located : piece.found) {
    const double part = std::clamp((segment.parameter(located.sample) - from) / (to - from), 0.0, 1.0);
    located.s = lo.s + part * (hi.s - lo.s);
    located.lo = lo.s;
    located.hi = hi.s;
    located.problem = piece.problem;
    found.push_back(std::move(located));
  }
}

/// A branch point of the restricted problem inside the bracket, and samples on both sides as close as Newton's method goes.
struct Together {
  const Located* point = nullptr;
  const Sample *below = nullptr, *above = nullptr;
};

Together together(Segment& segment, const Sample& lo, const Sample& hi,
                  const std::vector<Located>& restricted) {
  const double smallest =
      1e-5 * std::max(1.0, std::abs(segment.parameter(segment.base())) / segment.options().parameter_scale);
  for (const Located& point : restricted) {
    const double close = std::max(smallest, 100.0 * point.precision / segment.options().parameter_scale);
    if (point.s - close <= lo.s || point.s + close >= hi.s) continue;
    const Sample* below = segment.at(point.s - close, true);
    const Sample* above = below ? segment.at(point.s + close, true) : nullptr;
    if (above) return {&point, below, above};
  }
  return {};
}

/// @param around  the narrowest piece around this interval that holds a point, which could not be polished; null: there is none
void search(Segment& segment, const Sample& lo, const Sample& hi, int depth,
            const std::vector<Located>& restricted, const Piece* around, bool& counts,
            std::vector<Located>& found) {
  if (lo.breaking_index < 0 || hi.breaking_index < 0 || lo.breaking_index == hi.breaking_index) return;
  if (const Together one = together(segment, lo, hi, restricted); one.point) {
    // Modes of both kinds that come in at once are turned into each other by a symmetry of the problem, as buckling in
    // all planes of an isotropic rod: one point, and the arms that keep the restriction stand for all.
    search(segment, lo, *one.below, depth + 1, restricted, around, counts, found);
    search(segment, *one.above, hi, depth + 1, restricted, around, counts, found);
    return;
  }
  // The unrestricted problem costs a solve of twice the size to enter: halved first, where that costs two
  // factorisations, so that Newton's method and the kernel start close, and no fold or other branch point is near.
  constexpr int first = 4, between = 4;
  const bool alone = lo.index == hi.index && lo.tangent.p * hi.tangent.p > 0.0;
  std::string why;
  std::optional<Piece> piece;
  if (counts && depth >= first && (depth - first) % between == 0 && alone) {
    piece = in_the_large(segment, lo, hi, counts, why);
    if (piece && std::any_of(piece->found.begin(), piece->found.end(), is_polished)) {
      std::erase_if(piece->found, std::not_fn(is_polished));
      return add(segment, lo, hi, *piece, found);
    }
    if (piece && !piece->found.empty()) around = &*piece;
  }
  const double smallest =
      segment.options().location_tolerance *
      std::max(1.0, std::abs(segment.parameter(segment.base())) / segment.options().parameter_scale);
  const Sample* middle = nullptr;
  if (hi.s - lo.s > smallest && depth < 60) middle = segment.at(0.5 * (lo.s + hi.s), true);
  if (!middle) {
    // Newton's method fails this close to a singular point: the restricted one, if it is here.
    const double apart = std::abs(segment.parameter(hi) - segment.parameter(lo)),
                 width = 16.0 * (hi.s - lo.s);
    const auto here = [&](const Located& point) {
      return (point.s > lo.s - width && point.s < hi.s + width) ||
             std::abs(segment.parameter(point.sample) - segment.parameter(lo)) <= 16.0 * apart;
    };
    // A count that changes over a stretch that cannot be solved (next to an event, say) is no point.
    constexpr double narrow = 1e-5;
    if (apart <= narrow * std::max(1.0, std::abs(segment.parameter(lo))) &&
        std::none_of(restricted.begin(), restricted.end(), here)) {
      // Its kernel is the unrestricted problem's, polished or not.
      if (around) return add(segment, lo, hi, *around, found);
      found.push_back(unpolished(segment, lo, hi, std::abs(hi.breaking_index - lo.breaking_index), why));
    }
    return;
  }
  search(segment, lo, *middle, depth + 1, restricted, around, counts, found);
  search(segment, *middle, hi, depth + 1, restricted, around, counts, found);
  // Halving made the change vanish: the count at one end was roundoff close to an eigenvalue's touch.
}

}  // namespace

std::vector<Located> locate_symmetry_breaking(Segment& segment, const Sample& lo, const Sample& hi,
                                              const std::vector<Located>& restricted) {
  std::vector<Located> found;
  bool counts = true;
  search(segment, lo, hi, 0, restricted, nullptr, counts, found);
  return found;
}

}  // namespace continuation
