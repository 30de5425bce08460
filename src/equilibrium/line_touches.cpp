#include "line_touches.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "line_course.hpp"
#include "strand_line_events.hpp"
#include "strand_successors.hpp"

namespace windlass::equilibrium {

using chain::StrandLine;
using chain::Strands;

namespace {

/// One line of a skeleton: its ends, along the strand that is divided, and the joints between them; the edges on its other strand.
struct Divided {
  std::vector<double> s, edges;
  double other_begin, other_end;
  bool image, own_image, by_first;
  int mark;
};

/// Does another strand press where a joint of a strip is?
bool strand_presses(const Strip& strip, double s) {
  const auto at = std::find(strip.s.begin(), strip.s.end(), s);
  return at != strip.s.end() && strip.on[static_cast<std::size_t>(at - strip.s.begin())].strand != 0;
}

/// Of the two halves of a line with its own image, by the joints in them: see chain::Strands::laid.
bool divides_lower(const Strip& strip, const std::vector<double>& lower, const std::vector<double>& upper) {
  if (lower.size() != upper.size()) return lower.size() > upper.size();
  const auto presses = [&](double s) { return strand_presses(strip, s); };
  return std::count_if(lower.begin(), lower.end(), presses) >=
         std::count_if(upper.begin(), upper.end(), presses);
}

std::vector<double> edges_among(const Strip& strip, const std::vector<double>& places) {
  std::vector<double> out;
  std::copy_if(places.begin(), places.end(), std::back_inserter(out), [&](double s) {
    const auto at = std::find(strip.s.begin(), strip.s.end(), s) - strip.s.begin();
    return strip.on[static_cast<std::size_t>(at)].strand == 0;
  });
  return out;
}

Divided divided(const Strip& strip, const Strands& strands, const StrandLine& line,
                const std::vector<Touched>& known) {
  Divided out;
  out.image = line.image, out.own_image = line.own_image();
  out.mark = strip.on[line.first.front()].line;
  int begin = line.first.front(), end = line.first.back();
  int other_begin = line.second.front(), other_end = line.second.back();
  double middle = 0.0;
  if (out.own_image) {
    const Course course(known, strip.s[begin], strip.s[end], strip.s[end], strip.s[begin], true);
    middle = course.meets_itself();
  }
  const auto between = [&](double low, double high) {
    std::vector<double> s;
    for (const double at : strip.s)
      if (at > low && at < high) s.push_back(at);
    return s;
  };
  const auto of = [&](int one, int two) {
    const auto [low, high] = std::minmax(strip.s[one], strip.s[two]);
    return between(low, high);
  };
  if (out.own_image) {
    const std::vector<double> lower = between(strip.s[begin], middle), upper = between(middle, strip.s[end]);
    out.by_first = divides_lower(strip, lower, upper);
    out.s = out.by_first ? lower : upper;
    out.edges = edges_among(strip, out.by_first ? upper : lower);
    out.s.insert(out.s.begin(), out.by_first ? strip.s[begin] : middle);
    out.s.push_back(out.by_first ? middle : strip.s[end]);
    out.other_begin = out.by_first ? strip.s[end] : middle;
    out.other_end = out.by_first ? middle : strip.s[begin];
    return out;
  }
  const std::vector<double> first = of(begin, end), second = of(other_begin, other_end);
  out.by_first = strands.divides_first(line);
  if (!out.by_first) std::swap(begin, other_begin), std::swap(end, other_end);
  if (begin > end) std::swap(begin, end), std::swap(other_begin, other_end);
  out.s = out.by_first ? first : second;
  out.edges = edges_among(strip, out.by_first ? second : first);
  out.s.insert(out.s.begin(), strip.s[begin]), out.s.push_back(strip.s[end]);
  out.other_begin = strip.s[other_begin], out.other_end = strip.s[other_end];
  return out;
}

/// A place that is not right at a joint.
double clear_of(const Strip& strip, double s) {
  constexpr double clear = 2e-4;
  for (const double at : strip.s)
    if (std::abs(s - at) < clear) return s < at ? at - clear : at + clear;
  return s;
}

/// Lays the touches of lines on a strip. Between the same two joints of a strand all lines have theirs at the same places; where
/// another strand presses each has one, too.
class Layer {
 public:
  Layer(Strip& strip, const std::vector<Divided>& lines, const chain::Profile& profile,
        const std::vector<Touched>& known, double finer)
      : strip_(strip),
        lines_(lines),
        profile_(profile),
        known_(known),
        finer_(finer),
        strand_(new_strand(strip)) {}

  void lay() {
    for (const Divided& line : lines_) {
      const Course course = course_of(line);
      double needed = 0.0;
      for (std::size_t k = 0; k + 1 < line.s.size(); ++k) {
        if (k > 0 && has_touch(line, line.s[k])) add(line, course, line.s[k], true);
        const bool shared = between_.contains({line.s[k], line.s[k + 1]});
        for (const double s : places(line, k, needed)) add(line, course, s, shared);
      }
      // Half of what is between two touches; next to it a joint that comes nearer asks for one, whose distance tells of that.
      constexpr double half = 0.5, next_to_it = 0.02;
      const std::size_t last = line.s.size() - 1;
      const double beside = line.by_first ? line.s[last] - line.s[last - 1] : line.s[1] - line.s[0];
      const bool wanted = needed > half || beside < next_to_it * profile_.unit_length;
      if (line.own_image && wanted && beside > at_middle * profile_.unit_length &&
          (course.pressed() || finer_ > 1.0)) {
        const double middle = clear_of(strip_, line.by_first ? line.s.back() : line.s.front());
        add_pair(strip_, middle, middle, line.image, true, {0, strand_++, 0.5, line.mark});
      }
    }
  }

 private:
  /// Has a line one of its touches at a joint inside it?
  bool has_touch(const Divided& line, double s) const {
    return strand_presses(strip_, s) && inside(line, s, press_apart * profile_.unit_length);
  }

  /// Is a place of a line farther from its ends than that? The middle of a line with its own image is none.
  bool inside(const Divided& line, double s, double least) const {
    const bool before = line.own_image && !line.by_first, behind = line.own_image && line.by_first;
    return (before || s - line.s.front() > least) && (behind || line.s.back() - s > least);
  }

  Course course_of(const Divided& line) const {
    return {known_, line.s.front(), line.other_begin, line.s.back(), line.other_end, line.image};
  }

  /// Of all lines that are divided between these two joints as many places as that one asks for which asks for most.
  const std::vector<double>& places(const Divided& line, std::size_t k, double& needed) {
    const std::pair bounds(line.s[k], line.s[k + 1]);
    std::vector<double> most;
    for (const Divided& other : lines_)
      for (std::size_t i = 0; i + 1 < other.s.size(); ++i) {
        if (std::pair(other.s[i], other.s[i + 1]) != bounds) continue;
        const bool fresh = strip_.parts[strip_.part_at(0.5 * (bounds.first + bounds.second))].fresh;
        if (fresh && other.s.size() == 2) continue;  // a line that has no length yet
        const std::array inner{i > 0, i + 2 < other.s.size()};
        const auto closed = [&](double at) {  // close to an end the line opens where touches are laid densely
          return has_touch(other, at) || !inside(other, at, beside_end * profile_.unit_length);
        };
        const PartEnds ends{inner, {!inner[0] || closed(bounds.first), !inner[1] || closed(bounds.second)}};
        double links = 0.0;
        const std::vector<double> own =
            laid_out(course_of(other), bounds.first, bounds.second, ends, profile_, finer_, links);
        if (&other == &line) needed += links;
        if (own.size() > most.size()) most = own;
      }
    const auto [found, first] = between_.try_emplace(bounds, std::vector<double>());
    if (first)
      for (const double s : most) found->second.push_back(clear_of(strip_, s));
    return found->second;
  }

  /// @param shared  there is a touch at that place already
  void add(const Divided& line, const Course& course, double s, bool shared) {
    double other = clear_of(strip_, course.other(s));
    const int strand = strand_++;
    const bool swapped = !line.by_first && !line.own_image;
    add_pair(strip_, swapped ? other : s, swapped ? s : other, line.image, line.own_image,
             {0, strand, 0.5, line.mark});
    if (!shared) return;
    for (std::size_t j = 0; j < strip_.s.size(); ++j)
      if (std::abs(strip_.on[j].strand) == strand && strip_.s[j] == s) strip_.on[j].shares = 1;
  }

  Strip& strip_;
  const std::vector<Divided>& lines_;
  const chain::Profile& profile_;
  const std::vector<Touched>& known_;
  double finer_;
  int strand_;
  std::map<std::pair<double, double>, std::vector<double>> between_;  ///< places between two joints
};

/// An edge moves along its own strand, and the touches there, which tangency locates, are not to meet it: what is divided is divided at
/// the place that faces it, too, of all lines along that strand alike.
void break_at_edges(std::vector<Divided>& lines, const std::vector<Touched>& known) {
  std::vector<double> facing;
  for (const Divided& line : lines) {
    const Course course(known, line.s.front(), line.other_begin, line.s.back(), line.other_end, line.image);
    for (const double edge : line.edges) facing.push_back(course.where(edge, line.s.front(), line.s.back()));
  }
  for (Divided& line : lines)
    for (const double s : facing) {
      const auto after = std::upper_bound(line.s.begin(), line.s.end(), s);
      if (after == line.s.begin() || after == line.s.end()) continue;
      if (s - *(after - 1) > at_touch && *after - s > at_touch) line.s.insert(after, s);
    }
}

}  // namespace

Skeleton skeleton_of(const Strip& strip) {
  Skeleton out{strip, {}, {}};
  const int count = static_cast<int>(strip.s.size());
  int kept = 0;
  for (int j = 0; j < count; ++j) {
    const bool inside = strip.on[j].part > 0.0 && strip.on[j].line != 0;
    out.joint.push_back(inside ? -1 : kept++);
    if (j + 1 < count) out.link.push_back(kept - 1);
  }
  for (int j = count; j-- > 0;)
    if (out.joint[j] < 0)
      out.strip.merge(j - 1, j, joined(out.strip.parts[j - 1].kind, out.strip.parts[j].kind));
  return out;
}

Successor with_touches(const Successor& skeleton, const chain::Profile& profile,
                       const chain::Topology& topology, double finer) {
  Strip strip(skeleton);
  const Strands strands(skeleton.topology);
  const std::vector<Touched> known = touched_by(profile, topology);
  std::vector<Divided> lines;
  for (const StrandLine& line : strands.lines())
    if (!line.on_obstacles || strip.on[line.first.front()].line != 0)
      lines.push_back(divided(strip, strands, line, known));
  break_at_edges(lines, known);
  Layer(strip, lines, profile, known, finer).lay();
  measure_parts(strip);
  return strip.successor();
}

}  // namespace windlass::equilibrium
