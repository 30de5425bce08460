#include <algorithm>
#include <cmath>

#include "attempt.hpp"
#include "windlass/chain/ring.hpp"
#include "windlass/obstacle/scene_obstacles.hpp"

namespace windlass::equilibrium {

using chain::ArcMesh;
using chain::Stretch;

std::optional<Started> strut_near(const scene::Scene& scene, const chain::Profile& shape, double thrust,
                                  const std::vector<std::string>& keys) {
  // With order 12 and elements that turn by less than a radian the straight strut's buckling loads and the moment of
  // any number of turns are exact to 1e-13.
  const int elements = std::max(8, static_cast<int>(std::ceil(0.5 * std::abs(scene.ends.twist))));
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

namespace {

/// A moderate shortening at which the bow touches nothing. A shortening s bends a rod of length L by 2 L √s/π.
double free_bow(const scene::Scene& scene) {
  constexpr double moderate = 0.02, most = 0.5;  // of the room there is
  const obstacle::Set obstacles = obstacle::obstacles_of(scene);
  double room = HUGE_VAL;
  for (int o = 0; o < obstacles.size(); ++o) room = std::min(room, obstacles[o].gap(Eigen::Vector3d::Zero()));
  const double bow = 0.5 * M_PI * most * room / scene.rod.length;
  return std::min(moderate, bow * bow);
}

/// A slightly shortened strut: a moderate bow, whose amplitude follows from the shortening.
std::optional<Started> bowed_strut(const scene::Scene& scene) {
  const double goal = *scene.ends.shortening, moderate = free_bow(scene);
  const bool pinned =
      scene.ends.left_kind() != scene::EndKind::clamped && scene.ends.right_kind() != scene::EndKind::clamped;
  const double critical = (pinned ? 1.0 : 4.0) * M_PI * M_PI;  // B = L = 1
  scene::Scene near = scene;
  near.ends.shortening = moderate;
  contact::Loads loads = loads_of(near);
  if (pinned) loads.half_length *= 2.0;  // half a wave between pins, a whole one between clamps
  chain::Profile bow = chain::strut_profile(loads, 2.0 * std::sqrt(moderate));
  if (pinned) {
    chain::Piece& shape = bow.pieces.front();
    shape.r.row(1).array() -= bow.at(0.5 * loads.half_length).r(1);
  }
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

/// At a given shortening: the untwisted strut, followed from the bowed one, then twisted. Rods may pass through
/// themselves, so that a twist of two turns more or less has the same states; the one that is asked for is that of this
/// twist, reached by turning the ends.
Started buckled_strut(const scene::Scene& scene, bool half, const std::vector<std::string>& keys) {
  const double goal = *scene.ends.shortening;
  if (scene.rod.compliance() != 0.0) return stretched_strut(scene, half, keys);
  if (!(goal >
        0.0)) {  // straight: an inextensible rod carries any thrust up to buckling, and none is what it needs
    scene::Scene straight = scene;
    straight.ends.shortening.reset();
    straight.load.thrust = 0.0;
    return straight_strut(straight, half, keys);
  }
  scene::Scene untwisted = scene;
  untwisted.ends.twist = 0.0;
  std::string failure = "Newton did not converge near the straight one";
  // Ends that meet carry the ring, whose twist has gone into its loop; the figure of eight is another state.
  if (goal == 1.0 && scene.ends.twist != 0.0 && !scene.has_obstacles())
    if (auto ring = looped_strut(scene)) {
      ring->x = ring->problem->refine(ring->x, ring->p);
      if (const auto found = reach(*ring, scene, goal, half, keys, failure)) return *found;
    }
  if (auto from = bowed_strut(untwisted)) {
    from->x = from->problem->refine(from->x, from->p);
    if (!scene.obstacles_keep_half_turn())
      from = unfold(*from->problem, from->x, from->p, from->newton_iterations);
    const bool turns = scene.ends.twist != 0.0;
    const std::vector<std::string> by_twist{"ends.twist"};
    auto found = reach(*from, untwisted, goal, turns || half, turns ? by_twist : keys, failure);
    if (found && turns) found = reach(*found, scene, scene.ends.twist, half, keys, failure);
    if (found) return *found;
  }
  throw NoEquilibrium("the buckled strut was not found at shortening " + std::to_string(goal) + ", twist " +
                      std::to_string(scene.ends.twist) + ": " + failure);
}

}  // namespace windlass::equilibrium
