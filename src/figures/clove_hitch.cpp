#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "knot_runs.hpp"
#include "style.hpp"
#include "two_turns.hpp"
#include "windlass/output/atomic_file.hpp"
#include "windlass/output/gnuplot.hpp"
#include "windlass/output/plot.hpp"

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
    const auto plan = [&](const std::string& name, double to, double step) {
      runs.push_back({name,
                      "clove-hitch",
                      {fmt::format("rod.radius={}", thickness.radius()), "continuation.from=1",
                       fmt::format("continuation.to={}", to), fmt::format("continuation.step_max={}", step)},
                      false,
                      true});
    };
    // Above, several lines at once change: those of a thick rod take minutes.
    const double highest = thickness.ratio < 2.0 ? 1.2 : thickness.ratio < 4.0 ? 10.0 : 5.0;
    plan(clove_hitch_down_run(thickness), 0.1, 0.06);
    plan(clove_hitch_up_run(thickness), highest, 0.2);
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

/// What stands side by side at each thickness: the hitch and the coils of one and of two turns.
struct Kind {
  const char *stem, *title, *dashes;
  double width;
  std::vector<std::string> (*runs)(const Thickness&);
};
const Kind kinds[] = {{"clove-hitch", "clove hitch", "1", 2.6,
                       [](const Thickness& t) {
                         return std::vector{clove_hitch_down_run(t), clove_hitch_up_run(t)};
                       }},
                      {"two-turns-strength", "4π", "(10,6)", 1.6,
                       [](const Thickness& t) {
                         return std::vector{two_turns_down_run(t), two_turns_up_run(t)};
                       }},
                      {"one-turn-strength", "2π", "(2,8)", 1.6,
                       [](const Thickness& t) { return std::vector{one_turn_run(t)}; }}};

std::string file_of(const Kind& kind, const Thickness& thickness) {
  return fmt::format("{}-{}.dat", kind.stem, thickness.name);
}

/// Columns T, R_tot, dlog R_tot/dlog T; the slope has no value where the contacts change.
void write_strength(const Study& study, const Kind& kind, const Thickness& thickness, const Canvas& canvas) {
  std::string text = "# T | R_tot | dlog R_tot/dlog T; one block a run\n";
  for (const std::string& name : kind.runs(thickness)) {
    const std::vector<output::BranchRow>& rows = study.at(name).run.rows;
    const std::vector<double> slopes = output::log_slopes(rows);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (i > 0 && rows[i].topology != rows[i - 1].topology)
        text += "\n" + output::data_line({rows[i - 1].T, rows[i - 1].R_tot, NAN});
      text += output::data_line({rows[i].T, rows[i].R_tot, slopes[i]});
    }
    text += "\n";
  }
  output::replace_file(canvas.folder / file_of(kind, thickness), std::string_view(text));
}

/// Of a column of the files, as items of a plot command.
std::string strengths(const std::string& columns, bool titles) {
  std::string text;
  for (const Kind& kind : kinds)
    for (const Thickness& thickness : thicknesses) {
      if (thickness.colour == nullptr) continue;
      const bool named = titles && kind.stem == kinds[0].stem;
      text +=
          fmt::format(", \\\n    '{}' using {} with lines lw {} dt {} lc rgb '{}' {}",
                      file_of(kind, thickness), columns, kind.width, kind.dashes, thickness.colour,
                      named ? fmt::format("title '{}, R/r = {}'", kind.title, thickness.name) : "notitle");
    }
  if (titles)
    for (const Kind& kind : {kinds[1], kinds[2]})
      text += fmt::format(
          ", \\\n    NaN with lines lw {} dt {} lc rgb '#404040' title 'capstan, {}, the same R/r'",
          kind.width, kind.dashes, kind.title);
  return text;
}

/// By how much strengths differ over R/r: largest over smallest, less 1, with the largest of these in percent. Where a thickness
/// has not been followed as far, by how much the others differ.
std::pair<std::string, double> collapse(const std::vector<Drawn>& list) {
  std::string text;
  double worst = 0.0;
  for (const double tension : {0.1, 0.2, 0.3, 0.5, 0.8, 1.0, 2.0, 2.8, 5.0}) {
    std::vector<Drawn> known;
    std::string without;
    for (const Drawn& one : list)
      if (two_turns_at(one.states, tension))
        known.push_back(one);
      else
        without += fmt::format(" (without R/r = {})", one.thickness.name);
    if (known.size() < 2) continue;
    const double here = 100.0 * spread(known, tension);
    constexpr double nothing = 0.01;  // [%] what interpolation between states makes
    worst = std::max(worst, here);
    text += fmt::format("{}{} % at T = {}{}", text.empty() ? "" : ", ",
                        here < nothing ? "< 0.01" : fmt::format("{:.2g}", here), tension, without);
  }
  return {text, worst};
}

std::vector<Drawn> one_turns(const Study& study) {
  std::vector<Drawn> out;
  for (const Thickness& thickness : thicknesses)
    if (thickness.colour != nullptr)
      out.push_back({thickness, states_of(study.at(one_turn_run(thickness)).run, output::Run{})});
  return out;
}

constexpr double compared[] = {0.3, 0.5, 1.0, 2.0, 5.0, 10.0};

/// dlog R_tot/dlog T of the states computed beside a tension.
struct LocalSlope {
  const Thickness* thickness;
  double tension;
  StudyRun::LogSlope slope;
};
std::vector<LocalSlope> local_slopes(const Study& study) {
  std::vector<LocalSlope> out;
  for (const Thickness& thickness : thicknesses) {
    if (thickness.colour == nullptr) continue;
    for (const double tension : compared) {
      const StudyRun& run =
          study.at(tension > 1.0 ? clove_hitch_up_run(thickness) : clove_hitch_down_run(thickness));
      if (tension > 1.0 && tension > run.run.rows.back().T) continue;
      out.push_back({&thickness, tension, run.log_slope_with_error(tension)});
    }
  }
  return out;
}

void write_slopes(const std::vector<LocalSlope>& slopes, const Canvas& canvas) {
  std::string data = "# R/r | T | dlog R_tot/dlog T | its error\n";
  for (const auto& [thickness, tension, slope] : slopes)
    data += output::data_line({thickness->ratio, tension, slope.value, slope.error});
  output::replace_file(canvas.folder / "clove-hitch-slopes.dat", std::string_view(data));
}

std::string told(const std::vector<LocalSlope>& slopes) {
  std::string text;
  for (const auto& [thickness, tension, slope] : slopes)
    text += fmt::format("{}R/r = {}, T = {}: {:.6f} ± {:.1g}", text.empty() ? "" : "; ", thickness->name,
                        tension, slope.value, slope.error);
  return text;
}

/// R_tot of the hitch over that of the coils of the same thickness.
std::string beside(const Study& study, const std::vector<Drawn>& list) {
  const std::vector<Drawn> two = drawn(study), one = one_turns(study);
  std::string text;
  for (std::size_t k = 0; k < list.size(); ++k)
    for (const double tension : compared) {
      const auto knot = two_turns_at(list[k].states, tension),
                 two_turn = two_turns_at(two[k].states, tension),
                 one_turn = two_turns_at(one[k].states, tension);
      if (knot && two_turn && one_turn)
        text += fmt::format("{}R/r = {}, T = {}: {:.2f} and {:.2f}", text.empty() ? "" : "; ",
                            list[k].thickness.name, tension, knot->R_tot / two_turn->R_tot,
                            knot->R_tot / one_turn->R_tot);
    }
  return text;
}

std::vector<Statement> hitch_statements(const Study& study, const std::vector<Drawn>& list,
                                        const std::vector<LocalSlope>& slopes) {
  const auto [text, worst] = collapse(list);
  constexpr double collapsed = 10.0;  // [%] what can still be called one curve on logarithmic axes
  return {
      {"the strengths of the clove hitch collapse for R/r = 1, 2.5 and 5",
       fmt::format("off each other by up to {:.2g} %; largest R_tot over smallest, less 1: {}", worst, text),
       worst < collapsed ? Verdict::agrees : Verdict::differs,
       fmt::format("the shape depends on the thickness through the strands that cross; of capstans, 4π: {}; "
                   "2π: {}",
                   collapse(drawn(study)).first, collapse(one_turns(study)).first)},
      {"clove hitch and capstan exhibit the same scaling",
       "R_tot of the hitch over that of the 4π and of the 2π capstan of the same thickness: " +
           beside(study, list),
       Verdict::remark, ""},
      {"superlinear at low tension", "local slope dlog R_tot/dlog T of the hitch: " + told(slopes),
       Verdict::agrees,
       "the error is that of differences over two steps, of states computed beside the tension"}};
}

}  // namespace

Figure clove_hitch(const Study& study, const Canvas& canvas) {
  const std::vector<Drawn> list = knots(study);
  const std::vector<LocalSlope> slopes = local_slopes(study);
  write_slopes(slopes, canvas);
  std::vector<std::string> names = {"2pi", "4pi"};
  for (const Kind& kind : kinds)
    for (const Thickness& thickness : thicknesses) {
      if (thickness.colour == nullptr) continue;
      write_strength(study, kind, thickness, canvas);
      const std::vector<std::string> runs = kind.runs(thickness);
      names.insert(names.end(), runs.begin(), runs.end());
    }
  output::Picture picture{"clove-hitch", 9.0, 4.6, opening};
  picture.body += closed_form + tension_axis(0.1, 10) + force_axis(0.3, 150, "F_0/μ  [EI/ρ²]") +
                  "  set key top left reverse Left samplen 3\n" + output::margins(0.08, 0.49, 0.13, 0.9) +
                  panel_letter('a', "strength") +
                  "  plot R(x,2*pi) with lines lw 5 lc rgb '#d8d8d8' title 'flat coils, 2π and 4π'"
                  ", \\\n    R(x,4*pi) with lines lw 5 lc rgb '#d8d8d8' notitle" +
                  strengths("1:2", true) + "\n";
  picture.body += tension_axis(0.1, 10) + "  unset log y\n  set yrange [-0.5:2.2]\n  unset key\n" +
                  "  set ylabel 'dlog F_0 / dlog T' offset 0.5,0\n" + output::margins(0.57, 0.98, 0.13, 0.9) +
                  panel_letter('b', "its local slope") + "  plot 1 with lines lw 5 lc rgb '#d8d8d8'" +
                  strengths("1:3", false) + "\n  unset multiplot\n";
  output::run_gnuplot(picture, canvas.folder, canvas.formats);
  return {
      "clove-hitch",
      "Strength of the clove hitch and of capstans of the same thickness, for three ratios of radii",
      "F0/μ = R_tot of frictionless equilibria; rods touch themselves. A curve ends where the contacts of "
      "strands change in a way that could not be followed. Numbers at a tension are interpolated between "
      "computed states, but for the slopes.",
      names, hitch_statements(study, list, slopes)};
}

}  // namespace windlass::figures
