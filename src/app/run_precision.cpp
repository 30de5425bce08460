#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/commands.hpp"
#include "app/interrupt.hpp"
#include "app/progress.hpp"
#include "windlass/output/atomic_file.hpp"
#include "windlass/petsc/session.hpp"
#include "windlass/precision/second_opinion.hpp"
#include "windlass/precision/study.hpp"
#include "windlass/scene/error.hpp"

namespace windlass::app {

namespace fs = std::filesystem;

namespace {

nlohmann::ordered_json summary(const precision::Study& study) {
  nlohmann::ordered_json out;
  out["state"] = study.state;
  out["reference"] = {{"R_tot", study.reference.R_tot},
                      {"phi_star", study.reference.phi_star},
                      {"energy", study.reference.energy},
                      {"unknowns", study.reference_unknowns}};
  if (study.reference.transition) out["reference"]["transition"] = *study.reference.transition;
  out["measurements"] = study.measurements.size();
  out["failures"] = study.failures;
  out["conclusions"] = precision::conclusions(study);
  return out;
}

nlohmann::ordered_json summary(const precision::SecondOpinion& opinion) {
  const auto value = [](const precision::Opinion::Value& v) {
    return nlohmann::ordered_json{{"R_tot", v.R_tot}, {"self_force", v.self_force}, {"seconds", v.seconds}};
  };
  nlohmann::ordered_json out;
  out["angle"] = opinion.angle;
  out["states"] = nlohmann::ordered_json::array();
  for (const precision::Opinion& o : opinion.states) {
    nlohmann::ordered_json state{{"T", o.tension},
                                 {"radius", o.radius},
                                 {"topology", o.topology},
                                 {"chain", value(o.chain)},
                                 {"discrete", value(o.discrete)},
                                 {"R_tot_difference", o.R_tot_difference},
                                 {"self_force_difference", o.self_force_difference}};
    for (const precision::Opinion::Mesh& mesh : o.meshes)
      state["meshes"].push_back({{"h", mesh.h},
                                 {"unknowns", mesh.unknowns},
                                 {"iterations", mesh.iterations},
                                 {"R_tot", mesh.R_tot},
                                 {"self_force", mesh.self_force}});
    out["states"].push_back(std::move(state));
  }
  out["failures"] = opinion.failures;
  return out;
}

/// Of a thick rod; none for others.
std::optional<precision::SecondOpinion> second_opinion(const PrecisionRequest& request,
                                                       const precision::StudyOptions& options) {
  if (!precision::has_second_opinion(request.scene)) return std::nullopt;
  precision::OpinionStates states{request.tensions, request.radii};
  if (states.empty() && !request.quick) states = precision::default_states(request.scene);
  return precision::second_opinion(request.scene, states, options);
}

}  // namespace

int run_precision(const PrecisionRequest& request) {
  const fs::path folder = request.common.out.empty() ? fs::path("runs") / (request.scene.name + "-precision")
                                                     : request.common.out;
  if (fs::exists(folder) && !fs::is_empty(folder) && !request.common.force)
    throw InputError(folder.string() + ": is not empty; --force replaces what is there");
  petsc::ensure_session();
  const DeferredInterrupts deferred;
  fs::create_directories(folder);
  Progress progress(request.common.quiet);
  precision::StudyOptions options;
  options.repeats = request.repeats;
  options.quick = request.quick;
  options.progress = [&](const std::string& text) { progress.update(text); };
  options.stop = interrupted_by_user;
  const precision::Study study = precision::study(request.scene, options);
  const std::optional<precision::SecondOpinion> opinion = second_opinion(request, options);
  progress.finish();
  nlohmann::ordered_json json = summary(study);
  if (opinion) {
    json["second_opinion"] = summary(*opinion);
    output::replace_file(folder / "second_opinion.csv", std::string_view(precision::to_csv(*opinion)));
  }
  output::replace_file(folder / "precision.csv", std::string_view(precision::to_csv(study)));
  output::replace_file(folder / "precision.json", std::string_view(json.dump(2) + "\n"));
  precision::draw(study, folder, {"png", "svg", "pdf"});
  if (request.common.json) {
    std::printf("%s\n", json.dump(2).c_str());
  } else if (!request.common.quiet) {
    std::printf("%s\n", study.state.c_str());
    for (const std::string& sentence : precision::conclusions(study)) std::printf("%s\n", sentence.c_str());
    for (const std::string& failure : study.failures) std::printf("failed: %s\n", failure.c_str());
    if (opinion) {
      std::printf("%s", precision::to_text(*opinion).c_str());
      for (const std::string& failure : opinion->failures) std::printf("failed: %s\n", failure.c_str());
    }
    std::printf("%zu measurements -> %s\n", study.measurements.size(), folder.string().c_str());
  }
  return interrupted_by_user() ? interrupted : done;
}

}  // namespace windlass::app
