#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <continuation/branch_switch.hpp>
#include <continuation/walker.hpp>
#include <functional>

#include "dragged_start.hpp"
#include "windlass/equilibrium/equilibria.hpp"
#include "windlass/equilibrium/record.hpp"
#include "windlass/equilibrium/search.hpp"
#include "windlass/rod/capstan.hpp"
#include "windlass/scene/error.hpp"
#include "windlass/scene/resolved.hpp"
#include "windlass/scene/units.hpp"

namespace windlass::equilibrium {

using scene::ModelKind;

namespace {

Solution finish(Started& started, const std::string& reason) {
  started.problem->error_estimate(started.x, started.p);
  Solution solution = record(*started.problem, started.x, started.p);
  solution.newton_iterations = started.newton_iterations;
  solution.model_reason = reason;
  return solution;
}

/// Least thrust at which the straight strut may bow, up to that of twice Euler's; nullopt: none, or unstable without any.
std::optional<double> buckling_thrust(const scene::Scene& scene) {
  scene::Scene idle = scene;
  idle.load.thrust = 0.0;
  Started start = cold_start(idle, true, true, {"load.thrust"});
  if (start.problem->total_index(start.x, start.p) > 0) return std::nullopt;
  continuation::Options options;
  constexpr double euler = 4.0 * M_PI * M_PI;  // B = L = 1
  options.target = options.upper = 2.0 * euler;
  options.parameter_scale = euler;
  options.detect_events = false;
  continuation::Walker walker(start.problem, start.x, start.p, options);
  while (const auto point = walker.step())
    if (point->type == continuation::PointType::branch_point) return start.problem->as_given(point->p(0));
  return std::nullopt;
}

/// The flat (straight) state by itself, or why there is none in contact.
struct Flat {
  std::optional<Started> planar, rod;  ///< planar: where the rod is a lifted planar state
  int index = -1;                      ///< of the rod in space
  bool no_contact = false;             ///< followed to these loads, the rod lifts off
  std::string why;
};

Flat flat_state(const scene::Scene& scene, const std::vector<std::string>& keys) {
  Flat flat;
  try {
    if (scene.has_cylinder && (scene.strand_radius() > 0.0 || scene.ends.guided())) {
      flat.rod = cold_start(scene, true, scene.half_turn(), keys);
    } else if (scene.has_cylinder) {
      flat.planar = cold_start(scene, false, true, keys);
      flat.rod = lift(*flat.planar->problem, flat.planar->x, flat.planar->p, scene.half_turn());
    } else {
      flat.rod = cold_start(scene, true, scene.half_turn(), keys);
    }
    flat.index = flat.rod->problem->total_index(flat.rod->x, flat.rod->p);
  } catch (const NoContact& none) {
    flat.no_contact = true;
    flat.why = none.what();
  } catch (const NoEquilibrium& none) {
    flat.why = none.what();
  }
  return flat;
}

StateSummary summary_of(const Solution& solution, const scene::Scene& scene, int index) {
  return {solution.R_tot,
          solution.F0,
          solution.end_force,
          solution.end_moment,
          solution.energy,
          potential(solution, scene::as_given(scene)),
          index,
          solution.topology,
          solution.restart};
}

Equilibria only(Solution solution, const scene::Scene& scene, int index) {
  StateSummary summary = summary_of(solution, scene, index);
  return {std::move(solution), {std::move(summary)}};
}

/// Is it the state of this fingerprint?
bool is(const FoundState& state, const Vector& fingerprint) {
  return continuation::same_fingerprint(state.fingerprint, fingerprint, same_state);
}

/// Chooses among what search() finds, the flat state among it.
/// @param finished  the state chosen, on its rung and with the reason
Equilibria choose(const scene::Scene& scene, const Flat& flat, const std::vector<std::string>& keys,
                  const std::function<Solution(FoundState&)>& finished) {
  Search found = search(scene, true, scene.half_turn(), keys);
  if (flat.rod) include(found, *flat.rod);
  if (found.states.empty()) {
    const std::string none = flat.why + "; nor in space, searched: " + found.searched;
    if (flat.no_contact) throw NoContact(none);
    throw NoEquilibrium(none);
  }
  FoundState& best = found.states.front();
  Solution solution = finished(best);
  if (!best.stable()) {
    solution.model_reason += fmt::format("; no stable state was found (searched: {}), this one has index {}",
                                         found.searched, best.index);
  } else if (found.states.size() > 1) {
    const auto stable = std::count_if(found.states.begin(), found.states.end(),
                                      [](const FoundState& state) { return state.stable(); });
    solution.model_reason +=
        fmt::format("; of {} equilibria found, {} of them stable, the stable one of lowest potential",
                    found.states.size(), stable);
  }
  Equilibria out = only(std::move(solution), scene, best.index);
  for (std::size_t k = 1; k < found.states.size(); ++k) {
    FoundState& other = found.states[k];
    out.states.push_back(summary_of(record(*other.at.problem, other.at.x, other.at.p), scene, other.index));
  }
  return out;
}

Equilibria solve_knot(const scene::Scene& scene, const std::vector<std::string>& keys) {
  Started knot = cold_start(scene, true, scene.half_turn(), keys);
  const int index = knot.problem->total_index(knot.x, knot.p);
  return only(finish(knot, "a knot: Kirchhoff rod with its thickness"), scene, index);
}

/// @param kirchhoff  the rung is asked for: under a given thrust the straight rod itself, stable or not
Equilibria solve_strut(const scene::Scene& scene, const std::vector<std::string>& keys, bool kirchhoff) {
  Flat flat = flat_state(scene, keys);
  if (!scene.ends.shortening && kirchhoff && flat.rod)
    return only(finish(*flat.rod, "asked for"), scene, flat.index);
  if (scene.ends.shortening)
    return choose(scene, flat, keys, [](FoundState& best) {
      return finish(best.at, "a strut may twist and leave the plane: Kirchhoff rod");
    });
  if (flat.index == 0)
    return only(finish(*flat.rod, scene.rod.weighs() ? "the strut is stable under this thrust and its weight"
                                                     : "the straight strut is stable under this thrust"),
                scene, 0);
  return choose(scene, flat, keys, [&](FoundState& best) {
    return finish(best.at,
                  fmt::format("the straight strut is unstable under this thrust (index {})", flat.index));
  });
}

/// A coil of up to half a turn has one state, the flat one; a longer one may leave the plane.
bool may_leave_plane(const scene::Scene& scene) { return scene.load.angle > M_PI; }

Solution solve_flat(const scene::Scene& scene, Started& planar) {
  if (scene.rod.infinite() && rod::capstan::line_contact(scene.load.tension, scene.load.angle)) {
    Solution solution = finish(planar, "");
    solution.model = "closed_form";
    solution.model_reason =
        "infinite tails and a line contact: the closed form is exact, and the flat state is stable in space";
    return solution;
  }
  return finish(planar, "the flat state is stable against all perturbations of the Kirchhoff rod");
}

/// Of a cylinder that slips along the rod: the flat coil on the plate if there is one, and what else was found.
Equilibria solve_dragged(const scene::Scene& scene, const std::vector<std::string>& keys) {
  std::string searched, why;
  std::vector<Started> found = dragged_states(scene, keys, searched);
  try {
    found.insert(found.begin(), coil_on_plate(scene, keys));
  } catch (const NoEquilibrium& none) {
    why = none.what();
  }
  if (found.empty())
    throw NoEquilibrium(why + "; nor a state that has left the plate, searched: " + searched);
  Equilibria out;
  std::vector<Vector> seen;  // without friction thick states may lead to the coil on its plate, too
  for (Started& state : found) {
    const Vector fingerprint = state.problem->fingerprint(state.x, state.p);
    if (among(seen, fingerprint)) continue;
    seen.push_back(fingerprint);
    Solution solution =
        finish(state, !why.empty() ? "there is no flat coil"
                      : scene.strand_radius() > 0.0
                          ? "the coil that lies on the plate, but for what passes below its other end"
                          : "the flat coil, which lies on the plate along its contact");
    out.states.push_back(summary_of(solution, scene, state.problem->total_index(state.x, state.p)));
    if (out.states.size() == 1) out.answer = std::move(solution);
  }
  out.answer.model_reason += fmt::format(
      "; {} steady states were found ({}), which of them a pull from rest "
      "selects was not decided",
      out.states.size(), searched);
  if (scene.rod_radius > 0.0 && scene.ends_turn_freely() && !scene.motion.friction_couple)
    out.answer.model_reason +=
        "; the friction has no moment about the centre line, which ends that turn freely do not balance";
  return out;
}

/// @param kirchhoff  the rung is asked for: the flat state, too, is given on it
Equilibria solve_capstan(const scene::Scene& scene, const std::vector<std::string>& keys, bool kirchhoff) {
  const bool half = scene.half_turn();
  if (scene.slides()) return solve_dragged(scene, keys);
  Flat flat = flat_state(scene, keys);
  const Vector print = flat.rod ? flat.rod->problem->fingerprint(flat.rod->x, flat.rod->p) : Vector();
  const auto finished = [&](FoundState& best) {
    if (kirchhoff) return finish(best.at, "asked for");
    if (scene.strand_radius() > 0.0)
      return finish(best.at, "a rod that touches itself leaves the plane: Kirchhoff rod with its thickness");
    if (flat.index == 0 && scene.ends.guided() && is(best, print))
      return finish(best.at, "the flat state is stable; ends on sliders are computed with the Kirchhoff rod");
    if (flat.index == 0 && half && is(best, print)) return solve_flat(scene, *flat.planar);
    if (!half) return finish(best.at, "the full chain was asked for (model.symmetry = \"none\")");
    if (!flat.rod) return finish(best.at, "there is no flat state in contact: " + flat.why);
    if (flat.index == 0) return finish(best.at, "the flat state is stable, too, but lies higher");
    return finish(best.at, fmt::format("the flat state is unstable in space (index {})", flat.index));
  };
  if (flat.index == 0 && !may_leave_plane(scene)) {
    FoundState alone{*flat.rod, 0, 0.0, print};
    return only(finished(alone), scene, 0);
  }
  return choose(scene, flat, keys, finished);
}

}  // namespace

std::string load_key(const scene::Scene& scene) {
  if (scene.has_cylinder) return "load.tension";
  return scene.ends.shortening ? "ends.shortening" : "load.thrust";
}

bool thrust_undetermined(const scene::Scene& scene) {
  return !scene.has_cylinder && scene.ends.shortening == 0.0 && scene.rod.compliance() == 0.0;
}

scene::Scene determinate(scene::Scene scene) {
  if (!thrust_undetermined(scene)) return scene;
  scene.ends.shortening.reset();
  scene.load.thrust = 0.0;
  if (scene.continuation && scene.continuation->parameter == "ends.shortening") scene.continuation.reset();
  scene.resolved_toml = scene::to_toml(scene);
  return scene;
}

namespace {

/// On the rung of the model that is asked for.
Equilibria on_rung(const scene::Scene& scene) {
  const std::vector<std::string> keys{load_key(scene)};
  const bool closed_form = scene.model.kind == ModelKind::closed_form;
  switch (scene.model.kind) {
    case ModelKind::kirchhoff:
    case ModelKind::automatic:
      if (scene.knot.tied()) return solve_knot(scene, keys);
      return scene.has_cylinder ? solve_capstan(scene, keys, scene.model.kind == ModelKind::kirchhoff)
                                : solve_strut(scene, keys, scene.model.kind == ModelKind::kirchhoff);
    case ModelKind::closed_form:
      if (!scene.has_cylinder || !scene.rod.infinite())
        throw InputError("model.kind = \"closed_form\": needs a cylinder and rod.length = \"inf\"");
      if (!rod::capstan::line_contact(scene.load.tension, scene.load.angle))
        throw NoEquilibrium(
            "the closed form has no line contact at this tension; model.kind = \"planar\" goes on");
      break;
    case ModelKind::planar:
      break;
  }
  Started planar = cold_start(scene, false, closed_form || scene.half_turn(), keys);
  const int index = planar.problem->total_index(planar.x, planar.p);
  const char* why = planar.problem->spatial() ? "struts are solved as Kirchhoff rods" : "asked for";
  Equilibria out = only(finish(planar, why), scene, index);
  if (closed_form) out.answer.model = "closed_form";
  return out;
}

}  // namespace

void answer_with_stable(Equilibria& found, const scene::Scene& scene) {
  const auto first = found.states.begin();
  const auto stable = std::find_if(first, found.states.end(), [](const auto& s) { return s.index == 0; });
  if (stable == first || stable == found.states.end()) return;
  const std::string reason =
      fmt::format("a stable state; not so, with index {}, {}", first->index, found.answer.model_reason);
  std::rotate(first, stable, stable + 1);
  const auto problem = reopen(scene, first->restart, {load_key(scene)});
  Started state{problem, first->restart.state, problem->parameters(), 0};
  const double seconds = found.answer.seconds_solve;
  found.answer = finish(state, reason);
  found.answer.seconds_total = found.answer.seconds_solve = seconds;
}

StateSummary summarised(const Started& state, const scene::Scene& natural) {
  Started own = state;
  const Solution solution = finish(own, "");
  return summary_of(solution, natural, own.problem->total_index(own.x, own.p));
}

Equilibria equilibria(const scene::Scene& asked) {
  const scene::Scene scene = scene::natural(determinate(asked));
  const auto begin = std::chrono::steady_clock::now();
  Equilibria out = on_rung(scene);
  if (thrust_undetermined(asked)) {
    const std::optional<double> most = buckling_thrust(scene);
    out.answer.model_reason = fmt::format(
        "without shortening an inextensible strut is straight and {}; shown is the one without thrust",
        most ? fmt::format("carries any thrust up to its buckling load {:.12g}", *most)
             : "already unstable without thrust, by its twist");
  }
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
  out.answer.seconds_total = out.answer.seconds_solve = taken.count();
  return out;
}

Solution solve(const scene::Scene& scene) { return equilibria(scene).answer; }

}  // namespace windlass::equilibrium
