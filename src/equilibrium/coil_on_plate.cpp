// Coils that lie on a plate along their contact: flat ones, and thick ones whose tails pass each other.
#include <algorithm>
#include <cmath>

#include "attempt.hpp"
#include "between_plates.hpp"
#include "dragged_layout.hpp"
#include "dragged_start.hpp"
#include "entry.hpp"
#include "windlass/rod/capstan.hpp"

namespace windlass::equilibrium {

using chain::Piece;
using chain::Stretch;

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
      topology.on[j].flat = plate_obstacle;
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
  out.topology.on[3].flat = plate_obstacle;
  out.topology.on[5] = {plate_obstacle, 1};
  out.topology.on[5].flat = plate_obstacle;
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

}  // namespace windlass::equilibrium
