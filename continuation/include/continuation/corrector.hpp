#pragma once

#include "continuation/bordered_newton.hpp"

namespace continuation {

/// Solves the bordered system from a guess: by the problem's own solver (Problem::newton) if it has one, by
/// ChordNewton otherwise. Every solve of the library goes through here.
CorrectorReport correct(Problem& problem, const Borders& borders, Iterate& iterate, const Options& options);

}  // namespace continuation
