#pragma once

#include "continuation/bordered_newton.hpp"

namespace continuation {

/// Solves the bordered system from a guess: by the problem's own solver (Problem::newton) if it has one, by
/// ChordNewton otherwise. Every solve of the library goes through here.
CorrectorReport correct(Problem& problem, const Borders& borders, Iterate& iterate, const Options& options);

/// Is max |F(x, p)| within Options::residual_tolerance?
bool is_solution(Problem& problem, const Vector& x, const Vector& p, const Options& options);

}  // namespace continuation
