#include "windlass/precision/study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "arcs.hpp"
#include "processor_clock.hpp"
#include "windlass/discrete_rod/minimiser.hpp"
#include "windlass/equilibrium/discovery.hpp"
#include "windlass/rod/capstan.hpp"
#include "windlass/scene/error.hpp"

namespace windlass::precision {

namespace {

/// Of the value itself where the exact one is zero: phi_star of a single touch.
double relative(double value, double exact) {
  return std::abs(value - exact) / (exact == 0.0 ? 1.0 : std::abs(exact));
}

Quantities errors(const Quantities& value, const Quantities& exact) {
  Quantities out{relative(value.R_tot, exact.R_tot), relative(value.phi_star, exact.phi_star),
                 relative(value.energy, exact.energy), std::nullopt};
  if (value.transition && exact.transition) out.transition = relative(*value.transition, *exact.transition);
  return out;
}

/// Loads as the methods without infinite tails want them.
contact::Loads finite_loads(const Reference& reference) {
  contact::Loads loads = equilibrium::loads_of(reference.scene);
  if (reference.scene.rod.infinite()) loads.half_length = reference.s.back();
  return loads;
}

class Measurer {
 public:
  Measurer(const Reference& reference, const StudyOptions& options, Study& out)
      : reference_(reference), options_(options), out_(out) {}

  bool stopped() const { return options_.stop && options_.stop(); }

  /// `solve` is timed; `evaluate` fills unknowns and value afterwards.
  template <class Solve, class Evaluate>
  void measure(const std::string& method, int elements, int stages, Solve&& solve, Evaluate&& evaluate) {
    if (stopped()) return;
    const std::string name = fmt::format("{}, {} elements{}", method, elements,
                                         stages ? fmt::format(" of {} stages", stages) : std::string());
    if (options_.progress) options_.progress(name);
    Measurement m{method, elements, stages, 0, 0.0, {}, {}};
    const auto failed =
        [&](const std::exception& error) {  // a measurement that does not converge is a result
          out_.failures.push_back(name + ": " + error.what());
        };
    try {
      m.seconds = median(solve);
      evaluate(m);
    } catch (const std::runtime_error& error) {
      return failed(error);
    } catch (const std::domain_error& error) {
      return failed(error);
    }
    m.error = errors(m.value, out_.reference);
    out_.measurements.push_back(m);
  }

 private:
  /// Processor time, since the machine may be shared. The first call warms caches and is not counted, unless it alone is
  /// long; what is shorter than the clock can tell is done many times over.
  template <class Solve>
  double median(Solve&& solve) const {
    constexpr double enough = 0.5, readable = 5e-4;
    const auto timed = [&](int times) {
      const double begin = processor_seconds();
      for (int k = 0; k < times; ++k)
        if (!solve()) throw std::runtime_error("did not converge");
      return (processor_seconds() - begin) / times;
    };
    const double first = timed(1);
    if (first > enough) return first;
    const int times = std::clamp(static_cast<int>(readable / first), 1, 1000);
    std::vector<double> seconds;
    for (int k = 0; k < options_.repeats; ++k) seconds.push_back(timed(times));
    std::nth_element(seconds.begin(), seconds.begin() + seconds.size() / 2, seconds.end());
    return seconds[seconds.size() / 2];
  }

  const Reference& reference_;
  const StudyOptions& options_;
  Study& out_;
};

void measure_closed_form(const Reference& reference, Measurer& measurer) {
  namespace capstan = rod::capstan;
  const double t = reference.scene.load.tension, phi = reference.scene.load.angle;
  volatile double sink = 0.0;
  measurer.measure(
      "closed form", 0, 0, [&] { return sink = capstan::total_force(t, phi), true; },
      [&](Measurement& m) {
        // Energy of a homoclinic tail: ∫ ½ψ'² ds = 2 √T (1 − cos(β/2)).
        m.value = {capstan::total_force(t, phi), capstan::phi_star(t, phi),
                   capstan::phi_star(t, phi) + 4.0 * std::sqrt(t) * (1.0 - std::cos(0.5 * capstan::beta(t))),
                   std::nullopt};
      });
}

void measure_arcs(const Reference& reference, const StudyOptions& options, Measurer& measurer,
                  const std::string& method, bool spatial, bool half) {
  const std::vector<int> counts =
      options.quick ? std::vector{4, 12} : std::vector{2, 4, 6, 8, 12, 16, 24, 32};
  const std::vector<int> orders = options.quick ? std::vector{4} : std::vector{2, 4, 6, 8};
  for (const int stages : orders)
    for (const int count : counts) {
      const int elements = half ? count : 2 * count;
      ArcSolver solver(reference, spatial, half, elements, stages);
      measurer.measure(
          method, elements, stages, [&] { return solver.solve(); },
          [&](Measurement& m) {
            m.unknowns = solver.unknowns();
            m.value = solver.quantities();
            if (spatial && reference.value.transition)
              m.value.transition = solver.transition(*reference.value.transition);
          });
    }
}

/// What `solve` does: no mesh at all.
void measure_formula_tail(const Reference& reference, Measurer& measurer) {
  ArcSolver solver(reference, false, true, 0, 0);
  measurer.measure(
      "planar arcs, tail by formula", 0, 0, [&] { return solver.solve(); },
      [&](Measurement& m) {
        m.unknowns = solver.unknowns();
        m.value = solver.quantities();
      });
}

void measure_nodal(const Reference& reference, const StudyOptions& options, Measurer& measurer) {
  const contact::Loads loads = finite_loads(reference);
  const std::vector<int> counts = options.quick ? std::vector{20, 40} : std::vector{20, 40, 80, 160, 320};
  for (const int count : counts) {
    equilibrium::DiscoveryOptions nodal;
    nodal.elements = count;
    nodal.clamped = reference.scene.ends.kind == scene::EndKind::clamped;
    equilibrium::Discovery found;
    measurer.measure(
        "nodal complementarity", count, 0,
        [&] { return found = equilibrium::discover_contacts(loads, nodal), found.converged; },
        [&](Measurement& m) {
          m.unknowns = 6 * static_cast<int>(found.s.size()) - 2;
          double energy = 0.0;
          for (std::size_t k = 1; k < found.s.size(); ++k)
            energy += std::pow(found.theta[k] - found.theta[k - 1], 2) / (found.s[k] - found.s[k - 1]);
          const double last = found.contacts.empty() ? 0.0 : found.contacts.back().angle_end;
          m.value = {found.R_tot, last, energy, std::nullopt};
        });
  }
}

void measure_discrete_rod(const Reference& reference, const StudyOptions& options, Measurer& measurer) {
  const contact::Loads loads = finite_loads(reference);
  const std::vector<int> counts = options.quick ? std::vector{60, 120} : std::vector{60, 120, 240, 480, 960};
  for (const int count : counts) {
    discrete_rod::MinimiserOptions plain;
    plain.edges = count;
    plain.clamped = reference.scene.ends.kind == scene::EndKind::clamped;
    discrete_rod::Minimum found;
    measurer.measure(
        "discrete elastic rod", count, 0,
        [&] { return found = discrete_rod::minimise(loads, plain), found.converged; },
        [&](Measurement& m) {
          m.unknowns = found.unknowns;
          m.value = {found.R_tot, found.phi_star, found.energy, std::nullopt};
        });
  }
}

/// Tension at which the flat state loses its stability to an even mode, on the reference's mesh; none if it does not.
std::optional<double> reference_transition(const Reference& reference) {
  const double end = 1.02 * rod::capstan::line_limit(reference.scene.load.angle);
  int elements = 0;
  for (const auto& mesh : reference.meshes) elements += 2 * static_cast<int>(mesh.nodes.size() - 1);
  ArcSolver solver(reference, true, true, elements, 8);
  if (!solver.solve()) return std::nullopt;
  constexpr double step = 1.05;
  double tension = std::max(2.0 * end, reference.scene.load.tension);
  for (int index = 0; tension > end; tension /= step) {
    index = solver.even_index(tension);
    if (index > 0) return solver.transition(tension * std::sqrt(step));
    if (index < 0) break;
  }
  return std::nullopt;
}

}  // namespace

Study study(const scene::Scene& scene, const StudyOptions& options) {
  if (!scene.has_cylinder) throw InputError(scene.name + ": precision needs a scene with a cylinder");
  if (scene.ends.guided())
    throw InputError(scene.name +
                     ": ends.guide: precision needs \"none\": its other methods know dead pulls only");
  Reference reference = make_reference(scene);
  const bool line = rod::capstan::line_contact(scene.load.tension, scene.load.angle);
  if (reference.flat && scene.load.angle > M_PI && line)
    reference.value.transition = reference_transition(reference);
  Study out;
  out.state = reference.flat ? "flat state, every method started from the closed form of infinite tails"
                             : "helical state, arcs started from the reference's shape";
  out.reference = reference.value;
  out.reference_unknowns = reference.unknowns;
  Measurer measurer(reference, options, out);
  if (reference.flat && line) measure_closed_form(reference, measurer);
  const scene::Scene& of = reference.scene;
  if (reference.flat && line && !of.rod.infinite() && of.ends.kind == scene::EndKind::moment_free)
    measure_formula_tail(reference, measurer);
  if (reference.flat) measure_arcs(reference, options, measurer, "planar arcs", false, true);
  measure_arcs(reference, options, measurer, "Kirchhoff arcs, half", true, true);
  measure_arcs(reference, options, measurer, "Kirchhoff arcs, full", true, false);
  if (reference.flat) measure_nodal(reference, options, measurer);
  if (reference.flat && line) measure_discrete_rod(reference, options, measurer);
  return out;
}

}  // namespace windlass::precision
