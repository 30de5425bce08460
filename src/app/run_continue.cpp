#include "app/branch_recorder.hpp"
#include "app/branch_setup.hpp"
#include "windlass/petsc/session.hpp"

namespace windlass::app {

int run_continue(const BranchRequest& request) {
  petsc::ensure_session();
  const BranchSetup setup = set_up_branch(request);
  output::RunWriter writer = open_run(request, "continue");
  BranchRecorder recorder(writer, false, request.common.quiet);
  continuation::Branch branch;
  recorder.start_clock();
  continuation::Walker walker(setup.start.problem, setup.start.x, setup.start.p, setup.options);
  recorder.on_branch_start(branch);
  while (const auto point = walker.step()) {
    ++branch.points;
    recorder.on_point(branch, *point);
    using continuation::PointType;
    if (point->type == PointType::fold || point->type == PointType::branch_point ||
        point->type == PointType::event)
      recorder.on_special_point(branch, *point);
    if (recorder.should_stop()) walker.stop("interrupted");
  }
  branch.end = walker.end();
  recorder.on_branch_end(branch);
  std::vector<std::string> lost;
  if (walker.end().lost()) lost.push_back(walker.end().reason);
  return recorder.finish(lost, request.common.quiet, request.common.json);
}

}  // namespace windlass::app
