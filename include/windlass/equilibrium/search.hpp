#pragma once

#include <optional>
#include <string>
#include <vector>

#include "windlass/equilibrium/start.hpp"

/// All equilibria at a scene's loads that the branches through them lead to.
namespace windlass::equilibrium {

/// Two states whose fingerprints agree to this are one: the error of a mesh lies far below, two branches far above.
inline constexpr double same_state = 1e-6;
/// Of potentials, relative: states of one family differ by rounding, others by more.
inline constexpr double same_potential = 1e-11;

/// Is a state of this fingerprint among these?
bool among(const std::vector<Vector>& fingerprints, const Vector& fingerprint);

/// One of them.
struct FoundState {
  Started at;
  int index = 0;           ///< negative directions of the whole rod, both parities
  double potential = 0.0;  ///< see potential(), equilibria.hpp [EI/ρ]
  Vector fingerprint;
  bool stable() const { return index == 0; }
};

struct Search {
  std::vector<FoundState> states;  ///< distinct; stable ones first, of lowest potential first
  std::string searched;            ///< where, for people: branches and range of the load
  const FoundState* stable() const {
    return !states.empty() && states.front().stable() ? &states.front() : nullptr;
  }
};

/// Follows the diagram of the scene's load from where the flat (straight) state is stable through the wanted value and
/// as far again beyond it, and takes every state that a branch has at that value.
///
/// @param spatial  in space, else in the plane
/// @param half     on half chains where the state is symmetric; else every state on the full chain
/// @param keys     parameters of the problems returned; the first one is scene's load_key()
Search search(const scene::Scene& scene, bool spatial, bool half, const std::vector<std::string>& keys);

/// The stable one of lowest potential among them in space, in the scene's units, with other parameters; nullopt: none.
std::optional<Started> stable_state(const scene::Scene& scene, const std::vector<std::string>& keys);

/// Adds a state that was found otherwise, unless it is there already.
void include(Search& search, Started state);

}  // namespace windlass::equilibrium
