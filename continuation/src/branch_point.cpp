#include "continuation/branch_point.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace continuation {
namespace {

using Vector2 = Eigen::Vector2d;
using Matrix2 = Eigen::Matrix2d;

// The reduced function of one kernel direction and one parameter, as a gradient (y_λ, y_α) in z = (λ, α), λ in its
// unit.
class Gradient {
 public:
  Gradient(Reduced& reduced, Vector p, const Options& options)
      : reduced_(reduced), p_(std::move(p)), parameter_(options.parameter), scale_(options.parameter_scale) {}

  std::optional<Vector2> operator()(const Vector2& z) {
    p_[parameter_] = z[0] * scale_;
    std::optional<Reduced::Value> value = reduced_.at(p_, Vector::Constant(1, z[1]));
    if (!value) return std::nullopt;
    value_ = std::move(*value);
    return Vector2(value_.y_parameter(0, 0) * scale_, value_.y_alpha(0, 0));
  }

  std::optional<Matrix2> hessian(const Vector2& z, const Vector2& at_z, const Vector2& h) {
    Matrix2 hessian;
    for (int j = 0; j < 2; ++j) {
      Vector2 shifted = z;
      shifted[j] += h[j];
      const std::optional<Vector2> value = (*this)(shifted);
      if (!value) return std::nullopt;
      hessian.col(j) = (*value - at_z) / h[j];
    }
    hessian(0, 1) = hessian(1, 0) = 0.5 * (hessian(0, 1) + hessian(1, 0));
    return hessian;
  }

  // Symmetric in ±h, so that the arms of a pitchfork come out as exact mirror images.
  std::optional<Matrix2> central_hessian(const Vector2& z, const Vector2& h) {
    Matrix2 hessian;
    for (int j = 0; j < 2; ++j) {
      const Vector2 shift = h[j] * Vector2::Unit(j);
      const std::optional<Vector2> above = (*this)(z + shift), below = (*this)(z - shift);
      if (!above || !below) return std::nullopt;
      hessian.col(j) = (*above - *below) / (2.0 * h[j]);
    }
    hessian(0, 1) = hessian(1, 0) = 0.5 * (hessian(0, 1) + hessian(1, 0));
    return hessian;
  }

  const Reduced::Value& value() const { return value_; }

 private:
  Reduced& reduced_;
  Vector p_;
  Eigen::Index parameter_;
  double scale_;
  Reduced::Value value_;
};

// Directions (dλ, dα) with dᵀ H d = 0, for indefinite H.
std::vector<Vector2> isotropic_directions(const Matrix2& h) {
  const double discriminant = h(0, 1) * h(0, 1) - h(0, 0) * h(1, 1);
  if (!(discriminant > 0.0)) return {};
  std::vector<Vector2> directions;
  for (const double root : {std::sqrt(discriminant), -std::sqrt(discriminant)}) {
    const Vector2 one(-h(0, 1) + root, h(0, 0)),
        other(h(1, 1), -h(0, 1) - root);  // parallel; the longer is safer
    directions.push_back((one.norm() > other.norm() ? one : other).normalized());
  }
  return directions;
}

// `width`: how far away the point may be; `along`: the tangent of the branch followed, of any length.
std::optional<BranchPoint> polish_simple(Problem& problem, const Options& options, const Vector& p,
                                         double width, const Tangent* along, Reduced& reduced,
                                         std::string& why) {
  const double scale = options.parameter_scale;
  Gradient gradient(reduced, p, options);
  Vector2 z(p[options.parameter] / scale, 0.0);
  const double h = std::clamp(0.05 * width, 1e-6, 1e-3);
  const Vector2 steps(h, h);
  const double tolerance = options.location_tolerance * std::max(1.0, std::abs(z[0]));
  Matrix2 hessian;
  double previous = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 12; ++k) {
    const std::optional<Vector2> value = gradient(z);
    if (!value) return why = reduced.failure(), std::nullopt;
    if (k < 2) {
      const std::optional<Matrix2> fresh = gradient.hessian(z, *value, steps);
      if (!fresh) return why = reduced.failure(), std::nullopt;
      hessian = *fresh;
      if (!(hessian.determinant() < 0.0))
        return why = "no two branches cross here (the reduced equation is definite)", std::nullopt;
    }
    const Vector2 dz = -hessian.inverse() * *value;
    const double size = dz.norm();
    if (!(size < 4.0 * width + 1e-6)) return why = "the branch point equations lead away", std::nullopt;
    z += dz;
    const bool small = std::abs(dz[0]) <= tolerance && size <= 1e-7 + tolerance;
    if (small && (size <= 1e-2 * tolerance || size > 0.3 * previous || k == 11)) {
      if (const std::optional<Matrix2> fresh = gradient.central_hessian(z, steps)) hessian = *fresh;
      const std::optional<Vector2> left = gradient(z);
      if (!left) return why = reduced.failure(), std::nullopt;
      BranchPoint point;
      const Reduced::Value& at = gradient.value();
      if (at.holding() > options.residual_tolerance)
        return why = "neutral motions must be held here: no solution", std::nullopt;
      // y ≠ 0 at its saddle: an imperfect crossing, whose two parts are sqrt(|y|/|H|) apart.
      if (std::sqrt(std::abs(at.y()[0]) / hessian.norm()) > 1e-5)
        return why = "an imperfect branch point, the branches do not meet", std::nullopt;
      point.x = at.it.x;
      point.p = at.it.p;
      point.u = at.it.u;
      // Of steps that are all rounding one may be small by chance: the one that would follow is looked at, too.
      const double next = std::abs((hessian.inverse() * *left)[0]);
      point.precision = scale * std::max({std::abs(dz[0]), next,
                                          4.0 * std::numeric_limits<double>::epsilon() * std::abs(z[0])});
      point.polished = true;
      point.null = reduced.refreshed(at);
      const std::vector<Vector2> directions = isotropic_directions(hessian);
      if (directions.empty())
        return why = "no two branches cross here (the reduced equation is definite)", std::nullopt;
      for (const Vector2& d : directions) {
        Tangent tangent{at.x_parameter.col(0) * (scale * d[0]) + at.x_alpha.col(0) * d[1], scale * d[0]};
        normalise(problem, tangent, options.scales());
        point.tangents.push_back(std::move(tangent));
      }
      const auto share = [&](const Tangent& t) {
        return std::abs(along ? inner(problem, t, *along, options.scales()) : t.p);
      };
      if (share(point.tangents[1]) > share(point.tangents[0]))
        std::swap(point.tangents[0], point.tangents[1]);
      return point;
    }
    previous = size;
  }
  return why = "Newton's method on the branch point equations does not converge", std::nullopt;
}

std::optional<BranchPoint> polish_multiple(Segment& segment, const Sample& lo, const Sample& hi,
                                           Reduced& reduced, int multiplicity, std::string& why) {
  const Options& options = segment.options();
  const Eigen::Index parameter = options.parameter;
  const Vector alpha = Vector::Zero(multiplicity);
  Vector p = lo.it.p;
  double a = lo.it.p[parameter], b = hi.it.p[parameter];
  if (a == b) return why = "the parameter does not change over the bracket", std::nullopt;
  const double span = std::abs(b - a);
  std::optional<Reduced::Value> at_a = reduced.at(p, alpha);
  p[parameter] = b;
  std::optional<Reduced::Value> at_b = at_a ? reduced.at(p, alpha) : std::nullopt;
  if (!at_b) return why = reduced.failure(), std::nullopt;
  const Matrix weight = at_b->y_alpha - at_a->y_alpha;
  const double slope = weight.norm() / span;
  double f_a = weight.cwiseProduct(at_a->y_alpha).sum(), f_b = weight.cwiseProduct(at_b->y_alpha).sum();
  const double tolerance = options.location_tolerance * std::max(options.parameter_scale, std::abs(a));
  double previous = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 20; ++k) {
    if (f_a == f_b) return why = "the secant method stalls", std::nullopt;
    const double c = b - f_b * (b - a) / (f_b - f_a), increment = std::abs(c - b);
    if (!(increment < 4.0 * span)) return why = "the branch point equations lead away", std::nullopt;
    p[parameter] = c;
    const std::optional<Reduced::Value> at_c = reduced.at(p, alpha);
    if (!at_c) return why = reduced.failure(), std::nullopt;
    a = b;
    f_a = f_b;
    b = c;
    f_b = weight.cwiseProduct(at_c->y_alpha).sum();
    const bool stalled = increment <= tolerance && increment > 0.3 * previous;
    if (increment <= 1e-2 * tolerance || f_b == 0.0 || stalled) {
      const double spread = at_c->y_alpha.norm() / slope;
      if (spread > 1e-6 * std::max(options.parameter_scale, std::abs(c)))
        return why = "several branch points close together", std::nullopt;
      BranchPoint point;
      point.polished = true;
      point.x = at_c->it.x;
      point.p = at_c->it.p;
      point.u = at_c->it.u;
      point.multiplicity = multiplicity;
      point.precision = std::max(increment, 4.0 * std::numeric_limits<double>::epsilon() * std::abs(c));
      point.null = reduced.refreshed(*at_c);
      return point;
    }
    previous = increment;
  }
  return why = "the secant method does not converge", std::nullopt;
}

}  // namespace

std::optional<BranchPoint> polish_branch_point(Segment& segment, const Sample& lo, const Sample& hi,
                                               int multiplicity, std::string& why) {
  Problem& problem = *segment.problem();
  try {
    NullVectors null = null_vectors(problem, lo.it.x, lo.it.p, multiplicity, segment.options());
    // α = 0 is the branch only if φ spans the kernel exactly: refreshed until the point no longer moves.
    double last = std::numeric_limits<double>::quiet_NaN();
    for (int round = 0; round < 5; ++round) {
      Reduced reduced(problem, segment.options(), lo.it.x, lo.it.p, null, {segment.options().parameter});
      std::optional<BranchPoint> point =
          multiplicity == 1
              ? polish_simple(problem, segment.options(), lo.it.p, hi.s - lo.s, &lo.tangent, reduced, why)
              : polish_multiple(segment, lo, hi, reduced, multiplicity, why);
      if (!point) return point;
      problem.settle(point->x, point->p);
      if (multiplicity == 1) return point;
      const double found = point->p[segment.options().parameter], moved = std::abs(found - last);
      if (moved <= segment.options().location_tolerance *
                       std::max(segment.options().parameter_scale, std::abs(found))) {
        point->precision = std::max(point->precision, moved);
        return point;
      }
      last = found;
      null = point->null;
    }
    why = "the kernel and the branch are not separated by symmetry";
  } catch (const std::domain_error& error) {
    why = error.what();
  } catch (const std::runtime_error& error) {
    why = error.what();
  }
  return std::nullopt;
}

std::optional<BranchPoint> branch_point_at(Problem& problem, const Options& options, const Vector& x,
                                           const Vector& p, double width, std::string& why) {
  try {
    Reduced reduced(problem, options, x, p, null_vectors(problem, x, p, 1, options), {options.parameter});
    return polish_simple(problem, options, p, width, nullptr, reduced, why);
  } catch (const std::domain_error& error) {
    why = error.what();
  } catch (const std::runtime_error& error) {
    why = error.what();
  }
  return std::nullopt;
}

}  // namespace continuation
