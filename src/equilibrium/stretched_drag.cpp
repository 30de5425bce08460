#include "stretched_drag.hpp"

#include <fmt/format.h>

#include "attempt.hpp"
#include "dragged_further.hpp"

namespace windlass::equilibrium {

using chain::Stretch;

bool carries_stretch(const Topology& topology, chain::Travel travel) {
  const std::vector<Stretch>& all = topology.stretches;
  bool lines = false, tilted = false, flat = false, pressed = false;
  for (int i = 0; i < static_cast<int>(all.size()); ++i) {
    if (all[i] != Stretch::line) continue;
    lines = true;
    flat = flat || topology.lies_flat(i);
    pressed = pressed || (i > 0 && topology.lies_flat(i - 1) && topology.lies_flat(i));
    if (topology.lies_flat(i)) continue;
    tilted = true;
    const bool alone = topology.obstacle(i) == 0 && !(topology.half && i == 0) &&
                       !topology.beside_strand(i) && topology.seat(i).stop < 0 &&
                       topology.seat(i + 1).stop < 0;
    if (!alone) return false;
  }
  if (pressed || (tilted && flat)) return false;
  if (tilted) return travel != chain::Travel::free;
  const std::vector<Stretch> flat_coil{Stretch::tail, Stretch::line, Stretch::tail};
  return !lines || travel != chain::Travel::free || all == flat_coil;
}

std::string stretch_not_carried() {
  return "rod.extensible: a rod that stretches is dragged at isolated touches, along lines of the cylinder, "
         "or along lines that lie on the plate, too; not along lines that leave the plate, nor along lines "
         "of "
         "a rod that runs along itself: false leaves the stretch out";
}

std::vector<Started> dragged_with_stretch(const scene::Scene& scene, const std::vector<std::string>& keys,
                                          std::string& searched) {
  Further further{.simpler = inextensible(scene),
                  .from = inextensible(scene),
                  .keys = by_compliance,
                  .to = scene.rod.compliance()};
  further.simpler.rod.extensible = false;
  const chain::Travel travel = rod_of(scene, true).travel;
  further.carries = [travel](const Topology& topology) { return carries_stretch(topology, travel); };
  further.what = fmt::format("rod.axial_compliance = {:.6g}", scene.rod.compliance());
  further.not_carried = stretch_not_carried();
  return dragged_further(scene, further, keys, searched);
}

}  // namespace windlass::equilibrium
