#include "line_touches.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "strand_line_events.hpp"
#include "strand_successors.hpp"

namespace windlass::equilibrium {

using chain::StrandLine;
using chain::Strands;

namespace {

constexpr double quarter =
    0.25;  ///< of what is carried, by which strands come nearer between touches as they are laid

/// What is known of a line between two strands: of places along one of them those of the other and the pressure.
struct Touched {
  double s, other, pressure;  ///< pressure NaN: unknown
  bool mirrored;
};

/// Pressure of lines by the forces of the touches that stand for it. Those of touches laid closely answer to what rounding leaves of
/// their distances: it is their mean over as much of the line as would open by what is asked of touches, up to what presses on it.
class Pressure {
 public:
  Pressure(const chain::Profile& profile, const Strands& strands) : profile_(profile), strands_(strands) {
    for (const chain::Contact& c : profile.contacts)
      if (c.coupling >= 0) force_[c.joint] = c.force;
  }

  /// NaN where something else presses.
  double at(int joint) const {
    if (!stands_for_line(joint)) return NAN;
    const double opens = 192.0 * profile_.material.bending_stiffness * quarter * carried_between_strands;
    auto [before, after] = strands_.neighbours(joint);
    double force = force_.at(joint);
    while (true) {
      const double span = 0.5 * (place(after) - place(before));
      const bool enough = force * std::pow(span, 3) >= opens;
      const bool more_before = stands_for_line(before), more_after = stands_for_line(after);
      if (enough || (!more_before && !more_after)) return std::max(force, 0.0) / span;
      const bool nearer = place(joint) - place(before) < place(after) - place(joint);
      if (more_before && (nearer || !more_after)) {
        force += force_.at(before);
        before = strands_.neighbours(before)[0];
      } else {
        force += force_.at(after);
        after = strands_.neighbours(after)[1];
      }
    }
  }
  double place(int joint) const { return profile_.pieces[joint].s(0); }

 private:
  bool stands_for_line(int joint) const {
    return strands_.inside_line(joint) && !strands_.pressed(joint) &&
           !strands_.pressed(strands_.partner(joint));
  }

  const chain::Profile& profile_;
  const Strands& strands_;
  std::map<int, double> force_;
};

std::vector<Touched> touched_by(const chain::Profile& profile, const chain::Topology& topology) {
  const Strands strands(topology);
  const Pressure pressure(profile, strands);
  std::vector<Touched> out;
  for (const chain::Contact& c : profile.contacts) {
    const int joint = c.joint;
    if (c.coupling < 0 || strands.line_of(joint) < 0) continue;
    const int other = strands.partner(joint);
    const bool mirrored = topology.seat(joint).strand != topology.seat(other).strand || other == joint;
    out.push_back({pressure.place(joint), pressure.place(other), pressure.at(joint), mirrored});
  }
  std::sort(out.begin(), out.end(), [](const Touched& a, const Touched& b) { return a.s < b.s; });
  return out;
}

/// A line as a function of the place along the strand that is divided.
class Course {
 public:
  Course(const std::vector<Touched>& known, double begin, double other_begin, double end, double other_end,
         bool mirrored) {
    constexpr double near = 0.02;
    const auto [low, high] = std::minmax(other_begin, other_end);
    s_.push_back(begin), other_.push_back(other_begin);
    for (const Touched& t : known) {
      if (t.mirrored != mirrored || t.other < low - near || t.other > high + near) continue;
      if (t.s < begin - near || t.s > end + near) continue;
      if (!std::isnan(t.pressure)) at_.push_back(t.s), pressure_.push_back(t.pressure);
      const double sign = mirrored ? -1.0 : 1.0;  // an image runs the other way
      if (t.s > s_.back() && t.s < end && sign * (t.other - other_.back()) > 0.0 &&
          sign * (other_end - t.other) > 0.0)
        s_.push_back(t.s), other_.push_back(t.other);
    }
    s_.push_back(end), other_.push_back(other_end);
    if (!pressure_.empty()) least_ = 0.05 * *std::max_element(pressure_.begin(), pressure_.end());
  }

  double other(double s) const { return interpolated(s_, other_, s); }
  /// Where other(s) is that, between two places.
  double where(double other, double low, double high) const {
    const bool rises = this->other(high) > this->other(low);
    for (int k = 0; k < 60; ++k) {
      const double middle = 0.5 * (low + high);
      ((this->other(middle) < other) == rises ? low : high) = middle;
    }
    return 0.5 * (low + high);
  }
  double rate(double s) const {
    const auto after = std::clamp<std::size_t>(
        static_cast<std::size_t>(std::upper_bound(s_.begin(), s_.end(), s) - s_.begin()), 1, s_.size() - 1);
    return (other_[after] - other_[after - 1]) / (s_[after] - s_[after - 1]);
  }
  bool pressed() const { return least_ > 0.0; }
  double pressure(double s) const { return least_ + interpolated(at_, pressure_, s); }
  /// Where a strand meets its own image.
  double meets_itself() const {
    for (std::size_t k = 1; k < s_.size(); ++k) {
      const double before = s_[k - 1] - other_[k - 1], after = s_[k] - other_[k];
      if (before <= 0.0 && after >= 0.0) return s_[k - 1] + (s_[k] - s_[k - 1]) * before / (before - after);
    }
    return 0.5 * (s_.front() + s_.back());
  }

 private:
  static double interpolated(const std::vector<double>& x, const std::vector<double>& y, double at) {
    const auto after = static_cast<std::size_t>(std::upper_bound(x.begin(), x.end(), at) - x.begin());
    if (after == 0) return y.front();
    if (after == x.size()) return y.back();
    return y[after - 1] + (y[after] - y[after - 1]) * (at - x[after - 1]) / (x[after] - x[after - 1]);
  }
  std::vector<double> s_, other_, at_, pressure_;
  double least_ = 0.0;
};

/// What is at the two ends of a part of a line.
struct PartEnds {
  std::array<bool, 2> presses;  ///< a point force of something else, which goes on to this line
  std::array<bool, 2>
      touched;  ///< a touch of this line: the next one is a whole distance away, not half of one
};

/// Places between two, `begin` and `end` not among them.
std::vector<double> laid_out(const Course& course, double begin, double end, const PartEnds& ends,
                             const chain::Profile& profile, double finer, double& needed) {
  // A force that no touch takes up where it acts spreads over those beside it, the farther the more it tilts the strands.
  constexpr double denser = 1.5, densest = 5.0;
  const double stiffness = profile.material.bending_stiffness;
  const auto beside = [&](int end) {
    return !ends.presses[end] ? 0.0 : ends.touched[end] ? denser : densest;
  };
  // Where spacing or pressure changes along a line, strands are not quite tangent at touches, and H drifts by p²h⁴/144B in all.
  constexpr double drift = 7e-10;  // of max(1, T): certificates ask for 1e-9
  const double drifts = 144.0 * drift * std::max(1.0, profile.pieces.front().n.col(0).norm());
  constexpr int samples = 200;
  std::vector<double> sum{0.0};
  const double step = (end - begin) / samples;
  for (int k = 0; k < samples; ++k) {
    const double s = begin + (k + 0.5) * step, p = course.pressed() ? course.pressure(s) : 0.0;
    const double both = 1.0 + std::pow(std::abs(course.rate(s)), 3);  // each gives way over its own span
    const double nearer = 384.0 * quarter * carried_between_strands;
    const double most = std::pow(stiffness * std::min(nearer, drifts / p) / (p * both), 0.25);
    double density = 1.0 / most;
    density += beside(0) / most * std::exp(-0.5 * (s - begin) / most);
    density += beside(1) / most * std::exp(-0.5 * (end - s) / most);
    sum.push_back(sum.back() + (p > 0.0 ? step * density : 1.0 / (samples + 1)));
  }
  needed += finer * sum.back();
  // Beside an edge alone the distance from touch to touch across it is to be no longer than others.
  constexpr double enough = 0.5;
  const bool divides = finer * sum.back() > enough;
  const double before = divides && !ends.touched[0] ? 0.5 : 0.0,
               behind = divides && !ends.touched[1] ? 0.5 : 0.0;
  const double room = (end - begin) / (laid_apart * profile.unit_length);
  const int links = static_cast<int>(
      std::max(1.0, std::min(std::ceil(finer * sum.back() + before + behind), std::floor(room))));
  std::vector<double> out;
  int k = 0;
  for (int i = 1; i < links; ++i) {
    const double goal = sum.back() * (i - before) / (links - before - behind);
    while (sum[k + 1] < goal) ++k;
    out.push_back(begin + step * (k + (goal - sum[k]) / (sum[k + 1] - sum[k])));
  }
  return out;
}

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
