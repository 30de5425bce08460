#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <string>
#include <vector>

#include "windlass/equilibrium/solution.hpp"
#include "windlass/obstacle/surface.hpp"
#include "windlass/output/run_folder.hpp"
#include "windlass/scene/scene.hpp"

namespace windlass::output {

/// The XML PolyData (.vtp) texts of one rod, for ParaView and everything else that reads VTK's file formats
/// (https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html). Dimensionless, in the world frame.
struct VtkRod {
  /// A polyline along the centreline; point data s, pressure, contact (1 on a line contact), radius (of the
  /// rod, for the Tube filter: Scalars `radius`, Vary Radius by absolute scalar), the directors d1, d2, d3,
  /// force n, moment m. Field data T, phi, R_tot, rod_radius and, of a physical scene, its units.
  std::string rod;
  /// A vertex at each touch and edge, on the centreline; point data force (vector on the rod), size, s: ready
  /// for the Glyph filter. `touched` is the place on the rod's surface, `strand` 1 where another strand
  /// presses, touched at `partner_s`.
  std::string forces;
};

VtkRod vtk_rod(const equilibrium::Solution& solution, const scene::Scene& scene);

/// The surface of the cylinder as quadrilaterals, from z = low to high; its radius is 1 less the rod's
/// radius.
std::string vtk_cylinder(const scene::Scene& scene, double low, double high);

/// A rectangle for each plane wall, as large as the box (of a rod) asks for, a radius of the rod behind where its
/// centreline is stopped.
std::string vtk_walls(const obstacle::Set& obstacles, const Eigen::AlignedBox3d& box, double rod_radius);

/// Writes rods of a run: `rod-POINT.vtp`, `forces-POINT.vtp`, `cylinder.vtp` or `walls.vtp`, and the
/// collection that opens them all, `STEM.pvd`. Several rods follow one another in ParaView's time, which is
/// their number in the list.
/// @param names  stored points, by label or "BRANCH-POINT"
/// @return       the collection
/// @throws OutputError when a point is unknown or a file cannot be written
std::filesystem::path export_vtk(const Run& run, const scene::Scene& scene,
                                 const std::vector<std::string>& names, const std::filesystem::path& folder,
                                 const std::string& stem);

}  // namespace windlass::output
