#include <stdexcept>

#include "app/commands.hpp"

namespace windlass::app {

int run_verify(const RunRequest&) { throw std::runtime_error("verify: not available in this version"); }

}  // namespace windlass::app
