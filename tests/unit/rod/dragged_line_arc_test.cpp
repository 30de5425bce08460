// The line contact on a cylinder that slips: derivatives against differences, condensation against dense algebra.
#include "windlass/rod/dragged_line_arc.hpp"

#include <boost/test/unit_test.hpp>
#include <cmath>

#include "gathered.hpp"
#include "windlass/bvp/collocation_arc.hpp"

namespace {

using namespace windlass;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

const rod::SurfaceDensity density{1.2, 0.7};

/// The arc with its unknowns in one list: interior, q_a, q_b, n, ℓ, ω, nothing.
struct Fixture {
  rod::DraggedLineArc arc{density, {0.0, 0.3, 0.45, 1.0}, 4};
  VectorXd z{arc.interior_tangent() + arc.ends()};

  Fixture() {
    const int nodes = arc.interior_nodes() + 2;
    for (int k = 0; k < nodes; ++k)
      for (int j = 0; j < 2; ++j) {
        const double s = static_cast<double>(k) / (nodes - 1);
        z(place(k, nodes) + j) = 0.4 * std::sin(1.5 * s + j) - 0.2 * j * s;
      }
    z.tail(5) << 1.8, 0.3, 1.3, 0.2, 0.0;
  }
  int place(int k, int nodes) const {
    return k == 0 ? arc.interior_tangent() : k + 1 == nodes ? arc.interior_tangent() + 2 : 2 * (k - 1);
  }
  bvp::ArcPoint point(const VectorXd& at) const {
    const double* ends = at.data() + arc.interior_tangent();
    return {ends, ends + 2, at.data(), ends + 4, ends[6], 0.4, ends[7]};
  }
  VectorXd gradient(const VectorXd& at) const { return test::gathered_gradient(arc, point(at), z.size()); }
  MatrixXd matrix() const { return test::gathered_hessian(arc, point(z), z.size()); }
};

}  // namespace

BOOST_AUTO_TEST_SUITE(dragged_line_arc)

BOOST_AUTO_TEST_CASE(pressure_is_that_of_a_line_section) {
  constexpr double h = 1e-5, bound = 1e-8;
  const Vector2d q(0.3, 0.5), slope(0.2, -0.4), n(1.7, 0.4);
  const rod::LinePressure here = rod::line_pressure(density, q, slope, n);
  for (int k = 0; k < 4; ++k) {
    const auto at = [&](double by) {
      Vector2d a = q, b = slope;
      (k < 2 ? a(k) : b(k - 2)) += by;
      return rod::line_pressure(density, a, b, n).p;
    };
    BOOST_TEST(std::abs((at(h) - at(-h)) / (2.0 * h) - here.by_z(k)) < bound);
  }
  for (int k = 0; k < 2; ++k)
    BOOST_TEST(std::abs(rod::line_pressure(density, q, slope, n + Vector2d::Unit(k)).p - here.p -
                        here.by_n(k)) < 1e-13);
}

BOOST_AUTO_TEST_CASE(slip_has_unit_size_and_is_differentiated) {
  constexpr double h = 1e-5, bound = 1e-9;
  const rod::Slip here = rod::slip(0.4, 0.3);
  BOOST_TEST(std::abs(here.d.norm() - 1.0) < 1e-15);
  BOOST_TEST(((rod::slip(0.4 + h, 0.3).d - rod::slip(0.4 - h, 0.3).d) / (2.0 * h) - here.by_psi).norm() <
             bound);
  BOOST_TEST(((rod::slip(0.4, 0.3 + h).d - rod::slip(0.4, 0.3 - h).d) / (2.0 * h) - here.by_travel).norm() <
             bound);
}

BOOST_AUTO_TEST_CASE(matrix_is_the_derivative_of_the_gradient) {
  constexpr double h = 1e-5, bound = 2e-8;
  const Fixture f;
  const MatrixXd matrix = f.matrix();
  const int length = f.arc.interior_tangent() + f.arc.length_end();
  for (Eigen::Index k = 0; k < f.z.size(); ++k) {
    VectorXd up = f.z, down = f.z;
    up(k) += h, down(k) -= h;
    VectorXd difference = (f.gradient(up) - f.gradient(down)) / (2.0 * h) - matrix.col(k);
    BOOST_TEST(difference.cwiseAbs().maxCoeff() < bound, "column " << k);
  }
  BOOST_TEST(matrix.row(length).norm() == 0.0);  // nothing is conjugate to the length
}

BOOST_AUTO_TEST_CASE(condensation_is_elimination) {
  constexpr double rounding = 1e-10;
  Fixture f;
  const int in = f.arc.interior_tangent(), out = f.arc.ends();
  const MatrixXd k = f.matrix();
  bvp::EndsMatrix condensed;
  f.arc.factor(f.point(f.z), condensed);
  const MatrixXd inverse = k.topLeftCorner(in, in).inverse();
  const MatrixXd right = inverse * k.topRightCorner(in, out), left = k.bottomLeftCorner(out, in);
  BOOST_TEST((k.bottomRightCorner(out, out) - left * right - condensed).norm() < rounding);
  const VectorXd rhs = VectorXd::LinSpaced(in, -1.0, 2.0), ends = VectorXd::LinSpaced(out, 0.3, -0.7);
  VectorXd x = rhs;
  bvp::EndsVector reduced = bvp::EndsVector::Zero(out);
  f.arc.reduce(x.data(), reduced);
  BOOST_TEST((reduced + left * inverse * rhs).norm() < rounding);
  f.arc.expand(x.data(), ends);
  BOOST_TEST((x - (inverse * rhs - right * ends)).norm() < rounding);
  x = rhs;
  reduced.setZero();
  f.arc.reduce_transposed(x.data(), reduced);
  BOOST_TEST((reduced + right.transpose() * rhs).norm() < rounding);
  f.arc.expand_transposed(x.data(), ends);
  BOOST_TEST((x - inverse.transpose() * (rhs - left.transpose() * ends)).norm() < rounding);
}

BOOST_AUTO_TEST_CASE(without_friction_the_forces_are_conserved) {
  const Fixture f;
  bvp::ArcPoint at = f.point(f.z);
  at.friction = 0.0;
  VectorXd interior(f.arc.interior_tangent()), still_interior = interior;
  bvp::EndsVector ends, still_ends;
  f.arc.gradient(at, interior.data(), ends);
  bvp::make_collocation_arc(density, f.arc.mesh(), 4)->gradient(at, still_interior.data(), still_ends);
  BOOST_TEST((interior - still_interior).norm() < 1e-13);
  BOOST_TEST((ends.head(6) - still_ends.head(6)).norm() < 1e-13);
  BOOST_TEST(ends.tail(2).norm() == 0.0);
}

BOOST_AUTO_TEST_SUITE_END()
