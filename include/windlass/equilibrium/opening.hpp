#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "windlass/chain/singular_matrix.hpp"
#include "windlass/equilibrium/rod_problem.hpp"

/// Entering a contact topology that has an arc the one before did not have.
///
/// Where a gap of length ℓ has just opened inside a line contact, its edge forces go like ℓ³ and its height like ℓ⁶,
/// while ℓ itself goes like the square root of the distance to the event: at fixed load Newton has next to no domain
/// of attraction. With ℓ prescribed and the load free the same equations are nearly linear.
namespace windlass::equilibrium {

/// What `step` answers, or false where a length or tension leaves its domain or a matrix has no inverse on the way.
template <class Step>
bool tried(Step&& step) {
  try {
    return step();
  } catch (const std::domain_error&) {
  } catch (const chain::SingularMatrix&) {
  }
  return false;
}

/// A smooth function at zero by Richardson's extrapolation, and what one order less gives.
template <class Value>
struct Limit {
  Value value, before;
};

/// @param values  at distances that double, nearest first
template <class Value, std::size_t levels>
Limit<Value> limit_at_zero(std::array<Value, levels> values) {
  Value before = values[0];
  for (std::size_t order = 1; order < levels; ++order) {
    before = values[0];
    for (std::size_t k = 0; k + order < levels; ++k)
      values[k] += (values[k] - values[k + 1]) / ((1 << order) - 1);
  }
  return {values[0], before};
}

/// Lets the shape adjust while the edges of the opened links and of short gaps stay where they are, their location conditions
/// waived: a few corrections, as a start for what follows.
/// @returns false where the matrix has no inverse or a length or tension leaves its domain
bool settle_shape(RodProblem& problem, Vector& x, const Vector& p, const std::vector<int>& opened);

/// The same while these joints, edges, touches or ends of lines between strands, stay where they are.
bool settle_about(RodProblem& problem, Vector& x, const Vector& p, const std::vector<int>& joints);

/// Solves for the state at p, with steps cut where an arc would lose more than half its length.
/// @returns whether Newton converged; x is the solution then, and unspecified otherwise
bool solve_in_place(RodProblem& problem, Vector& x, const Vector& p);

/// Solves for the state in which the link has the given length, and for p(0) with it.
/// @returns whether Newton converged; x and p are the solution then, and unspecified otherwise
bool solve_at_length(RodProblem& problem, Vector& x, Vector& p, int link, double length);

/// The state in which a link has no length, p(0) with it: extrapolated, for there the link has no equations of its own. So a
/// line that carries no pressure over its length begins, and so touches of strands pass the edges of lines, or each other.
struct Vanishing {
  double p, precision;
  Vector x;
  /// The state with the shortest length that it is extrapolated from, and by how much the extrapolated one may be off.
  double nearest_p;
  Vector nearest_x;
  double uncertain;
};
/// @param shortest  length that it is extrapolated from, of four that double
std::optional<Vanishing> where_length_vanishes(RodProblem& problem, Vector x, Vector p, int link,
                                               double shortest);

/// Length that a link beside a touch of strands is entered with, and given where it has none.
double entered_beside_strand(const RodProblem& problem);

/// An event's own state, in which a link beside a touch of strands has no length, is no start: gives it some, p(0) free.
/// @returns false where Newton fails
bool leave_event(RodProblem& problem, Vector& x, Vector& p);

/// Lets a straight link bow off its obstacle, which it does at its buckling load: solves, p(0) free, for a state with a
/// slight bow. A link that is straight solves the same equations at any load, so the bow is prescribed.
/// @returns whether Newton converged
bool enter_bowed(RodProblem& problem, Vector& x, Vector& p, int link);

}  // namespace windlass::equilibrium
