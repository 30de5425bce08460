#include "windlass/rod/free_flow.hpp"

#include <boost/numeric/odeint.hpp>
#include <cmath>
#include <vector>

namespace windlass::rod {

Section free_flow(const Section& from, const Eigen::Vector3d& n, const Material& rod, double distance) {
  if (distance == 0.0) return from;
  namespace odeint = boost::numeric::odeint;
  using State = std::vector<double>;  // r, m, q
  using Map = Eigen::Map<const Eigen::Vector3d>;
  const auto slopes = [&](const State& y, State& dy, double s) {
    const Eigen::Map<const Quaternion> q(y.data() + 6);
    const Eigen::Matrix3d d = directors(q);
    const Eigen::Vector3d u = rod.natural + (d.transpose() * Map(y.data() + 3)).cwiseQuotient(rod.stiffness);
    const Eigen::Vector3d here = n - s * rod.weight, slope = rod.stretch(here.dot(d.col(2))) * d.col(2);
    Eigen::Map<Eigen::Vector3d>(dy.data()) = slope;
    Eigen::Map<Eigen::Vector3d>(dy.data() + 3) = here.cross(slope);
    Eigen::Map<Quaternion>(dy.data() + 6) = 0.5 * increments(q) * u;
  };
  State y(10);
  Eigen::Map<Eigen::Vector3d>(y.data()) = from.r;
  Eigen::Map<Eigen::Vector3d>(y.data() + 3) = from.m;
  Eigen::Map<Quaternion>(y.data() + 6) = from.q;
  constexpr double tolerance = 1e-13;
  odeint::integrate_adaptive(
      odeint::make_controlled(tolerance, tolerance, odeint::runge_kutta_fehlberg78<State>()), slopes, y, 0.0,
      distance, std::copysign(std::min(0.1, std::abs(distance)), distance));
  return {Map(y.data()), Map(y.data() + 3), Eigen::Map<const Quaternion>(y.data() + 6).normalized()};
}

}  // namespace windlass::rod
