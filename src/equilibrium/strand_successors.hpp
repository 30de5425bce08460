#pragma once

#include <optional>
#include <vector>

#include "strip.hpp"

/// What follows an event at a touch of the rod with itself.
namespace windlass::equilibrium {

/// The other joint of a touch between strands; j itself where it touches its own image.
int partner(const Strip& strip, int j);

/// A touch where the strip is cut, free or on the line's obstacle.
void add_touch(Strip& strip, double at, const chain::Seat& seat);

/// A touch of two places with each other, one where a strand meets its own image.
/// @param mirrored    the other strand is the half-turn's image of that place
/// @param own_strand  of a line between a strand and its image, or a place that is on one link with the other
/// @param seat        of the first place; the second's has the opposite marks that these ask for (chain::Seat)
void add_pair(Strip& strip, double s, double other, bool mirrored, bool own_strand, chain::Seat seat);

/// Where along the other strand of a touch is nearest to a place along the first. @param guess  of it
double foot(const chain::Profile& profile, double s, double guess, bool mirrored);

/// The end of a line between strands has reached the edge of a line on an obstacle, or a place where another strand presses on it: it
/// goes on beyond that. Pressed right before the end, the line has its end's force there, and hardly any is left for the end. Empty:
/// another link. @param by_strand  what presses, not the edge
std::vector<Successor> line_passes(int link, bool by_strand, const chain::Profile& profile,
                                   const chain::Topology& topology, const Strip& strip);

/// Takes out a touch between strands: at each place the arcs beside it become one.
void take_out(int j, Strip& strip);

/// A mark that no touch has yet, see chain::Seat.
int new_strand(const Strip& strip);

/// The line of a touch and the next one of the same two strands, where these overlap beside both. nullopt: there is none.
std::optional<Successor> line_with_next(int joint, const chain::Profile& profile,
                                        const chain::Topology& topology, Strip strip);

/// A touch whose curvature is lost right beside a line of the same two strands, which goes on to it now. nullopt: there is none.
std::optional<Successor> line_joins(int joint, const chain::Profile& profile, const chain::Topology& topology,
                                    Strip strip);

/// Two lines of the same strands with a gap between them, a single link of one strand: one line. nullopt: none.
std::optional<Successor> lines_unite(int link, const chain::Profile& profile, const chain::Topology& topology,
                                     Strip strip);

/// A strand that touches its own image between two touches with it, right beside each other: one line. nullopt: it does not.
std::optional<Successor> line_of_three(int joint, const chain::Profile& profile,
                                       const chain::Topology& topology, Strip strip);

/// Do two strands come near each other next to a line of theirs?
bool next_to_line(const ContactEvent& event, const chain::Topology& topology);

/// Two strands that meet between two touches of theirs, or ends of lines, all of which are of one line now. nullopt: elsewhere.
std::optional<Successor> line_closes(const ContactEvent& event, const chain::Topology& topology, Strip strip);

/// Two strands that meet right beside the end of a line of theirs, which ends there now. nullopt: elsewhere.
std::optional<Successor> line_extends(const ContactEvent& event, const chain::Topology& topology,
                                      Strip strip);

/// A line whose touches are not enough, with more of them where the strands are too near; nullopt: the link is in none.
std::optional<Successor> line_filled(const ContactEvent& event, const chain::Profile& profile,
                                     const chain::Topology& topology, Strip strip);

/// Measures where touches inside lines between strands are, as parts of these, after their ends have changed.
void measure_parts(Strip& strip);

/// The joints at these places are known by guess only; one of those that share a place.
void hold_at(const std::vector<double>& places, Successor& out);

/// A touch of a line between free strands pulls: the line opens there, and ends at the touches beside. nullopt: it is in none.
std::optional<Successor> line_opens(int joint, const chain::Topology& topology, Strip strip);

/// The line has opened where touches next to each other pull: over √5 of the width of that suction, or beside an end of the line, which
/// stays a touch, over 5/3 of it (contact_events.hpp, "A gap that has just opened").
std::vector<Successor> line_opens_by_suction(int joint, const chain::Profile& profile,
                                             const chain::Topology& topology, const Strip& strip);

/// A line between a strand and its image, with its touches laid anew, open about the middle, which an edge or another touch has come
/// near. @param other  that joint. Nothing where little is left of the line
std::vector<Successor> line_opens_about(int middle, int other, const chain::Profile& profile,
                                        const chain::Topology& topology, const Strip& strip);

/// A line between strands that `link` belongs to, with fewer or more touches; nothing where there is none, or no touch inside.
std::optional<Successor> line_with_fewer_touches(const chain::Profile& profile,
                                                 const chain::Topology& topology, int link,
                                                 const Strip& strip);
std::optional<Successor> line_with_more_touches(const ContactEvent& event, const chain::Profile& profile,
                                                const chain::Topology& topology, const Strip& strip);

/// All lines with about so many times the touches.
Successor lines_with_denser_touches(const chain::Profile& profile, const chain::Topology& topology,
                                    Strip strip, double finer);

/// An arc beside such a touch has no length left: two touches meet or pass each other, or one passes the edge of a line.
/// nullopt: the link is beside none.
std::optional<Successor> after_length_beside_strand(int link, const Strip& strip);

/// Two strands that part: at each place the arcs beside it become one.
std::vector<Successor> strands_part(int j, Strip strip);

/// A strand that lies on an obstacle where another presses on it lifts off there: the line ends before and begins anew
/// behind, and between the other carries it alone.
std::vector<Successor> strand_lifts(int j, Strip strip);

/// Two strands that meet, or one that meets its own image.
std::vector<Successor> strands_meet(const ContactEvent& event, Strip strip);

/// A touch of two strands where they come apart into two touches, along the direction in which their distance no longer
/// grows: of s₁ and s₂ one up and the other down, or both up.
std::vector<Successor> strands_split(const ContactEvent& event, const Strip& strip,
                                     const chain::Profile& profile);

/// The line (chain::Seat) that the image of a touch is of, as image_strand().
int image_line(const Successor& next, int joint);

/// The strand that the image of a joint touches, on a chain where the image of every joint is one, too: a joint that touches
/// the image of y has its own image touch y.
/// @param joint  of `next`, on the side that changed
int image_strand(const Successor& next, int joint);

}  // namespace windlass::equilibrium
