#pragma once

#include <Eigen/Core>

namespace windlass::chain {

/// Contact of the rod with itself: two joints, or a joint and the half-turn's image of one, its own too.
///
/// With D = r_first − Q r_second (Q: the half-turn about e_y, or the identity), e = D/|D| and the rod's radius r the two
/// strands keep |D| = 2r, and λ e pushes the first, −λ Qᵀe the second. In the Lagrangian it is the term −w λ (|D| − 2r) with
/// one multiplier λ. A half chain has half the energy: the two contacts of a pair of joints, images of each other, leave
/// w = 1, the one of a joint with its own image w = ½.
///
/// One equation more, |D| = 2r, for one unknown more; tangency, e·t = 0 at either joint, locates both along the rod.
///
/// **A line between strands** that lie on an obstacle is touches so near each other that between them the strands are nowhere
/// nearer than `carried_between_strands` allows (PHYSICS, "Lines between turns"). Its ends are located by tangency; those
/// inside divide what is between two joints on the first strand that locate themselves, tangency locates the second's places; where a
/// strand touches its own
/// image tangency does it all.
///
/// **Two couplings at one place.** Where another contact presses on a strand of a line, or another line runs along it, what goes
/// on to the second strand does so right there. The same section of the rod then is two joints, each with its coupling and the
/// same unknowns, with a link of no length between them (`Link::weld`); one of the two couplings locates it.
struct Coupling {
  int first = 0, second = 0;  ///< joints
  bool mirrored = false;
  bool along = false;        ///< of a line: moving it costs nothing
  bool placed = false;       ///< the first joint is where another coupling has one, which locates it
  int begin = -1, end = -1;  ///< inside a line: the joints about it that locate themselves
  double part = 0.0;         ///< where between them
  bool with_itself() const { return first == second; }
  double weight() const { return with_itself() ? 0.5 : 1.0; }
  Eigen::Vector3d image() const {  ///< diagonal of Q
    return mirrored ? Eigen::Vector3d(-1.0, 1.0, -1.0) : Eigen::Vector3d::Ones();
  }
  bool operator==(const Coupling& other) const = default;
};

}  // namespace windlass::chain
