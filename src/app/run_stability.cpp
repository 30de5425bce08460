#include <stdexcept>

#include "app/commands.hpp"

namespace windlass::app {

int run_stability(const RunRequest&) { throw std::runtime_error("stability: not available in this version"); }

}  // namespace windlass::app
