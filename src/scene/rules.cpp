#include "rules.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "windlass/scene/keys.hpp"

namespace windlass::scene {

void forbid(const Document& document, const std::string& key, const std::string& why) {
  if (const Entry* entry = document.find(key)) throw SceneError(entry->prefix() + why);
}

void refuse_for(const Document& document, const std::string& key, const std::string& why) {
  forbid(document, key, why);
  std::string table = key.substr(0, key.rfind('.'));
  if (!document.tables.contains(table)) table = table.substr(0, table.find('.'));
  throw SceneError(fmt::format("{}: {}: {}", document.place_of_table(table), key, why));
}

bool starts_in(const Scene& scene, const std::string& key) {
  return scene.continuation && scene.continuation->parameter == key;
}

namespace {

/// Where a symmetric half chain is asked for, the two ends must be alike.
void check_ends(const Document& document, const Scene& scene) {
  const bool unlike = scene.ends.left_kind() != scene.ends.right_kind();
  if (unlike && scene.model.symmetry == Symmetry::half_turn)
    forbid(document, "model.symmetry",
           "must not be \"half_turn\": the two ends of the rod are held differently");
  if (!scene.obstacles_keep_half_turn() && scene.model.symmetry == Symmetry::half_turn)
    forbid(document, "model.symmetry",
           "must not be \"half_turn\": a wall is not its own image under the half-turn about e_y");
  for (const char* key : {"ends.kind", "ends.left", "ends.right"}) {
    const EndKind kind = key[5] == 'l'   ? scene.ends.left_kind()
                         : key[5] == 'r' ? scene.ends.right_kind()
                                         : scene.ends.kind;
    if (scene.has_cylinder && kind == EndKind::pinned)
      forbid(document, key,
             "must be \"moment_free\", \"clamped\" or \"spin_held\" with [cylinder]: its pulls leave the "
             "ends free to move");
    if (!scene.has_cylinder && kind == EndKind::spin_held)
      forbid(document, key, "must be \"moment_free\", \"pinned\" or \"clamped\" without [cylinder]");
  }
}

void check_capstan(const Document& document, const Scene& scene) {
  if (scene.rod.infinite())
    for (const char* key : {"rod.natural_curvature", "rod.natural_twist"})
      if (find_key(key)->get(scene).value_or(0.0) != 0.0)
        forbid(document, key,
               "must be 0 with rod.length = \"inf\": an endless straight tail would store endless energy");
  for (const char* key : {"load.tension", "load.angle"})
    if (!document.find(key) && !starts_in(scene, key))
      throw missing(document, key, fmt::format("{} with [cylinder]", find_key(key)->allowed()));
  for (const char* key : {"load.thrust", "ends.shortening"})
    forbid(document, key, "belongs to a strut; must not be given with [cylinder]");
  if (scene.ends.twist != 0.0)
    forbid(document, "ends.twist", "belongs to a strut; must be 0 with [cylinder]");
  const Entry* radius = document.find("cylinder.radius");
  if (!scene.units) {
    if (scene.rod_radius >= 1.0)
      forbid(document, "rod.radius", "must be < 1: lengths are in units of rod plus cylinder radius");
    const Key& key = *find_key("cylinder.radius");
    const double expected = 1.0 - scene.rod_radius;
    const auto* number = radius ? std::get_if<double>(&radius->value) : nullptr;
    const auto* integer = radius ? std::get_if<std::int64_t>(&radius->value) : nullptr;
    const double given = number ? *number : integer ? static_cast<double>(*integer) : expected;
    if (std::abs(given - expected) > 1e-12)
      throw SceneError(
          fmt::format("{}must be {} = 1 - rod.radius: without units lengths are in units of rod plus "
                      "{}",
                      radius->prefix(), expected, key.name));
  }
}

void check_strut(const Document& document, const Scene& scene) {
  for (const char* key : {"load.tension", "load.angle"})
    forbid(document, key, "needs a [cylinder]; a strut has load.thrust or ends.shortening");
  if (scene.load.thrust && scene.ends.shortening) {
    const bool thrust_last = document.find("load.thrust") != nullptr;
    forbid(document, thrust_last ? "load.thrust" : "ends.shortening",
           "must not be given beside the other of load.thrust and ends.shortening");
  }
  if (!scene.load.thrust && !scene.ends.shortening)
    throw missing(document, "ends.shortening", "a scene without [cylinder] needs it, or load.thrust");
  if (scene.rod.infinite()) forbid(document, "rod.length", "must be finite without [cylinder]");
}

void check_self_contact(const Document& document, const Scene& scene) {
  if (!scene.self_contact) return;
  if (!(scene.rod_radius > 0.0))
    throw missing(document, "rod.radius", "must be > 0 with rod.self_contact = true");
  if (scene.rod.infinite())
    forbid(document, "rod.self_contact",
           "must be false with rod.length = \"inf\": endless tails in closed form know no other strand");
  if (scene.model.kind == ModelKind::planar || scene.model.kind == ModelKind::closed_form)
    forbid(document, "rod.self_contact",
           "must be false with this model.kind: a rod that touches itself leaves the plane");
}

void check_knot(const Document& document, const Scene& scene) {
  if (!scene.knot.tied()) return;
  const std::string key = scene.knot.curve.empty() ? "knot.kind" : "knot.curve";
  if (!scene.knot.curve.empty() && scene.knot.kind != KnotKind::none)
    forbid(document, "knot.curve", "must not be given beside knot.kind");
  if (!scene.has_cylinder && scene.knot.kind != KnotKind::none) forbid(document, key, "needs a [cylinder]");
  if (!scene.has_cylinder && !(scene.load.thrust.value_or(0.0) < 0.0)) {
    const char* pull = "must be < 0 with knot.curve and without [cylinder]: the ends of the knot are pulled";
    forbid(document, "load.thrust", pull);
    forbid(document, "ends.shortening",
           "must not be given with knot.curve: its ends are pulled by load.thrust < 0");
    throw missing(document, "load.thrust", pull);
  }
  if (!scene.walls.empty()) forbid(document, key, "must not be given beside [[wall]]");
  if (!scene.self_contact)
    forbid(document, key, "needs a rod that keeps off itself: rod.radius > 0 and rod.self_contact = true");
  constexpr double winding = 4.0 * M_PI, rounding = 1e-9;
  if (scene.knot.kind == KnotKind::clove_hitch && std::abs(scene.load.angle - winding) > rounding)
    forbid(document, document.find("load.angle") ? "load.angle" : key,
           "must be \"4 pi\" with knot.kind = \"clove_hitch\": its ends are pulled along +-e_x");
  for (const char* end : {"ends.kind", "ends.left", "ends.right"})
    if (!scene.ends_turn_freely()) forbid(document, end, "must be \"moment_free\" for a knot");
  if (!scene.rod.isotropic_straight())
    forbid(document, key, "needs an isotropic, naturally straight rod: its start is relaxed without torsion");
  if (scene.continuation && scene.continuation->parameter == "load.angle" &&
      scene.knot.kind == KnotKind::clove_hitch)
    forbid(document, "continuation.parameter", "must not be load.angle with knot.kind = \"clove_hitch\"");
}

/// The moment of the friction about the centre line, of a rod that has a radius.
template <class Refuse>
void check_friction_couple(const Scene& scene, const Refuse& refuse) {
  const char* key = "cylinder.friction_couple";
  if (!(scene.friction_arm() > 0.0) && !(scene.friction_has_couple() && starts_in(scene, "rod.radius")))
    return;
  if (scene.ends_turn_freely())
    refuse(
        key,
        "must not be true where both ends turn freely: nothing balances the moment of the friction about the "
        "rod's tangent; ends.kind = \"clamped\" or \"spin_held\" holds it");
}

/// Cylinders that slide.
void check_sliding(const Document& document, const Scene& scene) {
  const auto refuse = [&](const std::string& key, const std::string& why) { refuse_for(document, key, why); };
  if (scene.mirrored()) {
    if (!scene.slides())
      refuse("model.symmetry",
             "must not be \"mirror\" without cylinder.sliding = \"up\": it is built for rods that a cylinder "
             "drags");
    if (scene.ends.left_kind() != scene.ends.right_kind())
      refuse("model.symmetry", "must not be \"mirror\": the two ends of the rod are held differently");
    if (scene.strand_radius() > 0.0 || starts_in(scene, "rod.radius"))
      refuse("model.symmetry",
             "must not be \"mirror\" for a rod that may touch itself: its tails would cross at one height; "
             "rod.self_contact = false leaves that out");
    if (scene.model.kind == ModelKind::planar)
      refuse("model.symmetry", "must not be \"mirror\" with model.kind = \"planar\"");
    if (scene.ends.guided() || scene.rod.extensible || scene.knot.tied())
      refuse("model.symmetry",
             "must not be \"mirror\" with ends.guide, rod.extensible or a knot: not built yet");
  }
  if (!scene.slides()) return;
  if (!(scene.friction.value_or(0.0) > 0.0))
    refuse("cylinder.friction", "must be > 0 with cylinder.sliding = \"up\"");
  if (!scene.plate) refuse("cylinder.sliding", "needs a [plate], or the cylinder would carry the rod away");
  if (scene.plate->side != PlateSide::above)
    refuse(
        "plate.side",
        std::string("must be \"above\" with cylinder.sliding = \"up\", or the cylinder would carry the rod "
                    "away") +
            (scene.second_plate ? "; of two plates the first holds the rod back" : ""));
  check_friction_couple(scene, refuse);
  if (!scene.rod.isotropic_straight())
    refuse("cylinder.sliding", "needs an isotropic, naturally straight rod");
}

void check_continuation(const Document& document, const Scene& scene, bool restart) {
  const Continuation& c = *scene.continuation;
  const bool of_capstan = c.parameter == "load.tension" || c.parameter == "load.angle";
  const bool of_strut = c.parameter == "load.thrust" ||
                        (c.parameter.starts_with("ends.") && c.parameter != "ends.guide_offset");
  if (scene.has_cylinder ? of_strut : of_capstan)
    throw SceneError(fmt::format(
        "{}: continuation.parameter = \"{}\": must be a key that a scene {} [cylinder] has",
        document.place_of_table("continuation"), c.parameter, scene.has_cylinder ? "with" : "without"));
  if (!document.find("continuation.to"))
    throw missing(document, "continuation.to", fmt::format("the last value of {}", c.parameter));
  if (!std::isfinite(c.from) || !std::isfinite(c.to) || (c.from == c.to && !restart))
    forbid(document, "continuation.to",
           fmt::format("must be finite and differ from continuation.from = {}", c.from));
  if (c.step_max > 0.0 && c.step_min > c.step_max)
    forbid(document, "continuation.step_min",
           fmt::format("must be <= continuation.step_max = {}", c.step_max));
  if (c.step > 0.0 && c.step < c.step_min)
    forbid(document, "continuation.step", fmt::format("must be >= continuation.step_min = {}", c.step_min));
  if (c.step_max > 0.0 && c.step > c.step_max)
    forbid(document, "continuation.step", fmt::format("must be <= continuation.step_max = {}", c.step_max));
}

}  // namespace

SceneError missing(const Document& document, const std::string& key, const std::string& why) {
  const std::string table = key.substr(0, key.find('.'));
  return SceneError(fmt::format("{}: {}: missing; {}", document.place_of_table(table), key, why));
}

void check_rules(const Document& document, const Scene& scene, bool restart) {
  if (!document.find("rod.length"))
    throw missing(document, "rod.length", fmt::format("{}", find_key("rod.length")->allowed()));
  if (document.find("scale.length"))
    for (const char* key : {"cylinder.radius", "rod.youngs_modulus"})
      forbid(document, key, "must not be given beside [scale], which contains it already");
  if (scene.has_cylinder)
    check_capstan(document, scene);
  else
    check_strut(document, scene);
  check_ends(document, scene);
  check_self_contact(document, scene);
  check_knot(document, scene);
  check_stretch(document, scene);
  check_weight(document, scene);
  check_plates(document, scene);
  check_sliding(document, scene);
  check_guides(document, scene);
  if (scene.continuation) check_continuation(document, scene, restart);
  for (const char c : {'/', '\0'})
    if (scene.name.find(c) != std::string::npos || scene.name.empty() || scene.name.front() == '.')
      forbid(document, "name", "must be a file name: no \"/\", no leading \".\"");
}

}  // namespace windlass::scene
