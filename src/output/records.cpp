#include "windlass/output/records.hpp"

#include <sys/utsname.h>

#include <cmath>
#include <fstream>
#include <thread>

#include "windlass/output/checksum.hpp"

namespace windlass::output {

using nlohmann::ordered_json;

BranchRow make_row(const equilibrium::Solution& solution, int branch, int point, std::string label,
                   std::string type, double ds) {
  BranchRow row;
  row.branch = branch;
  row.point = point;
  row.label = std::move(label);
  row.type = std::move(type);
  row.T = solution.T;
  row.phi = solution.phi;
  row.R_tot = solution.R_tot;
  row.phi_star = solution.phi_star;
  row.end_force = solution.end_force;
  row.end_moment = solution.end_moment;
  row.shortening = solution.shortening;
  row.tilt = solution.tilt;
  row.z_span = solution.z_span;
  row.energy = solution.energy;
  row.self_distance = solution.self_distance;
  row.self_force = solution.self_force;
  row.plate_force = solution.plate_force;
  row.F0 = solution.F0;
  if (solution.dragged)
    row.travel = solution.travel_rate != 0.0 ? solution.travel_rate : solution.pull_difference;
  if (solution.stability) {
    row.index = solution.stability->index;
    if (!solution.stability->eigenvalues.empty()) row.eigenvalue_1 = solution.stability->eigenvalues.front();
  }
  row.ds = ds;
  row.newton_iterations = solution.newton_iterations;
  row.error_estimate = solution.error_estimate;
  row.topology = solution.topology;
  return row;
}

std::string point_name(int branch, int point, const std::string& label) {
  return label.empty() ? std::to_string(branch) + "-" + std::to_string(point) : label;
}

ordered_json finite_or_null(double value) {
  return std::isfinite(value) ? ordered_json(value) : ordered_json(nullptr);
}

namespace {

double number_or_nan(const ordered_json& json, const char* key) {
  const ordered_json& value = json.at(key);
  return value.is_null() ? std::nan("") : value.get<double>();
}

std::optional<double> number_if_any(const ordered_json& json, const char* key) {
  const ordered_json& value = json.at(key);
  return value.is_null() ? std::nullopt : std::optional(value.get<double>());
}

/// First value of a `key : value` line of /proc/cpuinfo; empty where there is no such file.
std::string processor_name() {
  std::ifstream stream("/proc/cpuinfo");
  for (std::string line; std::getline(stream, line);) {
    if (!line.starts_with("model name")) continue;
    const auto colon = line.find(':');
    if (colon != std::string::npos && colon + 2 < line.size()) return line.substr(colon + 2);
  }
  return {};
}

}  // namespace

ordered_json describe_machine() {
  ordered_json machine;
  machine["processor"] = processor_name();
  machine["cores"] = std::thread::hardware_concurrency();
  utsname system{};
  if (uname(&system) == 0) {
    machine["system"] = std::string(system.sysname) + " " + system.release + " " + system.machine;
  }
#if defined(__VERSION__)
  machine["compiler"] = __VERSION__;
#endif
  return machine;
}

ordered_json to_json(const SpecialPoint& point) {
  ordered_json json;
  json["label"] = point.label;
  json["type"] = point.type;
  json["branch"] = point.branch;
  json["T"] = finite_or_null(point.T);
  json["phi"] = finite_or_null(point.phi);
  json["parameter"] = finite_or_null(point.parameter.value_or(std::nan("")));
  json["precision"] = finite_or_null(point.precision);
  json["multiplicity"] = point.multiplicity;
  json["mode"] = nullptr;
  if (point.mode) json["mode"] = ordered_json{{"plane", point.mode->plane}, {"parity", point.mode->parity}};
  json["before"] = point.before.empty() ? ordered_json(nullptr) : ordered_json(point.before);
  json["after"] = point.after.empty() ? ordered_json(nullptr) : ordered_json(point.after);
  return json;
}

SpecialPoint special_point_from_json(const ordered_json& json) {
  SpecialPoint point;
  point.label = json.at("label").get<std::string>();
  point.type = json.at("type").get<std::string>();
  point.branch = json.at("branch").get<int>();
  point.T = number_or_nan(json, "T");
  point.phi = number_or_nan(json, "phi");
  point.parameter = number_if_any(json, "parameter");
  point.precision = number_or_nan(json, "precision");
  point.multiplicity = json.at("multiplicity").get<int>();
  const ordered_json& mode = json.at("mode");
  if (!mode.is_null())
    point.mode = SpecialMode{mode.at("plane").get<std::string>(), mode.at("parity").get<std::string>()};
  if (!json.at("before").is_null()) point.before = json.at("before").get<std::string>();
  if (!json.at("after").is_null()) point.after = json.at("after").get<std::string>();
  return point;
}

ordered_json to_json(const LostBranch& lost) {
  return ordered_json{{"branch", lost.branch},
                      {"from", lost.from},
                      {"T", finite_or_null(lost.T)},
                      {"phi", finite_or_null(lost.phi)},
                      {"parameter", finite_or_null(lost.parameter.value_or(std::nan("")))},
                      {"reason", lost.reason}};
}

LostBranch lost_branch_from_json(const ordered_json& json) {
  return {
      json.at("branch").get<int>(), json.at("from").get<std::string>(),   number_or_nan(json, "T"),
      number_or_nan(json, "phi"),   json.at("reason").get<std::string>(), number_if_any(json, "parameter")};
}

ordered_json to_json(const RunInfo& info) {
  ordered_json json;
  json["program"] = "windlass";
  json["version"] = info.version;
  json["command"] = info.command;
  json["scene"] = info.scene;
  json["status"] = info.status;
  json["has_cylinder"] = info.has_cylinder;
  json["parameter"] = info.parameter.empty() ? ordered_json(nullptr) : ordered_json(info.parameter);
  json["extra_parameter"] =
      info.extra_parameter.empty() ? ordered_json(nullptr) : ordered_json(info.extra_parameter);
  json["options"] = info.options;
  json["machine"] = info.machine;
  json["summary"] = info.summary;
  json["lost_branches"] = ordered_json::array();
  for (const LostBranch& lost : info.lost_branches) json["lost_branches"].push_back(to_json(lost));
  json["timings"] = {{"points", info.timings.points},
                     {"continuation", finite_or_null(info.timings.continuation)},
                     {"stability", finite_or_null(info.timings.stability)},
                     {"total", finite_or_null(info.timings.total)}};
  return json;
}

std::string info_text(const RunInfo& info) {
  ordered_json json = to_json(info);
  json["files"] = ordered_json::object();
  for (const auto& [file, stamps] : info.stamps)
    for (const Stamp& stamp : stamps)
      json["files"][file].push_back({{"bytes", stamp.bytes}, {"checksum", stamp.checksum}});
  json["checksum"] = checksum(json.dump());
  return json.dump(2) + "\n";
}

bool has_right_checksum(ordered_json info) {
  const std::string stated = info.at("checksum").get<std::string>();
  info.erase("checksum");
  return stated == checksum(info.dump());
}

RunInfo run_info_from_json(const ordered_json& json) {
  RunInfo info;
  info.version = json.at("version").get<std::string>();
  info.command = json.at("command").get<std::string>();
  info.scene = json.at("scene").get<std::string>();
  info.status = json.at("status").get<std::string>();
  info.has_cylinder = json.at("has_cylinder").get<bool>();
  if (!json.at("parameter").is_null()) info.parameter = json.at("parameter").get<std::string>();
  if (!json.at("extra_parameter").is_null())
    info.extra_parameter = json.at("extra_parameter").get<std::string>();
  info.options = json.at("options");
  info.machine = json.at("machine");
  info.summary = json.at("summary");
  for (const ordered_json& lost : json.at("lost_branches"))
    info.lost_branches.push_back(lost_branch_from_json(lost));
  const ordered_json& timings = json.at("timings");
  info.timings = {timings.at("points").get<int>(), number_or_nan(timings, "continuation"),
                  number_or_nan(timings, "stability"), number_or_nan(timings, "total")};
  for (const auto& [file, stamps] : json.at("files").items())
    for (const ordered_json& stamp : stamps)
      info.stamps[file].push_back(
          {stamp.at("bytes").get<std::size_t>(), stamp.at("checksum").get<std::string>()});
  return info;
}

}  // namespace windlass::output
