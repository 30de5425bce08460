#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "rod_projection.hpp"
#include "windlass/output/atomic_file.hpp"
#include "windlass/output/branches_csv.hpp"
#include "windlass/output/error.hpp"
#include "windlass/output/gnuplot.hpp"
#include "windlass/output/plot.hpp"

namespace windlass::output {

namespace fs = std::filesystem;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

/// Half width of the window round the cylinder [ρ]; tails go on outside.
constexpr double window = 2.6;

std::string line(std::initializer_list<double> values) {
  std::string text;
  for (const double value : values)
    text += (std::isfinite(value) ? format_number(value) : std::string("?")) + " ";
  return text + "\n";
}

std::string polygon(const std::vector<Vector2d>& points) {
  std::string text;
  for (const Vector2d& point : points) text += line({point.x(), point.y()});
  return text + "\n\n";
}

/// Blocks of one view: 0 visible rod and 1 hidden rod (right, up), 2 visible line contact (right, up, p), 3 point
/// forces (right, up, and the arrow), 4 outline of the cylinder, 5 its near rim.
///
/// gnuplot numbers blocks by the data they hold, so that an empty one still gets a line of missing values.
std::string view_data(const RodCurve& curve, const equilibrium::Solution& solution,
                      const std::vector<PointForce>& forces, const View& view, const Drum& drum,
                      double arrow) {
  std::string blocks[3] = {"# visible rod: right up\n", "# hidden rod: right up\n",
                           "# visible contact: right up p\n"};
  int drawn_as = -1;
  for (std::size_t i = 0; i < curve.r.size(); ++i) {
    const bool hidden = drum.hides(curve.r[i], view);
    const bool contact = solution.arcs[curve.arc[i]].kind == equilibrium::ArcKind::line;
    const Vector2d at = view.project(curve.r[i]);
    const int now = hidden ? 1 : contact ? 2 : 0;
    // a change of block: the old one still gets this place, to leave no hole, and then a break
    if (drawn_as >= 0 && now != drawn_as) blocks[drawn_as] += line({at.x(), at.y(), curve.p[i - 1]}) + "\n";
    blocks[now] += line({at.x(), at.y(), curve.p[i]});
    drawn_as = now;
  }
  std::string text;
  for (const std::string& block : blocks) text += block + "? ? ?\n\n\n";
  text += "# point forces: right up d_right d_up\n";
  if (forces.empty()) text += "? ? ? ?\n";
  for (const PointForce& force : forces) {
    const Vector2d at = view.project(force.r), d = view.project(force.direction) * arrow * force.size;
    text += line({at.x(), at.y(), d.x(), d.y()});
  }
  return text + "\n\n# cylinder\n" + polygon(drum.outline(view)) + "# near rim\n" +
         polygon(drum.rim(view, view.towards.z() >= 0.0 ? drum.high : drum.low));
}

/// Part of the picture plane that is shown.
struct Frame {
  double left = 0.0, right = 0.0, low = 0.0, high = 0.0;
};

/// Holds cylinder, forces and the rod near them, and has the given width/height.
Frame frame_of(const RodCurve& curve, const std::vector<PointForce>& forces, const View& view,
               const Drum& drum, double arrow, double aspect) {
  Eigen::AlignedBox2d box;
  for (const Vector2d& point : drum.outline(view)) box.extend(point);
  for (const PointForce& force : forces)
    box.extend(view.project(force.r + 1.1 * arrow * force.size * force.direction));
  for (const Vector3d& r : curve.r) {
    if (r.head<2>().lpNorm<Eigen::Infinity>() < window) box.extend(view.project(r));
  }
  const Vector2d centre = box.center();
  Vector2d half = 0.53 * box.sizes();
  half.x() = std::max(half.x(), half.y() * aspect);
  half.y() = half.x() / aspect;
  return {centre.x() - half.x(), centre.x() + half.x(), centre.y() - half.y(), centre.y() + half.y()};
}

/// Pressure along the rod: one block an arc in contact.
std::string pressure_data(const RodCurve& curve, const equilibrium::Solution& solution) {
  std::string text;
  for (std::size_t k = 0; k < solution.arcs.size(); ++k) {
    if (solution.arcs[k].kind != equilibrium::ArcKind::line) continue;
    text += "# line contact: s p\n";
    for (std::size_t i = 0; i < curve.s.size(); ++i) {
      if (curve.arc[i] == k) text += line({curve.s[i], curve.p[i]});
    }
    text += "\n";
  }
  return text.empty() ? "? ?\n" : text;
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

/// The same in newtons, grams and millimetres.
std::string physical_subtitle(const equilibrium::Solution& solution, const scene::Units& units,
                              double p_max) {
  char text[240];
  std::snprintf(text, sizeof text,
                "ρ = %.4g mm,  T = %.4g N (%.4g g hung),  R_{tot} = %.4g N,  p ≤ %.3g N/mm",
                units.length * 1e3, solution.T * units.force, solution.T * units.force / 9.80665e-3,
                solution.R_tot * units.force, p_max * units.pressure * 1e-3);
  std::string result = text;
  if (solution.F0) {
    std::snprintf(text, sizeof text, ",  F_0 = %.4g N", *solution.F0 * units.force);
    result += text;
  }
  return result;
}

std::string subtitle(const equilibrium::Solution& solution) {
  char text[200];
  if (solution.has_cylinder) {
    std::snprintf(text, sizeof text, "T = %.4g,  φ = %.4g°,  R_{tot} = %.5g,  φ^* = %.4g°", solution.T,
                  solution.phi * 180 / M_PI, solution.R_tot, solution.phi_star * 180 / M_PI);
  } else {
    std::snprintf(text, sizeof text, "shortening %.4g,  thrust %.5g,  axial moment %.4g", solution.shortening,
                  solution.end_force, solution.end_moment);
  }
  std::string result = text;
  if (solution.stability) result += ",  index " + std::to_string(solution.stability->index);
  return result;
}

/// p along s with the point forces as impulses on an axis of their own.
std::string pressure_commands(const equilibrium::Solution& solution, const std::string& stem, double p_max,
                              double f_max, const std::optional<scene::Units>& units) {
  double s_contact = 0.0;
  for (const PointForce& force : point_forces(solution)) s_contact = std::max(s_contact, std::abs(force.s));
  const double reach = std::max(1.1 * s_contact, 0.2);
  std::string text = "  unset colorbox\n  set size noratio\n  set border 11\n  set grid lc rgb '#dddddd'\n";
  text += "  set xtics nomirror font ',9'\n  set ytics nomirror font ',9'\n  set y2tics font ',9'\n";
  text += margins(0.11, 0.89, 0.125, 0.32);
  text += "  set xrange [" + format_number(-reach) + ":" + format_number(reach) + "]\n";
  text += "  set xlabel 'arclength s  [ρ]' offset 0,0.4\n";
  if (units) {
    const double mm = units->length * 1e3;
    text += "  set x2range [" + format_number(-reach * mm) + ":" + format_number(reach * mm) +
            "]\n  set x2tics font ',9' offset 0,-0.3\n  set x2label '[mm]' offset 0,-0.8\n  set border 15\n";
  }
  text += "  set yrange [0:" + format_number(p_max > 0 ? 1.15 * p_max : 1.0) +
          "]\n  set ylabel 'p  [EI/ρ³]' offset 1,0\n";
  if (!(p_max > 0)) text += "  unset ytics\n  unset ylabel\n";
  text += "  set y2range [0:" + format_number(f_max > 0 ? 1.25 * f_max : 1.0) +
          "]\n  set y2label 'point force f  [EI/ρ²]' offset -1,0 tc rgb '#c00000'\n";
  const std::string pressure = "'" + stem + "-pressure.dat'", forces = "'" + stem + "-forces.dat'";
  return text + "  plot " + pressure + " with filledcurves y1=0 lc rgb '#f3c6a5' notitle, \\\n    " +
         pressure + " with lines lc rgb '#bc3754' lw 1.8 notitle, \\\n    " + forces +
         " using 1:2 axes x1y2 with impulses lc rgb '#c00000' lw 2.5 notitle, \\\n    " + forces +
         " using 1:2 axes x1y2 with points pt 9 ps 0.8 lc rgb '#c00000' notitle\n";
}

std::string heading(const equilibrium::Solution& solution, const std::string& title, double p_max,
                    const std::optional<scene::Units>& units) {
  std::string text =
      "  set datafile missing '?'\n  set multiplot\n  unset key\n  unset tics\n  unset border\n";
  text += "  set label 1 " + gnuplot_text(title) + " at screen 0.5, screen 0.968 center font ',11'\n";
  text += "  set label 2 " + gnuplot_text(subtitle(solution), false) +
          " at screen 0.5, screen 0.925 center font ',9'\n";
  if (units)
    text += "  set label 3 " + gnuplot_text(physical_subtitle(solution, *units, p_max), false) +
            " at screen 0.5, screen 0.888 center font ',9'\n";
  text += "  set palette defined (0 '#fde725', 0.33 '#f98e09', 0.66 '#bc3754', 1 '#57106e')\n";
  text += "  set cbrange [0:" + format_number(p_max > 0 ? p_max : 1.0) + "]\n";
  if (!(p_max > 0)) return text + "  unset colorbox\n";
  return text + "  set cblabel 'pressure p  [EI/ρ³]' offset -0.6,0\n  set cbtics font ',8'\n" +
         "  set colorbox user origin screen 0.89, screen 0.47 size screen 0.018, screen 0.38\n";
}

/// 1, 2 or 5 times a power of ten, at least `least`.
double nice_step(double least) {
  const double decade = std::pow(10.0, std::floor(std::log10(std::max(least, 1e-12))));
  for (const double digit : {1.0, 2.0, 5.0})
    if (digit * decade >= least * (1 - 1e-9)) return digit * decade;
  return 10.0 * decade;
}

/// As high as long: a loop, whose views stand side by side.
bool strut_is_tall(const equilibrium::Solution& solution, const RodCurve& curve) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& r : curve.r) box.extend(r);
  return solution.z_span >= 1e-6 && std::max(box.sizes().y(), box.sizes().z()) > 0.6 * box.sizes().x();
}

/// A strut has no cylinder: one side view, or two of equal scale when it leaves its plane.
std::string strut_commands(const equilibrium::Solution& solution, const RodCurve& curve,
                           const std::string& title, const std::string& stem) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& r : curve.r) box.extend(r);
  const bool planar = solution.z_span < 1e-6, tall = strut_is_tall(solution, curve);
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
  text += "  set label 2 " + gnuplot_text(subtitle(solution), false) +
          " at screen 0.5, screen 0.91 center font ',9'\n";
  text += range("xrange", box.min().x() - margin, box.max().x() + margin) + "  set xlabel 'x  [ρ]'\n";
  for (int k = 1; k <= (planar ? 1 : 2); ++k) {
    text += range("yrange", box.center()[k] - half, box.center()[k] + half) + "  set ylabel '" +
            (k == 1 ? "y" : "z") + "  [ρ]'\n  plot '" + stem +
            "-curve.dat' using 2:" + std::to_string(k + 2) +
            " with lines lc rgb '#303030' lw 3\n  unset label\n";
  }
  return text + "  unset multiplot\n";
}

}  // namespace

std::vector<fs::path> plot_rod(const equilibrium::Solution& solution, const std::string& title,
                               const PlotOptions& options, const fs::path& folder, const std::string& stem) {
  if (solution.arcs.empty()) throw OutputError("the point " + stem + " holds no rod to draw");
  const double length = solution.arcs.back().s.tail<1>()[0] - solution.arcs.front().s[0];
  const RodCurve curve = dense_curve(solution, std::min(0.03, std::max(length, 1e-3) / 300.0));
  const auto write = [&](const char* suffix, const std::string& text) {
    replace_file(folder / (stem + suffix), std::string_view(text));
  };
  std::string rows = "# s x y z p\n";
  for (std::size_t i = 0; i < curve.s.size(); ++i) {
    rows += line({curve.s[i], curve.r[i].x(), curve.r[i].y(), curve.r[i].z(), curve.p[i]});
  }
  write("-curve.dat", rows);
  if (!solution.has_cylinder)
    return run_gnuplot({stem, strut_is_tall(solution, curve) ? 8.4 : 7.0,
                        solution.z_span < 1e-6           ? 4.2
                        : strut_is_tall(solution, curve) ? 4.8
                                                         : 5.6,
                        strut_commands(solution, curve, title, stem)},
                       folder, options.formats);

  const bool planar = solution.z_span < 1e-6;
  const std::vector<PointForce> forces = point_forces(solution);
  double f_max = 0.0, p_max = 0.0;
  for (const PointForce& force : forces) f_max = std::max(f_max, force.size);
  for (const double p : curve.p) p_max = std::max(p_max, p);
  std::string impulses = "# s f\n";
  for (const PointForce& force : forces) impulses += line({force.s, force.size});
  write("-forces.dat", forces.empty() ? "? ?\n" : impulses);
  write("-pressure.dat", pressure_data(curve, solution));

  const double arrow = f_max > 0.0 ? 0.8 / f_max : 0.0;
  const Drum drum = drum_for(curve);
  const View axis = View::along_axis(), side = View::from(-M_PI / 2 + 0.5, 0.35);
  Picture picture{stem, planar ? 7.0 : 8.5, 6.0, heading(solution, title, p_max, options.units)};
  const auto panel = [&](const char* suffix, const View& view, bool with_rim, double left, double right) {
    const double low = 0.42, high = options.units ? 0.86 : 0.90;
    const double aspect = (right - left) * picture.width / ((high - low) * picture.height);
    write(suffix, view_data(curve, solution, forces, view, drum, arrow));
    picture.body +=
        margins(left, right, low, high) +
        view_commands(stem + suffix, with_rim, frame_of(curve, forces, view, drum, arrow, aspect));
    picture.body += "  unset label\n";
  };
  panel("-axis.dat", axis, false, planar ? 0.13 : 0.03, planar ? 0.87 : 0.44);
  if (!planar) panel("-side.dat", side, true, 0.46, 0.87);
  picture.body += pressure_commands(solution, stem, p_max, f_max, options.units) + "  unset multiplot\n";
  return run_gnuplot(picture, folder, options.formats);
}

}  // namespace windlass::output
