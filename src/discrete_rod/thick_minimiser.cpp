#include "windlass/discrete_rod/thick_minimiser.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "thick_descent.hpp"

namespace windlass::discrete_rod {

using Eigen::VectorXd;

namespace {

constexpr double fine_beyond = 1.5;  // fine elements reach so far beyond half the angle [ρ]

/// Flat coil of the thin rod with infinite tails, raised into a helix whose strands clear each other.
VectorXd helix(const ThickRod& rod, const SplineRod& spline) {
  const double tension = std::max(rod.tension, 0.6);  // below 1/2 there is no flat coil that lies on
  const double root = std::sqrt(tension), half = 0.5 * rod.angle, beta = std::acos(1.0 - 0.5 / tension);
  const double end = std::max(half - beta, 0.0);
  const auto angle = [&](double s) {
    return s < end ? s : half - 4.0 * std::atan(std::tan(0.25 * (half - end)) * std::exp(root * (end - s)));
  };
  const double pitch = 2.1 * rod.radius, level = half + 0.5;  // a turn; where the tails level off
  std::vector<SplineRod::Point> points = {{0.0, -1.0, 0.0}};
  for (int k = 1; k <= spline.elements(); ++k) {
    const double s = spline.knot(k), h = s - spline.knot(k - 1), theta = angle(s - 0.5 * h);
    points.push_back(points.back() + h * SplineRod::Point(std::cos(theta), std::sin(theta), 0.0));
    const double rising = s < level ? s : level + 1.0 - std::exp(level - s);
    points.back()(2) = pitch * rising / (2.0 * M_PI);
  }
  return spline.through(points);
}

/// Points at the knots, on the curve that the rod starts on.
VectorXd along(const std::vector<SplineRod::Point>& curve, const SplineRod& spline) {
  std::vector<SplineRod::Point> points;
  std::size_t corner = 1;
  double begin = 0.0;
  for (int k = 0; k <= spline.elements(); ++k) {
    double length = (curve[corner] - curve[corner - 1]).norm();
    while (spline.knot(k) > begin + length && corner + 1 < curve.size()) {
      begin += length;
      ++corner;
      length = (curve[corner] - curve[corner - 1]).norm();
    }
    points.push_back(curve[corner - 1] +
                     (spline.knot(k) - begin) / length * (curve[corner] - curve[corner - 1]));
  }
  return spline.through(points);
}

VectorXd resampled(const SplineRod& from, const VectorXd& x, const SplineRod& to) {
  std::vector<SplineRod::Point> points;
  int e = 0;
  for (int k = 0; k <= to.elements(); ++k) {
    const double s = to.knot(k);
    while (e + 1 < from.elements() && from.knot(e + 1) < s) ++e;
    points.push_back(from.position(x, e, (s - from.knot(e)) / from.length(e)));
  }
  return to.through(points);
}

/// Raises the penalties from soft, where the start is far off, to those of the mesh. False if TAO fails.
bool stiffen(ThickEnergy& energy, const ThickRod& rod, double h, bool far_off, ThickMinimum& minimum) {
  const double range = 1.5 * h, bed = 4.0 / std::pow(range, 4);
  constexpr double stretching = 1e4;
  // Softer than this, and the pulls draw the rod through the cylinder.
  const double softest = 50.0 * rod.tension;
  // Penetration O(h²), hence a length O(h) over which strands push; slender ones must not pass each other.
  energy.penalties.strands = std::max(0.5 / std::pow(h, 3), 2.0 / std::pow(rod.radius, 3));
  for (double soft = far_off ? 1e-2 : 1.0; soft < 2.0; soft *= 10.0) {
    energy.penalties.cylinder = rod.cylinder ? std::max(soft * bed, std::min(bed, softest)) : 0.0;
    energy.penalties.stretching = std::max(soft * stretching, softest);
    const int used = descend(energy, 1e-5, minimum.x);
    if (used < 0) return false;
    minimum.iterations += used;
  }
  return true;
}

/// Augmented Lagrangian: lengths by multipliers, the closest approach by shifting where strands begin to push.
bool settle(ThickEnergy& energy, double radius, ThickMinimum& minimum) {
  constexpr int most = 12;
  for (int k = 0; k < most; ++k) {
    const bool touches = energy.strand_force(minimum.x) > 0.0;
    const double depth = touches ? 2.0 * radius - energy.strand_distance(minimum.x) : 0.0;
    if (k > 0 && energy.stretch(minimum.x) < 1e-9 && std::abs(depth) < 1e-8) return true;
    energy.raise_tension(minimum.x);
    energy.penalties.strand_shift = std::max(0.0, energy.penalties.strand_shift + depth);
    const int used = descend(energy, 1e-8, minimum.x);
    if (used < 0) return false;
    minimum.iterations += used;
  }
  return false;
}

}  // namespace

void ThickRod::validate() const {
  if (!(tension > 0.0)) throw std::invalid_argument("thick rod: tension must be > 0");
  if (cylinder ? !(angle > 0.0) : angle != 0.0)
    throw std::invalid_argument("thick rod: angle must be > 0, or 0 without a cylinder");
  if (!cylinder && curve.empty()) throw std::invalid_argument("thick rod: needs a curve without a cylinder");
  if (!(radius > 0.0 && radius < 1.0)) throw std::invalid_argument("thick rod: radius must be in (0, 1)");
  if (!(half_length > 0.5 * angle + fine_beyond))
    throw std::invalid_argument("thick rod: half_length must exceed half the capstan angle by 1.5");
}

double ThickRod::length_of_knot() const {
  const double turns = cylinder ? 0.5 * angle + 1.0 : 2.0 * M_PI / std::sqrt(tension);
  return std::min(turns + 3.0 / std::sqrt(tension), 0.9 * half_length);
}

SplineRod ThickRod::spline(double h) const {
  return {half_length, fine_length > 0.0 ? fine_length : 0.5 * angle + fine_beyond, h};
}

ThickMinimum minimise(const ThickRod& rod, double h, const ThickMinimum* start) {
  rod.validate();
  if (!(h > 0.0 && h <= 0.2)) throw std::invalid_argument("thick rod: h must be in (0, 0.2]");
  const SplineRod spline = rod.spline(h);
  ThickEnergy energy(spline, rod.tension, rod.angle, rod.radius);
  ThickMinimum minimum;
  minimum.h = h;
  energy.penalties.mid_point = rod.cylinder ? 0.0 : 1.0;
  minimum.unknowns = static_cast<int>(spline.size());
  minimum.x = start               ? resampled(rod.spline(start->h), start->x, spline)
              : rod.curve.empty() ? helix(rod, spline)
                                  : along(rod.curve, spline);
  if (!stiffen(energy, rod, h, !start, minimum) || !settle(energy, rod.radius, minimum)) return minimum;
  minimum.penalties = energy.penalties;
  minimum.R_tot = energy.cylinder_force(minimum.x);
  minimum.self_force = energy.strand_force(minimum.x);
  minimum.energy = energy.bending(minimum.x);
  minimum.open = (rod.cylinder ? minimum.R_tot : minimum.self_force) == 0.0;
  minimum.converged = !minimum.open && convex(energy.hessian(minimum.x));
  return minimum;
}

double extrapolated(const std::vector<double>& h, const std::vector<double>& values, int order) {
  double mean = 0.0, mean_value = 0.0, square = 0.0, product = 0.0;
  const double share = 1.0 / static_cast<double>(h.size());
  for (std::size_t k = 0; k < h.size(); ++k) {
    const double power = std::pow(h[k], order);
    mean += share * power, mean_value += share * values[k];
    square += share * power * power, product += share * power * values[k];
  }
  return mean_value - mean * (product - mean * mean_value) / (square - mean * mean);
}

ThickLimit minimise(const ThickRod& rod, const std::vector<double>& meshes) {
  if (meshes.size() < 3) throw std::invalid_argument("thick rod: three meshes at least");
  ThickLimit limit;
  for (const double h : meshes) {
    ThickMinimum minimum = minimise(rod, h, limit.meshes.empty() ? nullptr : &limit.meshes.back());
    if (!minimum.converged && !limit.meshes.empty()) minimum = minimise(rod, h);  // softly from nothing
    limit.meshes.push_back(std::move(minimum));
    if (!limit.meshes.back().converged) return limit;
  }
  std::vector<double> h, R_tot, self_force;
  for (auto mesh = limit.meshes.end() - 3; mesh != limit.meshes.end(); ++mesh) {
    h.push_back(mesh->h);
    R_tot.push_back(mesh->R_tot);
    self_force.push_back(mesh->self_force);
  }
  limit.R_tot = extrapolated(h, R_tot, 3);
  limit.self_force = extrapolated(h, self_force, 2);
  limit.converged = true;
  return limit;
}

}  // namespace windlass::discrete_rod
