#pragma once

#include <optional>
#include <string>
#include <vector>

#include "continuation/corrector.hpp"

namespace continuation {

/// Approximate null vectors of J.
struct NullVectors {
  Matrix right;  ///< J φ ≈ 0; n×k, orthogonal columns, unit in the metric
  Matrix left;   ///< Jᵀ ψ ≈ 0; n×k, orthonormal
};

/// Null vectors other than neutral motions, in the units of the options, by iterating [J ψ; φᵀ 0][φ' ; g] = [0; 1] and its transpose, from fixed starting borders.
/// Regular also where J is singular; converges like inverse iteration where it is not.
/// @throws std::runtime_error if the bordered matrix is singular (the kernel has more than k dimensions)
NullVectors null_vectors(Problem& problem, const Vector& x, const Vector& p, Eigen::Index k,
                         const Options& options, int passes = 3);

/// y_α of the reduction below with these null vectors (the first columns): zero where J is singular, smooth along a
/// branch. One factorisation. @throws as Problem::factor
double nearness(Problem& problem, const Vector& x, const Vector& p, const NullVectors& null,
                const Options& options);

/// Lyapunov-Schmidt reduction y(p, α) of F near a point where J is nearly singular:
///
///     F(x, p) + ψ y = 0,      φ*ᵀ u = α,      φ*ᵀ φ = 1,
///
/// solved for x and y at given p, α (k entries each). It is regular at the singular point, and F(x, p) = 0 ⇔
/// y = 0. Every simple singularity is a statement about y:  fold y = y_α = 0;  branch point y = y_α = y_λ =
/// 0.
///
/// Where motions cost nothing (Problem::neutral_motions) one more border each holds them; the forces that this takes must
/// vanish.
class Reduced {
 public:
  struct Value {
    Iterate it;          ///< x, u, p and y
    Vector alpha;        ///< k
    Matrix y_alpha;      ///< ∂y/∂α; k×k, the matrix whose singularity is J's
    Matrix x_alpha;      ///< ∂x/∂α; n×k
    Matrix y_parameter;  ///< ∂y/∂p_j, one column a parameter asked for
    Matrix x_parameter;  ///< ∂x/∂p_j
    Vector y() const { return it.y.head(alpha.size()); }
    /// Largest of the forces that hold neutral motions, in the unit of F.
    double holding() const;
  };

  /// @param parameters  for which derivatives are wanted
  Reduced(Problem& problem, const Options& options, const Vector& x, const Vector& p, NullVectors null,
          std::vector<Eigen::Index> parameters);

  /// y and its first derivatives at (p, α), guessed from the last value. Two or three factorisations.
  /// @return nullopt where Newton's method fails, see failure()
  std::optional<Value> at(const Vector& p, const Vector& alpha);

  /// Null vectors of J at the value, exact if y_α = 0 there; the last call of `at` must have returned
  /// `value`.
  NullVectors refreshed(const Value& value);

  const NullVectors& null() const { return null_; }
  const std::string& failure() const { return failure_; }

 private:
  void differentiate(Value& value, bool factored);

  Problem& problem_;
  const Options& options_;
  NullVectors null_;
  std::vector<Eigen::Index> parameters_;
  Borders borders_;
  Value last_;
  std::string failure_;
};

}  // namespace continuation
