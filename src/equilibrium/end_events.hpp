#pragma once

#include <optional>
#include <vector>

#include "dense_samples.hpp"
#include "strip.hpp"
#include "windlass/equilibrium/contact_events.hpp"

/// Plates that the ends of a rod touch, and the room between two plates that a rod floats in (PHYSICS, "Two plates").
namespace windlass::equilibrium {

/// Is an obstacle a plate beside the cylinder?
bool is_plate(const obstacle::Set& obstacles, int obstacle);

/// The obstacle that a rod's image touches. Where nothing but two plates holds a rod along the axis, its half-turn maps one to the
/// other; the mirror of one that is dragged keeps them.
int image_of(const chain::Profile& profile, int obstacle);

/// The gap at an end of the rod on this link that comes nearer to a plate all the way to the end; nothing where it does not, touches
/// that plate, or is held in its place.
std::optional<Least> graze_at_end(const chain::Profile& profile, const chain::Topology& topology,
                                  int obstacle, int link);

/// Of ends that touch a plate: the plate's force, and how much the tail slopes towards it there.
std::vector<ContactEvent> end_events(const chain::Profile& profile, const chain::Topology& topology);

/// Of a rod that floats between two plates: their distance less its height. It could touch either at no force, wherever it is.
std::optional<ContactEvent> room_event(const chain::Profile& profile);

/// Lifts a floating rod to the middle between the two plates.
void centre_between_plates(chain::Profile& profile);

/// Is a joint of the strip an end of the rod?
bool is_end(const Strip& strip, int joint);

/// An end that reaches a plate touches it; where it is level there the tail beside it does.
std::optional<Successor> end_touches(const ContactEvent& event, const chain::Profile& profile,
                                     const Strip& strip);
/// A floating rod has no room left: what is highest and what is lowest touch the plates. Empty where that lies on a line.
std::vector<Successor> touches_both(const chain::Profile& profile, const Strip& strip);
/// An end that touches a plate lies level there: the touch moves inward, what is beyond lies flat in the plate.
std::vector<Successor> touch_leaves_end(const ContactEvent& event, const Strip& strip);
/// A touch of a plate has reached the end of the rod, which touches now, or lifts off where hardly anything presses it on. Nothing
/// for other tails.
std::optional<Successor> touch_reaches_end(int tail, const chain::Profile& profile, const Strip& strip);
/// Nothing but plates holds the rod along the axis, and one alone does not push it: it floats again.
void float_where_one_is_left(const chain::Profile& profile, Strip& strip);

}  // namespace windlass::equilibrium
