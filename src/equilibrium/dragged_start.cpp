#include "dragged_start.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <continuation/diagram.hpp>

#include "attempt.hpp"
#include "between_plates.hpp"
#include "dragged_layout.hpp"
#include "entry.hpp"
#include "friction_couple.hpp"
#include "harvest.hpp"
#include "stretched_drag.hpp"
#include "turns_on_plate.hpp"
#include "windlass/equilibrium/contact_events.hpp"
#include "windlass/equilibrium/search.hpp"

namespace windlass::equilibrium {

using chain::ArcMesh;
using chain::Piece;
using chain::Stretch;

namespace {

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
    return level ? std::optional(Hold{*level, plate_obstacle}) : std::nullopt;
  const std::optional<double> out = comes_out(tail, leftward, its_plate.outer_radius);
  if (out && (!level || std::abs(*out) < std::abs(*level))) return Hold{*out, plate_obstacle + 1};
  return level ? std::optional(Hold{*level, plate_obstacle}) : std::nullopt;
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
