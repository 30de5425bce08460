#include <algorithm>

#include "attempt.hpp"

namespace windlass::equilibrium {

using chain::ArcMesh;
using chain::Stretch;

namespace {

bool is_formula(const ArcMesh& mesh) { return mesh.stages == 0; }

/// A first mesh for the tail, fine where it leaves the contact: at its end if it runs to the left.
ArcMesh meshed_tail(const contact::Loads& loads, double length, bool leftward) {
  ArcMesh mesh = first_mesh(Stretch::tail, loads, length);
  if (!leftward) return mesh;
  std::reverse(mesh.nodes.begin(), mesh.nodes.end());
  for (double& node : mesh.nodes) node = 1.0 - node;
  return mesh;
}

}  // namespace

void choose_tails(std::vector<ArcMesh>& meshes, const Topology& topology, const chain::RodKind& rod,
                  const contact::Loads& loads, const std::vector<double>& s) {
  constexpr int gap_elements = 8;
  const std::vector<Stretch>& kinds = topology.stretches;
  const bool admitted = !rod.holds_an_end() && !rod.strut && !rod.infinite && rod.isotropic_straight() &&
                        !rod.stretches() && !rod.guided &&
                        rod.travel == chain::Travel::none;  // a formula knows no change of its pull
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    const bool leftward = i == 0 && !topology.half, tail = kinds[i] == Stretch::tail;
    const bool leaves_line = tail && kinds.size() > 1 && kinds[leftward ? 1 : i - 1] == Stretch::line;
    const bool touched = topology.end_touches(leftward ? 0 : static_cast<int>(kinds.size())) > 0;
    if (admitted && leaves_line && !touched)
      meshes[i] = {{0.0, 1.0}, 0};
    else if (is_formula(meshes[i]) && tail)
      meshes[i] = meshed_tail(loads, s[i + 1] - s[i], leftward);
    else if (is_formula(meshes[i]))
      meshes[i] = {chain::uniform_mesh(gap_elements), start_stages};
  }
}

std::optional<Started> with_meshed_tails(RodProblem& problem, const Vector& x, const Vector& p) {
  std::vector<ArcMesh> meshes = problem.meshes();
  const bool infinite = problem.rod().infinite;
  if (!infinite && std::none_of(meshes.begin(), meshes.end(), is_formula)) return std::nullopt;
  const chain::Profile shape = problem.profile(x, p);
  const std::vector<double> s = problem.joint_places(x, p, shape);
  for (std::size_t i = 0; i < meshes.size(); ++i)
    if (is_formula(meshes[i]) || (infinite && problem.topology().stretches[i] == Stretch::tail))
      meshes[i] = meshed_tail(problem.loads(p), s[i + 1] - s[i], i == 0 && !problem.topology().half);
  // An infinite tail ends where it is straight to rounding: a rod as long as that has its modes.
  scene::Scene scene = problem.scene_at(p);
  if (infinite) scene.rod.length = 2.0 * s.back();
  auto meshed =
      std::make_shared<RodProblem>(scene, problem.spatial(), problem.topology(), meshes, problem.keys());
  Vector y = chain::guess_state(meshed->chain(), problem.topology(), meshed->rod(), shape, s);
  const int used = meshed->polish(y, p);
  if (used < 0) throw NoEquilibrium("Newton did not converge with the tails on a mesh");
  return Started{meshed, y, p, used};
}

}  // namespace windlass::equilibrium
