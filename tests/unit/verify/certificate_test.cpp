#include <boost/test/unit_test.hpp>
#include <chrono>
#include <nlohmann/json.hpp>

#include "closed_form_rods.hpp"
#include "windlass/verify/certificate.hpp"
#include "windlass/verify/rod_flow.hpp"

namespace {

using namespace windlass;
using test::capstan_scene;
using test::planar_capstan;
using verify::Certificate;

/// Names of the checks that fail, separated by blanks.
std::string failed(const Certificate& certificate) {
  std::string names;
  for (const auto& check : certificate.checks) {
    if (!check.passed()) names += (names.empty() ? "" : " ") + check.name;
  }
  return names;
}

constexpr double two_pi = 2 * std::numbers::pi;

}  // namespace

BOOST_AUTO_TEST_SUITE(certificate)

BOOST_AUTO_TEST_CASE(closed_form_capstan_passes_for_all_tensions) {
  for (const double T : {0.51, 1.0, 7.0, 100.0, 1e4}) {
    for (const double phi : {std::numbers::pi, 2 * two_pi}) {
      const Certificate certificate = verify::verify(planar_capstan(T, phi), capstan_scene(T, phi));
      BOOST_TEST(certificate.passed(), "T = " << T << ", phi = " << phi << "\n"
                                              << verify::to_text(certificate));
    }
  }
}

BOOST_AUTO_TEST_CASE(a_tail_of_a_thousand_decay_lengths_passes) {
  // exp(1000) overflows: a sweep from one end could not pass
  const Certificate certificate =
      verify::verify(planar_capstan(4.0, two_pi, 1000.0, 4001), capstan_scene(4.0, two_pi));
  BOOST_TEST(certificate.passed(), verify::to_text(certificate));
}

BOOST_AUTO_TEST_CASE(a_line_contact_with_samples_at_its_ends_only_passes) {
  // 60 growth lengths between the two samples
  auto solution = planar_capstan(100.0, two_pi);
  auto& line = solution.arcs[1];
  const auto keep_ends = [](auto& columns) {
    const auto last = columns.rightCols(1).eval();
    columns.conservativeResize(Eigen::NoChange, 2);
    columns.rightCols(1) = last;
  };
  line.s = Eigen::Vector2d(line.s_begin, line.s_end);
  line.p = line.p.head(2).eval();
  keep_ends(line.r), keep_ends(line.q), keep_ends(line.n), keep_ends(line.m);
  const auto begin = std::chrono::steady_clock::now();
  const Certificate certificate = verify::verify(solution, capstan_scene(100.0, two_pi));
  BOOST_TEST(certificate.passed(), verify::to_text(certificate));
  BOOST_TEST_MESSAGE(
      "seconds: " << std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
}

BOOST_AUTO_TEST_CASE(endless_helix_satisfies_the_surface_equations) {
  for (const double psi : {0.0, 0.3, 0.9, -0.5}) {
    const auto solution = test::endless_helix(psi);
    auto scene = capstan_scene(solution.T, solution.phi);
    scene.rod.length = 6.0;
    const Certificate certificate = verify::verify(solution, scene);
    // the helix is cut, not held: its ends carry neither the pulls nor vanishing moments
    BOOST_TEST(failed(certificate) == "end_pull end_moment", verify::to_text(certificate));
  }
}

BOOST_AUTO_TEST_CASE(surface_pressure_of_the_helix_is_cos_to_the_fourth) {
  for (const double psi : {0.0, 0.4, 1.1}) {
    const auto arc = test::endless_helix(psi).arcs[0];
    const verify::Section section{arc.r.col(5), arc.q.col(5), arc.m.col(5), arc.n.col(5)};
    BOOST_TEST(verify::surface_pressure(section, 1.0) == std::pow(std::cos(psi), 4),
               boost::test_tools::tolerance(1e-13));
  }
}

BOOST_AUTO_TEST_CASE(each_kind_of_damage_fails_its_own_check) {
  const double T = 1.0;
  const auto scene = capstan_scene(T, two_pi);
  const auto damaged = [&](auto damage) {
    auto solution = planar_capstan(T, two_pi);
    damage(solution);
    return failed(verify::verify(solution, scene));
  };
  const auto fails = [](const std::string& names, const std::string& name) {
    return (" " + names + " ").find(" " + name + " ") != std::string::npos;
  };
  BOOST_TEST(damaged([](auto&) {}) == "");
  BOOST_TEST(fails(damaged([](auto& x) { x.arcs[2].r(0, 7) += 1e-8; }), "arc_position"));
  BOOST_TEST(fails(damaged([](auto& x) { x.arcs[2].m(2, 7) += 1e-8; }), "arc_moment"));
  BOOST_TEST(fails(damaged([](auto& x) { x.arcs[1].n(0, 7) += 1e-8; }), "arc_force"));
  BOOST_TEST(fails(damaged([](auto& x) { x.arcs[1].p[7] += 1e-7; }), "pressure_balance"));
  BOOST_TEST(damaged([](auto& x) { x.joints[1].force += 1e-8; }) == "joint_force total_contact_force");
  BOOST_TEST(damaged([](auto& x) { x.R_tot *= 1 + 1e-8; }) == "total_contact_force");
  BOOST_TEST(damaged([](auto& x) { x.phi_star += 1e-8; }) == "contact_angle");
  BOOST_TEST(fails(damaged([](auto& x) { x.T += 1e-8; }), "end_pull"));
  BOOST_TEST(fails(damaged([](auto& x) { x.joints[1].force = -x.joints[1].force; }), "point_force"));
  BOOST_TEST(damaged([](auto& x) { x.arcs[1].q(0, 3) = NAN; }) == "structure");
  BOOST_TEST(damaged([](auto& x) { x.arcs[1].p.conservativeResize(3); }) == "structure");
  BOOST_TEST(damaged([](auto& x) { x.joints.pop_back(); }) == "structure");
  BOOST_TEST(damaged([](auto& x) { x.converged = false; }) == "structure");
}

BOOST_AUTO_TEST_CASE(a_rod_of_another_scene_fails) {
  auto scene = capstan_scene(1.0, two_pi);
  scene.rod.length = 30.0;
  BOOST_TEST(failed(verify::verify(planar_capstan(1.0, two_pi), scene)) == "rod_length");
  BOOST_TEST(failed(verify::verify(planar_capstan(1.0, two_pi), capstan_scene(1.1, two_pi))) == "load");
  BOOST_TEST(failed(verify::verify(planar_capstan(1.0, two_pi), capstan_scene(1.0, 6.0))) == "load");
}

BOOST_AUTO_TEST_CASE(the_standard_decides_what_passes) {
  auto solution = planar_capstan(1.0, two_pi);
  const auto scene = capstan_scene(1.0, two_pi);
  solution.phi_star += 1e-7;
  BOOST_TEST(failed(verify::verify(solution, scene)) == "contact_angle");
  BOOST_TEST(verify::verify(solution, scene, {1e-12, 1e-6}).passed());
  // A coarse reference integration misses the stored points by more than the usual bound.
  BOOST_TEST(!verify::verify(planar_capstan(1.0, two_pi), scene, {1e-5, 1e-9}).passed());
  BOOST_TEST(verify::verify(planar_capstan(1.0, two_pi), scene, {1e-5, 1e-2}).passed());
}

BOOST_AUTO_TEST_CASE(a_rod_through_the_cylinder_fails_by_its_depth) {
  // a moment-free straight rod pulled at both ends, at a distance 0.6 of the axis: 0.4 deep, passing only the mechanics
  auto scene = capstan_scene(1.0, 1e-12);
  scene.ends.kind = scene::EndKind::moment_free;
  scene.rod.length = 5.6;
  test::Solution solution;
  solution.T = 1.0, solution.phi = 0.0, solution.converged = true;
  auto arc = test::empty_arc(test::ArcKind::free, "gap", 5);
  for (int i = 0; i < 5; ++i) {
    // no sample where the rod is closest to the axis
    const double s = -3.0 + 1.4 * i;
    test::set_planar(arc, i, s, {s, -0.6}, 0.0, 0.0, {1.0, 0.0});
  }
  arc.s_begin = -3.0, arc.s_end = 2.6;
  solution.arcs = {arc};
  solution.joints.resize(2);
  const Certificate certificate = verify::verify(solution, scene);
  BOOST_TEST(failed(certificate) == "gap");
  BOOST_TEST(certificate.find("gap")->value == -0.4, boost::test_tools::tolerance(3e-3));
  BOOST_TEST(certificate.worst() == certificate.find("gap"));
}

BOOST_AUTO_TEST_CASE(tension_in_the_line_shows_as_negative_pressure) {
  // adding a constant c to the tension of a ring on the cylinder changes p by c: still balanced, but pulling inward
  auto solution = test::endless_helix(0.0);
  auto& arc = solution.arcs[0];
  for (Eigen::Index i = 0; i < arc.s.size(); ++i) {
    arc.n.col(i) *= -0.5;
    arc.p[i] *= -0.5;
  }
  const Certificate certificate = verify::verify(solution, capstan_scene(solution.T, solution.phi));
  BOOST_TEST(!certificate.find("pressure")->passed());
  BOOST_TEST(certificate.find("pressure")->value == -0.5 / 1.5, boost::test_tools::tolerance(1e-9));
  BOOST_TEST(certificate.find("pressure_balance")->passed());
}

BOOST_AUTO_TEST_CASE(json_says_what_failed_and_holds_no_nan) {
  auto solution = planar_capstan(1.0, two_pi);
  solution.R_tot = NAN;
  const auto json = verify::to_json(verify::verify(solution, capstan_scene(1.0, two_pi)));
  BOOST_TEST(!json["passed"].get<bool>());
  BOOST_TEST(json.dump().find("nan") == std::string::npos);
  for (const auto& check : json["checks"]) {
    const bool expected = check["name"] != "total_contact_force";
    BOOST_TEST(check["passed"].get<bool>() == expected, check.dump());
  }
}

BOOST_AUTO_TEST_SUITE_END()
