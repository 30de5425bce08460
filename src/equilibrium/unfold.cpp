#include <algorithm>

#include "attempt.hpp"

namespace windlass::equilibrium {

using chain::ArcMesh;
using chain::Stretch;
using contact::Loads;

ArcMesh reversed(const ArcMesh& mesh) {
  ArcMesh out{{}, mesh.stages};
  for (auto node = mesh.nodes.rbegin(); node != mesh.nodes.rend(); ++node) out.nodes.push_back(1.0 - *node);
  return out;
}

ArcMesh spanning(const ArcMesh& right) {
  ArcMesh out{{}, right.stages};
  for (const double node : reversed(right).nodes) out.nodes.push_back(0.5 * node);
  for (std::size_t k = 1; k < right.nodes.size(); ++k) out.nodes.push_back(0.5 + 0.5 * right.nodes[k]);
  return out;
}

namespace {

/// Does the image of the half solve the full chain? Where a shape turns at no cost (a planar strut whose ends meet) the full
/// chain is singular and Newton's method cannot say so.
bool is_state(RodProblem& problem, const Vector& y, const Vector& p) {
  constexpr double rounding = 1e-10;  // of the residual; the half is solved to 1e-12 of its own
  return problem.residual_norm(problem.residual(y, p)) <= rounding;
}

}  // namespace

Started unfold(RodProblem& halved, const Vector& x, const Vector& p, int iterations) {
  // Through the recorded whole rod: sample the half, mirror it, and build the full chain on it.
  const chain::Profile half = halved.profile(x, p);
  const chain::Profile whole = chain::mirrored(half);
  const Topology topology = chain::unfolded(halved.topology());
  const bool spanned = !halved.topology().mid_touch;  // the first stretch spans both halves
  std::vector<ArcMesh> meshes;
  for (auto mesh = halved.meshes().rbegin(); mesh != halved.meshes().rend(); ++mesh)
    meshes.push_back(reversed(*mesh));
  std::size_t first = 0;
  if (spanned) {
    meshes.back() = spanning(halved.meshes().front());
    first = 1;
  }
  meshes.insert(meshes.end(), halved.meshes().begin() + static_cast<std::ptrdiff_t>(first),
                halved.meshes().end());
  auto problem =
      std::make_shared<RodProblem>(halved.scene_at(p), halved.spatial(), topology, meshes, halved.keys());
  const std::vector<double> right = halved.joint_places(x, p, half);
  std::vector<double> s;
  for (std::size_t j = right.size(); j-- > 1;) s.push_back(-right[j]);
  s.insert(s.end(), right.begin() + (spanned ? 1 : 0), right.end());
  Vector y = chain::guess_state(problem->chain(), topology, problem->rod(), whole, s);
  Vector polished = y;
  const int used = problem->polish(polished, p);
  if (used >= 0)
    y = polished;
  else if (!is_state(*problem, y, p))
    throw NoEquilibrium("Newton did not converge on the full chain from its symmetric half");
  problem->error_estimate(y, p);
  return {problem, y, p, iterations + std::max(used, 0)};
}

Started lift(RodProblem& planar, const Vector& x, const Vector& p, bool half) {
  const chain::Profile shape = planar.profile(x, p);
  std::vector<ArcMesh> meshes = planar.meshes();
  const std::vector<Stretch>& kinds = planar.topology().stretches;
  const Loads loads = planar.loads(p);
  const std::vector<double> s = planar.joint_places(x, p, shape);
  for (std::size_t i = 0; i < kinds.size(); ++i)
    if (kinds[i] == Stretch::line) meshes[i] = first_mesh(Stretch::line, loads, s[i + 1] - s[i]);
  auto problem =
      std::make_shared<RodProblem>(planar.scene_at(p), true, planar.topology(), meshes, planar.keys());
  Vector y = chain::guess_state(problem->chain(), planar.topology(), problem->rod(), shape, s);
  const int used = problem->polish(y, p);
  if (used < 0) throw NoEquilibrium("Newton did not converge on the Kirchhoff rod from the planar state");
  y = problem->refine(y, p);
  if (!half) return unfold(*problem, y, p, used);
  return {problem, y, p, used};
}

}  // namespace windlass::equilibrium
