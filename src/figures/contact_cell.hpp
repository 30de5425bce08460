#pragma once

#include <optional>
#include <string>
#include <vector>

#include "windlass/equilibrium/solution.hpp"
#include "windlass/figures/figure.hpp"

/// The contact of one stable state, as the figures of pressure show it: φ = π and 2π at three tensions.
namespace windlass::figures {

struct ContactCell {
  std::string stem;  ///< of its data file
  equilibrium::Solution state;
  double highest_pressure = 0.0, highest_force = 0.0;  ///< [EI/ρ³], [EI/ρ²]
};

inline constexpr double contact_tensions[] = {0.3, 0.9, 7.0};   ///< those of the paper [EI/ρ²]
inline constexpr const char* contact_angles[] = {"pi", "2pi"};  ///< names in the study
inline constexpr const char* contact_titles[] = {"φ = π", "φ = 2π"};

/// Row by row of the figures: π and 2π at the first tension, then at the next.
///
/// Each has a data file STEM.dat; places round the axis are in units of π, 0 at the south pole. Blocks: 0 line contacts
/// (place, p, z); 1 point forces of the cylinder (place, f, z); 2 the rod between its outermost contacts (place, z);
/// 3 forces between strands (place, f, z).
std::vector<ContactCell> contact_cells(const Study& study, const Canvas& canvas);

/// The clove hitch at the same tensions; nullopt above those that its runs reach.
std::vector<std::optional<ContactCell>> knot_cells(const Study& study, const Canvas& canvas);

/// On the cylinder; a line that strands press on counts once, and what it carries there is no touch.
int lines_of(const equilibrium::Solution& state);
int touches_of(const equilibrium::Solution& state);
/// Places where strands touch each other, a line counts once.
int strand_contacts_of(const equilibrium::Solution& state);

/// Names of contact and shape above a panel.
std::string contact_heading(const ContactCell& cell);

/// Grey band behind a panel: the contact that the closed form of the flat coil has at that tension, if any.
std::string flat_contact_band(const equilibrium::Solution& state);

/// The two angles over their columns; to be followed by `unset label 60` and `61` once drawn.
std::string column_titles(double left, double right);

}  // namespace windlass::figures
