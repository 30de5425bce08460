#include <algorithm>

#include <cmath>

#include "attempt.hpp"
#include "windlass/rod/quaternion.hpp"

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

Started image_on_full_chain(RodProblem& halved, const Vector& x, const Vector& p) {
  // Through the recorded whole rod: sample the half, mirror it, and build the full chain on it.
  const chain::Profile half = halved.profile(x, p);
  const chain::Profile whole = chain::unfolded(half, halved.topology().symmetry);
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
  return {problem, chain::guess_state(problem->chain(), topology, problem->rod(), whole, s), p, 0};
}

Started unfold(RodProblem& halved, const Vector& x, const Vector& p, int iterations) {
  Started whole = image_on_full_chain(halved, x, p);
  Vector polished = whole.x;
  const int used = whole.problem->polish(polished, p);
  if (used >= 0)
    whole.x = polished;
  else if (!is_state(*whole.problem, whole.x, p))
    throw NoEquilibrium("Newton did not converge on the full chain from its symmetric half");
  whole.problem->error_estimate(whole.x, p);
  whole.newton_iterations = iterations + std::max(used, 0);
  return whole;
}

namespace {

/// Is the shape its own image, to within what meshes leave?
bool is_own_image(const chain::Profile& shape, chain::Symmetry symmetry) {
  constexpr double same = 1e-6;  // of the unit of length
  const Eigen::Vector3d image = contact::image(symmetry);
  for (const chain::Piece& piece : shape.pieces)
    for (Eigen::Index k = 0; k < piece.s.size(); k += piece.stride)
      if (!((shape.at(-piece.s(k)).r - image.cwiseProduct(piece.r.col(k))).norm() < same * shape.unit_length))
        return false;
  return true;
}

/// The middle of a rod that is its own image, exactly: what the symmetry holds is not solved for.
contact::Place on_the_symmetry(contact::Place middle, chain::Symmetry symmetry) {
  const Eigen::Vector3d image = contact::image(symmetry);
  const Eigen::Vector3d t = rod::directors(middle.q).col(2);
  middle.r = 0.5 * (middle.r + image.cwiseProduct(middle.r));
  middle.q = rod::product(rod::turn_between(t, (t - image.cwiseProduct(t)).normalized()), middle.q);
  middle.angle = M_PI * std::round(middle.angle / M_PI);
  return middle;
}

/// What of a mesh is behind its middle, as a mesh of its own.
ArcMesh second_half(const ArcMesh& whole) {
  ArcMesh out{{0.0}, whole.stages};
  for (const double node : whole.nodes)
    if (node > 0.5) out.nodes.push_back(2.0 * node - 1.0);
  return out;
}

}  // namespace

std::optional<Started> fold(RodProblem& whole, const Vector& x, const Vector& p, chain::Symmetry symmetry) {
  const chain::Profile shape = whole.profile(x, p);
  const std::vector<double> all = whole.joint_places(x, p, shape);
  const std::vector<Stretch>& kinds = whole.topology().stretches;
  if (!std::equal(kinds.begin(), kinds.end(), kinds.rbegin()) || !is_own_image(shape, symmetry))
    return std::nullopt;
  const Topology topology = chain::folded(whole.topology(), symmetry);
  if (chain::unfolded(topology) != whole.topology()) return std::nullopt;
  const auto first = static_cast<std::ptrdiff_t>(kinds.size() / 2);
  std::vector<ArcMesh> meshes(whole.meshes().begin() + first, whole.meshes().end());
  std::vector<double> s(all.begin() + first, all.end());
  s.front() = 0.0;
  if (!topology.mid_touch && meshes.front().stages > 0) meshes.front() = second_half(meshes.front());
  const auto problem =
      std::make_shared<RodProblem>(whole.scene_at(p), whole.spatial(), topology, meshes, whole.keys());
  Vector y = chain::guess_state(problem->chain(), topology, problem->rod(), shape, s);
  problem->chain().joint(0).adopt(on_the_symmetry(shape.at(0.0), symmetry),
                                  problem->chain().coordinates(y, 0));
  const int used = problem->polish(y, p);
  if (used < 0) return std::nullopt;
  return Started{problem, problem->refine(y, p), p, used};
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
