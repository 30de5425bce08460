#include "app/sweep_case.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <vector>

#include "app/stored_point.hpp"
#include "windlass/output/branches_csv.hpp"
#include "windlass/output/error.hpp"
#include "windlass/output/run_folder.hpp"
#include "windlass/scene/error.hpp"
#include "windlass/scene/reader.hpp"

namespace windlass::app {

namespace fs = std::filesystem;
using output::csv_cell;
using output::format_number;

std::string SweepCase::columns() const {
  if (request_.each != "solve") return "status,points,special_points,lost_branches";
  return has_cylinder_ ? "T,phi,model,R_tot,phi_star,tilt,z_span,energy,index,error_estimate,topology"
                       : "model,end_force,end_moment,shortening,z_span,energy,index,error_estimate,topology";
}

std::string SweepCase::header() const {
  std::string text = "case";
  for (const SweepAxis& axis : grid_.axes()) text += "," + axis.key;
  return text + "," + columns() + ",failure\n";
}

std::string SweepCase::solve(const scene::Scene& scene) const {
  const equilibrium::Equilibria all = judged_equilibria(scene);
  const equilibrium::Solution& s = all.answer;
  std::string text;
  if (s.has_cylinder) text = format_number(s.T) + "," + format_number(s.phi) + ",";
  text += s.model;
  const std::array<double, 5> capstan{s.R_tot, s.phi_star, s.tilt, s.z_span, s.energy},
      strut{s.end_force, s.end_moment, s.shortening, s.z_span, s.energy};
  for (const double value : s.has_cylinder ? capstan : strut) text += "," + format_number(value);
  return text + "," + std::to_string(all.states.front().index) + "," + format_number(s.error_estimate) + "," +
         csv_cell(s.topology);
}

std::optional<std::string> SweepCase::walk(const scene::Scene& scene, const fs::path& folder) const {
  if (!scene.continuation) throw scene::SceneError("[continuation]: missing; a branch needs continuation.to");
  BranchRequest branch;
  branch.common = request_.common;
  branch.common.out = folder;
  branch.common.quiet = true;
  branch.common.json = false;
  branch.scene = scene;
  branch.resume = request_.resume;
  branch.eigenvalues = false;
  if ((request_.each == "continue" ? run_continue : run_diagram)(branch) == interrupted) return std::nullopt;
  const output::Run run = output::read_run(folder, false);
  std::string lost;
  for (const output::LostBranch& branch_lost : run.info.lost_branches)
    lost += (lost.empty() ? "" : "; ") + branch_lost.reason;
  return run.info.status + "," + std::to_string(run.rows.size()) + "," +
         std::to_string(run.special_points.size()) + "," + std::to_string(run.info.lost_branches.size()) +
         "," + csv_cell(lost);
}

std::optional<std::string> SweepCase::run(int number, const fs::path& folder) const {
  std::string row = std::to_string(number + 1);
  for (const std::string& value : grid_.values(number)) row += "," + csv_cell(value);
  row += ",";
  const auto failed = [&](const std::exception& error) {
    const std::string names = columns();
    row.append(std::count(names.begin(), names.end(), ','), ',');
    return row + "," + csv_cell(error.what()) + "\n";
  };
  try {
    std::vector<std::string> settings = request_.common.set;
    const std::vector<std::string> own = grid_.settings(number);
    settings.insert(settings.end(), own.begin(), own.end());
    const scene::Scene scene = scene::read_scene(request_.scene, settings);
    if (request_.each == "solve") return row + solve(scene) + ",\n";
    const auto cells = walk(scene, folder);
    return cells ? std::optional(row + *cells + "\n") : std::nullopt;
  } catch (const output::OutputError&) {  // a full disk is no answer to the case
    throw;
  } catch (const std::runtime_error& error) {  // a scene that cannot be, no equilibrium, PETSc
    return failed(error);
  } catch (const std::domain_error& error) {  // a state that leaves the equations' domain
    return failed(error);
  }
}

bool SweepCase::failed(const std::string& row) {
  const std::string line = row.substr(0, row.find_last_not_of('\n') + 1);
  return !output::split_csv(line).back().empty();
}

}  // namespace windlass::app
