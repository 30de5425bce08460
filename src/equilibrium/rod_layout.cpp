// The rows of touches that lines between strands are, laid where a rod's state needs them.
#include <algorithm>
#include <cmath>

#include "entry.hpp"
#include "line_touches.hpp"
#include "strand_line_events.hpp"
#include "windlass/equilibrium/contact_events.hpp"
#include "windlass/equilibrium/opening.hpp"
#include "windlass/equilibrium/rod_problem.hpp"
#include "windlass/rod/quaternion.hpp"

namespace windlass::equilibrium {

namespace {

constexpr double allowed = 8e-10;  // certificates ask for 1e-9

/// Range of H along the rod, of max(1, T), as a part of what is allowed: rows of touches that stand for lines leave some of it,
/// p²h⁴/144B where spacing or pressure changes, more beside forces.
/// 0: friction or weight change it, or stretch, which is left out here.
double drift_of_hamiltonian(const chain::Profile& shape, bool dragged) {
  if (dragged || shape.material.stretches) return 0.0;
  const auto hamiltonian = [&](const chain::Piece& piece) {
    const Eigen::Matrix3d directors = rod::directors(piece.q.col(0));
    const Eigen::Vector3d m = directors.transpose() * piece.m.col(0);
    const Eigen::Vector3d strain = m.cwiseQuotient(shape.material.stiffness);
    return m.dot(0.5 * strain + shape.material.natural) + piece.n.col(0).dot(directors.col(2));
  };
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (const chain::Piece& piece : shape.pieces) {
    if (piece.length() == 0.0) continue;  // has no section of its own
    const double h = hamiltonian(piece);
    low = std::min(low, h), high = std::max(high, h);
  }
  return (high - low) / (allowed * std::max(1.0, shape.pieces.back().n.col(0).norm()));
}

/// How little strands are tangent at the touches inside their lines, as a part of what is allowed: by half the distance
/// to the next touch.
double slope_at_touches(const chain::Profile& shape, const chain::Strands& strands) {
  double most = 0.0;
  const auto place = [&](int joint) { return shape.pieces[joint].s(0); };
  for (const chain::Contact& c : shape.contacts) {
    if (c.coupling < 0 || !strands.laid(c.joint)) continue;
    const auto [before, after] = strands.neighbours(c.joint);
    const double next = std::max(place(c.joint) - place(before), place(after) - place(c.joint));
    const Eigen::Vector3d tangent = rod::directors(shape.pieces[c.joint].q.col(0)).col(2);
    most = std::max(most, std::abs(c.normal.dot(tangent)) * 0.5 * next / shape.unit_length);
  }
  return most / allowed;
}

/// Is it the same state? Touches move what they stand for by less than this.
bool same(const chain::Profile& shape, const Entry& laid) {
  constexpr double most = 1e-5;
  const chain::Profile there = laid.problem->profile(laid.x, laid.p);
  return chain::in_order(there) && chain::farthest(there, shape) < most * shape.unit_length;
}

/// Touches laid anew may show where a line has opened, or strands are too near: with what follows from that, as far as it leaves the
/// state what it is. nullopt: all holds, or nothing is found.
std::optional<Entry> with_what_they_show(const Entry& laid) {
  constexpr int most = 12;
  if (holds(laid)) return std::nullopt;
  Entry out = laid;
  int iterations = 0;
  if (!tried([&] { return mend(out, most, true, iterations); })) return std::nullopt;
  return out;
}

}  // namespace

std::optional<Vector> RodProblem::laid_where_needed(const Vector& x, const Vector& p) {
  constexpr double few = 0.6, many = 0.03;  // of what is carried, at the place where strands are nearest
  constexpr double denser = 1.2, densest = 1.5, forgotten = 0.9, by_chance = 1.2;
  if (chain_->couplings().empty()) return std::nullopt;
  const chain::Profile shape = profile(x, p);
  double nearer = nearer_between_touches(shape, topology_) / carried_between_strands;
  if (nearer < 0.0) return std::nullopt;
  for (const ContactEvent& event : contact_events(shape, topology_))
    if (event.kind == ContactEvent::Kind::approach && event.redrawn)
      nearer = std::max(nearer, 1.0 - event.value);
  if (touches_too_near(shape, topology_) || pressed_without_touch(shape, topology_)) nearer = 1.0;
  drift_floor_ *= forgotten;
  const bool well_spaced = nearer > many && nearer < few;
  const auto left_in = [&](const chain::Profile& at, const Topology& touches) {
    return std::max(drift_of_hamiltonian(at, dragged()), slope_at_touches(at, chain::Strands(touches)));
  };
  double left = left_in(shape, topology_);
  const auto too_much = [&] { return left > std::max(1.0, by_chance * drift_floor_); };
  if (well_spaced && !too_much()) return std::nullopt;
  const Strip strip(topology_, joint_places(x, p, shape));
  const Successor skeleton = skeleton_of(strip).strip.successor();
  std::optional<Entry> best;
  // The spacing that the pressure asks for first, but where it is that of now.
  for (double finer = well_spaced ? denser : 1.0; finer < densest && (!best || too_much()); finer *= denser) {
    const Successor next = with_touches(skeleton, shape, topology_, finer);
    if (nearer < many && !too_much() && next.s.size() >= strip.s.size()) break;
    Entry laid = draft(*this, next, shape, p);
    if (laid.problem->polish(laid.x, p) < 0) break;
    const chain::Profile there = laid.problem->profile(laid.x, p);
    if (!same(shape, laid)) break;
    const double now = left_in(there, laid.problem->topology());
    if (now > left && (best || well_spaced)) break;  // it is not the spacing's
    best = std::move(laid), left = now;
  }
  if (too_much()) drift_floor_ = std::max(drift_floor_, left);
  if (!best) return std::nullopt;
  if (const auto mended = with_what_they_show(*best); mended && same(shape, *mended)) best = *mended;
  topology_ = best->problem->topology();
  meshes_ = best->problem->meshes();
  rebuild();
  return best->x;
}

}  // namespace windlass::equilibrium
