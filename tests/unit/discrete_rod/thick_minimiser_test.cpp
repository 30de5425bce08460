// The thick discrete rod: derivatives with both contacts at work, pairs of strands, orders, refusals.
#include "windlass/discrete_rod/thick_minimiser.hpp"

#include <boost/test/unit_test.hpp>
#include <cmath>

#include "support/petsc_session.hpp"
#include "windlass/discrete_rod/thick_energy.hpp"
#include "windlass/rod/capstan.hpp"

using namespace windlass;
using discrete_rod::SplineRod;
using discrete_rod::ThickEnergy;
using discrete_rod::ThickRod;

namespace {

/// A helix of this radius and rise a turn, two turns long, bumpy.
Eigen::VectorXd coil(const SplineRod& rod, double radius, double rise, double bump) {
  std::vector<SplineRod::Point> points;
  for (int k = 0; k <= rod.elements(); ++k) {
    const double s = rod.knot(k);
    points.emplace_back(radius * std::sin(s), -radius * std::cos(s), rise * s / (2.0 * M_PI));
  }
  Eigen::VectorXd x = rod.through(points);
  for (Eigen::Index k = 0; k < x.size(); ++k) x(k) += bump * std::sin(7.0 * static_cast<double>(k) + 1.0);
  return x;
}

ThickRod thick_rod(double tension, double radius) { return {tension, 2.0 * M_PI, 15.0, radius}; }

}  // namespace

BOOST_FIXTURE_TEST_SUITE(thick_discrete_rods, test::PetscSession)

BOOST_AUTO_TEST_CASE(a_spline_is_its_own_half_turn_image) {
  const SplineRod rod(6.0, 3.0, 0.25);
  const Eigen::VectorXd x = coil(rod, 1.0, 0.6, 0.02);
  for (const int element : {0, 3, 11}) {
    const SplineRod::Point here = rod.position(x, element, 0.3), image = rod.position(x, -element - 1, 0.7);
    BOOST_TEST((here - SplineRod::Point(-image(0), image(1), -image(2))).norm() < 1e-15);
  }
  // Control points for values at knots: exact but for fourth differences.
  const Eigen::VectorXd smooth = coil(rod, 1.0, 0.6, 0.0);
  const double s = rod.knot(5);
  const SplineRod::Point wanted(std::sin(s), -std::cos(s), 0.6 * s / (2.0 * M_PI));
  BOOST_TEST((rod.position(smooth, 5, 0.0) - wanted).norm() < 1e-3 * std::pow(0.25, 2));
}

BOOST_AUTO_TEST_CASE(gradient_and_hessian_are_those_of_the_energy) {
  const SplineRod rod(4.0 * M_PI, 4.0 * M_PI, 0.35);
  ThickEnergy energy(rod, 2.0, 4.0 * M_PI, 0.25);
  energy.penalties.cylinder = 50.0;
  energy.penalties.strands = 40.0;
  energy.penalties.stretching = 30.0;
  energy.penalties.strand_shift = 0.01;
  const Eigen::VectorXd x = coil(rod, 0.97, 0.45, 0.01);
  BOOST_REQUIRE(energy.cylinder_force(x) > 1.0);
  BOOST_REQUIRE(energy.strand_force(x) > 1.0);
  const Eigen::VectorXd gradient = energy.gradient(x);
  const Eigen::MatrixXd hessian = energy.hessian(x);
  constexpr double step = 1e-6;
  for (Eigen::Index k = 0; k < x.size(); k += 3) {
    Eigen::VectorXd up = x, down = x;
    up(k) += step, down(k) -= step;
    BOOST_TEST(std::abs((energy.value(up) - energy.value(down)) / (2.0 * step) - gradient(k)) < 1e-7);
    // The second derivative jumps where a sample comes into contact: a step across one is off by its weight.
    const Eigen::VectorXd column = (energy.gradient(up) - energy.gradient(down)) / (2.0 * step);
    BOOST_TEST((column - hessian.col(k)).lpNorm<Eigen::Infinity>() < 1e-5);
  }
  BOOST_TEST((hessian - hessian.transpose()).lpNorm<Eigen::Infinity>() < 1e-11);
}

BOOST_AUTO_TEST_CASE(pairs_are_perpendicular_and_none_is_missed) {
  const SplineRod rod(4.0 * M_PI, 4.0 * M_PI, 0.2);
  const Eigen::VectorXd x = coil(rod, 1.0, 0.45, 0.004);
  constexpr double reach = 0.5, apart = 2.0;
  const auto pairs = discrete_rod::strand_pairs(rod, x, reach, apart);
  for (const auto& pair : pairs) {
    const SplineRod::Controls there = rod.controls(x, pair.other);
    const SplineRod::Point gap =
        rod.position(x, pair.element, pair.t) - rod.position(x, pair.other, pair.other_t);
    BOOST_TEST(std::abs(gap.dot(there * discrete_rod::cubic_weights(pair.other_t, 1))) < 1e-12);
    BOOST_TEST(std::abs(gap.norm() - pair.distance) < 1e-15);
  }
  // Every turn lies between two others 0.45 away; the ends lack one. All are within reach.
  const int samples = discrete_rod::Quadrature::points;
  int inside = 0, found = 0;
  for (int e = 0; e < rod.elements(); ++e)
    if (rod.knot(e + 1) < 2.0 * M_PI - 0.3) inside += 2 * samples;
  for (const auto& pair : pairs)
    if (rod.knot(pair.element + 1) < 2.0 * M_PI - 0.3) ++found;
  BOOST_TEST(found == inside);
}

BOOST_AUTO_TEST_CASE(no_foot_is_lost_to_rounding) {
  // A strand next to the other's centre of curvature: the place that is nearest is poorly determined, and unique.
  const SplineRod rod(6.0, 6.0, 0.1);
  const double bent = M_PI + 0.4;
  std::srand(3);
  for (int sample = 0; sample < 300; ++sample) {
    const double aside = 0.01 * std::rand() / RAND_MAX, beside = 0.02 * std::rand() / RAND_MAX - 0.01;
    std::vector<SplineRod::Point> points;
    for (int k = 0; k <= rod.elements(); ++k) {
      const double s = rod.knot(k);
      if (s < M_PI)
        points.emplace_back(std::sin(s), -std::cos(s), 3.0);
      else
        points.emplace_back(0.05 + aside + 0.1 * (s - bent), beside, 3.0);
    }
    int places = 0, found = 0;
    for (int e = 0; e < rod.elements(); ++e)
      if (rod.knot(e) > bent && rod.knot(e + 1) < bent + 1.0) places += discrete_rod::Quadrature::points;
    for (const auto& pair : discrete_rod::strand_pairs(rod, rod.through(points), 1.2, 0.3))
      if (rod.knot(pair.element) > bent && rod.knot(pair.element + 1) < bent + 1.0 &&
          rod.knot(pair.other + 1) < M_PI)
        ++found;
    BOOST_TEST_CONTEXT("sample " << sample) BOOST_TEST(found == places);
  }
}

BOOST_AUTO_TEST_CASE(a_slender_rod_comes_to_the_closed_form) {
  // Flat but for its crossing, which changes R_tot by 0.1 r² (1e-5 of it here).
  const auto limit = discrete_rod::minimise(thick_rod(4.0, 0.05), {0.1, 0.07, 0.05});
  BOOST_REQUIRE(limit.converged);
  BOOST_TEST(std::abs(limit.R_tot / rod::capstan::total_force(4.0, 2.0 * M_PI) - 1.0) < 6e-5);
}

BOOST_AUTO_TEST_CASE(the_forces_converge_at_the_orders_extrapolated_with) {
  // Where contacts end between knots decides on a factor of a few at each mesh: order over 1 to 4.
  const auto force_error = [](const discrete_rod::ThickMinimum& mesh) {
    return std::abs(mesh.self_force / 0.262659926569692 - 1.0);  // the chain's, to 1e-11
  };
  const auto error = [](const discrete_rod::ThickMinimum& mesh) {
    return std::abs(mesh.R_tot / 22.3175578060383 - 1.0);
  };
  const auto limit =
      discrete_rod::minimise({4.0, 2.0 * M_PI, 20.0, 2.0 / 7.0}, {0.1, 0.07, 0.05, 0.035, 0.025});
  BOOST_REQUIRE(limit.converged);
  const double order = std::log2(error(limit.meshes.front()) / error(limit.meshes.back())) / 2.0;
  const double force_order =
      std::log2(force_error(limit.meshes.front()) / force_error(limit.meshes.back())) / 2.0;
  BOOST_TEST_MESSAGE("orders " << order << ", " << force_order);
  BOOST_TEST(order > 2.5);
  BOOST_TEST(force_order > 1.7);
  BOOST_TEST(force_order < 2.3);
}

BOOST_AUTO_TEST_CASE(forces_and_energy_obey_the_scaling_identity) {
  // R_tot + 2r F = T l − E (src/PHYSICS.md), l the length less the ends' places along their pulls: forces
  // against shapes, no other solver asked. The depth into the cylinder, p/κ, is left out of it: 1e-5 here.
  const ThickRod rod{2.0, 4.0 * M_PI, 20.0, 0.5};
  const auto limit = discrete_rod::minimise(rod, {0.1, 0.07, 0.05});
  BOOST_REQUIRE(limit.converged);
  const auto& mesh = limit.meshes.back();
  const SplineRod spline = rod.spline(mesh.h);
  const SplineRod::Point end = spline.position(mesh.x, spline.elements() - 1, 1.0);
  const double length = 2.0 * (rod.half_length - end(0));
  BOOST_TEST(mesh.self_force > 0.1);
  const double forces = mesh.R_tot + 2.0 * rod.radius * mesh.self_force;
  BOOST_TEST(std::abs(forces / (rod.tension * length - mesh.energy) - 1.0) < 1e-4);
}

BOOST_AUTO_TEST_CASE(extrapolation_is_exact_for_one_power) {
  const std::vector<double> h{0.1, 0.07, 0.05};
  std::vector<double> values;
  for (const double width : h) values.push_back(3.0 - 20.0 * width * width);
  BOOST_TEST(std::abs(discrete_rod::extrapolated(h, values, 2) - 3.0) < 1e-13);
}

BOOST_AUTO_TEST_CASE(what_cannot_be_is_refused) {
  BOOST_CHECK_THROW(discrete_rod::minimise(thick_rod(0.0, 0.2), 0.1), std::invalid_argument);
  BOOST_CHECK_THROW(discrete_rod::minimise(thick_rod(1.0, 1.0), 0.1), std::invalid_argument);
  BOOST_CHECK_THROW(discrete_rod::minimise(thick_rod(1.0, 0.2), 0.3), std::invalid_argument);
  BOOST_CHECK_THROW(discrete_rod::minimise({1.0, 2.0 * M_PI, 4.0, 0.2}, 0.1), std::invalid_argument);
  BOOST_CHECK_THROW(discrete_rod::minimise(thick_rod(1.0, 0.2), {0.1, 0.05}), std::invalid_argument);
}

BOOST_AUTO_TEST_SUITE_END()
