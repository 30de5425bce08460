#include "app/pull_folder.hpp"

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>

#include "windlass/output/atomic_file.hpp"
#include "windlass/output/branches_csv.hpp"
#include "windlass/output/checksum.hpp"
#include "windlass/output/error.hpp"
#include "windlass/scene/error.hpp"

namespace windlass::app {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

namespace {

constexpr const char* info_name = "pull.json";
constexpr const char* table_name = "pull.csv";
constexpr const char* checkpoint_name = "pull.cbor";

/// A row as numbers, for the checkpoint.
std::array<double, 12> numbers(const pull::Row& row) {
  const pull::Measured& at = row.at;
  return {row.displacement,
          row.step,
          at.drag,
          at.plate_force,
          at.R_tot,
          at.sticking,
          at.pull_difference,
          at.z_low,
          at.z_high,
          at.moved,
          1.0 * row.iterations,
          row.jumped ? 1.0 : 0.0};
}

pull::Row row_of(const std::array<double, 12>& n) {
  return {n[0],
          n[1],
          {.drag = n[2],
           .plate_force = n[3],
           .R_tot = n[4],
           .sticking = n[5],
           .pull_difference = n[6],
           .z_low = n[7],
           .z_high = n[8],
           .moved = n[9]},
          static_cast<int>(n[10]),
          n[11] != 0.0};
}

std::vector<double> list(const Eigen::VectorXd& v) { return {v.begin(), v.end()}; }
Eigen::VectorXd vector(const std::vector<double>& v) {
  return Eigen::Map<const Eigen::VectorXd>(v.data(), static_cast<Eigen::Index>(v.size()));
}

nlohmann::json to_json(const pull::State& state) {
  return {{"unknowns", list(state.unknowns)},
          {"before", list(state.before)},
          {"slip", list(state.slip.reshaped())},
          {"lengths", {state.displacement, state.last_step, state.next_step}}};
}

pull::State state_from(const nlohmann::json& json) {
  pull::State state;
  state.unknowns = vector(json.at("unknowns"));
  state.before = vector(json.at("before"));
  const Eigen::VectorXd slip = vector(json.at("slip"));
  state.slip = slip.reshaped(2, slip.size() / 2);
  const std::array<double, 3> lengths = json.at("lengths");
  state.displacement = lengths[0], state.last_step = lengths[1], state.next_step = lengths[2];
  return state;
}

}  // namespace

PullFolder::Found PullFolder::prepare(const std::string& scene, bool force, bool resume) {
  const fs::path info = folder_ / info_name;
  if (resume && fs::exists(info)) {
    lock_ = output::FolderLock(folder_);
    const ordered_json stored = ordered_json::parse(output::read_file(info), nullptr, false);
    if (stored.is_discarded() || !stored.contains("request"))
      throw output::OutputError("cannot read " + info.string() + ": it is truncated or damaged");
    if (stored["request"] != ordered_json::parse(request_))
      throw InputError("--resume: " + folder_.string() +
                       " holds a pull of another scene, other options or another version; use --force to "
                       "replace it or --out to write elsewhere");
    return stored.contains("outcome") ? Found::over : Found::begun;
  }
  const bool holds = fs::exists(folder_) && (!fs::is_directory(folder_) || !fs::is_empty(folder_));
  if (resume && !holds) throw InputError("--resume: " + folder_.string() + " holds no pull");
  if (holds && !(force && fs::is_directory(folder_)))
    throw InputError(resume ? "--resume: " + folder_.string() + " holds no pull"
                            : folder_.string() + ": is not empty; --force replaces a pull, --resume goes on");
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error) throw output::OutputError("cannot make the folder " + folder_.string() + ": " + error.message());
  lock_ = output::FolderLock(folder_);
  for (const char* old : {table_name, checkpoint_name}) fs::remove(folder_ / old);
  output::replace_file(folder_ / "scene.toml", std::string_view(scene));
  output::replace_file(
      info, std::string_view(ordered_json{{"request", ordered_json::parse(request_)}}.dump(2) + "\n"));
  return Found::nothing;
}

std::optional<PullFolder::Checkpoint> PullFolder::read() const {
  const fs::path path = folder_ / checkpoint_name;
  if (!fs::exists(path)) return std::nullopt;
  const std::string bytes = output::read_file(path);
  try {
    const nlohmann::json json = nlohmann::json::from_cbor(output::unsealed(bytes, path.string()));
    Checkpoint out;
    for (const nlohmann::json& mesh : json.at("meshes")) {
      PulledMesh& one = out.meshes.emplace_back();
      one.h = mesh.at("h");
      for (const nlohmann::json& row : mesh.at("rows")) one.rows.push_back(row_of(row));
    }
    if (json.contains("state")) out.state = state_from(json.at("state"));
    return out;
  } catch (const nlohmann::json::exception& error) {
    throw output::OutputError("cannot read " + path.string() + ": it is truncated or damaged (" +
                              error.what() + ")");
  }
}

std::string PullFolder::table(std::span<const PulledMesh> meshes) const {
  std::string text = "h,U,F,plate_force,R_tot,z_low,z_high,sticking,pull_difference,step,iterations,jumped\n";
  for (const PulledMesh& mesh : meshes)
    for (const pull::Row& row : mesh.rows) {
      const pull::Measured& at = row.at;
      for (const double value :
           {mesh.h, row.displacement, at.drag * force_, at.plate_force * force_, at.R_tot * force_, at.z_low,
            at.z_high, at.sticking, at.pull_difference * force_, row.step})
        text += output::format_number(value) + ",";
      text += fmt::format("{},{:d}\n", row.iterations, row.jumped);
    }
  return text;
}

void PullFolder::save(std::span<const PulledMesh> meshes, const pull::State* state) const {
  nlohmann::json json;
  json["meshes"] = nlohmann::json::array();
  for (const PulledMesh& mesh : meshes) {
    nlohmann::json rows = nlohmann::json::array();
    for (const pull::Row& row : mesh.rows) rows.push_back(numbers(row));
    json["meshes"].push_back({{"h", mesh.h}, {"rows", std::move(rows)}});
  }
  if (state) json["state"] = to_json(*state);
  const std::vector<std::uint8_t> bytes = nlohmann::json::to_cbor(json);
  output::replace_file(folder_ / table_name, std::string_view(table(meshes)));
  output::replace_file(folder_ / checkpoint_name,
                       std::string_view(output::sealed(std::string(bytes.begin(), bytes.end()))));
}

void PullFolder::finish(std::span<const PulledMesh> meshes, const ordered_json& outcome) const {
  output::replace_file(folder_ / table_name, std::string_view(table(meshes)));
  output::replace_file(
      folder_ / info_name,
      std::string_view(
          ordered_json{{"request", ordered_json::parse(request_)}, {"outcome", outcome}}.dump(2) + "\n"));
  fs::remove(folder_ / checkpoint_name);
}

ordered_json PullFolder::outcome() const {
  return ordered_json::parse(output::read_file(folder_ / info_name)).at("outcome");
}

}  // namespace windlass::app
