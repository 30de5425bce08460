#include "continuation/problem.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace continuation {

double Problem::residual_norm(const Vector& f) const { return f.size() ? f.lpNorm<Eigen::Infinity>() : 0.0; }

Vector Problem::parameter_derivative(const Vector& x, const Vector& p, Eigen::Index k) {
  const double h = std::cbrt(std::numeric_limits<double>::epsilon()) * std::max(1.0, std::abs(p[k]));
  const auto at = [&](double value) {
    Vector shifted = p;
    shifted[k] = value;
    return residual(x, shifted);
  };
  try {
    return (at(p[k] + h) - at(p[k] - h)) / ((p[k] + h) - (p[k] - h));
  } catch (const std::domain_error&) {
    // Next to the end of the domain: one-sided, of second order too.
  }
  try {
    return (3.0 * at(p[k]) - 4.0 * at(p[k] - h) + at(p[k] - 2.0 * h)) / (2.0 * h);
  } catch (const std::domain_error&) {
    return (-3.0 * at(p[k]) + 4.0 * at(p[k] + h) - at(p[k] + 2.0 * h)) / (2.0 * h);
  }
}

Vector Problem::retract(const Vector& x, const Vector& dx) const { return x + dx; }

double Problem::inner(const Vector& a, const Vector& b) const {
  return a.size() == 0 ? 0.0 : a.dot(b) / static_cast<double>(a.size());
}

Vector Problem::dual(const Vector& a) const {
  const double square = a.squaredNorm();
  if (square == 0.0) return a;
  return a * (inner(a, a) / square);
}

int Problem::complex_index(const Vector&, const Vector&) { return 0; }

int Problem::breaking_index(const Vector&, const Vector&) { return -1; }

std::optional<Unrestricted> Problem::unrestricted(const Vector&, const Vector&) { return std::nullopt; }

int Problem::determinant_sign() { return 0; }

std::vector<Vector> Problem::kernel_directions(const Vector&, const Vector&, const Matrix&) { return {}; }

std::vector<EventFunction> Problem::events(const Vector&, const Vector&) { return {}; }

std::optional<Transition> Problem::resettled(const Vector&, const Vector&, const Vector&, const Vector&) {
  return std::nullopt;
}

std::optional<Transition> Problem::transition(std::size_t, const Vector&, const Vector&) {
  return std::nullopt;
}

std::optional<Vector> Problem::adapt(const Vector&, const Vector&) { return std::nullopt; }

std::optional<Vector> Problem::carried_over(const Problem&, const Vector&, const Vector&) {
  return std::nullopt;
}

std::string Problem::unsettled(const Vector& x, const Vector& dx) const {
  (void)x, (void)dx;
  return {};
}

Matrix Problem::neutral_motions(const Vector& x, const Vector& p) {
  (void)x, (void)p;
  return Matrix(size(), 0);
}

bool Problem::settle(Vector&, const Vector&) { return false; }

Vector Problem::fingerprint(const Vector& x, const Vector&) { return x; }

}  // namespace continuation
