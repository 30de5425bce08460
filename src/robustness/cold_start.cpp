#include "windlass/robustness/cold_start.hpp"

#include <chrono>
#include <cmath>
#include <limits>

#include "windlass/equilibrium/start.hpp"
#include "windlass/rod/capstan.hpp"
#include "windlass/scene/error.hpp"
#include "windlass/verify/certificate.hpp"

namespace windlass::robustness {

namespace {

double between(double low, double high, int k, int count) {
  return count > 1 ? low + (high - low) * k / (count - 1) : low;
}

/// Long enough for the wrap and for tails of many decay lengths, as a rod that is not to matter should be.
double ample_length(double tension, double angle) { return angle + 2.0 * (4.0 + 18.0 / std::sqrt(tension)); }

Case at(const scene::Scene& scene, double tension, double angle, double length, const std::string& place) {
  Case one{scene, place};
  one.scene.load.tension = tension;
  one.scene.load.angle = angle;
  one.scene.rod.length = length;
  return one;
}

Outcome outcome_of(const std::string& cause) {
  if (cause.find("events repeat") != std::string::npos) return Outcome::event_loop;
  return Outcome::diverged;
}

}  // namespace

std::string_view name(Outcome outcome) { return outcome_names[static_cast<std::size_t>(outcome)]; }

std::vector<Case> grid_cases(const scene::Scene& scene, const Grid& grid) {
  std::vector<Case> cases;
  for (int i = 0; i < grid.tensions; ++i) {
    const double t =
        std::exp(between(std::log(grid.tension_low), std::log(grid.tension_high), i, grid.tensions));
    for (int j = 0; j < grid.angles; ++j) {
      const double angle = between(grid.angle_low, grid.angle_high, j, grid.angles);
      cases.push_back(at(scene, t, angle, ample_length(t, angle), "grid"));
    }
  }
  return cases;
}

std::vector<Case> hard_cases(const scene::Scene& scene) {
  const double b = scene.rod.bending_stiffness;
  const std::vector<double> angles{0.25 * M_PI, M_PI - 1e-6, M_PI, M_PI + 1e-6, 2.0 * M_PI, 4.0 * M_PI};
  std::vector<Case> cases;
  for (const double angle : angles) {
    const double limit = rod::capstan::line_limit(angle) * b;
    for (const double side : {-1e-2, -1e-4, -1e-8, 1e-8, 1e-4, 1e-2}) {
      const double t = limit * (1.0 + side);
      cases.push_back(at(scene, t, angle, ample_length(t, angle), "limit of line contact"));
    }
    for (const double t : {0.02, 0.1, 1e5})
      cases.push_back(at(scene, t, angle, ample_length(t, angle), "extreme tension"));
    cases.push_back(at(scene, 2.0, angle, angle + 1000.0, "very long tails"));
    cases.push_back(at(scene, 2.0, angle, angle + 0.5, "very short tails"));
    cases.push_back(at(scene, 2.0, angle, std::numeric_limits<double>::infinity(), "infinite tails"));
  }
  for (const double t : {0.6, 3.0, 100.0}) cases.push_back(at(scene, t, 20.0 * M_PI, 100.0, "20 pi of wrap"));
  const std::size_t half = cases.size();
  for (std::size_t k = 0; k < half; k += 3) {
    cases.push_back(cases[k]);
    cases.back().scene.model.symmetry = scene::Symmetry::none;
    cases.back().place += ", full chain";
  }
  return cases;
}

Answer try_case(const Case& one) {
  Answer answer;
  const auto failed = [&](const std::exception& error) {
    answer.cause = error.what();
    answer.outcome = outcome_of(answer.cause);
  };
  const auto begin = std::chrono::steady_clock::now();
  try {
    const equilibrium::Solution solution = equilibrium::solve(one.scene);
    answer.topology = solution.topology;
    answer.R_tot = solution.R_tot;
    answer.newton_iterations = solution.newton_iterations;
    const verify::Certificate certificate = verify::verify(solution, one.scene);
    answer.outcome = certificate.passed() ? Outcome::solved : Outcome::certificate_failed;
    if (const verify::Check* worst = certificate.worst()) answer.cause = worst->name;
  } catch (const scene::SceneError& error) {
    answer.outcome = Outcome::impossible;
    answer.cause = error.what();
  } catch (const equilibrium::NoContact& error) {
    answer.outcome = Outcome::impossible;
    answer.cause = error.what();
  } catch (const std::runtime_error& error) {
    failed(error);
  } catch (const std::domain_error& error) {
    failed(error);
  }
  answer.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return answer;
}

}  // namespace windlass::robustness
