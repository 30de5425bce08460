#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "pressure_profile.hpp"
#include "rod_views.hpp"
#include "strut_picture.hpp"
#include "windlass/output/atomic_file.hpp"
#include "windlass/output/branches_csv.hpp"
#include "windlass/output/error.hpp"
#include "windlass/output/gnuplot.hpp"
#include "windlass/output/plot.hpp"

namespace windlass::output {

namespace fs = std::filesystem;

namespace {

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

std::string heading(const equilibrium::Solution& solution, const std::string& title, double p_max,
                    const std::optional<scene::Units>& units) {
  std::string text =
      "  set datafile missing '?'\n  set multiplot\n  unset key\n  unset tics\n  unset border\n";
  constexpr int usual = 11, least = 6, letters = 85;  // that the width holds at the usual size
  const int size = std::clamp(usual * letters / std::max(1, static_cast<int>(title.size())), least, usual);
  text += "  set label 1 " + gnuplot_text(title) + " at screen 0.5, screen 0.968 center font '," +
          std::to_string(size) + "'\n";
  text += "  set label 2 " + gnuplot_text(subtitle(solution), false) +
          " at screen 0.5, screen 0.925 center font ',9'\n";
  if (units)
    text += "  set label 3 " + gnuplot_text(physical_subtitle(solution, *units, p_max), false) +
            " at screen 0.5, screen 0.888 center font ',9'\n";
  text += std::string("  set palette ") + pressure_palette + "\n";
  text += "  set cbrange [0:" + format_number(p_max > 0 ? p_max : 1.0) + "]\n";
  if (!(p_max > 0)) return text + "  unset colorbox\n";
  return text + "  set cblabel 'pressure p  [EI/ρ³]' offset 0.2,0\n  set cbtics font ',8'\n" +
         "  set colorbox user origin screen 0.89, screen 0.47 size screen 0.018, screen 0.38\n";
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
  for (std::size_t i = 0; i < curve.s.size(); ++i)
    rows += data_line({curve.s[i], curve.r[i].x(), curve.r[i].y(), curve.r[i].z(), curve.p[i]});
  write("-curve.dat", rows);
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& r : curve.r) box.extend(r);
  const double capstan_width = 6.0;  // [ρ], about that of a view
  const Stroke stroke =
      stroke_of(options.rod_radius, solution.has_cylinder ? capstan_width : 1.2 * box.sizes().maxCoeff());
  if (!solution.has_cylinder) {
    for (const int view : {1, 2})
      if (stroke.radius > 0.0)
        write(view == 1 ? "-tube-1.dat" : "-tube-2.dat", strut_tube(curve, stroke, view));
    return run_gnuplot(
        strut_picture(solution, curve, options.obstacles, stroke, title, subtitle(solution), stem), folder,
        options.formats);
  }

  const std::vector<PointForce> forces = point_forces(solution);
  const Heights heights = heights_of(curve, forces);
  write("-forces.dat", force_data(forces));
  write("-pressure.dat", pressure_data(curve, solution));
  const RodScene rod{curve,
                     solution,
                     forces,
                     drum_for(curve, options.rod_radius),
                     heights.force > 0.0 ? 0.8 / heights.force : 0.0,
                     heights.pressure,
                     stroke,
                     options.plates};
  const bool planar = solution.z_span < 1e-6;
  Picture picture{stem, planar ? 7.0 : 8.5, 6.0, heading(solution, title, heights.pressure, options.units)};
  const auto panel = [&](const char* suffix, const View& view, bool with_rim, double left, double right) {
    const double low = 0.42, high = options.units ? 0.86 : 0.90;
    const double aspect = (right - left) * picture.width / ((high - low) * picture.height);
    write(suffix, view_data(rod, view));
    picture.body += margins(left, right, low, high) +
                    view_commands(rod, stem + suffix, with_rim, frame_of(rod, view, aspect));
    picture.body += "  unset label\n  unset colorbox\n";  // once a picture
  };
  panel("-axis.dat", View::along_axis(), false, planar ? 0.13 : 0.03, planar ? 0.87 : 0.44);
  if (!planar) panel("-side.dat", side_view(rod), true, 0.46, 0.87);
  picture.body += pressure_commands(forces, stem, heights, options.units) + "  unset multiplot\n";
  return run_gnuplot(picture, folder, options.formats);
}

}  // namespace windlass::output
