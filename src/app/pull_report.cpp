#include "app/pull_report.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace windlass::app {

using equilibrium::StateSummary;
using nlohmann::ordered_json;

namespace {

ordered_json to_json(const StateSummary& state) {
  return {{"F0", *state.F0}, {"R_tot", state.R_tot}, {"index", state.index}, {"topology", state.topology}};
}

std::string newtons(double force, const scene::Scene& scene) {
  return scene.units ? fmt::format("  {:.6g} N", force * scene.units->force) : "";
}

std::string in_words(const StateSummary& state, const scene::Scene& scene) {
  return fmt::format("F0 = {:.8g}{}, R_tot = {:.8g}, index {}, {}", *state.F0, newtons(*state.F0, scene),
                     state.R_tot, state.index, state.topology);
}

void print_meshes(const PullResult& result) {
  for (std::size_t k = 0; k < result.meshes.size(); ++k) {
    const PulledMesh& mesh = result.meshes[k];
    if (mesh.rows.empty()) continue;
    const pull::Row& last = mesh.rows.back();
    const auto& at = result.plateaus[k];
    fmt::print("  {:<12} h = {:<8.4g} F = {:<12.8g} {} U = {:.4g} in {} steps", k == 0 ? "meshes" : "",
               mesh.h, (at ? at->drag : last.at.drag) * result.force,
               at ? "plateau reached at" : "no plateau up to", last.displacement, mesh.rows.size());
    for (const double U : result.jumps(k)) fmt::print(", jump at {:.4g}", U);
    fmt::print("\n");
  }
}

void print_selection(const PullResult& result, const scene::Scene& scene) {
  if (!result.no_states.empty()) fmt::print("  {:<12} none found: {}\n", "steady", result.no_states);
  if (!result.selection) return;
  const auto& [state, nearest, difference] = *result.selection;
  fmt::print("  {:<12} {}\n", state ? "selects" : "none selected",
             state ? in_words(result.states[*state], scene)
                   : "the plateau is none of the steady states that `solve` finds; the nearest");
  if (!state) fmt::print("  {:<12} {}\n", "", in_words(result.states[nearest], scene));
  if (!state) fmt::print("  {:<12} nor was it found on exact arcs: {}\n", "", result.not_polished);
  if (result.own)
    fmt::print("  {:<12} not among those that `solve` finds: found on exact arcs from the plateau\n", "");
  fmt::print("  {:<12} F/F0 - 1 = {:.2e}\n", "difference", difference);
}

}  // namespace

std::vector<pull::MeshOutcome> PullResult::outcomes() const {
  std::vector<pull::MeshOutcome> out;
  for (std::size_t k = 0; k < meshes.size(); ++k) out.push_back({meshes[k].h, meshes[k].rows, plateaus[k]});
  return out;
}

std::vector<double> PullResult::jumps(std::size_t mesh) const {
  std::vector<double> out;
  for (const pull::Row& row : meshes[mesh].rows)
    if (row.jumped) out.push_back(row.displacement);
  return out;
}

ordered_json to_json(const PullResult& result, const scene::Scene& scene) {
  ordered_json json{{"scene", scene.name},
                    {"T", scene.load.tension},
                    {"phi", scene.load.angle},
                    {"friction", scene.friction.value_or(0.0)},
                    {"travel", scene.ends.travel == scene::Travel::blocked ? "blocked" : "free"}};
  json["meshes"] = ordered_json::array();
  for (std::size_t k = 0; k < result.meshes.size(); ++k) {
    const PulledMesh& mesh = result.meshes[k];
    ordered_json one{{"h", mesh.h}, {"steps", mesh.rows.size()}, {"plateau", result.plateaus[k].has_value()}};
    if (!mesh.rows.empty()) {
      one["U"] = mesh.rows.back().displacement;
      one["F"] = (result.plateaus[k] ? result.plateaus[k]->drag : mesh.rows.back().at.drag) * result.force;
      one["R_tot"] =
          (result.plateaus[k] ? result.plateaus[k]->R_tot : mesh.rows.back().at.R_tot) * result.force;
    }
    one["jumps"] = result.jumps(k);
    json["meshes"].push_back(std::move(one));
  }
  json["plateau"] = nullptr;
  if (result.limit)
    json["plateau"] = {{"F", result.limit->at.drag * result.force},
                       {"R_tot", result.limit->at.R_tot * result.force},
                       {"misfit", result.limit->misfit},
                       {"one_state", result.limit->one_state()}};
  if (result.limit && scene.units)
    json["plateau"]["newtons"] = result.limit->at.drag * result.force * scene.units->force;
  json["selected"] = nullptr;
  if (result.selection && result.selection->state)
    json["selected"] = to_json(result.states[*result.selection->state]);
  if (result.selection) json["difference"] = result.selection->difference;
  json["states"] = ordered_json::array();
  for (const StateSummary& state : result.states) json["states"].push_back(to_json(state));
  if (result.own) json["selected_by"] = "plateau";
  if (!result.no_states.empty()) json["no_states"] = result.no_states;
  if (!result.failure.empty()) json["failure"] = result.failure;
  return json;
}

void print(const PullResult& result, const scene::Scene& scene) {
  fmt::print("{}: {}\n", scene.name, scene.title);
  print_meshes(result);
  if (result.limit) {
    fmt::print("  {:<12} F = {:.8g}{}, R_tot = {:.8g}", "plateau", result.limit->at.drag * result.force,
               newtons(result.limit->at.drag * result.force, scene), result.limit->at.R_tot * result.force);
    if (result.meshes.size() > 1) fmt::print(", extrapolated with h³");
    if (result.meshes.size() > 2) fmt::print(" (meshes off it by up to {:.1e})", result.limit->misfit);
    fmt::print("\n");
    if (!result.limit->one_state())
      fmt::print("  {:<12} the meshes do not end on one state: the limit means nothing\n", "");
  }
  print_selection(result, scene);
  for (std::size_t k = 0, shown = 0; k < result.states.size(); ++k) {
    const bool told = result.selection && (result.selection->state.value_or(result.selection->nearest) == k);
    if (!told) fmt::print("  {:<12} {}\n", shown++ == 0 ? "others" : "", in_words(result.states[k], scene));
  }
}

}  // namespace windlass::app
