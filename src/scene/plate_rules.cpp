#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "rules.hpp"
#include "windlass/scene/keys.hpp"

namespace windlass::scene {

void check_plates_given(const Document& document) {
  for (const auto& [table, line] : document.tables)
    if (table.starts_with("plate.") && table != "plate.2")
      throw SceneError(
          fmt::format("{}: {}: a third plate; must be left out: a rod has one on each side of it, [[plate]] "
                      "twice at most",
                      document.place_of_table(table), table));
}

namespace {

/// The second is given beside a first, by its height.
void check_second_given(const Document& document, const Scene& scene) {
  const bool first = std::any_of(document.entries.begin(), document.entries.end(), [](const Entry& entry) {
    return entry.key.starts_with("plate.") && !entry.key.starts_with("plate.2.");
  });
  if (!first) refuse_for(document, "plate.2.height", "needs a first [plate], with a height of its own");
  if (!document.find("plate.2.height") && !starts_in(scene, "plate.2.height"))
    refuse_for(document, "plate.2.height", "missing; a second plate needs it");
}

/// Which of two plates must be higher, and that there is room between them, wherever the second one is brought.
void check_room(const Document& document, const Scene& scene) {
  const Plate &first = *scene.plate, &second = *scene.second_plate;
  if (first.side == second.side)
    refuse_for(document, "plate.2.side",
               fmt::format("must be \"{}\": of two plates one is above the rod and one below",
                           first.side == PlateSide::above ? "below" : "above"));
  const bool above = first.side == PlateSide::above;
  // Where a thick rod passes itself two of its strands are between the plates.
  const bool crosses = scene.strand_radius() > 0.0 && (scene.load.angle >= 2.0 * M_PI || scene.knot.tied());
  const double room = crosses ? 2.0 * scene.rod_radius : 0.0;
  const double bound = above ? first.height - room : first.height + room;
  const auto check = [&](const std::string& key, double height) {
    if (above ? height < bound : height > bound) return;
    refuse_for(document, key,
               fmt::format("must be {} {}, {} the height of the first plate{}: no room would be left between "
                           "the two",
                           above ? "<" : ">", number_text(bound), crosses ? "2 rod.radius off" : "which is",
                           crosses ? ", for strands that pass each other" : ""));
  };
  check("plate.2.height", second.height);
  if (!starts_in(scene, "plate.2.height")) return;
  check("continuation.from", scene.continuation->from);
  check("continuation.to", scene.continuation->to);
}

}  // namespace

void check_plates(const Document& document, const Scene& scene) {
  const auto refuse = [&](const std::string& key, const char* why) { refuse_for(document, key, why); };
  if (!scene.plate) {
    if (starts_in(scene, "plate.2.height"))
      refuse("continuation.parameter", "needs two plates, [[plate]] twice");
    return;
  }
  if (!scene.has_cylinder)
    refuse(scene.second_plate ? "plate.2.height" : "plate.height", "needs a [cylinder]");
  if (scene.second_plate) check_second_given(document, scene);
  constexpr const char* small = "must be >= 1: a smaller plate does not reach the rod on the cylinder";
  if (scene.plate->outer_radius < 1.0) refuse("plate.outer_radius", small);
  if (scene.second_plate && scene.second_plate->outer_radius < 1.0) refuse("plate.2.outer_radius", small);
  if (scene.rod.infinite()) refuse("rod.length", "must be finite with a plate");
  if (scene.model.symmetry == Symmetry::half_turn)
    refuse("model.symmetry", "must not be \"half_turn\": a plate is not its own image under the half-turn");
  if (scene.second_plate) {
    check_room(document, scene);
    for (const auto& [end, kind] :
         {std::pair{"ends.left", scene.ends.left_kind()}, {"ends.right", scene.ends.right_kind()}})
      if (kind != EndKind::moment_free)
        refuse(document.find(end) ? end : "ends.kind",
               "must be \"moment_free\" with two plates: an end that is held and touches one is not built");
  }
  if (!scene.second_plate && starts_in(scene, "plate.2.height"))
    refuse("continuation.parameter", "plate.2.height needs a second [[plate]]");
}

}  // namespace windlass::scene
