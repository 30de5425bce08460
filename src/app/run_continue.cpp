#include <stdexcept>

#include "app/commands.hpp"

namespace windlass::app {

int run_continue(const BranchRequest&) {
  throw std::runtime_error("continue: not available in this version");
}

}  // namespace windlass::app
