#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "knot_runs.hpp"
#include "sliding_data.hpp"
#include "windlass/output/atomic_file.hpp"
#include "windlass/output/gnuplot.hpp"
#include "windlass/rod/capstan.hpp"

namespace windlass::figures {

using Verdict = Statement::Verdict;

std::string sliding_hitch_run(const Thickness& thickness) {
  return std::string("clove-hitch-plate-") + thickness.name;
}

std::vector<PlannedRun> sliding_hitch_runs() {
  std::vector<PlannedRun> runs;
  for (const Thickness& thickness : thicknesses) {
    if (thickness.colour == nullptr) continue;
    // Above, strands meet beside a line of theirs (R/r = 1), or lines make minutes of it.
    const char* highest = thickness.ratio < 2.0 ? "0.8" : "2";
    runs.push_back({sliding_hitch_run(thickness),
                    "clove-hitch-plate",
                    {fmt::format("rod.radius={}", thickness.radius()),
                     fmt::format("continuation.from={}", highest), "continuation.to=0.1"},
                    false,
                    true});
  }
  return runs;
}

namespace {

/// One state of the knot that a cylinder slides through, and R_tot of the knot that nothing drags, interpolated.
struct Beside {
  double T, strength, still;  ///< F0/μ, R_tot [EI/ρ²]
};

std::vector<Beside> beside(const Study& study, const Thickness& thickness) {
  const std::vector<TwoTurns> still =
      states_of(study.at(clove_hitch_down_run(thickness)).run, study.at(clove_hitch_up_run(thickness)).run);
  const StudyRun& dragged = study.at(sliding_hitch_run(thickness));
  std::vector<Beside> out;
  for (const output::BranchRow& row : dragged.run.rows)
    if (const auto at = two_turns_at(still, row.T))
      out.push_back({row.T, strength_of(row, dragged), at->R_tot});
  return out;
}

std::string file_of(const std::string& run) { return "strength-" + run + ".dat"; }

/// Columns T, F0/μ, R_tot.
void write(const std::string& run, const std::vector<Beside>& states, const Canvas& canvas) {
  std::string text = "# T | F0/μ of the dragged state | R_tot without friction\n";
  for (const Beside& state : states) text += output::data_line({state.T, state.strength, state.still});
  output::replace_file(canvas.folder / file_of(run), std::string_view(text));
}

/// The flat coils on their plate beside the closed form, where that is defined.
std::vector<Beside> flat_coils(const Study& study, const Angle& angle) {
  const StudyRun& flat = study.at(on_plate_run(angle));
  std::vector<Beside> out;
  for (const output::BranchRow& row : flat.run.rows)
    if (flat.phi() < M_PI || rod::capstan::line_contact(row.T, flat.phi()))
      out.push_back({row.T, strength_of(row, flat), rod::capstan::total_force(row.T, flat.phi())});
  return out;
}

std::string curve(const std::string& run, const char* columns, double width, const char* dashes,
                  const char* colour, const std::string& title) {
  return fmt::format(", \\\n    '{}' using {} with lines lw {} dt {} lc rgb '{}' {}", file_of(run), columns,
                     width, dashes, colour, title.empty() ? "notitle" : "title '" + title + "'");
}

/// F0/μ of the dragged knot over R_tot of the one at rest, where there is a state near a tension.
std::string told(const std::vector<Beside>& states) {
  std::string text;
  for (const double tension : {0.1, 0.3, 0.8, 2.0}) {
    const auto near = std::ranges::min(states, {}, [&](const Beside& s) { return std::abs(s.T - tension); });
    constexpr double at_all = 0.05;
    if (std::abs(near.T - tension) > at_all * tension) continue;
    text +=
        fmt::format("{}{:.3f} at T = {:.3g}", text.empty() ? "" : ", ", near.strength / near.still, near.T);
  }
  return text;
}

}  // namespace

Figure sliding_hitch(const Study& study, const Canvas& canvas) {
  std::vector<std::string> names;
  std::string still, strengths, together, ratios;
  for (const Angle& angle : angles) {
    const std::string run = on_plate_run(angle);
    write(run, flat_coils(study, angle), canvas);
    together += curve(run, "3:2", 1.6, "1", angle.colour, fmt::format("flat coil, φ = {}", angle.title));
    names.push_back(run);
  }
  for (const Thickness& thickness : thicknesses) {
    if (thickness.colour == nullptr) continue;
    const std::string run = sliding_hitch_run(thickness);
    const std::vector<Beside> states = beside(study, thickness);
    write(run, states, canvas);
    ratios += fmt::format("{}R/r = {}: {}", ratios.empty() ? "" : "; ", thickness.name, told(states));
    still += curve(run, "1:3", 4.0, "1", "#d0d0d0", "");
    strengths += curve(run, "1:2", 1.8, "1", thickness.colour, fmt::format("R/r = {}", thickness.name));
    together += curve(run, "3:2", 1.6, "(10,6)", thickness.colour,
                      fmt::format("clove hitch, R/r = {}", thickness.name));
    names.insert(names.end(), {run, clove_hitch_down_run(thickness), clove_hitch_up_run(thickness)});
  }
  output::Picture picture{"sliding-hitch", 9.0, 4.6, opening};
  picture.body += tension_axis(0.09, 2.2) + "  set xtics (0.1, 0.2, 0.5, 1, 2)\n" +
                  force_axis(0.2, 30, "F_0/μ  [EI/ρ²]") + "  set key top left reverse Left samplen 3\n" +
                  output::margins(0.08, 0.49, 0.13, 0.9) + panel_letter('a', "clove hitch on a plate") +
                  "  plot NaN with lines lw 4 lc rgb '#d0d0d0' title 'R_{tot} without friction'" + still +
                  strengths + "\n";
  picture.body += std::string("  set xtics auto\n  set logscale x\n  set xrange [0.1:60]\n") +
                  "  set xlabel 'R_{tot} without friction  [EI/ρ²]' offset 0,0.4\n" +
                  force_axis(0.1, 60, "") + output::margins(0.57, 0.98, 0.13, 0.9) +
                  panel_letter('b', "against the normal force") +
                  "  plot x with lines lw 5 lc rgb '#d8d8d8' title 'F_0 = μ R_{tot}'" + together +
                  "\n  unset multiplot\n";
  output::run_gnuplot(picture, canvas.folder, canvas.formats);
  constexpr const char* legend =
      "F0/μ at μ = 0.32, a plate, travel along itself blocked. (a) Grey: R_tot of the hitch that nothing "
      "drags, interpolated between computed states; colours: F0/μ of the dragged one. (b) The same, and flat "
      "coils on their plate against the closed form, where that is defined.";
  return {"sliding-hitch",
          "Sliding strength against the total normal force, and that of the clove hitch with friction in its "
          "shape",
          legend,
          names,
          {{"the strength of the clove hitch is μ times the total normal force of the knot at rest",
            "F0 of the dragged knot over μ R_tot of the knot without friction, μ = 0.32: " + ratios,
            Verdict::differs,
            "friction changes the shape: loose knots are dragged into ones that hold less, tight ones into "
            "ones that hold a little more"}}};
}

}  // namespace windlass::figures
