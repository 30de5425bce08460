#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "continuation/bracket.hpp"
#include "continuation/branch_point.hpp"
#include "continuation/point.hpp"
#include "continuation/segment.hpp"

namespace continuation {

/// A special point located on a segment.
struct Located {
  PointType type = PointType::fold;
  double s = 0.0;                    ///< path length on the segment
  Sample sample;                     ///< the solution there
  std::shared_ptr<Problem> problem;  ///< the sample's, where it is not the segment's
  double lo = 0.0, hi = 0.0;         ///< bracket in path length
  double precision = 0.0;            ///< in the varied parameter
  int index = -1, index_after = -1;
  std::size_t which = 0;  ///< event: its place in events()
  std::string event;
  int multiplicity = 0;
  std::optional<BranchPoint> branch_point;  ///< where the reduced equations could be solved
  std::string note;
};

/// Does the parameter stay where it is between two completed samples, to within rounding? A motion that costs nothing makes
/// such a branch; all its points are degenerate, none is a fold.
bool is_vertical(const Segment& segment, const Sample& lo, const Sample& hi);

/// The zero of the tangent's parameter component between two completed samples where it has opposite signs.
Located locate_fold(Segment& segment, const Sample& lo, const Sample& hi);

/// Is this zero a jump of the slope? The corrector then found different branches on its two sides.
bool slope_jumps(const Sample& lo, const Sample& hi, const Located& fold);

/// Takes the error that Newton's tolerance left out of a fold, and says in its precision how large it was.
/// @throws std::runtime_error, std::domain_error as the problem does
void sharpen_fold(Segment& segment, Located& fold);

/// Signs of the events along a branch, by name. An event without an entry counts as positive.
using EventSigns = std::map<std::string, int>;
int sign_of(const EventSigns& signs, const std::string& name);

/// The first zero of any event between the segment's base and the sample `hi` (both with events). An event
/// whose value at the base has already the wrong sign (within roundoff of zero) is located at the base.
/// @return nullopt when no event changes sign. `note` is not empty if the bracket did not converge.
std::optional<Located> locate_first_event(Segment& segment, const Sample& hi, const EventSigns& signs);

/// The zero of a user function between two samples where it has opposite signs; nullopt where it has not.
std::optional<Located> locate_function(Segment& segment, const UserFunction& function, const Sample& lo,
                                       const Sample& hi);

/// What the index says of a step.
struct Crossings {
  std::vector<Located> points;  ///< branch points and Hopf points, not sorted
  bool fold = false;            ///< the turn of the parameter is a fold
  std::string refusal;          ///< the index changes where no branch point is: the step has left its branch
};

/// Branch points, Hopf points and the nature of a turn between two completed samples.
///
/// An interval over which the index changes (det J where it is unknown) is halved until the reduced equations find the
/// point in it. A turn of the parameter is a fold if the index changes by an odd number across it. Where several
/// eigenvalues change sign but J stays regular, a complex pair became real or the reverse.
///
/// @param turn  where dp/ds vanishes, or null
/// @param edge  path length of an event: the index close to it may change for reasons of its own
/// @param may_refuse  the step is long: an index that changes without a branch point is a jump to another branch
Crossings locate_crossings(Segment& segment, const Sample& lo, const Sample& hi, const Located* turn,
                           double edge, bool may_refuse);

/// All branch points between two completed samples between which the parameter does not turn.
/// @returns nullopt where counts change from sample to sample by rounding, however near these are
std::optional<std::vector<Located>> locate_branch_points(Segment& segment, const Sample& lo,
                                                         const Sample& hi);

/// A branch point that is known by its bracket only; why: what kept it from being located, empty: the segment's failure.
Located unpolished(Segment& segment, const Sample& lo, const Sample& hi, int multiplicity,
                   const std::string& why);

/// The branch points between two completed samples whose kernel breaks the symmetry the segment's problem is
/// restricted to: its own equations are regular there. The interval is halved on the change of the breaking
/// index; in it the unrestricted problem follows the same branch, and the point is located there, where it is
/// an ordinary branch point with its arms. One that comes in together with a point of `restricted`, which
/// locate_branch_points found there, is left to that point.
std::vector<Located> locate_symmetry_breaking(Segment& segment, const Sample& lo, const Sample& hi,
                                              const std::vector<Located>& restricted);

}  // namespace continuation
