#include "windlass/equilibrium/codec.hpp"

#include "windlass/equilibrium/record.hpp"

namespace windlass::equilibrium {

continuation::ProblemCodec rod_codec(const scene::Scene& scene, const std::vector<std::string>& keys) {
  return {
      [](const continuation::Problem& problem) -> nlohmann::json {
        const auto& rod = dynamic_cast<const RodProblem&>(problem);
        const RodProblem::Memory memory = rod.memory();
        return {{"chain", chain_of(rod)},
                {"index", memory.index},
                {"breaking_index", memory.breaking_index},
                {"error", memory.error},
                {"nodal_floor", memory.nodal_floor},
                {"error_floor", memory.error_floor},
                {"slides", memory.slides},
                {"sliding_off", memory.sliding_off},
                {"sliding_reference",
                 memory.sliding_reference ? nlohmann::json(*memory.sliding_reference) : nlohmann::json()}};
      },
      [scene, keys](const nlohmann::json& data) -> std::shared_ptr<continuation::Problem> {
        const auto rod = rebuild(scene, data.at("chain").get<std::string>(), keys);
        const nlohmann::json& reference = data.at("sliding_reference");
        rod->remember({data.at("index"), data.at("breaking_index"), data.at("error"), data.at("nodal_floor"),
                       data.value("error_floor", 0.0), data.at("slides"), data.at("sliding_off"),
                       reference.is_null() ? std::nullopt : std::optional(reference.get<int>())});
        return rod;
      }};
}

}  // namespace windlass::equilibrium
