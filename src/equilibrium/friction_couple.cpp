#include "friction_couple.hpp"

#include <fmt/format.h>

#include "dragged_further.hpp"

namespace windlass::equilibrium {

using chain::Stretch;

bool carries_couple(const Topology& topology) {
  for (int i = 0; i < static_cast<int>(topology.stretches.size()); ++i) {
    if (topology.lies_flat(i) || topology.touches_flat(i) || topology.seat(i).stop >= 0) return false;
    if (topology.stretches[i] == Stretch::line && (topology.obstacle(i) != 0 || (topology.half && i == 0)))
      return false;
  }
  return topology.couplings().empty();
}

std::string couple_not_carried() {
  return "cylinder.friction_couple: is built for coils that lie all along in a plate without an outer edge, "
         "both "
         "ends' spin held, and for touches and lines of the cylinder, not for rods of which a part lies on "
         "cylinder and plate at once; false leaves the moment of the friction out";
}

std::string rim_not_thickened() {
  return "plate.outer_radius: a rod that touches the plate's outer edge is not followed in rod.radius";
}

std::vector<Started> dragged_with_couple(const scene::Scene& scene, const std::vector<std::string>& keys,
                                         std::string& searched) {
  // Followed by the radius from nothing, where friction has no moment.
  Further further{.simpler = scene, .from = scene, .keys = {"rod.radius"}, .to = scene.rod_radius};
  further.simpler.motion.friction_couple = false;
  further.from.rod_radius = 0.0;
  further.carries = carries_couple;
  further.what = fmt::format("the moment of the friction at rod.radius = {:.6g}", scene.rod_radius);
  further.not_carried = couple_not_carried();
  return dragged_further(scene, further, keys, searched);
}

}  // namespace windlass::equilibrium
