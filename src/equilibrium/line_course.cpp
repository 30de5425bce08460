#include "line_course.hpp"

#include <map>

#include "strand_line_events.hpp"
#include "strand_successors.hpp"
#include "windlass/chain/strands.hpp"

namespace windlass::equilibrium {

using chain::Strands;

namespace {

constexpr double quarter =
    0.25;  ///< of what is carried, by which strands come nearer between touches as they are laid

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

}  // namespace

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

}  // namespace windlass::equilibrium
