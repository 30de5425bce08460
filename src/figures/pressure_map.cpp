#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "contact_cell.hpp"
#include "knot_runs.hpp"
#include "style.hpp"
#include "windlass/output/gnuplot.hpp"
#include "windlass/rod/capstan.hpp"

namespace windlass::figures {

using Verdict = Statement::Verdict;

namespace {

/// Of a disc that stands for f = T.
constexpr double disc = 2.2;

/// Columns of the picture: π, 2π, the clove hitch.
constexpr double column_left[] = {0.055, 0.345, 0.635}, column_width = 0.255;

std::string place_panel(int row, int column) {
  const double left = column_left[column], top = 0.93 - 0.29 * row;
  std::string text = output::margins(left, left + column_width, top - 0.215, top);
  text += fmt::format("  set label 52 'T = {:g}' at graph 0.03, graph 0.88 left font ',10'\n",
                      contact_tensions[row]);
  text += column == 0 ? "  set ylabel 'z / ρ' offset 1,0\n" : "  unset ylabel\n";
  return text + (row == 2 ? "  set xlabel 'place round the axis θ / π'\n" : "  unset xlabel\n");
}

std::string map_panel(const ContactCell& cell, int row, int column) {
  const double T = cell.state.T;
  std::string text = place_panel(row, column) + contact_heading(cell);
  text += row == 2 && column == 1
              ? "  set colorbox user origin screen 0.905, screen 0.35 size screen 0.014, screen 0.58\n"
              : "  unset colorbox\n";
  text += cell.state.self_force > 0.0 ? "  unset object 1\n" : flat_contact_band(cell.state);
  text += fmt::format(
      "  plot '{0}.dat' index 2 using 1:2 with lines lw 1.5 dt (6,4) lc rgb '#808080', \\\n"
      "    '{0}.dat' index 0 using 1:3:($2/{1}) with lines lw 7 lc palette, \\\n"
      "    '{0}.dat' index 1 using 1:3:({2}*sqrt($2/{1})) with points pt 7 ps variable lc rgb '#0072b2', \\\n"
      "    '{0}.dat' index 3 using 1:3:({2}*sqrt($2/{1})) with points pt 6 ps variable lc rgb '#404040'\n",
      cell.stem, T, disc);
  return text + "  unset label 60\n  unset label 61\n  unset label 64\n";
}

/// A state that its branch does not reach.
std::string empty_panel(int row, int column) {
  return place_panel(row, column) +
         "  unset label 51\n  unset object 1\n  unset colorbox\n"
         "  set label 53 'not reached' at graph 0.5, graph 0.5 center font ',9'\n  plot NaN\n  unset label "
         "53\n";
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

/// The highest tension at which a hitch's contact with the cylinder is by touches alone; 0 where none is met.
double touches_alone_below(const StudyRun& run) {
  double tension = 0.0;
  for (const auto& row : run.run.rows)
    // Lines between strands are called so, too, but in the plural.
    if ((row.topology + " ").find("line ") == std::string::npos) tension = std::max(tension, row.T);
  return tension;
}

std::string contacts_in_words(const equilibrium::Solution& state) {
  double angle = 0.0;
  for (std::size_t k = 0; k < state.arcs.size(); ++k)
    if (state.arcs[k].kind == equilibrium::ArcKind::line)
      angle += std::abs(state.joints[k + 1].angle - state.joints[k].angle);
  const int lines = lines_of(state);
  const std::string along =
      lines > 0 ? fmt::format("{} lines, over {:.2f} π in all, and ", lines, angle / M_PI) : "";
  return fmt::format("on the cylinder {}{} touches; strands press on each other with {:.3g} T in all", along,
                     touches_of(state), state.self_force / state.T);
}

std::vector<Statement> knot_statements(const Study& study,
                                       const std::vector<std::optional<ContactCell>>& cells) {
  const StudyRun &down = study.at(clove_hitch_down_run(simulated)),
                 &up = study.at(clove_hitch_up_run(simulated));
  std::vector<Statement> list;
  if (cells[0])
    list.push_back({"the clove hitch below T = 0.5: a loose shape with discrete contact points",
                    fmt::format("at T = 0.3 {}. It touches the cylinder at points alone below T = {:.4f}",
                                contacts_in_words(cells[0]->state), touches_alone_below(down)),
                    lines_of(cells[0]->state) == 0 ? Verdict::agrees : Verdict::differs, ""});
  if (cells[1])
    list.push_back(
        {"they merge into two continuous contact loops as T increases",
         "at T = 0.9 " + contacts_in_words(cells[1]->state),
         lines_of(cells[1]->state) == 2 ? Verdict::agrees : Verdict::differs,
         "each half lies on the cylinder along one line; the middle strand, which passes over the tails, "
         "never does"});
  list.push_back(
      {"the clove hitch at T = 7",
       cells[2] ? contacts_in_words(cells[2]->state)
                : fmt::format("not reached: its strands' contacts could be followed up to T = {:.4f} ({})",
                              up.run.rows.back().T,
                              up.run.info.lost_branches.empty() ? "where the run was to end"
                                                                : up.run.info.lost_branches.front().reason),
       Verdict::remark, ""});
  return list;
}

}  // namespace

Figure pressure_map(const Study& study, const Canvas& canvas) {
  output::Picture picture{"pressure-map", 12.0, 7.6, opening};
  picture.body +=
      "  unset key\n  set xrange [-1:1]\n  set xtics 0.5\n  set yrange [-2.6:2.6]\n  set ytics 1\n"
      "  set palette defined (0 '#fde725', 0.33 '#f98e09', 0.66 '#bc3754', 1 '#57106e')\n"
      "  set cbrange [0:1]\n  set cblabel 'p / T  [1/ρ]' offset -0.5,0\n";
  picture.body +=
      column_titles(column_left[0] + 0.5 * column_width, column_left[1] + 0.5 * column_width) +
      fmt::format("  set label 64 'clove hitch, R/r = 2.5' at screen {}, screen 0.978 center font ',11'\n",
                  column_left[2] + 0.5 * column_width);
  picture.body += fmt::format(
      "  set label 62 'f = T' at screen 0.905, screen 0.27 left font ',9' point pt 7 ps {} lc rgb '#0072b2' "
      "offset 1.6,0\n"
      "  set label 63 'f = T/10' at screen 0.905, screen 0.22 left font ',9' point pt 7 ps {:.3f} lc rgb "
      "'#0072b2' "
      "offset 1.6,0\n",
      disc, disc * std::sqrt(0.1));
  const std::vector<ContactCell> cells = contact_cells(study, canvas);
  const std::vector<std::optional<ContactCell>> knots = knot_cells(study, canvas);
  for (std::size_t row = 0; row < knots.size(); ++row) {
    const int k = static_cast<int>(row);
    picture.body += map_panel(cells[2 * row], k, 0) + (k == 0 ? "  unset label 62\n  unset label 63\n" : "") +
                    map_panel(cells[2 * row + 1], k, 1) +
                    (knots[row] ? map_panel(*knots[row], k, 2) : empty_panel(k, 2));
  }
  picture.body += "  unset multiplot\n";
  output::run_gnuplot(picture, canvas.folder, canvas.formats);
  std::vector<Statement> statements = map_statements(cells);
  const std::vector<Statement> of_knots = knot_statements(study, knots);
  statements.insert(statements.end(), of_knots.begin(), of_knots.end());
  return {"pressure-map",
          "The contact on the unrolled cylinder (the paper's “Graphical illustration of the contact "
          "interface”)",
          "Stable states; θ = 0 is opposite to the pull. Thick line: line contact, its colour the pressure "
          "over the "
          "tension. Discs: point forces, their area in proportion to f/T. Dashed: the rod off the cylinder "
          "between "
          "contacts. Circles: where strands press on each other, by the same measure. Grey zone: contact of "
          "the flat coil after the closed form.",
          {"pi", "2pi", clove_hitch_down_run(simulated), clove_hitch_up_run(simulated)},
          statements};
}

}  // namespace windlass::figures
