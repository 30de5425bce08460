#include <stdexcept>

#include "app/commands.hpp"

namespace windlass::app {

int run_locus(const LocusRequest&) { throw std::runtime_error("locus: not available in this version"); }

}  // namespace windlass::app
