#include "rules.hpp"

namespace windlass::scene {

void check_guides(const Document& document, const Scene& scene) {
  if (!scene.ends.guided()) {
    forbid(document, "ends.guide_offset", "needs ends.guide = \"slider\"");
    if (starts_in(scene, "ends.guide_offset"))
      forbid(document, "continuation.parameter", "ends.guide_offset needs ends.guide = \"slider\"");
    return;
  }
  const auto refuse = [&](const char* why) { forbid(document, "ends.guide", why); };
  if (!scene.has_cylinder)
    refuse("must be \"none\" without [cylinder]: the ends of a strut are on e_x as they are");
  if (scene.rod.infinite()) refuse("must be \"none\" with rod.length = \"inf\": there is no end to guide");
  if (scene.knot.tied()) refuse("must be \"none\" for a knot: it is relaxed with free ends");
  if (scene.model.kind == ModelKind::closed_form || scene.model.kind == ModelKind::planar)
    forbid(document, "model.kind", "must be \"auto\" or \"kirchhoff\" with ends.guide = \"slider\"");
  if (scene.plate && !scene.slides())
    refuse(
        "must be \"none\" with a plate and without cylinder.sliding = \"up\": the sliders are at its height");
}

}  // namespace windlass::scene
