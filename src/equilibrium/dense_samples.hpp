#pragma once

#include "windlass/chain/profile.hpp"

/// Quantities along an arc between its samples, on the polynomials of its elements.
namespace windlass::equilibrium {

struct Least {
  double value, s;
};

/// Least value of a sampled quantity between lo and hi, on the polynomials of the elements to the two sides of s, where it is
/// `value`: an event located by samples would move with the mesh.
Least least_near(const chain::Piece& piece, const Eigen::VectorXd& values, double s, double value, double lo,
                 double hi);

/// Extent of a shape in z, from where its tangent is level to where it is again: by samples alone it would be that of a mesh.
double extent_in_z(const chain::Profile& shape);

/// First sample of the element that s lies in; of two that meet there the first.
Eigen::Index element_at(const chain::Piece& piece, double s);

/// A quantity along an arc, dense enough that no dip and no rise of its polynomials is missed.
struct Dense {
  Eigen::VectorXd s, value;
};

Dense dense_samples(const chain::Piece& piece, const Eigen::VectorXd& values);

}  // namespace windlass::equilibrium
