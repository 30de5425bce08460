#pragma once

#include <boost/test/unit_test.hpp>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/run_program.hpp"

/// Cylinders that slide through a rod held back by a plate.
namespace windlass::test {

inline std::vector<std::string> sliding(const std::string& command, const std::vector<std::string>& settings,
                                        const char* scene = "capstan-2pi-plate") {
  std::vector<std::string> out = {command, shipped_scene(scene)};
  for (const std::string& setting : settings) out.insert(out.end(), {"--set", setting});
  return out;
}

inline nlohmann::json solved(const std::vector<std::string>& settings,
                             const char* scene = "capstan-2pi-plate") {
  std::vector<std::string> command = sliding("solve", settings, scene);
  command.push_back("--json");
  const TemporaryFolder folder;
  const Outcome outcome = run_program(command, folder.path());
  BOOST_REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
  return nlohmann::json::parse(outcome.out);
}

/// A branch in `run`, all of whose points pass their certificates; its special points.
inline nlohmann::json followed(const std::string& run, const std::vector<std::string>& settings,
                               const char* scene = "capstan-2pi-plate") {
  std::vector<std::string> command = sliding("continue", settings, scene);
  command.insert(command.end(), {"--out", run, "--quiet"});
  const TemporaryFolder folder;
  BOOST_REQUIRE(run_program(command, folder.path()).status == 0);
  const Outcome verified = run_program({"verify", run}, folder.path());
  BOOST_TEST(verified.status == 0, verified.out);
  return nlohmann::json::parse(std::ifstream(run + "/special_points.json"));
}

/// Between clamps and under a pull that leaves it on isolated touches.
inline std::vector<std::string> on_touches(std::vector<std::string> more) {
  std::vector<std::string> out = {"rod.length=22.283185307179586", "load.tension=0.3", "ends.kind=clamped",
                                  "model.kind=kirchhoff", "rod.self_contact=false"};
  out.insert(out.end(), more.begin(), more.end());
  return out;
}

}  // namespace windlass::test
