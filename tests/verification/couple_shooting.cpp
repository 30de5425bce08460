#include "couple_shooting.hpp"

#include <boost/numeric/odeint.hpp>
#include <cmath>

#include "shooting.hpp"

namespace windlass::test {

namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;
using equilibrium::JointKind;

struct Section : OnCylinder {
  Vector3d m, n;
};

struct Touch {
  bool of_plate;
  double s, force;
};

/// What is unknown, in one vector: where the rod lies at its first touch (angle, height, inclination, turn), moment and force
/// behind it, τ or ω, and place and force of each touch.
struct Oracle {
  const scene::Scene& scene;
  std::vector<Touch> touches;
  int size() const { return 11 + 2 * static_cast<int>(touches.size()); }

  double stretch(const Vector3d& n, const Vector3d& t) const {
    return 1.0 + scene.rod.compliance() * n.dot(t);
  }

  /// t' = m×t/B, all of the section turns by u = (m − M t)/B + M t/C; r' = λ t, m' = λ n×t, λ = 1 + n·t/EA.
  Section along(Section at, double length) const {
    using State = std::array<double, 12>;
    const double b = scene.rod.bending_stiffness, c = scene.rod.twist_ratio * b;
    const Vector3d n = at.n;
    const auto rates = [&](const State& x, State& rate, double) {
      const Eigen::Map<const Vector3d> t(&x[3]), d1(&x[6]), m(&x[9]);
      const double twisting = m.dot(t);
      const Vector3d u = (m - twisting * t) / b + twisting / c * t;
      const double along = stretch(n, t);
      Eigen::Map<Vector3d>{&rate[0]} = along * t;
      Eigen::Map<Vector3d>{&rate[3]} = u.cross(t);
      Eigen::Map<Vector3d>{&rate[6]} = u.cross(d1);
      Eigen::Map<Vector3d>{&rate[9]} = along * n.cross(t);
    };
    State x;
    Eigen::Map<Vector3d>{&x[0]} = at.r;
    Eigen::Map<Vector3d>{&x[3]} = at.t;
    Eigen::Map<Vector3d>{&x[6]} = at.d1;
    Eigen::Map<Vector3d>{&x[9]} = at.m;
    boost::numeric::odeint::runge_kutta_fehlberg78<State> stepper;
    const int steps = 10 + static_cast<int>(std::abs(length) / 0.05);  // error (0.05 κ)^8, κ about 1
    for (int k = 0; k < steps; ++k) stepper.do_step(rates, x, length * k / steps, length / steps);
    for (int k = 0; k < 3; ++k) at.r(k) = x[k], at.t(k) = x[3 + k], at.d1(k) = x[6 + k], at.m(k) = x[9 + k];
    return at;
  }

  Vector3d normal(const Touch& touch, const Vector3d& r) const {
    return touch.of_plate ? Vector3d(0.0, 0.0, -1.0) : Vector3d(r.x(), r.y(), 0.0).normalized();
  }
  /// Force on the rod, and the moment of what acts at its surface.
  /// @param half_ahead  −½: `at` is the section before the touch, ½: behind it
  std::pair<Vector3d, Vector3d> push(const Touch& touch, double force, const Section& at, double travel,
                                     double half_ahead) const {
    const Vector3d out = normal(touch, at.r);
    if (touch.of_plate) return {force * out, Vector3d::Zero()};
    // The rod slips with the mean of its stretch on the two sides, which friction along it tells apart.
    Vector3d whole = Vector3d::Zero();
    for (int k = 0; k < 20; ++k) {
      const double speed = travel * stretch(at.n + half_ahead * whole, at.t);
      whole = force * (out + *scene.friction * (Vector3d::UnitZ() - speed * at.t).normalized());
    }
    return {whole, -scene.friction_arm() * out.cross(whole)};
  }
  double travel(const VectorXd& x) const { return scene.ends.travel == scene::Travel::free ? x(10) : 0.0; }
  double pull_difference(const VectorXd& x) const { return x(10) - travel(x); }

  Section first(const VectorXd& x) const {
    Section at{on_cylinder(x.head<4>()), {}, {}};
    at.m = x.segment<3>(4), at.n = x.segment<3>(7);
    return at;
  }

  /// Of a clamped end: d₂ = −e_z, the tangent along the pull; the force is the pull.
  void end(const Section& at, const Vector3d& pull, double side, VectorXd& out, int& row) const {
    const Vector3d along = side * pull.normalized(), d2 = -Vector3d::UnitZ();
    out.segment<3>(row) << at.d1.dot(along), at.d1.dot(d2), at.t.dot(d2);
    out.segment<3>(row + 3) = side * at.n - pull;
    row += 6;
  }

  VectorXd residual(const VectorXd& x, Dragged* found = nullptr) const {
    VectorXd out(size());
    int row = 0;
    const double T = scene.load.tension, half = 0.5 * scene.load.angle, end_at = 0.5 * scene.rod.length;
    const Vector3d right(std::cos(half), std::sin(half), 0.0), left(-right.x(), right.y(), 0.0);
    const double tau = pull_difference(x);
    Section at = first(x), before = at;
    const auto place = [&](std::size_t k) { return x(11 + 2 * static_cast<Eigen::Index>(k)); };
    const auto force = [&](std::size_t k) { return x(12 + 2 * static_cast<Eigen::Index>(k)); };
    double outermost = 0.0;
    for (std::size_t k = 0; k < touches.size(); ++k) {
      const auto [f, moment] = push(touches[k], force(k), at, travel(x), k == 0 ? 0.5 : -0.5);
      if (k == 0) {
        before.n += f, before.m += moment;
        end(along(before, -end_at - place(0)), (T - tau) * left, -1.0, out, row);
      } else {
        const Vector3d out_of = normal(touches[k], at.r);
        out(row++) = touches[k].of_plate ? scene.plate->height - at.r.z() : at.r.head<2>().norm() - 1.0;
        out(row++) = out_of.dot(at.t);
        at.n -= f, at.m -= moment;
      }
      if (found && !touches[k].of_plate) {
        found->drag += f.z();
        found->contact_force += force(k);
      }
      if (!touches[k].of_plate) outermost = place(k);
      const double next = k + 1 < touches.size() ? place(k + 1) : end_at;
      at = along(at, next - place(k));
    }
    end(at, (T + tau) * right, 1.0, out, row);
    out(row) = place(0) + outermost;  // the middle of the cylinder's contacts is that of the rod
    if (found) found->travelled = x(10);
    return out;
  }
};

VectorXd start(const equilibrium::Solution& guess, Oracle& oracle) {
  VectorXd x(11 + 2 * (guess.joints.size() - 2));
  for (std::size_t k = 1; k + 1 < guess.joints.size(); ++k) {
    const auto& joint = guess.joints[k];
    oracle.touches.push_back({joint.obstacle > 0, joint.s, joint.force});
    x.segment<2>(9 + 2 * static_cast<Eigen::Index>(k)) << joint.s, joint.force;
  }
  const auto& arc = guess.arcs[1];
  x.head<4>() = coordinates_on_cylinder(arc.r.col(0), arc.q.col(0));
  x.segment<3>(4) = arc.m.col(0);
  x.segment<3>(7) = arc.n.col(0);
  x(10) = oracle.scene.ends.travel == scene::Travel::free ? guess.travel_rate : guess.pull_difference;
  return x;
}

}  // namespace

Dragged shot_from_touches(const equilibrium::Solution& guess, const scene::Scene& scene) {
  Oracle oracle{scene, {}};
  const auto residual = [&](const VectorXd& x) { return oracle.residual(x); };
  const VectorXd x = newton_shot(residual, start(guess, oracle), 1e-4, 1e-11);
  Dragged found;
  oracle.residual(x, &found);
  return found;
}

}  // namespace windlass::test
