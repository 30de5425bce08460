#include "windlass/precision/second_opinion.hpp"

#include <fmt/format.h>

#include <cmath>

#include "processor_clock.hpp"
#include "windlass/discrete_rod/thick_minimiser.hpp"
#include "windlass/equilibrium/start.hpp"
#include "windlass/knot/start_curve.hpp"
#include "windlass/scene/units.hpp"

namespace windlass::precision {

namespace {

discrete_rod::ThickRod thick_rod(const scene::Scene& scene) {
  discrete_rod::ThickRod rod;
  rod.tension = scene.load.tension;
  rod.angle = scene.load.angle;
  rod.radius = scene.strand_radius();
  constexpr double decay_lengths = 20.0;  // of an infinite tail: exp(−20), squared at the contact
  rod.half_length = scene.rod.infinite() ? 0.5 * rod.angle + decay_lengths / std::sqrt(rod.tension) + 2.0
                                         : 0.5 * scene.rod.length;
  if (scene.knot.tied()) {
    rod.curve = knot::start_curve(scene);
    rod.fine_length = rod.length_of_knot();
  }
  return rod;
}

/// @returns why it found nothing; empty where it did
std::string ask_discrete_rod(const scene::Scene& scene, const std::vector<double>& meshes, Opinion& opinion) {
  const double begin = processor_seconds();
  const discrete_rod::ThickRod rod = thick_rod(scene);
  try {
    rod.validate();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  const discrete_rod::ThickLimit limit = discrete_rod::minimise(rod, meshes);
  opinion.discrete = {limit.R_tot, limit.self_force, processor_seconds() - begin};
  for (const auto& mesh : limit.meshes)
    opinion.meshes.push_back({mesh.h, mesh.unknowns, mesh.iterations, mesh.R_tot, mesh.self_force});
  if (limit.converged) return {};
  return fmt::format("the discrete rod did not converge with h = {:.3g}", limit.meshes.back().h);
}

void ask_chain(const scene::Scene& scene, Opinion& opinion) {
  const double begin = processor_seconds();
  const equilibrium::Solution solution = equilibrium::solve(scene);
  opinion.chain = {solution.R_tot, solution.self_force, processor_seconds() - begin};
  opinion.topology = solution.topology;
}

/// Why there is no comparison; empty where there is one. A state that one of them cannot do is a result.
std::string ask_both(const scene::Scene& scene, const std::vector<double>& meshes, Opinion& opinion) {
  if (const std::string why = ask_discrete_rod(scene, meshes, opinion); !why.empty()) return why;
  try {
    ask_chain(scene, opinion);
  } catch (const equilibrium::NoEquilibrium& error) {
    return fmt::format("{}; the discrete rod alone: R_tot = {:.7g}, self_force = {:.7g}", error.what(),
                       opinion.discrete.R_tot, opinion.discrete.self_force);
  }
  return {};
}

void compare(Opinion& opinion) {
  const Opinion::Value &chain = opinion.chain, &discrete = opinion.discrete;
  opinion.R_tot_difference = discrete.R_tot / chain.R_tot - 1.0;
  opinion.self_force_difference =
      (discrete.self_force - chain.self_force) / (chain.self_force > 0.0 ? chain.self_force : chain.R_tot);
}

}  // namespace

bool Opinion::agrees() const {
  return std::abs(R_tot_difference) <= agreed_R_tot && std::abs(self_force_difference) <= agreed_self_force;
}

OpinionStates default_states(const scene::Scene& scene) {
  if (scene.knot.tied()) return {{0.2, 0.3, 0.5, 0.8, 1.0, 1.5, 2.0, 3.0}, {1.0 / 2.0, 2.0 / 7.0, 1.0 / 6.0}};
  OpinionStates out{{1.0, 1.5, 2.0, 4.0, 8.0}, {1.0 / 2.0, 2.0 / 7.0, 1.0 / 6.0}};
  if (scene.load.angle < 3.0 * M_PI) out.tensions.push_back(12.0);
  return out;
}

bool has_second_opinion(const scene::Scene& scene) {
  return scene.has_cylinder && scene.strand_radius() > 0.0 && scene.free_of_torsion() &&
         scene.rod.compliance() == 0.0;
}

SecondOpinion second_opinion(const scene::Scene& scene, OpinionStates states, const StudyOptions& options) {
  scene::Scene asked = scene::natural(scene);
  if (states.tensions.empty()) states.tensions.push_back(asked.load.tension);
  if (states.radii.empty()) states.radii.push_back(asked.rod_radius);
  SecondOpinion out{asked.load.angle, asked.rod.length, {}, {}};
  const std::vector<double> meshes =
      options.quick ? std::vector{0.1, 0.07, 0.05} : std::vector{0.1, 0.07, 0.05, 0.035};
  for (const double radius : states.radii)
    for (const double tension : states.tensions) {
      if (options.stop && options.stop()) return out;
      asked.rod_radius = radius;
      asked.load.tension = tension;
      const std::string name = fmt::format("T = {:.6g}, R/r = {:.6g}", tension, 1.0 / radius - 1.0);
      if (options.progress) options.progress("second opinion, " + name);
      Opinion opinion;
      opinion.tension = tension;
      opinion.radius = radius;
      if (const std::string reason = ask_both(asked, meshes, opinion); !reason.empty()) {
        out.failures.push_back(name + ": " + reason);
        continue;
      }
      compare(opinion);
      out.states.push_back(opinion);
    }
  return out;
}

}  // namespace windlass::precision
