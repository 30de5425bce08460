#include <cmath>

#include "attempt.hpp"
#include "windlass/chain/ring.hpp"
#include "windlass/scene/error.hpp"

namespace windlass::equilibrium {

using chain::ArcMesh;
using chain::Stretch;

namespace {

/// A strut's half chain near a given shape; nullopt where Newton does not converge.
std::optional<Started> strut_near(const scene::Scene& scene, const chain::Profile& shape, double thrust,
                                  const std::vector<std::string>& keys) {
  constexpr int elements = 8;  // with order 12 the straight strut's buckling loads are exact to 1e-13
  const Topology topology{{Stretch::tail}, true, false};
  const std::vector<ArcMesh> meshes{{chain::uniform_mesh(elements), start_stages}};
  auto problem = std::make_shared<RodProblem>(scene, true, topology, meshes, keys);
  const double half_length = loads_of(scene).half_length;
  Vector x = chain::guess_state(problem->chain(), topology, problem->rod(), shape, {0.0, half_length});
  const Vector p = problem->parameters();
  problem->chain().force(x, 0)[0] = -thrust;
  const int used = problem->polish(x, p);
  if (used < 0) return std::nullopt;
  return Started{problem, x, p, used};
}

/// A slightly shortened strut: a moderate bow, whose amplitude follows from the shortening.
std::optional<Started> bowed_strut(const scene::Scene& scene) {
  constexpr double moderate = 0.02;
  const double goal = *scene.ends.shortening, length = scene.rod.length;
  const double critical = 4.0 * M_PI * M_PI * scene.rod.bending_stiffness / (length * length);
  scene::Scene near = scene;
  near.ends.shortening = moderate;
  const chain::Profile bow = chain::strut_profile(loads_of(near), 2.0 * std::sqrt(moderate));
  std::optional<Started> from = strut_near(near, bow, critical, {"ends.shortening"});
  // Towards none by factors: the amplitude goes like the square root.
  for (double at = moderate; from && at > goal;) {
    at = std::max(goal, at / 3.0);
    from->p = Vector::Constant(1, at);
    if (from->problem->polish(from->x, from->p) < 0) from.reset();
  }
  return from;
}

/// A strut whose twist has gone into a loop: the ring, with its ends together.
std::optional<Started> looped_strut(const scene::Scene& scene) {
  scene::Scene near = scene;
  near.ends.shortening = 1.0;
  return strut_near(near, chain::ring_profile(loads_of(near)), 0.0, {"ends.shortening"});
}

}  // namespace

/// Under a given thrust: the straight strut, twisted evenly. Its mesh is kept: nothing in this state tells how fine the
/// mesh must be for the buckling loads.
Started straight_strut(const scene::Scene& scene, bool half, const std::vector<std::string>& keys) {
  const chain::Profile straight = chain::strut_profile(loads_of(scene), 0.0);
  const std::optional<Started> start = strut_near(scene, straight, scene.load.thrust.value_or(0.0), keys);
  if (!start) throw NoEquilibrium("Newton did not converge for the straight strut");
  start->problem->error_estimate(start->x, start->p);
  if (!half) return unfold(*start->problem, start->x, start->p, start->newton_iterations);
  return *start;
}

/// At a given shortening: followed from the bowed strut. A strut twisted by a full turn or so may not get there, since
/// its ends come together only once the twist has gone into a loop; it is then followed from the ring.
Started buckled_strut(const scene::Scene& scene, bool half, const std::vector<std::string>& keys) {
  const double goal = *scene.ends.shortening;
  if (!(goal > 0.0))
    throw scene::SceneError(
        "ends.shortening = 0: a straight inextensible strut carries any thrust up to buckling; give "
        "load.thrust, or a shortening above 0");
  std::string failure = "Newton did not converge near the straight one";
  const auto reached = [&](std::optional<Started> from) -> std::optional<Started> {
    if (!from) return std::nullopt;
    from->x = from->problem->refine(from->x, from->p);
    return reach(*from, scene, goal, half, keys, failure);
  };
  if (auto bowed = reached(bowed_strut(scene))) return *bowed;
  if (std::abs(scene.ends.twist) > M_PI)
    if (auto looped = reached(looped_strut(scene))) return *looped;
  throw NoEquilibrium("the buckled strut was not found at shortening " + std::to_string(goal) + ": " +
                      failure);
}

}  // namespace windlass::equilibrium
