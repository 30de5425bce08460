#include "slaved_pressure.hpp"

#include <cmath>

namespace windlass::verify {

using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Points of the polynomial: it misses a pressure that changes over h by (h/4)^8 and less, what it adds up to at the end by far less.
constexpr int points = 8;

/// Radau's points on [0, 1], the last one 1 (Golub's eigenvalues, with the end prescribed).
VectorXd radau_points() {
  const auto beside = [](int k) { return k / std::sqrt(4.0 * k * k - 1.0); };
  MatrixXd jacobi = MatrixXd::Zero(points, points);
  for (int k = 1; k < points; ++k) jacobi(k, k - 1) = jacobi(k - 1, k) = beside(k);
  const int inner = points - 1;
  const MatrixXd shifted = jacobi.topLeftCorner(inner, inner) - MatrixXd::Identity(inner, inner);
  const double last = beside(inner);
  jacobi(inner, inner) =
      1.0 + shifted.partialPivLu().solve(last * last * VectorXd::Unit(inner, inner - 1))(inner - 1);
  return 0.5 + 0.5 * Eigen::SelfAdjointEigenSolver<MatrixXd>(jacobi).eigenvalues().array();
}

}  // namespace

SlavedPiece find_slaved(RodFlow& flow, const Stiffness& law, const Shape& shape, const Section& start,
                        double length, double guess, bool backward, int looks) {
  static const VectorXd unit = radau_points();
  const VectorXd places = length * unit;
  VectorXd p = VectorXd::Constant(points, guess);
  const auto off = [&](const VectorXd& pressures) {
    VectorXd out(points);
    flow.prescribe(places, pressures);
    flow.restart(start, backward);
    for (int k = 0; k < points; ++k) {
      const Section here = flow.advance(places(k));
      out(k) = taken_by_friction(here, law) - layer_width(here, law, shape) * pressures(k);
    }
    return out;
  };
  VectorXd f = off(p);
  MatrixXd slopes(points, points);
  constexpr double step = 1e-3;  // nearly linear
  for (int k = 0; k < points; ++k) slopes.col(k) = (off(p + step * VectorXd::Unit(points, k)) - f) / step;
  const Eigen::PartialPivLU<MatrixXd> factors(slopes);
  SlavedPiece out;
  constexpr int most = 12;
  constexpr double rounding = 1e-12;  // of forces
  double before = HUGE_VAL;
  for (int k = 0; k < most && !out.converged; ++k) {
    p -= factors.solve(f);
    f = off(p);
    const double size = f.lpNorm<Eigen::Infinity>();
    out.converged = size < rounding || (size < 1e2 * rounding && size > 0.5 * before);
    before = size;
  }
  flow.prescribe(places, p);
  flow.restart(start, backward);
  for (int k = 0; k <= looks; ++k) {
    const double s = k * length / looks;
    out.stations.push_back(k == 0 ? start : flow.advance(k == looks ? length : s));
    out.pressures.push_back(polynomial(places, p, s));
  }
  out.contact_force = std::abs(flow.contact_force());
  flow.prescribe({}, {});
  return out;
}

}  // namespace windlass::verify
