// First and second derivatives of the Lagrangian densities against differences.
#include <boost/test/unit_test.hpp>

#include "windlass/rod/extensible_density.hpp"
#include "windlass/rod/kirchhoff_density.hpp"
#include "windlass/rod/planar_density.hpp"
#include "windlass/rod/plane_density.hpp"
#include "windlass/rod/surface_density.hpp"

namespace {

using namespace windlass;

/// Checks L's gradient and Hessian in z = (q, q'), and d = −∂L/∂n with its derivative, at some points.
template <class Density>
void check(const Density& density) {
  constexpr int a = Density::ambient, p = Density::forces;
  using Z = Eigen::Matrix<double, 2 * a, 1>;
  using Q = Eigen::Matrix<double, a, 1>;
  using N = Eigen::Matrix<double, p, 1>;
  constexpr double h = 1e-5, bound = 1e-8;  // central differences: h² and 1e-16/h, entries of order one
  std::srand(11);
  for (int sample = 0; sample < 5; ++sample) {
    const Z z = Z::Random() + Z::Unit(0) * (a == 4 ? 1.5 : 0.0);  // quaternions of any length but zero
    const N n = N::Random();
    const auto first = [&](const Z& at, N& d) {
      Z g;
      const double value = density.first(Q(at.template head<a>()), Q(at.template tail<a>()), n, g, d);
      return std::pair<double, Z>(value, g);
    };
    N d, unused;
    Z g;
    Eigen::Matrix<double, 2 * a, 2 * a> hessian;
    Eigen::Matrix<double, p, a> dd;
    density.second(Q(z.template head<a>()), Q(z.template tail<a>()), n, g, hessian, d, dd);
    BOOST_TEST((g - first(z, unused).second).norm() < 1e-14 * (1.0 + g.norm()));
    BOOST_TEST((d - density.direction(Q(z.template head<a>()))).norm() < 1e-14);
    for (int k = 0; k < 2 * a; ++k) {
      N d_up, d_down;
      const auto up = first(z + h * Z::Unit(k), d_up), down = first(z - h * Z::Unit(k), d_down);
      const double scale = 1.0 + hessian.norm();
      BOOST_TEST(std::abs((up.first - down.first) / (2.0 * h) - g(k)) < bound * scale);
      BOOST_TEST(((up.second - down.second) / (2.0 * h) - hessian.col(k)).norm() < 10.0 * bound * scale);
      if (k < a) BOOST_TEST(((d_up - d_down) / (2.0 * h) - dd.col(k)).norm() < bound * scale);
    }
  }
}

/// The same of a density that stretches, with ∂d/∂q' and ∂d/∂n, too.
template <class Density>
void check_stretching(const Density& density) {
  constexpr int a = Density::ambient, p = Density::forces;
  using Z = Eigen::Matrix<double, 2 * a, 1>;
  using Q = Eigen::Matrix<double, a, 1>;
  using N = Eigen::Matrix<double, p, 1>;
  constexpr double h = 1e-5, bound = 1e-8, k = 0.3;  // as above; EA = 3.3, stretches of some 30 %
  std::srand(13);
  for (int sample = 0; sample < 5; ++sample) {
    const Z z = Z::Random() + Z::Unit(0) * (a == 4 ? 1.5 : 0.0);
    const N n = N::Random();
    const auto first = [&](const Z& at, const N& force, Z& g, N& d) {
      return density.first(Q(at.template head<a>()), Q(at.template tail<a>()), force, k, g, d);
    };
    Z g, g_up, g_down;
    N d, d_up, d_down;
    Eigen::Matrix<double, 2 * a, 2 * a> hessian;
    Eigen::Matrix<double, p, a> d_q, d_slope;
    Eigen::Matrix<double, p, p> d_n;
    density.second(Q(z.template head<a>()), Q(z.template tail<a>()), n, k, g, hessian, d, d_q, d_slope, d_n);
    const double scale = 1.0 + hessian.norm();
    for (int i = 0; i < 2 * a; ++i) {
      const double up = first(z + h * Z::Unit(i), n, g_up, d_up),
                   down = first(z - h * Z::Unit(i), n, g_down, d_down);
      BOOST_TEST(std::abs((up - down) / (2.0 * h) - g(i)) < bound * scale);
      BOOST_TEST(((g_up - g_down) / (2.0 * h) - hessian.col(i)).norm() < 10.0 * bound * scale);
      BOOST_TEST(((d_up - d_down) / (2.0 * h) - (i < a ? d_q.col(i) : d_slope.col(i - a))).norm() <
                 bound * scale);
    }
    for (int i = 0; i < p; ++i) {
      const double up = first(z, n + h * N::Unit(i), g_up, d_up),
                   down = first(z, n - h * N::Unit(i), g_down, d_down);
      BOOST_TEST(std::abs((up - down) / (2.0 * h) + d(i)) < bound * scale);
      BOOST_TEST(((d_up - d_down) / (2.0 * h) - d_n.col(i)).norm() < bound * scale);
    }
    // L is W − n·r' with the stretch's own energy in W.
    const double w = density.elastic(Q(z.template head<a>()), Q(z.template tail<a>()), n, k);
    BOOST_TEST(first(z, n, g, d) == w - n.dot(d), boost::test_tools::tolerance(1e-12));
  }
}

}  // namespace

BOOST_AUTO_TEST_SUITE(densities)

BOOST_AUTO_TEST_CASE(stretching) {
  check_stretching(rod::Extensible<rod::PlanarDensity>{{1.3, 0.2}});
  check_stretching(rod::Extensible<rod::SurfaceDensity>{{1.2, 0.7}});
  check_stretching(rod::Extensible<rod::PlaneDensity>{{{1.0, 1.4, 0.6}, {0.2, -0.1, 0.3}}});
  check_stretching(rod::Extensible<rod::KirchhoffDensity>{{{1.0, 1.4, 0.6}, {0.2, -0.1, 0.3}}});
}

BOOST_AUTO_TEST_CASE(without_compliance_the_stretching_densities_are_the_others) {
  const Eigen::Vector2d q(0.4, 0.1), slope(0.3, 0.2), n(0.9, -0.4);
  const rod::SurfaceDensity rigid{1.2, 0.7};
  Eigen::Vector4d g, g_rigid;
  Eigen::Vector2d d, d_rigid;
  const double value = rod::Extensible<rod::SurfaceDensity>{rigid}.first(q, slope, n, 0.0, g, d);
  BOOST_TEST(value == rigid.first(q, slope, n, g_rigid, d_rigid), boost::test_tools::tolerance(1e-14));
  BOOST_TEST((g - g_rigid).norm() < 1e-14);
  BOOST_TEST((d - d_rigid).norm() < 1e-14);
}

BOOST_AUTO_TEST_CASE(planar) { check(rod::PlanarDensity{1.3}); }
BOOST_AUTO_TEST_CASE(surface) { check(rod::SurfaceDensity{1.2, 0.7}); }
BOOST_AUTO_TEST_CASE(plane) { check(rod::PlaneDensity{{1.0, 1.4, 0.6}, {0.2, -0.1, 0.3}}); }
BOOST_AUTO_TEST_CASE(kirchhoff) { check(rod::KirchhoffDensity{{1.0, 1.4, 0.6}, {0.2, -0.1, 0.3}}); }

BOOST_AUTO_TEST_CASE(kirchhoff_in_the_plane_is_the_planar_density) {
  const rod::KirchhoffDensity spatial;
  const rod::PlanarDensity planar;
  for (const double theta : {0.3, 2.0}) {
    const double slope = 0.7;
    // Frame turned by θ about e_z from d3 = e_x; q' = ½ slope (0, e_z) ⊗ q.
    const rod::Quaternion base = rod::rotation(Eigen::Vector3d::UnitY(), 0.5 * M_PI);
    const rod::Quaternion q = rod::product(rod::rotation(Eigen::Vector3d::UnitZ(), theta), base);
    const rod::Quaternion dq = 0.5 * slope * rod::product(rod::Quaternion(0.0, 0.0, 0.0, 1.0), q);
    rod::KirchhoffDensity::Vector8 g;
    Eigen::Vector3d d;
    Eigen::Vector2d g2, d2;
    const double lagrangian = spatial.first(q, dq, {0.4, -0.9, 0.0}, g, d);
    using Scalar = rod::PlanarDensity::Scalar;
    BOOST_TEST(lagrangian == planar.first(Scalar(theta), Scalar(slope), {0.4, -0.9}, g2, d2),
               boost::test_tools::tolerance(1e-13));
    BOOST_TEST((d.head<2>() - d2).norm() < 1e-14);
  }
}

BOOST_AUTO_TEST_CASE(a_rod_on_a_plane_is_that_of_the_kirchhoff_density) {
  // Frame Rz(ψ) Q₀ R₃(χ) on the plane z = 0 with N = e_z, d₃ = e_x; its slope by ψ' and χ'.
  const Eigen::Vector3d stiffness(1.0, 1.4, 0.6), natural(0.2, -0.1, 0.3);
  const rod::PlaneDensity plane{stiffness, natural};
  const rod::KirchhoffDensity spatial{stiffness, natural};
  const rod::Quaternion base(0.5, -0.5, -0.5, -0.5);
  const Eigen::Matrix3d d = rod::directors(base);
  BOOST_TEST_REQUIRE((d.col(2).squaredNorm() - 1.0) < 1e-15);
  const Eigen::Vector3d normal = d.col(0);
  const auto frame = [&](double psi, double chi) {
    return rod::product(rod::product(rod::rotation(normal, psi), base),
                        rod::rotation(Eigen::Vector3d::UnitZ(), chi));
  };
  const Eigen::Vector2d q(0.4, 0.7), slope(0.9, -0.3);
  constexpr double h = 1e-6;  // of differences: h², 1e-16/h
  const rod::Quaternion rate =
      (frame(q(0) + h * slope(0), q(1) + h * slope(1)) - frame(q(0) - h * slope(0), q(1) - h * slope(1))) /
      (2 * h);
  BOOST_TEST(plane.elastic(q, slope) == spatial.elastic(frame(q(0), q(1)), rate),
             boost::test_tools::tolerance(1e-9));
}

BOOST_AUTO_TEST_CASE(a_helix_on_the_cylinder_is_that_of_the_kirchhoff_density) {
  // Inclination ψ, no slope: curvature cos²ψ, twist sin ψ cos ψ.
  const rod::SurfaceDensity surface{1.0, 0.6};
  const Eigen::Vector2d q(0.4, 0.1), slope(0.0, 0.2);
  const double c = std::cos(0.4), s = std::sin(0.4), twist = 0.2 + s * c;
  BOOST_TEST(surface.elastic(q, slope) == 0.5 * c * c * c * c + 0.3 * twist * twist,
             boost::test_tools::tolerance(1e-14));
}

BOOST_AUTO_TEST_SUITE_END()
