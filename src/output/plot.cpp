#include "windlass/output/plot.hpp"

#include <algorithm>
#include <map>

#include "windlass/output/error.hpp"

namespace windlass::output {

namespace fs = std::filesystem;

namespace {

/// Special points first, then the ends of branches, as far as they are stored.
std::vector<std::string> interesting_points(const Run& run, std::size_t most) {
  std::vector<std::string> names;
  const auto add = [&](const std::string& name) {
    if (names.size() < most && run.points.find(name) &&
        std::find(names.begin(), names.end(), name) == names.end()) {
      names.push_back(name);
    }
  };
  std::map<int, std::pair<const BranchRow*, const BranchRow*>> ends;
  for (const BranchRow& row : run.rows) {
    auto& [first, last] = ends[row.branch];
    if (first == nullptr) first = &row;
    last = &row;
  }
  if (!run.rows.empty())
    add(point_name(run.rows.front().branch, run.rows.front().point, run.rows.front().label));
  for (const char* type : {"branch_point", "fold", "contact"}) {
    for (const SpecialPoint& point : run.special_points) {
      if (point.type == type) add(point.label);
    }
  }
  for (const auto& [branch, rows] : ends)
    add(point_name(rows.second->branch, rows.second->point, rows.second->label));
  return names;
}

/// Many contacts by their beginning and end, so that the title fits the picture.
std::string abridged(const std::string& topology) {
  constexpr std::size_t longest = 90, part = 40;
  if (topology.size() <= longest) return topology;
  const std::size_t head = topology.rfind(' ', part), tail = topology.find(' ', topology.size() - part);
  return topology.substr(0, head) + " …" + topology.substr(tail);
}

std::string rod_title(const Run& run, const std::string& name) {
  const std::string topology = abridged(run.points.get(name).topology);
  for (const SpecialPoint& point : run.special_points) {
    if (point.label != name) continue;
    std::string type = point.type == "branch_point" ? "branch point"
                       : point.type == "contact"    ? "contact event"
                                                    : point.type;
    return run.info.scene + ", " + type + " " + name + ": " + topology;
  }
  return run.info.scene + ", point " + name + ": " + topology;
}

}  // namespace

std::vector<fs::path> plot_run(const fs::path& run_folder, const PlotOptions& options) {
  const Run run = read_run(run_folder);
  const fs::path folder = options.folder.empty() ? run_folder / "plots" : options.folder;
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw OutputError("cannot make the folder " + folder.string() + ": " + error.message());
  std::vector<fs::path> pictures = plot_diagram(run, options, folder, "diagram");
  for (const std::string& name :
       options.points.empty() ? interesting_points(run, options.most_rods) : options.points) {
    const auto made = plot_rod(run.points.get(name), rod_title(run, name), options, folder, "rod-" + name);
    pictures.insert(pictures.end(), made.begin(), made.end());
  }
  return pictures;
}

}  // namespace windlass::output
