// The study of work against precision: its reference, the order of its methods, and what it concludes.
#include "windlass/precision/study.hpp"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <string>

#include "support/petsc_session.hpp"
#include "windlass/rod/capstan.hpp"
#include "windlass/scene/error.hpp"

using namespace windlass;
using precision::Measurement;
using precision::Study;

namespace {

scene::Scene capstan_scene(double tension) {
  scene::Scene scene;
  scene.name = "capstan";
  scene.has_cylinder = true;
  scene.load.tension = tension;
  scene.load.angle = 2.0 * M_PI;
  scene.rod.length = 30.0;
  return scene;
}

Study quick_study(double tension) {
  precision::StudyOptions options;
  options.repeats = 1;
  options.quick = true;
  return precision::study(capstan_scene(tension), options);
}

/// Measurements of one method, coarsest first.
std::vector<Measurement> of(const Study& study, const std::string& method) {
  std::vector<Measurement> out;
  for (const Measurement& m : study.measurements)
    if (m.method == method) out.push_back(m);
  return out;
}

}  // namespace

BOOST_FIXTURE_TEST_SUITE(work_and_precision, test::PetscSession)

BOOST_AUTO_TEST_CASE(a_flat_coil_is_measured_by_every_method) {
  const Study study = quick_study(2.0);
  BOOST_TEST(study.failures.empty());
  // Tails of 12: the closed form of infinite ones is exact to exp(−2√2·12) = 2e-15.
  namespace capstan = rod::capstan;
  BOOST_TEST(std::abs(study.reference.R_tot / capstan::total_force(2.0, 2.0 * M_PI) - 1.0) < 1e-13);
  BOOST_TEST(std::abs(study.reference.phi_star / capstan::phi_star(2.0, 2.0 * M_PI) - 1.0) < 1e-13);
  BOOST_REQUIRE(study.reference.transition.has_value());
  // Half and full chain on adapted meshes agree on these digits at tolerance 1e-12.
  BOOST_TEST(std::abs(*study.reference.transition - 1.28593684163) < 2e-11);
  for (const char* method : {"planar arcs", "Kirchhoff arcs, half", "Kirchhoff arcs, full",
                             "nodal complementarity", "discrete elastic rod"}) {
    BOOST_TEST_CONTEXT(method) {
      const auto rungs = of(study, method);
      BOOST_REQUIRE(rungs.size() == 2u);
      BOOST_TEST(rungs[1].unknowns > rungs[0].unknowns);
      BOOST_TEST(rungs[1].error.R_tot < 0.01);
      BOOST_TEST(rungs[1].error.energy < 0.01);
      BOOST_TEST(rungs[1].seconds > 0.0);
    }
  }
  // Four stages, elements by three: order 8 is 3^-8 = 1.5e-4; 1e-2 is far above and far below what low orders give.
  for (const char* method : {"planar arcs", "Kirchhoff arcs, half", "Kirchhoff arcs, full"}) {
    const auto rungs = of(study, method);
    BOOST_TEST(rungs[1].error.R_tot < 1e-2 * rungs[0].error.R_tot);
    BOOST_TEST(rungs[1].error.R_tot < 1e-7);
  }
  for (const char* method : {"Kirchhoff arcs, half", "Kirchhoff arcs, full"})
    BOOST_TEST(of(study, method)[1].error.transition.value() < 1e-7);
}

BOOST_AUTO_TEST_CASE(a_helix_is_measured_by_the_methods_in_space) {
  const Study study = quick_study(1.0);
  BOOST_TEST(study.state.find("helical") != std::string::npos);
  BOOST_TEST(of(study, "planar arcs").empty());
  BOOST_TEST(of(study, "Kirchhoff arcs, half").size() == 2u);
  for (const Measurement& m : of(study, "Kirchhoff arcs, full")) BOOST_TEST(m.error.R_tot < 1e-3);
}

BOOST_AUTO_TEST_CASE(the_cheapest_method_is_named_for_each_error) {
  Study study;
  study.measurements = {{"slow and exact", 10, 0, 100, 1.0, {}, {1e-10, 0.0, 0.0, {}}},
                        {"fast and coarse", 5, 4, 10, 1e-3, {}, {1e-4, 0.0, 0.0, {}}}};
  const auto sentences = precision::conclusions(study);
  BOOST_REQUIRE(sentences.size() == 3u);
  BOOST_TEST(sentences[0].find("fast and coarse, 4 stages on 5 elements (1 ms)") != std::string::npos);
  BOOST_TEST(sentences[1].find("slow and exact") != std::string::npos);
  BOOST_TEST(sentences[2].find("slow and exact") != std::string::npos);
  study.measurements.pop_back();
  study.measurements[0].error.R_tot = 1e-2;
  BOOST_TEST(precision::conclusions(study)[0].find("no method") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(the_table_has_a_row_a_measurement) {
  Study study;
  study.measurements = {{"Kirchhoff arcs, half", 4, 6, 50, 0.5, {1.0, 2.0, 3.0, {}}, {0.1, 0.2, 0.3, {}}}};
  const std::string table = precision::to_csv(study);
  BOOST_TEST(table.substr(table.find('\n') + 1) ==
             "\"Kirchhoff arcs, half\",4,6,50,0.5,1,2,3,,0.1,0.2,0.3,\n");
}

BOOST_AUTO_TEST_CASE(a_scene_without_cylinder_is_refused) {
  scene::Scene strut;
  strut.has_cylinder = false;
  BOOST_CHECK_THROW(precision::study(strut, {}), InputError);
}

BOOST_AUTO_TEST_SUITE_END()
