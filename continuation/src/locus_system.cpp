#include "continuation/locus_system.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "event_by_name.hpp"

namespace continuation {
namespace {

constexpr double kDifference = 1e-5;  // y and its derivatives come from solves to roundoff

}  // namespace

const char* name(LocusKind kind) {
  switch (kind) {
    case LocusKind::fold:
      return "fold";
    case LocusKind::branch_point:
      return "branch_point";
    case LocusKind::event:
      return "event";
  }
  return "?";
}

LocusSystem::LocusSystem(std::shared_ptr<Problem> problem, const Options& options, LocusKind kind,
                         int multiplicity, std::string event, Eigen::Index first, Eigen::Index second,
                         const Vector& x, const Vector& p, std::optional<NullVectors> null)
    : problem_(std::move(problem)),
      options_(options),
      kind_(kind),
      multiplicity_(kind == LocusKind::branch_point ? std::max(1, multiplicity) : 1),
      event_(std::move(event)),
      first_(first),
      second_(second),
      p_(p),
      reduced_(*problem_, options_, x, p,
               null ? std::move(*null) : null_vectors(*problem_, x, p, multiplicity_, options), {first}) {
  if (kind_ == LocusKind::event && !find(problem_->events(x, p), event_))
    throw std::invalid_argument("locus: the problem has no event \"" + event_ + "\"");
  if (size() == 3) return;
  // W from one difference in λ.
  const Vector alpha = Vector::Zero(multiplicity_);
  Vector shifted = p;
  const double h = 1e-3 * std::max(1.0, std::abs(p[first]));
  shifted[first] += h;
  const auto above = reduced_.at(shifted, alpha);
  const auto here = above ? reduced_.at(p, alpha) : std::nullopt;
  if (!here) throw std::runtime_error("locus: " + reduced_.failure());
  weight_ = (above->y_alpha - here->y_alpha) / h;
  weight_ /= std::max(weight_.squaredNorm(), 1e-300);
}

Vector LocusSystem::base() const {
  Vector z = Vector::Zero(size());
  z[0] = p_[first_];
  z[1] = p_[second_];
  return z;
}

Vector LocusSystem::parameters(const Vector& z) const {
  Vector p = p_;
  p[first_] = z[0];
  p[second_] = z[1];
  return p;
}

std::optional<Vector> LocusSystem::residual(const Vector& z) {
  if (last_z_.size() == z.size() && last_z_ == z) return last_residual_;
  last_z_.resize(0);
  const Vector p = parameters(z);
  const Vector alpha = size() == 3 ? Vector::Constant(1, z[2]) : Vector::Zero(multiplicity_);
  std::optional<Reduced::Value> value = reduced_.at(p, alpha);
  if (!value) return failure_ = reduced_.failure(), std::nullopt;
  Vector r(size() - 1);
  try {
    switch (kind_) {
      case LocusKind::fold:
        r << value->y()[0], value->y_alpha(0, 0);
        break;
      case LocusKind::branch_point:
        if (size() == 2) {
          r[0] = weight_.cwiseProduct(value->y_alpha).sum();
        } else {
          r << value->y_parameter(0, 0), value->y_alpha(0, 0);
        }
        break;
      case LocusKind::event: {
        const std::vector<EventFunction> events = problem_->events(value->it.x, p);
        const EventFunction* event = find(events, event_);
        if (!event) return failure_ = "event \"" + event_ + "\" no longer exists", std::nullopt;
        r << value->y()[0], event->value;
      }
    }
  } catch (const std::domain_error& error) {
    return failure_ = error.what(), std::nullopt;
  } catch (const std::runtime_error& error) {
    return failure_ = error.what(), std::nullopt;
  }
  if (!r.allFinite()) return failure_ = "the locus equations are not finite", std::nullopt;
  value_ = std::move(value);
  last_z_ = z;
  last_residual_ = r;
  return r;
}

double LocusSystem::alignment() const {
  const Matrix& x_alpha = value_->x_alpha;
  const Matrix& border = reduced_.null().right;
  double least = 1.0;
  for (Eigen::Index i = 0; i < border.cols(); ++i)
    least = std::min(
        least, std::abs(x_alpha.col(i).dot(border.col(i))) / (x_alpha.col(i).norm() * border.col(i).norm()));
  return least;
}

std::optional<Matrix> LocusSystem::jacobian(const Vector& z, const Vector& at_z) {
  Matrix jacobian(size() - 1, size());
  const std::optional<Reduced::Value> keep = value_;
  for (Eigen::Index j = 0; j < size(); ++j) {
    Vector shifted = z;
    shifted[j] += kDifference * std::max(1.0, std::abs(z[j]));
    const double h = shifted[j] - z[j];
    std::optional<Vector> r = residual(shifted);
    if (!r) {  // at the edge of F's domain: from the other side
      shifted[j] = z[j] - h;
      r = residual(shifted);
    }
    if (!r) return std::nullopt;
    jacobian.col(j) = (*r - at_z) / (shifted[j] - z[j]);
  }
  value_ = keep;
  return jacobian;
}

double LocusSystem::imperfection(const Matrix& jacobian) const {
  if (kind_ != LocusKind::branch_point || size() != 3) return 0.0;
  return std::sqrt(value_->y().cwiseAbs().maxCoeff() / std::max(jacobian.norm(), 1e-300));
}

}  // namespace continuation
