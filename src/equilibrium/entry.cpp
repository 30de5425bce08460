#include "entry.hpp"

#include <algorithm>
#include <cmath>

#include "windlass/equilibrium/start.hpp"

namespace windlass::equilibrium {

namespace {

constexpr int elements = 4;  // of an arc, at least

/// The elements that the old arcs have between two places, in scaled arclength: an arc cut in two, or made of several, is as
/// finely resolved as they were. What has just closed leaves none.
std::vector<double> inherited(const chain::Profile& shape, double begin, double end) {
  constexpr double apart = 0.1;  // of the element before, and of the unit
  std::vector<double> nodes{0.0};
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

Entry draft(const RodProblem& from, const Successor& next, const chain::Profile& shape, const Vector& p) {
  std::vector<chain::ArcMesh> meshes;
  for (int source : next.source)
    meshes.push_back(from.meshes().empty() ? chain::ArcMesh{} : from.meshes()[source]);
  const std::vector<chain::Stretch>&before = from.topology().stretches, &now = next.topology.stretches;
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    const double length = next.s[i + 1] - next.s[i];
    const bool along_strand = next.topology.beside(static_cast<int>(i)) >= 0;
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
  // A rod that finds its own place along itself keeps doing so: held where the guess lies, it would be another.
  RodProblem::Memory kept;
  if (const RodProblem::Memory before_it = from.memory(); before_it.slides) {
    kept.slides = true;
    kept.sliding_off = before_it.sliding_off;
    kept.sliding_reference = before_it.sliding_reference;
  }
  problem->remember(kept);
  const Vector guess = chain::guess_state(problem->chain(), next.topology, problem->rod(), shape, next.s);
  return {problem, guess, p};
}

}  // namespace windlass::equilibrium
