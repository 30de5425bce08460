#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "windlass/scene/scene.hpp"

/// Work against precision: what each method and mesh costs, and how far it is from a reference of far higher resolution.
namespace windlass::precision {

/// What is compared, dimensionless; an error has the same shape, relative.
struct Quantities {
  double R_tot = 0.0, phi_star = 0.0, energy = 0.0;
  std::optional<double>
      transition;  ///< tension below which the flat state is unstable; where a method can tell
};

/// One method on one mesh.
struct Measurement {
  std::string method;            ///< e.g. "planar arcs"
  int elements = 0, stages = 0;  ///< of the half rod (full chain: of the rod); 0 where there are none
  int unknowns = 0;
  double seconds = 0.0;  ///< of the processor, median over repeats, warm: from the first guess to R_tot
  Quantities value, error;
};

struct Study {
  std::string state;  ///< which equilibrium, and how the methods are started
  Quantities reference;
  int reference_unknowns = 0;
  std::vector<Measurement> measurements;
  std::vector<std::string> failures;  ///< "METHOD, N elements: reason"
};

struct StudyOptions {
  int repeats = 5;
  bool quick = false;                                ///< short ladders
  std::function<void(const std::string&)> progress;  ///< told what is being measured; may be empty
  std::function<bool()> stop;                        ///< asked between measurements; may be empty
};

/// Measures every method that can do the scene: on flat states the closed form, planar arcs (the tail a formula or on a mesh), Kirchhoff arcs on the half
/// and the full chain, nodal complementarity (equilibrium/discovery) and the discrete elastic rod; on helical states
/// the Kirchhoff arcs. Meshes have the reference's distribution of nodes, thinned.
/// @throws InputError for a scene without cylinder; equilibrium::NoEquilibrium
Study study(const scene::Scene& scene, const StudyOptions& options);

/// One line a measurement, relative errors last.
std::string to_csv(const Study& study);

/// Which method reaches 1e-3, 1e-6 and 1e-9 in R_tot at the least cost, a sentence each.
std::vector<std::string> conclusions(const Study& study);

/// Errors against seconds, `precision`.{png,svg,pdf}, and against unknowns, `precision-unknowns`, log-log.
/// @return the pictures
std::vector<std::filesystem::path> draw(const Study& study, const std::filesystem::path& folder,
                                        const std::vector<std::string>& formats);

}  // namespace windlass::precision
