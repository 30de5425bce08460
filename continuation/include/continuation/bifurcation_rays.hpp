#pragma once

#include <vector>

#include "continuation/reduced.hpp"
#include "continuation/tangent.hpp"

namespace continuation {

/// Directions of all arms that leave a double branch point, from its bifurcation equations y(λ, α) = 0, α ∈ R².
///
/// To leading order y = μ b + g on the circle α = ε (cos θ, sin θ), with μ = λ − λ₀, b = y_λ and g = y at λ₀: there is an
/// arm where g is parallel to b, and μ = −(b·g)/(b·b). The zeros of det(b, g) on the circle are shut in between samples
/// and located, so that no symmetry need be known. Each ray is one direction; its opposite, if it is one, comes by itself.
///
/// @return empty where g is parallel to b all around: the arms form a surface (a rotation acts), no direction is special
std::vector<Tangent> bifurcation_rays(Problem& problem, const Options& options, const Vector& x,
                                      const Vector& p);

}  // namespace continuation
