#include "touch_dip.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "strand_successors.hpp"
#include "windlass/equilibrium/contact_events.hpp"

namespace windlass::equilibrium {

using chain::Contact;
using chain::Profile;
using chain::Strands;

namespace {

/// Do two strands touch there of which one is free?
bool is_free_touch(const Profile& profile, const Strands& strands, int joint) {
  const int other = strands.partner(joint);
  if (other < 0) return false;
  const Contact *one = profile.contact_at(joint), *two = profile.contact_at(other);
  return one && two && (one->obstacle < 0 || two->obstacle < 0);
}

/// How much a strand gives way to a force of another: not into an obstacle that it lies on.
double yields(const Contact& touch) {
  return touch.obstacle < 0 ? 1.0 : 1.0 - std::pow(touch.normal.dot(touch.surface_normal), 2);
}

/// Length of a strand on one side of a joint up to the next place where something touches it. What the touches inside a line stand
/// for is a pressure.
double length_beside(const Profile& profile, const Strands& strands, int joint, bool ahead) {
  const int last = static_cast<int>(profile.pieces.size()) - 1;
  double length = 0.0;
  int link = ahead ? joint : joint - 1;
  for (; link >= 0 && link <= last; link += ahead ? 1 : -1) {
    length += profile.pieces[link].length();
    const int next = ahead ? link + 1 : link;
    if (length > 0.0 && !strands.inside_line(next)) break;
  }
  return length;
}

/// Least distance of the other strand from a place near a touch, less 2r.
class Beside {
 public:
  Beside(const Profile& profile, const Contact& touch, const Contact& other, bool mirrored)
      : profile_(profile), touch_(touch), other_(other), mirrored_(mirrored) {}

  double operator()(double shift) const {
    const double s = touch_.s + shift,
                 met = foot(profile_, s, other_.s + touch_.place_ratio * shift, mirrored_);
    const Eigen::Vector3d turn(mirrored_ ? -1.0 : 1.0, 1.0, mirrored_ ? -1.0 : 1.0);
    return (profile_.at(s).r - turn.cwiseProduct(profile_.at(met).r)).norm() - 2.0 * profile_.radius;
  }

 private:
  const Profile& profile_;
  const Contact &touch_, &other_;
  bool mirrored_;
};

double carried_length(double cubic) { return std::cbrt(2.0 * carried_between_strands / cubic); }

}  // namespace

std::optional<TouchDip> dip_beside_touch(const Profile& profile, const Strands& strands,
                                         const Contact& touch) {
  constexpr double small = 0.05, most = 0.01, part = 0.4;  // of G″ [1/ρ], of what is seen of the strands [ρ]
  const int joint = touch.joint, other = strands.partner(joint);
  if (!is_free_touch(profile, strands, joint) || strands.line_of(joint) >= 0 || !(touch.force > 0.0) ||
      std::abs(touch.gap_second) > small / profile.unit_length)
    return std::nullopt;
  double room = HUGE_VAL;
  for (const int end : {joint, other})
    for (const bool ahead : {false, true})
      room = std::min(room, part * length_beside(profile, strands, end, ahead));
  const double reach = std::min(room, most * profile.unit_length);
  const Beside distance(profile, touch, *profile.contact_at(other), strands.mirrored(joint));
  // Of G″σ²/2 + (k ± c)σ³ + qσ⁴/24 at one and at two parts of what is seen.
  const auto rest = [&](double shift) {
    return (distance(shift) - 0.5 * touch.gap_second * shift * shift) / std::pow(std::abs(shift), 3);
  };
  const double half = 0.5 * reach;
  const std::array near{rest(-half), rest(half)}, far{rest(-reach), rest(reach)};
  double quartic = 0.0;
  std::array<double, 2> cubic{};  // before and after
  for (int side = 0; side < 2; ++side) {
    cubic[side] = 2.0 * near[side] - far[side];
    quartic += 24.0 * (far[side] - near[side]) / half / 2.0;
  }
  const double least = std::min(cubic[0], cubic[1]), dip = std::max(-touch.gap_second, 0.0);
  const double length = dip / (3.0 * least);  // of what follows, and to where strands are nearest
  if (!(least > 0.0) || !(carried_length(least) < room)) return std::nullopt;
  TouchDip out;
  out.nearer = dip * dip * dip / (54.0 * least * least);
  out.part = std::max(out.nearer / carried_between_strands, length / reach);
  // The two share the force as their sides' cubics say, about where it is.
  const double ahead = cubic[0] / (cubic[0] + cubic[1]);
  out.from = touch.s - (1.0 - ahead) * length, out.to = touch.s + ahead * length;
  out.presses = quartic < 0.0;
  return out;
}

std::optional<double> part_of_carried(const Profile& profile, const Strands& strands, int link) {
  if (link == 0 || !is_free_touch(profile, strands, link) || !is_free_touch(profile, strands, link + 1))
    return std::nullopt;
  const auto one_link = [&](int begin, int end) {  // but for touches of other lines at the places of its ends
    int links = 0;
    for (int i = begin; i < end; ++i) links += !strands.welded(i);
    return links == 1;
  };
  const bool next_to_each_other =
      std::any_of(strands.facing(link).begin(), strands.facing(link).end(), [&](const Strands::Facing& f) {
        return f.begin == link && f.end == link + 1 && one_link(f.other_begin, f.other_end) &&
               (f.line < 0 ? strands.line_of(link) < 0 && strands.line_of(link + 1) < 0
                           : strands.lines()[f.line].links() == 1);
      });
  if (!next_to_each_other) return std::nullopt;
  const Contact &before = *profile.contact_at(link), &after = *profile.contact_at(link + 1);
  const Contact &of_before = *profile.contact_at(strands.partner(link)),
                &of_after = *profile.contact_at(strands.partner(link + 1));
  constexpr double least = 1e-12;  // of a force
  const double length = profile.pieces[link].length(), ratio = std::abs(of_after.s - of_before.s) / length;
  const double cubic = (before.force + after.force) / (12.0 * profile.material.bending_stiffness) *
                       (yields(before) + std::pow(ratio, 3) * yields(of_before));
  return length / carried_length(std::max(cubic, least));
}

}  // namespace windlass::equilibrium
