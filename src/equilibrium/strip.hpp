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
    chain::MicroGaps gaps = {};
  };
  std::vector<Part> parts;
  std::vector<double> s;  ///< bounds of the parts
  bool half = true, mid_touch = false;
  bool passes_mid = false;  ///< see Successor
  int marker = 0;           ///< bound at the mid-point

  Strip(const chain::Topology& topology, const std::vector<double>& places);
  Successor successor() const;

  bool starts_at_mid(int part) const { return part == marker; }
  bool ends_at_mid(int part) const { return !half && part + 1 == marker; }
  /// Is there a part of this kind on both sides of the mid-point (in a half chain: beside it)?
  bool astride(chain::Stretch kind) const;

  /// Takes out part i and one of its bounds.
  void erase(int i, int bound);
  /// Replaces parts [first, last] by one.
  void merge(int first, int last, chain::Stretch kind);
  /// Splits part i at s into (i, left) and (i + 1, right). Its gaps without arcs at its ends stay there; those inside are
  /// the caller's to share out.
  void split(int i, double at, chain::Stretch left, chain::Stretch right);
  /// Takes out part i, which has no length left, about the mid-point both halves of it: what met at its two ends meets
  /// now. @returns false for an end of the rod
  bool collapse(int i);

 private:
  bool collapse_about_mid();
  /// The bound of part i, which has run out beside the mid-point, goes over to the other side of it.
  bool pass_mid(int i);
};

}  // namespace windlass::equilibrium
