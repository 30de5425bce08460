#include "couple_line_shooting.hpp"

#include <boost/numeric/odeint.hpp>
#include <cmath>

#include "shooting.hpp"

namespace windlass::test {

namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

struct OnLine : OnCylinder {
  Vector3d m, n;
  double pressed = 0.0;  ///< ∫ p ds
};

/// What the force along the normal is without friction, ν, and w of n·N = ν − w p.
struct Normal {
  double free, width;
};

/// Unknowns: at the right edge angle, height, inclination, turn, the moments about N and t, the force (3); τ; the places of both
/// edges, the point force at the left one; place and force of the plate's touch. At the right edge the curvature is the surface's.
struct LineOracle {
  const scene::Scene& scene;
  static constexpr int size = 15;

  double stretch(const Vector3d& n, const Vector3d& t) const {
    return 1.0 + scene.rod.compliance() * n.dot(t);
  }

  /// The moment about t × N is Bλ cos²ψ all along; its rate, and that of λ, say what n·N is.
  Normal normal(const Vector3d& out, const Vector3d& t, const Vector3d& m, const Vector3d& n) const {
    const double b = scene.rod.bending_stiffness, k = scene.rod.compliance(), mu = *scene.friction;
    const double sine = t.z(), cosine = Vector3d::UnitZ().cross(out).dot(t), longer = stretch(n, t);
    const double whole = 1.0 + k * b * std::pow(cosine, 4), turn = m.dot(out) / b;
    const double a = m.dot(t) - 3.0 * b * longer * sine * cosine;
    const double rate = -k * turn * (a * cosine * cosine + n.dot(t.cross(out))) / whole;
    return {(turn * a + b * rate * cosine * cosine) / longer,
            mu * sine * (scene.friction_arm() + k * b * cosine * cosine) / (longer * whole)};
  }

  OnLine along(const OnLine& at, double length, bool line) const {
    using State = std::array<double, 16>;
    const double b = scene.rod.bending_stiffness, c = scene.rod.twist_ratio * b;
    const double mu = *scene.friction, arm = scene.friction_arm();
    const auto rates = [&](const State& x, State& rate, double) {
      const Eigen::Map<const Vector3d> r(&x[0]), t(&x[3]), d1(&x[6]), m(&x[9]), n(&x[12]);
      const double twisting = m.dot(t), longer = stretch(n, t);
      const Vector3d u = (m - twisting * t) / b + twisting / c * t;
      Vector3d push = Vector3d::Zero(), couple = Vector3d::Zero();
      double p = 0.0;
      if (line) {
        const Vector3d out(r.x(), r.y(), 0.0), whole = out + mu * Vector3d::UnitZ();
        const Normal force = normal(out, t, m, n);
        p = (force.free - n.dot(out)) / force.width;
        push = p * whole, couple = -arm * out.cross(push);
      }
      Eigen::Map<Vector3d>{&rate[0]} = longer * t;
      Eigen::Map<Vector3d>{&rate[3]} = u.cross(t);
      Eigen::Map<Vector3d>{&rate[6]} = u.cross(d1);
      Eigen::Map<Vector3d>{&rate[9]} = longer * n.cross(t) - couple;
      Eigen::Map<Vector3d>{&rate[12]} = -push;
      rate[15] = p;
    };
    State x;
    const Vector3d* all[] = {&at.r, &at.t, &at.d1, &at.m, &at.n};
    for (int k = 0; k < 5; ++k) Eigen::Map<Vector3d>{&x[static_cast<std::size_t>(3 * k)]} = *all[k];
    x[15] = at.pressed;
    boost::numeric::odeint::runge_kutta_fehlberg78<State> stepper;
    // Steps of a seventh of the layer's width and less: error (1/7)^8, decaying.
    const double step = line ? (arm + b * scene.rod.compliance()) * mu / 35.0 : 0.05;
    const int steps = 10 + static_cast<int>(std::abs(length) / step);
    for (int k = 0; k < steps; ++k) stepper.do_step(rates, x, length * k / steps, length / steps);
    OnLine out;
    Vector3d* to[] = {&out.r, &out.t, &out.d1, &out.m, &out.n};
    for (int k = 0; k < 5; ++k) *to[k] = Eigen::Map<Vector3d>{&x[static_cast<std::size_t>(3 * k)]};
    out.pressed = x[15];
    return out;
  }

  OnLine edge(const VectorXd& x) const {
    const Vector3d out(std::sin(x(0)), -std::cos(x(0)), 0.0);
    OnLine at{on_cylinder(x.head<4>()), {}, {}};
    const Vector3d across = out.cross(at.t);
    at.n = x.segment<3>(6);
    const double curvature = stretch(at.n, at.t) * std::pow(std::cos(x(2)), 2);
    at.m = x(4) * out + x(5) * at.t + scene.rod.bending_stiffness * curvature * across;
    return at;
  }

  void end(const OnLine& at, const Vector3d& pull, double side, VectorXd& out, int row) const {
    const Vector3d along = side * pull.normalized(), d2 = -Vector3d::UnitZ();
    out.segment<3>(row) << at.d1.dot(along), at.d1.dot(d2), at.t.dot(d2);
    out.segment<3>(row + 3) = side * at.n - pull;
  }

  VectorXd residual(const VectorXd& x, Dragged* found = nullptr) const {
    VectorXd out(size);
    const double T = scene.load.tension, half = 0.5 * scene.load.angle, end_at = 0.5 * scene.rod.length;
    const double tau = x(9), right = x(10), left = x(11), force = x(12), plate = x(13);
    const Vector3d pull(std::cos(half), std::sin(half), 0.0), other(-pull.x(), pull.y(), 0.0);
    OnLine at = along(edge(x), plate - right, false);
    out(0) = scene.plate->height - at.r.z();
    out(1) = at.t.z();
    at.n += x(14) * Vector3d::UnitZ();
    end(along(at, end_at - plate, false), (T + tau) * pull, 1.0, out, 2);
    OnLine begin = along(edge(x), left - right, true);
    const Vector3d outward(begin.r.x(), begin.r.y(), 0.0),
        whole = force * (outward + *scene.friction * Vector3d::UnitZ());
    begin.n += whole;
    begin.m -= scene.friction_arm() * outward.cross(whole);
    end(along(begin, -end_at - left, false), (T - tau) * other, -1.0, out, 8);
    out(14) = left + right;
    if (found) {
      found->contact_force = force - begin.pressed;  // integrated leftward
      found->drag = *scene.friction * found->contact_force;
      found->travelled = tau;
    }
    return out;
  }
};

VectorXd start(const equilibrium::Solution& guess) {
  VectorXd x(LineOracle::size);
  const auto& line = guess.arcs[1];
  const Eigen::Index last = line.s.size() - 1;
  const Vector3d r = line.r.col(last), out = Vector3d(r.x(), r.y(), 0.0).normalized();
  x.head<4>() = coordinates_on_cylinder(r, line.q.col(last));
  const Vector3d t = on_cylinder(x.head<4>()).t;
  x(4) = line.m.col(last).dot(out);
  x(5) = line.m.col(last).dot(t);
  x.segment<3>(6) = guess.arcs[2].n.col(0);
  x(9) = guess.pull_difference;
  x(10) = guess.joints[2].s, x(11) = guess.joints[1].s, x(12) = guess.joints[1].force;
  x(13) = guess.joints[3].s, x(14) = guess.joints[3].force;
  return x;
}

}  // namespace

Dragged shot_from_line(const equilibrium::Solution& guess, const scene::Scene& scene) {
  const LineOracle oracle{scene};
  const auto residual = [&](const VectorXd& x) { return oracle.residual(x); };
  const VectorXd x = newton_shot(residual, start(guess), 1e-5, 1e-10);
  Dragged found;
  oracle.residual(x, &found);
  return found;
}

}  // namespace windlass::test
