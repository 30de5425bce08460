#include <fmt/format.h>

#include "run_files.hpp"
#include "windlass/output/atomic_file.hpp"
#include "windlass/output/branches_csv.hpp"
#include "windlass/output/checksum.hpp"
#include "windlass/output/error.hpp"
#include "windlass/output/run_folder.hpp"

namespace windlass::output {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

namespace {

ordered_json parse_json(const fs::path& path) {
  const std::string text = read_file(path);
  try {
    return ordered_json::parse(text);
  } catch (const ordered_json::exception& error) {
    throw OutputError("cannot read " + path.string() + ": it is truncated or not JSON (" + error.what() +
                      ")");
  }
}

/// Runs a conversion of already parsed JSON; a missing or mistyped key names the file.
template <class Convert>
auto convert_json(const fs::path& path, Convert convert) {
  try {
    return convert();
  } catch (const ordered_json::exception& error) {
    throw OutputError("cannot read " + path.string() + ": " + error.what());
  }
}

/// @param whole  nothing may follow what the stamp is of; rows of a run in progress may
void require_stamp(const fs::path& path, const std::string& text, const RunInfo& info, bool whole) {
  const auto stamps = info.stamps.find(path.filename().string());
  if (stamps != info.stamps.end())
    for (const Stamp& stamp : stamps->second)
      if ((whole ? text.size() == stamp.bytes : text.size() >= stamp.bytes) &&
          checksum(std::string_view(text).substr(0, stamp.bytes)) == stamp.checksum)
        return;
  throw OutputError("cannot read " + path.string() + ": it is truncated or damaged (its checksum in " +
                    info_file + " does not fit)");
}

}  // namespace

const BranchRow& Run::row(const std::string& name) const {
  for (const BranchRow& row : rows) {
    if (name == row.label || name == point_name(row.branch, row.point, "")) return row;
  }
  throw OutputError("there is no point \"" + name + "\" in " + (folder / branches_file).string());
}

std::optional<Checkpoint> read_checkpoint(const fs::path& folder) {
  const fs::path path = folder / checkpoint_file;
  if (!fs::exists(path)) return std::nullopt;
  const std::string bytes = read_file(path);
  try {
    nlohmann::json json = nlohmann::json::from_cbor(unsealed(bytes, path.string()));
    const Extent extent{json.at("points"), json.at("special_points"), json.at("lost_branches")};
    return Checkpoint{extent, std::move(json.at("state"))};
  } catch (const nlohmann::json::exception& error) {
    throw OutputError("cannot read " + path.string() + ": it is truncated or damaged (" + error.what() + ")");
  }
}

Run read_run(const fs::path& folder, bool with_points) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) {
    throw OutputError("cannot read the run folder " + folder.string() + ": no such folder");
  }
  Run run;
  run.folder = folder;
  run.scene_toml = read_file(folder / scene_file);
  const ordered_json info = parse_json(folder / info_file);
  run.info = convert_json(folder / info_file, [&] {
    if (!has_right_checksum(info))
      throw OutputError("cannot read " + (folder / info_file).string() +
                        ": it is damaged (its checksum does not fit)");
    return run_info_from_json(info);
  });
  require_stamp(folder / scene_file, run.scene_toml, run.info, true);
  require_stamp(folder / branches_file, read_file(folder / branches_file), run.info,
                run.info.status != "running" && run.info.status != "interrupted");
  run.rows = read_branches(folder / branches_file, run.info.has_cylinder, run.info.extra_parameter);
  require_stamp(folder / special_file, read_file(folder / special_file), run.info, true);
  const ordered_json special = parse_json(folder / special_file);
  run.special_points = convert_json(folder / special_file, [&] {
    std::vector<SpecialPoint> points;
    for (const ordered_json& entry : special) points.push_back(special_point_from_json(entry));
    return points;
  });
  if (!with_points) return run;
  run.points = PointStore::read(folder / points_file);
  // Rows are written before their solutions, so this is not what a kill leaves behind.
  if (run.rows.size() < run.points.size())
    throw OutputError(fmt::format("cannot read {}: it is truncated: {} rows for the {} points of {}",
                                  (folder / branches_file).string(), run.rows.size(), run.points.size(),
                                  points_file));
  return run;
}

}  // namespace windlass::output
