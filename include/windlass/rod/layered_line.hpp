#pragma once

#include "windlass/rod/dual.hpp"
#include "windlass/rod/surface_density.hpp"

namespace windlass::rod {

/// What a cylinder that slips along a line on it is to the rod.
struct Friction {
  double mu = 0.0;
  double arm = 0.0;         ///< r: it acts this far below the centre line [ρ]
  double compliance = 0.0;  ///< k = 1/EA of the rod [ρ²/EI]
  double travel =
      0.0;  ///< ω: the rod runs along itself at ω times the cylinder's speed, in reference lengths
};

/// Layers narrower than this [ρ] are point forces: where p would flow in there, one lifts nothing, but presses the free arc into the
/// cylinder by F w³/B, 1e-20.
inline constexpr double narrowest_layer = 3e-7;

/// One section of a line on the unit cylinder that slips along the rod, with all that the friction does to it: it turns the rod about
/// the centre line, by `arm`, and stretches it, by k (PHYSICS, "The moment of the friction", "Stretch while sliding"). Numbers with
/// derivatives with the section's six variables, of which the first four are ψ, ψ', χ' or m₃, then n_a, n_z and ω.
///
/// With g = (n_a − m₃ sin ψ) sin ψ − n_z cos ψ, D = 1 + k B cos⁴ψ, E = λ D = 1 + k (n_a cos ψ + n_z sin ψ − m₃ sin ψ cos ψ)
/// and d the direction of slip,
///
///     n_N = ν − w p,   ν = ψ' f,   f = (m₃ − k B cos²ψ g)/E − B sin ψ cos ψ (3 − k B cos⁴ψ)/D,
///     w = mu d_t (r + k B cos²ψ)/E,   (w p)' = (1 − α) p − p₀,   p₀ = λ cos ψ n_θ − ψ'' f − ψ'² ∂f/∂ψ,
///     −α p = what friction changes of ν a length, by n_a' = −mu (1 − r) p d_θ, n_z' = −mu p d_z, M' = −r mu p d_b.
struct LayeredSection {
  static constexpr int variables = 6;
  using Number = Dual<variables>;
  enum Variable { psi, bend, twist, around, axial, travel };

  Number normal;            ///< ν [EI/ρ²]
  Number lever;             ///< w [ρ]
  Number pressure;          ///< p₀ [EI/ρ³]
  Number share;             ///< α
  Number drag[2];           ///< −n_a', −n_z' over p
  Number across;            ///< −M' over p
  Number stretch;           ///< λ
  Number load, momenta[2];  ///< ∂L/∂ψ; B ψ' and m₃ [EI/ρ]
  Number moved[2];          ///< (a', z')
  double stored = 0.0;      ///< elastic energy a length, that of the stretch too [EI/ρ²]

  /// @param slope  (ψ', χ'); the third variable is χ'
  static LayeredSection at(const SurfaceDensity& rod, const Friction& friction, double psi,
                           const Eigen::Vector2d& slope, const Eigen::Vector2d& n);
  /// @param momentum  (B ψ', m₃); the third variable is m₃, the second still ψ'
  static LayeredSection with_momentum(const SurfaceDensity& rod, const Friction& friction, double psi,
                                      const Eigen::Vector2d& momentum, const Eigen::Vector2d& n);
};

}  // namespace windlass::rod
