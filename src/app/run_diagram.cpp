#include "app/branch_recorder.hpp"
#include "app/branch_setup.hpp"
#include "windlass/petsc/session.hpp"

namespace windlass::app {

int run_diagram(const BranchRequest& request) {
  petsc::ensure_session();
  const BranchSetup setup = set_up_branch(request);
  output::RunWriter writer = open_run(request, "diagram");
  BranchRecorder recorder(writer, false, request.common.quiet);
  recorder.start_clock();
  const continuation::Diagram diagram =
      continuation::trace_diagram(setup.start.problem, setup.start.x, setup.start.p, setup.options,
                                  continuation::DiagramOptions{}, recorder);
  return recorder.finish(diagram.lost, request.common.quiet, request.common.json);
}

}  // namespace windlass::app
