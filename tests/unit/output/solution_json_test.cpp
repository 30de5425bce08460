#include "windlass/output/solution_json.hpp"

#include <boost/test/unit_test.hpp>

#include "unit/verify/closed_form_rods.hpp"

BOOST_AUTO_TEST_SUITE(solution_json)

using namespace windlass;

namespace {
std::vector<std::string> keys(const nlohmann::ordered_json& json) {
  std::vector<std::string> names;
  for (const auto& item : json.items()) names.push_back(item.key());
  return names;
}
}  // namespace

BOOST_AUTO_TEST_CASE(the_object_has_the_promised_keys) {
  auto scene = test::capstan_scene(1.0, 2 * std::numbers::pi);
  auto solution = test::planar_capstan(1.0, 2 * std::numbers::pi);
  solution.F0 = 0.3 * solution.R_tot;
  solution.stability = equilibrium::Stability{0, 0, {0.5}, 0.0, false, {}, {}};
  const auto json = output::to_json(solution, scene);
  const std::vector<std::string> expected = {"parameters",
                                             "model",
                                             "model_reason",
                                             "converged",
                                             "newton_iterations",
                                             "R_tot",
                                             "F0",
                                             "phi_star",
                                             "tilt",
                                             "z_span",
                                             "energy",
                                             "self_distance",
                                             "self_force",
                                             "contact",
                                             "stability",
                                             "invariants",
                                             "error_estimate",
                                             "tolerance_met",
                                             "mesh",
                                             "seconds"};
  BOOST_TEST(keys(json) == expected, boost::test_tools::per_element());
  BOOST_TEST(json["contact"]["arcs"].size() == 3u);
  BOOST_TEST(json["contact"]["arcs"][1]["kind"] == "line");
  BOOST_TEST(json["contact"]["joints"][1]["kind"] == "edge");
  BOOST_TEST(json["contact"]["arcs"][2]["s_end"].is_null());  // infinite
  BOOST_TEST(json["stability"]["eigenvalues"][0] == 0.5);
  // the parts add up to the whole
  double sum = 0.0;
  for (const auto& arc : json["contact"]["arcs"]) sum += arc["force"].get<double>();
  for (const auto& joint : json["contact"]["joints"]) sum += joint["force"].get<double>();
  BOOST_TEST(sum == json["R_tot"].get<double>(), boost::test_tools::tolerance(1e-14));
}

BOOST_AUTO_TEST_CASE(struts_have_end_force_instead_of_contact) {
  auto solution = test::planar_capstan(1.0, 2 * std::numbers::pi);
  solution.has_cylinder = false, solution.end_force = 40.0, solution.shortening = 0.1;
  const auto json = output::to_json(solution, {});
  for (const char* key : {"end_force", "end_moment", "shortening"}) BOOST_TEST(json.contains(key), key);
  for (const char* key : {"R_tot", "phi_star", "contact", "F0"}) BOOST_TEST(!json.contains(key), key);
}

BOOST_AUTO_TEST_CASE(physical_scenes_give_newtons_and_millimetres) {
  auto scene = test::capstan_scene(2.0, std::numbers::pi);
  const double rho = 8e-3, EI = 0.4e-3;  // the paper's rope
  scene.units.emplace();
  scene.units->length = rho, scene.units->force = EI / (rho * rho), scene.units->moment = EI / rho;
  scene.units->pressure = EI / (rho * rho * rho), scene.units->energy = EI / rho;
  auto solution = test::planar_capstan(2.0, std::numbers::pi);
  solution.z_span = 0.5;
  const auto physical = output::to_json(solution, scene)["physical"];
  BOOST_TEST(physical["tension"]["value"].get<double>() == 12.5, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(physical["tension"]["unit"] == "N");
  BOOST_TEST(physical["hung_mass"]["value"].get<double>() == 12.5 / 9.80665 * 1000,
             boost::test_tools::tolerance(1e-12));
  BOOST_TEST(physical["R_tot"]["value"].get<double>() == solution.R_tot * 6.25,
             boost::test_tools::tolerance(1e-12));
  BOOST_TEST(physical["z_span"]["value"].get<double>() == 4.0, boost::test_tools::tolerance(1e-12));
  // p = 1.5 EI/rho³ on the contact arc
  BOOST_TEST(physical["contact"]["arcs"][1]["largest_pressure"]["value"].get<double>() == 1.5 * 6.25 / 8.0,
             boost::test_tools::tolerance(1e-12));
}

BOOST_AUTO_TEST_CASE(what_is_not_finite_is_null) {
  auto solution = test::planar_capstan(1.0, 2 * std::numbers::pi);
  solution.R_tot = NAN, solution.error_estimate = HUGE_VAL;
  const std::string text = output::to_json(solution, test::capstan_scene(1.0, 1.0)).dump();
  BOOST_TEST(text.find("nan") == std::string::npos);
  BOOST_TEST(text.find("inf") == text.find("infinity"));  // the kind of a joint
}

BOOST_AUTO_TEST_SUITE_END()
