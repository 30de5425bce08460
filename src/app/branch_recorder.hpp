#pragma once

#include <chrono>
#include <cmath>
#include <continuation/checkpoint.hpp>
#include <set>

#include "app/progress.hpp"
#include "windlass/output/run_folder.hpp"
#include "windlass/stability/analysis.hpp"

namespace windlass::app {

/// Writes a growing diagram into its run folder, point by point, and keeps the clock: time spent computing branches and
/// time spent on spectra are told apart from time spent writing.
class BranchRecorder final : public continuation::DiagramObserver {
 public:
  /// Goes on with what the writer holds already.
  /// @param codec    of the problems on the branches
  /// @param spectra  the lowest eigenvalue at every point; special points get theirs, and its mode, always
  BranchRecorder(output::RunWriter& writer, continuation::ProblemCodec codec, const scene::Scene& scene,
                 bool spectra, bool quiet);

  void on_branch_start(const continuation::Branch& branch) override;
  void on_way_back(const continuation::Point& point) override;
  void on_point(const continuation::Branch& branch, const continuation::Point& point) override;
  void on_special_point(const continuation::Branch& branch, const continuation::Point& point) override;
  void on_branch_end(const continuation::Branch& branch) override;
  bool should_stop() override;
  void on_rest(const continuation::DiagramState& state) override;

  /// Starts the clock of the computation; call it right before the walk.
  void start_clock() { resumed_ = Clock::now(); }
  /// Final commit. @return exit status
  int finish(const continuation::Diagram& diagram, bool quiet, bool json);

 private:
  using Clock = std::chrono::steady_clock;
  void pause() { continuation_ += std::chrono::duration<double>(Clock::now() - resumed_).count(); }
  output::Timings timings() const;
  void add_eigenvalues(equilibrium::Solution& solution, const continuation::Point& point);
  /// Counts what the summary has to warn of.
  void judge(const output::BranchRow& row);
  /// What the user should know of the points, a sentence each.
  std::vector<std::string> warnings() const;

  output::RunWriter& writer_;
  continuation::ProblemCodec codec_;
  double tolerance_;  ///< asked of every point
  double radius_;     ///< of the rod; 0: not given
  bool spectra_;
  Progress progress_;
  stability::SpectrumSolver solver_;
  Clock::time_point begin_ = Clock::now(), resumed_ = Clock::now();
  double continuation_ = 0.0, stability_ = 0.0,
         earlier_ = 0.0;  ///< earlier_: total of the run before it was resumed
  int points_ = 0, in_branch_ = 0, lost_ = 0;
  bool stopped_ = false;
  int imprecise_ = 0;          ///< points whose error estimate exceeds the tolerance
  double worst_error_ = 0.0;   ///< of them
  int too_close_ = 0;          ///< points at which the rod is nearer to itself than two radii
  double closest_ = INFINITY;  ///< of them
  double at_ = 0.0;            ///< the parameter at the last point
  std::set<std::string> labels_;
  int kernel_ = 0;  ///< zero eigenvalues at the last branch point
  output::BranchRow last_;
};

}  // namespace windlass::app
