#include "wall_shooting.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <boost/numeric/odeint.hpp>
#include <cmath>
#include <functional>

namespace windlass::test {

namespace {

using Kind = WallEventKind;

using Real = long double;
using State = std::array<Real, 4>;  // θ, κ, x, y; EI = 1

/// One end of the strut to the wall: from (0, 0), thrust P along e_x and a transverse force V at the end.
State elastica(Real angle, Real curvature, Real thrust, Real transverse, Real length) {
  boost::numeric::odeint::runge_kutta_fehlberg78<State, Real> stepper;
  State state{angle, curvature, 0, 0};
  const auto rates = [&](const State& at, State& rate, Real) {
    // θ' = κ, κ' = n_x sin θ − n_y cos θ with n = (−P, V)
    rate = {at[1], -thrust * std::sin(at[0]) - transverse * std::cos(at[0]), std::cos(at[0]),
            std::sin(at[0])};
  };
  constexpr int steps = 200;  // error (0.06)^8 at the largest thrust: below 1e-13
  for (int k = 0; k < steps; ++k) stepper.do_step(rates, state, length * k / steps, length / steps);
  return state;
}

/// Newton's method with differences, for as many unknowns as equations.
Eigen::VectorXd shoot(const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& residual,
                      Eigen::VectorXd x) {
  for (int k = 0; k < 60; ++k) {
    const Eigen::VectorXd f = residual(x);
    Eigen::MatrixXd j(f.size(), x.size());
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      const double step = 1e-6 * std::max(1.0, std::abs(x(i)));
      Eigen::VectorXd up = x, down = x;
      up(i) += step, down(i) -= step;
      j.col(i) = (residual(up) - residual(down)) / (2.0 * step);
    }
    const Eigen::VectorXd dx = -j.fullPivLu().solve(f);
    x += dx;
    if ((dx.array().abs() / x.array().abs().max(1.0)).maxCoeff() < 1e-13) return x;
  }
  BOOST_FAIL("the oracle did not converge");
  return x;
}

}  // namespace

WallEvent event_at(Kind kind, bool clamped, double h) {
  const double pi = M_PI, euler = (clamped ? 4.0 : 1.0) * pi * pi;
  const double factor = kind == Kind::touch ? 1.0 : kind == Kind::line ? 4.0 : clamped ? 9.0 : 16.0;
  const double free = kind != Kind::buckling ? 0.5 : clamped ? 1.0 / 3.0 : 0.25;  // of small deflections
  // Small deflections: y = h (1 − cos kx)/2, h sin kx, or with V at the end h (kx − sin kx)/2π, h (kx + sin
  // kx)/π.
  const double k = std::sqrt(factor * euler);
  Eigen::VectorXd guess(4);
  guess << factor * euler, 0.0, 0.0, free;
  if (kind == Kind::touch)
    guess(2) = clamped ? 0.5 * h * k * k : h * k;
  else
    guess(1) = -h * k * k * k / (clamped ? 2.0 * pi : pi), guess(2) = clamped ? 0.0 : 2.0 * h * k / pi;
  const auto end = [&](const Eigen::VectorXd& x) {
    return clamped ? elastica(0, x(2), x(0), x(1), x(3)) : elastica(x(2), 0, x(0), x(1), x(3));
  };
  const auto residual = [&](const Eigen::VectorXd& x) {
    const State at = end(x);
    // On the wall: no curvature there, at[1] = 0. With H = κ²/2 + n·t the same at both ends, and t too, a
    // clamped end then has none either. The tangent at the wall is a double root, x(2) = 0 a simple one that
    // says the same.
    const bool by_curvature = clamped && kind != Kind::touch;
    Eigen::VectorXd f(4);
    f << (by_curvature ? Real(x(2)) : at[0]), at[3] - h, kind == Kind::touch ? Real(x(1)) : at[1],
        kind == Kind::buckling ? x(0) * std::pow(1.0 - 2.0 * x(3), 2) / (4.0 * pi * pi) - 1.0 : x(3) - 0.5;
    return f;
  };
  const Eigen::VectorXd x = shoot(residual, guess);
  return {2.0 * static_cast<double>(x(3) - end(x)[2]), x(0)};
}

Eigen::VectorXd variations_beside_the_line(double thrust, double h, int elements) {
  const double k = std::sqrt(thrust);
  Eigen::VectorXd guess(2);
  guess << -h * k * k * k / (2.0 * M_PI), 2.0 * M_PI / k;
  const auto at_line = [&](const Eigen::VectorXd& x) {
    const State at = elastica(0, 0, thrust, x(0), x(1));
    return Eigen::VectorXd(Eigen::Vector2d(at[1], at[3] - h));
  };
  const Eigen::VectorXd x = shoot(at_line, guess);
  const double transverse = x(0), size = x(1) / elements;
  const int inner = elements - 1, both = 2 * inner;
  Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(both, both), mass = stiffness,
                  held = Eigen::MatrixXd::Zero(3, both);
  for (int e = 0; e < elements; ++e)
    for (const double at : {0.5 - std::sqrt(1.0 / 12.0), 0.5 + std::sqrt(1.0 / 12.0)}) {
      const auto angle = static_cast<double>(elastica(0, 0, thrust, transverse, (e + at) * size)[0]);
      const double weight = 0.5 * size, load = -thrust * std::cos(angle) + transverse * std::sin(angle);
      const Eigen::Vector2d shape(1.0 - at, at), slope(-1.0 / size, 1.0 / size);
      for (int part = 0; part < 2; ++part)
        for (int i = 0; i < 2; ++i) {
          if (e + i < 1 || e + i > inner) continue;
          const int row = part * inner + e + i - 1;
          held(part, row) += weight * std::cos(angle) * shape(i);
          held(2, row) += weight * std::sin(angle) * shape(i);
          for (int j = 0; j < 2; ++j) {
            if (e + j < 1 || e + j > inner) continue;
            const int column = part * inner + e + j - 1;
            stiffness(row, column) += weight * (slope(i) * slope(j) + load * shape(i) * shape(j));
            mass(row, column) += weight * shape(i) * shape(j);
          }
        }
    }
  const Eigen::MatrixXd free = Eigen::FullPivLU<Eigen::MatrixXd>(held).kernel();
  return Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(
             free.transpose() * stiffness * free, free.transpose() * mass * free, Eigen::EigenvaluesOnly)
      .eigenvalues();
}

}  // namespace windlass::test
