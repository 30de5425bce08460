#include <stdexcept>

#include "app/commands.hpp"

namespace windlass::app {

int run_solve(const SolveRequest&) { throw std::runtime_error("solve: not available in this version"); }

}  // namespace windlass::app
