// The chain's linear algebra against differences and against its own assembled matrix.
#include "windlass/chain/chain.hpp"

#include <boost/test/unit_test.hpp>

#include "windlass/equilibrium/start.hpp"

namespace {

using namespace windlass;
using Eigen::MatrixXd;
using Eigen::VectorXd;

struct Case {
  const char* name;
  bool spatial, half;
  double tension;
  double radius = 0.0;  // 0: thin
  double turns = 1.0;
};

/// An equilibrium with the topology that belongs to it.
equilibrium::Started state(const Case& c) {
  scene::Scene scene;
  scene.has_cylinder = true;
  scene.load.tension = c.tension;
  scene.load.angle = 2.0 * M_PI * c.turns;
  scene.rod.length = 14.0 + 6.0 * c.turns;
  scene.rod_radius = c.radius;
  scene.self_contact = c.radius > 0.0;
  scene.model.tolerance = 1e-6;
  return equilibrium::cold_start(scene, c.spatial, c.half, {"load.tension"});
}

/// Central differences of the residual along increments.
MatrixXd differences(const chain::Chain& chain, const VectorXd& x, const contact::Loads& loads,
                     double h = 1e-5) {  // error h² of the difference: 1e-10
  const Eigen::Index n = chain.size();
  MatrixXd j(n, n);
  for (Eigen::Index k = 0; k < n; ++k) {
    VectorXd step = VectorXd::Zero(n);
    step(k) = h;
    j.col(k) =
        (chain.residual(chain.retract(x, step), loads) - chain.residual(chain.retract(x, -step), loads)) /
        (2 * h);
  }
  return j;
}

constexpr Case cases[] = {
    {"planar line", false, true, 1.0},
    {"planar touches", false, true, 0.4},
    {"planar full", false, false, 1.0},
    {"spatial line", true, true, 1.0},
    {"spatial full", true, false, 2.0},
    {"spatial touches", true, true, 0.4},
    // a strand that touches its image; two that touch each other's; one of them on the cylinder
    {"crossing", true, true, 2.0, 0.25},
    {"crossing full", true, false, 2.0, 0.25},
    {"split crossing", true, true, 8.0, 0.25},
    {"split crossing full", true, false, 8.0, 0.25},
    {"pressed strand", true, true, 16.0, 0.25},
    {"pressed strand full", true, false, 16.0, 0.25},
    {"tail on a strand", true, true, 2.0, 0.1, 2.0}};

}  // namespace

BOOST_AUTO_TEST_SUITE(chain_algebra)

BOOST_AUTO_TEST_CASE(bordered_solves_match_differences_of_the_residual) {
  for (const Case& c : cases) {
    equilibrium::Started s = state(c);
    chain::Chain& chain = s.problem->chain_to_factor();
    const contact::Loads loads = s.problem->loads(s.p);
    const MatrixXd j = differences(chain, s.x, loads);
    const Eigen::Index n = chain.size(), k = 2;
    std::srand(7);
    const MatrixXd b = MatrixXd::Random(n, k), ct = MatrixXd::Random(n, k), d = MatrixXd::Random(k, k);
    const VectorXd f = VectorXd::Random(n), g = VectorXd::Random(k);
    chain.factor(s.x, loads, b, ct, d);
    MatrixXd full(n + k, n + k);
    full << j, b, ct.transpose(), d;
    VectorXd rhs(n + k);
    rhs << f, g;
    const VectorXd y = chain.solve(f, g), yt = chain.solve(f, g, true);
    BOOST_TEST_CONTEXT(c.name) {
      // Differences are good to about 1e-9 of the largest entries, which are stiffnesses 1/h.
      BOOST_TEST((full * y - rhs).norm() < 1e-6 * full.norm() * y.norm());
      BOOST_TEST((full.transpose() * yt - rhs).norm() < 1e-6 * full.norm() * yt.norm());
      BOOST_TEST((MatrixXd(chain.jacobian(s.x, loads)) - j).norm() < 1e-7 * j.norm());
    }
  }
}

/// Without friction displacements are tested by themselves: by how much row and column of τ then differ in a dragged variation,
/// over the column, but for conditions of places, which are no balance.
double conjugate(const chain::Chain& chain, const VectorXd& x, contact::Loads loads) {
  loads.friction = 0.0;
  const MatrixXd k(chain.dragged_variation(x, loads).matrix);
  std::vector<bool> place(static_cast<std::size_t>(chain.size()), false), edge = place;
  for (int j = 0; j < chain.joint_count(); ++j) {
    if (chain.arclength_row(j) < 0) continue;
    place[static_cast<std::size_t>(chain.arclength_row(j))] = true;
    edge[static_cast<std::size_t>(chain.arclength_row(j))] =
        chain.joint(j).kind() == contact::JointKind::edge;
  }
  const auto left = [&](Eigen::Index row) {
    return row - std::count(edge.begin(), edge.begin() + row, true);
  };
  const Eigen::Index slide = left(chain.slide_row());
  double off = 0.0;
  for (Eigen::Index row = 0; row < chain.size(); ++row)
    if (!place[static_cast<std::size_t>(row)])
      off = std::max(off, std::abs(k(left(row), slide) - k(slide, left(row))));
  return off / k.col(slide).lpNorm<Eigen::Infinity>();
}

BOOST_AUTO_TEST_CASE(matrices_of_thick_rods_that_are_dragged_match_differences) {
  // One tail in the plate, the other below it, at T = 9 on the cylinder where it is pressed on.
  for (const double tension : {2.0, 8.0})
    for (const scene::Travel travel : {scene::Travel::blocked, scene::Travel::free}) {
      scene::Scene scene;
      scene.has_cylinder = true;
      scene.load = {.tension = tension, .angle = 2.0 * M_PI, .thrust = {}};
      scene.rod.length = 24.0;
      scene.rod_radius = 0.25;
      scene.self_contact = true;
      scene.friction = 0.32;
      scene.motion = {scene::Sliding::up, false};
      scene.plate.emplace();
      scene.ends.travel = travel;
      scene.model.tolerance = 1e-6;
      equilibrium::Started s = equilibrium::cold_start(scene, true, false, {"load.tension"});
      const contact::Loads loads = s.problem->loads(s.p);
      // Beside an edge the pressed place is near, and third derivatives are large: without the h² of the difference.
      const MatrixXd j = (4.0 * differences(s.problem->chain(), s.x, loads) -
                          differences(s.problem->chain(), s.x, loads, 2e-5)) /
                         3.0;
      BOOST_TEST_CONTEXT("T = " << tension << ": " << s.problem->topology().text()) {
        BOOST_TEST(s.problem->chain().couplings().size() == 1u);
        if (travel == scene::Travel::blocked) BOOST_TEST(conjugate(s.problem->chain(), s.x, loads) < 1e-12);
        BOOST_TEST((MatrixXd(s.problem->chain().jacobian(s.x, loads)) - j).norm() < 1e-7 * j.norm());
      }
    }
}

BOOST_AUTO_TEST_CASE(matrices_of_dragged_rods_that_stretch_and_of_ends_on_sliders_match_differences) {
  // Flat on the plate; on touches, one of the plate; flat, with ends on sliders.
  for (const int kind : {0, 1, 2})
    for (const scene::Travel travel : {scene::Travel::blocked, scene::Travel::free}) {
      scene::Scene scene;
      scene.has_cylinder = true;
      scene.load = {.tension = kind == 1 ? 0.3 : 2.0, .angle = 2.0 * M_PI, .thrust = {}};
      scene.rod.length = 18.0;
      scene.rod.extensible = true;
      scene.rod.axial_stiffness = 10.0;
      scene.friction = 0.32;
      scene.motion = {scene::Sliding::up, false};
      scene.plate.emplace();
      scene.ends.travel = travel;
      scene.ends.kind = scene::EndKind::clamped;
      if (kind == 1) scene.model.kind = scene::ModelKind::kirchhoff;
      if (kind == 2) scene.ends.guide = scene::Guide::slider;
      scene.model.tolerance = 1e-6;
      equilibrium::Started s = equilibrium::cold_start(scene, true, false, {"cylinder.friction"});
      const contact::Loads loads = s.problem->loads(s.p);
      const MatrixXd j = (4.0 * differences(s.problem->chain(), s.x, loads) -
                          differences(s.problem->chain(), s.x, loads, 2e-5)) /
                         3.0;
      BOOST_TEST_CONTEXT(s.problem->topology().text()
                         << ", travelled " << s.problem->chain().travelled(s.x)) {
        if (travel == scene::Travel::blocked) BOOST_TEST(conjugate(s.problem->chain(), s.x, loads) < 1e-12);
        BOOST_TEST((MatrixXd(s.problem->chain().jacobian(s.x, loads)) - j).norm() < 1e-7 * j.norm());
      }
    }
}

BOOST_AUTO_TEST_CASE(an_equilibrium_is_a_fixed_point) {
  for (const Case& c : cases) {
    equilibrium::Started s = state(c);
    VectorXd x = s.x;
    BOOST_TEST_CONTEXT(c.name) {
      BOOST_TEST(s.problem->polish(x, s.p) <= 1);
      BOOST_TEST((x - s.x).lpNorm<Eigen::Infinity>() < 1e-9);
    }
  }
}

BOOST_AUTO_TEST_CASE(second_variation_is_symmetric_and_its_inertia_is_the_index) {
  for (const Case& c : cases) {
    equilibrium::Started s = state(c);
    chain::Chain& chain = s.problem->chain_to_factor();
    const contact::Loads loads = s.problem->loads(s.p);
    const MatrixXd none(chain.size(), 0);
    chain.factor(s.x, loads, none, none, MatrixXd(0, 0));
    for (auto parity : {contact::Parity::even, contact::Parity::odd}) {
      if (parity == contact::Parity::odd && !c.half) continue;
      const auto variation = chain.second_variation(s.x, loads, parity);
      const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(MatrixXd(variation.matrix), Eigen::EigenvaluesOnly);
      // A neutral mode counts either way: two touches on the e_x axis let the whole rod turn about it, an odd mode whose
      // eigenvalue is rounding.
      const auto below = [&](double bound) {
        return static_cast<int>((eigen.eigenvalues().array() < bound).count()) - variation.constraints;
      };
      BOOST_TEST_CONTEXT(c.name) {
        BOOST_TEST(chain.index(s.x, loads, parity) >= below(-1e-12));
        BOOST_TEST(chain.index(s.x, loads, parity) <= below(1e-12));
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(index_of_a_full_chain_is_the_sum_of_both_parities_of_its_half) {
  for (const auto& [tension, radius] :
       {std::pair{2.0, 0.0}, {1.0, 0.0}, {2.0, 0.25}, {8.0, 0.25}, {16.0, 0.25}}) {
    equilibrium::Started half = state({"half", true, true, tension, radius}),
                         full = state({"full", true, false, tension, radius});
    const MatrixXd none_half(half.problem->size(), 0), none_full(full.problem->size(), 0);
    half.problem->chain_to_factor().factor(half.x, half.problem->loads(half.p), none_half, none_half,
                                           MatrixXd(0, 0));
    full.problem->chain_to_factor().factor(full.x, full.problem->loads(full.p), none_full, none_full,
                                           MatrixXd(0, 0));
    BOOST_TEST(half.problem->total_index(half.x, half.p) == full.problem->total_index(full.x, full.p));
  }
}

BOOST_AUTO_TEST_SUITE_END()
