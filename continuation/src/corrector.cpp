#include "continuation/corrector.hpp"

namespace continuation {

CorrectorReport correct(Problem& problem, const Borders& borders, Iterate& iterate, const Options& options) {
  if (BorderedNewton* newton = problem.newton()) return newton->solve(problem, borders, iterate, options);
  return ChordNewton().solve(problem, borders, iterate, options);
}

}  // namespace continuation
