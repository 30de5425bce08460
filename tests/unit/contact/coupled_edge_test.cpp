// The edge of a line whose friction turns and stretches the rod: derivatives against differences, where pressure flows in and where it flows out.
#include "windlass/contact/coupled_edge.hpp"

#include <boost/test/unit_test.hpp>

namespace {

using namespace windlass;
using contact::Side;
using contact::SmallVector;
using contact::spatial::CoupledEdge;
using Eigen::VectorXd;

constexpr double step = 1e-5,
                 allowed = 1e-8;  // central differences of functions with derivatives of order one

contact::Loads slipping_loads(double travel) {
  contact::Loads loads;
  loads.friction = 0.4;
  loads.arm = 0.2;
  loads.compliance = 0.15;
  loads.travel = travel;
  return loads;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(coupled_edge)

BOOST_AUTO_TEST_CASE(derivatives_are_those_of_the_values) {
  const VectorXd w = (VectorXd(5) << 0.4, 0.3, 0.35, -0.2, 0.7).finished();
  SmallVector g(3);
  g << 0.6, -0.3, 0.2;
  int inflows = 0;
  for (const Side line : {Side::left, Side::right})
    for (const double travel : {0.1, 0.8}) {  // on either side of sin ψ
      const CoupledEdge edge(line, 1.2);
      const contact::Loads loads = slipping_loads(travel);
      const Side other = line == Side::left ? Side::right : Side::left;
      inflows += edge.flux(w.data(), loads) > 0.0;
      BOOST_TEST((edge.flux(w.data(), loads) > 0.0) == !edge.lift(w.data(), loads).has_value());
      const SmallVector n = SmallVector::LinSpaced(3, 0.4, 1.9);
      const auto stretching = *edge.stretching(w.data(), n, loads.compliance);
      BOOST_TEST(!edge.drag(other, w.data(), loads, g).has_value());
      const auto drag = [&](const VectorXd& at, const SmallVector& h) {
        return VectorXd(edge.drag(line, at.data(), loads, h)->value);
      };
      const auto exact = *edge.drag(line, w.data(), loads, g);
      for (int k = 0; k < 5; ++k) {
        const VectorXd by = step * VectorXd::Unit(5, k);
        const VectorXd difference = (drag(w + by, g) - drag(w - by, g)) / (2.0 * step);
        BOOST_TEST((difference - VectorXd(exact.by_w.col(k))).norm() < allowed);
        const VectorXd above = w + by, below = w - by;
        const double stretched = (edge.stretching(above.data(), n, loads.compliance)->value -
                                  edge.stretching(below.data(), n, loads.compliance)->value) /
                                 (2.0 * step);
        BOOST_TEST(std::abs(stretched - stretching.by_w(k)) < allowed);
        const auto lift = edge.lift(w.data(), loads);
        if (!lift) continue;
        const VectorXd up = w + by, down = w - by;
        const double change =
            (edge.lift(up.data(), loads)->value - edge.lift(down.data(), loads)->value) / (2.0 * step);
        BOOST_TEST(std::abs(change - lift->by_w(k)) < allowed);
      }
      for (int k = 0; k < 3; ++k) {
        const SmallVector by = step * SmallVector::Unit(3, k);
        const VectorXd difference = (drag(w, g + by) - drag(w, g - by)) / (2.0 * step);
        BOOST_TEST((difference - VectorXd(exact.by_gradient.col(k))).norm() < allowed);
      }
      if (const auto lift = edge.lift(w.data(), loads)) {
        const double change = (edge.lift(w.data(), slipping_loads(travel + step))->value -
                               edge.lift(w.data(), slipping_loads(travel - step))->value) /
                              (2.0 * step);
        BOOST_TEST(std::abs(change - lift->by_travel) < allowed);
        BOOST_TEST(lift->value < 0.0);  // the gap begins with a curvature of its own
      }
    }
  BOOST_TEST(inflows == 2);
}

BOOST_AUTO_TEST_CASE(attachments_are_differentiated) {
  const VectorXd w = (VectorXd(5) << 0.4, 0.3, 0.35, -0.2, 0.7).finished();
  const contact::Loads loads = slipping_loads(0.1);
  for (const Side line : {Side::left, Side::right})
    for (const Side side : {Side::left, Side::right}) {
      const CoupledEdge edge(line, 1.2);
      const auto here = edge.attach(side, w.data(), loads);
      const SmallVector g = SmallVector::LinSpaced(here.dq.rows(), 0.7, -0.4),
                        f = SmallVector::LinSpaced(here.x.size(), -0.6, 0.9);
      contact::SmallMatrix curvature = contact::SmallMatrix::Zero(5, 5);
      edge.curvature(side, w.data(), loads, g, f, curvature);
      for (int k = 0; k < 5; ++k) {
        const VectorXd up = w + step * VectorXd::Unit(5, k), down = w - step * VectorXd::Unit(5, k);
        const auto a = edge.attach(side, up.data(), loads), b = edge.attach(side, down.data(), loads);
        const VectorXd change = VectorXd(a.test().transpose() * f - b.test().transpose() * f +
                                         a.dq.transpose() * g - b.dq.transpose() * g) /
                                (2.0 * step);
        BOOST_TEST((VectorXd(a.x - b.x) / (2.0 * step) - VectorXd(here.dx.col(k))).norm() < allowed);
        BOOST_TEST((change - VectorXd(curvature.col(k))).norm() < allowed);
      }
    }
}

BOOST_AUTO_TEST_SUITE_END()
