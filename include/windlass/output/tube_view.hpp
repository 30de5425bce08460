#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "windlass/output/rod_projection.hpp"

/// A rod of some thickness in a parallel projection: short pieces of a tube, drawn farthest first, so that
/// what is nearer to the eye covers what is farther, strands of the same rod too.
namespace windlass::output {

/// Between two neighbouring places of the rod. Its sides are perpendicular to the tangents as they are seen,
/// so that neighbours share them, also where the rod turns towards the eye.
struct TubePiece {
  Eigen::Vector3d middle;
  double depth = 0.0;  ///< of the middle, towards the eye
  std::array<Eigen::Vector2d, 2> centre, side;
  std::array<double, 2> rest = {0.0, 0.0};  ///< of the rod, beyond either end of the piece [ρ]
  unsigned colour = 0;                      ///< 0xRRGGBB
};

/// @param radius     of the tube [ρ]
/// @param colour_of  colour of the piece that begins at a place of the curve
/// @return           farthest first
std::vector<TubePiece> tube_pieces(const RodCurve& curve, double radius, const View& view,
                                   const std::function<unsigned(std::size_t place)>& colour_of);

/// How wide a rod is drawn.
struct Stroke {
  double radius = 0.0;  ///< of the rod, or of a line that can just be seen; 0: no thickness [ρ]
  double edge = 0.0;    ///< width of the dark line along either side [ρ]
};
Stroke stroke_of(double rod_radius, double picture_width);

/// Polygons (right, up, colour) of a piece, a blank line after each: edge, body, and a lighter strip along
/// the middle.
std::string tube_polygons(const TubePiece& piece, const Stroke& stroke);

/// gnuplot's style for them, and the command before.
inline constexpr const char* tube_fill = "  set style fill solid noborder\n";
inline constexpr const char* tube_style = "using 1:2:3 with filledcurves closed fc rgb variable notitle";

/// Colours of rods: one that touches nothing, and one under a pressure, as a share of the highest.
inline constexpr unsigned free_rod = 0xc9c7c1;
unsigned pressure_colour(double share);

/// The same colours as gnuplot's palette.
inline constexpr const char* pressure_palette =
    "defined (0 '#fde725', 0.33 '#f98e09', 0.66 '#bc3754', 1 '#57106e')";

}  // namespace windlass::output
