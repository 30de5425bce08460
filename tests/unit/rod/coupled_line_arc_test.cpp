// The line contact on a cylinder that slips, with the moment of the friction and the stretch: derivatives against differences, limits.
#include "windlass/rod/coupled_line_arc.hpp"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <tuple>

#include "gathered.hpp"
#include "windlass/obstacle/cylinder.hpp"
#include "windlass/rod/dragged_line_arc.hpp"
#include "windlass/rod/line_contact.hpp"

namespace {

using namespace windlass;
using Eigen::MatrixXd;
using Eigen::VectorXd;

const rod::SurfaceDensity coupled_density{1.2, 0.7};

/// The arc with its unknowns in one list: interior, q_a, q_b, n, ℓ, ω, nothing; q with the force at the end.
struct Coupled {
  rod::CoupledLineArc arc{coupled_density, {0.0, 0.3, 0.45, 1.0}, 4};
  VectorXd z{arc.interior_tangent() + arc.ends()};
  double friction = 0.4, radius = 0.3, compliance = 0.0;

  /// @param tilt  of the arc: its sign is that of the lever, where the rod does not run along itself
  explicit Coupled(double tilt, double travel, double bend = 0.4) {
    const int nodes = arc.interior_nodes() + 2;
    for (int k = 0; k < nodes; ++k) {
      const double s = static_cast<double>(k) / (nodes - 1);
      z(place(k, nodes)) = tilt + bend * (s - 0.5) + 0.05 * std::sin(3.0 * s);
      z(place(k, nodes) + 1) = 0.3 * std::cos(2.0 * s) - 0.2 * s;
    }
    const int inner = arc.interior_tangent();
    z(inner + 2) = 0.17, z(inner + 5) = 0.23;
    z.tail(5) << 1.8, 0.3, 1.3, travel, 0.0;
  }
  int place(int k, int nodes) const {
    return k == 0 ? arc.interior_tangent() : k + 1 == nodes ? arc.interior_tangent() + 3 : 2 * (k - 1);
  }
  bvp::ArcPoint point(const VectorXd& at) const {
    const double* ends = at.data() + arc.interior_tangent();
    return {ends, ends + 3, at.data(), ends + 6, ends[8], friction, ends[9], compliance, nullptr, radius};
  }
  VectorXd gradient(const VectorXd& at) const { return test::gathered_gradient(arc, point(at), z.size()); }
  MatrixXd matrix() const { return test::gathered_hessian(arc, point(z), z.size()); }
};

}  // namespace

BOOST_AUTO_TEST_SUITE(coupled_line_arc)

BOOST_AUTO_TEST_CASE(matrix_is_the_derivative_of_the_gradient) {
  constexpr double h = 1e-5,
                   bound = 2e-7;  // third derivatives are some 100 where layers are as short as here
  // With the moment of the friction, the stretch, and both.
  for (const auto& [radius, compliance] : {std::pair(0.3, 0.0), std::pair(0.0, 0.3), std::pair(0.2, 0.1)})
    // The pressure flows leftward, rightward, from both ends, from the middle.
    for (const auto& [tilt, travel, bend] : {std::tuple(0.5, 0.0, 0.4), std::tuple(-0.5, 0.0, 0.4),
                                             std::tuple(0.3, 0.3, 0.4), std::tuple(0.3, 0.3, -0.4)}) {
      Coupled f(tilt, travel, bend);
      f.radius = radius, f.compliance = compliance;
      const MatrixXd matrix = f.matrix();
      for (Eigen::Index k = 0; k < f.z.size(); ++k) {
        VectorXd up = f.z, down = f.z;
        up(k) += h, down(k) -= h;
        const VectorXd difference = (f.gradient(up) - f.gradient(down)) / (2.0 * h) - matrix.col(k);
        BOOST_TEST(difference.cwiseAbs().maxCoeff() < bound, "r " << radius << " k " << compliance
                                                                  << " column " << k << " off by "
                                                                  << difference.cwiseAbs().maxCoeff());
      }
    }
}

BOOST_AUTO_TEST_CASE(without_an_arm_it_is_the_line_without_moment) {
  Coupled f(0.5, 0.2);
  f.radius = 0.0;
  const rod::DraggedLineArc plain(coupled_density, f.arc.mesh(), 4);
  const int inner = f.arc.interior_tangent();
  VectorXd interior(inner), plain_interior(inner);
  bvp::EndsVector ends, plain_ends;
  const bvp::ArcPoint at = f.point(f.z);
  f.arc.gradient(at, interior.data(), ends);
  plain.gradient(at, plain_interior.data(), plain_ends);
  constexpr double rounding = 1e-13;
  BOOST_TEST((interior - plain_interior).norm() < rounding);
  BOOST_TEST((ends.head<2>() - plain_ends.head<2>()).norm() < rounding);
  BOOST_TEST((ends.segment<2>(3) - plain_ends.segment<2>(2)).norm() < rounding);
  BOOST_TEST((ends.segment<2>(6) - plain_ends.segment<2>(4)).norm() < rounding);
  BOOST_TEST((ends.tail<2>() - plain_ends.tail<2>()).norm() < rounding);
}

BOOST_AUTO_TEST_CASE(a_section_without_friction_is_that_of_a_line_contact) {
  const Eigen::Vector2d momentum(0.4, -0.15), n(1.7, 0.3);
  for (const double compliance : {0.0, 0.2}) {
    rod::Material material;
    material.bending_stiffness = coupled_density.bending_stiffness;
    material.stiffness << 1.2, 1.2, 0.7;
    material.compliance = compliance;
    material.stretches = true;
    const rod::LineSection known =
        rod::line_section(*obstacle::unit_cylinder(), material, {0.35, 0.2}, momentum, n);
    const rod::LayeredSection at =
        rod::LayeredSection::with_momentum(coupled_density, {0.4, 0.2, compliance, 0.3}, 0.35, momentum, n);
    constexpr double rounding = 1e-14;
    BOOST_TEST(std::abs(at.pressure.value - known.pressure) < rounding);
    BOOST_TEST(std::abs(at.normal.value - known.n(0)) < rounding);
    BOOST_TEST(std::abs(at.stretch.value - material.stretch(known.n(2))) < rounding);
  }
}

BOOST_AUTO_TEST_CASE(pressure_balances_the_force_along_the_normal) {
  // n·N = ν − w p falls by p less the hoop part along any motion that the friction drives: α is what it changes of ν.
  const rod::Friction friction{0.4, 0.2, 0.3, 0.25};
  const Eigen::Vector2d momentum(0.4, -0.15), n(1.7, 0.3);
  const rod::LayeredSection at =
      rod::LayeredSection::with_momentum(coupled_density, friction, 0.35, momentum, n);
  constexpr double h = 1e-5;
  const auto normal = [&](double p) {
    const rod::LayeredSection there = rod::LayeredSection::with_momentum(
        coupled_density, friction, 0.35, momentum - Eigen::Vector2d(0.0, at.across.value * p),
        n - p * Eigen::Vector2d(at.drag[0].value, at.drag[1].value));
    return there.normal.value;
  };
  BOOST_TEST(std::abs((normal(-h) - normal(h)) / (2.0 * h) - at.share.value) < 1e-9);
}

BOOST_AUTO_TEST_SUITE_END()
