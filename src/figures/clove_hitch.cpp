#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "knot_runs.hpp"
#include "style.hpp"
#include "two_turns.hpp"
#include "windlass/output/atomic_file.hpp"
#include "windlass/output/gnuplot.hpp"

namespace windlass::figures {

using Verdict = Statement::Verdict;

std::string clove_hitch_down_run(const Thickness& thickness) {
  return std::string("clove-hitch-") + thickness.name;
}
std::string clove_hitch_up_run(const Thickness& thickness) { return clove_hitch_down_run(thickness) + "-up"; }

std::vector<PlannedRun> knot_runs() {
  std::vector<PlannedRun> runs;
  for (const auto& [name, tension] :
       {std::pair{thin_limit_runs[0], "2"}, std::pair{thin_limit_runs[1], "1.2"}})
    runs.push_back({name,
                    "capstan-2pi-thick",
                    {fmt::format("load.tension={}", tension), "continuation.parameter=rod.radius",
                     "continuation.from=0.001", "continuation.to=0.5", "continuation.step_max=0.05"},
                    false,
                    true});
  for (const Thickness& thickness : thicknesses) {
    if (thickness.colour == nullptr) continue;
    const auto plan = [&](const std::string& name, double to) {
      runs.push_back({name,
                      "clove-hitch",
                      {fmt::format("rod.radius={}", thickness.radius()), "continuation.from=1",
                       fmt::format("continuation.to={}", to), "continuation.step_max=0.06"},
                      false,
                      true});
    };
    // Above, several lines at once change: the runs would end there after a minute.
    const double highest = thickness.ratio < 2.0 ? 1.2 : thickness.ratio < 4.0 ? 3.0 : 5.0;
    plan(clove_hitch_down_run(thickness), 0.1);
    plan(clove_hitch_up_run(thickness), highest);
  }
  return runs;
}

namespace {

std::vector<Drawn> knots(const Study& study) {
  std::vector<Drawn> out;
  for (const Thickness& thickness : thicknesses)
    if (thickness.colour != nullptr)
      out.push_back({thickness, states_of(study.at(clove_hitch_down_run(thickness)).run,
                                          study.at(clove_hitch_up_run(thickness)).run)});
  return out;
}

std::string collapse(const std::vector<Drawn>& list) {
  std::string text;
  for (const double tension : {0.2, 0.3, 0.5, 0.8, 1.0})
    text +=
        fmt::format("{}{:.2g} % at T = {}", text.empty() ? "" : ", ", 100.0 * spread(list, tension), tension);
  return text;
}

/// dlog R_tot/dlog T between 2 % below and above.
std::string slopes(const std::vector<Drawn>& list) {
  std::string text;
  for (const Drawn& knot : list)
    for (const double tension : {0.3, 0.5, 1.0, 2.0}) {
      const auto below = two_turns_at(knot.states, tension / 1.02),
                 above = two_turns_at(knot.states, tension * 1.02);
      if (below && above)
        text += fmt::format("{}R/r = {}, T = {}: {:.2f}", text.empty() ? "" : "; ", knot.thickness.name,
                            tension, std::log(above->R_tot / below->R_tot) / (2.0 * std::log(1.02)));
    }
  return text;
}

}  // namespace

Figure clove_hitch(const Study& study, const Canvas& canvas) {
  const std::vector<Drawn> list = knots(study);
  std::string curves;
  std::vector<std::string> names = {"2pi", "4pi"};
  for (const Drawn& knot : list) {
    const std::string file = fmt::format("clove-hitch-{}.dat", knot.thickness.name);
    std::string text = "# T | R_tot\n";
    for (const auto& state : knot.states) text += output::data_line({state.T, state.R_tot});
    output::replace_file(canvas.folder / file, std::string_view(text));
    curves +=
        fmt::format(", \\\n    '{}' using 1:2 with lines lw 2.2 lc rgb '{}' title 'clove hitch, R/r = {}'",
                    file, knot.thickness.colour, knot.thickness.name);
    names.insert(names.end(), {clove_hitch_down_run(knot.thickness), clove_hitch_up_run(knot.thickness)});
  }
  output::Picture picture{"clove-hitch", 6.4, 4.6, opening};
  picture.body += closed_form + tension_axis(0.1, 10) + force_axis(0.3, 150, "F_0/μ  [EI/ρ²]") +
                  "  set key top left reverse Left samplen 3\n" + output::margins(0.12, 0.97, 0.13, 0.95) +
                  "  plot R(x,2*pi) with lines lw 5 lc rgb '#d0d0d0' title 'flat coils, 2π and 4π'"
                  ", \\\n    R(x,4*pi) with lines lw 5 lc rgb '#d0d0d0' notitle, \\\n    " +
                  item("2pi", 4, 2, "lw 1.2 dt (3,6) lc rgb 'black' title 'thin helices, 2π and 4π'") +
                  ", \\\n    " + item("4pi", 4, 2, "lw 1.2 dt (3,6) lc rgb 'black' notitle") + curves +
                  "\n  unset multiplot\n";
  output::run_gnuplot(picture, canvas.folder, canvas.formats);
  return {"clove-hitch",
          "Strength of the clove hitch for three ratios of radii",
          "F0/μ = R_tot of the frictionless knot. A curve ends where the contacts of its strands change in a "
          "way that could not "
          "be followed.",
          names,
          {{"the strengths of the clove hitch collapse for R/r = 1, 2.5 and 5",
            "largest R_tot over smallest, less 1: " + collapse(list), Verdict::remark,
            "below T = 1 thicker rods hold better: the shape depends on the thickness through the strands "
            "that cross"},
           {"—", "local slope dlog R_tot/dlog T: " + slopes(list), Verdict::remark, ""}}};
}

}  // namespace windlass::figures
