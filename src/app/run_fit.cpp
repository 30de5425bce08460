#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "app/commands.hpp"
#include "windlass/equilibrium/follow.hpp"
#include "windlass/equilibrium/rod_problem.hpp"
#include "windlass/measurement/dragged_fit.hpp"
#include "windlass/measurement/fit_picture.hpp"
#include "windlass/output/stable_state.hpp"
#include "windlass/petsc/session.hpp"
#include "windlass/scene/error.hpp"
#include "windlass/scene/units.hpp"

namespace windlass::app {

namespace {

using measurement::ComparedPoint;
using measurement::FrictionFit;
using output::ForceSource;

measurement::Weights weights_of(const std::string& word) {
  return word == "absolute"   ? measurement::Weights::absolute
         : word == "relative" ? measurement::Weights::relative
                              : measurement::Weights::automatic;
}

/// [EI/ρ²]; a plain number is dimensionless already.
double tension_of(const std::string& text, const std::optional<scene::Units>& units) {
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error == std::errc() && end == text.data() + text.size()) return number;
  try {
    if (units) return scene::parse_quantity(text, scene::Dimension::force) / units->force;
  } catch (const std::invalid_argument& error) {
    throw InputError("--min-tension " + text + ": " + error.what());
  }
  throw InputError("--min-tension " + text + ": must be a number, since the scene is dimensionless");
}

/// The measured points with the model's forces, apart from those it has no stable state for and those of low tension.
struct Comparison {
  std::vector<ComparedPoint> used, below;
  std::vector<ForceSource> sources;  ///< of the forces of `used`
  std::vector<measurement::Measurement> without_state;
};

Comparison compare(const FitRequest& request, const output::Run& run, const scene::Scene& scene) {
  const double least = request.min_tension.empty() ? 0.0 : tension_of(request.min_tension, scene.units);
  Comparison comparison;
  for (const auto& measured : measurement::read_measurements(request.csv, scene.units)) {
    const auto force = output::stable_contact_force(run, scene, measured.T);
    if (!force || !(force->R_tot > 0.0)) {
      comparison.without_state.push_back(measured);
    } else if (measured.T < least) {
      comparison.below.push_back({measured, force->R_tot});
    } else {
      comparison.used.push_back({measured, force->R_tot});
      comparison.sources.push_back(force->source);
    }
  }
  return comparison;
}

/// The same of a run whose cylinder slips along the rod: at the run's own friction.
struct DraggedComparison {
  Comparison points;
  std::vector<equilibrium::Solution> states;  ///< of the points used
};

DraggedComparison compare_dragged(const FitRequest& request, const output::Run& run,
                                  const scene::Scene& scene) {
  const double least = request.min_tension.empty() ? 0.0 : tension_of(request.min_tension, scene.units);
  DraggedComparison comparison;
  for (const auto& measured : measurement::read_measurements(request.csv, scene.units)) {
    std::optional<equilibrium::Solution> state = output::stable_state(run, scene, measured.T);
    if (!state) {
      comparison.points.without_state.push_back(measured);
      continue;
    }
    const double per_friction = *state->F0 / *scene.friction;
    if (measured.T < least) {
      comparison.points.below.push_back({measured, per_friction});
      continue;
    }
    comparison.points.used.push_back({measured, per_friction});
    comparison.points.sources.push_back(ForceSource::computed);
    comparison.states.push_back(std::move(*state));
  }
  return comparison;
}

/// Follows the states of the measured points in the friction coefficient, each from where it was last.
measurement::Strength strength_of(std::vector<equilibrium::Solution> states, const scene::Scene& scene) {
  std::vector<double> friction(states.size(), *scene.friction);
  return [states = std::move(states), friction = std::move(friction), scene](
             std::size_t point, double mu) mutable -> std::optional<double> {
    scene::Scene at = scene;
    at.friction = friction[point];
    try {
      states[point] = equilibrium::follow(at, states[point], "cylinder.friction", mu);
    } catch (const equilibrium::NoEquilibrium&) {
      return std::nullopt;
    }
    friction[point] = mu;
    return states[point].F0;
  };
}

const char* name(ForceSource source) {
  return source == ForceSource::interpolated ? "interpolated"
         : source == ForceSource::above_run  ? "above_run"
                                             : "computed";
}

nlohmann::ordered_json to_json(const FrictionFit& fit, const Comparison& comparison) {
  nlohmann::ordered_json json;
  json["mu"] = fit.mu;
  json["standard_error"] = fit.standard_error;
  json["interval_95"] = {fit.low, fit.high};
  json["chi_squared"] = fit.chi_squared;
  json["degrees_of_freedom"] = fit.degrees_of_freedom;
  if (fit.errors_given) json["p_value"] = fit.p_value;
  json["points"] = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < comparison.used.size(); ++i) {
    const ComparedPoint& point = comparison.used[i];
    json["points"].push_back({{"line", point.measured.line},
                              {"T", point.measured.T},
                              {"F0", point.measured.F0},
                              {"R_tot", point.R_tot},
                              {"R_tot_from", name(comparison.sources[i])},
                              {"residual", fit.residuals[i]}});
  }
  json["left_out"] = {{"low_tension", comparison.below.size()},
                      {"no_stable_state", comparison.without_state.size()}};
  return json;
}

void print_points(const FrictionFit& fit, const Comparison& comparison,
                  const std::optional<scene::Units>& units) {
  const double force = units ? units->force : 1.0;
  const char* unit = units ? "[N]" : "[EI/ρ²]";
  fmt::print("  {:>4}  {:>11}  {:>11}  {:>11}  {:>11}  {:>11}\n", "line", "T", "F0", "mu R_tot", "residual",
             "F0/R_tot");
  fmt::print("  {:>4}  {:>11}  {:>11}  {:>11}  {:>11}\n", "", unit, unit, unit, unit);
  for (std::size_t i = 0; i < comparison.used.size(); ++i) {
    const ComparedPoint& point = comparison.used[i];
    const char* mark = comparison.sources[i] == ForceSource::interpolated ? "  a"
                       : comparison.sources[i] == ForceSource::above_run  ? "  b"
                                                                          : "";
    fmt::print("  {:>4}  {:>11.5g}  {:>11.5g}  {:>11.5g}  {:>11.2g}  {:>11.5g}{}\n", point.measured.line,
               point.measured.T * force, point.measured.F0 * force, fit.mu * point.R_tot * force,
               fit.residuals[i] * force, point.measured.F0 / point.R_tot, mark);
  }
  const auto any = [&](ForceSource source) { return std::ranges::count(comparison.sources, source) > 0; };
  if (any(ForceSource::interpolated))
    fmt::print("  a: R_tot interpolated between two points of the run; no equilibrium was computed there\n");
  if (any(ForceSource::above_run))
    fmt::print(
        "  b: above the tensions of the run; the equilibrium was computed there, its stability assumed\n");
}

void print_fit(const FrictionFit& fit, const Comparison& comparison,
               const std::optional<scene::Units>& units) {
  fmt::print("mu = {:.5g} ± {:.2g}   (95 %: {:.5g} to {:.5g})\n", fit.mu, fit.standard_error, fit.low,
             fit.high);
  if (fit.errors_given)
    fmt::print("  chi² = {:.4g} for {} degrees of freedom, p = {:.2g}{}\n", fit.chi_squared,
               fit.degrees_of_freedom, fit.p_value,
               fit.p_value < 0.01 ? ": the given errors do not explain the scatter" : "");
  else
    fmt::print("  {} degrees of freedom; the error is that of the scatter\n", fit.degrees_of_freedom);
  print_points(fit, comparison, units);
  if (!comparison.below.empty())
    fmt::print("  left out below --min-tension: {} points\n", comparison.below.size());
}

}  // namespace

int run_fit(const FitRequest& request) {
  petsc::ensure_session();
  const scene::Scene scene = scene_of_run(request.run, request.common);
  const output::Run run = output::read_run(request.run);
  if (!scene.has_cylinder || (scene.continuation && scene.continuation->parameter != "load.tension"))
    throw InputError(
        request.run.string() +
        ": the fit needs a branch or diagram of a capstan or a knot on a cylinder, in load.tension");
  DraggedComparison found = scene.slides() ? compare_dragged(request, run, scene)
                                           : DraggedComparison{compare(request, run, scene), {}};
  Comparison& comparison = found.points;
  for (const auto& point : comparison.without_state)
    fmt::print(stderr, "windlass: {}:{}: left out: the run has no stable state at T = {:.6g}\n",
               request.csv.string(), point.line, point.T);
  const measurement::Weights weights = weights_of(request.weights);
  const FrictionFit fit = scene.slides()
                              ? measurement::fit_dragged(comparison.used, weights, *scene.friction,
                                                         strength_of(std::move(found.states), scene))
                              : measurement::fit_friction(comparison.used, weights);
  // The numbers first: they are not lost where the pictures cannot be written.
  if (request.common.json)
    fmt::print("{}\n", to_json(fit, comparison).dump(2));
  else if (!request.common.quiet)
    print_fit(fit, comparison, scene.units);
  std::fflush(stdout);
  const std::filesystem::path folder = request.common.out.empty() ? request.run / "fit" : request.common.out;
  const auto pictures = measurement::draw_fit(run, fit, comparison.used, comparison.below, scene.units,
                                              folder, request.formats);
  if (!request.common.json && !request.common.quiet)
    for (const auto& picture : pictures) fmt::print("{}\n", picture.string());
  return done;
}

}  // namespace windlass::app
