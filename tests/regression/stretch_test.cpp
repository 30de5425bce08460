// Rods that stretch and struts that weigh, as a user has them computed; strengths fitted on dragged states.
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "support/csv.hpp"
#include "support/fit_of.hpp"
#include "support/run_program.hpp"
#include "windlass/rod/capstan.hpp"

using namespace windlass::test;

namespace {

std::vector<std::string> with(std::vector<std::string> command, const std::vector<std::string>& settings) {
  for (const std::string& setting : settings) command.insert(command.end(), {"--set", setting});
  return command;
}

nlohmann::json solved(const std::string& scene, const std::vector<std::string>& settings) {
  const TemporaryFolder folder;
  const Outcome outcome =
      run_program(with({"solve", shipped_scene(scene), "--json"}, settings), folder.path());
  BOOST_REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
  return nlohmann::json::parse(outcome.out);
}

}  // namespace

BOOST_AUTO_TEST_SUITE(stretch)

BOOST_AUTO_TEST_CASE(silicone_stretches_and_its_core_holds_it) {
  // EA ρ²/EI = 4 (ρ/r)² = 16 at R = r: the tails of 4.2 EI/ρ² stretch by T/EA, and nothing is stretched more.
  const nlohmann::json soft = solved("capstan-vps-vps", {}),
                       held = solved("capstan-vps-vps", {"rod.extensible=false"}),
                       core = solved("capstan-vps-inext", {});
  const double T = soft["parameters"]["T"];
  BOOST_TEST(soft["stretch"].get<double>() == T / 16.0, boost::test_tools::tolerance(1e-6));
  BOOST_TEST(held["R_tot"].get<double>() == core["R_tot"].get<double>());
  BOOST_TEST(!held.contains("stretch"));
  BOOST_TEST(soft["stability"]["index"] == 0);
  BOOST_TEST(std::abs(soft["R_tot"].get<double>() / core["R_tot"].get<double>() - 1.0) > 1e-3);
}

BOOST_AUTO_TEST_CASE(branches_of_silicone_pass_their_certificates) {
  const TemporaryFolder folder;
  const std::string run = (folder / "run").string();
  const Outcome branch =
      run_program(with({"diagram", shipped_scene("capstan-vps-pom"), "--out", run, "--quiet"},
                       {"continuation.from=300 g", "continuation.to=60 g"}),
                  folder.path());
  BOOST_REQUIRE_MESSAGE(branch.status == 0, branch.err);
  const Outcome verified = run_program({"verify", run}, folder.path());
  BOOST_TEST(verified.status == 0, verified.out);
}

BOOST_AUTO_TEST_CASE(a_branch_from_the_rod_that_does_not_stretch) {
  const TemporaryFolder folder;
  const std::string run = (folder / "run").string();
  const Outcome branch = run_program(
      with({"continue", shipped_scene("capstan-2pi"), "--out", run, "--quiet"},
           {"rod.extensible=true", "model.kind=planar", "rod.length=60",
            "continuation.parameter=rod.axial_compliance", "continuation.from=0", "continuation.to=0.1"}),
      folder.path());
  BOOST_REQUIRE_MESSAGE(branch.status == 0, branch.err);
  const nlohmann::json last = solved(
      "capstan-2pi", {"rod.extensible=true", "rod.axial_stiffness=10", "model.kind=planar", "rod.length=60"});
  // PHYSICS, "Planar capstan that stretches", T = 1.
  const double k = 0.1, tension = ((1.0 + k) / std::sqrt(1.0 + k) - 1.0) / k, beta = std::acos(tension);
  BOOST_TEST(last["R_tot"].get<double>() == 2.0 * (tension * (M_PI - beta) + std::sin(beta)),
             boost::test_tools::tolerance(1e-9));
  const Outcome verified = run_program({"verify", run}, folder.path());
  BOOST_TEST(verified.status == 0, verified.out);
}

BOOST_AUTO_TEST_CASE(what_cannot_be_is_refused_with_key_and_reason) {
  const auto refused = [](const std::string& scene, const std::vector<std::string>& settings,
                          const std::string& key, const std::string& reason) {
    const TemporaryFolder folder;
    const Outcome outcome = run_program(with({"solve", shipped_scene(scene)}, settings), folder.path());
    BOOST_TEST(outcome.status == 1);
    BOOST_TEST(contains(outcome.err, key), outcome.err);
    BOOST_TEST(contains(outcome.err, reason), outcome.err);
  };
  refused("capstan-2pi", {"rod.extensible=true", "rod.axial_stiffness=50", "rod.length=inf"},
          "rod.extensible = true", "must be false with rod.length = \"inf\"");
  // A one-handed state of a rod that runs along itself, with lines on the cylinder that friction would stretch: no bad input, but no
  // state either.
  const TemporaryFolder folder;
  const Outcome tilted = run_program(
      with({"continue", shipped_scene("capstan-2pi-plate"), "--out", "run", "--quiet"},
           {"rod.extensible=true", "rod.axial_stiffness=50", "cylinder.friction=0.005", "rod.length=14.3",
            "continuation.from=1.01", "continuation.to=1.1", "model.kind=kirchhoff", "ends.travel=free"}),
      folder.path());
  BOOST_TEST(tilted.status == 2, tilted.err);
  BOOST_TEST(contains(tilted.err, "rod.extensible"), tilted.err);
  const Outcome guided =
      run_program({"pull", shipped_scene("capstan-2pi-plate"), "--set", "ends.guide=slider"}, folder.path());
  BOOST_TEST(guided.status == 1);
  BOOST_TEST(contains(guided.err, "ends.guide"), guided.err);
  refused("capstan-2pi", {"ends.guide_offset=1.2"}, "ends.guide_offset = 1.2", "needs ends.guide");
  refused("capstan-2pi", {"ends.guide=slider", "rod.length=inf"}, "ends.guide", "rod.length = \"inf\"");
  refused("strut-clamped", {"ends.guide=slider"}, "ends.guide", "without [cylinder]");
  refused("clove-hitch", {"ends.guide=slider"}, "ends.guide", "for a knot");
  refused("capstan-2pi", {"ends.guide=rail", "rod.length=20"}, "ends.guide", "\"slider\"");
  refused("capstan-2pi", {"rod.weight=[0, 0, -1]"}, "rod.weight_z = -1",
          "nothing carries weight along its axis");
  refused("strut-thrust", {"rod.weight=[1, 0, 0]"}, "rod.weight_x = 1", "both ends are free");
}

BOOST_AUTO_TEST_CASE(silicone_is_dragged_in_newtons) {
  const nlohmann::json state = solved("capstan-vps-pom-plate", {});
  // PHYSICS, "Planar capstan that stretches": EA ρ²/EI = 4 (14 mm/4 mm)² = 49. Tails of 3 decay lengths and more: 1 %.
  const double T = state["parameters"]["T"], k = 1.0 / 49.0, stretch = (1.0 + k * T) / std::sqrt(1.0 + k),
               tension = (stretch - 1.0) / k, beta = std::acos(tension / T);
  const double R_tot = 2.0 * (tension * (M_PI - beta) + T * std::sin(beta));
  BOOST_TEST(state["R_tot"].get<double>() == R_tot, boost::test_tools::tolerance(0.01));
  BOOST_TEST(state["F0"].get<double>() == 0.32 * state["R_tot"].get<double>(),
             boost::test_tools::tolerance(1e-11));
  BOOST_TEST(state["plate"]["force"].get<double>() == state["F0"].get<double>(),
             boost::test_tools::tolerance(1e-11));
  BOOST_TEST(state["stretch"].get<double>() == k * T, boost::test_tools::tolerance(1e-3));
  BOOST_TEST(state["stability"]["index"] == 0);
  const double newtons = state["physical"]["scales"]["force"]["value"];
  BOOST_TEST(state["physical"]["F0"]["value"].get<double>() == newtons * state["F0"].get<double>(),
             boost::test_tools::tolerance(1e-12));
  const TemporaryFolder folder;
  for (const char* scene : {"capstan-vps-pom-plate", "capstan-vps-vps-plate"}) {
    const Outcome branch =
        run_program({"continue", shipped_scene(scene), "--out", scene, "--quiet"}, folder.path());
    BOOST_REQUIRE_MESSAGE(branch.status == 0, branch.err);
    const Outcome verified = run_program({"verify", scene}, folder.path());
    BOOST_TEST(verified.status == 0, verified.out);
  }
}

BOOST_AUTO_TEST_CASE(friction_is_fitted_on_dragged_states_that_stretch) {
  // The flat coil's F0 of the closed form, with the stretch: another coefficient than the run's is found, and one without the
  // stretch would be off by per cents.
  constexpr double mu = 0.2, k = 1.0 / 20.0;
  const TemporaryFolder folder;
  const Outcome branch = run_program(
      with({"continue", shipped_scene("capstan-2pi-plate"), "--out", "run", "--quiet"},
           {"rod.length=60", "continuation.to=1", "rod.extensible=true", "rod.axial_stiffness=20"}),
      folder.path());
  BOOST_REQUIRE_MESSAGE(branch.status == 0, branch.err);
  std::ostringstream data;
  data.precision(14);
  data << "T, F0\n";
  for (const double T : {1.5, 3.0, 8.0}) {
    const double tension = ((1.0 + k * T) / std::sqrt(1.0 + k) - 1.0) / k, beta = std::acos(tension / T);
    data << T << ", " << mu * 2.0 * (tension * (M_PI - beta) + T * std::sin(beta)) << "\n";
  }
  const auto fit = fit_of(folder, data.str());
  BOOST_TEST(fit["mu"].get<double>() == mu, boost::test_tools::tolerance(1e-7));
}

BOOST_AUTO_TEST_CASE(friction_is_fitted_on_dragged_states) {
  // The flat coil on its plate is dragged with mu R_tot of the closed form: another coefficient than the run's is found.
  constexpr double mu = 0.2;
  const TemporaryFolder folder;
  const Outcome branch =
      run_program(with({"continue", shipped_scene("capstan-2pi-plate"), "--out", "run", "--quiet"},
                       {"rod.length=60", "continuation.to=1"}),
                  folder.path());
  BOOST_REQUIRE_MESSAGE(branch.status == 0, branch.err);
  std::ostringstream data;
  data.precision(14);
  data << "T, F0\n";
  for (const double T : {1.5, 3.0, 8.0})
    data << T << ", " << mu * windlass::rod::capstan::total_force(T, 2.0 * M_PI) << "\n";
  const auto fit = fit_of(folder, data.str());
  BOOST_TEST(fit["mu"].get<double>() == mu, boost::test_tools::tolerance(1e-7));
}

BOOST_AUTO_TEST_CASE(the_fit_follows_the_shape_that_friction_gives_a_helix) {
  // Strengths of a helix dragged with one coefficient, fitted on its branch at another: R_tot of that branch would not do.
  const TemporaryFolder folder;
  const auto dragged = [&](const char* mu, const char* out) {
    const Outcome branch = run_program(
        with({"continue", shipped_scene("capstan-2pi-plate"), "--out", out, "--quiet"},
             {"rod.length=14.283185307179586", "model.kind=kirchhoff", std::string("cylinder.friction=") + mu,
              "continuation.from=1.01", "continuation.to=0.9"}),
        folder.path());
    BOOST_REQUIRE_MESSAGE(branch.status == 0, branch.err);
    return read_csv(folder.path() / out / "branches.csv");
  };
  dragged("0.005", "run");
  std::string data = "T, F0\n";
  double ratio = 0.0;  // F0/R_tot says mu, whatever the shape, where the rod does not run along itself
  for (const auto& row : dragged("0.009", "measured").rows) {
    if (row.at("type") != "regular") continue;
    data += row.at("T") + ", " + row.at("F0") + "\n";
    ratio = std::stod(row.at("F0")) / std::stod(row.at("R_tot"));
  }
  BOOST_TEST(ratio == 0.009, boost::test_tools::tolerance(1e-9));
  folder.write("data.csv", data);
  const Outcome outcome =
      run_program({"fit", "run", "--csv", "data.csv", "--json", "--format", "png"}, folder.path());
  BOOST_REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
  const auto fit = nlohmann::json::parse(outcome.out);
  BOOST_TEST(fit["mu"].get<double>() == 0.009, boost::test_tools::tolerance(1e-7));
  BOOST_TEST(fit["standard_error"].get<double>() < 1e-9);
}

BOOST_AUTO_TEST_SUITE_END()
