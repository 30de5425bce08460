#pragma once

#include <optional>
#include <string>
#include <vector>

#include "windlass/equilibrium/start.hpp"

/// What starts of dragged rods have in common: a shape put on contacts.
namespace windlass::equilibrium {

/// The (first) plate's place among the obstacles of a rod on a cylinder.
inline constexpr int plate_obstacle = 1;

/// The rod round a cylinder that stands, and no plate.
scene::Scene standing(scene::Scene scene);

/// Contacts, the places of joints and the meshes between them.
struct Layout {
  Topology topology;
  std::vector<double> s;
  std::vector<chain::ArcMesh> meshes;
};

/// The state on these contacts, from a shape lifted by `lift`. @param p  of the keys; nothing: the scene's
std::optional<Started> on_contacts(Layout layout, chain::Profile shape, double lift,
                                   const scene::Scene& scene, const std::vector<std::string>& keys,
                                   std::optional<Vector> p);

}  // namespace windlass::equilibrium
