#include "entry.hpp"

#include <algorithm>
#include <cmath>

#include "attempt.hpp"
#include "layer_mesh.hpp"
#include "windlass/chain/guess.hpp"
#include "windlass/equilibrium/opening.hpp"
#include "windlass/equilibrium/start.hpp"

namespace windlass::equilibrium {

namespace {

constexpr int elements = 4;  // of an arc, at least

/// The elements that the old arcs have between two places, in scaled arclength: an arc cut in two, or made of several, is as
/// finely resolved as they were. What has just closed leaves none.
std::vector<double> inherited(const chain::Profile& shape, double begin, double end) {
  constexpr double apart = 0.1;  // of the element before, and of the unit
  std::vector<double> nodes{0.0};
  if (end == begin) return {0.0, 1.0};
  const double least = apart * shape.unit_length / (end - begin);
  for (const chain::Piece& piece : shape.pieces) {
    if (piece.stride == 1) continue;  // a formula
    for (Eigen::Index k = 0; k < piece.s.size(); k += piece.stride) {
      const double node = (piece.s(k) - begin) / (end - begin);
      if (node > nodes.back() + least && node < 1.0 - least) nodes.push_back(node);
    }
  }
  nodes.push_back(1.0);
  return nodes;
}

}  // namespace

bool admissible(const std::vector<ContactEvent>& events) {
  return std::all_of(events.begin(), events.end(), [](const ContactEvent& event) {
    return event.passes || event.value >= (event.kind == ContactEvent::Kind::length ? 1e-6 : -1e-6);
  });
}

bool holds(const Entry& entry) {
  return admissible(contact_events(entry.problem->profile(entry.x, entry.p), entry.problem->topology()));
}

const ContactEvent* most_violated(const std::vector<ContactEvent>& events, double unit, bool redrawn) {
  using Kind = ContactEvent::Kind;
  constexpr Kind order[] = {Kind::length, Kind::approach, Kind::graze,     Kind::room, Kind::slope,
                            Kind::force,  Kind::pressure, Kind::curvature, Kind::dip,  Kind::reaction};
  constexpr double rounding = 1e-9, near = 0.1;
  const auto violated = [&](const ContactEvent& event) {
    return !event.passes && event.value < -rounding && (event.redrawn || !redrawn);
  };
  for (const Kind kind : order) {
    const ContactEvent* worst = nullptr;
    for (const ContactEvent& event : events)
      if (event.kind == kind && violated(event) && (!worst || event.value < worst->value)) worst = &event;
    if (!worst) continue;
    if (kind == Kind::approach && !worst->redrawn)
      for (const ContactEvent& event : events)
        if (event.kind == Kind::curvature && violated(event) &&
            std::min(std::abs(event.s - worst->s), std::abs(event.s - worst->s_other)) < near * unit)
          return &event;
    return worst;
  }
  return nullptr;
}

bool mend(Entry& at, int most, bool redrawn, int& iterations) {
  constexpr int most_laid = 8;
  int laid = 0;
  bool pulled = false;
  for (int k = 0; k < most; ++k) {
    const chain::Profile shape = at.problem->profile(at.x, at.p);
    const Topology& topology = at.problem->topology();
    const std::vector<ContactEvent> events = contact_events(shape, topology);
    const ContactEvent* violated = most_violated(events, shape.unit_length, redrawn);
    if (!violated) return admissible(events);
    std::vector<Successor> all =
        successors(*violated, shape, topology, at.problem->joint_places(at.x, at.p, shape));
    // Laid anew again and again, where a line is open inside, what is too near is filled.
    if (violated->kind == ContactEvent::Kind::approach && violated->redrawn && ++laid > most_laid)
      all.erase(all.begin(), all.end() - 1);
    // A touch that pulls after that, too, does so for what is between the strands.
    const bool pulls = violated->kind == ContactEvent::Kind::force && violated->redrawn;
    if (pulls && pulled && all.size() > 1) all.erase(all.begin());
    pulled |= pulls;
    bool found = false;
    for (Successor& next : all) {
      if (!at.problem->admits(next.topology)) continue;
      std::sort(next.s.begin(), next.s.end());  // what has changed places
      Entry entry = draft(*at.problem, next, shape, at.p);
      const int used = entry.problem->polish(entry.x, entry.p);
      if (used < 0) continue;
      iterations += used;
      at = entry;
      found = true;
      break;
    }
    if (!found) return false;
  }
  return false;
}

Entry draft(const RodProblem& from, const Successor& next, const chain::Profile& shape, const Vector& p) {
  std::vector<chain::ArcMesh> meshes;
  for (int source : next.source)
    meshes.push_back(from.meshes().empty() ? chain::ArcMesh{} : from.meshes()[source]);
  const std::vector<chain::Stretch>&before = from.topology().stretches, &now = next.topology.stretches;
  const chain::Strands strands(next.topology);
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    const double length = next.s[i + 1] - next.s[i];
    const bool along_strand = strands.along(static_cast<int>(i));
    if (meshes[i].stages > 0) meshes[i].stages = along_strand ? stages_along_strand : start_stages;
    if ((now[i] == chain::Stretch::line || along_strand) && length > 0.0 && std::isfinite(length))
      meshes[i].nodes = inherited(shape, next.s[i], next.s[i + 1]);
    if (along_strand) continue;  // many, and each as short as need be
    if (meshes[i].nodes.size() > elements && before[next.source[i]] == now[i]) continue;
    // Was a closed form, or a smooth line of several turns.
    const double most = std::min(std::abs(length), 40.0);
    meshes[i].nodes = chain::uniform_mesh(std::max(elements, static_cast<int>(std::ceil(most))));
  }
  for (int link : next.opened) meshes[link].nodes = chain::uniform_mesh(elements);
  const scene::Scene scene = from.scene_at(p);
  choose_tails(meshes, next.topology, from.rod(), loads_of(scene), next.s);
  auto problem = std::make_shared<RodProblem>(scene, from.spatial(), next.topology, meshes, from.keys());
  if (problem->layered()) {
    const Vector guess = chain::guess_state(problem->chain(), next.topology, problem->rod(), shape, next.s);
    meshes = with_layers(problem->chain(), meshes, guess, problem->loads(p));
    problem = std::make_shared<RodProblem>(scene, from.spatial(), next.topology, meshes, from.keys());
  }
  // A rod that finds its own place along itself keeps doing so: held where the guess lies, it would be another.
  RodProblem::Memory kept;
  if (const RodProblem::Memory before_it = from.memory(); before_it.slides) {
    kept.slides = true;
    kept.sliding_off = before_it.sliding_off;
    kept.sliding_reference = before_it.sliding_reference;
  }
  problem->remember(kept);
  Vector guess = chain::guess_state(problem->chain(), next.topology, problem->rod(), shape, next.s);
  if (!next.held.empty()) {
    Vector settled = guess;
    if (tried([&] { return settle_about(*problem, settled, p, next.held); })) guess = settled;
  }
  return {problem, guess, p};
}

}  // namespace windlass::equilibrium
