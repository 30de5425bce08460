#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "style.hpp"
#include "two_turns.hpp"
#include "windlass/output/gnuplot.hpp"
#include "windlass/rod/capstan.hpp"

namespace windlass::figures {

namespace capstan = rod::capstan;
using Verdict = Statement::Verdict;

namespace {

constexpr double two_turns_angle = 4.0 * M_PI;

std::string reach(const std::vector<Drawn>& list) {
  std::string text;
  for (const Drawn& one : list)
    text += fmt::format("{}R/r = {}: T = {:.4g} to {:.4g}", text.empty() ? "" : ", ", one.thickness.name,
                        one.states.front().T, one.states.back().T);
  return text;
}

Statement collapse_statement(const std::vector<Drawn>& list) {
  std::string text;
  double worst = 0.0;
  for (const double tension : {0.2, 0.5, 1.0, 1.5, 2.0, 3.0}) {
    const double here = spread(list, tension);
    if (here < 0.0) continue;
    worst = std::max(worst, here);
    text += fmt::format("{}{:.2g} % at T = {}", text.empty() ? "" : ", ", 100.0 * here, tension);
  }
  constexpr double collapsed = 0.1;  // what can still be called one curve on logarithmic axes
  return {"the strengths at 4π collapse for R/r = 1, 2.5 and 5",
          "largest R_tot over smallest, less 1: " + text,
          worst < collapsed ? Verdict::agrees : Verdict::differs,
          "below the opening of the crossing no strand touches another, and the thickness is in ρ alone"};
}

std::vector<Statement> strength_statements(const Study& study, const std::vector<Drawn>& list) {
  std::string beside;
  for (const Drawn& one : list)
    for (const double tension : {1.0, 2.0})
      if (const auto state = two_turns_at(one.states, tension))
        beside += fmt::format("{}R/r = {}, T = {}: {:.3f} of the flat coil's, {:.3f} of the thin rod's",
                              beside.empty() ? "" : "; ", one.thickness.name, tension,
                              state->R_tot / capstan::total_force(tension, two_turns_angle),
                              state->R_tot / study.at("4pi").stable_force(tension));
  return {collapse_statement(list),
          {"—", "R_tot beside the planar closed form and beside a rod that passes through itself: " + beside,
           Verdict::remark, ""},
          {"R/r = 1, 2.5, 5 up to the highest tensions of the experiments", "computed: " + reach(list),
           Verdict::remark,
           "where a curve ends (filled circle) before, the contact of neighbouring turns changes in a way "
           "that could not be followed: the runs below say how"}};
}

}  // namespace

Figure radius_ratio(const Study& study, const Canvas& canvas) {
  const std::vector<Drawn> list = drawn(study);
  write_states(list, canvas);
  output::Picture picture{"radius-ratio", 9.0, 4.4, opening};
  const auto ends = [&](const char* columns) {
    std::string text;
    for (const Drawn& one : list)
      text += fmt::format(", \\\n    '< tail -n 1 {}' using {} with points pt 7 ps 0.8 lc rgb '{}' notitle",
                          file_of(one.thickness), columns, one.thickness.colour);
    return text + "\n";
  };
  picture.body += closed_form + tension_axis(0.1, 40) + force_axis(0.5, 600, "F_0/μ  [EI/ρ²]");
  picture.body += "  set key top left reverse Left samplen 3\n" + output::margins(0.08, 0.49, 0.14, 0.9) +
                  panel_letter('a', "strength");
  picture.body += "  plot R(x,4*pi) with lines lw 9 lc rgb '#d0d0d0' title 'flat coil, closed form'" +
                  curves(list, "1:2", true) + ", \\\n    " +
                  item("4pi", 4, 2, "lw 1.2 dt (3,6) lc rgb 'black' title 'thin rod, helical'") + ends("1:2");
  picture.body +=
      tension_axis(1, 40) + "  unset log y\n  set yrange [0.98:1.08]\n  unset key\n  unset ylabel\n" +
      output::margins(0.57, 0.98, 0.14, 0.9) + panel_letter('b', "the same, over that of the flat coil");
  picture.body += "  plot 1 with lines lw 9 lc rgb '#d0d0d0'" + curves(list, "1:($2/R($1,4*pi))", false) +
                  ends("1:($2/R($1,4*pi))") + "  unset multiplot\n";
  output::run_gnuplot(picture, canvas.folder, canvas.formats);
  return {"radius-ratio", "Strength at φ = 4π for three ratios of radii (the paper's first appendix)",
          "F0/μ = R_tot, all forces of the cylinder on a rod that touches itself. A circle is the last "
          "state computed. Numbers at a tension are interpolated between computed states.",
          runs(list), strength_statements(study, list)};
}

}  // namespace windlass::figures
