// One equilibrium, as a user asks for it.
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "regression/coil_run.hpp"
#include "windlass/rod/capstan.hpp"

using namespace windlass::test;
namespace capstan = windlass::rod::capstan;
namespace fs = std::filesystem;

namespace {

nlohmann::json answer(const std::string& tension, const Words& more) {
  const Outcome outcome =
      run_program(Words{"solve", coil(), "--set", "load.tension=" + tension, "--json"} + more);
  BOOST_REQUIRE_MESSAGE(outcome.status == 0, tension << ": " << outcome.err);
  return nlohmann::json::parse(outcome.out);
}

}  // namespace

BOOST_AUTO_TEST_SUITE(solve)

BOOST_AUTO_TEST_CASE(solve_prints_what_the_contract_names) {
  const TemporaryFolder folder;
  const Outcome outcome = run_program(planar("solve", {"--set", "load.tension=1", "--json"}), folder.path());
  BOOST_REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
  const auto json = nlohmann::json::parse(outcome.out);
  for (const char* key :
       {"parameters", "model", "model_reason", "converged", "newton_iterations", "R_tot", "phi_star", "tilt",
        "z_span", "energy", "contact", "stability", "invariants", "error_estimate", "mesh", "seconds"})
    BOOST_TEST(json.contains(key), key);
  BOOST_TEST(!json.contains("F0"));  // the scene has no friction
  BOOST_TEST(json["parameters"]["T"] == 1.0);
  BOOST_TEST(json["parameters"]["phi"].get<double>() == full_turn);
  BOOST_TEST(json["model"] == "planar");
  BOOST_TEST(json["converged"].get<bool>());
  BOOST_TEST(relative(json["R_tot"], capstan::total_force(1.0, full_turn)) < 1e-8);
  BOOST_TEST(relative(json["phi_star"], capstan::phi_star(1.0, full_turn)) < 1e-8);
  BOOST_TEST(json["error_estimate"].get<double>() < 1e-8);
  BOOST_TEST(json["stability"]["index"] == 0);
  BOOST_TEST(!json["stability"]["degenerate"].get<bool>());
  for (const char* key : {"hamiltonian_drift", "axial_torque_drift", "force_residual"})
    BOOST_TEST(json["invariants"][key].get<double>() < 1e-8, key);
  const auto& contact = json["contact"];
  BOOST_TEST(contact["topology"] == "tail line tail");
  BOOST_REQUIRE(contact["arcs"].size() == 3u);
  BOOST_TEST(contact["arcs"][1]["kind"] == "line");
  // The whole rod, and its contact forces, are the sum of what is listed.
  BOOST_TEST(contact["arcs"][0]["s_begin"].get<double>() == -15.0);
  BOOST_TEST(contact["arcs"][2]["s_end"].get<double>() == 15.0);
  double sum = 0.0;
  for (const char* list : {"arcs", "joints"})
    for (const auto& part : contact[list]) sum += part["force"].get<double>();
  BOOST_TEST(relative(sum, json["R_tot"]) < 1e-12);
  BOOST_TEST(!fs::exists(folder.path() / "runs"));  // only --out makes a folder
}

BOOST_AUTO_TEST_CASE(infinite_length_equals_the_closed_form) {
  for (const char* tension : {"0.51", "5"}) {
    const std::string setting = std::string("load.tension=") + tension;
    const Outcome outcome =
        run_program(planar("solve", {"--set", "rod.length=inf", "--set", setting, "--json"}));
    BOOST_REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
    const auto json = nlohmann::json::parse(outcome.out);
    BOOST_TEST(relative(json["R_tot"], capstan::total_force(std::stod(tension), full_turn)) < 1e-10);
  }
}

BOOST_AUTO_TEST_CASE(physical_scenes_have_units) {
  const std::string scene = shipped_scene("capstan-vps-pom");
  const Outcome outcome = run_program({"solve", scene, "--set", "model.kind=planar", "--json"});
  BOOST_REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
  const auto json = nlohmann::json::parse(outcome.out);
  BOOST_TEST(json.contains("physical"));
  BOOST_TEST(relative(json["F0"], 0.32 * json["R_tot"].get<double>()) < 1e-12);
}

BOOST_AUTO_TEST_CASE(rod_shorter_than_its_contact) {
  const Outcome outcome = run_program(planar("solve", {"--set", "rod.length=2"}));
  BOOST_TEST(outcome.status == 1);
  BOOST_TEST(contains(outcome.err, "rod.length = 2"), outcome.err);
  BOOST_TEST(contains(outcome.err, "the rod is shorter than its contact arc"), outcome.err);
}

BOOST_AUTO_TEST_CASE(no_equilibrium_in_contact) {
  // The free loop is wider than the cylinder below T = 0.284.
  const Outcome outcome = run_program(planar("solve", {"--set", "load.tension=0.2", "--json"}));
  BOOST_TEST(outcome.status == 2);
  BOOST_TEST(outcome.out == "");
  BOOST_TEST(contains(outcome.err, "windlass: no equilibrium in contact exists at load.tension = 0.2"),
             outcome.err);
  BOOST_TEST(contains(outcome.err, "lifts off the cylinder at 0.2839"), outcome.err);
}

// The flat coil has lifted off at T = 0.2839 or is unstable, the helix is there all the way down, close by the event at
// 0.50773, too, where a gap of the helix opens: carried by the line first, then as an arc.
BOOST_AUTO_TEST_CASE(the_stable_helix_answers_whatever_the_flat_coil_does) {
  double last = 0.0;
  for (const char* tension : {"0.1", "0.2", "0.3", "0.48", "0.49", "0.495", "0.5", "0.505", "0.507", "0.5077",
                              "0.50774", "0.51", "0.52"}) {
    const auto json = answer(tension, {});
    BOOST_TEST(json["stability"]["index"] == 0, tension);
    BOOST_TEST(json["z_span"].get<double>() > 0.1, tension);
    BOOST_TEST(json["R_tot"].get<double>() > last, tension);  // one branch, on which the force rises with T
    last = json["R_tot"];
  }
  // Known from an independent minimisation of a discrete rod, good to its mesh.
  BOOST_TEST(relative(answer("0.1", {})["R_tot"], 0.6166) < 1e-3);
}

BOOST_AUTO_TEST_CASE(every_rung_in_space_has_the_same_answer) {
  const double force = answer("0.5", {})["R_tot"];
  for (const char* setting : {"model.kind=kirchhoff", "model.symmetry=none"}) {
    const auto json = answer("0.5", {"--set", setting});
    BOOST_TEST(json["stability"]["index"] == 0, setting);
    BOOST_TEST(relative(json["R_tot"], force) < 1e-7, setting);  // meshes to a tolerance of 1e-8
  }
}

BOOST_AUTO_TEST_CASE(the_other_equilibria_are_listed) {
  const auto json = answer("0.8", {});
  const auto& states = json["states"];
  BOOST_TEST_REQUIRE(states.size() >= 2u);
  BOOST_TEST(states[0]["R_tot"] == json["R_tot"]);
  BOOST_TEST(states[0]["energy"] == json["energy"]);
  BOOST_TEST(states[0]["index"] == 0);
  bool flat = false;
  for (const auto& state : states) {
    flat = flat || relative(state["R_tot"], capstan::total_force(0.8, full_turn)) < 1e-6;
    BOOST_TEST(state["potential"].get<double>() >= states[0]["potential"].get<double>());
  }
  BOOST_TEST(flat);
}

// Ends that bend freely and do not spin. Their moments are felt, as a clamp's are, by exp(−2 √T L_tail): clamped ends differ by
// that, exp(−6) less with 6 more of rod. The twist that they keep in spreads over the length: R_tot is that of free ends but for
// 1/L.
BOOST_AUTO_TEST_CASE(ends_that_cannot_spin) {
  const auto total = [](const char* ends, const char* length) {
    return answer("1", {"--set", std::string("ends.kind=") + ends, "--set",
                        std::string("rod.length=") + length})["R_tot"]
        .get<double>();
  };
  const double near = total("spin_held", "14") - total("clamped", "14"),
               far = total("spin_held", "20") - total("clamped", "20");
  BOOST_TEST(std::abs(near) > 1e-4);
  BOOST_TEST(std::abs(far / near / std::exp(-6.0) - 1.0) < 0.2);
  const double free = total("moment_free", "60"), kept = free - total("spin_held", "60");
  BOOST_TEST(kept > 0.1);
  BOOST_TEST(std::abs(kept / (free - total("spin_held", "120")) - 2.0) < 0.02);
}

// The helix that leaves the flat coil, whole chains and halves: all certificates, the end's among them.
BOOST_AUTO_TEST_CASE(branches_between_ends_that_cannot_spin) {
  for (const char* symmetry : {"half_turn", "none"}) {
    const TemporaryFolder folder;
    const Outcome run = run_program({"diagram", coil(), "--set", "ends.kind=spin_held", "--set",
                                     std::string("model.symmetry=") + symmetry, "--set",
                                     "continuation.to=0.3", "--no-eigenvalues", "--quiet", "--out", "run"},
                                    folder.path());
    BOOST_TEST(run.status == 0, run.err);
    const Outcome checked = run_program({"verify", "run"}, folder.path());
    BOOST_TEST(checked.status == 0, checked.out);
  }
}

BOOST_AUTO_TEST_SUITE_END()
