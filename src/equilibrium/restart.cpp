// States as text and numbers, from which the discrete problem comes back to the last bit.
#include <algorithm>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "windlass/equilibrium/record.hpp"
#include "windlass/scene/units.hpp"

namespace windlass::equilibrium {

using chain::Stretch;

std::string chain_of(const RodProblem& problem) {
  nlohmann::json chain;
  chain["spatial"] = problem.spatial();
  chain["half"] = problem.topology().half;
  chain["mid_touch"] = problem.topology().mid_touch;
  if (problem.topology().symmetry == chain::Symmetry::mirror) chain["mirror"] = true;
  const scene::Units& units = problem.units();
  chain["units"] = {{"length", units.length}, {"bending_stiffness", units.bending_stiffness}};
  for (const Stretch stretch : problem.topology().stretches)
    chain["stretches"].push_back(static_cast<int>(stretch));
  for (const chain::Seat& seat : problem.topology().on) {
    chain["on"].push_back(seat.obstacle);
    chain["strands"].push_back(seat.strand);
    chain["parts"].push_back(seat.part);
    chain["lines"].push_back(seat.line);
    chain["stops"].push_back(seat.stop);
    chain["flats"].push_back(seat.flat);
    chain["middles"].push_back(static_cast<int>(seat.middle));
  }
  const std::vector<chain::Seat>& on = problem.topology().on;
  if (std::any_of(on.begin(), on.end(), [](const chain::Seat& seat) { return seat.shares != 0; }))
    for (const chain::Seat& seat : on) chain["shares"].push_back(seat.shares);
  for (const auto& mesh : problem.meshes())
    chain["meshes"].push_back({{"nodes", mesh.nodes}, {"stages", mesh.stages}});
  return chain.dump();
}

Restart restart_of(const RodProblem& problem, const Vector& x) { return {chain_of(problem), x}; }

scene::Units units_of(const std::string& chain) {
  const nlohmann::json all = nlohmann::json::parse(chain);
  if (!all.contains("units")) return {};  // of a run made before states had units of their own
  const nlohmann::json& units = all.at("units");
  return scene::Units::of(units.at("length"), units.at("bending_stiffness"));
}

std::shared_ptr<RodProblem> rebuild(const scene::Scene& scene, const std::string& text,
                                    const std::vector<std::string>& keys) {
  const nlohmann::json chain = nlohmann::json::parse(text);
  Topology topology;
  topology.half = chain.at("half");
  topology.mid_touch = chain.at("mid_touch");
  if (chain.value("mirror", false)) topology.symmetry = chain::Symmetry::mirror;
  for (int k : chain.at("stretches")) topology.stretches.push_back(static_cast<Stretch>(k));
  const auto on = chain.value("on", std::vector<int>()), strands = chain.value("strands", std::vector<int>());
  const auto parts = chain.value("parts", std::vector<double>());
  const auto lines = chain.value("lines", std::vector<int>());
  const auto flats = chain.value("flats", std::vector<int>());
  const auto stops = chain.value("stops", std::vector<int>()), middles = chain.value("middles", stops);
  const auto shares = chain.value("shares", std::vector<int>());
  for (std::size_t j = 0; j < on.size(); ++j)
    topology.on.push_back(
        {on[j], j < strands.size() ? strands[j] : 0, j < parts.size() ? parts[j] : 0.0,
         j < lines.size() ? lines[j] : 0, j < stops.size() ? stops[j] : -1, j < flats.size() ? flats[j] : -1,
         j < middles.size() && stops[j] >= 0 && middles[j] == 1, j < shares.size() ? shares[j] : 0});
  std::vector<chain::ArcMesh> meshes;
  for (const auto& mesh : chain.at("meshes"))
    meshes.push_back({mesh.at("nodes").get<std::vector<double>>(), mesh.at("stages").get<int>()});
  return std::make_shared<RodProblem>(scene::in_units(scene, units_of(text)), chain.at("spatial").get<bool>(),
                                      topology, meshes, keys);
}

std::shared_ptr<RodProblem> reopen(const scene::Scene& scene, const Restart& restart,
                                   const std::vector<std::string>& keys) {
  const auto refuse = [](const std::string& why) {
    return std::runtime_error("the stored point cannot be restarted: " + why);
  };
  std::shared_ptr<RodProblem> problem;
  try {
    problem = rebuild(scene, restart.chain, keys);
  } catch (const nlohmann::json::exception& error) {  // damaged text
    throw refuse(error.what());
  } catch (const std::invalid_argument& error) {  // a chain that the kind of rod cannot have
    throw refuse(error.what());
  }
  if (problem->chain().ambient_size() != restart.state.size()) throw refuse("its state has another size");
  return problem;
}

}  // namespace windlass::equilibrium
