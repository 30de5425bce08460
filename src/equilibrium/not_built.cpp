#include "not_built.hpp"

#include "friction_couple.hpp"
#include "stretched_drag.hpp"

namespace windlass::equilibrium {

bool strands_in_plate(const chain::Topology& topology) {
  for (int j = 0; j < static_cast<int>(topology.on.size()); ++j)
    if (topology.seat(j).strand != 0 && topology.seat(j).flat >= 0) return true;
  return false;
}

std::string not_built(std::string_view key) {
  if (key == "rod.extensible") return stretch_not_carried();
  if (key == "plate.2.height")
    return "plate.2.height: the second plate and the cylinder cannot hold the rod at one place";
  if (key == "plate.outer_radius") return rim_not_thickened();
  if (key == "ends.kind") return "ends.kind: strands that touch in a plate are built for ends free of moment";
  return couple_not_carried();
}

const char* contacts_not_built(std::string_view key) {
  if (key == "rod.extensible") return "lines that friction stretches";
  if (key == "plate.2.height") return "places where the cylinder holds the rod, too";
  if (key == "ends.kind") return "strands that touch in a plate";
  return "lines";
}

}  // namespace windlass::equilibrium
