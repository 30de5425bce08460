#pragma once

#include <optional>
#include <string>
#include <vector>

#include "windlass/chain/profile.hpp"
#include "windlass/chain/topology.hpp"
#include "windlass/equilibrium/micro_gap.hpp"

/// Where a contact topology ends, and which one follows.
///
/// | event | positive quantity | what follows |
/// |---|---|---|
/// | pressure | least pressure on a line contact | the line opens: a gap inside it, or all of it |
/// | length | length of a line contact, or of a gap between contacts, less `least_length` | a touch in its place; where
/// only one side of a full chain's mid-point runs out, the contact there moves over it |
/// | force | point force at a touch or an edge | the touch is lost (an edge: no successor is known) |
/// | curvature | g'' at a touch | the touch flattens into a line, or comes apart into two |
/// | graze | least gap inside a free arc | a new touch |
/// | closure | suction of a gap without an arc | the line closes |
/// | arc | height it may still grow | the same gap with an arc of its own: no point of the branch |
///
/// Values are in units of `Scales`. The length of a gap in a line contact is the part of its height beyond which it keeps
/// its arc: what follows is the same gap without.
namespace windlass::equilibrium {

/// Forces of an arc of length ℓ carry rounding errors like 1/ℓ: it gives way to the topology without it this early, and
/// the event itself is located there.
inline constexpr double least_length = 1e-3;
/// So far a contact goes over the mid-point of a full chain before it counts to the other side: nothing is lost there.
inline constexpr double past_mid = 1e-5;

struct ContactEvent {
  enum class Kind { pressure, length, force, curvature, graze, closure, arc };
  Kind kind = Kind::force;
  int place = 0;  ///< link (pressure, length, graze) or joint (force, curvature)
  double value = 0.0;
  double s = 0.0;         ///< where along the rod
  bool imminent = false;  ///< length of a gap so short that its two touches can hardly be told apart
  std::string name() const;
};

/// Does a stretch across the mid-point of a full chain run out on one side only? What bounds it there moves over the
/// mid-point then.
bool one_side_ends(double length, double other_length);

/// All events of a state, in a fixed order for a given topology.
std::vector<ContactEvent> contact_events(const chain::Profile& profile, const chain::Topology& topology,
                                         const Scales& scales = {});

LineContact line_contact_of(const chain::Piece& piece, const chain::Topology& topology, int link,
                            const Scales& scales);
/// Of a line's gaps the one next to close, and the one next to need an arc.
const MicroGap& shallowest(const LineContact& line);
const MicroGap& tallest(const LineContact& line);
/// Height of a gap between two lines, or a line and a touch, by its edge force; nothing for any other link.
std::optional<double> height_between_lines(const chain::Profile& profile, const chain::Topology& topology,
                                           int link, const Scales& scales);

/// A topology with the arclengths of its joints, to be filled from the old profile.
struct Successor {
  chain::Topology topology;
  std::vector<double> s;       ///< one a joint of the new chain
  std::vector<int> source;     ///< link of the old chain whose mesh each new arc inherits
  std::vector<int> opened;     ///< links that have no length at the event itself
  bool nothing_left = false;   ///< no contact remains: the branch ends
  bool same_chain = false;     ///< only the gaps without arcs differ: the state is the old one
  bool same_contacts = false;  ///< a gap gets or gives up its arc
  bool passes_mid = false;     ///< a contact moves over the mid-point of a full chain: the same contacts
};

/// Candidates for what follows the event, most likely first.
std::vector<Successor> successors(const ContactEvent& event, const chain::Profile& profile,
                                  const chain::Topology& topology, const std::vector<double>& s,
                                  const Scales& scales = {});

}  // namespace windlass::equilibrium
