// The line contact on cylinder and plate: its matrix against differences of its gradient, its energy.
#include "windlass/rod/plate_line_arc.hpp"

#include <boost/test/unit_test.hpp>

using namespace windlass;

BOOST_AUTO_TEST_SUITE(plate_line_arc)

BOOST_AUTO_TEST_CASE(matrix_is_the_derivative_of_the_gradient) {
  constexpr double h = 1e-5, bound = 1e-9;
  rod::PlateLineArc arc(1.2, 0.7);
  for (const double compliance : {0.0, 0.1}) {
    // χ_a, χ_b, n, ℓ, ω
    const Eigen::Matrix<double, 5, 1> z =
        (Eigen::Matrix<double, 5, 1>() << 0.2, 0.9, 2.1, 1.7, 0.3).finished();
    const auto point = [compliance](const Eigen::Matrix<double, 5, 1>& at) {
      return bvp::ArcPoint{at.data(), at.data() + 1, nullptr, at.data() + 2, at(3), 0.4, at(4), compliance};
    };
    const auto gradient = [&](const Eigen::Matrix<double, 5, 1>& at) {
      bvp::EndsVector g;
      arc.gradient(point(at), nullptr, g);
      return g;
    };
    bvp::EndsMatrix matrix;
    arc.factor(point(z), matrix);
    for (int k = 0; k < 5; ++k) {
      const auto step = Eigen::Matrix<double, 5, 1>::Unit(k) * h;
      const bvp::EndsVector change = (gradient(z + step) - gradient(z - step)) / (2.0 * h);
      BOOST_TEST((change - bvp::EndsVector(matrix.col(k))).cwiseAbs().maxCoeff() < bound, "column " << k);
    }
    const bvp::ArcSamples samples = arc.sample(point(z));
    // n_a' = −mu p d_θ from one end to the other is what the gradient says.
    BOOST_TEST(std::abs(samples.force(0, samples.force.cols() - 1) - samples.force(0, 0) - gradient(z)(4)) <
               1e-14);
    BOOST_TEST(std::abs(samples.displacement(0, samples.displacement.cols() - 1) + gradient(z)(2)) < 1e-14);
  }
}

BOOST_AUTO_TEST_CASE(energy_of_a_rod_that_stretches_is_that_of_its_action) {
  // S = E − n·X and ∂S/∂n = −X: E = S − n ∂S/∂n; S is homogeneous in ℓ at the same twist a length, here none.
  constexpr double k = 0.1, n = 2.1, length = 1.7, none = 0.0;
  rod::PlateLineArc arc(1.2, 0.7);
  const bvp::ArcPoint at{&none, &none, nullptr, &n, length, 0.4, 0.0, k};
  bvp::EndsVector g;
  arc.gradient(at, nullptr, g);
  BOOST_TEST(std::abs(arc.energy(at) - (g(3) * length - n * g(2))) < 1e-14);
}

BOOST_AUTO_TEST_SUITE_END()
