#include "knot_on_plate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "attempt.hpp"
#include "strip.hpp"
#include "windlass/equilibrium/contact_events.hpp"

namespace windlass::equilibrium {

using chain::Piece;

namespace {

/// The section of a rod that is farthest towards the plate.
struct Farthest {
  int link = 0;
  double s = 0.0, height = -HUGE_VAL;  ///< of it towards the plate, up or down
};

Farthest farthest_of(const chain::Profile& shape, double towards) {
  Farthest out;
  for (int i = 0; i < static_cast<int>(shape.pieces.size()); ++i) {
    const Piece& piece = shape.pieces[i];
    for (Eigen::Index k = 0; k < piece.s.size(); ++k)
      if (towards * piece.r(2, k) > out.height) out = {i, piece.s(k), towards * piece.r(2, k)};
  }
  return out;
}

/// The same contacts and, where given, others, in the scene with its plate, from the shape lifted by `lift`.
std::optional<Started> lifted(const Started& still, chain::Profile shape, const Successor& next, double lift,
                              const scene::Scene& scene, const std::vector<std::string>& keys) {
  std::vector<chain::ArcMesh> meshes;
  for (const int source : next.source) meshes.push_back(still.problem->meshes()[source]);
  for (Piece& piece : shape.pieces) piece.r.row(2).array() += lift;
  choose_tails(meshes, next.topology, rod_of(scene, true), loads_of(scene), next.s);
  const auto problem = std::make_shared<RodProblem>(scene, true, next.topology, meshes, keys);
  const Vector p = problem->parameters();
  Vector x = chain::guess_state(problem->chain(), next.topology, problem->rod(), shape, next.s);
  const int used = problem->polish(x, p);
  if (used < 0) return std::nullopt;
  return Started{problem, problem->refine(x, p), p, still.newton_iterations + used};
}

Strip strip_of(const Started& at, const chain::Profile& shape) {
  return {at.problem->topology(), at.problem->joint_places(at.x, at.p, shape)};
}

/// The knot where it is, or clear of the plate.
std::optional<Started> beside_plate(const Started& still, const scene::Scene& scene,
                                    const std::vector<std::string>& keys, std::string& failure) {
  constexpr double clear = 0.1;  // [ρ]
  const double towards = scene.plate->side == scene::PlateSide::above ? 1.0 : -1.0;
  const chain::Profile shape = still.problem->profile(still.x, still.p);
  const double room = towards * scene.plate->height - farthest_of(shape, towards).height - clear;
  auto out =
      lifted(still, shape, strip_of(still, shape).successor(), towards * std::min(room, 0.0), scene, keys);
  if (!out) failure = "Newton did not converge on the knot moved along the axis";
  return out;
}

/// The knot without friction put under the plate: its highest place touches it, and the cylinder drags by a little friction.
std::optional<Started> under_plate(const Started& still, const scene::Scene& scene, std::string& failure) {
  const chain::Profile shape = still.problem->profile(still.x, still.p);
  const Farthest top = farthest_of(shape, 1.0);
  Strip strip = strip_of(still, shape);
  if (strip.is_line(top.link))
    return failure = "the highest place of the knot lies on the cylinder", std::nullopt;
  constexpr int plate = 1;  // its place among the obstacles
  strip.cut(top.link, top.s, {plate});
  const Successor next = strip.successor();
  auto out = lifted(still, shape, next, scene.plate->height - top.height, scene, {"cylinder.friction"});
  if (!out) failure = "Newton did not converge on the contacts " + next.topology.text();
  return out;
}

/// The same state on the plate as it is. Nothing where that does not reach as far as it is touched.
std::optional<Started> within_rim(const Started& endless, const scene::Scene& scene,
                                  const std::vector<std::string>& keys, std::string& failure) {
  const auto problem =
      std::make_shared<RodProblem>(scene, true, endless.problem->topology(), endless.problem->meshes(), keys);
  Started out{problem, endless.x, problem->parameters(), endless.newton_iterations};
  for (const ContactEvent& event : contact_events(problem->profile(out.x, out.p), problem->topology()))
    if (event.kind == ContactEvent::Kind::rim && event.value < 0.0)
      return failure = fmt::format("it would touch the plate beyond plate.outer_radius = {:.6g}",
                                   scene.plate->outer_radius),
             std::nullopt;
  return out;
}

}  // namespace

std::optional<Started> knot_on_plate(const scene::Scene& scene, const std::vector<std::string>& keys,
                                     std::string& failure) {
  constexpr double loose =
      0.3;  // tension at which the highest place of a hitch is free of the cylinder [EI/ρ²]
  constexpr double slight = 1e-3;  // friction that changes a shape by no more than Newton's method sees to
  scene::Scene still = scene;
  still.plate.reset();
  still.motion = {};
  const bool slides = scene.slides();
  if (slides) still.load.tension = loose;
  const auto knot = knot_start(still, false, {"load.tension"}, failure);
  if (!knot) return std::nullopt;
  if (!slides) return beside_plate(*knot, scene, keys, failure);
  scene::Scene at = scene;
  at.plate->outer_radius = HUGE_VAL;  // on the way the plate may be touched farther out
  at.load.tension = loose;
  at.friction = std::min(slight, *scene.friction);
  std::optional<Started> from = under_plate(*knot, at, failure);
  if (!from) return std::nullopt;
  at.friction = scene.friction;
  from = reach(*from, at, *scene.friction, false, {"load.tension"}, failure);
  if (!from) return std::nullopt;
  at.load.tension = scene.load.tension;
  from = reach(*from, at, scene.load.tension, false, keys, failure);
  return from ? within_rim(*from, scene, keys, failure) : std::nullopt;
}

}  // namespace windlass::equilibrium
