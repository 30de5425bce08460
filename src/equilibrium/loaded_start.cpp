// Ways to the states of rods that stretch and of struts that weigh, from those that do neither.
#include <algorithm>
#include <cmath>

#include "attempt.hpp"
#include "windlass/equilibrium/equilibria.hpp"
#include "windlass/rod/quaternion.hpp"
#include "windlass/scene/keys.hpp"

namespace windlass::equilibrium {

scene::Scene inextensible(scene::Scene scene) {
  scene.rod.axial_stiffness = HUGE_VAL;
  return scene;
}

namespace {

/// The straight strut, shortened by its compression alone.
std::optional<Started> compressed(const scene::Scene& scene, const std::vector<std::string>& keys) {
  const double thrust = *scene.ends.shortening / scene.rod.compliance();
  return strut_near(scene, chain::strut_profile(loads_of(scene), 0.0), thrust, keys);
}

/// The whole rod turned about e_x, every section back about its tangent: what an isotropic strut may do at no cost.
chain::Profile turned(chain::Profile shape, double angle) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitX()).toRotationMatrix();
  const Eigen::Vector4d by = rod::rotation(Eigen::Vector3d::UnitX(), angle),
                        back = rod::rotation(Eigen::Vector3d::UnitZ(), -angle);
  for (chain::Piece& piece : shape.pieces) {
    piece.r = turn * piece.r;
    piece.n = turn * piece.n;
    piece.m = turn * piece.m;
    for (Eigen::Index k = 0; k < piece.s.size(); ++k)
      piece.q.col(k) = rod::product(by, rod::product(piece.q.col(k), back));
  }
  return shape;
}

/// Angle by which a bow must turn about e_x to hang in the direction of the weight, or half a turn where the rod is free to make
/// no other.
double turn_to_hang(const chain::Profile& shape, const contact::Loads& loads, bool isotropic) {
  const Eigen::Vector3d middle = shape.at(0.5 * (shape.begin() + shape.end())).r;
  constexpr double straight = 1e-9;
  if (std::hypot(loads.weight_y, loads.weight_z) == 0.0 || middle.tail<2>().norm() < straight) return 0.0;
  const double turn = std::atan2(loads.weight_z, loads.weight_y) - std::atan2(middle(2), middle(1));
  return isotropic ? turn : M_PI * std::round(turn / M_PI);
}

}  // namespace

Started stretched_strut(const scene::Scene& scene, bool half, const std::vector<std::string>& keys) {
  std::string failure = "there is no bowed rod that does not stretch";
  if (*scene.ends.shortening > 0.0) {
    try {
      const Started rigid = buckled_strut(inextensible(scene), half, by_compliance);
      if (auto bowed = reach(rigid, scene, scene.rod.compliance(), half, keys, failure)) return *bowed;
    } catch (const NoEquilibrium& none) {
      failure = none.what();
    }
  }
  // Short of the shortening at which it buckles the rod stays straight.
  std::optional<Started> straight = compressed(scene, keys);
  if (!straight) throw NoEquilibrium("the strut that stretches was not found: " + failure);
  straight->problem->error_estimate(straight->x, straight->p);
  return half ? *straight : unfold(*straight->problem, straight->x, straight->p, straight->newton_iterations);
}

/// By continuation, one component of the weight after the other, from a thousandth of it: where it vanishes an isotropic strut
/// may bow in any plane.
Started weighted_strut(const scene::Scene& scene, bool half, const std::vector<std::string>& keys) {
  constexpr double slight = 1e-3;
  constexpr const char* components[] = {"rod.weight_x", "rod.weight_y", "rod.weight_z"};
  scene::Scene light = scene;
  light.rod.weight = {};
  const Started without = cold_start(light, true, half, {load_key(scene)});
  for (std::size_t k = 0; k < 3; ++k) light.rod.weight[k] = slight * scene.rod.weight[k];
  std::vector<std::string> ways;
  for (std::size_t k = 0; k < 3; ++k)
    if (scene.rod.weight[k] != 0.0) ways.emplace_back(components[k]);
  chain::Profile shape = without.problem->profile(without.x, without.p);
  const std::vector<double> s = without.problem->joint_places(without.x, without.p, shape);
  const chain::Profile whole =
      without.problem->topology().half ? chain::unfolded(shape, chain::Symmetry::half_turn) : shape;
  if (scene.rod.natural_curvature == 0.0 && scene.rod.natural_twist == 0.0)
    shape = turned(shape, turn_to_hang(whole, loads_of(light), scene.rod.isotropic_straight()));
  auto problem =
      std::make_shared<RodProblem>(light, true, without.problem->topology(), without.problem->meshes(),
                                   std::vector<std::string>{ways.front()});
  Started at{problem, chain::guess_state(problem->chain(), problem->topology(), problem->rod(), shape, s),
             problem->parameters(), without.newton_iterations};
  const int used = problem->polish(at.x, at.p);
  if (used < 0) throw NoEquilibrium("Newton did not converge for the strut with a thousandth of its weight");
  std::string failure;
  for (std::size_t k = 0; k < ways.size(); ++k) {
    const double goal = scene::get_parameter(scene, ways[k]);
    scene::set_parameter(light, ways[k], goal);
    const bool last = k + 1 == ways.size();
    const std::vector<std::string> next = last ? keys : std::vector<std::string>{ways[k + 1]};
    const auto there = reach(at, light, goal, half, next, failure);
    if (!there) throw NoEquilibrium("the strut under its weight was not reached: " + failure);
    at = *there;
  }
  return at;
}

}  // namespace windlass::equilibrium
