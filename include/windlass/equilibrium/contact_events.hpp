#pragma once

#include <optional>
#include <string>
#include <vector>

#include "windlass/chain/profile.hpp"
#include "windlass/chain/topology.hpp"

/// Where a contact topology ends, and which one follows.
///
/// | event | positive quantity | what follows |
/// |---|---|---|
/// | pressure | least pressure on a line contact | a gap opens, or closes; a line that is pressed evenly lifts |
/// | suction | 1 less the length of the gap that opens where a line pulls, over what a line carries | that gap, as an arc |
/// | length | length of a line contact, or of a gap between touches, less `least_length`; of a gap beside a line less what the
/// line carries; of a tail less `shortest_tail` | a touch in its place; the line; nothing, the contact is at the rod's end |
/// | force | point force at a touch or an edge | the touch is lost; an edge: what `length` says if its line is as short |
/// | curvature | g'' at a touch, on a plane less `least_curvature` | the touch flattens into a line, or comes apart into two |
/// | dip | 1 less how much nearer strands are beside a touch of theirs, over what it carries | two touches, a line between them or not |
/// | graze | least gap inside a free arc, of each obstacle, and at an end of the rod | a new touch |
/// | slope | of an end that touches a plate, towards it | the touch leaves the end, the tail beyond lies flat |
/// | room | of a rod that floats between two plates: their distance less its height | it touches both |
/// | approach | least distance of two strands less 2r, of every pair of links | a new touch of the two |
/// | reaction | force of the obstacle under a strand that another presses on, and what the line carries of it | it lifts |
/// | rim | how far inside a plate's outer edge it is touched; of a touch of that edge sin α cos α of its force's tilt | the other one of the two; at α = π/2 the branch ends |
/// | buckling | margin of a line without pressure against its own buckling | it bows off the obstacle between two touches |
///
/// **A gap that has just opened is carried by its line.** Where the pressure p of a line contact is negative, the rod lifts: a
/// beam under p₀ + a s²/2, negative on a width w = √(−8 p₀/a), over a gap of half-length h = √5 w/2, to the height a h⁶/720B,
/// with forces a h³/15 at the gap's edges; beside a touch, under p_e + b s, negative on w = −p_e/b, over a length 5w/3, by an
/// angle to the touch that costs the moment bℓ³/60, with the force bℓ²/20 at the edge. Long before such a gap is an arc that
/// can be solved for (rounding of the frames, over the edges' force, moves its edges) the line with the suction in it is the
/// same state to all digits. So `pressure` only says where contacts open, and the gap becomes an arc where its height, or the
/// moment at the touch, is as large as `carried_inside` or `carried_beside_touch` says: by what it does to the state, not by
/// its width, for a pressure that is nearly even pulls weakly on a wide stretch.
namespace windlass::equilibrium {

/// Forces of an arc of length ℓ carry rounding errors like 1/ℓ: it gives way to the topology without it this early, and
/// the event itself is located there. In units of Profile::unit_length.
inline constexpr double least_length = 1e-3;
/// The curvature of two touches falls with the square of the gap between them; here it still is a hundred times its rounding.
inline constexpr double least_between_touches = 5e-3;

/// An arc that begins or ends where strands touch: neither its forces nor what follows grows with 1/ℓ, for its ends are no
/// contacts of one surface. It gives way this early, in the same units.
inline constexpr double least_beside_strand = 1e-5;

/// Of such an arc the lever of a gap beside a strand that presses (opened_press.hpp), which goes with the cube of that gap.
inline constexpr double least_lever = 1e-6;

/// A tail gives way this early, in the same units: its moment, of its own size, has rounding errors of its frames over ℓ.
inline constexpr double shortest_tail = 1e-4;

/// On a plane a touch whose curvature vanishes is where branches meet: between clamps the free part is a whole wave and about
/// to buckle; beside a part that has bowed off the plane, straight and bowed states cross (PHYSICS, "Struts between walls").
/// There the equations of the touch are singular, those of the line that follows are not: the touch gives way this early,
/// and the event is located from the line's side. In units of the curvature f/√(B n) of a free part that ends where a
/// line begins, with force f there.
inline constexpr double least_curvature = 1e-3;

/// Length of a gap over the width of the suction that stands for it, inside a line (√5) and beside a touch; and the distance
/// from an edge, in half-lengths, at which a gap reaches it: next to no line would be left between.
inline constexpr double gap_inside = 2.23606797749978969641, gap_beside_touch = 5.0 / 3.0,
                        gap_reaches_edge = 1.5;
/// What a line carries for a gap: |p₀| w⁴ and |p_e| w² [EI/ρ³·ρ⁴ and ρ²]. Under a = 1 and b = 1 that is w = 0.036 and 0.018. The
/// height of the gap is then below 1e-11; energy and R_tot, which see the square of what the line does wrong, change by less
/// than 1e-9, the moment at a touch by 1e-7.
inline constexpr double carried_inside = 2.1e-10, carried_beside_touch = 5.8e-6;

/// The same of the part F of a strand's force that is normal to an obstacle, away from it, over the pressure p beside it: F²/p
/// [EI/ρ]. The rod would rise by 0.0044 F⁴/p³, under 1e-11 from p = 1 on, over the length 3F/2p, in which its moment changes by
/// 4e-6 at most, the energy by less than 1e-13. Strands on a cylinder that are not parallel to its sections push each other off.
inline constexpr double carried_under_strand = 4e-5;

/// How much nearer than 2r strands may be between the touches of a line of theirs [ρ].
inline constexpr double carried_between_strands = 8e-10;
/// With fewer touches where they are nearer by no more than this part of it.
inline constexpr double spare_between_strands = 1e-2;

struct ContactEvent {
  enum class Kind {
    pressure,
    suction,
    length,
    force,
    curvature,
    graze,
    buckling,
    approach,
    reaction,
    rim,
    dip,
    slope,
    room
  };
  Kind kind = Kind::force;
  int place = 0;  ///< link (pressure, suction, length, graze, buckling) or joint (force, curvature)
  double value = 0.0;
  double s = 0.0;                    ///< where along the rod
  double from = 0.0, to = 0.0;       ///< pressure, suction: the stretch of negative pressure; dip: what opens
  bool presses = false;              ///< curvature, dip: strands press on each other on that stretch
  int obstacle = 0;                  ///< graze: the one that the rod comes near
  int other = -1;                    ///< approach: the link that `place` comes near
  bool mirrored = false;             ///< approach: it is the half-turn's image of that
  int named = -1, named_other = -1;  ///< approach: the links it is called by, where not these
  double s_other = 0.0;              ///< approach: where along the other
  bool imminent = false;  ///< length of a gap so short that its two touches can hardly be told apart
  bool passes = false;    ///< the same equations hold on both sides
  bool redrawn = false;   ///< the same state follows, a gap as an arc or carried by its line
  std::string name() const;
};

/// All events of a state, in a fixed order for a given topology.
std::vector<ContactEvent> contact_events(const chain::Profile& profile, const chain::Topology& topology);

/// Of the event with that name; nullopt: there is none.
std::optional<double> value_of(const std::vector<ContactEvent>& events, const std::string& name);

/// Links beside a touch of strands that have no length left, as in the state of an event, or less than what they stand for.
std::vector<int> vanished_beside_strands(const std::vector<ContactEvent>& events,
                                         const chain::Topology& topology);

/// A topology with the arclengths of its joints, to be filled from the old profile.
struct Successor {
  chain::Topology topology;
  std::vector<double> s;    ///< one a joint of the new chain
  std::vector<int> source;  ///< link of the old chain whose mesh each new arc inherits
  std::vector<int> opened;  ///< links that have no length at the event itself
  std::vector<int> held =
      {};  ///< ends of lines between strands that are known by guess only: the shape adjusts to them first
  bool beside =
      false;  ///< opened links grow so slowly that a state of a length is far: sought a little beside the event, too
  int bowed = -1;             ///< link that has no bow at the event itself, −1: none
  bool nothing_left = false;  ///< no contact remains: the branch ends
  bool at_rim =
      false;  ///< a line or a strand has reached a plate's outer edge, or a touch its outer side: the branch ends
  bool at_end = false;  ///< a contact has reached the rod's end, no tail remains: the branch ends
};

/// Candidates for what follows the event, most likely first.
std::vector<Successor> successors(const ContactEvent& event, const chain::Profile& profile,
                                  const chain::Topology& topology, const std::vector<double>& s);

}  // namespace windlass::equilibrium
