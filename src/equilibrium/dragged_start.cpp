#include "dragged_start.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <continuation/diagram.hpp>

#include "attempt.hpp"
#include "between_plates.hpp"
#include "entry.hpp"
#include "friction_couple.hpp"
#include "harvest.hpp"
#include "stretched_drag.hpp"
#include "turns_on_plate.hpp"
#include "windlass/equilibrium/contact_events.hpp"
#include "windlass/equilibrium/search.hpp"
#include "windlass/rod/capstan.hpp"

namespace windlass::equilibrium {

using chain::ArcMesh;
using chain::Piece;
using chain::Stretch;

namespace {

constexpr int plate = 1;  // its place among the obstacles

/// Where a tail that rises to its end slopes no more than this: the plate's force bends it flat about there.
std::optional<double> levels_off(const Piece& tail, bool leftward, double slope) {
  const Eigen::Index last = tail.s.size() - 1;
  for (Eigen::Index k = 1; k < last; ++k) {
    const Eigen::Index at = leftward ? last - k : k;
    if (std::abs(tail.inclination(at)) < slope) return tail.s(at);
  }
  return std::nullopt;
}

/// Where a tail comes out from under a plate of this radius.
std::optional<double> comes_out(const Piece& tail, bool leftward, double outer_radius) {
  const Eigen::Index last = tail.s.size() - 1;
  for (Eigen::Index k = 1; k <= last; ++k) {
    const Eigen::Index at = leftward ? last - k : k, before = leftward ? at + 1 : at - 1;
    const double here = tail.r.col(at).head<2>().norm() - outer_radius,
                 last_one = tail.r.col(before).head<2>().norm() - outer_radius;
    if (last_one < 0.0 && here >= 0.0)
      return tail.s(before) - (tail.s(at) - tail.s(before)) * last_one / (here - last_one);
  }
  return std::nullopt;
}

/// Where a plate first holds a tail that rises, and on which obstacle: its surface, or its outer edge.
struct Hold {
  double s;
  int obstacle;
};
std::optional<Hold> held_at(const Piece& tail, bool leftward, double slope, const scene::Plate& its_plate) {
  const std::optional<double> level = levels_off(tail, leftward, slope);
  if (!std::isfinite(its_plate.outer_radius))
    return level ? std::optional(Hold{*level, plate}) : std::nullopt;
  const std::optional<double> out = comes_out(tail, leftward, its_plate.outer_radius);
  if (out && (!level || std::abs(*out) < std::abs(*level))) return Hold{*out, plate + 1};
  return level ? std::optional(Hold{*level, plate}) : std::nullopt;
}

/// The rod round a cylinder that stands, and no plate.
scene::Scene standing(scene::Scene scene) {
  scene.plate.reset();
  scene.second_plate.reset();
  scene.motion = {};
  return scene;
}

/// Contacts, the places of joints and the meshes between them.
struct Layout {
  Topology topology;
  std::vector<double> s;
  std::vector<ArcMesh> meshes;
};

/// The state on these contacts, from a shape lifted by `lift`. @param p  of the keys; nothing: the scene's
std::optional<Started> on_contacts(Layout layout, chain::Profile shape, double lift,
                                   const scene::Scene& scene, const std::vector<std::string>& keys,
                                   std::optional<Vector> p) {
  for (Piece& piece : shape.pieces) piece.r.row(2).array() += lift;
  choose_tails(layout.meshes, layout.topology, rod_of(scene, true), loads_of(scene), layout.s);
  const auto problem = std::make_shared<RodProblem>(scene, true, layout.topology, layout.meshes, keys);
  if (!p) p = problem->parameters();
  Vector x = chain::guess_state(problem->chain(), layout.topology, problem->rod(), shape, layout.s);
  const int used = problem->polish(x, *p);
  if (used < 0) return std::nullopt;
  return Started{problem, problem->refine(x, *p), *p, used};
}

/// Contacts in their order along the rod, free between them and beyond.
Layout layout_of(const std::vector<Pressing>& pressing, const contact::Loads& loads) {
  Layout out;
  out.topology.half = false;
  out.topology.on = {{}};
  out.s = {-loads.half_length};
  const auto cut = [&](double s, Stretch behind, int obstacle) {
    out.topology.stretches.push_back(behind);
    out.topology.on.push_back(chain::Seat{obstacle});
    out.s.push_back(s);
  };
  Stretch behind = Stretch::tail;
  for (const Pressing& one : pressing) {
    cut(one.begin, behind, one.obstacle);
    if (one.line()) cut(one.end, Stretch::line, one.obstacle);
    behind = Stretch::gap;
  }
  cut(loads.half_length, Stretch::tail, 0);
  for (std::size_t i = 0; i < out.topology.stretches.size(); ++i)
    out.meshes.push_back(first_mesh(out.topology.stretches[i], loads, out.s[i + 1] - out.s[i]));
  out.meshes.front() = reversed(out.meshes.front());  // fine where it leaves the contact
  return out;
}

/// Does the plate reach as far as it is touched?
bool within_the_plate(RodProblem& problem, const Vector& x, const Vector& p) {
  for (const ContactEvent& event : contact_events(problem.profile(x, p), problem.topology()))
    if (event.kind == ContactEvent::Kind::rim && event.value < 0.0) return false;
  return true;
}

double height_of_end(const Piece& tail, bool leftward) { return tail.r(2, leftward ? 0 : tail.s.size() - 1); }

}  // namespace

std::optional<Started> under_the_plate(const Started& still, const scene::Scene& scene, double friction,
                                       std::string& failure) {
  const chain::Profile shape = still.problem->profile(still.x, still.p);
  std::vector<double> s = still.problem->joint_places(still.x, still.p, shape);
  Topology topology = still.problem->topology();
  std::vector<ArcMesh> meshes = still.problem->meshes();
  if (topology.on.empty()) topology.on.resize(topology.stretches.size() + 1);
  double top = -HUGE_VAL;
  for (const Piece& piece : shape.pieces) top = std::max(top, piece.r.row(2).maxCoeff());
  // The plate's force is mu R_tot or so, and turns the end of the tail by that over the pull.
  const double drag =
      friction * still.problem->target(still.problem->chain(), still.x, still.problem->loads(still.p));
  const double slope = drag / scene.load.tension;
  double height = top;
  bool touched = false;
  for (const bool leftward : {false, true}) {
    const Piece& tail = leftward ? shape.pieces.front() : shape.pieces.back();
    constexpr double as_high = 1e-6;
    if (height_of_end(tail, leftward) < top - as_high) continue;
    const std::optional<Hold> at = held_at(tail, leftward, slope, *scene.plate);
    if (!at)
      return failure = "the tail that is highest is shorter than where the plate would hold it", std::nullopt;
    const int link = leftward ? 0 : static_cast<int>(topology.stretches.size()) - 1;
    topology.stretches.insert(topology.stretches.begin() + link, topology.stretches[link]);
    topology.stretches[leftward ? 1 : link] = Stretch::gap;
    topology.on.insert(topology.on.begin() + link + 1, chain::Seat{at->obstacle});
    s.insert(s.begin() + link + 1, at->s);
    meshes.insert(meshes.begin() + link, meshes[link]);
    height = shape.at(at->s).r(2);
    touched = true;
  }
  if (!touched) return failure = "no tail rises to the highest place", std::nullopt;
  auto laid = on_contacts({topology, s, meshes}, shape, scene.plate->height - height, scene,
                          {"cylinder.friction"}, Vector::Constant(1, friction));
  if (!laid) failure = "Newton did not converge under the plate";
  return laid;
}

namespace {

/// The state near this shape on these contacts, or on those that follow where they do not hold.
std::optional<Started> mended_on(Layout layout, const chain::Profile& shape, const scene::Scene& scene,
                                 const std::vector<std::string>& keys, std::string& failure) {
  const std::string contacts = layout.topology.text();
  const std::optional<Started> laid = on_contacts(std::move(layout), shape, 0.0, scene, keys, {});
  if (!laid) return failure = "Newton did not converge on the contacts " + contacts, std::nullopt;
  Entry found{laid->problem, laid->x, laid->p};
  int iterations = laid->newton_iterations;
  constexpr int most = 20;
  for (int k = 0; k < 3 && mend(found, most, false, iterations); ++k) {
    found.x = found.problem->refine(found.x, found.p);
    const chain::Profile fine = found.problem->profile(found.x, found.p);
    if (!most_violated(contact_events(fine, found.problem->topology()), fine.unit_length))
      return Started{found.problem, found.x, found.p, iterations};
  }
  failure = "no contacts were found that hold all, last " + found.problem->topology().text();
  return std::nullopt;
}

/// States between sliders, each next to one whose ends are free to move.
std::vector<Started> dragged_between_sliders(const scene::Scene& scene, const std::vector<std::string>& keys,
                                             std::string& searched) {
  scene::Scene loose = scene;
  loose.ends.guide = scene::Guide::none;
  std::vector<Started> out;
  std::string lost;
  for (const Started& state : dragged_states(loose, {"cylinder.friction"}, searched)) {
    std::string failure;
    try {
      const chain::Profile shape = state.problem->profile(state.x, state.p);
      Layout layout{state.problem->topology(), state.problem->joint_places(state.x, state.p, shape),
                    state.problem->meshes()};
      if (auto held = mended_on(std::move(layout), shape, scene, keys, failure))
        out.push_back(*held);
      else
        lost += "; one was not found between sliders: " + failure;
    } catch (const NoEquilibrium& none) {
      lost += fmt::format("; one was not found between sliders: {}", none.what());
    }
  }
  searched += fmt::format("; {} of them between sliders", out.size()) + lost;
  return out;
}

}  // namespace

std::optional<Started> dragged_on(const scene::Scene& scene, const chain::Profile& shape,
                                  const std::vector<Pressing>& pressing, const std::vector<std::string>& keys,
                                  std::string& failure) {
  return mended_on(layout_of(pressing, loads_of(scene)), shape, scene, keys, failure);
}

Started flat_on_plate(const scene::Scene& scene, const std::vector<std::string>& keys) {
  std::string failure;
  if (scene.friction_arm() > 0.0 && std::isfinite(scene.plate->outer_radius))
    throw NoEquilibrium(
        "there is no flat coil: the moment of the friction twists its tails, which plate.outer_radius lets "
        "rise");
  // Without a line the coil in space is free to turn: its shape is that of the plane.
  const bool lies = rod::capstan::line_contact(scene.load.tension, scene.load.angle);
  const std::optional<Started> still =
      followed_coil(standing(scene), lies || scene.ends.guided(), false, keys, failure);
  if (!still) throw NoEquilibrium("there is no flat coil: " + failure);
  Topology topology = still->problem->topology();
  topology.on.resize(topology.stretches.size() + 1);
  for (int j = 1; j < static_cast<int>(topology.stretches.size()); ++j)
    if (topology.stretches[j] == Stretch::line || topology.stretches[j - 1] != Stretch::line)
      topology.on[j].flat = plate;
  const chain::Profile shape = still->problem->profile(still->x, still->p);
  const std::vector<double> s = still->problem->joint_places(still->x, still->p, shape);
  auto laid =
      on_contacts({topology, s, still->problem->meshes()}, shape, scene.plate->height, scene, keys, {});
  if (!laid) throw NoEquilibrium("Newton did not converge on the flat coil on its plate");
  if (!scene.mirrored()) return *laid;
  const auto half = fold(*laid->problem, laid->x, laid->p, chain::Symmetry::mirror);
  if (!half) throw NoEquilibrium("Newton did not converge on half of the flat coil on its plate");
  return *half;
}

namespace {

/// Where the right tail of a flat coil crosses the left one: the first place behind its contact in the plane of symmetry.
std::optional<double> tails_cross(const chain::Profile& shape) {
  const Piece& tail = shape.pieces.back();
  for (Eigen::Index k = 1; k < tail.s.size(); ++k) {
    const double before = tail.r(0, k - 1), after = tail.r(0, k);
    constexpr double touching = 1e-9;  // a touch in the middle is no crossing
    if (before * after > 0.0 || std::abs(before) < touching) continue;
    return tail.s(k - 1) + (tail.s(k) - tail.s(k - 1)) * before / (before - after);
  }
  return std::nullopt;
}

/// The flat coil on its plate with its left tail pressed down by 2r where it passes below the right one, which lies in the plate.
/// The left part of the contact then leaves the plate a little before its edge: a beam pressed up by mu p, and by mu f at its free
/// end d away, is held down by the other tail's λ, c behind that, λ (d + c) = mu f d + ½ mu p d².
Layout pressed_below(const chain::Profile& shape, double crossing, const scene::Scene& scene,
                     chain::Profile& bent) {
  const contact::Loads loads = loads_of(scene);
  const double edge = shape.pieces.back().s(0), c = crossing - edge, r = scene.rod_radius;
  const double mu = loads.friction, p = mu * shape.pieces[1].p(0);
  const double f = mu * shape.contacts.back().force;
  const double push = 2.0 * r * (loads.tension / c + 3.0 / (c * c * c)), rest = f - push;
  const double d = (std::sqrt(rest * rest + 2.0 * p * push * c) - rest) / p;
  Layout out;
  out.topology.half = false;
  out.topology.stretches = {Stretch::tail, Stretch::gap, Stretch::line,
                            Stretch::line, Stretch::gap, Stretch::tail};
  out.topology.on.resize(7);
  out.s = {-loads.half_length, -crossing, -edge, d - edge, edge, crossing, loads.half_length};
  out.topology.on[1].strand = 1;
  out.topology.on[3].flat = plate;
  out.topology.on[5] = {plate, 1};
  out.topology.on[5].flat = plate;
  for (std::size_t i = 0; i < out.topology.stretches.size(); ++i)
    out.meshes.push_back(first_mesh(out.topology.stretches[i], loads, out.s[i + 1] - out.s[i]));
  out.meshes.front() = reversed(out.meshes.front());
  bent = shape;
  for (Piece& piece : bent.pieces)
    for (Eigen::Index k = 0; k < piece.s.size(); ++k)
      if (const double down = d - edge - piece.s(k); down > 0.0)
        piece.r(2, k) -= 2.0 * r * std::min(1.0, down * down / ((c + d) * (c + d)));
  return out;
}

/// Do the turns of this flat coil lie on each other?
bool laps(const chain::Profile& shape) {
  return shape.pieces.size() == 3 && shape.pieces[1].length() > 2.0 * M_PI;
}

/// A coil so thick that its tails pass each other, from a thin one on the plate.
std::optional<Started> crossing_on_plate(const scene::Scene& scene, const std::vector<std::string>& keys,
                                         std::string& failure) {
  scene::Scene thin = scene;
  thin.self_contact = false;
  const Started flat = flat_on_plate(thin, keys);
  const chain::Profile shape = flat.problem->profile(flat.x, flat.p);
  if (laps(shape)) return failure = "the turns of the flat coil lie on each other", std::nullopt;
  const std::optional<double> crossing = tails_cross(shape);
  if (crossing && (scene.friction_arm() > 0.0 || !scene.free_of_torsion())) {
    failure =
        "its tails would cross, which is built for tails without torsion: ends.kind = \"moment_free\" and "
        "cylinder.friction_couple = false";
    return std::nullopt;
  }
  if (!crossing) {
    auto problem =
        std::make_shared<RodProblem>(scene, true, flat.problem->topology(), flat.problem->meshes(), keys);
    const Vector p = problem->parameters();
    if (contacts_hold(*problem, flat.x, p)) return Started{problem, flat.x, p, flat.newton_iterations};
    return failure = "the flat coil passes through itself", std::nullopt;
  }
  if (shape.pieces.size() != 3) return failure = "it has no line contact to start from", std::nullopt;
  failure = "pressed apart where they cross, the tails of the flat coil were not balanced";
  for (double radius = std::min(0.01, scene.rod_radius); radius > 1e-5; radius *= 0.3) {
    scene::Scene slender = scene;
    slender.rod_radius = radius;
    chain::Profile bent;
    Layout layout = pressed_below(shape, *crossing, slender, bent);
    auto start = on_contacts(std::move(layout), bent, 0.0, slender, {"rod.radius"}, {});
    if (!start || !contacts_hold(*start->problem, start->x, start->p)) continue;
    auto reached = reach(*start, scene, scene.rod_radius, false, keys, failure);
    if (!reached) failure = "from the thin rod no thick one was reached: " + failure;
    return reached;
  }
  return std::nullopt;
}

}  // namespace

Started coil_on_plate(const scene::Scene& scene, const std::vector<std::string>& keys) {
  if (scene.second_plate) {
    std::string failure;
    const Started coil = coil_on_plate(with_one_plate(scene), {"load.tension"});
    if (auto found = between_plates(coil, scene, keys, failure)) return *found;
    throw NoEquilibrium("the coil on its plate was not found with a second plate: " + failure);
  }
  if (!(scene.strand_radius() > 0.0)) return flat_on_plate(scene, keys);
  std::string failure;
  // Thin tails cross on lines where the tension is high, and hang on touches where it is low.
  constexpr double loose = 2.0, low = 0.6, high = 5.0;
  if (scene.load.tension > low && scene.load.tension < high)
    if (auto found = crossing_on_plate(scene, keys, failure)) return *found;
  scene::Scene moderate = scene;
  moderate.load.tension = loose;
  if (const auto from = crossing_on_plate(moderate, {"load.tension"}, failure))
    if (auto found = reach(*from, scene, scene.load.tension, false, keys, failure)) return *found;
  throw NoEquilibrium("no coil of this thickness was found on the plate: " + failure);
}

namespace {

/// States beside one plate that the second one, brought to where it is, leads to.
std::vector<Started> dragged_between_plates(const scene::Scene& scene, const std::vector<std::string>& keys,
                                            std::string& searched) {
  std::vector<Started> out;
  std::string lost;
  for (const Started& state : dragged_states(with_one_plate(scene), {"load.tension"}, searched)) {
    std::string failure;
    if (auto found = between_plates(state, scene, keys, failure))
      out.push_back(*found);
    else
      lost += "; one was not found with the second plate: " + failure;
  }
  searched += fmt::format("; {} of them with the second plate", out.size()) + lost;
  return out;
}

}  // namespace

std::vector<Started> left_the_plate(const scene::Scene& scene, const std::vector<std::string>& keys,
                                    std::string& searched) {
  constexpr double flat = 1e-6;  // [ρ]
  // Next to nothing; with more friction the plate holds the tail nearer to the coil, so that short tails need more.
  constexpr double least = 1e-3, next = 2.0, most = 0.1;
  const double goal = scene.dragging_friction();
  std::vector<Started> out;
  try {
    if (!(scene.strand_radius() > 0.0)) out = hanging_arches(scene, keys);
  } catch (const NoEquilibrium&) {  // no flat coil to bend down
  }
  const std::size_t arches = out.size();
  int followed = 0, points = 0, beyond = 0;
  for (const FoundState& still : search(standing(scene), true, false, {"load.tension"}).states) {
    if (still.fingerprint(2) < flat) continue;
    std::optional<Started> start;
    std::string failure;
    for (double mu = std::min(least, 0.5 * goal); !start && mu < std::min(most, goal); mu *= next)
      start = under_the_plate(still.at, scene, mu, failure);
    if (start && scene.mirrored()) start = fold(*start->problem, start->x, start->p, chain::Symmetry::mirror);
    if (!start) continue;
    ++followed;
    continuation::Options options;
    options.target = options.upper = 2.0 * goal;  // beyond it a branch may turn and come back
    options.lower = 0.5 * start->p(0);            // one that comes back past its start leads nowhere
    options.parameter_scale = goal;
    options.detect_branch_points = false;
    options.newton_tolerance = 1e-9;
    options.max_points = 800;
    Harvest harvest(goal, options);
    continuation::DiagramOptions one;
    one.max_branches = 1;
    continuation::trace_diagram(start->problem, start->x, start->p, options, one, harvest);
    points += harvest.points();
    for (const Started& found : harvest.states()) {
      const auto problem =
          std::make_shared<RodProblem>(scene, true, found.problem->topology(), found.problem->meshes(), keys);
      Vector x = found.x;
      if (problem->polish(x, problem->parameters()) < 0) continue;
      if (within_the_plate(*problem, x, problem->parameters()))
        out.push_back({problem, x, problem->parameters(), 0});
      else
        ++beyond;
    }
  }
  searched = fmt::format("{} states without friction dragged to mu = {:.4g} and as far again, {} points",
                         followed, goal, points);
  if (arches > 0) searched += fmt::format("; {} that hang from the plate on both sides", arches);
  if (beyond > 0)
    searched += fmt::format("; {} would touch the plate beyond plate.outer_radius = {:.6g}", beyond,
                            scene.plate->outer_radius);
  return out;
}

std::vector<Started> dragged_states(const scene::Scene& scene, const std::vector<std::string>& keys,
                                    std::string& searched) {
  if (scene.second_plate) return dragged_between_plates(scene, keys, searched);
  if (scene.friction_arm() > 0.0) return dragged_with_couple(scene, keys, searched);
  if (scene.ends.guided()) return dragged_between_sliders(scene, keys, searched);
  if (scene.rod.extensible) return dragged_with_stretch(scene, keys, searched);
  return turns_press(scene) ? turns_on_plate(scene, keys, searched) : left_the_plate(scene, keys, searched);
}

}  // namespace windlass::equilibrium
