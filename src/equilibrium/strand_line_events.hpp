#pragma once

#include "windlass/chain/strands.hpp"
#include "windlass/equilibrium/contact_events.hpp"

/// What the touches say that a line between strands consists of.
namespace windlass::equilibrium {

/// The line that a link is between two touches of, with others; −1: none. Touches inside a line are where they are laid.
int line_of_several(const chain::Strands& strands, int link);

/// A line between strands needs its touches, or has more than it needs.
ContactEvent spare_touches(const chain::Profile& profile, const chain::Strands& strands, int link, int line);

/// How much nearer strands are between the touches inside lines of theirs, by the pressure that these stand for; −1: there are none
/// between free strands.
double nearer_between_touches(const chain::Profile& profile, const chain::Topology& topology);

/// Are touches inside such lines nearer to each other than they are laid anew, or have they passed each other? That of a strand which
/// another one is divided for goes where tangency says.
bool touches_too_near(const chain::Profile& profile, const chain::Topology& topology);

/// Does something press on the divided strand of such a line, farther from its ends than touches at such places are laid from, where
/// the line has none? It has come from an end, or the line has become longer.
bool pressed_without_touch(const chain::Profile& profile, const chain::Topology& topology);

/// What is pressed on right before the end of a line has no touch there: the end itself takes it. From the second distance on it is laid
/// without, at the first it is laid with one: F d²/3B of the rod's height over a span to the next touch is below what is carried [ρ].
inline constexpr double press_apart = 6e-4, press_at_end = 4e-4;
/// No more touches are laid between two joints than are as far apart as the first, and they are laid anew once nearer than the
/// second: their forces answer to their places by 192B/h³ [ρ].
inline constexpr double laid_apart = 3e-4, laid_too_near = 2e-4;
/// The middle of a line between a strand and its own image, which an edge, or what else locates itself, comes near: between the edge's
/// place and its image the pulls of both open the line, by more than it carries. Its touch is laid up to there, or the event would be
/// lost. And touches beyond the middle that come near such a joint [ρ].
inline constexpr double at_middle = 4.5e-3, at_touch = 5e-4;

/// Length at which what a link is of, [begin, end] as joints, has the touches of its lines laid anew; nullopt: it is passed, or none of
/// these.
struct LaidAnew {
  int begin, end;
  double least;
  int middle = -1;    ///< joint of a line with the own image, where it is that
  int pressed = -1;   ///< touch of a line right before its end, where that comes near what presses there
  int line_end = -1;  ///< and that end
};
std::optional<LaidAnew> laid_anew_at(const chain::Profile& profile, const chain::Strands& strands, int link);

/// What is between two joints that no line has inside it, and touches are laid in, as one length: they keep their parts of it.
/// nullopt: no such touch is at the link.
std::optional<ContactEvent> laid_between(const chain::Profile& profile, const chain::Strands& strands,
                                         int link);

/// Of a gap between two lines of the same strands, a single link on one of them: its length over that of a gap
/// which a line opens over. With a force F at its ends it is Fℓ³/192B high, which falls with the sixth power of ℓ:
/// long before the gap is gone its ends, which tangency locates, no longer know where they are. nullopt: none of
/// these, or told by the link of the other strand.
std::optional<double> part_of_opened(const chain::Profile& profile, const chain::Strands& strands, int link);

/// Touches next to each other inside a line that pull together: those from `first` to `last` of the line's, the force of all, and the
/// places on their strand between which the pressure that they stand for, linear between touches, is below zero.
struct Suction {
  int first = 0, last = 0;
  double force = 0.0, begin = 0.0, end = 0.0;
  double width() const { return end > begin ? end - begin : begin - end; }
};
Suction suction_about(const chain::Profile& profile, const chain::Strands& strands, int joint);

/// How far apart strands would come where a touch inside a line of theirs pulls [ρ]. Where the cylinder's point force at the edge of
/// a line on it pushes a strand off the other, by Q, the pull opens them by 2·0.0044 Q⁴/p³: some 4e-9. The energy that the line does
/// wrong there is Q times that, 1e-9 at most.
inline constexpr double opened_between_strands = 1e-8;

/// The same beside a line's end, up to a distance from it (what is above holds from twice that on) [ρ]: the end gives way with what pulls
/// beside it, and holds nothing together. Touches laid densely there would keep a line closed that has opened behind its end.
inline constexpr double opened_at_end = 1e-9, beside_end = 0.1;

/// Of a line between strands the touches inside may pull, as its pressure changes its sign, with what would open the strands by
/// no more than they may be nearer elsewhere. A force F of one lifts both over the span h of its neighbours by Fh³/12B. What touches
/// next to each other pull is one suction: F in all over a width w, of each a parabola's, lifts them by Fw³/15.4B over √5 w (as a gap
/// inside a line on an obstacle, contact_events.hpp, with both giving way). @returns what is to be added to the contact's force
double carried_pull(const chain::Profile& profile, const chain::Strands& strands,
                    const chain::Contact& contact);

}  // namespace windlass::equilibrium
