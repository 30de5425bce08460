#pragma once

#include <span>
#include <vector>

#include "windlass/measurement/measurements.hpp"

namespace windlass::measurement {

/// A measured strength beside the contact force the model has at the same pull.
struct ComparedPoint {
  Measurement measured;
  double R_tot = 0.0;  ///< [EI/ρ²], > 0
};

/// How much each F0 is trusted.
enum class Weights {
  automatic,  ///< from the F0_error of the points where all have one, else `absolute`
  absolute,   ///< the same absolute error for all: F0/R_tot counts like R_tot², so high tensions decide
  relative,   ///< an error in proportion to R_tot: every ratio F0/R_tot counts the same
};

struct FrictionFit {
  double mu = 0.0;
  double standard_error = 0.0;
  double low = 0.0, high = 0.0;  ///< 95 % interval
  double chi_squared = 0.0;      ///< Σ wᵢ (F0ᵢ − mu R_totᵢ)²
  int degrees_of_freedom = 0;
  double residual_deviation = 0.0;  ///< √(chi²/degrees): 1 if given errors are right; else in units of 1/√wᵢ
  bool errors_given = false;  ///< weights are 1/F0_error², and the standard error takes them at their word
  double p_value = 0.0;       ///< where errors are given: chance of a chi² at least as large
  std::vector<double> residuals;  ///< F0ᵢ − mu R_totᵢ [EI/ρ²]
};

/// Least squares of Amontons' law F0 = mu R_tot(T), Σ wᵢ (F0ᵢ − mu R_totᵢ)² → min, by Eigen's QR.
///
/// The paper reads mu off the slope at high tension, where R_tot → phi T; equal absolute errors do that, with R_tot in
/// place of phi T, so that lower tensions may take part. Without given errors the variance is that of the residuals,
/// and the interval Student's with N − 1 degrees of freedom; with them it is the normal distribution's.
/// @throws InputError for fewer than two points
FrictionFit fit_friction(std::span<const ComparedPoint> points, Weights weights = Weights::automatic);

}  // namespace windlass::measurement
