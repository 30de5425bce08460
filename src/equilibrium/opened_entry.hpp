#pragma once

#include <optional>
#include <vector>

#include "entry.hpp"

namespace windlass::equilibrium {

/// How many more arcs may open together with one, and how many states of several are tried: each has several that may follow.
struct Together {
  int depth = 5, tries = 40;
};

/// Solves for a successor with opened arcs. Where the pressure is lost in several places almost at once, the state with
/// one gap open has suction in another: that opens too, and so on.
/// @param opened   links of `entry`, the one that keeps its length first
/// @param as_long  as it is at p(0) = p; else brought to the length that arcs are entered with
std::optional<Entry> open_in_turn(Entry entry, const std::vector<int>& opened, Together& left, bool as_long,
                                  double p);

}  // namespace windlass::equilibrium
