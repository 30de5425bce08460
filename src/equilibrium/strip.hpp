#pragma once

#include <vector>

#include "windlass/equilibrium/contact_events.hpp"

/// Cutting and joining the arcs of a chain.
namespace windlass::equilibrium {

/// The chain's arcs with their bounds: easier to cut and join than topologies.
struct Strip {
  struct Part {
    chain::Stretch kind;
    int source;          ///< link of the old chain
    bool fresh = false;  ///< has no length at the event itself
  };
  std::vector<Part> parts;
  std::vector<double> s;                ///< bounds of the parts
  std::vector<chain::Seat> on;          ///< what the bounds touch, see chain::Topology
  bool half = true, mid_touch = false;  ///< see chain::Topology
  chain::Symmetry symmetry = chain::Symmetry::half_turn;

  Strip(const chain::Topology& topology, const std::vector<double>& places);
  explicit Strip(const Successor& next);
  Successor successor() const;

  /// Is there such a part, and is it a line?
  bool is_line(int part) const {
    return part >= 0 && part < static_cast<int>(parts.size()) && parts[part].kind == chain::Stretch::line;
  }
  /// Does a part of a half chain begin at its mid-point?
  bool starts_at_mid(int part) const { return half && part == 0; }

  /// Takes out part i and one of its bounds.
  void erase(int i, int bound);
  /// Replaces parts [first, last] by one.
  void merge(int first, int last, chain::Stretch kind);
  /// Splits part i at s into (i, left) and (i + 1, right), by a contact with what is given, else on the obstacle of the part's
  /// first bound.
  void split(int i, double at, chain::Stretch left, chain::Stretch right, std::optional<chain::Seat> on = {});
  /// The plate that a free part lies in, for it ends where the rod touches one along with something else; −1: none.
  int plate_beside(int part) const;
  /// The part that s lies in.
  int part_at(double at) const;
  /// Cuts part i at s by a contact: free on both sides of it, or a line that another strand presses on, on the line's obstacle.
  void cut(int i, double at, chain::Seat contact);
  /// Takes out part i, which has no length left: what met at its two ends meets now. @returns false for an end of the rod
  bool collapse(int i);

 private:
  bool collapse_about_mid();
};

/// What two arcs with a contact between them are without it: free, a tail if either is; one line, where a strand pressed on it.
chain::Stretch joined(chain::Stretch a, chain::Stretch b);

}  // namespace windlass::equilibrium
