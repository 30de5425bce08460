#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

#include "entry.hpp"
#include "friction_couple.hpp"
#include "line_touches.hpp"
#include "not_built.hpp"
#include "opened_entry.hpp"
#include "windlass/equilibrium/contact_events.hpp"
#include "windlass/equilibrium/opening.hpp"
#include "windlass/equilibrium/rod_problem.hpp"
#include "windlass/equilibrium/start.hpp"

namespace windlass::equilibrium {

namespace {

using Kind = ContactEvent::Kind;

/// What vanishes with an arc about s, in the topology without it: the curvature of the touch there, or the pressure of the
/// line. Of several the one that comes last in the order of events.
std::optional<std::string> vanishing_with(const chain::Profile& shape, const Topology& topology, double s) {
  const double least = least_length * shape.unit_length;
  std::optional<std::string> name;
  const chain::Strands strands(topology);
  const auto touches_there = [&](const ContactEvent& event) {  // of two strands, either of them
    const int partner = strands.partner(event.place);
    return std::any_of(shape.contacts.begin(), shape.contacts.end(), [&](const chain::Contact& c) {
      return (c.joint == event.place || c.joint == partner) && std::abs(c.s - s) < 10.0 * least;
    });
  };
  for (const ContactEvent& event : contact_events(shape, topology)) {
    if (event.kind == Kind::curvature && touches_there(event)) return event.name();
    constexpr double near = 1e-3;
    const bool at_end = (event.s == shape.begin() || event.s == shape.end()) &&
                        std::abs(event.value) < near * shape.unit_length;
    if ((event.kind == Kind::slope || (event.kind == Kind::graze && at_end)) &&
        std::abs(event.s - s) < 10.0 * least)
      return event.name();
    const bool unpressed = event.kind == Kind::buckling && shape.pieces[event.place].buckling;
    if (event.kind != Kind::pressure && !unpressed) continue;
    const Eigen::VectorXd& places = shape.pieces[event.place].s;
    const double begin = places(0), end = places(places.size() - 1);
    // The touches of a bow have moved since it was straight.
    constexpr double moved = 0.05;
    const double beyond = unpressed ? moved * (end - begin) : least;
    if (begin - beyond < s && s < end + beyond) name = event.name();
  }
  return name;
}

/// From a state whose arc about s has nearly vanished to the one where it does, the event itself. In the topology without
/// the arc that is a zero of the curvature of the touch at s, or of the pressure there.
/// @returns the precision of p(0), nothing if there is no such zero near
/// @param name  of what vanishes; not given: chosen once, for on the way to the event it moves
std::optional<double> locate_from_beyond(Entry& entry, double s, std::optional<std::string>& name) {
  const auto value_at = [&](Entry& at) -> std::optional<double> {
    if (at.problem->polish(at.x, at.p, 18) < 0) return std::nullopt;
    const chain::Profile shape = at.problem->profile(at.x, at.p);
    if (!name) name = vanishing_with(shape, at.problem->topology(), s);
    return name ? value_of(contact_events(shape, at.problem->topology()), *name) : std::nullopt;
  };
  const double scale = std::max(1.0, std::abs(entry.p(0))), start = entry.p(0);
  Entry other = entry;
  other.p(0) += 1e-5 * scale;
  std::optional<double> last = value_at(other);
  if (last) entry.x = other.x;  // nearer than the guess
  std::optional<double> value = value_at(entry);
  double last_p = other.p(0);
  for (int k = 0; k < 20 && last && value && *value != *last; ++k) {
    const double step = -*value * (entry.p(0) - last_p) / (*value - *last);
    if (std::abs(entry.p(0) + step - start) > 0.05 * scale) return std::nullopt;
    last_p = entry.p(0);
    last = value;
    entry.p(0) += step;
    value = value_at(entry);
    if (std::abs(step) < 1e-11 * scale) return value ? std::optional(std::abs(step)) : std::nullopt;
  }
  return std::nullopt;
}

/// Solves for the successor right here, or a little to either side, with its contacts intact.
bool settle_beside(Entry& entry, const std::vector<double>& offsets) {
  const Vector p = entry.p, guess = entry.x;
  const std::shared_ptr<RodProblem> problem = entry.problem;
  for (const double offset : offsets) {
    entry.p = p;
    entry.x = guess;
    entry.p(0) += offset;
    constexpr int most = 18, most_redrawn = 12;
    int iterations = 0;
    if (tried([&] {
          return entry.problem->polish(entry.x, entry.p, most) >= 0 &&
                 (holds(entry) || mend(entry, most_redrawn, true, iterations));
        }))
      return true;
    entry.problem = problem;
  }
  return false;
}

/// The same, on either side of the event. @param parts  of p(0), by how far
bool settle_on_either_side(Entry& entry, std::initializer_list<double> parts) {
  std::vector<double> offsets;
  for (const double offset : parts)
    for (const double sign : {-1.0, 1.0}) offsets.push_back(sign * offset * std::abs(entry.p(0)));
  return settle_beside(entry, offsets);
}

/// The same, a touch in the place of a line on a plane that has no length left: it holds on one side of the event, from
/// where its curvature is that at which it gives way (`least_curvature`).
bool settle_touch(Entry& entry) { return settle_on_either_side(entry, {1e-4, 4e-4, 2e-3, 1e-2}); }

/// Link of a line on a plane that begins or ends at the event, in `lines`; −1: it is none.
int straight_line(const RodProblem& lines, int link) {
  const Topology& topology = lines.topology();
  if (topology.stretches[link] != chain::Stretch::line) return -1;
  return lines.rod().obstacles[topology.obstacle(link == 0 ? 1 : link)].curvature() == 0.0 ? link : -1;
}

/// State of a touch at p(0), where branches cross and its equations are singular: extrapolated from the side that it is on.
/// @returns whether there is a solution at all of the places that it is extrapolated from
bool extrapolate(Entry& touch, double p) {
  constexpr int levels = 4;
  constexpr double nearest = 1e-4;  // of p: rounding is amplified by its inverse, the error is (8e-4)⁴
  const double distance = std::copysign(nearest * std::abs(p), touch.p(0) - p);
  std::array<Vector, levels> x;
  // The nearer to the crossing, the nearer Newton has to start: outward from where the state is known, if it is known so
  // near, and along the secant.
  const bool outward = std::abs(touch.p(0) - p) < std::abs(distance) * (1 << (levels - 1));
  Vector slope = Vector::Zero(touch.x.size());
  for (int n = 0; n < levels; ++n) {
    const int k = outward ? n : levels - 1 - n;
    const Vector last = touch.x;
    const double next = p + distance * (1 << k), step = next - touch.p(0);
    touch.x += step * slope;
    touch.p(0) = next;
    if (touch.problem->polish(touch.x, touch.p, 18) < 0) return false;
    if (step != 0.0) slope = (touch.x - last) / step;
    x[k] = touch.x;
  }
  touch.x = limit_at_zero(x).value;
  touch.p(0) = p;
  return true;
}

/// State of a touch at p(0). Of struts it is singular there; a plate's touch is not.
bool bring_touch_to(Entry& touch, double p) {
  if (touch.problem->rod().strut) return extrapolate(touch, p);
  touch.p(0) = p;
  return touch.problem->polish(touch.x, touch.p) >= 0;
}

/// The event where a line on a plane begins, and the touch in its place.
std::optional<continuation::Transition::Located> located_onset(Entry line, int link, Entry touch) {
  std::optional<Vanishing> begins;
  constexpr double settled = 1e-8;
  touch.problem = std::static_pointer_cast<RodProblem>(touch.problem->clone());
  if (!tried([&] {
        begins = where_length_vanishes(*line.problem, line.x, line.p, link,
                                       4.0 * least_length * line.problem->rod().unit_length);
        return begins && bring_touch_to(touch, begins->p) &&
               touch.problem->residual_norm(touch.problem->residual(touch.x, touch.p)) < settled;
      }))
    return std::nullopt;
  return continuation::Transition::Located{touch.problem, touch.x, touch.p, begins->precision};
}

/// The event at which an arc beside a touch of strands has no length.
std::optional<continuation::Transition::Located> located_vanishing(Entry here, int link) {
  here.problem = std::static_pointer_cast<RodProblem>(here.problem->clone());
  std::optional<Vanishing> at;
  if (!tried([&] {
        at = where_length_vanishes(*here.problem, here.x, here.p, link, entered_beside_strand(*here.problem));
        return at.has_value();
      }))
    return std::nullopt;
  // Forces of touches close to each other answer to what is left of an extrapolation; then the state is one that holds.
  constexpr double certain = 1e-9;
  if (at->uncertain > certain) {
    here.p(0) = at->nearest_p;
    return continuation::Transition::Located{here.problem, at->nearest_x, here.p,
                                             std::max(at->precision, std::abs(at->nearest_p - at->p))};
  }
  here.p(0) = at->p;
  return continuation::Transition::Located{here.problem, at->x, here.p, at->precision};
}

/// How far in p(0) the place where a tail has no length is from where it has hardly any.
double to_the_end(RodProblem& problem, const Vector& x, const Vector& p, int link) {
  const double length = problem.chain().length(x, problem.loads(p), link);
  Vector longer = x, beside = p;
  const bool solved = tried([&] { return solve_at_length(problem, longer, beside, link, 2.0 * length); });
  return solved ? std::abs(beside(0) - p(0)) : -1.0;
}

/// How far in p(0) the place where a touch is flat is from where it gives way: nothing on a cylinder, on a plane a little
/// (`least_curvature`).
double to_flat(RodProblem& problem, Vector x, Vector p, const chain::Profile& shape,
               const ContactEvent& event) {
  const chain::Contact* touch = shape.contact_at(event.place);
  if (event.kind != Kind::curvature || !touch) return -1.0;
  const double step = 1e-5 * std::max(1.0, std::abs(p(0)));
  p(0) += step;
  double slope = 0.0;
  tried([&] {
    if (problem.polish(x, p) < 0) return false;
    const auto beside = value_of(contact_events(problem.profile(x, p), problem.topology()), event.name());
    if (beside) slope = (*beside - event.value) / step;
    return beside.has_value();
  });
  return slope != 0.0 ? std::abs(touch->gap_curvature / slope) : -1.0;
}

/// The force of the touch between strands that is new in a topology.
std::string new_touch_force(const Topology& topology) {
  int newest = 0;
  for (int j = 0; j < static_cast<int>(topology.on.size()); ++j)
    if (std::abs(topology.on[j].strand) > std::abs(topology.on[newest].strand)) newest = j;
  return "force " + std::to_string(std::min(newest, chain::Strands(topology).partner(newest)));
}

/// Is it the state before the event again? A touch that strands meet in, and that a line of theirs has taken in, may be gone with the
/// line's touches laid anew: then nothing but these has other numbers.
bool came_from(const Entry& before, const ContactEvent& event, const Entry& found) {
  const Topology &old = before.problem->topology(), &now = found.problem->topology();
  if (now == old) return true;
  if (event.kind != Kind::approach || now.text() != old.text()) return false;
  const auto located = [](const Entry& at) {
    const chain::Profile shape = at.problem->profile(at.x, at.p);
    return skeleton_of(Strip(at.problem->topology(), at.problem->joint_places(at.x, at.p, shape)))
        .strip.s.size();
  };
  return located(before) == located(found);
}

/// Solves for the successor of an event. @param transition  told where the state found is the event itself
/// @param becomes_touch  a line on a plane has no length left
std::optional<Entry> enter(const Entry& guess, const ContactEvent& event, const Successor& next,
                           bool becomes_touch, continuation::Transition& transition) {
  Together together;
  const double unit = guess.problem->rod().unit_length;
  Entry exact = guess;
  // What vanishes may have another arc open in its place, whose length then says where.
  const bool opens = !next.opened.empty() && next.topology.couplings().empty();
  const bool vanishes = (event.kind == Kind::length && !event.redrawn && !becomes_touch && !opens) ||
                        (event.kind == Kind::curvature && next.opened.empty());
  // Where strands meet the force of the new touch says better than their distance between samples.
  const bool meets = event.kind == Kind::approach && !event.redrawn;
  const double at = vanishes ? event.s + 0.5 * least_length * unit : event.s;
  if ((vanishes || meets) && tried([&] {
        std::optional<std::string> name;
        if (meets) name = new_touch_force(next.topology);
        const auto found = locate_from_beyond(exact, at, name);
        if (found) transition.precision = *found, transition.vanishes = *name;
        // A touch that carries next to nothing has reached the rod's end, which lifts off a little further on.
        if (found && name->starts_with("graze"))
          transition.precision = std::max(*found, std::abs(exact.p(0) - guess.p(0)));
        return found && holds(exact);
      }))
    return exact;
  transition.precision = -1.0;
  std::optional<Entry> entered;
  if (next.bowed >= 0) {
    Entry bow = guess;
    if (tried([&] { return enter_bowed(*bow.problem, bow.x, bow.p, next.bowed) && holds(bow); }))
      entered = bow;
    return entered;
  }
  if (!next.opened.empty()) {
    tried([&] {
      entered = open_in_turn(guess, next.opened, together, event.redrawn, guess.p(0));
      return true;
    });
    Entry near = guess;
    if (!entered && next.beside && settle_on_either_side(near, {1e-3, 4e-3, 1.6e-2, 4e-2})) entered = near;
    return entered;
  }
  Entry beside = guess;
  const bool settled = becomes_touch ? settle_touch(beside) : settle_beside(beside, {0.0});
  return settled ? std::optional(beside) : std::nullopt;
}

}  // namespace

std::vector<continuation::EventFunction> RodProblem::events(const Vector& x, const Vector& p) {
  std::vector<continuation::EventFunction> out;
  if (rod_.obstacles.size() == 0 && scene_.strand_radius() == 0.0) return out;
  for (const ContactEvent& event : contact_events(profile(x, p), topology_))
    out.push_back({event.name(), event.value, event.imminent, event.passes});
  return out;
}

std::optional<continuation::Transition> RodProblem::transition(std::size_t which, const Vector& x,
                                                               const Vector& p) {
  const chain::Profile shape = profile(x, p);
  const ContactEvent event = contact_events(shape, topology_).at(which);
  return after_event(event, shape, x, p);
}

std::optional<continuation::Transition> RodProblem::resettled(const Vector& last, const Vector& last_p,
                                                              const Vector& x, const Vector& ahead) {
  constexpr int most = 40;
  constexpr double rounding = 1e-7;
  Entry at{std::static_pointer_cast<RodProblem>(clone()), x, ahead};
  int iterations = 0;
  const chain::Profile here = profile(last, last_p), expected = profile(x, ahead);
  if (!tried([&] { return at.problem->polish(at.x, ahead, 18) >= 0; })) at.x = x;
  if (!tried([&] { return mend(at, most, false, iterations) && (at.problem->settle(at.x, ahead), true); }))
    return std::nullopt;
  const chain::Profile found = at.problem->profile(at.x, ahead);
  const double reach = chain::farthest(expected, here) + rounding * here.unit_length;
  if (!chain::in_order(found) || chain::farthest(found, expected) > reach) return std::nullopt;
  continuation::Transition out;
  out.problem = at.problem, out.state = at.x, out.p = ahead;
  out.before = topology_.text(), out.after = at.problem->topology().text();
  return out;
}

std::optional<continuation::Transition> RodProblem::after_event(const ContactEvent& event,
                                                                const chain::Profile& shape, const Vector& x,
                                                                const Vector& p) {
  std::optional<continuation::Transition> first;
  std::string beyond;  // contacts that something in the scene is not built for
  for (const Successor& next : successors(event, shape, topology_, joint_places(x, p, shape))) {
    if (const char* key = missing_on(next.topology)) {
      if (key == std::string_view("plate.outer_radius")) {  // null problem: the branch ends here
        continuation::Transition end;
        end.before = topology_.text();
        end.after = next.topology.text() + " (" + rim_not_thickened() + ")";
        return end;
      }
      beyond = fmt::format("{} ({} is not built for {})", next.topology.text(), key, contacts_not_built(key));
      continue;
    }
    continuation::Transition transition;
    transition.before = topology_.text();
    transition.after = next.topology.text();
    transition.silent = event.redrawn;
    if (event.passes) return transition;
    if (next.nothing_left && !rod_.strut) {  // a free rod goes on without contact
      transition.after = "no contact";
      return transition;  // null problem: the branch ends here
    }
    if (next.at_rim) {
      transition.after = "contact with the plate's outer edge";
      return transition;
    }
    if (next.at_end) {
      transition.after = "contact at the rod's end";
      transition.precision = to_the_end(*std::static_pointer_cast<RodProblem>(clone()), x, p, event.place);
      return transition;
    }
    const Entry entry = draft(*this, next, shape, p);
    if (!first) {
      // On the mesh that this guess is of: what follows may remesh its problem, and fail after that.
      transition.state = entry.x;
      transition.problem = entry.problem->clone();
      first = transition;
    }
    const bool shrinks = event.kind == Kind::length && straight_line(*this, event.place) >= 0;
    std::optional<Entry> found = enter(entry, event, next, shrinks, transition);
    const auto here = std::static_pointer_cast<RodProblem>(clone());
    if (!found || (!event.redrawn && came_from({here, x, p}, event, *found))) continue;
    if (!tried([&] { return found->problem->settle(found->x, found->p), true; })) continue;
    if (event.kind == Kind::length && !event.redrawn && transition.precision < 0.0 &&
        topology_.beside_strand(event.place))
      transition.located = located_vanishing({here, x, p}, event.place);
    else if (shrinks)
      transition.located = located_onset({here, x, p}, event.place, *found);
    else if (event.kind == Kind::curvature && next.opened.size() == 1 &&
             straight_line(*found->problem, next.opened.front()) >= 0)
      transition.located = located_onset(*found, next.opened.front(), {here, x, p});
    transition.problem = found->problem;
    transition.after = found->problem->topology().text();
    transition.state = found->x;
    if (!event.redrawn && (found->p != p || transition.precision >= 0.0)) transition.p = found->p;
    return transition;
  }
  if (beyond.empty()) return first;
  continuation::Transition end;  // null problem: the branch ends here
  end.before = topology_.text(), end.after = beyond;
  end.precision = to_flat(*std::static_pointer_cast<RodProblem>(clone()), x, p, shape, event);
  return end;
}

}  // namespace windlass::equilibrium
