#include "pressure_profile.hpp"

#include <algorithm>
#include <cmath>

#include "windlass/output/branches_csv.hpp"
#include "windlass/output/gnuplot.hpp"

namespace windlass::output {

Heights heights_of(const RodCurve& curve, const std::vector<PointForce>& forces) {
  Heights heights;
  for (const PointForce& force : forces) heights.force = std::max(heights.force, force.size);
  for (const double p : curve.p) heights.pressure = std::max(heights.pressure, p);
  return heights;
}

std::string pressure_data(const RodCurve& curve, const equilibrium::Solution& solution) {
  std::string text;
  for (std::size_t k = 0; k < solution.arcs.size(); ++k) {
    if (solution.arcs[k].kind != equilibrium::ArcKind::line) continue;
    text += "# line contact: s p\n";
    for (std::size_t i = 0; i < curve.s.size(); ++i) {
      if (curve.arc[i] == k) text += data_line({curve.s[i], curve.p[i]});
    }
    text += "\n";
  }
  return text.empty() ? "? ?\n" : text;
}

std::string force_data(const std::vector<PointForce>& forces) {
  if (forces.empty()) return "? ? ?\n";
  std::string text = "# s f colour\n";
  for (const PointForce& force : forces)
    text += data_line({force.s, force.size, static_cast<double>(force_colour(force))});
  return text;
}

std::string pressure_commands(const std::vector<PointForce>& point_forces, const std::string& stem,
                              const Heights& heights, const std::optional<scene::Units>& units) {
  const double p_max = heights.pressure, f_max = heights.force;
  double s_contact = 0.0;
  for (const PointForce& force : point_forces) s_contact = std::max(s_contact, std::abs(force.s));
  const double reach = std::max(1.1 * s_contact, 0.2);
  std::string text = "  unset colorbox\n  set size noratio\n  set border 11\n  set grid lc rgb '#dddddd'\n";
  text += "  set xtics nomirror font ',9'\n  set ytics nomirror font ',9'\n  set y2tics font ',9'\n";
  text += margins(0.13, 0.87, 0.125, 0.32);
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
  if (std::any_of(point_forces.begin(), point_forces.end(),
                  [](const auto& f) { return f.partner.has_value(); }))
    text += "  set label 4 'blue: between strands' at graph 1, graph -0.33 right font ',9' tc " +
            std::string("rgb '#0072b2'\n");
  const std::string pressure = "'" + stem + "-pressure.dat'", forces = "'" + stem + "-forces.dat'";
  return text + "  plot " + pressure + " with filledcurves y1=0 lc rgb '#f3c6a5' notitle, \\\n    " +
         pressure + " with lines lc rgb '#bc3754' lw 1.8 notitle, \\\n    " + forces +
         " using 1:2:3 axes x1y2 with impulses lc rgb variable lw 2.5 notitle, \\\n    " + forces +
         " using 1:2:3 axes x1y2 with points pt 9 ps 0.8 lc rgb variable notitle\n";
}

}  // namespace windlass::output
