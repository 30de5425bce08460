#include "knot_on_plate.hpp"

#include <algorithm>
#include <cmath>

#include "attempt.hpp"
#include "strip.hpp"

namespace windlass::equilibrium {

using chain::Piece;

namespace {

constexpr int plate = 1;  // its place among the obstacles

/// Place of the highest section of a rod, and its height.
struct Highest {
  int link = 0;
  double s = 0.0, z = -HUGE_VAL;
};

Highest highest_of(const chain::Profile& shape) {
  Highest out;
  for (int i = 0; i < static_cast<int>(shape.pieces.size()); ++i) {
    const Piece& piece = shape.pieces[i];
    for (Eigen::Index k = 0; k < piece.s.size(); ++k)
      if (piece.r(2, k) > out.z) out = {i, piece.s(k), piece.r(2, k)};
  }
  return out;
}

}  // namespace

std::optional<Started> knot_under_plate(const Started& still, const scene::Scene& scene, double friction,
                                        std::string& failure) {
  chain::Profile shape = still.problem->profile(still.x, still.p);
  Strip strip(still.problem->topology(), still.problem->joint_places(still.x, still.p, shape));
  const Highest top = highest_of(shape);
  chain::Seat seat{plate};
  if (strip.is_line(top.link)) seat = {.obstacle = 0, .stop = plate};
  strip.cut(top.link, top.s, seat);
  const Successor next = strip.successor();
  std::vector<chain::ArcMesh> meshes;
  for (const int source : next.source) meshes.push_back(still.problem->meshes()[source]);
  for (Piece& piece : shape.pieces) piece.r.row(2).array() += scene.plate->height - top.z;
  choose_tails(meshes, next.topology, rod_of(scene, true), loads_of(scene), next.s);
  const auto problem = std::make_shared<RodProblem>(scene, true, next.topology, meshes,
                                                    std::vector<std::string>{"cylinder.friction"});
  const Vector p = Vector::Constant(1, friction);
  Vector x = chain::guess_state(problem->chain(), next.topology, problem->rod(), shape, next.s);
  const int used = problem->polish(x, p);
  if (used < 0)
    return failure = "Newton did not converge on the contacts " + next.topology.text(), std::nullopt;
  return Started{problem, problem->refine(x, p), p, still.newton_iterations + used};
}

}  // namespace windlass::equilibrium
