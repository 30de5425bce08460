#include "turns_on_plate.hpp"

#include <fmt/format.h>

#include <cmath>

#include "attempt.hpp"
#include "dragged_start.hpp"
#include "windlass/rod/capstan.hpp"

namespace windlass::equilibrium {

namespace {

/// Turns of a coil in space lie apart here: an endless helix opens below 3/2 [EI/ρ²].
constexpr double turns_apart = 1.0;

}  // namespace

bool turns_press(const scene::Scene& scene) {
  const double tension = scene.load.tension;
  return scene.strand_radius() > 0.0 && tension > turns_apart &&
         rod::capstan::phi_star(tension, scene.load.angle) > M_PI;
}

std::vector<Started> turns_on_plate(const scene::Scene& scene, const std::vector<std::string>& keys,
                                    std::string& searched) {
  std::vector<Started> out;
  scene::Scene moderate = scene;
  moderate.load.tension = turns_apart;
  std::string there, lost;
  const std::vector<Started> found = left_the_plate(moderate, {"load.tension"}, there);
  for (const Started& from : found) {
    std::string failure;
    try {
      if (auto reached = reach(from, scene, scene.load.tension, false, keys, failure))
        out.push_back(*reached);
    } catch (const NoEquilibrium& none) {
      failure = none.what();
    }
    if (!failure.empty()) lost += "; one was not: " + failure;
  }
  searched += fmt::format("at T = {:.4g} {}; of the {} found there {} followed to this tension{}",
                          turns_apart, there, found.size(), out.size(), lost);
  return out;
}

}  // namespace windlass::equilibrium
