#pragma once

#include <vector>

#include "windlass/chain/profile.hpp"
#include "windlass/chain/topology.hpp"
#include "windlass/equilibrium/scales.hpp"

/// Gaps that have just opened in a line contact.
///
/// With the pressure p = p₀ + a s²/2 about its least value, the deviation from the line obeys B d⁴η/ds⁴ = −p with
/// η = η' = η″ = 0 at both ends:
///
///     η = (a/720B) (h² − s²)³,   h² = −10 p₀/a,   edge forces a h³/15, together ∫ p ds.
///
/// Beside a touch, p = p₀ + b s:  η = (b/120B) s² (l − s)³,  l = −(5/3) p₀/b,  edge force b l²/20.
/// While η is below `micro_height` the line's shape is the rod's, its signed pressure stands for the edge forces (their
/// sum is the same), and the gap needs no arc: it is entered and left exactly at the event, p₀ = 0.
namespace windlass::equilibrium {

struct MicroGap {
  enum class Where { inside, begin, end } where = Where::inside;
  double s = 0.0;  ///< place of the least pressure
  double p = 0.0;  ///< least pressure; negative while the gap is open
  double from = 0.0, to = 0.0;
  double height = 0.0;  ///< largest η [ρ]
  double room =
      1.0;  ///< distance to the line's ends over half the length, less 1: negative where it sticks out
};

/// A line contact and the gaps in it.
struct LineContact {
  std::vector<MicroGap> gaps;
  double least_pressure = 0.0, s = 0.0;  ///< outside them, and its place
};

/// @param begins_at_mid  the line begins at the mid-point of a symmetric rod, and goes on beyond
LineContact line_contact(const chain::Piece& line, const chain::MicroGaps& gaps, bool begins_at_mid,
                         bool ends_at_mid, const Scales& scales);

/// Height of a gap with an arc of its own, if as short as those without.
/// @param force  at the edge, @param length  half the gap's inside a line, all of it beside a touch
double height_of_gap(double force, double length, bool beside_touch, const Scales& scales);

/// Least value of a sampled quantity.
struct Least {
  double value, s;
};
/// Between the neighbours of sample k, on the polynomials of the elements there: an event located by samples would move
/// with the mesh.
Least least_near(const chain::Piece& piece, const Eigen::VectorXd& values, Eigen::Index k);

}  // namespace windlass::equilibrium
