#pragma once

/// The elastica between a place where its tangent makes the angle ψ with the pull and its moment-free end: a pendulum
/// released from rest at ψ_e, the angle at the end. With q = sin²(ψ/2), ρ = sin²(ψ_e/2)/q and u = √(T/B) s, s the length
/// from the end,
///
///     u(ρ, q) = ½ ∫ dt / √(t (1 − t) (t − ρq)) over t from ρq to q
///             = √(1 − x) R_F(x, ρ, 1),   x = ρ (1 − q)/(1 − ρq)      (Carlson's R_F; NIST DLMF 19.25.5).
namespace windlass::rod {

/// ρ and 1 − ρ, both to all digits: far from the end the one is next to nothing, close to it the other, ~ u².
struct EndRatio {
  double rho = 0.0, deficit = 1.0;
  static EndRatio of_log(double log_rho);
  /// cosh²v = 1/ρ: how much sin²(ψ/2) has grown since the end.
  static EndRatio of_growth(double v);
  double growth() const;
};

struct FreeEnd {
  EndRatio ratio;
  double log_slope = -0.5;  ///< ρ ∂u/∂ρ
  double by_q = 0.0;        ///< ∂ρ/∂q at constant u
  double by_u = 0.0;        ///< ∂ρ/∂u at constant q
};

/// Beyond this many decay lengths the end is not felt: ρ ~ exp(−2u) = 1e-35, and the tail is the infinite one.
inline constexpr double far_end = 40.0;

/// u(ρ, q) and ρ ∂u/∂ρ. @param q  sin²(ψ/2) in [0, 1)
struct Elapsed {
  double u, log_slope;
};
Elapsed elapsed(const EndRatio& ratio, double q);
/// u(ρ, q) alone.
double time_from_end(const EndRatio& ratio, double q);

/// The free end u decay lengths away. @param u  > 0
FreeEnd free_end(double u, double q);

/// Bending energy between here and the end, over 2 √(B T). @param u  u(ρ, q)
double bending(const EndRatio& ratio, double log_slope, double q, double u);

}  // namespace windlass::rod
