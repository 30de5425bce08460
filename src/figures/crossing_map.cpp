#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "style.hpp"
#include "thick_runs.hpp"
#include "windlass/output/atomic_file.hpp"
#include "windlass/output/gnuplot.hpp"

namespace windlass::figures {

using Verdict = Statement::Verdict;

namespace {

double known(const std::optional<double>& tension) { return tension.value_or(std::nan("")); }

StrandEvents one_turn(const Study& study, const Thickness& thickness) {
  return events_of(study.at(one_turn_run(thickness)).run.special_points);
}

/// Of two turns: opens below the tension where the two runs begin, all else is above.
StrandEvents two_turns_events(const Study& study, const Thickness& thickness) {
  StrandEvents events = events_of(study.at(two_turns_up_run(thickness)).run.special_points);
  events.opens = events_of(study.at(two_turns_down_run(thickness)).run.special_points).opens;
  return events;
}

/// Rows R/r, then the tensions of a map: opens, splits, and the third of it.
std::string table(const Study& study, bool one) {
  std::string text = one ? "# one turn: R/r | opens | splits | on the cylinder\n"
                         : "# two turns: R/r | opens | splits | turns meet\n";
  for (const Thickness& thickness : thicknesses) {
    const StrandEvents e = one ? one_turn(study, thickness) : two_turns_events(study, thickness);
    text += output::data_line(
        {thickness.ratio, known(e.opens), known(e.splits), known(one ? e.on_cylinder : e.turns_meet)});
  }
  return text;
}

std::string panel(const std::string& file, const char* third) {
  constexpr const char* colours[] = {"#0072b2", "#009e73", "#d55e00"};
  const std::string titles[] = {"the crossing opens", "a touch becomes two", third};
  std::string text = "  plot ";
  for (int k = 0; k < 3; ++k)
    text += fmt::format("{}'{}' using (${}):1 with linespoints pt 7 ps 0.7 lw 2 lc rgb '{}' title '{}'",
                        k == 0 ? "" : ", \\\n    ", file, k + 2, colours[k], titles[k]);
  return text + "\n";
}

/// "R/r = 1: 1.1853, ..." of one event.
template <class Events>
std::string listed(const Study& study, const Events& events, std::optional<double> StrandEvents::*event) {
  std::string text;
  for (const Thickness& thickness : thicknesses)
    if (const std::optional<double> tension = events(study, thickness).*event)
      text += fmt::format("{}R/r = {}: {:.6g}", text.empty() ? "" : ", ", thickness.name, *tension);
  return text.empty() ? "nowhere in these runs" : text;
}

/// Of all events in those runs, relative.
double least_precision(const Study& study, const std::vector<std::string>& runs) {
  double worst = 0.0;
  for (const std::string& run : runs)
    for (const auto& point : study.at(run).run.special_points)
      if (point.type == "contact") worst = std::max(worst, point.precision / point.T);
  return worst;
}

}  // namespace

Figure crossing_map(const Study& study, const Canvas& canvas) {
  output::replace_file(canvas.folder / "crossing-map-2pi.dat", std::string_view(table(study, true)));
  output::replace_file(canvas.folder / "crossing-map-4pi.dat", std::string_view(table(study, false)));
  output::Picture picture{"crossing-map", 9.0, 4.4, opening};
  // What is not known interrupts a line; what is missing would be passed over.
  picture.body += "  set datafile missing\n" + tension_axis(1.0, 40) +
                  "  set log y\n  set yrange [0.9:16.5]\n  set ytics (1, 1.5, 2.5, 4, 5, 7, 10, 15)\n";
  picture.body +=
      "  set ylabel 'R/r' offset 1,0\n  set key at graph 0.13, graph 0.97 left top reverse Left samplen 2\n";
  picture.body += output::margins(0.07, 0.49, 0.14, 0.9) + panel_letter('a', "φ = 2π") +
                  panel("crossing-map-2pi.dat", "they come onto the cylinder");
  picture.body += output::margins(0.56, 0.98, 0.14, 0.9) + "  unset ylabel\n" + panel_letter('b', "φ = 4π") +
                  panel("crossing-map-4pi.dat", "neighbouring turns meet") + "  unset multiplot\n";
  output::run_gnuplot(picture, canvas.folder, canvas.formats);
  std::vector<std::string> runs;
  for (const Thickness& t : thicknesses)
    runs.insert(runs.end(), {one_turn_run(t), two_turns_down_run(t), two_turns_up_run(t)});
  const auto row = [&](const char* what, std::string here, const char* why = "") {
    return Statement{what, std::move(here), Verdict::remark, why};
  };
  return {
      "crossing-map",
      "Where strands meet, by tension and ratio of radii (not in the paper)",
      fmt::format(
          "Circles: events of continuation runs in T, each located to {:.0e} of T; the lines between them "
          "only guide the eye. Beyond the blue curve, at higher tension, strands touch. Runs go to T = 40, "
          "those of one turn with R/r below 2 to T = 20; what is not marked was not met there, or lies "
          "beyond where a run ends (below).",
          least_precision(study, runs)),
      runs,
      {row("φ = 2π: the crossing is one touch above", listed(study, one_turn, &StrandEvents::opens)),
       row("φ = 2π: it is two touches, images of each other, above",
           listed(study, one_turn, &StrandEvents::splits)),
       row("φ = 2π: both strands lie on the cylinder where they touch, above",
           listed(study, one_turn, &StrandEvents::on_cylinder)),
       row("φ = 4π: each tail touches the strand that it lies over, above",
           listed(study, two_turns_events, &StrandEvents::opens)),
       row("φ = 4π: it touches it twice, above", listed(study, two_turns_events, &StrandEvents::splits)),
       row("φ = 4π: neighbouring turns touch, above",
           listed(study, two_turns_events, &StrandEvents::turns_meet),
           "soon after they lie on each other along lines")}};
}

}  // namespace windlass::figures
