#pragma once

#include <Eigen/Dense>

/// What may map a rod to itself with its halves exchanged, r(−s) = S r(s): of such a state half a chain is enough.
namespace windlass::contact {

enum class Symmetry {
  half_turn,  ///< about e_y, S = diag(−1, 1, −1): flat and helical rods without plates
  mirror      ///< in the plane x = 0, S = diag(−1, 1, 1): a cylinder that drags along e_z keeps it
};

/// Diagonal of S. Tangents and internal forces: t(−s) = −S t(s), n(−s) = −S n(s), for both change sign with the direction of s.
inline Eigen::Vector3d image(Symmetry symmetry) {
  return {-1.0, 1.0, symmetry == Symmetry::half_turn ? -1.0 : 1.0};
}

/// Diagonal of −det(S) S, which maps internal moments, axial vectors: m(−s) = −det(S) S m(s).
inline Eigen::Vector3d image_of_moment(Symmetry symmetry) {
  return symmetry == Symmetry::half_turn ? Eigen::Vector3d(-image(symmetry)) : image(symmetry);
}

/// Does it map a shift along e_z, a turn about e_x, and a spin of all sections about their tangents to their opposites? A shift
/// of the rod along itself is, by either.
inline bool reverses_height(Symmetry symmetry) { return symmetry == Symmetry::half_turn; }

}  // namespace windlass::contact
