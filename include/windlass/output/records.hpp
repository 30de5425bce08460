#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "windlass/equilibrium/solution.hpp"

/// The small value types of a run folder: rows of branches.csv, special points, lost branches, run.json.
///
/// All numbers are dimensionless (PHYSICS: ρ = 1, EI = 1). A number that does not exist for a point is NaN
/// here and becomes an empty CSV cell or a JSON null on disk: no file ever holds NaN or inf.
namespace windlass::output {

/// One continuation point, a row of branches.csv.
struct BranchRow {
  int branch = 0;                       ///< branch number, from 1
  int point = 0;                        ///< number within the branch, from 1
  std::string label;                    ///< e.g. "BP1"; empty for an ordinary point
  std::string type;                     ///< "start", "regular", "fold", "branch_point", "contact", "end"
  double T = 0.0;                       ///< tension [EI/ρ²]
  double phi = 0.0;                     ///< capstan angle [rad]
  double R_tot = 0.0;                   ///< [EI/ρ²]; cylinder scenes
  double phi_star = 0.0;                ///< [rad]; cylinder scenes
  double end_force = 0.0;               ///< thrust positive; struts
  double end_moment = 0.0;              ///< struts
  double shortening = 0.0;              ///< end shortening / length; struts
  double tilt = 0.0;                    ///< [rad]
  double z_span = 0.0;                  ///< [ρ]
  double energy = 0.0;                  ///< [EI/ρ]
  std::optional<double> self_distance;  ///< closest approach of the rod to itself [ρ], where there is one
  double self_force = 0.0;              ///< sum of the sizes of the forces between strands [EI/ρ²]
  double plate_force = 0.0;             ///< capstan: of the plate on the rod [EI/ρ²]
  std::optional<double> F0;             ///< capstan with a friction coefficient [EI/ρ²]
  std::optional<double> travel;  ///< while the cylinder slips: ω, or with ends.travel = "blocked" τ [EI/ρ²]
  std::optional<int> index;      ///< number of negative eigenvalues, where computed
  std::optional<double> eigenvalue_1;  ///< lowest eigenvalue, where computed
  double ds = 0.0;                     ///< continuation step that led here
  int newton_iterations = 0;
  double error_estimate = 0.0;      ///< relative
  std::string topology;             ///< e.g. "tail edge line edge tail"
  std::optional<double> parameter;  ///< value of RunOptions::extra_parameter, where there is one
};

/// Of 2 rod.radius: strands that touch keep that distance, of rods as slender as r = 0.01 ρ too; see carried_between_strands.
inline constexpr double touching = 1.0 - 1e-7;

/// Row of a solution: everything the solution knows; branch, point, label, type and ds are the caller's.
BranchRow make_row(const equilibrium::Solution& solution, int branch, int point, std::string label,
                   std::string type, double ds);

/// Name of a point on disk and on the command line: its label, or "BRANCH-POINT" such as "2-17".
std::string point_name(int branch, int point, const std::string& label);

struct SpecialMode {
  std::string plane;   ///< "in" | "out"
  std::string parity;  ///< "even" | "odd"
};

/// A fold, branch point or contact event, an entry of special_points.json.
struct SpecialPoint {
  std::string label;
  std::string type;  ///< "fold" | "branch_point" | "contact"
  int branch = 0;
  double T = 0.0;
  double phi = 0.0;
  double precision = 0.0;  ///< half width of the interval the parameter is known to lie in
  int multiplicity = 1;    ///< dimension of the kernel
  std::optional<SpecialMode> mode;
  std::string before;               ///< contact: topology on the side the branch came from
  std::string after;                ///< contact: topology on the other side
  std::optional<double> parameter;  ///< value of the continuation parameter, RunInfo::parameter
};

/// A branch that could not be followed to where it was asked to go.
struct LostBranch {
  int branch = 0;
  std::string from;  ///< label of the special point it leaves, or "start"
  double T = 0.0;    ///< where it was lost
  double phi = 0.0;
  std::string reason;
  std::optional<double> parameter;  ///< of the continuation, where it was lost
};

/// Content of a file as it may stand on disk: its first `bytes` bytes and their checksum.
struct Stamp {
  std::size_t bytes = 0;
  std::string checksum;
};

/// In-process seconds, measured by the caller.
struct Timings {
  int points = 0;             ///< number of computed points
  double continuation = 0.0;  ///< [s]
  double stability = 0.0;     ///< [s]
  double total = 0.0;         ///< [s]
};

/// Content of run.json.
struct RunInfo {
  std::string version;
  std::string command;  ///< "solve", "continue", "diagram", ...
  std::string scene;    ///< scene name
  bool has_cylinder = true;
  std::string parameter;           ///< dotted key the branches are followed in; empty: none
  std::string extra_parameter;     ///< dotted key of an extra CSV column, or empty
  std::string status = "running";  ///< "running" | "finished" | "interrupted" | "incomplete"
  nlohmann::ordered_json options = nlohmann::ordered_json::object();
  nlohmann::ordered_json machine = nlohmann::ordered_json::object();
  nlohmann::ordered_json summary = nlohmann::ordered_json::object();
  std::vector<LostBranch> lost_branches;
  Timings timings;
  /// Of the other files. Two where a file is being replaced: it holds the one or the other.
  std::map<std::string, std::vector<Stamp>> stamps;
};

/// Processor, number of cores, operating system and compiler of this process.
nlohmann::ordered_json describe_machine();

nlohmann::ordered_json to_json(const SpecialPoint& point);
nlohmann::ordered_json to_json(const LostBranch& lost);
nlohmann::ordered_json to_json(const RunInfo& info);
/// The text of run.json: with the stamps, and its own checksum.
std::string info_text(const RunInfo& info);

/// Inverses of to_json. @throws nlohmann::json::exception for a missing or mistyped key
SpecialPoint special_point_from_json(const nlohmann::ordered_json& json);
LostBranch lost_branch_from_json(const nlohmann::ordered_json& json);
RunInfo run_info_from_json(const nlohmann::ordered_json& json);
/// Does run.json have the checksum of its content?
bool has_right_checksum(nlohmann::ordered_json info);

/// A finite number, or null. JSON knows neither NaN nor infinity.
nlohmann::ordered_json finite_or_null(double value);

}  // namespace windlass::output
