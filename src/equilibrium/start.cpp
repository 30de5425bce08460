#include "windlass/equilibrium/start.hpp"

#include <algorithm>
#include <cmath>

#include "attempt.hpp"
#include "between_plates.hpp"
#include "dragged_start.hpp"
#include "knot_on_plate.hpp"
#include "windlass/knot/start_curve.hpp"
#include "windlass/rod/capstan.hpp"
#include "windlass/scene/error.hpp"
#include "windlass/scene/keys.hpp"
#include "windlass/scene/units.hpp"

namespace windlass::equilibrium {

using chain::Stretch;
using contact::Loads;

namespace {

/// The draft the closed form suggests: a line contact where it can exist, else one touch at the mid-point.
Draft closed_form_draft(const Loads& loads) {
  if (loads.tension > rod::capstan::line_limit(loads.angle)) {
    const double contact = 0.5 * loads.angle - std::acos(1.0 - 0.5 / loads.tension);
    return {{Stretch::line, Stretch::tail}, false, {0.0, contact, loads.half_length}};
  }
  return {{Stretch::tail}, true, {0.0, loads.half_length}};
}

/// Down from a tension where the line contact exists, through every event on the way.
std::optional<Started> by_continuation(const scene::Scene& scene, bool spatial, bool half,
                                       const std::vector<std::string>& keys, std::string& failure) {
  scene::Scene tight = scene;
  tight.load.tension = std::max({1.5 * rod::capstan::line_limit(scene.load.angle), 1.0, scene.load.tension});
  const std::vector<std::string> path{"load.tension"};
  std::optional<Started> from;
  for (int k = 0; k < 6 && !from; ++k, tight.load.tension *= 1.6) {
    Loads loads = loads_of(tight);
    if (scene.rod.infinite()) loads.half_length = 0.5 * loads.angle + 40.0 / std::sqrt(loads.tension);
    from = attempt(tight, spatial, true, path, closed_form_draft(loads),
                   chain::capstan_profile(loads.tension, loads.angle, loads.half_length, 1.0));
  }
  if (!from) {
    failure = "no line contact was found at a higher tension either";
    return std::nullopt;
  }
  return reach(*from, scene, scene.load.tension, half, keys, failure);
}

/// The same on the chain that is asked for.
std::optional<Started> on_chain(const std::optional<Started>& found, bool half) {
  if (!found || half) return found;
  return unfold(*found->problem, found->x, found->p, found->newton_iterations);
}

/// A coil whose rod keeps off itself: the flat one thickened; one of several turns under high tension, where each would go through
/// a change of contact, thickened at a tension at which its turns lie apart and still press on each other, then tightened or
/// loosened.
std::optional<Started> thick_coil(const scene::Scene& scene, bool half, const std::vector<std::string>& keys,
                                  std::string& failure) {
  constexpr double loose_tension = 1.5, high = 2.0, turns_side_by_side = 3.0 * M_PI;
  const auto thickened = [&](const scene::Scene& at, bool as_half,
                             const std::vector<std::string>& in) -> std::optional<Started> {
    scene::Scene thin = at;
    thin.self_contact = false;
    try {
      const std::optional<Started> flat = followed_coil(thin, true, true, in, failure);
      return flat ? thicken(*flat, at, as_half, in, failure) : std::nullopt;
    } catch (const NoContact& lifted) {  // the flat one: strands that press on each other may stay
      failure = lifted.what();
      return std::nullopt;
    }
  };
  if (scene.load.tension <= high || scene.load.angle <= turns_side_by_side)
    if (const auto direct = thickened(scene, half, keys)) return direct;
  scene::Scene loose = scene;
  loose.load.tension = loose_tension;
  if (const auto from = thickened(loose, true, {"load.tension"}))
    if (const auto there = reach(*from, scene, scene.load.tension, half, keys, failure)) return there;
  return std::nullopt;
}

/// A thick coil relaxed as a discrete rod, where no other way leads there.
std::optional<Started> relaxed_coil(const scene::Scene& scene, bool half,
                                    const std::vector<std::string>& keys, std::string& failure) {
  if (!scene.free_of_torsion() || scene.ends.guided()) return std::nullopt;  // it knows dead pulls only
  std::string not_relaxed;
  const std::optional<Started> relaxed = relaxed_start(scene, {}, keys, not_relaxed);
  if (!relaxed) failure += "; nor relaxed as a discrete rod: " + not_relaxed;
  return on_chain(relaxed, half);
}

/// Pulls at which a knot is relaxed: its own or one at which its contacts are few [EI/ρ²].
std::vector<double> relaxing_pulls(const scene::Scene& scene) {
  if (!scene.has_cylinder) {  // knots round themselves are loose where loops are wide beside the rod
    constexpr double loose = 0.01;
    const double own = scene.load.thrust.value(),
                 wide = -loose * scene.rod.bending_stiffness / (scene.rod_radius * scene.rod_radius);
    return {own, std::max(own, wide)};
  }
  constexpr double loose = 0.3, tight = 2.0;
  return {std::clamp(scene.load.tension, loose, tight), 1.0, 1.5, 0.6};
}

/// The flat coil, which the automatic rung starts with; where that is not asked for, or there is none, the first state that has left
/// the plate.
Started dragged_first(const scene::Scene& scene, const std::vector<std::string>& keys) {
  std::string none, searched;
  if (scene.model.kind != scene::ModelKind::kirchhoff) {
    try {
      return coil_on_plate(scene, keys);
    } catch (const NoEquilibrium& flat) {
      none = std::string(flat.what()) + "; ";
    }
  }
  const std::vector<Started> states = dragged_states(scene, keys, searched);
  if (states.empty()) throw NoEquilibrium(none + "no state that has left the plate was found: " + searched);
  return states.front();
}

std::string pull_on_knot(const scene::Scene& scene) {
  return scene.has_cylinder ? "load.tension" : "load.thrust";
}

/// A knot relaxed at the first of its pulls at which it is found, on a half chain.
std::optional<Started> relaxed_knot(const scene::Scene& scene, std::string& failure) {
  const knot::Curve curve = knot::start_curve(scene);
  const std::string key = pull_on_knot(scene);
  for (const double pull : relaxing_pulls(scene)) {
    scene::Scene at = scene;
    scene::set_parameter(at, key, pull);
    const double compliance = scene.rod.compliance();
    std::optional<Started> from = compliance == 0.0
                                      ? relaxed_start(at, curve, {key}, failure)
                                      : relaxed_start(inextensible(at), curve, by_compliance, failure);
    if (from && compliance != 0.0) from = reach(*from, at, compliance, true, {key}, failure);
    if (from) return from;
  }
  return std::nullopt;
}

}  // namespace

std::optional<Started> knot_start(const scene::Scene& scene, bool half, const std::vector<std::string>& keys,
                                  std::string& failure) {
  const auto from = relaxed_knot(scene, failure);
  if (!from) return std::nullopt;
  return reach(*from, scene, scene::get_parameter(scene, pull_on_knot(scene)), half, keys, failure);
}

std::optional<Started> knot_between(const scene::Scene& asked, bool half, const std::string& key,
                                    double lower, double upper) {
  const scene::Scene scene = scene::natural(asked);
  if (!scene.knot.tied() || scene.plate || key != pull_on_knot(scene)) return std::nullopt;
  const auto inside = [&](double pull) { return lower < pull && pull < upper; };
  if (!inside(relaxing_pulls(scene).front())) return std::nullopt;
  std::string failure;
  const auto found = relaxed_knot(scene, failure);
  if (!found || !inside(found->p(0))) return std::nullopt;
  return on_chain(found, half);
}

std::optional<Started> followed_coil(const scene::Scene& scene, bool spatial, bool half,
                                     const std::vector<std::string>& keys, std::string& failure) {
  if (const double compliance = scene.rod.compliance(); compliance != 0.0) {
    const auto rigid = followed_coil(inextensible(scene), spatial, half, by_compliance, failure);
    return rigid ? reach(*rigid, scene, compliance, half, keys, failure) : std::nullopt;
  }
  if (spatial && scene.strand_radius() > 0.0) return thick_coil(scene, half, keys, failure);
  Loads loads = loads_of(scene);
  if (scene.rod.infinite()) loads.half_length = 0.5 * loads.angle + 40.0 / std::sqrt(loads.tension);
  const Draft draft = closed_form_draft(loads);
  if (draft.s.size() == 3 && draft.s[1] >= loads.half_length)
    throw scene::SceneError("rod.length = " + std::to_string(2.0 * loads.half_length) +
                            ": the rod is shorter than its contact arc, which needs more than " +
                            std::to_string(2.0 * draft.s[1]));
  const chain::Profile profile = chain::capstan_profile(loads.tension, loads.angle, loads.half_length, 1.0);
  if (auto direct = attempt(scene, spatial, half, keys, draft, profile)) return direct;
  return by_continuation(scene, spatial, half, keys, failure);
}

Started cold_start(const scene::Scene& asked, bool spatial, bool half, const std::vector<std::string>& keys) {
  const scene::Scene scene = scene::natural(asked);
  spatial = spatial || scene.ends.guided();
  std::string failure;
  if (spatial && scene.second_plate && (scene.knot.tied() || !scene.slides())) {
    const Started one = cold_start(with_one_plate(scene), spatial, false, {"load.tension"});
    if (auto found = between_plates(one, scene, keys, failure)) return *found;
    throw NoEquilibrium("no equilibrium was found with the second plate: " + failure);
  }
  if (scene.knot.tied() && scene.plate) {
    if (auto knot = knot_on_plate(scene, keys, failure)) return *knot;
    throw NoEquilibrium("no equilibrium of the knot on its plate was found: " + failure);
  }
  if (spatial && scene.slides()) return dragged_first(scene, keys);
  if (const double compliance = scene.rod.compliance();
      compliance != 0.0 && scene.has_cylinder && !scene.knot.tied()) {
    const Started rigid = cold_start(inextensible(scene), spatial, half, by_compliance);
    if (auto stretched = reach(rigid, scene, compliance, half, keys, failure)) return *stretched;
    throw NoEquilibrium("the rod that stretches was not reached from the one that does not: " + failure);
  }
  if (scene.knot.tied()) {
    if (auto knot = knot_start(scene, half, keys, failure)) return *knot;
    throw NoEquilibrium("no equilibrium of the knot was found: " + failure);
  }
  if (!scene.has_cylinder && scene.rod.weighs()) return weighted_strut(scene, half, keys);
  if (!scene.has_cylinder)
    return scene.ends.shortening ? buckled_strut(scene, half, keys) : straight_strut(scene, half, keys);
  if (auto followed = followed_coil(scene, spatial, half, keys, failure)) return *followed;
  if (spatial && scene.strand_radius() > 0.0)
    if (auto relaxed = relaxed_coil(scene, half, keys, failure)) return *relaxed;
  if (auto discovered = discovered_start(scene, spatial, half, keys)) return *discovered;
  throw NoEquilibrium("no equilibrium in contact was found at T = " + std::to_string(asked.load.tension) +
                      ", phi = " + std::to_string(scene.load.angle) + ": " + failure);
}

}  // namespace windlass::equilibrium
