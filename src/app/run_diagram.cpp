#include "app/branch_run.hpp"

namespace windlass::app {

int run_diagram(const BranchRequest& request) { return run_branches(request, "diagram", {}); }

}  // namespace windlass::app
