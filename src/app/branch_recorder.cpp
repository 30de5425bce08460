#include "app/branch_recorder.hpp"

#include <fmt/format.h>

#include <cstdio>

#include "app/commands.hpp"
#include "app/interrupt.hpp"
#include "windlass/equilibrium/record.hpp"

namespace windlass::app {

using continuation::Branch;
using continuation::Point;
using continuation::PointType;
using equilibrium::RodProblem;
using equilibrium::Solution;

namespace {

const char* type_name(PointType type) {
  return type == PointType::event ? "contact" : continuation::name(type);
}

bool special(const Point& point) {
  return point.type == PointType::fold || point.type == PointType::branch_point ||
         point.type == PointType::event;
}

}  // namespace

BranchRecorder::BranchRecorder(output::RunWriter& writer, continuation::ProblemCodec codec, bool spectra,
                               bool quiet)
    : writer_(writer), codec_(std::move(codec)), spectra_(spectra), progress_(quiet) {
  const output::Timings& before = writer.info().timings;
  continuation_ = before.continuation, stability_ = before.stability, earlier_ = before.total;
  lost_ = static_cast<int>(writer.info().lost_branches.size());
  if (writer.rows().empty()) return;
  for (const output::BranchRow& row : writer.rows()) labels_.insert(row.label);
  points_ = static_cast<int>(writer.rows().size());
  last_ = writer.rows().back();
  in_branch_ = last_.point;
  progress_.note(
      fmt::format("goes on after branch {}, point {} ({} points)", last_.branch, last_.point, points_));
}

void BranchRecorder::on_branch_start(const Branch&) { in_branch_ = 0; }

void BranchRecorder::add_eigenvalues(Solution& solution, const Point& point) {
  const auto begin = Clock::now();
  auto& problem = dynamic_cast<RodProblem&>(*point.problem);
  equilibrium::Stability stability;
  if (spectra_ || special(point)) {
    try {
      stability = stability::analyse(problem, point.x, point.p, 1, special(point), solver_);
    } catch (
        const std::exception&) {  // at a singular point the spectrum may be out of reach; the index is not
    }
  }
  stability.index = stability.inertia_index = problem.total_index(point.x, point.p);
  solution.stability = stability;
  const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
  solution.seconds_stability = seconds;
  stability_ += seconds;
}

void BranchRecorder::on_point(const Branch& branch, const Point& point) {
  pause();
  auto& problem = dynamic_cast<RodProblem&>(*point.problem);
  try {
    Solution solution = equilibrium::record(problem, point.x, point.p);
    solution.newton_iterations = point.newton_iterations;
    solution.model_reason = "a point of a branch";
    if (point.index >= 0) add_eigenvalues(solution, point);
    // A branch that arrives at a known special point carries its label again; the first one keeps it.
    const std::string label = special(point) && labels_.insert(point.label).second ? point.label : "";
    last_ = output::make_row(solution, branch.id + 1, ++in_branch_, label, type_name(point.type), point.ds);
    if (!writer_.info().extra_parameter.empty()) last_.parameter = point.p(0);
    writer_.add_point(last_, solution);
    ++points_;
    if (progress_.due())
      progress_.update(fmt::format("branch {}  point {}  T = {:.6g}  phi = {:.6g}  index {}", branch.id + 1,
                                   in_branch_, solution.T, solution.phi, point.index));
  } catch (const std::domain_error&) {  // an event at the very edge of the domain: nothing to store
  }
  resumed_ = Clock::now();
}

void BranchRecorder::on_special_point(const Branch& branch, const Point& point) {
  pause();
  output::SpecialPoint entry;
  entry.label = point.label;
  entry.type = type_name(point.type);
  entry.branch = branch.id + 1;
  entry.T = last_.T;
  entry.phi = last_.phi;
  entry.parameter = last_.parameter;
  entry.precision = point.precision;
  entry.multiplicity = std::max(1, point.multiplicity);
  entry.before = point.before;
  entry.after = point.after;
  if (point.type == PointType::branch_point) {
    auto& problem = dynamic_cast<RodProblem&>(*point.problem);
    equilibrium::Mode mode;
    if (point.branch_point && point.branch_point->polished && point.branch_point->null.right.cols() > 0) {
      mode = stability::mode_of(problem, point.x, point.p, point.branch_point->null.right.col(0),
                                contact::Parity::even);
    } else {
      // Not a zero of the half chain's equations: an odd mode, which only the full chain can follow.
      try {
        mode = stability::analyse(problem, point.x, point.p, 1, true, solver_).modes.front();
      } catch (const std::exception&) {
        mode.plane = "out", mode.parity = "odd";
      }
    }
    entry.mode = output::SpecialMode{mode.plane, mode.parity};
  }
  writer_.add_special_point(entry);
  progress_.note(fmt::format(
      "{:<4} {:<12} T = {:.10g}  phi = {:.10g}  precision {:.1e}{}{}", entry.label, entry.type, entry.T,
      entry.phi, entry.precision,
      entry.mode ? (entry.mode->plane == "in" ? "  in plane, " : "  out of plane, ") + entry.mode->parity
                 : "",
      entry.after.empty() ? "" : "  " + entry.before + " -> " + entry.after));
  resumed_ = Clock::now();
}

void BranchRecorder::on_branch_end(const Branch& branch) {
  pause();
  if (branch.end.lost()) {
    ++lost_;
    writer_.add_lost_branch({branch.id + 1, branch.origin.empty() ? "start" : branch.origin, last_.T,
                             last_.phi, branch.end.reason});
  }
  progress_.note(fmt::format("branch {}: {} points, {}", branch.id + 1, branch.points, branch.end.reason));
  resumed_ = Clock::now();
}

bool BranchRecorder::should_stop() {
  stopped_ = stopped_ || interrupted_by_user();
  return stopped_;
}

void BranchRecorder::on_rest(const continuation::DiagramState& state) {
  if (!stopped_ && !writer_.checkpoint_due()) return;
  pause();
  writer_.info().timings = timings();
  writer_.checkpoint(continuation::encode(state, codec_));
  resumed_ = Clock::now();
}

output::Timings BranchRecorder::timings() const {
  const double now = std::chrono::duration<double>(Clock::now() - begin_).count();
  return {points_, continuation_, stability_, earlier_ + now};
}

int BranchRecorder::finish(const std::vector<std::string>& lost, bool quiet, bool json) {
  pause();
  progress_.finish();
  nlohmann::ordered_json summary;
  summary["points"] = points_;
  summary["special_points"] = writer_.special_points().size();
  summary["lost"] = lost;
  const bool incomplete = !lost.empty() || lost_ > 0;
  writer_.finish(stopped_ ? "interrupted" : incomplete ? "incomplete" : "finished", timings(), summary);
  if (json) {
    nlohmann::ordered_json out = output::to_json(writer_.info());
    for (const auto& special : writer_.special_points())
      out["special_points"].push_back(output::to_json(special));
    std::printf("%s\n", out.dump(2).c_str());
  } else if (!quiet) {
    std::printf("%d points, %zu special points, %.3f ms a point (spectra %.3f ms a point more) -> %s\n",
                points_, writer_.special_points().size(), 1e3 * continuation_ / std::max(1, points_),
                1e3 * stability_ / std::max(1, points_), writer_.folder().string().c_str());
    for (const std::string& reason : lost) std::printf("lost: %s\n", reason.c_str());
  }
  return stopped_ ? interrupted : incomplete ? not_finished : done;
}

}  // namespace windlass::app
