#pragma once

#include <optional>
#include <string>

#include "continuation/reduced.hpp"

namespace continuation {

enum class LocusKind { fold, branch_point, event };

/// "fold", "branch_point", "event".
const char* name(LocusKind kind);

/// The few equations that define a special point in two parameters λ, μ, with x slaved through the reduction
/// F(x, λ, μ) + ψ y = 0, φ*ᵀ u = α  (see Reduced):
///
///     fold           y = 0,   y_α = 0                  z = (λ, μ, α)
///     branch point   y_λ = 0, y_α = 0                  z = (λ, μ, α)     (y = 0 follows where the crossing
/// persists)
///     event          y = 0,   e(x, λ, μ) = 0           z = (λ, μ, α)
///     k-fold branch point   tr(Wᵀ y_α) = 0, α = 0      z = (λ, μ)        W = ∂y_α/∂λ at the base
///
/// One equation fewer than unknowns: a curve. All of them are regular where J is singular, and at cusps.
class LocusSystem {
 public:
  /// @param first, second  indices of λ and μ
  /// @param event          name of the event function followed; for LocusKind::event only
  /// @throws std::runtime_error if no null vectors can be found; std::invalid_argument if there is no such
  /// event
  LocusSystem(std::shared_ptr<Problem> problem, const Options& options, LocusKind kind, int multiplicity,
              std::string event, Eigen::Index first, Eigen::Index second, const Vector& x, const Vector& p,
              std::optional<NullVectors> null = std::nullopt);

  /// Number of unknowns, 3 or 2.
  Eigen::Index size() const { return kind_ == LocusKind::branch_point && multiplicity_ > 1 ? 2 : 3; }

  /// z of the base: (λ, μ, 0).
  Vector base() const;

  /// The size() − 1 residuals at z; nullopt where F cannot be solved, see failure(). Free at the last z
  /// again.
  std::optional<Vector> residual(const Vector& z);

  /// Derivative of the residuals by differences, (size() − 1)×size(). `at_z`: the residual there.
  std::optional<Matrix> jacobian(const Vector& z, const Vector& at_z);

  /// The solution of the last successful call of residual.
  const Reduced::Value& value() const { return *value_; }

  /// Null vectors there, for the next base; right after `residual` only.
  NullVectors refreshed() { return reduced_.refreshed(*value_); }

  /// Cosine of the angle between the null vector there and the border; the system wants a new base when it
  /// is small.
  double alignment() const;

  /// Distance in the plane of y's arguments by which a crossing has come apart, sqrt(|y| / |∂²y|); 0 but for
  /// branch points.
  double imperfection(const Matrix& jacobian) const;

  const std::shared_ptr<Problem>& problem() const { return problem_; }
  const std::string& failure() const { return failure_; }

 private:
  Vector parameters(const Vector& z) const;

  std::shared_ptr<Problem> problem_;
  Options options_;
  LocusKind kind_;
  int multiplicity_;
  std::string event_;
  Eigen::Index first_, second_;
  Vector p_;
  Reduced reduced_;
  Matrix weight_;
  std::optional<Reduced::Value> value_;
  Vector last_z_, last_residual_;  // empty: the last evaluation failed
  std::string failure_;
};

}  // namespace continuation
