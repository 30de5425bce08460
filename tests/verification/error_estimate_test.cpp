// The error estimate against the change under refinement: at least as large, and not more than ten times.
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "support/coil_scene.hpp"
#include "windlass/equilibrium/search.hpp"

namespace {

using namespace windlass;
using equilibrium::RodProblem;
using equilibrium::Started;

scene::Scene strut(double shortening, double twist) {
  scene::Scene scene;
  scene.name = "strut";
  scene.rod.length = 1.0;
  scene.ends.kind = scene::EndKind::clamped;
  scene.ends.shortening = shortening;
  scene.ends.twist = twist;
  return scene;
}

/// A mesh with every element halved.
std::vector<chain::ArcMesh> halved(const std::vector<chain::ArcMesh>& meshes) {
  std::vector<chain::ArcMesh> out = meshes;
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    out[i].nodes.clear();
    const auto& old = meshes[i].nodes;
    for (std::size_t k = 0; k + 1 < old.size(); ++k)
      out[i].nodes.insert(out[i].nodes.end(), {old[k], 0.5 * (old[k] + old[k + 1])});
    out[i].nodes.push_back(old.back());
  }
  return out;
}

/// The same equilibrium on coarse meshes of `stages` stages, its estimate against the change when elements are halved
/// twice.
void check(Started start, int stages, const char* what) {
  if (const auto meshed = equilibrium::with_meshed_tails(*start.problem, start.x, start.p)) start = *meshed;
  std::vector<chain::ArcMesh> meshes = start.problem->meshes();
  for (auto& mesh : meshes) mesh.stages = stages;
  const auto at = [&](const std::vector<chain::ArcMesh>& on, double* estimate) {
    RodProblem problem(start.problem->scene_at(start.p), start.problem->spatial(), start.problem->topology(),
                       on, start.problem->keys());
    Eigen::VectorXd x = chain::transfer_state(start.problem->chain(), problem.chain(), start.x,
                                              start.problem->loads(start.p));
    BOOST_TEST_REQUIRE(problem.polish(x, start.p) >= 0);
    if (estimate) *estimate = problem.error_estimate(x, start.p);
    return problem.target(problem.chain(), x, problem.loads(start.p));
  };
  double estimate = 0.0;
  const double coarse = at(meshes, &estimate), fine = at(halved(halved(meshes)), nullptr);
  const double change = std::abs(coarse / fine - 1.0);
  BOOST_TEST_CONTEXT(what << ", stages " << stages << ": estimate " << estimate << ", change " << change) {
    BOOST_TEST(change > 1e-12);  // or the sample says nothing
    BOOST_TEST(estimate >= change);
    BOOST_TEST(estimate <= 10.0 * change);
  }
}

}  // namespace

BOOST_AUTO_TEST_SUITE(error_estimate)

BOOST_AUTO_TEST_CASE(it_bounds_the_change_under_refinement_within_a_factor_of_ten) {
  const std::vector<std::string> tension{"load.tension"}, shortening{"ends.shortening"};
  for (const int stages : {3, 4}) {
    check(equilibrium::cold_start(test::coil_scene(1.5), false, true, tension), stages, "planar");
    check(equilibrium::cold_start(test::coil_scene(0.4), false, true, tension), stages,
          "planar, two touches");
    check(equilibrium::cold_start(test::coil_scene(1.5, scene::EndKind::clamped), true, true, tension),
          stages, "flat, clamped");
    check(equilibrium::cold_start(strut(0.3, 0.0), true, true, shortening), stages, "strut");
    check(equilibrium::cold_start(strut(0.3, M_PI), true, true, shortening), stages, "twisted strut");
    const auto found = equilibrium::search(test::coil_scene(0.9), true, true, tension);
    BOOST_TEST_REQUIRE(found.stable() != nullptr);
    check(found.stable()->at, stages, "helix");
  }
}

BOOST_AUTO_TEST_SUITE_END()
