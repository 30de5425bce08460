#include "windlass/equilibrium/start.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <continuation/walker.hpp>
#include <optional>

#include "windlass/chain/ring.hpp"
#include "windlass/equilibrium/contact_events.hpp"
#include "windlass/rod/capstan.hpp"
#include "windlass/scene/error.hpp"

namespace windlass::equilibrium {

using chain::ArcMesh;
using chain::Stretch;
using contact::Loads;

namespace {

constexpr int start_stages = 6;

/// Is the state a solution of the unilateral problem: forces and gaps nonnegative? A force of zero (an event) passes.
/// A free loop that only grazes the cylinder carries no force at all and is no equilibrium in contact.
bool contacts_hold(RodProblem& problem, const Vector& x, const Vector& p) {
  for (const ContactEvent& event : contact_events(problem.profile(x, p), problem.topology())) {
    const double short_of = event.kind == ContactEvent::Kind::length ? least_length : 0.0;
    if (event.value < -1e-9 - short_of) return false;
  }
  constexpr double least_force = 1e-12;  // of R_tot, dimensionless
  return problem.target(problem.chain(), x, problem.loads(p)) > least_force;
}

ArcMesh mesh_for(Stretch stretch, const Loads& loads, double length) {
  if (stretch == Stretch::tail)
    return {chain::tail_mesh(loads.tension, length, 10, start_stages), start_stages};
  return {chain::uniform_mesh(std::max(4, static_cast<int>(std::ceil(length)))), start_stages};
}

/// Right-half topology and joint places given; the full chain is its mirror image.
struct Draft {
  std::vector<Stretch> right;
  bool mid_touch = false;
  std::vector<double> s;  ///< from the mid-point, right half
};

std::optional<Started> attempt(const scene::Scene& scene, bool spatial, bool half,
                               const std::vector<std::string>& keys, const Draft& draft,
                               const chain::Profile& profile) {
  const Loads loads = loads_of(scene);
  Topology topology{draft.right, {}, true, draft.mid_touch};
  std::vector<ArcMesh> meshes;
  for (std::size_t i = 0; i < draft.right.size(); ++i)
    meshes.push_back(mesh_for(draft.right[i], loads, draft.s[i + 1] - draft.s[i]));
  auto problem = std::make_shared<RodProblem>(scene, spatial, topology, meshes, keys);
  const Vector p = problem->parameters();
  Vector x = chain::guess_state(problem->chain(), topology, problem->rod(), profile, draft.s);
  try {
    const int iterations = problem->polish(x, p);
    if (iterations < 0 || !contacts_hold(*problem, x, p)) return std::nullopt;
    x = problem->refine(x, p);
    if (!half) return unfold(*problem, x, p, iterations);
    return Started{problem, x, p, iterations};
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

/// The draft the closed form suggests: a line contact where it can exist, else one touch at the mid-point.
Draft closed_form_draft(const Loads& loads, double b) {
  if (loads.tension > rod::capstan::line_limit(loads.angle) * b) {
    const double contact = 0.5 * loads.angle - std::acos(1.0 - 0.5 * b / loads.tension);
    return {{Stretch::line, Stretch::tail}, false, {0.0, contact, loads.half_length}};
  }
  return {{Stretch::tail}, true, {0.0, loads.half_length}};
}

/// The state of `scene`, followed from a half-chain state at another value of the one parameter on `from.p`.
std::optional<Started> follow(const Started& from, const scene::Scene& scene, double goal, bool half,
                              const std::vector<std::string>& keys, std::string& failure) {
  continuation::Options options;
  options.target = goal;
  options.direction = goal < from.p(0) ? -1 : 1;
  options.detect_branch_points = false;
  options.step = 0.02;
  options.step_max = 0.2;
  options.max_points = 3000;
  std::shared_ptr<continuation::Problem> last = from.problem;
  Vector x = from.x;
  int iterations = from.newton_iterations;
  if (from.p(0) != goal) {
    continuation::Walker walker(from.problem, from.x, from.p, options);
    double reached = from.p(0);
    while (const auto point = walker.step()) iterations += point->newton_iterations, reached = point->p(0);
    if (walker.end().kind == continuation::End::Kind::event)
      throw NoContact(
          fmt::format("no equilibrium in contact exists at {} = {:g}: followed from {:g}, the rod lifts off "
                      "the cylinder at {:.6g}",
                      from.problem->keys().front(), goal, from.p(0), reached));
    if (walker.end().kind != continuation::End::Kind::target) {
      failure = fmt::format("followed from {} = {:g}, the branch ends: {}", from.problem->keys().front(),
                            from.p(0), walker.end().reason);
      return std::nullopt;
    }
    last = walker.problem();
    x = walker.x();
  }
  const auto& reached = dynamic_cast<const RodProblem&>(*last);
  auto problem =
      std::make_shared<RodProblem>(scene, reached.spatial(), reached.topology(), reached.meshes(), keys);
  const Vector p = problem->parameters();
  if (problem->polish(x, p) < 0)
    return failure = "Newton did not converge at the end of the way", std::nullopt;
  x = problem->refine(x, p);
  if (!half) return unfold(*problem, x, p, iterations);
  return Started{problem, x, p, iterations};
}

/// Down from a tension where the line contact exists, through every event on the way.
std::optional<Started> by_continuation(const scene::Scene& scene, bool spatial, bool half,
                                       const std::vector<std::string>& keys, std::string& failure) {
  scene::Scene tight = scene;
  tight.load.tension = std::max({1.5 * rod::capstan::line_limit(scene.load.angle), 1.0, scene.load.tension});
  const std::vector<std::string> path{"load.tension"};
  std::optional<Started> from;
  for (int k = 0; k < 6 && !from; ++k, tight.load.tension *= 1.6) {
    Loads loads = loads_of(tight);
    if (scene.rod.infinite()) loads.half_length = 0.5 * loads.angle + 40.0 / std::sqrt(loads.tension);
    const double b = scene.rod.bending_stiffness;
    from = attempt(tight, spatial, true, path, closed_form_draft(loads, b),
                   chain::capstan_profile(loads.tension, loads.angle, loads.half_length, b));
  }
  if (!from) {
    failure = "no line contact was found at a higher tension either";
    return std::nullopt;
  }
  return follow(*from, scene, scene.load.tension, half, keys, failure);
}

/// A strut's half chain near a given shape; nullopt where Newton does not converge.
std::optional<Started> strut_near(const scene::Scene& scene, const chain::Profile& shape, double thrust,
                                  const std::vector<std::string>& keys) {
  constexpr int elements = 8;  // with order 12 the straight strut's buckling loads are exact to 1e-13
  const Topology topology{{Stretch::tail}, {}, true, false};
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
    return follow(*from, scene, goal, half, keys, failure);
  };
  if (auto bowed = reached(bowed_strut(scene))) return *bowed;
  if (std::abs(scene.ends.twist) > M_PI)
    if (auto looped = reached(looped_strut(scene))) return *looped;
  throw NoEquilibrium("the buckled strut was not found at shortening " + std::to_string(goal) + ": " +
                      failure);
}

}  // namespace

Started unfold(RodProblem& halved, const Vector& x, const Vector& p, int iterations) {
  // Through the recorded whole rod: sample the half, mirror it, and build the full chain on it.
  const chain::Profile half = halved.profile(x, p);
  const chain::Profile whole = chain::mirrored(half, halved.topology());
  Topology topology = halved.topology();
  topology.half = false;
  topology.left = topology.right;
  std::vector<ArcMesh> meshes = halved.meshes();
  for (auto& mesh : meshes) {
    std::vector<double> nodes;
    for (auto node = mesh.nodes.rbegin(); node != mesh.nodes.rend(); ++node) nodes.push_back(1.0 - *node);
    mesh.nodes = nodes;
  }
  std::reverse(meshes.begin(), meshes.end());
  meshes.insert(meshes.end(), halved.meshes().begin(), halved.meshes().end());
  auto problem =
      std::make_shared<RodProblem>(halved.scene_at(p), halved.spatial(), topology, meshes, halved.keys());
  std::vector<double> s;
  const Loads loads = halved.loads(p);
  for (int j = halved.chain().joint_count() - 1; j > 0; --j)
    s.push_back(-halved.chain().arclength(x, loads, j));
  for (int j = 0; j < halved.chain().joint_count(); ++j) s.push_back(halved.chain().arclength(x, loads, j));
  for (double& at : s)
    if (std::isinf(at)) at = at > 0.0 ? whole.end() : whole.begin();
  Vector y = chain::guess_state(problem->chain(), topology, problem->rod(), whole, s);
  const int used = problem->polish(y, p);
  if (used < 0) throw NoEquilibrium("Newton did not converge on the full chain from its symmetric half");
  problem->error_estimate(y, p);
  return {problem, y, p, iterations + used};
}

Started lift(RodProblem& planar, const Vector& x, const Vector& p, bool half) {
  const chain::Profile shape = planar.profile(x, p);
  std::vector<ArcMesh> meshes = planar.meshes();
  const std::vector<Stretch> kinds = chain::stretches(planar.topology());
  const Loads loads = planar.loads(p);
  std::vector<double> s;
  for (int j = 0; j < planar.chain().joint_count(); ++j) {
    const double at = planar.chain().arclength(x, loads, j);
    s.push_back(std::isinf(at) ? shape.end() : at);
  }
  for (std::size_t i = 0; i < kinds.size(); ++i)
    if (kinds[i] == Stretch::line) meshes[i] = mesh_for(Stretch::line, loads, s[i + 1] - s[i]);
  auto problem =
      std::make_shared<RodProblem>(planar.scene_at(p), true, planar.topology(), meshes, planar.keys());
  Vector y = chain::guess_state(problem->chain(), planar.topology(), problem->rod(), shape, s);
  const int used = problem->polish(y, p);
  if (used < 0) throw NoEquilibrium("Newton did not converge on the Kirchhoff rod from the planar state");
  y = problem->refine(y, p);
  if (!half) return unfold(*problem, y, p, used);
  return {problem, y, p, used};
}

Started cold_start(const scene::Scene& scene, bool spatial, bool half, const std::vector<std::string>& keys) {
  if (!scene.has_cylinder)
    return scene.ends.shortening ? buckled_strut(scene, half, keys) : straight_strut(scene, half, keys);
  Loads loads = loads_of(scene);
  const double b = scene.rod.bending_stiffness;
  if (scene.rod.infinite()) loads.half_length = 0.5 * loads.angle + 40.0 / std::sqrt(loads.tension);
  const Draft draft = closed_form_draft(loads, b);
  if (draft.s.size() == 3 && draft.s[1] >= loads.half_length)
    throw scene::SceneError("rod.length = " + std::to_string(2.0 * loads.half_length) +
                            ": the rod is shorter than its contact arc, which needs more than " +
                            std::to_string(2.0 * draft.s[1]));
  const chain::Profile profile = chain::capstan_profile(loads.tension, loads.angle, loads.half_length, b);
  if (auto direct = attempt(scene, spatial, half, keys, draft, profile)) return *direct;
  std::string failure;
  if (auto reached = by_continuation(scene, spatial, half, keys, failure)) return *reached;
  throw NoEquilibrium("no equilibrium in contact was found at T = " + std::to_string(scene.load.tension) +
                      ", phi = " + std::to_string(scene.load.angle) + ": " + failure);
}

}  // namespace windlass::equilibrium
