#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/command_line.hpp"
#include "windlass/robustness/cold_start.hpp"
#include "windlass/scene/scene.hpp"
#include "windlass/verify/certificate.hpp"

/// The commands: each file `NAME_command.cpp` declares its options to the command line and, once they are parsed and the
/// scene is read, calls the `run_NAME` below.
namespace windlass::app {

/// What the process tells the shell (CONTRACT.md).
enum ExitStatus : int {
  done = 0,
  bad_input = 1,
  not_finished = 2,  ///< the solver gave up; what it had is on disk
  certificate_failed = 3,
  interrupted = 130,
};

/// Options every command has.
struct CommonOptions {
  std::vector<std::string> set;    ///< KEY=VALUE, in the order given
  std::filesystem::path out;       ///< --out; empty: default_folder()
  bool force = false;              ///< replace an existing run
  bool json = false;               ///< summary as one JSON object on stdout, nothing else there
  bool quiet = false;              ///< no progress, no summary text
  std::vector<std::string> petsc;  ///< after `--`; already given to petsc::set_options
};

struct SolveRequest {
  CommonOptions common;
  scene::Scene scene;
  bool save = false;  ///< --out was given: keep a run folder of one point
};

/// `continue` and `diagram`: from a scene, or from a stored point of a run.
struct BranchRequest {
  CommonOptions common;
  scene::Scene scene;                        ///< of the run, with overrides, when it restarts
  std::optional<std::filesystem::path> run;  ///< restart from here
  std::string label;                         ///< the stored point to restart from
  bool resume = false;                       ///< go on with the run in the output folder
  bool eigenvalues = true;           ///< the lowest eigenvalue of every point, not of special ones only
  std::optional<double> save_every;  ///< [s] between two checkpoints; empty: the writer's choice
};

struct LocusRequest {
  CommonOptions common;
  std::filesystem::path run;
  std::string label;
  scene::Scene scene;                 ///< of the run, with overrides
  std::string second = "load.angle";  ///< the second parameter
  std::optional<double> from, to;     ///< of the second parameter [dimensionless]
};

/// `fit`: the friction coefficient from measured strengths.
struct FitRequest {
  CommonOptions common;
  std::filesystem::path run, csv;
  std::string weights = "automatic";
  std::string min_tension;  ///< points below do not take part; a number or a quantity; empty: all do
  std::vector<std::string> formats = {"png", "svg", "pdf"};
};

struct FiguresRequest {
  CommonOptions common;
  std::vector<std::string> formats = {"png", "svg", "pdf"};
};

/// `stability`, `verify`, `plot`, `report`, `export`: what is done with a finished run.
struct RunRequest {
  CommonOptions common;
  std::filesystem::path run;
  std::string label;                                         ///< stability: one point; empty: all
  int eigenvalues = 6;                                       ///< stability: how many
  verify::Standard standard;                                 ///< verify: what is asked of a point
  std::vector<std::string> formats = {"png", "svg", "pdf"};  ///< plot
  std::filesystem::path csv;  ///< plot: measured points to lay over the diagram
};

struct RobustnessRequest {
  CommonOptions common;
  scene::Scene scene;
  robustness::Grid grid;
  bool grid_only = false;
};

/// `sweep`: the same for every combination of values of some scene keys.
struct SweepRequest {
  CommonOptions common;
  std::filesystem::path scene;
  std::vector<std::string> over;  ///< see parse_axis
  std::string each = "solve";     ///< what is done with a case: solve, continue, diagram
  bool resume = false;            ///< keep the cases finished already
};

/// `pull`: force against displacement, from rest to the plateau.
struct PullRequest {
  CommonOptions common;
  scene::Scene scene;
  std::vector<double> meshes;  ///< [ρ]; empty: chosen by the tension
  double to = 0.0;             ///< largest displacement [ρ]
  double step = 0.1;           ///< largest displacement a step [ρ]
  bool resume = false;
  std::vector<std::string> formats = {"png", "svg", "pdf"};
};

/// `precision`: which methods reach which error at what cost.
struct PrecisionRequest {
  CommonOptions common;
  scene::Scene scene;
  int repeats = 5;                      ///< solutions a measurement; the median counts
  bool quick = false;                   ///< short ladders
  std::vector<double> tensions, radii;  ///< states of the second opinion; empty: its own
};

// Bodies: one function a command, in run_NAME.cpp. They return an exit status; bad input is thrown.
int run_solve(const SolveRequest& request);
int run_continue(const BranchRequest& request);
int run_diagram(const BranchRequest& request);
int run_locus(const LocusRequest& request);
int run_stability(const RunRequest& request);
int run_verify(const RunRequest& request);
int run_plot(const RunRequest& request);
int run_report(const RunRequest& request);
int run_robustness(const RobustnessRequest& request);
int run_fit(const FitRequest& request);
int run_export(const RunRequest& request);
int run_figures(const FiguresRequest& request);
int run_sweep(const SweepRequest& request);
int run_precision(const PrecisionRequest& request);
int run_pull(const PullRequest& request);

/// Declares a subcommand; its callback stores the exit status in `status`.
using AddCommand = void(CommandLine& app, CommonOptions& common, int& status);
AddCommand add_solve, add_continue, add_diagram, add_locus, add_stability, add_verify, add_plot, add_report,
    add_fit, add_figures, add_export, add_sweep, add_pull, add_robustness, add_precision, add_scenes,
    add_manual, add_completion;

// ---- shared by the command files -------------------------------------------------------------------------------

/// Adds --set, --out, --force, --json, --quiet to a subcommand.
void add_common_options(Command& command, CommonOptions& common);

/// Adds --format to a command that draws.
void add_format_option(Command& command, std::vector<std::string>& formats);

/// `runs/SCENE-NAME` unless --out says otherwise.
std::filesystem::path output_folder(const CommonOptions& common, const scene::Scene& scene);

/// Where the shipped scenes stand.
std::filesystem::path scenes_folder();

/// The scene as resolved in a run folder, with the overrides applied. @throws scene::SceneError
/// @param restart  a branch begins at a stored point of the run
scene::Scene scene_of_run(const std::filesystem::path& run, const CommonOptions& common,
                          bool restart = false);

}  // namespace windlass::app
