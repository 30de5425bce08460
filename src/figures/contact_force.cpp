#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "style.hpp"
#include "windlass/output/atomic_file.hpp"
#include "windlass/output/gnuplot.hpp"
#include "windlass/output/plot.hpp"
#include "windlass/rod/capstan.hpp"

namespace windlass::figures {

namespace capstan = rod::capstan;
using Verdict = Statement::Verdict;

namespace {

/// Largest relative difference of computed flat states with a line contact from the closed form.
double largest_difference(const StudyRun& study) {
  double worst = 0.0;
  for (const auto& row : study.run.rows)
    if (row.branch == 1 && row.topology == "tail line tail")
      worst = std::max(worst, std::abs(row.R_tot / capstan::total_force(row.T, row.phi) - 1.0));
  return worst;
}

/// Log slope of the last line contact before the limit.
double slope_at_limit(const StudyRun& study) {
  std::vector<output::BranchRow> rows;
  for (const auto& row : study.run.rows)
    if (row.branch == 1 && row.topology == "tail line tail") rows.push_back(row);
  return rows.empty() ? std::nan("") : output::log_slopes(rows).back();
}

std::string limits(const Study& study) {
  std::string text = "# end of the line contact: T | R_tot | dlog R_tot/dlog T | angle\n";
  for (const Angle& angle : angles) {
    const StudyRun& run = study.at(angle.run);
    if (const auto T = run.flat_event("contact"))
      text += fmt::format("{} {} {} # {}\n", *T, capstan::total_force(*T, run.phi()), slope_at_limit(run),
                          angle.title);
  }
  return text;
}

std::string panel(bool slopes) {
  const int column = slopes ? 4 : 2;
  std::string text =
      slopes ? "  unset log y\n  set yrange [0.9:6]\n  set ylabel 'α = dlog R_{tot} / dlog T' offset -0.3,0\n"
               "  unset key\n"
             : force_axis(0.2, 700, "R_{tot}  [EI/ρ²]") + "  set key bottom right reverse Left samplen 2.5\n";
  text += panel_letter(slopes ? 'b' : 'a', slopes ? "its slope in logarithms" : "total contact force");
  text += "  plot ";
  if (slopes)
    text +=
        "1 with lines dt (14,9) lc rgb 'black' notitle, 1.6 with lines dt (3,6) lc rgb 'black' notitle, \\\n "
        "   ";
  for (const Angle& angle : angles) {
    const std::string style = fmt::format("lw 2 lc rgb '{}' ", angle.colour);
    text += item(angle.run, 0, column, style + fmt::format("title 'φ = {}'", angle.title)) + ", \\\n    ";
    text += item(angle.run, 1, column, style + "notitle") + ", \\\n    ";
    if (slopes) continue;
    for (const int touches : {2, 3})
      text +=
          item(angle.run, touches, column, fmt::format("lw 1.2 dt (3,6) lc rgb '{}' notitle", angle.colour)) +
          ", \\\n    ";
  }
  return text + fmt::format(
                    "'contact-force-limits.dat' using 1:{} with points pt 2 ps 1 lw 1.5 lc rgb 'black' "
                    "title 'line contact ends'\n",
                    slopes ? 3 : 2);
}

std::vector<Statement> force_statements(const Study& study) {
  std::vector<Statement> list;
  double worst = 0.0;
  for (const Angle& angle : angles) worst = std::max(worst, largest_difference(study.at(angle.run)));
  list.push_back(
      {"Eq. for R_tot(T, φ), all five angles",
       fmt::format("computed flat states with a line contact differ from it by at most {:.0e}; the rods have "
                   "finite length (25 to 40 ρ)",
                   worst),
       Verdict::agrees, ""});
  std::string found;
  for (const Angle& angle : angles)
    if (const auto T = study.at(angle.run).flat_event("contact"))
      found += fmt::format("{}{}: {:.6f} (formula {:.6f})", found.empty() ? "" : ", ", angle.title, *T,
                           capstan::line_limit(study.at(angle.run).phi()));
  list.push_back({"line contact needs T ≥ 1/(2(1 − cos φ/2)) for φ < π, T ≥ 1/2 for φ ≥ π",
                  "contact events located at T = " + found, Verdict::agrees, ""});
  found.clear();
  for (const Angle& angle : angles)
    found += fmt::format("{}{}: {:.3f}", found.empty() ? "" : ", ", angle.title,
                         slope_at_limit(study.at(angle.run)));
  list.push_back(
      {"at the limit α = 1 for φ < π and α = 1 + (φ − π)/2 for φ ≥ π, that is 2.571 for 2π and 5.712 for 4π",
       "α there, from differences: " + found, Verdict::agrees, ""});
  list.push_back(
      {"below the limit no solution for R_tot exists",
       "for φ ≤ π the rod touches at one point, R_tot = 2 T sin(φ/2), down to any tension; for φ > π flat "
       "states with isolated touches continue below T = 1/2 (dotted)",
       Verdict::differs,
       "the closed form assumes a line contact; the branch goes on with touches, which for φ > π are "
       "unstable "
       "in space"});
  list.push_back({"for φ ≥ π a finite contact length persists at T = 1/2",
                  "φ* = φ/2 − π/2 there: zero at φ = π, finite above", Verdict::differs,
                  "at φ = π exactly the arc shrinks to a point, which also makes α = 1 there"});
  list.push_back(
      {"α ≈ 1.6 at T ≈ 1 for 2π",
       fmt::format("flat coil: {:.3f}; but that coil is unstable in space, and the stable helix has {:.3f}",
                   capstan::log_slope(1.0, 2.0 * M_PI), study.at("2pi").stable_log_slope(1.0)),
       Verdict::differs,
       fmt::format(
           "the flat value is 1.5 when rounded ({:.3f} at T = 0.93). A thin rod without friction in the "
           "plane, with ends free to turn and no plates beside it, leaves the plane at T = {:.4f}",
           capstan::log_slope(0.93, 2.0 * M_PI), study.at("2pi").flat_event("branch_point").value_or(0.0))});
  return list;
}

}  // namespace

Figure contact_force(const Study& study, const Canvas& canvas) {
  output::replace_file(canvas.folder / "contact-force-limits.dat", std::string_view(limits(study)));
  output::Picture picture{"contact-force", 9.0, 4.2, opening};
  picture.body += tension_axis(0.2, 40);
  picture.body += output::margins(0.075, 0.485, 0.15, 0.9) + panel(false);
  picture.body += output::margins(0.575, 0.985, 0.15, 0.9) + panel(true) + "  unset multiplot\n";
  output::run_gnuplot(picture, canvas.folder, canvas.formats);
  return {"contact-force",
          "Total contact force of the flat coil and its slope (the paper's “Analytical predictions”)",
          "Solid: computed flat states with a line contact, stable or not. Dotted: with isolated touches. "
          "Crosses: where the "
          "line contact ends. In (b) the horizontal lines are α = 1 and 1.6.",
          {"4pi", "2pi", "pi", "half-pi", "quarter-pi"},
          force_statements(study)};
}

}  // namespace windlass::figures
