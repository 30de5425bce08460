#include <stdexcept>

#include "app/commands.hpp"

namespace windlass::app {

int run_plot(const RunRequest&) { throw std::runtime_error("plot: not available in this version"); }

}  // namespace windlass::app
