#include "dragged_start.hpp"

#include <fmt/format.h>

#include "attempt.hpp"
#include "windlass/rod/quaternion.hpp"

namespace windlass::equilibrium {

using chain::ArcMesh;
using chain::Piece;
using chain::Stretch;

namespace {

constexpr int plate = 1;  // its place among the obstacles

/// Where a tail that rises to its end slopes no more than this: the plate's force bends it flat about there.
std::optional<double> levels_off(const Piece& tail, bool leftward, double slope) {
  const Eigen::Index last = tail.s.size() - 1;
  for (Eigen::Index k = 1; k < last; ++k) {
    const Eigen::Index at = leftward ? last - k : k;
    if (std::abs(tail.inclination(at)) < slope) return tail.s(at);
  }
  return std::nullopt;
}

double height_of_end(const Piece& tail, bool leftward) {
  return tail.r(2, leftward ? 0 : tail.s.size() - 1);
}

}  // namespace

std::optional<Started> under_the_plate(const Started& still, const scene::Scene& scene, double friction,
                                       std::string& failure) {
  chain::Profile shape = still.problem->profile(still.x, still.p);
  std::vector<double> s = still.problem->joint_places(still.x, still.p, shape);
  Topology topology = still.problem->topology();
  std::vector<ArcMesh> meshes = still.problem->meshes();
  if (topology.on.empty()) topology.on.resize(topology.stretches.size() + 1);
  double top = -HUGE_VAL;
  for (const Piece& piece : shape.pieces) top = std::max(top, piece.r.row(2).maxCoeff());
  // The plate's force is mu R_tot or so, and turns the end of the tail by that over the pull.
  const double drag = friction * still.problem->target(still.problem->chain(), still.x,
                                                       still.problem->loads(still.p));
  const double slope = drag / scene.load.tension;
  double height = top;
  bool touched = false;
  for (const bool leftward : {false, true}) {
    const Piece& tail = leftward ? shape.pieces.front() : shape.pieces.back();
    constexpr double as_high = 1e-6;
    if (height_of_end(tail, leftward) < top - as_high) continue;
    const std::optional<double> at = levels_off(tail, leftward, slope);
    if (!at) return failure = "the tail that is highest is shorter than where the plate would hold it", std::nullopt;
    const int link = leftward ? 0 : static_cast<int>(topology.stretches.size()) - 1;
    topology.stretches.insert(topology.stretches.begin() + link, topology.stretches[link]);
    topology.stretches[leftward ? 1 : link] = Stretch::gap;
    topology.on.insert(topology.on.begin() + link + 1, chain::Seat{plate});
    s.insert(s.begin() + link + 1, *at);
    meshes.insert(meshes.begin() + link, meshes[link]);
    height = shape.at(*at).r(2);
    touched = true;
  }
  if (!touched) return failure = "no tail rises to the highest place", std::nullopt;
  for (Piece& piece : shape.pieces) piece.r.row(2).array() += scene.plate->height - height;
  const chain::RodKind rod = rod_of(scene, true);
  choose_tails(meshes, topology, rod, loads_of(scene), s);
  const auto problem = std::make_shared<RodProblem>(scene, true, topology, meshes,
                                                    std::vector<std::string>{"cylinder.friction"});
  Vector x = chain::guess_state(problem->chain(), topology, problem->rod(), shape, s);
  const Vector p = Vector::Constant(1, friction);
  const int used = problem->polish(x, p);
  if (used < 0) return failure = "Newton did not converge under the plate", std::nullopt;
  return Started{problem, problem->refine(x, p), p, used};
}

}  // namespace windlass::equilibrium
