#include "continuation/bifurcation_rays.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "continuation/bracket.hpp"

namespace continuation {
namespace {

class Circle {
 public:
  Circle(Problem& problem, const Options& options, const Vector& x, const Vector& p, double radius)
      : p_(p),
        radius_(radius),
        reduced_(problem, options, x, p, null_vectors(problem, x, p, 2, options), {options.parameter}) {}

  /// sin of the angle between g and b: zero on an arm. @throws std::runtime_error where F cannot be solved
  double operator()(double theta) {
    const Eigen::Vector2d alpha = radius_ * Eigen::Vector2d(std::cos(theta), std::sin(theta));
    const std::optional<Reduced::Value> value = reduced_.at(p_, alpha);
    if (!value) throw std::runtime_error(reduced_.failure());
    const Eigen::Vector2d b = value->y_parameter.col(0), g = value->y();
    mu_ = -b.dot(g) / b.squaredNorm();
    way_ = Tangent{value->x_alpha * Vector(alpha) + value->x_parameter.col(0) * mu_, mu_};
    const double size = b.norm() * g.norm();
    return size > 0.0 ? (b[0] * g[1] - b[1] * g[0]) / size : 0.0;
  }

  /// From the branch point to the arm, at the last θ.
  const Tangent& way() const { return way_; }

 private:
  Vector p_;
  double radius_, mu_ = 0.0;
  Reduced reduced_;
  Tangent way_;
};

}  // namespace

std::vector<Tangent> bifurcation_rays(Problem& problem, const Options& options, const Vector& x,
                                      const Vector& p) {
  // Small enough for the leading terms, large enough for cubic ones to stand out of rounding (1e-6 against 1e-13).
  const double radius = std::min(0.2 * options.step, 1e-2);
  constexpr int samples = 48;              // rays are told apart down to 7.5°; a hexagon's are 30° apart
  constexpr double offset = 0.0618033989;  // no symmetric direction is a sample
  constexpr double parallel = 1e-4;        // what higher terms leave of a surface of arms
  Circle circle(problem, options, x, p, radius);
  std::vector<double> theta(samples + 1), value(samples + 1);
  double largest = 0.0;
  for (int i = 0; i <= samples; ++i) {
    const auto k = static_cast<std::size_t>(i);
    theta[k] = offset + 2.0 * M_PI * i / samples;
    value[k] = i < samples ? circle(theta[k]) : value[0];
    largest = std::max(largest, std::abs(value[k]));
  }
  std::vector<Tangent> rays;
  if (largest < parallel) return rays;
  for (std::size_t k = 0; k < samples; ++k) {
    if ((value[k] < 0.0) == (value[k + 1] < 0.0)) continue;
    const Bracket bracket = find_zero(theta[k], value[k], theta[k + 1], value[k + 1], 1e-7,
                                      [&](double t) -> std::optional<double> { return circle(t); });
    if (std::abs(circle(bracket.best)) > 0.1) continue;  // a jump: g passes through zero beside λ₀
    Tangent ray = circle.way();
    normalise(problem, ray, options.scales());
    rays.push_back(std::move(ray));
  }
  return rays;
}

}  // namespace continuation
