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
/// | pressure | least pressure on a line contact | the line opens: a gap inside it, or all of it |
/// | length | length of a line contact, or of a gap between contacts, less `least_length` | a touch in its place; where
/// only one side of a full chain's mid-point runs out, the contact there moves over it |
/// | force | point force at a touch or an edge | the touch is lost (an edge: no successor is known) |
/// | curvature | g'' at a touch | the touch flattens into a line, or comes apart into two |
/// | graze | least gap inside a free arc, of each obstacle | a new touch |
/// | buckling | margin of a line without pressure against its own buckling | it bows off the obstacle between two touches |
namespace windlass::equilibrium {

/// Forces of an arc of length ℓ carry rounding errors like 1/ℓ: it gives way to the topology without it this early, and
/// the event itself is located there. In units of Profile::unit_length.
inline constexpr double least_length = 1e-3;
struct ContactEvent {
  enum class Kind { pressure, length, force, curvature, graze, buckling };
  Kind kind = Kind::force;
  int place = 0;  ///< link (pressure, length, graze, buckling) or joint (force, curvature)
  double value = 0.0;
  double s = 0.0;         ///< where along the rod
  int obstacle = 0;       ///< graze: the one that the rod comes near
  bool imminent = false;  ///< length of a gap so short that its two touches can hardly be told apart
  std::string name() const;
};

/// All events of a state, in a fixed order for a given topology.
std::vector<ContactEvent> contact_events(const chain::Profile& profile, const chain::Topology& topology);

/// A topology with the arclengths of its joints, to be filled from the old profile.
struct Successor {
  chain::Topology topology;
  std::vector<double> s;      ///< one a joint of the new chain
  std::vector<int> source;    ///< link of the old chain whose mesh each new arc inherits
  std::vector<int> opened;    ///< links that have no length at the event itself
  int bowed = -1;             ///< link that has no bow at the event itself, −1: none
  bool nothing_left = false;  ///< no contact remains: the branch ends
};

/// Candidates for what follows the event, most likely first.
std::vector<Successor> successors(const ContactEvent& event, const chain::Profile& profile,
                                  const chain::Topology& topology, const std::vector<double>& s);

}  // namespace windlass::equilibrium
