#include <algorithm>
#include <array>
#include <iterator>
#include <type_traits>

#include "windlass/scene/keys.hpp"

namespace windlass::scene {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr Range any{};
constexpr Range positive{.low = 0.0, .open_low = true};
constexpr Range not_negative{.low = 0.0};

// ---- access to members, as plain function pointers -------------------------------------------------------------

template <auto Part, auto Member>
std::optional<double> get_in(const Scene& scene) {
  return scene.*Part.*Member;
}
template <auto Part, auto Member>
void set_in(Scene& scene, double value) {
  scene.*Part.*Member = value;
}
template <auto Member>
std::optional<double> get_continuation(const Scene& scene) {
  if (!scene.continuation) return std::nullopt;
  return static_cast<double>((*scene.continuation).*Member);
}
template <auto Member>
void set_continuation(Scene& scene, double value) {
  if (!scene.continuation) scene.continuation.emplace();
  auto& member = (*scene.continuation).*Member;
  member = static_cast<std::remove_reference_t<decltype(member)>>(value);
}

/// Words of an enumeration in the order of its values.
template <auto Part, auto Member, const auto& Words>
std::string get_word(const Scene& scene) {
  return std::string(Words[static_cast<std::size_t>(scene.*Part.*Member)]);
}
template <auto Part, auto Member, const auto& Words>
void set_word(Scene& scene, const std::string& word) {
  const auto found = std::find(std::begin(Words), std::end(Words), word);
  using Enum = std::remove_reference_t<decltype(scene.*Part.*Member)>;
  scene.*Part.*Member = static_cast<Enum>(found - std::begin(Words));
}

constexpr std::string_view end_words[] = {"moment_free", "clamped", "pinned", "spin_held"};

/// One end's kind; no text where it is that of `ends.kind`.
template <auto Member>
std::string get_end(const Scene& scene) {
  const std::optional<EndKind>& end = scene.ends.*Member;
  return end ? std::string(end_words[static_cast<std::size_t>(*end)]) : "";
}
template <auto Member>
void set_end(Scene& scene, const std::string& word) {
  const auto found = std::find(std::begin(end_words), std::end(end_words), word);
  scene.ends.*Member = static_cast<EndKind>(found - std::begin(end_words));
}
template <auto Member>
Key end_of_rod(std::string_view name, std::string_view help) {
  return {.name = name,
          .kind = ValueKind::text,
          .range = any,
          .choices = {std::begin(end_words), std::end(end_words)},
          .help = help,
          .get_text = get_end<Member>,
          .set_text = set_end<Member>};
}

constexpr std::string_view sliding_words[] = {"none", "up"};
constexpr std::string_view travel_words[] = {"free", "blocked"};
constexpr std::string_view guide_words[] = {"none", "slider"};
constexpr std::string_view side_words[] = {"above", "below"};
constexpr std::string_view knot_words[] = {"none", "clove_hitch"};
constexpr std::string_view model_words[] = {"auto", "closed_form", "planar", "kirchhoff"};
constexpr std::string_view symmetry_words[] = {"auto", "half_turn", "mirror", "none"};

template <auto Part, auto Member>
Key parameter(std::string_view name, Dimension dimension, Range range, std::string_view help) {
  return {.name = name,
          .dimension = dimension,
          .range = range,
          .choices = {},
          .help = help,
          .get = get_in<Part, Member>,
          .set = set_in<Part, Member>,
          .is_parameter = true};
}

template <auto Part, auto Member, const auto& Words>
Key word(std::string_view name, std::string_view help) {
  return {.name = name,
          .kind = ValueKind::text,
          .range = any,
          .choices = {std::begin(Words), std::end(Words)},
          .help = help,
          .get_text = get_word<Part, Member, Words>,
          .set_text = set_word<Part, Member, Words>};
}

template <auto Member>
Key method(std::string_view name, Dimension dimension, Range range, std::string_view help,
           ValueKind kind = ValueKind::number) {
  return {.name = name,
          .kind = kind,
          .dimension = dimension,
          .range = range,
          .choices = {},
          .help = help,
          .get = get_continuation<Member>,
          .set = set_continuation<Member>};
}

Key truth(std::string_view name, std::string_view help, decltype(Key::get) get, decltype(Key::set) set) {
  return {.name = name,
          .kind = ValueKind::truth,
          .range = any,
          .choices = {},
          .help = help,
          .get = get,
          .set = set};
}

/// A key the resolved scene no longer has: it went into the scales or into another key.
Key derived(std::string_view name, Dimension dimension, Range range, std::string_view help) {
  return {.name = name, .dimension = dimension, .range = range, .choices = {}, .help = help};
}

std::vector<Key> top_level_keys() {
  return {
      {.name = "name",
       .kind = ValueKind::text,
       .range = any,
       .choices = {},
       .help = "name of the run folder; default: the file's",
       .get_text = [](const Scene& scene) { return scene.name; },
       .set_text = [](Scene& scene, const std::string& text) { scene.name = text; }},
      {.name = "title",
       .kind = ValueKind::text,
       .range = any,
       .choices = {},
       .help = "one line for people",
       .get_text = [](const Scene& scene) { return scene.title; },
       .set_text = [](Scene& scene, const std::string& text) { scene.title = text; }},
  };
}

std::vector<Key> rod_keys() {
  const Range length{.low = 0.0, .open_low = true, .allows_infinity = true};
  const Range poisson{.low = -1.0, .high = 0.5, .open_low = true};
  Key radius =
      parameter<&Scene::rod, &Rod::length>("rod.radius", Dimension::length, not_negative,
                                           "radius r of the rod; the centreline's cylinder is R + r");
  radius.get = [](const Scene& scene) -> std::optional<double> { return scene.rod_radius; };
  radius.set = [](Scene& scene, double value) { scene.rod_radius = value; };
  const Key self_contact = truth(
      "rod.self_contact",
      "may the rod touch itself? true, the default where rod.radius > 0: its strands keep 2 rod.radius "
      "apart; false: a thin rod, which passes through itself",
      [](const Scene& scene) -> std::optional<double> { return scene.self_contact ? 1.0 : 0.0; },
      [](Scene& scene, double value) { scene.self_contact = value != 0.0; });
  return {
      parameter<&Scene::rod, &Rod::length>("rod.length", Dimension::length, length,
                                           "whole length, or \"inf\" (closed-form tails)"),
      radius,
      self_contact,
      parameter<&Scene::rod, &Rod::bending_stiffness>(
          "rod.bending_stiffness", Dimension::stiffness, positive,
          "EI of bending in the plane of the flat rod (the plane of the pulls); the unit of stiffness"),
      parameter<&Scene::rod, &Rod::bending_stiffness_2>(
          "rod.bending_stiffness_2", Dimension::stiffness, positive,
          "EI of bending out of the plane of the flat rod; default: that of bending_stiffness"),
      derived("rod.youngs_modulus", Dimension::modulus, positive,
              "E; with rod.radius it gives EI = E pi r^4/4"),
      derived("rod.poisson_ratio", Dimension::none, poisson, "nu; gives twist_ratio = 1/(1 + nu)"),
      parameter<&Scene::rod, &Rod::twist_ratio>("rod.twist_ratio", Dimension::none, positive, "GJ/EI"),
      parameter<&Scene::rod, &Rod::natural_curvature>(
          "rod.natural_curvature", Dimension::curvature, any,
          "curvature of the unloaded rod in the plane of the flat rod; > 0 bends it round the cylinder"),
      parameter<&Scene::rod, &Rod::natural_twist>("rod.natural_twist", Dimension::curvature, any,
                                                  "twist of the unloaded rod, rad per length"),
  };
}

template <std::size_t Component>
Key weight_key(std::string_view name, std::string_view help) {
  return {.name = name,
          .dimension = Dimension::distributed,
          .range = any,
          .choices = {},
          .help = help,
          .get = [](const Scene& scene) -> std::optional<double> {
            const double value = scene.rod.weight[Component];
            return value != 0.0 ? std::optional(value) : std::nullopt;
          },
          .set = [](Scene& scene, double value) { scene.rod.weight[Component] = value; },
          .is_parameter = true};
}

/// Rods that stretch, and rods that weigh. What a scene without them does not say is not written into it.
std::vector<Key> stretch_keys() {
  const Key extensible = truth(
      "rod.extensible", "may the rod stretch? true: by its axial stiffness; false, the default: not at all",
      [](const Scene& scene) -> std::optional<double> {
        return scene.rod.extensible ? std::optional(1.0) : std::nullopt;
      },
      [](Scene& scene, double value) { scene.rod.extensible = value != 0.0; });
  Key stiffness{
      .name = "rod.axial_stiffness",
      .dimension = Dimension::force,
      .range = {.low = 0.0, .open_low = true, .allows_infinity = true},
      .choices = {},
      .help = "EA of an extensible rod; default: 4 EI/r^2, that of a solid round rod, from rod.radius",
      .get = [](const Scene& scene) -> std::optional<double> {
        return scene.rod.extensible ? std::optional(scene.rod.axial_stiffness) : std::nullopt;
      },
      .set = [](Scene& scene, double value) { scene.rod.axial_stiffness = value; },
      .is_parameter = true};
  Key compliance{
      .name = "rod.axial_compliance",
      .dimension = Dimension::compliance,
      .range = not_negative,
      .choices = {},
      .help =
          "1/EA instead of rod.axial_stiffness, to follow a branch in: 0 is the rod that does not stretch",
      .get = [](const Scene& scene) -> std::optional<double> { return scene.rod.compliance(); },
      .set = [](Scene& scene, double value) { scene.rod.axial_stiffness = 1.0 / value; },
      .is_parameter = true,
      .is_alias = true};
  return {extensible,
          stiffness,
          compliance,
          weight_key<0>("rod.weight_x",
                        "of rod.weight = [x, y, z], the weight or another known force per length"),
          weight_key<1>("rod.weight_y", "the same along e_y"),
          weight_key<2>("rod.weight_z", "the same along e_z")};
}

/// Ends on sliders. What a scene without them does not say is not written into it.
std::vector<Key> guide_keys() {
  Key guide{.name = "ends.guide",
            .kind = ValueKind::text,
            .range = any,
            .choices = {std::begin(guide_words), std::end(guide_words)},
            .help = "slider: with a cylinder each end moves along a line parallel to its pull only",
            .get_text = [](const Scene& scene) -> std::string {
              return scene.ends.guided() ? std::string(guide_words[1]) : "";
            },
            .set_text =
                [](Scene& scene, const std::string& word) {
                  scene.ends.guide = word == guide_words[1] ? Guide::slider : Guide::none;
                }};
  Key offset{
      .name = "ends.guide_offset",
      .dimension = Dimension::length,
      .range = positive,
      .choices = {},
      .help = "distance of the sliders' lines from the cylinder's axis; default: rod plus cylinder radius",
      .get = [](const Scene& scene) -> std::optional<double> {
        return scene.ends.guided() ? std::optional(scene.ends.guide_offset) : std::nullopt;
      },
      .set = [](Scene& scene, double value) { scene.ends.guide_offset = value; },
      .is_parameter = true};
  return {guide, offset};
}

std::vector<Key> load_keys() {
  Key friction{.name = "cylinder.friction",
               .range = not_negative,
               .choices = {},
               .help = "friction coefficient mu; gives the sliding strength F0 = mu R_tot",
               .get = [](const Scene& scene) { return scene.friction; },
               .set = [](Scene& scene, double value) { scene.friction = value; },
               .is_parameter = true};
  const Key couple = truth(
      "cylinder.friction_couple",
      "while sliding, of a rod with a radius: has the friction, which acts at the rod's surface, a moment "
      "about its centre line? default: where an end that does not spin holds it",
      [](const Scene& scene) -> std::optional<double> { return scene.motion.friction_couple; },
      [](Scene& scene, double value) { scene.motion.friction_couple = value != 0.0; });
  return {
      derived("cylinder.radius", Dimension::length, positive, "radius R; dimensionless: 1 - rod.radius"),
      friction,
      word<&Scene::motion, &Motion::sliding, sliding_words>(
          "cylinder.sliding",
          "up: the cylinder moves along +e_z and slips everywhere on the rod, which a plate holds back"),
      couple,
      parameter<&Scene::load, &Load::tension>("load.tension", Dimension::force, positive,
                                              "pull T on each end (with a cylinder)"),
      parameter<&Scene::load, &Load::angle>("load.angle", Dimension::angle, positive,
                                            "capstan angle phi between the pulls (with a cylinder)"),
      parameter<&Scene::load, &Load::thrust>("load.thrust", Dimension::force, any,
                                             "compressive end force of a strut"),
      word<&Scene::ends, &Ends::kind, end_words>("ends.kind",
                                                 "what holds the ends; pinned: rods without a cylinder; "
                                                 "spin_held: with one, bends and does not spin"),
      end_of_rod<&Ends::left>("ends.left", "what holds the end at s = -L/2; default: ends.kind"),
      end_of_rod<&Ends::right>("ends.right", "what holds the end at s = L/2; default: ends.kind"),
      parameter<&Scene::ends, &Ends::shortening>("ends.shortening", Dimension::none,
                                                 {.low = 0.0, .high = 2.0, .open_high = true},
                                                 "approach of a strut's ends, fraction of the length"),
      parameter<&Scene::ends, &Ends::twist>("ends.twist", Dimension::angle, any,
                                            "rotation of one strut end about the axis against the other"),
      word<&Scene::ends, &Ends::travel, travel_words>(
          "ends.travel",
          "while sliding: equal pulls, the rod runs along itself; or no travel, the pulls differ as needed"),
  };
}

template <std::optional<Plate> Scene::*One>
Plate& the_plate(Scene& scene) {
  if (scene.*One) return *(scene.*One);
  Plate& made = (scene.*One).emplace();
  if (One == &Scene::second_plate && scene.plate && scene.plate->side == PlateSide::above)
    made.side = PlateSide::below;  // on the other side of the rod
  return made;
}

/// Keys of one of the two plates. @param names  of its height, outer radius and side
template <std::optional<Plate> Scene::*One>
std::vector<Key> keys_of_plate(std::array<std::string_view, 3> names, std::string_view what) {
  Key height{.name = names[0],
             .dimension = Dimension::length,
             .range = any,
             .choices = {},
             .help = what,
             .get = [](const Scene& scene) -> std::optional<double> {
               return scene.*One ? std::optional((scene.*One)->height) : std::nullopt;
             },
             .set = [](Scene& scene, double value) { the_plate<One>(scene).height = value; }};
  Key radius{.name = names[1],
             .dimension = Dimension::length,
             .range = {.low = 0.0, .open_low = true, .allows_infinity = true},
             .choices = {},
             .help = "of the plate, which has the cylinder's hole; \"inf\": it reaches beyond the rod",
             .get = [](const Scene& scene) -> std::optional<double> {
               return scene.*One ? std::optional((scene.*One)->outer_radius) : std::nullopt;
             },
             .set = [](Scene& scene, double value) { the_plate<One>(scene).outer_radius = value; }};
  Key side{.name = names[2],
           .kind = ValueKind::text,
           .range = any,
           .choices = {std::begin(side_words), std::end(side_words)},
           .help = "where the plate is, seen from the rod",
           .get_text = [](const Scene& scene) -> std::string {
             return scene.*One ? std::string(side_words[static_cast<std::size_t>((scene.*One)->side)]) : "";
           },
           .set_text =
               [](Scene& scene, const std::string& word) {
                 the_plate<One>(scene).side = word == side_words[0] ? PlateSide::above : PlateSide::below;
               }};
  return {height, side, radius};
}

std::vector<Key> plate_keys() {
  std::vector<Key> all =
      keys_of_plate<&Scene::plate>({"plate.height", "plate.outer_radius", "plate.side"},
                                   "of a plate, a plane z = height that stops the rod; needs a cylinder");
  const std::vector<Key> second = keys_of_plate<&Scene::second_plate>(
      {"plate.2.height", "plate.2.outer_radius", "plate.2.side"},
      "of a second plate, on the other side of the rod: the second [[plate]], or [plate.2]");
  all.insert(all.end(), second.begin(), second.end());
  for (Key& key : all) key.is_parameter = key.name == "plate.2.height";
  return all;
}

std::vector<Key> knot_keys() {
  Key curve{.name = "knot.curve",
            .kind = ValueKind::text,
            .range = any,
            .choices = {},
            .help = "another knot: CSV file with the points x, y, z of the curve that it starts on",
            .get_text = [](const Scene& scene) { return scene.knot.curve; },
            .set_text = [](Scene& scene, const std::string& text) { scene.knot.curve = text; }};
  return {word<&Scene::knot, &Knot::kind, knot_words>("knot.kind", "how the rod is tied round the cylinder"),
          curve};
}

std::vector<Key> method_keys() {
  Key tolerance{.name = "model.tolerance",
                .range = {.low = 1e-14, .high = 0.1},
                .choices = {},
                .help = "relative error asked of R_tot (strut: of end_force)",
                .get = get_in<&Scene::model, &Model::tolerance>,
                .set = set_in<&Scene::model, &Model::tolerance>};
  Key parameter_name{
      .name = "continuation.parameter",
      .kind = ValueKind::text,
      .range = any,
      .choices = {},
      .help = "key the branch is followed in, e.g. load.tension or load.angle",
      .get_text = [](const Scene& s) { return s.continuation ? s.continuation->parameter : ""; },
      .set_text =
          [](Scene& scene, const std::string& text) {
            if (!scene.continuation) scene.continuation.emplace();
            scene.continuation->parameter = text;
          }};
  using C = Continuation;
  return {
      word<&Scene::model, &Model::kind, model_words>("model.kind", "rung of the model ladder"),
      word<&Scene::model, &Model::symmetry, symmetry_words>(
          "model.symmetry",
          "half or whole rod; mirror: of a dragged rod, states that are their own images in x = 0"),
      tolerance,
      parameter_name,
      method<&C::from>("continuation.from", Dimension::of_parameter, any,
                       "first value of the parameter; default: the scene's"),
      method<&C::to>("continuation.to", Dimension::of_parameter, any, "last value of the parameter"),
      method<&C::step>("continuation.step", Dimension::none, not_negative,
                       "first step in path length; 0: chosen"),
      method<&C::step_min>("continuation.step_min", Dimension::none, not_negative,
                           "smallest step; 0: chosen"),
      method<&C::step_max>("continuation.step_max", Dimension::none, not_negative, "largest step; 0: chosen"),
      method<&C::max_points>("continuation.max_points", Dimension::none, {.low = 2, .high = 1e6},
                             "most points on a branch", ValueKind::integer),
      derived("scale.length", Dimension::none, positive, "resolved scenes only: unit of length [m]"),
      derived("scale.bending_stiffness", Dimension::none, positive, "resolved scenes only: unit EI [N m^2]"),
  };
}

}  // namespace

std::span<const Key> keys() {
  static const std::vector<Key> table = [] {
    std::vector<Key> all;
    for (auto&& part : {top_level_keys(), rod_keys(), stretch_keys(), load_keys(), guide_keys(), plate_keys(),
                        knot_keys(), method_keys()})
      all.insert(all.end(), part.begin(), part.end());
    return all;
  }();
  return table;
}

}  // namespace windlass::scene
