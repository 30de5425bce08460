// Closed forms against balance of forces, quadrature and differences.
#include "windlass/rod/closed_form_arcs.hpp"

#include <boost/test/unit_test.hpp>
#include <cmath>

#include "windlass/rod/capstan.hpp"
#include "windlass/rod/quaternion.hpp"

namespace {

using namespace windlass::rod;
using windlass::bvp::ArcPoint;
using windlass::bvp::EndsMatrix;
using windlass::bvp::EndsVector;

/// Frame whose tangent makes the angle θ with e_x in the plane.
Quaternion frame(double theta) {
  return product(rotation(Eigen::Vector3d::UnitZ(), theta), rotation(Eigen::Vector3d::UnitY(), 0.5 * M_PI));
}

}  // namespace

BOOST_AUTO_TEST_SUITE(closed_forms)

BOOST_AUTO_TEST_CASE(contact_forces_balance_the_pulls) {
  for (const double phi : {0.5 * M_PI, M_PI, 2.0 * M_PI, 4.0 * M_PI})
    for (const double tension : {2.0, 5.0, 100.0}) {
      using namespace capstan;
      const double contact = phi_star(tension, phi);
      const double along_y =
          2.0 * pressure(tension) * std::sin(contact) + 2.0 * edge_force(tension) * std::cos(contact);
      BOOST_TEST(std::abs(along_y - 2.0 * tension * std::sin(0.5 * phi)) < 1e-12 * tension);
      BOOST_TEST(std::abs(total_force(tension, phi) -
                          2.0 * (pressure(tension) * contact + edge_force(tension))) < 1e-12 * tension);
      const double h = 1e-5;  // of log T
      const double slope =
          std::log(total_force(tension * std::exp(h), phi) / total_force(tension * std::exp(-h), phi)) /
          (2.0 * h);
      BOOST_TEST(log_slope(tension, phi) == slope, boost::test_tools::tolerance(1e-8));
    }
}

BOOST_AUTO_TEST_CASE(the_tail_is_the_pendulums_separatrix) {
  const double tension = 1.7, h = 1e-4;
  BOOST_TEST(capstan::tail_angle(tension, 0.0) == capstan::beta(tension),
             boost::test_tools::tolerance(1e-14));
  for (const double d : {0.3, 1.0, 2.5}) {
    const double psi = capstan::tail_angle(tension, d);
    const double bend =
        (capstan::tail_angle(tension, d + h) - 2.0 * psi + capstan::tail_angle(tension, d - h)) / (h * h);
    BOOST_TEST(bend == tension * std::sin(psi), boost::test_tools::tolerance(1e-6));  // h² and 1e-16/h²
  }
}

BOOST_AUTO_TEST_CASE(an_infinite_tails_action_moment_and_curvature) {
  const double stiffness = 1.3, theta = 0.9;
  const Eigen::Vector2d n(0.8, -0.4);
  const double psi = std::atan2(n(1), n(0)) - theta, tension = n.norm();
  TailArc planar(2, stiffness), spatial(3, stiffness);
  const double q[1] = {theta};
  const ArcPoint at{q, q, nullptr, n.data(), 1.0};
  // Energy by quadrature of ½ B θ'² along the separatrix, θ' = 2 √(T/B) sin(ψ/2).
  double energy = 0.0;
  const double rate = std::sqrt(tension / stiffness), step = 1e-3;
  for (double d = 0.5 * step; d < 40.0 / rate; d += step) {
    const double angle = 4.0 * std::atan(std::tan(0.25 * psi) * std::exp(-rate * d));
    energy += step * 2.0 * stiffness * rate * rate * std::pow(std::sin(0.5 * angle), 2);
  }
  BOOST_TEST(planar.energy(at) == energy, boost::test_tools::tolerance(1e-6));  // the midpoint rule's step²
  EndsVector g;
  planar.gradient(at, nullptr, g);
  BOOST_TEST(std::abs(g(0)) == 2.0 * std::sqrt(stiffness * tension) * std::abs(std::sin(0.5 * psi)),
             boost::test_tools::tolerance(1e-13));
  EndsMatrix h;
  planar.factor(at, h);
  constexpr double small = 1e-6;
  const double up[1] = {theta + small}, down[1] = {theta - small};
  EndsVector g_up, g_down;
  planar.gradient({up, up, nullptr, n.data(), 1.0}, nullptr, g_up);
  planar.gradient({down, down, nullptr, n.data(), 1.0}, nullptr, g_down);
  BOOST_TEST((EndsVector((g_up - g_down) / (2.0 * small)) - EndsVector(h.col(0))).norm() < 1e-8);

  // In space: the moment is about e_z, and its gradient ∓2 m in the body frame.
  const Quaternion frame_a = frame(theta);
  const Eigen::Vector3d n3(n(0), n(1), 0.0);
  EndsVector g3;
  spatial.gradient({frame_a.data(), frame_a.data(), nullptr, n3.data(), 1.0}, nullptr, g3);
  const Eigen::Vector3d moment = directors(frame_a) * (-0.5 * Eigen::Vector3d(g3.head<3>()));
  BOOST_TEST((moment - Eigen::Vector3d(0.0, 0.0, -g(0))).norm() < 1e-13);
}

BOOST_AUTO_TEST_CASE(a_tails_hessian_is_the_derivative_of_its_gradient) {
  const double stiffness = 1.3, length = 2.2;  // 1.9 decay lengths: the free end is felt
  const Eigen::Vector3d n(0.8, -0.4, 0.3);
  constexpr double small = 1e-5;
  for (const int dimension : {2, 3})
    for (const bool starts_here : {true, false})
      for (const auto end : {TailArc::End::infinite, TailArc::End::moment_free}) {
        TailArc tail(dimension, stiffness, starts_here, end);
        const int d = tail.tangent(), first = starts_here ? 0 : d, last = tail.ends() - 1;
        const double theta[1] = {1.4};
        const Quaternion q = product(rotation(Eigen::Vector3d(0.2, 0.9, -0.4).normalized(), 1.1), frame(0.5));
        const auto gradient_at = [&](const Eigen::VectorXd& step) {  // of the configuration and the length
          const double moved[1] = {theta[0] + step(0)};
          const Quaternion turned = dimension == 3 ? retract(q, step.head<3>()) : q;
          const double* at = dimension == 2 ? moved : turned.data();
          EndsVector g;
          tail.gradient({at, at, nullptr, n.data(), length + step(d)}, nullptr, g);
          Eigen::VectorXd out(d + 1);
          out << Eigen::VectorXd(g.segment(first, d)), g(last);
          return out;
        };
        const double* at = dimension == 2 ? theta : q.data();
        EndsMatrix h;
        tail.factor({at, at, nullptr, n.data(), length}, h);
        const Eigen::VectorXd g = gradient_at(Eigen::VectorXd::Zero(d + 1));
        for (int k = 0; k <= d; ++k) {
          Eigen::VectorXd step = Eigen::VectorXd::Zero(d + 1);
          step(k) = small;
          Eigen::VectorXd column = (gradient_at(step) - gradient_at(-step)) / (2.0 * small);
          // Increments of frames do not commute: the derivative of the gradient has the antisymmetric part g × as well.
          if (dimension == 3 && k < 3) {
            const Eigen::Vector3d moment = g.head<3>(), direction = step.head<3>() / small;
            column.head<3>() -= moment.cross(direction);
          }
          Eigen::VectorXd expected(d + 1);
          expected << Eigen::VectorXd(h.block(first, k < d ? first + k : last, d, 1)),
              h(last, k < d ? first + k : last);
          BOOST_TEST_CONTEXT("dimension " << dimension << ", starts here " << starts_here << ", direction "
                                          << k)
          BOOST_TEST((column - expected).lpNorm<Eigen::Infinity>() < 1e-8);  // small², rounding/small
        }
      }
}

BOOST_AUTO_TEST_CASE(a_free_tail_obeys_the_pendulum_and_ends_without_moment) {
  const double stiffness = 1.3, length = 3.0, theta[1] = {1.9};
  const Eigen::Vector2d n(0.8, -0.4);
  const double tension = n.norm(), pull = std::atan2(n(1), n(0));
  TailArc tail(2, stiffness, true, TailArc::End::moment_free);
  const ArcPoint at{theta, theta, nullptr, n.data(), length};
  const windlass::bvp::ArcSamples samples = tail.sample(at);
  const Eigen::Index count = samples.sigma.size();
  EndsVector g;
  tail.gradient(at, nullptr, g);
  BOOST_TEST(samples.momentum(0, 0) == -g(0), boost::test_tools::tolerance(1e-13));
  BOOST_TEST(std::abs(samples.momentum(0, count - 1)) < 1e-14);
  BOOST_TEST(samples.sigma(0) == 0.0);
  BOOST_TEST(samples.sigma(count - 1) == 1.0);
  double energy = 0.0;
  for (Eigen::Index k = 0; k < count; ++k) {
    const double psi = samples.q(0, k) - pull, m = samples.momentum(0, k);
    // The Hamiltonian, and the balance of moments m' = −(r' × n): m + r × n is constant.
    BOOST_TEST(std::abs(0.5 * m * m / stiffness + tension * std::cos(psi) + g(5 - 1)) < 1e-13);
    const Eigen::Vector2d r = samples.displacement.col(k);
    BOOST_TEST(std::abs(m + r(0) * n(1) - r(1) * n(0) - samples.momentum(0, 0)) < 1e-13);
    if (k == 0) continue;
    const double h = length * (samples.sigma(k) - samples.sigma(k - 1)), before = samples.momentum(0, k - 1);
    BOOST_TEST(h > 0.0);
    energy += h * (m * m + m * before + before * before) / (6.0 * stiffness);
    // Bθ' = m, by the trapezium rule: h³ m''/12.
    const double turn = samples.q(0, k) - samples.q(0, k - 1);
    BOOST_TEST(std::abs(turn - 0.5 * h * (m + before) / stiffness) < 0.2 * h * h * h);
  }
  BOOST_TEST(tail.energy(at) == energy, boost::test_tools::tolerance(2e-3));  // m² by parabolas, h <= 0.13
}

BOOST_AUTO_TEST_CASE(a_short_tails_samples_lie_on_its_own_curve) {
  // Nearly at right angles to the pull, where way made along it is all cancellation: the samples' places against
  // ∫ (cos θ, sin θ) ds over the formula's own angles, by Simpson's rule on 512 intervals. The
  // formula cancels by 1 − ρ, 2e-4 at least here: 1e-16 over that, a few times.
  const Eigen::Vector2d n(1.0, 0.0);
  for (const double length : {0.05, 0.16, 0.5, 2.0})
    for (const double theta : {0.3, 1.5, 1.55, 2.5}) {
      TailArc tail(2, 1.0, true, TailArc::End::moment_free);
      const ArcPoint at{&theta, &theta, nullptr, n.data(), length};
      const auto samples = tail.sample(at);
      for (const Eigen::Index k : {1, 4, 16, 30, 31}) {
        constexpr int parts = 512;
        const double step = samples.sigma(k) * length / parts;
        const Eigen::VectorXd distances = Eigen::VectorXd::LinSpaced(parts + 1, 0.0, parts * step);
        const Eigen::MatrixXd angles = tail.configurations(at, distances);
        Eigen::Vector2d sum = Eigen::Vector2d::Zero();
        for (int i = 0; i <= parts; ++i) {
          const double weight = (i == 0 || i == parts ? 1.0 : i % 2 == 1 ? 4.0 : 2.0) * step / 3.0;
          sum += weight * Eigen::Vector2d(std::cos(angles(0, i)), std::sin(angles(0, i)));
        }
        BOOST_TEST((samples.displacement.col(k) - sum).norm() < 2e-11);
      }
    }
}

// Close to a free end the moment is what the pull exerts about it, T ℓ sin ψ (1 + O(ℓ²)): to all digits, however short the tail.
BOOST_AUTO_TEST_CASE(the_moment_of_a_short_tail_keeps_its_digits) {
  const Eigen::Vector2d n(1.7, 0.0);
  const double theta = 0.6;
  const TailArc tail(2, 1.3, true, TailArc::End::moment_free);
  for (const double length : {1e-3, 1e-5, 1e-7}) {
    EndsVector gradient;
    tail.gradient(ArcPoint{&theta, &theta, nullptr, n.data(), length}, nullptr, gradient);
    const double moment = n(0) * length * std::sin(theta);
    BOOST_TEST(std::abs(std::abs(gradient(0)) - moment) < moment * (length * length + 1e-13));
  }
}

BOOST_AUTO_TEST_CASE(a_long_free_tail_is_the_infinite_one) {
  const double theta[1] = {1.9};
  const Eigen::Vector2d n(0.8, -0.4);
  TailArc free(2, 1.0, true, TailArc::End::moment_free), infinite(2, 1.0);
  for (const double length :
       {20.0, 60.0}) {  // below and beyond the 40 decay lengths where the formula changes
    const ArcPoint at{theta, theta, nullptr, n.data(), length};
    EndsVector g, limit;
    free.gradient(at, nullptr, g);
    infinite.gradient(at, nullptr, limit);
    BOOST_TEST(g(0) == limit(0), boost::test_tools::tolerance(1e-14));  // exp(−2·19) = 3e-17
    BOOST_TEST(free.energy(at) == infinite.energy(at), boost::test_tools::tolerance(1e-14));
  }
}

BOOST_AUTO_TEST_CASE(configurations_lie_on_the_samples_curve) {
  const Eigen::Vector3d n(0.8, -0.4, 0.3);
  const double length = 6.0, theta[1] = {1.4};
  const Quaternion q = product(rotation(Eigen::Vector3d(0.2, 0.9, -0.4).normalized(), 1.1), frame(0.5));
  for (const int dimension : {2, 3})
    for (const bool starts_here : {true, false})
      for (const auto end : {TailArc::End::infinite, TailArc::End::moment_free}) {
        const TailArc tail(dimension, 1.3, starts_here, end);
        const double* from = dimension == 2 ? theta : q.data();
        const ArcPoint at{from, from, nullptr, n.data(), length};
        const windlass::bvp::ArcSamples samples = tail.sample(at);
        Eigen::VectorXd distances = length * samples.sigma;
        if (!starts_here) distances = (length - distances.array()).reverse().eval();
        const Eigen::MatrixXd found = tail.configurations(at, distances);
        const Eigen::MatrixXd ordered = starts_here ? found : Eigen::MatrixXd(found.rowwise().reverse());
        // Distances from σ lose eps of the length; the place is found by Newton's method to the rounding of u.
        BOOST_TEST((ordered - samples.q).cwiseAbs().maxCoeff() < 1e-12);
      }
}

BOOST_AUTO_TEST_SUITE_END()
