#include "rod_views.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "windlass/output/branches_csv.hpp"
#include "windlass/output/gnuplot.hpp"

namespace windlass::output {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

/// Half width of the window round the cylinder [ρ]; tails go on outside.
constexpr double window = 2.6;

std::string polygon(const std::vector<Vector2d>& points) {
  std::string text;
  for (const Vector2d& point : points) text += data_line({point.x(), point.y()});
  return text + "\n\n";
}

}  // namespace

std::string view_data(const RodScene& scene, const View& view) {
  const auto& [curve, solution, forces, drum, arrow] = scene;
  std::string blocks[3] = {"# visible rod: right up\n", "# hidden rod: right up\n",
                           "# visible contact: right up p\n"};
  int drawn_as = -1;
  for (std::size_t i = 0; i < curve.r.size(); ++i) {
    const bool hidden = drum.hides(curve.r[i], view);
    const bool contact = solution.arcs[curve.arc[i]].kind == equilibrium::ArcKind::line;
    const Vector2d at = view.project(curve.r[i]);
    const int now = hidden ? 1 : contact ? 2 : 0;
    // a change of block: the old one still gets this place, to leave no hole, and then a break
    if (drawn_as >= 0 && now != drawn_as)
      blocks[drawn_as] += data_line({at.x(), at.y(), curve.p[i - 1]}) + "\n";
    blocks[now] += data_line({at.x(), at.y(), curve.p[i]});
    drawn_as = now;
  }
  std::string text;
  for (const std::string& block : blocks) text += block + "? ? ?\n\n\n";
  text += "# point forces: right up d_right d_up\n";
  if (forces.empty()) text += "? ? ? ?\n";
  for (const PointForce& force : forces) {
    const Vector2d at = view.project(force.r), d = view.project(force.direction) * arrow * force.size;
    text += data_line({at.x(), at.y(), d.x(), d.y()});
  }
  return text + "\n\n# cylinder\n" + polygon(drum.outline(view)) + "# near rim\n" +
         polygon(drum.rim(view, view.towards.z() >= 0.0 ? drum.high : drum.low));
}

Frame frame_of(const RodScene& scene, const View& view, double aspect) {
  Eigen::AlignedBox2d box;
  for (const Vector2d& point : scene.drum.outline(view)) box.extend(point);
  for (const PointForce& force : scene.forces)
    box.extend(view.project(force.r + 1.1 * scene.arrow * force.size * force.direction));
  for (const Vector3d& r : scene.curve.r) {
    if (r.head<2>().lpNorm<Eigen::Infinity>() < window) box.extend(view.project(r));
  }
  const Vector2d centre = box.center();
  Vector2d half = 0.53 * box.sizes();
  half.x() = std::max(half.x(), half.y() * aspect);
  half.y() = half.x() / aspect;
  return {centre.x() - half.x(), centre.x() + half.x(), centre.y() - half.y(), centre.y() + half.y()};
}

std::string view_commands(const std::string& file, bool with_rim, const Frame& frame) {
  const std::string data = "'" + file + "'", next = ", \\\n    " + data;
  std::string text = "  set xrange [" + format_number(frame.left) + ":" + format_number(frame.right) +
                     "]\n  set yrange [" + format_number(frame.low) + ":" + format_number(frame.high) +
                     "]\n  set size ratio -1\n";
  text += "  plot " + data + " index 4 with filledcurves closed notitle lc rgb '#e8e8ec'";
  text += next + " index 4 with lines notitle lc rgb '#9a9aa4' lw 1";
  if (with_rim) text += next + " index 5 with lines notitle lc rgb '#9a9aa4' lw 1";
  text += next + " index 1 using 1:2 with lines notitle lc rgb '#8a8a8a' lw 1.3 dt (4,4)";
  text += next + " index 0 using 1:2 with lines notitle lc rgb '#303030' lw 3.2";
  text += next + " index 2 using 1:2:3 with lines notitle lc palette lw 4.2";
  text +=
      next +
      " index 3 using 1:2:3:4 with vectors notitle head filled size screen 0.012,20 lc rgb '#c00000' lw 2";
  return text + "\n";
}

}  // namespace windlass::output
