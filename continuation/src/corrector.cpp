#include "continuation/corrector.hpp"

namespace continuation {

CorrectorReport correct(Problem& problem, const Borders& borders, Iterate& iterate, const Options& options) {
  if (BorderedNewton* newton = problem.newton()) return newton->solve(problem, borders, iterate, options);
  return ChordNewton().solve(problem, borders, iterate, options);
}

bool is_solution(Problem& problem, const Vector& x, const Vector& p, const Options& options) {
  const Vector residual = problem.residual(x, p);
  return residual.size() == 0 ||
         residual.lpNorm<Eigen::Infinity>() <= options.residual_tolerance * options.residual_scale;
}

}  // namespace continuation
