#pragma once

#include <functional>
#include <utility>

#include <string>

#include "continuation/options.hpp"
#include "continuation/problem.hpp"

namespace continuation {

/// Extra unknowns y and equations that border F = 0:
///
///     F(x, p) + Ψ β = 0,      Cᵀu + D y = g,      y = (Δp, β) or β,
///
/// with u the sum of the state's increments since a base and Δp the change of the varied parameter since
/// there. Keller's constraint is Ψ empty, C = dual(t_x), D = t_p, g = ds; a fixed parameter is C = 0, D = 1,
/// g = Δp.
struct Borders {
  Eigen::Index parameter = -1;  ///< the parameter that varies; -1: none
  double scale = 1.0;           ///< its unit in the metric
  Matrix psi;                   ///< Ψ, n×m, m may be 0
  Matrix c;                     ///< C, n×q, q = m + (1 if a parameter varies)
  Matrix d;                     ///< D, q×q
  Vector g;                     ///< g, q
  double state_scale = 1.0;     ///< the state's unit in the metric
};

/// What Newton's method changes. u and y are relative to the base of the borders.
struct Iterate {
  Vector x;  ///< stored state
  Vector u;  ///< sum of increments; shape n
  Vector p;  ///< all parameters
  Vector y;  ///< extra unknowns; shape q
};

struct CorrectorReport {
  bool converged = false;
  int iterations = 0;      ///< corrections above the tolerance; an exact guess takes none
  int factorizations = 0;  ///< calls of Problem::factor
  double contraction =
      0.0;  ///< |δ₁|/|δ₀| with one factorisation; 0 if the first correction was within tolerance
  double increment = 0.0;      ///< last |δ|
  double residual = 0.0;       ///< last max |F + Ψβ|
  bool factored_here = false;  ///< the last factorisation was made at the returned state, with these borders
  std::string failure;         ///< why it did not converge
};

/// A bordered system at an iterate: all that a nonlinear solver needs of it.
class BorderedSystem {
 public:
  /// All are kept by reference.
  BorderedSystem(Problem& problem, const Borders& borders, Iterate& iterate);

  /// n + q.
  Eigen::Index size() const { return n_ + borders_.c.cols(); }

  /// −(F + Ψβ) and g − Cᵀu − D y at the iterate, stacked.
  /// @throws std::runtime_error if the residual is not finite; std::domain_error as the problem does
  const Vector& defect();
  /// max |F + Ψβ| of the last defect.
  double residual() const { return residual_; }
  /// What rounding makes of F at the iterate: its change where every number of x is off by its last digit.
  double noise();

  /// Factors the bordered Jacobian at the iterate. @throws as Problem::factor does
  void factor();
  /// Solves with the last factorisation; r and the result: n + q. @throws std::runtime_error if not finite
  Vector solve(const Vector& r);

  /// Length of a correction (dx, dy) in the metric of x and the varied parameter.
  double length(const Vector& delta) const;
  /// rms of the stored state, in its unit.
  double state_size() const;
  /// Adds a correction to the iterate.
  void add(const Vector& delta);

  const Iterate& iterate() const { return it_; }
  int factorizations() const { return factorizations_; }

 private:
  bool parameter_free() const { return borders_.parameter >= 0; }

  Problem& problem_;
  const Borders& borders_;
  Iterate& it_;
  const Eigen::Index n_;
  Vector defect_;
  double residual_ = 0.0;
  int factorizations_ = 0;
};

/// When Newton's corrections are over: on increment and residual together.
///
/// |δ| ≤ newton_tolerance and max |F| ≤ residual_tolerance; or corrections no longer shrink and are what
/// rounding leaves of a state with large entries.
class StoppingRule {
 public:
  /// From a far guess corrections may grow, as long as they do not run away.
  enum class Guess { near, far };

  /// @param noise  what rounding leaves of the residual (BorderedSystem::noise); asked for only where corrections stall
  explicit StoppingRule(const Options& options, Guess guess = Guess::near, std::function<double()> noise = {})
      : options_(options), guess_(guess), noise_(std::move(noise)) {}

  /// Of a correction found with an old factorisation: would three more such corrections not do?
  bool slow(double length) const;

  /// Takes in a correction at a state with this residual and size, `fresh` if found with that state's own factorisation;
  /// true if it is the last one.
  /// @throws std::runtime_error if corrections grow (near guess) or run away (far guess)
  bool last(double length, double residual, double state_size, bool fresh);

  /// Was the last correction small, and another one asked for only to see off what the metric does not see? Says nothing
  /// about how hard the solve is, and is not counted.
  bool settling() const { return settling_; }

  /// So small a correction need not be added: the factorisation then belongs to the state exactly.
  bool negligible(double length) const { return length <= 1e-3 * options_.newton_tolerance; }

 private:
  double contraction(double length) const { return length / previous_; }
  bool over(double length, bool all_rounding) const;
  bool is_noise(double residual) const;

  const Options& options_;
  const Guess guess_;
  const std::function<double()> noise_;
  int taken_ = 0;
  bool settling_ = false;
  double previous_ = 0.0, previous_residual_ = 0.0;
};

/// Solves F = 0 with borders from a guess. A problem that has a nonlinear solver of its own hands it out by
/// Problem::newton.
class BorderedNewton {
 public:
  virtual ~BorderedNewton() = default;

  /// Changes the iterate. A solve that fails is reported, not thrown: std::domain_error and
  /// std::runtime_error of the problem, NaN and infinity included.
  virtual CorrectorReport solve(Problem& problem, const Borders& borders, Iterate& iterate,
                                const Options& options) = 0;
};

/// Newton's method with few factorisations.
///
/// A factorisation is kept for further corrections (chord method) as long as the observed contraction θ
/// promises the tolerance within three of them, |δ| θ³ ≤ tolerance; the trial costs one solve where it
/// fails. A correction that grows on a fresh factorisation rejects the solve.
class ChordNewton final : public BorderedNewton {
 public:
  CorrectorReport solve(Problem& problem, const Borders& borders, Iterate& iterate,
                        const Options& options) override;
};

}  // namespace continuation
