#include <stdexcept>

#include "app/commands.hpp"

namespace windlass::app {

int run_report(const RunRequest&) { throw std::runtime_error("report: not available in this version"); }

}  // namespace windlass::app
