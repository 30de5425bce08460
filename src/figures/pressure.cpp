#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "contact_cell.hpp"
#include "style.hpp"
#include "windlass/output/gnuplot.hpp"
#include "windlass/rod/capstan.hpp"

namespace windlass::figures {

namespace capstan = rod::capstan;
using Verdict = Statement::Verdict;

namespace {

std::string pressure_panel(const ContactCell& cell, int row, int column) {
  const double left = column == 0 ? 0.08 : 0.56, top = 0.93 - 0.31 * row;
  const equilibrium::Solution& state = cell.state;
  std::string text = output::margins(left, left + 0.35, top - 0.225, top) + contact_heading(cell);
  text += fmt::format("  set label 52 'T = {:g}' at graph 0.03, graph 0.88 left font ',10'\n", state.T);
  text += fmt::format("  set yrange [0:{}]\n  set y2range [0:{}]\n",
                      cell.highest_pressure > 0.0 ? 1.45 * cell.highest_pressure : 1.0,
                      cell.highest_force > 0.0 ? 1.45 * cell.highest_force : 1.0);
  text += column == 0 ? "  set ylabel 'p  [EI/ρ³]' offset 1,0\n  unset y2label\n"
                      : "  unset ylabel\n  set y2label 'f  [EI/ρ²]' offset -1,0 tc rgb '#c00000'\n";
  text += row == 2 ? "  set xlabel 'place round the axis θ / π'\n" : "  unset xlabel\n";
  if (cell.highest_pressure > 0.0)
    text += "  set ytics auto nomirror font ',9'\n";
  else
    text += "  unset ytics\n";
  text += flat_contact_band(state);
  text += fmt::format(
      "  plot '{0}.dat' index 0 using 1:2 with filledcurves y1=0 lc rgb '#f3c6a5', \\\n"
      "    '{0}.dat' index 0 using 1:2 with lines lw 1.8 lc rgb '#bc3754', \\\n"
      "    '{0}.dat' index 1 using 1:2 axes x1y2 with impulses lw 2.5 lc rgb '#c00000', \\\n"
      "    '{0}.dat' index 1 using 1:2 axes x1y2 with points pt 9 ps 0.8 lc rgb '#c00000'\n",
      cell.stem);
  return text + "  unset label 60\n  unset label 61\n";
}

std::vector<Statement> pressure_statements(const std::vector<ContactCell>& cells) {
  const ContactCell &loose_pi = cells[0], &loose_turn = cells[1], &middle_turn = cells[3],
                    &tight_turn = cells[5];
  const auto joint_force = [](const ContactCell& cell) {
    return cell.highest_force / std::max(cell.highest_pressure, 1e-300);
  };
  return {
      {"π begins with a single-point contact that grows into a line from T = 0.5",
       "at T = 0.3 the contact is: " + loose_pi.state.topology, Verdict::agrees, ""},
      {"2π is helical at T = 0.3", "contact " + loose_turn.state.topology, Verdict::agrees, ""},
      {"2π is planar for T ≥ 0.5, so at 0.9",
       fmt::format("helical at T = 0.9, tilt {:.1f}°, height {:.2f} ρ; its contact covers ±{:.3f} π, the "
                   "flat coil's ±{:.3f} π",
                   middle_turn.state.tilt * 180.0 / M_PI, middle_turn.state.z_span,
                   middle_turn.state.phi_star / M_PI, capstan::phi_star(0.9, 2.0 * M_PI) / M_PI),
       Verdict::differs,
       "the flat coil at T = 0.9 exists, but a thin rod without plates, friction or thickness leaves it (see "
       "the "
       "strength figure)"},
      {"the pressure is not uniform: it has a maximum near the ends of the wrap, which flattens as T grows",
       fmt::format(
           "point forces at the ends over the pressure, f/p: {:.3f} at T = 0.9, {:.3f} at T = 7 (2π). The "
           "pressure itself is uniform in a flat coil and largest in the middle of a helix",
           joint_force(middle_turn), joint_force(tight_turn)),
       Verdict::agrees, ""},
      {"contact zones of the simulations reach beyond the grey bands", "at T = 7 the contact is the band",
       Verdict::differs, "cross-sections do not deform here"}};
}

}  // namespace

Figure pressure(const Study& study, const Canvas& canvas) {
  output::Picture picture{"pressure", 9.0, 7.4, opening};
  picture.body +=
      "  unset key\n  set border 11\n  set xrange [-1:1]\n  set xtics 0.5 nomirror\n  set ytics nomirror\n"
      "  set y2tics font ',9'\n";
  picture.body += column_titles(0.255, 0.735);
  const std::vector<ContactCell> cells = contact_cells(study, canvas);
  for (std::size_t k = 0; k < cells.size(); ++k)
    picture.body += pressure_panel(cells[k], static_cast<int>(k / 2), static_cast<int>(k % 2));
  picture.body += "  unset multiplot\n";
  output::run_gnuplot(picture, canvas.folder, canvas.formats);
  return {
      "pressure",
      "Contact force along the contact (the paper's “Graphical illustration of the contact interface”, a, b)",
      "Stable states. Filled: pressure p; red arrows: point forces f (right axis). Grey band: contact of the "
      "flat coil "
      "after the closed form.",
      {"pi", "2pi"},
      pressure_statements(cells)};
}

}  // namespace windlass::figures
