#pragma once

#include <optional>

#include "windlass/equilibrium/start.hpp"

/// What the ways to a first equilibrium share.
namespace windlass::equilibrium {

/// Stages an element of a first mesh.
inline constexpr int start_stages = 6;
/// Between touches that stand for a line, which are near each other, and many.
inline constexpr int stages_along_strand = 4;

/// A first mesh for a stretch of this length.
chain::ArcMesh first_mesh(chain::Stretch stretch, const contact::Loads& loads, double length);

/// Right-half topology and joint places given; the full chain is its mirror image.
struct Draft {
  std::vector<chain::Stretch> right;
  bool mid_touch = false;
  std::vector<double> s;  ///< from the mid-point, right half
};

/// The equilibrium on the contacts of a draft, from the shape as guess; nullopt where Newton does not converge or a contact
/// would pull.
std::optional<Started> attempt(const scene::Scene& scene, bool spatial, bool half,
                               const std::vector<std::string>& keys, const Draft& draft,
                               const chain::Profile& profile);

/// Is the state a solution of the unilateral problem: forces and gaps nonnegative? A force of zero (an event) passes.
/// A free loop that only grazes the cylinder carries no force at all and is no equilibrium in contact.
bool contacts_hold(RodProblem& problem, const Vector& x, const Vector& p);

/// The state of `scene`, followed from a half-chain state at another value of the one parameter on `from.p`.
/// @param failure  why it was not reached
/// @throws NoContact where the rod lifts off on the way
std::optional<Started> reach(const Started& from, const scene::Scene& scene, double goal, bool half,
                             const std::vector<std::string>& keys, std::string& failure);

/// The flat coil, in milliseconds: on the closed form's contacts, or followed from a higher tension.
/// @param scene    in natural units
/// @param failure  why it was not reached
/// @throws NoContact where the rod lifts off on the way
std::optional<Started> followed_coil(const scene::Scene& scene, bool spatial, bool half,
                                     const std::vector<std::string>& keys, std::string& failure);

/// A knot and no plate, relaxed as a rod that does not stretch at a pull at which its contacts are few, then stretched, then
/// tightened or loosened.
std::optional<Started> knot_start(const scene::Scene& scene, bool half, const std::vector<std::string>& keys,
                                  std::string& failure);

/// The scene of the rod that does not stretch, though its chain may.
scene::Scene inextensible(scene::Scene scene);
/// What a branch towards the rod that stretches is followed in.
inline const std::vector<std::string> by_compliance{"rod.axial_compliance"};

/// A strut's half chain near a given shape; nullopt where Newton does not converge.
std::optional<Started> strut_near(const scene::Scene& scene, const chain::Profile& shape, double thrust,
                                  const std::vector<std::string>& keys);
/// Struts that stretch, at the scene's shortening, and struts that weigh. @throws NoEquilibrium
Started stretched_strut(const scene::Scene& scene, bool half, const std::vector<std::string>& keys);
Started weighted_strut(const scene::Scene& scene, bool half, const std::vector<std::string>& keys);

/// A strut under the scene's thrust, or at its shortening. @throws NoEquilibrium
Started straight_strut(const scene::Scene& scene, bool half, const std::vector<std::string>& keys);
Started buckled_strut(const scene::Scene& scene, bool half, const std::vector<std::string>& keys);

}  // namespace windlass::equilibrium
