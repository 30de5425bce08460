// Rods that stretch, and struts that weigh, against what is known exactly and against integrations of another kind.
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <continuation/walker.hpp>

#include "support/coil_scene.hpp"
#include "windlass/equilibrium/equilibria.hpp"
#include "windlass/equilibrium/record.hpp"
#include "windlass/equilibrium/start.hpp"
#include "windlass/verify/certificate.hpp"

namespace {

using namespace windlass;
using continuation::PointType;
using equilibrium::Solution;
using equilibrium::Started;

scene::Scene stretching_coil(double tension, double angle, double length, double axial_stiffness) {
  scene::Scene scene = test::coil_scene(tension);
  scene.load.angle = angle;
  scene.rod.length = length;
  scene.rod.extensible = true;
  scene.rod.axial_stiffness = axial_stiffness;
  scene.model.tolerance = 1e-11;
  return scene;
}

Solution solved(const scene::Scene& scene, bool spatial, bool half = true) {
  Started started = equilibrium::cold_start(scene, spatial, half, {"load.tension"});
  return equilibrium::record(*started.problem, started.x, started.p);
}

double relative(double value, double exact) { return std::abs(value / exact - 1.0); }

/// The planar capstan that stretches, very long tails (PHYSICS, "Known exactly").
struct Capstan {
  double stretch, tension, beta, phi_star, R_tot, energy;  ///< energy: of all but the straight tails
  Capstan(double T, double phi, double k) {
    stretch = (1.0 + k * T) / std::sqrt(1.0 + k);
    tension = (stretch - 1.0) / k;
    beta = std::acos(tension / T);
    phi_star = 0.5 * phi - beta;
    R_tot = 2.0 * (tension * phi_star + T * std::sin(beta));
    // Tail: m = 2√T sin(ψ/2) √(1 + kT cos²(ψ/2)); with v = cos(ψ/2) the bending energy is 2√T ∫ √(1 + kT v²) dv, and the
    // stretch has ½kT² a length less ½kT² ∫ sin²ψ ds = 2kT √T ∫ v²/√(1 + kT v²) dv.
    const double a = std::sqrt(k * T), low = std::cos(0.5 * beta);
    const auto root = [&](double v) { return std::sqrt(1.0 + a * a * v * v); };
    const auto bent = [&](double v) { return 0.5 * (v * root(v) + std::asinh(a * v) / a); };
    const auto slack = [&](double v) { return 0.5 * (v * root(v) - std::asinh(a * v) / a) / (a * a); };
    const double tail =
        2.0 * std::sqrt(T) * (bent(1.0) - bent(low)) - 2.0 * k * T * std::sqrt(T) * (slack(1.0) - slack(low));
    energy = 2.0 * (phi_star / stretch * (0.5 * stretch * stretch + 0.5 * k * tension * tension) + tail);
  }
};

}  // namespace

BOOST_AUTO_TEST_SUITE(rods_that_stretch)

BOOST_AUTO_TEST_CASE(long_tails_equal_the_closed_form) {
  // As for rods that do not stretch: exp(−2 √T L_tail) is below the bound.
  for (const double phi : {M_PI, 2.0 * M_PI})
    for (const double T : {0.8, 3.0})
      for (const double k : {1e-4, 0.02, 0.2})
        for (const bool spatial : {false, true}) {
          const double length = phi + 40.0 / std::sqrt(std::min(T, 1.0));
          const Solution s = solved(stretching_coil(T, phi, length, 1.0 / k), spatial);
          const Capstan exact(T, phi, k);
          const double tails = length - 2.0 * exact.phi_star / exact.stretch;
          BOOST_TEST_CONTEXT("T = " << T << ", phi = " << phi << ", 1/EA = " << k << ", spatial "
                                    << spatial) {
            BOOST_TEST(s.topology == "tail line tail");
            BOOST_TEST(relative(s.R_tot, exact.R_tot) < 1e-9);
            BOOST_TEST(relative(s.phi_star, exact.phi_star) < 1e-9);
            BOOST_TEST(relative(s.energy, exact.energy + 0.5 * k * T * T * tails) < 1e-9);
            BOOST_TEST(relative(s.stretch, k * T) < 1e-9);
            for (const auto& arc : s.arcs)
              if (arc.kind == equilibrium::ArcKind::line)
                BOOST_TEST(relative(arc.p.maxCoeff(), exact.stretch * exact.tension) < 1e-9);
            for (const auto& joint : s.joints)
              if (joint.kind == equilibrium::JointKind::edge)
                BOOST_TEST(relative(joint.force, T * std::sin(exact.beta)) < 1e-9);
          }
        }
}

BOOST_AUTO_TEST_CASE(finite_rods_equal_quadratures_of_their_first_integral) {
  // m²/2 + n₃ + k n₃²/2 = H along the tail, its length and energy by quadrature with 25 digits; the edge from m = λ there.
  const Solution whole_turn = solved(stretching_coil(1.0, 2.0 * M_PI, 30.0, 50.0), false),
                 half_turn = solved(stretching_coil(1.0, M_PI, 20.0, 50.0), false);
  BOOST_TEST(relative(whole_turn.R_tot, 3.81608443436192) < 1e-10);
  BOOST_TEST(relative(whole_turn.energy, 2.91530899073592) < 1e-10);
  BOOST_TEST(relative(half_turn.R_tot, 2.25306450619978) < 1e-10);
  BOOST_TEST(relative(half_turn.energy, 1.25228895904873) < 1e-10);
}

BOOST_AUTO_TEST_CASE(stiff_rods_tend_to_the_inextensible_one_at_the_rate_1_over_EA) {
  // The helical state at T = 1: differences over 1/EA tend to a constant, and differ from it by O(1/EA).
  scene::Scene scene = stretching_coil(1.0, 2.0 * M_PI, 24.0, HUGE_VAL);
  scene.rod.extensible = false;
  const Solution limit = equilibrium::solve(scene);
  BOOST_TEST(limit.tilt != 0.0);
  std::vector<double> slopes;
  for (const double stiffness : {20.0, 200.0, 2000.0, 20000.0}) {  // 2e4 times the tolerance 1e-11 is little
    const Solution s = equilibrium::solve(stretching_coil(1.0, 2.0 * M_PI, 24.0, stiffness));
    BOOST_TEST(s.topology == limit.topology);
    slopes.push_back(stiffness * (s.R_tot - limit.R_tot));
  }
  const double first = slopes[1] - slopes[0], second = slopes[2] - slopes[1], third = slopes[3] - slopes[2];
  BOOST_TEST(first / second == 10.0, boost::test_tools::tolerance(0.1));
  BOOST_TEST(second / third == 10.0, boost::test_tools::tolerance(0.02));
}

BOOST_AUTO_TEST_CASE(certificates_hold_on_helices_and_thick_rods) {
  scene::Scene helix = stretching_coil(1.0, 2.0 * M_PI, 24.0, 20.0);
  helix.name = "helix";
  scene::Scene thick = test::thick_coil_scene();
  thick.rod.extensible = true;
  thick.rod.axial_stiffness = 49.0;  // 4/r², R/r = 2.5
  for (const scene::Scene& scene : {helix, thick}) {
    const Solution s = equilibrium::solve(scene);
    const verify::Certificate certificate = verify::verify(s, scene);
    BOOST_TEST(certificate.passed(), scene.name << "\n" << verify::to_text(certificate));
    BOOST_TEST(certificate.find("scaling") != nullptr);
    BOOST_TEST(s.stretch > 0.03);
  }
}

BOOST_AUTO_TEST_CASE(struts_that_give_way_buckle_at_the_thrust_of_an_extensible_column) {
  // B θ″ + P (1 − P/EA) θ = 0 between clamps: P (1 − P/EA) = 4π² B/L².
  for (const double stiffness : {200.0, 1000.0}) {
    scene::Scene scene;
    scene.name = "strut";
    scene.rod.length = 1.0;
    scene.ends.kind = scene::EndKind::clamped;
    scene.load.thrust = 0.0;
    scene.rod.extensible = true;
    scene.rod.axial_stiffness = stiffness;
    scene.model.tolerance = 1e-10;
    Started start = equilibrium::cold_start(scene, true, true, {"load.thrust"});
    continuation::Options options;
    options.target = 70.0;
    options.parameter_scale = 15.0;
    continuation::Walker walker(start.problem, start.x, start.p, options);
    double buckles = 0.0;
    while (const auto point = walker.step())
      if (point->type == PointType::branch_point && buckles == 0.0) buckles = point->p(0);
    const double exact = 0.5 * stiffness * (1.0 - std::sqrt(1.0 - 16.0 * M_PI * M_PI / stiffness));
    BOOST_TEST(relative(buckles, exact) < 1e-9);
  }
}

BOOST_AUTO_TEST_CASE(struts_that_weigh_equal_an_integration_from_the_middle) {
  // Half the rod, θ' = m, m' = n × r', r' = (1 + k n·t) t, n = (n_x, −w s), by shooting from the middle (DOP853, 1e-13):
  // shortening, weight, 1/EA, clamped; force along e_x, energy, and how deep the middle hangs.
  struct Case {
    double shortening, weight, compliance;
    bool clamped;
    double tension, energy, sag;
  };
  const Case cases[] = {
      {0.05, -20.0, 0.0, false, 6.9003865938509845, 0.5009318640051985, -0.13935624945018477},
      {0.05, -20.0, 0.005, false, 3.546585071529506, 0.8324438541290518, -0.1743647862604864},
      {0.02, -50.0, 0.002, true, 3.5534605482054475, 1.4377623917302433, -0.11600134877166007}};
  for (const Case& c : cases)
    for (const bool turned : {false, true}) {  // the same weight along e_z: a whole chain
      scene::Scene scene;
      scene.name = "strut";
      scene.rod.length = 1.0;
      scene.ends.kind = c.clamped ? scene::EndKind::clamped : scene::EndKind::pinned;
      scene.ends.shortening = c.shortening;
      scene.rod.extensible = c.compliance != 0.0;
      if (scene.rod.extensible) scene.rod.axial_stiffness = 1.0 / c.compliance;
      scene.rod.weight[turned ? 2 : 1] = c.weight;
      scene.model.tolerance = 1e-11;
      Started start = equilibrium::cold_start(scene, true, scene.half_turn(), {"ends.shortening"});
      BOOST_TEST(start.problem->topology().half == !turned);
      const Solution s = equilibrium::record(*start.problem, start.x, start.p);
      BOOST_TEST_CONTEXT("weight " << c.weight << ", 1/EA = " << c.compliance << ", turned " << turned) {
        BOOST_TEST(relative(-s.end_force, c.tension) < 1e-9);
        BOOST_TEST(relative(s.energy, c.energy) < 1e-9);
        const double middle = start.problem->profile(start.x, start.p).at(0.0).r(turned ? 2 : 1);
        BOOST_TEST(relative(middle, c.sag) < 1e-7);  // inside an element the curve is a polynomial's
        BOOST_TEST(start.problem->total_index(start.x, start.p) == 0);  // it hangs
        const verify::Certificate certificate = verify::verify(s, scene);
        BOOST_TEST(certificate.passed(), verify::to_text(certificate));
      }
    }
}

BOOST_AUTO_TEST_SUITE_END()
