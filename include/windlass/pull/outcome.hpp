#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "windlass/equilibrium/equilibria.hpp"
#include "windlass/pull/pull.hpp"

/// What comes out of pulls on several meshes, and its picture.
namespace windlass::pull {

/// One mesh's pull, natural units.
struct MeshOutcome {
  double h = 0.0;
  std::span<const Row> rows;
  std::optional<Plateau> at;  ///< empty: no plateau up to where the pull was to end
};

/// Of forces, relative: what the limit over three meshes and a steady state differ by where they are the same.
inline constexpr double same_state = 1e-3;

/// The plateaus' limit at h = 0.
struct Limit {
  Plateau at;
  double misfit = 0.0;  ///< largest relative distance of a mesh's F from the line in h³ through them
  /// Do the meshes end on the same state? Those of one differ by less.
  bool one_state() const { return misfit < same_state; }
};

/// Extrapolated with h³, the order of the beds (`DraggedRod`); of one mesh its own. nullopt where a mesh has no plateau.
std::optional<Limit> limit_of(std::span<const MeshOutcome> meshes);

/// Which steady state a pull has come to.
struct Selection {
  std::optional<std::size_t> state;  ///< empty: none of them
  std::size_t nearest = 0;           ///< in F0
  double difference = 0.0;           ///< F over F0 of the nearest, less 1
};

/// The nearest in F0, taken for the one that was come to where F0 and R_tot agree to `same_state`. nullopt without states.
/// @param force  unit in which the states' forces are [EI/ρ²]
std::optional<Selection> selected(const Plateau& at, std::span<const equilibrium::StateSummary> states,
                                  double force);

/// The state of a plateau on exact arcs: contacts are read off where the beds are pressed on, Newton's method finds the state
/// on them and on those that follow (`equilibrium::dragged_on`); it agrees with the plateau to `same_state`. Not for a coil that
/// lies flat on the plate.
/// @param at       the plateau, extrapolated; natural units
/// @param scene    in natural units
/// @param failure  why there is none
std::optional<equilibrium::StateSummary> polished(const Pull& pull, const Plateau& at,
                                                  const scene::Scene& scene, std::string& failure);

struct PictureRequest {
  std::vector<MeshOutcome> meshes;      ///< coarsest first
  std::optional<double> limit;          ///< F of the plateau, natural units
  std::vector<double> steady;           ///< F0 of steady states, natural units
  std::optional<std::size_t> selected;  ///< of `steady`
  double force = 1.0;                   ///< unit of the picture's forces [EI/ρ²]
  std::optional<double> newtons;        ///< EI/ρ² in newtons, for an axis of its own
  std::string title;
  std::vector<std::string> formats;
};

/// pull.{png,svg,pdf}, with its script and data, in `folder`: F(U), the plateau and the steady states' F0 beside it; below
/// what of the contact sticks, and the height of the rod. @throws output::OutputError
std::vector<std::filesystem::path> draw(const PictureRequest& request, const std::filesystem::path& folder);

}  // namespace windlass::pull
