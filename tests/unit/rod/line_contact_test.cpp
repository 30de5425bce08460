// Forces on a rod that lies on an obstacle, against the balance of forces and moments along it.
#include "windlass/rod/line_contact.hpp"

#include <boost/test/unit_test.hpp>
#include <cmath>

#include "windlass/obstacle/cylinder.hpp"
#include "windlass/obstacle/plane.hpp"
#include "windlass/verify/rod_flow.hpp"

namespace {

using namespace windlass;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// A section of the rod: place, configuration, momenta.
struct At {
  Vector2d u, q, momentum;
};

/// In the world: frame (N, t × N, t), n, m.
struct World {
  Matrix3d darboux;
  Vector3d n, m;
  double pressure;
};

struct Rod {
  const obstacle::Surface& surface;
  rod::Material material;
  Vector2d n;

  World world(const At& at) const {
    const obstacle::Chart here = surface.chart(at.u);
    const double c = std::cos(at.q(0)), s = std::sin(at.q(0));
    World out;
    out.darboux << here.normal, here.tangents * Vector2d(s, -c), here.tangents * Vector2d(c, s);
    const rod::LineSection section = rod::line_section(surface, material, at.q, at.momentum, n);
    out.n = out.darboux * section.n, out.m = out.darboux * section.m, out.pressure = section.pressure;
    return out;
  }

  /// Moves along the rod by Hamilton's equations of its density, from the balances about N and t and the material law.
  At rate(const At& at) const {
    const World w = world(at);
    const double k = surface.curvature(), c = std::cos(at.q(0)), s = std::sin(at.q(0));
    const Matrix3d body = w.darboux * Eigen::AngleAxisd(at.q(1), Vector3d::UnitZ()).toRotationMatrix();
    const Vector3d strain = (body.transpose() * w.m).cwiseQuotient(material.stiffness) + material.natural;
    const Vector3d turn =
        body * strain;  // of the material frame; that of the Darboux frame differs by χ' about t
    const Vector3d normal = w.darboux.col(0), t = w.darboux.col(2);
    const double geodesic = turn.dot(normal), torsion = k * s * c;
    const Vector3d darboux_turn = geodesic * normal - k * c * c * w.darboux.col(1) + torsion * t;
    const Vector3d m_rate = -t.cross(w.n);
    At out;
    out.u = {c, s};
    out.q = {geodesic, turn.dot(t) - torsion};
    out.momentum = {m_rate.dot(normal) + w.m.dot(darboux_turn.cross(normal)),
                    m_rate.dot(t) + w.m.dot(darboux_turn.cross(t))};
    return out;
  }

  At moved(const At& from, double h) const {  // Runge and Kutta
    const auto plus = [](const At& a, double f, const At& b) {
      return At{a.u + f * b.u, a.q + f * b.q, a.momentum + f * b.momentum};
    };
    const At a = rate(from), b = rate(plus(from, 0.5 * h, a)), c = rate(plus(from, 0.5 * h, b)),
             d = rate(plus(from, h, c));
    return plus(plus(plus(plus(from, h / 6, a), h / 3, b), h / 3, c), h / 6, d);
  }
};

void check_balance(const Rod& rod, const At& at) {
  constexpr double h = 1e-4;      // central differences: h²,
  constexpr double bound = 1e-7;  // quantities of order one
  const World here = rod.world(at), after = rod.world(rod.moved(at, h)),
              before = rod.world(rod.moved(at, -h));
  const Vector3d normal = here.darboux.col(0), t = here.darboux.col(2);
  BOOST_TEST(((after.n - before.n) / (2 * h) + here.pressure * normal).norm() < bound);
  BOOST_TEST(((after.m - before.m) / (2 * h) + t.cross(here.n)).norm() < bound);
}

}  // namespace

BOOST_AUTO_TEST_SUITE(line_contacts)

BOOST_AUTO_TEST_CASE(forces_balance_along_the_rod) {
  const At at{{0.4, 0.1}, {0.3, 0.5}, {0.7, -0.4}};
  check_balance({*obstacle::unit_cylinder(), {1.2, {1.2, 1.2, 0.7}, Vector3d::Zero()}, {0.9, -0.5}}, at);
  const obstacle::Plane plane({0.3, -0.5, 0.8}, 0.7);
  check_balance({plane, {1.2, {1.2, 1.2, 0.7}, Vector3d::Zero()}, {0.9, -0.5}}, at);
  check_balance({plane, {1.2, {2.1, 1.2, 0.7}, {0.2, -0.3, 0.4}}, {0.9, -0.5}}, at);
}

BOOST_AUTO_TEST_CASE(an_untwisted_rod_presses_on_no_plane) {
  const obstacle::Plane plane({0.0, 1.0, 0.0}, 0.1);
  const rod::LineSection at =
      rod::line_section(plane, {1.0, {1.0, 1.0, 0.7}, Vector3d::Zero()}, {0.3, 0.0}, {0.8, 0.0}, {-2.0, 0.4});
  BOOST_TEST(at.pressure == 0.0);
}

BOOST_AUTO_TEST_CASE(conserved_forces_come_back_from_the_world) {
  const At at{{0.4, 0.1}, {0.3, 0.5}, {0.7, -0.4}};
  const obstacle::Plane plane({0.3, -0.5, 0.8}, 0.7);
  const obstacle::Surface* surfaces[] = {obstacle::unit_cylinder().get(), &plane};
  for (const obstacle::Surface* surface : surfaces) {
    const Rod rod{*surface, {1.2, {1.2, 1.2, 0.7}, Vector3d::Zero()}, {0.9, -0.5}};
    const World w = rod.world(at);
    BOOST_TEST((rod::line_forces(*surface, at.u, surface->chart(at.u).r, w.n, w.m) - rod.n).norm() < 1e-14);
  }
}

BOOST_AUTO_TEST_CASE(margin_against_buckling_off) {
  const obstacle::Plane plane({0.0, 1.0, 0.0}, 0.1);
  const rod::Material strip{1.0, {20.0, 1.0, 0.7}, Vector3d::Zero()};
  const double critical = 4.0 * M_PI * M_PI / 0.09;  // of a clamped rod of length 0.3
  BOOST_TEST(std::abs(rod::buckling_margin(plane, strip, 0.0, -critical, 0.3).value()) < 1e-14);
  BOOST_TEST(rod::buckling_margin(plane, strip, 0.5 * M_PI, -critical, 0.3).value() == 0.95,
             boost::test_tools::tolerance(1e-13));  // on its edge 20 times as stiff
  BOOST_TEST(!rod::buckling_margin(*obstacle::unit_cylinder(), strip, 0.0, -critical, 0.3));
}

BOOST_AUTO_TEST_CASE(where_the_rod_stretches_or_weighs_the_pressure_is_that_of_the_certificate) {
  // Its formulas know the constraint and the balances in space only.
  scene::Rod rod;
  rod.twist_ratio = 0.7;
  rod.extensible = true;
  rod.axial_stiffness = 5.0;
  const obstacle::Plane wall({0.3, 1.0, -0.2}, 0.4);
  const obstacle::Cylinder cylinder;
  for (const obstacle::Surface* surface :
       {static_cast<const obstacle::Surface*>(&cylinder), static_cast<const obstacle::Surface*>(&wall)}) {
    const bool flat = surface->curvature() == 0.0;
    if (flat) rod.weight = {0.2, -0.5, 0.3};
    rod::Material material{1.0, {1.0, 1.0, 0.7}, Vector3d::Zero()};
    material.compliance = rod.compliance();
    material.weight = Vector3d(rod.weight[0], rod.weight[1], rod.weight[2]);
    const Rod section{*surface, material, {0.9, 0.4}};
    for (const double psi : {-0.4, 0.1, 0.7}) {
      const At at{{0.5, 0.2}, {psi, 0.3}, {0.6, -0.25}};
      const World w = section.world(at);
      const Eigen::Quaterniond q(w.darboux * Eigen::AngleAxisd(0.3, Vector3d::UnitZ()).toRotationMatrix());
      const verify::Section here{surface->chart(at.u).r, {q.w(), q.x(), q.y(), q.z()}, w.m, w.n};
      const verify::Stiffness law(rod);
      const double p = flat ? verify::plane_pressure(here, law, w.darboux.col(0))
                            : verify::stretched_surface_pressure(here, law);
      BOOST_TEST(w.pressure == p, boost::test_tools::tolerance(1e-11));
      if (!flat)  // ε = n·t/EA makes the curvature of the line what the moment says
        BOOST_TEST(-w.m.dot(w.darboux.col(1)) == law.stretch(here) * std::pow(std::cos(psi), 2),
                   boost::test_tools::tolerance(1e-13));
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
