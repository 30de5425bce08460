#include "rod_views.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Geometry>

#include "pressure_profile.hpp"
#include "windlass/output/branches_csv.hpp"
#include "windlass/output/gnuplot.hpp"

namespace windlass::output {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

/// Half width of the window round the cylinder [ρ]; tails go on outside.
constexpr double window = 2.6;

/// Arrows shorter than this point at the eye [ρ].
constexpr double shortest_arrow = 0.05;

std::string polygon(const std::vector<Vector2d>& points) {
  std::string text;
  for (const Vector2d& point : points) text += data_line({point.x(), point.y()});
  return text + "\n\n";
}

bool is_line(const RodScene& scene, std::size_t place) {
  return scene.solution.arcs[scene.curve.arc[place]].kind == equilibrium::ArcKind::line;
}

/// A rod without thickness: its visible and hidden parts, and the visible line contacts.
std::array<std::string, 3> line_blocks(const RodScene& scene, const View& view) {
  const RodCurve& curve = scene.curve;
  std::array<std::string, 3> blocks = {"# visible rod: right up\n", "# hidden rod: right up\n",
                                       "# visible contact: right up p\n"};
  std::size_t drawn_as = 3;
  for (std::size_t i = 0; i < curve.r.size(); ++i) {
    const Vector2d at = view.project(curve.r[i]);
    const std::size_t now = scene.drum.hides(curve.r[i], view) ? 1 : is_line(scene, i) ? 2 : 0;
    // a change of block: the old one still gets this place, to leave no hole, and then a break
    if (drawn_as < 3 && now != drawn_as)
      blocks[drawn_as] += data_line({at.x(), at.y(), curve.p[i - 1]}) + "\n";
    blocks[now] += data_line({at.x(), at.y(), curve.p[i]});
    drawn_as = now;
  }
  return blocks;
}

/// A thick rod: its tube before the cylinder and after it, and the centre line where the cylinder hides it.
std::array<std::string, 3> tube_blocks(const RodScene& scene, const View& view) {
  const RodCurve& curve = scene.curve;
  std::array<std::string, 3> blocks = line_blocks(scene, view);
  blocks[0] = "# tube before the cylinder: right up colour\n";
  blocks[2] = "# tube after the cylinder: right up colour\n";
  const auto colour = [&](std::size_t place) {
    return is_line(scene, place) ? pressure_colour(curve.p[place] / scene.highest_pressure) : free_rod;
  };
  for (const TubePiece& piece : tube_pieces(curve, scene.stroke.radius, view, colour))
    if (piece.middle.head<2>().lpNorm<Eigen::Infinity>() < 2.0 * window)
      blocks[scene.drum.covers(piece.middle, view) ? 0 : 2] += tube_polygons(piece, scene.stroke);
  return blocks;
}

/// Where it shows, the edge of the plate, or of a larger one a circle on it that is as wide as the window.
std::string plate_edge(const scene::Plate& plate, const Drum& drum, const View& view) {
  constexpr int sides = 240;
  const double radius = std::min(plate.outer_radius, window);
  std::string text;
  bool broken = true;  // two empty lines would begin another block
  for (int k = 0; k <= sides; ++k) {
    const double a = 2.0 * M_PI * k / sides;
    const Vector3d at(radius * std::cos(a), radius * std::sin(a), plate.height);
    const Vector2d shown = view.project(at);
    const bool hidden = drum.hides(at, view);
    if (!hidden)
      text += data_line({shown.x(), shown.y()});
    else if (!broken)
      text += "\n";
    broken = hidden;
  }
  return text;
}

}  // namespace

std::string view_data(const RodScene& scene, const View& view) {
  const auto blocks = scene.is_thick() ? tube_blocks(scene, view) : line_blocks(scene, view);
  std::string text;
  for (const std::string& block : blocks) text += block + "? ? ?\n\n\n";
  text += "# point forces: right up d_right d_up colour\n? ? ? ? ?\n";
  std::string touches = "# strands touch: right up\n? ?\n";
  for (const PointForce& force : scene.forces) {
    const Vector2d at = view.project(force.r + scene.stroke.radius * force.direction),
                   d = view.project(force.direction) * scene.arrow * force.size;
    if (d.norm() > shortest_arrow)
      text += data_line({at.x(), at.y(), d.x(), d.y(), static_cast<double>(force_colour(force))});
    const Vector3d touch = force.r - scene.stroke.radius * force.direction;
    if (force.partner && !scene.drum.hides(touch, view))
      touches += data_line({view.project(touch).x(), view.project(touch).y()});
  }
  const Drum& drum = scene.drum;
  std::string plates;
  for (const scene::Plate& plate : scene.plates)  // one block
    plates += (plates.empty() ? "\n\n# plate: right up\n" : "\n") + plate_edge(plate, drum, view);
  return text + "\n\n# cylinder\n" + polygon(drum.outline(view)) + "# near rim\n" +
         polygon(drum.rim(view, view.towards.z() >= 0.0 ? drum.high : drum.low)) + touches + plates;
}

View side_view(const RodScene& scene) {
  Vector2d towards = Vector2d::Zero();
  for (const PointForce& force : scene.forces)
    if (force.partner) towards += force.r.head<2>();
  constexpr double turned = 0.5, elevation = 0.35;
  const double azimuth = towards.norm() > 0.1 ? std::atan2(towards.y(), towards.x()) : -M_PI / 2;
  return View::from(azimuth + turned, elevation);
}

Frame frame_of(const RodScene& scene, const View& view, double aspect) {
  Eigen::AlignedBox2d box;
  const Vector2d around = Vector2d::Constant(scene.stroke.radius);
  for (const Vector2d& point : scene.drum.outline(view)) box.extend(point);
  for (const PointForce& force : scene.forces)
    box.extend(
        view.project(force.r + (scene.stroke.radius + 1.1 * scene.arrow * force.size) * force.direction));
  for (const Vector3d& r : scene.curve.r)
    if (r.head<2>().lpNorm<Eigen::Infinity>() < window)
      box.extend(view.project(r) - around), box.extend(view.project(r) + around);
  const Vector2d centre = box.center();
  Vector2d half = 0.53 * box.sizes();
  half.x() = std::max(half.x(), half.y() * aspect);
  half.y() = half.x() / aspect;
  return {centre.x() - half.x(), centre.x() + half.x(), centre.y() - half.y(), centre.y() + half.y()};
}

std::string view_commands(const RodScene& scene, const std::string& file, bool with_rim, const Frame& frame) {
  const std::string data = "'" + file + "'", next = ", \\\n    " + data;
  std::string text = "  set xrange [" + format_number(frame.left) + ":" + format_number(frame.right) +
                     "]\n  set yrange [" + format_number(frame.low) + ":" + format_number(frame.high) +
                     "]\n  set size ratio -1\n" + tube_fill;
  // without the last item there is no colour box beside a tube
  text += scene.is_thick()
              ? "  plot " + data + " index 0 " + tube_style + ", NaN with lines notitle lc palette" + next
              : "  plot " + data;
  text += " index 4 with filledcurves closed notitle lc rgb '#e8e8ec'";
  text += next + " index 4 with lines notitle lc rgb '#9a9aa4' lw 1";
  if (with_rim) text += next + " index 5 with lines notitle lc rgb '#9a9aa4' lw 1";
  if (!scene.plates.empty() && with_rim) text += next + " index 7 with lines notitle lc rgb '#b4b4be' lw 1.2";
  text += next + " index 1 using 1:2 with lines notitle lc rgb '#8a8a8a' lw 1.3 dt (4,4)";
  if (scene.is_thick()) {
    text += next + " index 2 " + tube_style;
  } else {
    text += next + " index 0 using 1:2 with lines notitle lc rgb '#303030' lw 3.2";
    text += next + " index 2 using 1:2:3 with lines notitle lc palette lw 4.2";
  }
  text +=
      next +
      " index 3 using 1:2:3:4:5 with vectors notitle head filled size screen 0.012,20 lc rgb variable lw 2";
  text += next + " index 6 using 1:2 with points notitle pt 7 ps 0.9 lc rgb 'white'";
  text += next + " index 6 using 1:2 with points notitle pt 6 ps 0.9 lw 2 " + strand_force_style;
  return text + "\n";
}

}  // namespace windlass::output
