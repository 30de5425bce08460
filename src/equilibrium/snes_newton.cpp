#include "windlass/equilibrium/snes_newton.hpp"

#include <algorithm>
#include <memory>
#include <vector>

#include "snes_system.hpp"

namespace windlass::equilibrium {

using continuation::Borders;
using continuation::CorrectorReport;
using continuation::Iterate;
using continuation::Options;
using continuation::Problem;

namespace {

/// Systems by their last use. A process, not a problem, keeps them: a diagram's problems are many, their sizes few.
class Pool {
 public:
  /// One that is not in use.
  SnesSystem& of(Eigen::Index size) {
    auto fits = std::find_if(kept_.begin(), kept_.end(),
                             [&](const auto& system) { return system->size() == size && !system->busy(); });
    if (fits == kept_.end()) {
      if (kept_.size() >= most_kept) drop_oldest();
      kept_.push_back(std::make_unique<SnesSystem>(size));
      ++made_;
      fits = std::prev(kept_.end());
    }
    std::rotate(kept_.begin(), fits, std::next(fits));
    return *kept_.front();
  }
  /// After an error PETSc's objects may be locked in the middle of a solve.
  void drop(const SnesSystem& broken) {
    std::erase_if(kept_, [&](const auto& system) { return system.get() == &broken; });
  }
  int made() const { return made_; }

 private:
  void drop_oldest() {
    for (auto it = kept_.rbegin(); it != kept_.rend(); ++it)
      if (!(*it)->busy()) {
        kept_.erase(std::next(it).base());
        return;
      }
  }

  static constexpr std::size_t most_kept = 16;  // sizes of a branch's topologies, each on a few meshes
  std::vector<std::unique_ptr<SnesSystem>> kept_;
  int made_ = 0;
};

Pool& pool() {
  static Pool systems;
  return systems;
}

CorrectorReport solved(Problem& problem, const Borders& borders, Iterate& iterate, const Options& options,
                       const SnesNewton::Part* part) {
  SnesSystem& system = pool().of(problem.size() + borders.c.cols());
  try {
    return system.solve(problem, borders, iterate, options, part);
  } catch (...) {
    pool().drop(system);
    throw;
  }
}

}  // namespace

CorrectorReport SnesNewton::solve(Problem& problem, const Borders& borders, Iterate& iterate,
                                  const Options& options) {
  return solved(problem, borders, iterate, options, nullptr);
}

CorrectorReport SnesNewton::solve_from_guess(Problem& problem, const Borders& borders, Iterate& iterate,
                                             const Options& options, const Part& part) {
  return solved(problem, borders, iterate, options, &part);
}

int SnesNewton::made() { return pool().made(); }

}  // namespace windlass::equilibrium
