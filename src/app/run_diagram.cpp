#include <stdexcept>

#include "app/commands.hpp"

namespace windlass::app {

int run_diagram(const BranchRequest&) { throw std::runtime_error("diagram: not available in this version"); }

}  // namespace windlass::app
