#pragma once

#include <Eigen/Dense>
#include <memory>
#include <optional>
#include <vector>

#include "windlass/bvp/arc.hpp"
#include "windlass/obstacle/surface.hpp"

/// A rod that lies on an obstacle, whichever it is: its arc and the forces on it.
///
/// Configuration (ψ, χ): inclination of the tangent to u₀ of the obstacle's chart, twist of the material frame against the
/// Darboux frame D₁ = N, D₂ = t × N, D₃ = t. Momenta (m·N, m·t) along the arc; forces n conserved on it, conjugate to u.
namespace windlass::rod {

struct Material {
  double bending_stiffness = 1.0;                     ///< B, of an isotropic rod
  Eigen::Vector3d stiffness = {1.0, 1.0, 2.0 / 3.0};  ///< K [EI]
  Eigen::Vector3d natural = Eigen::Vector3d::Zero();  ///< û [1/ρ]
  double compliance = 0.0;                            ///< 1/EA [ρ²/EI]
  Eigen::Vector3d weight = Eigen::Vector3d::Zero();   ///< known force per length, world frame [EI/ρ³]
  bool stretches = false;  ///< may it stretch, or weigh? What its arcs are made for
  /// 1 + ε of a section with the tension n·d₃.
  double stretch(double tension) const { return 1.0 + compliance * tension; }
};

/// @throws std::invalid_argument for a rod or an obstacle that has no density yet
std::unique_ptr<bvp::Arc> make_line_arc(const obstacle::Surface& surface, const Material& rod,
                                        const std::vector<double>& mesh, int stages);

/// State of one section of a line contact.
struct LineSection {
  Eigen::Vector3d n, m;  ///< internal force and moment in the Darboux frame
  double pressure;       ///< contact force per length p, along N on the rod [EI/ρ³]
  double hoop;           ///< p + (n·N)': ∫ p ds is the integral of this and the fall of n·N
};
LineSection line_section(const obstacle::Surface& surface, const Material& rod, const Eigen::Vector2d& q,
                         const Eigen::Vector2d& momentum, const Eigen::Vector2d& n);

/// The conserved forces of a line contact through a section with the world-frame state (r, n, m).
Eigen::Vector2d line_forces(const obstacle::Surface& surface, const Eigen::Vector2d& u,
                            const Eigen::Vector3d& r, const Eigen::Vector3d& n, const Eigen::Vector3d& m);

/// Where the obstacle holds a straight part without any pressure, nothing but its own stiffness keeps the rod there: it
/// comes off when the thrust P along it reaches the buckling load of a clamped rod of its length, 4π² K/ℓ².
/// @returns 1 − P ℓ²/(4π² K), K the stiffness of bending off the obstacle, P (1 − P/EA) in the place of P where the rod
///          stretches; nothing for a line under pressure
std::optional<double> buckling_margin(const obstacle::Surface& surface, const Material& rod, double twist,
                                      double tension, double length);

}  // namespace windlass::rod
