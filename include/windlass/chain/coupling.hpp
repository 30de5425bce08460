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
struct Coupling {
  int first = 0, second = 0;  ///< joints
  bool mirrored = false;
  bool with_itself() const { return first == second; }
  double weight() const { return with_itself() ? 0.5 : 1.0; }
  Eigen::Vector3d image() const {  ///< diagonal of Q
    return mirrored ? Eigen::Vector3d(-1.0, 1.0, -1.0) : Eigen::Vector3d::Ones();
  }
  bool operator==(const Coupling& other) const = default;
};

}  // namespace windlass::chain
