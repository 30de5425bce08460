#include "app/branch_run.hpp"

namespace windlass::app {

int run_continue(const BranchRequest& request) {
  continuation::DiagramOptions one_branch;
  one_branch.arms = false;
  return run_branches(request, "continue", one_branch);
}

}  // namespace windlass::app
