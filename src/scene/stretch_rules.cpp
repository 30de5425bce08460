#include <fmt/format.h>

#include <cmath>

#include "rules.hpp"

namespace windlass::scene {

void check_stretch(const Document& document, const Scene& scene) {
  const Entry *stiffness = document.find("rod.axial_stiffness"),
              *compliance = document.find("rod.axial_compliance");
  if (stiffness && compliance)
    forbid(document, "rod.axial_compliance", "must not be given beside rod.axial_stiffness");
  if (!scene.rod.extensible) {
    if (scene.rod.axial_stiffness != HUGE_VAL)
      forbid(document, stiffness ? "rod.axial_stiffness" : "rod.axial_compliance",
             stiffness ? "must be \"inf\" without rod.extensible = true"
                       : "must be 0 without rod.extensible = true");
    for (const char* key : {"rod.axial_stiffness", "rod.axial_compliance"})
      if (starts_in(scene, key))
        forbid(document, "continuation.parameter", fmt::format("{} needs rod.extensible = true", key));
    return;
  }
  if (scene.rod.infinite())
    forbid(document, "rod.extensible",
           "must be false with rod.length = \"inf\": endless tails are known in closed form only where the "
           "rod does not stretch");
  if (!stiffness && !compliance && !(scene.rod_radius > 0.0) && !starts_in(scene, "rod.axial_stiffness") &&
      !starts_in(scene, "rod.axial_compliance"))
    throw missing(document, "rod.axial_stiffness",
                  "rod.extensible = true needs it, or rod.radius, of which it is 4 EI/r^2");
  if (scene.model.kind == ModelKind::closed_form)
    forbid(document, "model.kind",
           "must not be \"closed_form\" with rod.extensible = true: closed forms are those of rods that do "
           "not stretch");
}

void check_weight(const Document& document, const Scene& scene) {
  const char* names[] = {"rod.weight_x", "rod.weight_y", "rod.weight_z"};
  for (std::size_t k = 0; k < 3; ++k) {
    const bool weighs = scene.rod.weight[k] != 0.0 || starts_in(scene, names[k]);
    const auto refuse = [&](const std::string& why) {
      forbid(document, names[k], why);
      if (starts_in(scene, names[k])) forbid(document, "continuation.parameter", why);
    };
    if (!weighs) continue;
    if (scene.has_cylinder)
      refuse(k == 2 ? "must be 0 with [cylinder]: nothing carries weight along its axis"
                    : "must be 0 with [cylinder]: a line contact under weight is not built yet");
    if (!scene.walls.empty())
      refuse("must be 0 beside [[wall]]: a line on a wall under weight is not built yet");
    if (scene.knot.tied()) refuse("must be 0 for a knot: its start is relaxed without weight");
    if (k == 0 && !scene.ends.shortening)
      refuse("must be 0 with load.thrust: both ends are free to move along e_x, and nothing carries it");
    if (scene.ends.shortening == 0.0 && scene.rod.compliance() == 0.0 && !starts_in(scene, "ends.shortening"))
      refuse(
          "must be 0 with ends.shortening = 0, but with rod.extensible = true: a straight rod that does not "
          "stretch carries no weight across it");
    if (k != 1 && scene.model.symmetry == Symmetry::half_turn)
      forbid(document, "model.symmetry",
             fmt::format("must not be \"half_turn\": {} is not its own image under the half-turn about e_y",
                         names[k]));
  }
}

}  // namespace windlass::scene
