#include "windlass/equilibrium/start.hpp"

#include <algorithm>
#include <cmath>
#include <continuation/walker.hpp>
#include <optional>

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
  continuation::Options options;
  options.target = scene.load.tension;
  options.direction = scene.load.tension < from->p(0) ? -1 : 1;
  options.detect_branch_points = false;
  options.step = 0.02;
  options.step_max = 0.2;
  options.max_points = 3000;
  continuation::Walker walker(from->problem, from->x, from->p, options);
  int iterations = 0;
  while (const auto point = walker.step()) iterations += point->newton_iterations;
  if (walker.end().kind != continuation::End::Kind::target) {
    failure = "followed from T = " + std::to_string(from->p(0)) + ", the branch ends: " + walker.end().reason;
    return std::nullopt;
  }
  const auto& reached = dynamic_cast<const RodProblem&>(*walker.problem());
  auto problem = std::make_shared<RodProblem>(scene, spatial, reached.topology(), reached.meshes(), keys);
  Vector x = walker.x();
  const Vector p = problem->parameters();
  if (problem->polish(x, p) < 0) return std::nullopt;
  x = problem->refine(x, p);
  if (!half) return unfold(*problem, x, p, iterations);
  return Started{problem, x, p, iterations};
}

Started start_strut(const scene::Scene& scene, bool half, const std::vector<std::string>& keys) {
  // A shortened strut is buckled: reached from a slight bow, where the amplitude follows from the shortening.
  const Loads loads = loads_of(scene);
  const double goal = loads.shortening;
  scene::Scene near = scene;
  std::shared_ptr<RodProblem> problem;
  Vector x, p;
  int iterations = 0;
  const Topology topology{{Stretch::tail}, {}, true, false};
  if (scene.ends.shortening && !(goal > 0.0))
    throw scene::SceneError(
        "ends.shortening = 0: a straight inextensible strut carries any thrust up to buckling; give "
        "load.thrust, or a shortening above 0");
  // From a moderate bow up in steps, or down by factors: the amplitude goes like the square root.
  constexpr double first = 0.02;
  for (double at = scene.ends.shortening ? first : goal;;
       at = goal > at ? std::min(goal, at + 0.05) : std::max(goal, at / 3.0)) {
    if (scene.ends.shortening) near.ends.shortening = at;
    const Loads here = loads_of(near);
    const std::vector<ArcMesh> meshes =
        problem ? problem->meshes() : std::vector<ArcMesh>{{chain::uniform_mesh(6), start_stages}};
    auto next = std::make_shared<RodProblem>(near, true, topology, meshes, keys);
    p = next->parameters();
    if (!problem) {
      const chain::Profile bow = chain::strut_profile(here, 2.0 * std::sqrt(at));
      x = chain::guess_state(next->chain(), topology, next->rod(), bow, {0.0, here.half_length});
      const double critical = 4.0 * M_PI * M_PI / (4.0 * here.half_length * here.half_length);
      next->chain().force(x, 0)[0] =
          scene.ends.shortening ? -critical * scene.rod.bending_stiffness : -here.thrust;
    }
    const int used = next->polish(x, p);
    if (used < 0)
      throw NoEquilibrium("Newton did not converge for the strut at shortening " + std::to_string(at));
    iterations += used;
    problem = next;
    if (at == goal) break;
  }
  x = problem->refine(x, p);
  if (!half) return unfold(*problem, x, p, iterations);
  return {problem, x, p, iterations};
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
  if (!scene.has_cylinder) return start_strut(scene, half, keys);
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
