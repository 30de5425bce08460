#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "contact_cell.hpp"
#include "style.hpp"
#include "windlass/output/gnuplot.hpp"
#include "windlass/rod/capstan.hpp"

namespace windlass::figures {

using Verdict = Statement::Verdict;

namespace {

/// Of a disc that stands for f = T.
constexpr double disc = 2.2;

std::string map_panel(const ContactCell& cell, int row, int column) {
  const double left = column == 0 ? 0.075 : 0.485, top = 0.93 - 0.29 * row, T = cell.state.T;
  std::string text = output::margins(left, left + 0.37, top - 0.215, top) + contact_heading(cell);
  text += fmt::format("  set label 52 'T = {:g}' at graph 0.03, graph 0.88 left font ',10'\n", T);
  text += column == 0 ? "  set ylabel 'z / ρ' offset 1,0\n" : "  unset ylabel\n";
  text += row == 2 ? "  set xlabel 'place round the axis θ / π'\n" : "  unset xlabel\n";
  text += row == 2 && column == 1
              ? "  set colorbox user origin screen 0.885, screen 0.35 size screen 0.018, screen 0.58\n"
              : "  unset colorbox\n";
  text += flat_contact_band(cell.state);
  text += fmt::format(
      "  plot '{0}.dat' index 2 using 1:2 with lines lw 1.5 dt (6,4) lc rgb '#808080', \\\n"
      "    '{0}.dat' index 0 using 1:3:($2/{1}) with lines lw 7 lc palette, \\\n"
      "    '{0}.dat' index 1 using 1:3:({2}*sqrt($2/{1})) with points pt 7 ps variable lc rgb '#0072b2'\n",
      cell.stem, T, disc);
  return text + "  unset label 60\n  unset label 61\n";
}

/// Arclength of line contact over that between the outermost contacts.
double share_of_lines(const equilibrium::Solution& state) {
  double lines = 0.0, reach = 0.0;
  for (const auto& arc : state.arcs)
    if (arc.kind == equilibrium::ArcKind::line) lines += arc.s_end - arc.s_begin;
  for (const auto& joint : state.joints)
    if (joint.force > 0.0) reach = std::max(reach, std::abs(joint.s));
  return reach > 0.0 ? lines / (2.0 * reach) : 0.0;
}

double height(const equilibrium::Solution& state) {
  double high = 0.0;
  for (const auto& joint : state.joints)
    if (joint.force > 0.0) high = std::max(high, std::abs(joint.z));
  return 2.0 * high;
}

std::vector<Statement> map_statements(const std::vector<ContactCell>& cells) {
  const auto &loose = cells[1].state, &middle = cells[3].state, &tight = cells[5].state;
  return {
      {"2π at T = 0.3: a helix without continuous contact",
       fmt::format("contact {}: a line over {:.0f} % of the length between the outermost contacts, which lie "
                   "{:.2f} ρ apart along the axis",
                   loose.topology, 100.0 * share_of_lines(loose), height(loose)),
       Verdict::agrees, ""},
      {"2π at T = 0.9 and 7: one flat loop, in the grey zone of the closed form",
       fmt::format(
           "flat at T = 7. At T = 0.9 one line still, but inclined: its ends lie {:.2f} ρ apart along the "
           "axis, and {:.3f} π beside the grey zone",
           height(middle), middle.phi_star / M_PI - rod::capstan::phi_star(0.9, middle.phi) / M_PI),
       Verdict::differs, "the flat coil is unstable there in this model (see the strength figure)"},
      {"the contact is a band whose width in z grows with T",
       fmt::format(
           "a line at every tension; its height in z is that of the helix: {:.2f}, {:.2f}, {:.2f} ρ for 2π",
           height(loose), height(middle), height(tight)),
       Verdict::differs, "cross-sections do not deform here"}};
}

}  // namespace

Figure pressure_map(const Study& study, const Canvas& canvas) {
  output::Picture picture{"pressure-map", 9.0, 7.6, opening};
  picture.body +=
      "  unset key\n  set xrange [-1:1]\n  set xtics 0.5\n  set yrange [-2.6:2.6]\n  set ytics 1\n"
      "  set palette defined (0 '#fde725', 0.33 '#f98e09', 0.66 '#bc3754', 1 '#57106e')\n"
      "  set cbrange [0:1]\n  set cblabel 'p / T  [1/ρ]' offset -0.5,0\n";
  picture.body += column_titles(0.26, 0.67);
  picture.body += fmt::format(
      "  set label 62 'f = T' at screen 0.885, screen 0.27 left font ',9' point pt 7 ps {} lc rgb '#0072b2' "
      "offset 1.6,0\n"
      "  set label 63 'f = T/10' at screen 0.885, screen 0.22 left font ',9' point pt 7 ps {:.3f} lc rgb "
      "'#0072b2' "
      "offset 1.6,0\n",
      disc, disc * std::sqrt(0.1));
  const std::vector<ContactCell> cells = contact_cells(study, canvas);
  for (std::size_t k = 0; k < cells.size(); ++k)
    picture.body += map_panel(cells[k], static_cast<int>(k / 2), static_cast<int>(k % 2)) +
                    (k == 0 ? "  unset label 62\n  unset label 63\n" : "");
  picture.body += "  unset multiplot\n";
  output::run_gnuplot(picture, canvas.folder, canvas.formats);
  return {"pressure-map",
          "The contact on the unrolled cylinder (the paper's “Graphical illustration of the contact "
          "interface”, maps of "
          "a, b)",
          "Stable states; θ = 0 is opposite to the pull. Thick line: line contact, its colour the pressure "
          "over the "
          "tension. Discs: point forces, their area in proportion to f/T. Dashed: the rod off the cylinder "
          "between "
          "contacts. Grey zone: contact of the flat coil after the closed form.",
          {"pi", "2pi"},
          map_statements(cells)};
}

}  // namespace windlass::figures
