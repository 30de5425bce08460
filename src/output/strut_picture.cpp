#include "strut_picture.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "pressure_profile.hpp"
#include "sheet.hpp"
#include "windlass/output/branches_csv.hpp"

namespace windlass::output {

using Eigen::Vector3d;

namespace {

/// 1, 2 or 5 times a power of ten, at least `least`.
double nice_step(double least) {
  const double decade = std::pow(10.0, std::floor(std::log10(std::max(least, 1e-12))));
  for (const double digit : {1.0, 2.0, 5.0})
    if (digit * decade >= least * (1 - 1e-9)) return digit * decade;
  return 10.0 * decade;
}

/// As high as long: a loop, whose views stand side by side.
bool is_tall(const equilibrium::Solution& solution, const Eigen::AlignedBox3d& box) {
  return solution.z_span >= 1e-6 && std::max(box.sizes().y(), box.sizes().z()) > 0.6 * box.sizes().x();
}

/// Point forces as arrows from the rod's surface, and the places where strands touch, as gnuplot objects of a
/// view.
std::string force_objects(const equilibrium::Solution& solution, double rod_radius, double size, int up) {
  const auto place = [&](const Vector3d& r) { return format_number(r.x()) + "," + format_number(r[up]); };
  const std::vector<PointForce> forces = point_forces(solution);
  double largest = 0.0;
  for (const PointForce& force : forces) largest = std::max(largest, force.size);
  std::string text;
  for (const PointForce& force : forces) {
    const Vector3d from = force.r + rod_radius * force.direction,
                   arrow = 0.12 * size * force.size / largest * force.direction;
    constexpr double points_at_the_eye = 0.01;
    if (force.size > 0.0 && std::hypot(arrow.x(), arrow[up]) > points_at_the_eye * size)
      text += "  set arrow from " + place(from) + " to " + place(from + arrow) +
              " front head filled size screen 0.012,20 lw 2 " +
              (force.partner ? strand_force_style : "lc rgb '#c00000'") + "\n";
    const std::string touch = place(force.r - rod_radius * force.direction);
    if (force.partner && force.s < *force.partner)
      text += "  set label '' at " + touch + " front point pt 7 ps 0.9 lc rgb 'white'\n  set label '' at " +
              touch + " front point pt 6 ps 0.9 lw 2 " + strand_force_style + "\n";
  }
  return text;
}

/// Obstacles as gnuplot objects of the view of x and coordinate `up`.
std::string surroundings(const obstacle::Set& obstacles, double rod_radius, const Eigen::AlignedBox3d& box,
                         int up) {
  std::string text = "  unset arrow\n";
  const auto place = [&](const Vector3d& r) { return format_number(r.x()) + "," + format_number(r[up]); };
  for (int o = 0; o < obstacles.size(); ++o) {
    const std::vector<Vector3d> sheet = sheet_of(obstacles[o], box, rod_radius);
    if (sheet.empty()) continue;
    const Vector3d normal = obstacles[o].normal(sheet[0]);
    constexpr double from_the_side = 1e-9;
    if (std::abs(normal[3 - up]) > from_the_side) continue;
    text +=
        "  set arrow from " + place(sheet[0]) + " to " + place(sheet[1]) + " nohead lc rgb '#9a9aa4' lw 4\n";
  }
  return text;
}

}  // namespace

Picture strut_picture(const equilibrium::Solution& solution, const RodCurve& curve,
                      const obstacle::Set& obstacles, const Stroke& stroke, const std::string& title,
                      const std::string& subtitle, const std::string& stem) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& r : curve.r) box.extend(r);
  const Eigen::AlignedBox3d rod = box;
  for (int o = 0; o < obstacles.size(); ++o)  // those near the rod are in the picture
    for (const Vector3d& corner : sheet_of(obstacles[o], rod, stroke.radius))
      if (std::abs(corner.y()) < 0.5 * rod.sizes().x())
        box.extend(Vector3d(rod.center().x(), corner.y(), 0.0));
  const bool planar = solution.z_span < 1e-6, tall = is_tall(solution, box);
  const double margin = 0.08 * box.sizes().maxCoeff(),
               half = 0.5 * std::max(box.sizes().y(), planar ? 0.0 : box.sizes().z()) + margin;
  const auto range = [](const char* name, double low, double high) {
    return std::string("  set ") + name + " [" + format_number(low) + ":" + format_number(high) + "]\n";
  };
  const double tic = nice_step(box.sizes().maxCoeff() / 4.0);
  std::string text = std::string("  set multiplot layout ") +
                     (planar ? "1,1"
                      : tall ? "1,2"
                             : "2,1") +
                     " margins screen 0.11,0.96,0.14,0.86 " +
                     "spacing screen 0.12\n  unset key\n  set size ratio -1\n  set grid lc rgb '#dddddd'\n";
  text += "  set xtics " + format_number(tic) + "\n  set ytics " + format_number(tic) + "\n";
  text += "  set label 1 " + gnuplot_text(title) + " at screen 0.5, screen 0.965 center font ',11'\n";
  text += "  set label 2 " + gnuplot_text(subtitle, false) + " at screen 0.5, screen 0.91 center font ',9'\n";
  text +=
      tube_fill + range("xrange", box.min().x() - margin, box.max().x() + margin) + "  set xlabel 'x  [ρ]'\n";
  for (int k = 1; k <= (planar ? 1 : 2); ++k) {
    text += surroundings(obstacles, stroke.radius, rod, k) +
            force_objects(solution, stroke.radius, rod.sizes().maxCoeff(), k);
    text += range("yrange", box.center()[k] - half, box.center()[k] + half) + "  set ylabel '" +
            (k == 1 ? "y" : "z") + "  [ρ]'\n  plot '" + stem;
    text += stroke.radius > 0.0
                ? "-tube-" + std::to_string(k) + ".dat' " + tube_style
                : "-curve.dat' using 2:" + std::to_string(k + 2) + " with lines lc rgb '#303030' lw 3";
    text += "\n  unset label\n";
  }
  return {stem, tall ? 8.4 : 7.0, planar ? 4.2 : tall ? 4.8 : 5.6, text + "  unset multiplot\n"};
}

std::string strut_tube(const RodCurve& curve, const Stroke& stroke, int view) {
  const View along_z = View::along_axis(), along_y{-Vector3d::UnitY(), Vector3d::UnitX(), Vector3d::UnitZ()};
  std::string text = "# tube: right up colour\n";
  for (const TubePiece& piece :
       tube_pieces(curve, stroke.radius, view == 1 ? along_z : along_y, [](std::size_t) { return free_rod; }))
    text += tube_polygons(piece, stroke);
  return text;
}

}  // namespace windlass::output
