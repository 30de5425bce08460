#include "app/branch_recorder.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "app/commands.hpp"
#include "app/interrupt.hpp"
#include "windlass/equilibrium/event_precision.hpp"
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

/// Where a point lies, for people: the loads of a capstan, what a strut carries.
std::string place(const output::BranchRow& row) {
  if (row.phi > 0.0) return fmt::format("T = {:.10g}  phi = {:.10g}", row.T, row.phi);
  const std::string where =
      fmt::format("end_force = {:.10g}  shortening = {:.10g}", row.end_force, row.shortening);
  return row.end_moment == 0.0 ? where : where + fmt::format("  end_moment = {:.10g}", row.end_moment);
}

bool special(const Point& point) {
  return point.type == PointType::fold || point.type == PointType::branch_point ||
         point.type == PointType::event;
}

/// In natural units. Branch points that could only be bracketed are good to 1e-6 in the load.
constexpr double zero_eigenvalue = 1e-5;

/// Lowest eigenvalues that surely hold those that vanish at a branch point: they come after the negative ones of both
/// parities.
int zero_modes_wanted(const Point& point) { return 3 + 2 * std::max(0, point.index_after); }

}  // namespace

BranchRecorder::BranchRecorder(output::RunWriter& writer, continuation::ProblemCodec codec,
                               const scene::Scene& scene, bool spectra, bool quiet)
    : writer_(writer),
      codec_(std::move(codec)),
      tolerance_(scene.model.tolerance),
      radius_(scene.rod_radius),
      spectra_(spectra),
      progress_(quiet) {
  const output::Timings& before = writer.info().timings;
  continuation_ = before.continuation, stability_ = before.stability, earlier_ = before.total;
  lost_ = static_cast<int>(writer.info().lost_branches.size());
  if (writer.rows().empty()) return;
  for (const output::BranchRow& row : writer.rows()) labels_.insert(row.label), judge(row);
  points_ = static_cast<int>(writer.rows().size());
  last_ = writer.rows().back();
  in_branch_ = last_.point;
  progress_.note(
      fmt::format("goes on after branch {}, point {} ({} points)", last_.branch, last_.point, points_));
}

void BranchRecorder::judge(const output::BranchRow& row) {
  // A special point repeats the estimate of the point before.
  if (row.label.empty() && row.error_estimate > tolerance_) {
    ++imprecise_;
    worst_error_ = std::max(worst_error_, row.error_estimate);
  }
  // A branch may be followed in the radius itself.
  const double radius = writer_.info().parameter == "rod.radius" ? row.parameter.value_or(radius_) : radius_;
  if (row.self_distance && *row.self_distance < output::touching * 2.0 * radius) {
    ++too_close_;
    closest_ = std::min(closest_, *row.self_distance);
  }
}

std::vector<std::string> BranchRecorder::warnings() const {
  std::vector<std::string> list;
  if (imprecise_ > 0)
    list.push_back(
        fmt::format("model.tolerance = {:g} was not met at {} points: error estimates up to {:.1e}",
                    tolerance_, imprecise_, worst_error_));
  if (too_close_ > 0)
    list.push_back(fmt::format(
        "the rod passes through itself at {} points: self_distance down to {:.6g}, under 2 rod.radius{}",
        too_close_, closest_,
        writer_.info().parameter == "rod.radius" ? "" : fmt::format(" = {:.6g}", 2.0 * radius_)));
  return list;
}

void BranchRecorder::on_branch_start(const Branch&) { in_branch_ = 0; }

void BranchRecorder::on_way_back(const Point& point) {
  if (!progress_.due()) return;
  auto& problem = dynamic_cast<RodProblem&>(*point.problem);
  progress_.update(fmt::format("on the way to where it begins: {} = {:.6g}", writer_.info().parameter,
                               problem.as_given(point.p(0))));
}

void BranchRecorder::add_eigenvalues(Solution& solution, const Point& point) {
  const auto begin = Clock::now();
  auto& problem = dynamic_cast<RodProblem&>(*point.problem);
  equilibrium::Stability stability;
  bool told = !problem.dragged();
  kernel_ = 0;
  if (spectra_ || special(point) || problem.dragged()) {  // only a spectrum knows a dragged state's index
    try {
      // At a branch point the zero eigenvalues are counted: the kernel of the whole rod, of which a half chain sees the
      // even part.
      const int count = point.type == PointType::branch_point ? zero_modes_wanted(point) : 1;
      stability = stability::analyse(problem, point.x, point.p, count, special(point), solver_);
      told = true;
      const double zero = zero_eigenvalue * problem.units().force;
      kernel_ = static_cast<int>(std::count_if(stability.eigenvalues.begin(), stability.eigenvalues.end(),
                                               [zero](double mu) { return std::abs(mu) < zero; }));
      kernel_ = std::max(0, kernel_ - stability::neutral_modes(problem));
    } catch (
        const std::exception&) {  // at a singular point the spectrum may be out of reach; the index is not
    }
  }
  if (!problem.dragged()) stability.index = stability.inertia_index = problem.total_index(point.x, point.p);
  // A dragged state without a spectrum: the index of the branch's last point stands, as where a contact carries nothing.
  const bool follows = in_branch_ > 0 && last_.index;
  if (!told && follows) stability.index = stability.inertia_index = *last_.index, stability.degenerate = true;
  if (told || follows) solution.stability = stability;
  const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
  solution.seconds_stability = seconds;
  stability_ += seconds;
}

void BranchRecorder::on_point(const Branch& branch, const Point& point) {
  pause();
  auto& problem = dynamic_cast<RodProblem&>(*point.problem);
  try {
    // The walker has mostly asked for it already. At a special point Newton's step is not small: the estimate of the
    // point before, on the same mesh, stands.
    if (!special(point)) problem.error_estimate(point.x, point.p);
    Solution solution = equilibrium::record(problem, point.x, point.p);
    solution.newton_iterations = point.newton_iterations;
    solution.model_reason = "a point of a branch";
    if (point.index >= 0 || solution.dragged) add_eigenvalues(solution, point);
    // A branch that arrives at a known special point carries its label again; the first one keeps it.
    const std::string label = special(point) && labels_.insert(point.label).second ? point.label : "";
    last_ = output::make_row(solution, branch.id + 1, ++in_branch_, label, type_name(point.type), point.ds);
    if (!writer_.info().extra_parameter.empty()) last_.parameter = problem.as_given(point.p(0));
    at_ = problem.as_given(point.p(0));
    judge(last_);
    writer_.add_point(last_, solution);
    ++points_;
    if (progress_.due())
      progress_.update(fmt::format("branch {}  point {}  {}", branch.id + 1, in_branch_, place(last_)) +
                       (last_.index ? fmt::format("  index {}", *last_.index) : ""));
  } catch (const std::domain_error&) {  // an event at the very edge of the domain: nothing to store
  }
  resumed_ = Clock::now();
}

namespace {

/// What the mesh, and the touches that stand for lines, have moved a special point by, as far as it is known.
double share_of_mesh(const RodProblem& problem, const Point& point) {
  if (point.type != PointType::event)
    return equilibrium::singular_precision(problem, point.x, point.p, point.type, point.multiplicity)
        .value_or(0.0);
  return equilibrium::event_precision(problem, point.x, point.p, point.event).value_or(0.0) +
         equilibrium::layout_precision(problem, point.x, point.p, point.event).value_or(0.0);
}

}  // namespace

void BranchRecorder::on_special_point(const Branch& branch, const Point& point) {
  pause();
  output::SpecialPoint entry;
  entry.label = point.label;
  entry.type = type_name(point.type);
  entry.branch = branch.id + 1;
  const bool capstan = writer_.info().has_cylinder;  // a strut has neither tension nor angle
  entry.T = capstan ? last_.T : std::nan("");
  entry.phi = capstan ? last_.phi : std::nan("");
  auto& problem = dynamic_cast<RodProblem&>(*point.problem);
  entry.parameter = problem.as_given(point.p(0));
  entry.precision = problem.as_given(point.precision + share_of_mesh(problem, point));
  entry.multiplicity = std::max(
      1, point.type == PointType::branch_point ? std::max(point.multiplicity, kernel_) : point.multiplicity);
  entry.before = point.before;
  entry.after = point.after;
  if (point.type == PointType::branch_point) {
    const double zero = zero_eigenvalue * problem.units().force;
    equilibrium::Mode mode;
    if (point.branch_point && point.branch_point->polished && point.branch_point->null.right.cols() > 0) {
      mode = stability::mode_of(problem, point.x, point.p, point.branch_point->null.right.col(0),
                                contact::Parity::even);
    } else {
      mode.plane = "out", mode.parity = "odd";
      // A zero that was bracketed and not polished: the spectrum's mode nearest to zero, an even one first where several
      // vanish.
      try {
        const auto modes =
            stability::analyse(problem, point.x, point.p, zero_modes_wanted(point), true, solver_).modes;
        if (!modes.empty())  // of a dragged state none are drawn
          mode = *std::min_element(modes.begin(), modes.end(), [zero](const auto& a, const auto& b) {
            const auto rank = [zero](const equilibrium::Mode& m) {
              return std::abs(m.eigenvalue) > zero ? std::abs(m.eigenvalue) : m.parity == "even" ? -1.0 : 0.0;
            };
            return rank(a) < rank(b);
          });
      } catch (const std::domain_error&) {  // no spectrum right at the zero
      } catch (const std::runtime_error&) {
      }
    }
    entry.mode = output::SpecialMode{mode.plane, mode.parity};
  }
  writer_.add_special_point(entry);
  progress_.note(fmt::format(
      "{:<4} {:<12} {}  precision {:.1e}{}{}{}", entry.label, entry.type, place(last_), entry.precision,
      entry.multiplicity > 1 ? fmt::format("  multiplicity {}", entry.multiplicity) : "",
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
                             last_.phi, branch.end.reason, at_});
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

int BranchRecorder::finish(const continuation::Diagram& diagram, bool quiet, bool json) {
  pause();
  progress_.finish();
  nlohmann::ordered_json summary;
  std::vector<std::string> cut_short;
  summary["points"] = points_;
  summary["special_points"] = writer_.special_points().size();
  summary["lost"] = diagram.lost;
  summary["inadmissible"] = diagram.inadmissible;
  // Of the whole run: a resumed one did not see the ends of its first branches.
  for (const continuation::Branch& branch : diagram.branches)
    if (branch.end.kind == continuation::End::Kind::max_points)
      cut_short.push_back(fmt::format("branch {}: {}, before {} reached continuation.to", branch.id + 1,
                                      branch.end.reason, writer_.info().parameter));
  const std::vector<std::string> warned = warnings();
  summary["cut_short"] = cut_short;
  summary["warnings"] = warned;
  const bool incomplete = !diagram.lost.empty() || lost_ > 0 || !cut_short.empty();
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
    for (const std::string& arm : diagram.inadmissible) std::printf("no arm: %s\n", arm.c_str());
    for (const std::string& reason : diagram.lost) std::printf("lost: %s\n", reason.c_str());
    for (const std::string& end : cut_short) std::printf("cut short: %s\n", end.c_str());
  }
  for (const std::string& warning : warned) std::fprintf(stderr, "windlass: %s\n", warning.c_str());
  return stopped_ ? interrupted : incomplete ? not_finished : done;
}

}  // namespace windlass::app
