#include <fmt/format.h>

#include <cmath>

#include "style.hpp"
#include "windlass/output/gnuplot.hpp"
#include "windlass/rod/capstan.hpp"

namespace windlass::figures {

namespace capstan = rod::capstan;
using Verdict = Statement::Verdict;

namespace {

constexpr const char* colours[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00"};

std::string inset() {
  return output::margins(0.62, 0.94, 0.25, 0.52) +
         "  set object 2 rectangle from graph 0,0 to graph 1,1 fc rgb 'white' behind\n"
         "  set yrange [0.7:2.7]\n  unset log y\n  set xrange [0.2:10]\n  set xtics font ',8' offset 0,0.4\n"
         "  set ytics 0.5 font ',8' offset 0.5,0\n  unset ylabel\n  set xlabel 'T' offset 0,0.9 font ',9'\n"
         "  set label 53 'α, one loop (2π)' at graph 0.97, graph 0.88 right font ',9'\n  unset key\n  plot "
         "1.6 with lines dt (3,6) lc rgb 'black', 1 with lines dt (14,9) lc rgb 'black', \\\n    " +
         item("2pi", 0, 4, fmt::format("lw 2 lc rgb '{}'", flat_colour)) + ", \\\n    " +
         item("2pi", 1, 4, fmt::format("lw 1.3 dt (14,9) lc rgb '{}'", flat_colour)) + ", \\\n    " +
         item("2pi", 4, 4, fmt::format("lw 2 lc rgb '{}'", helical_colour)) + "\n  unset object 2\n";
}

/// Slope of R_tot(T) of a computed branch between the rows nearest to two tensions.
double mean_slope(const StudyRun& study, double low, double high) {
  const auto nearest = [&](double T) {
    const output::BranchRow* best = &study.run.rows.front();
    for (const auto& row : study.run.rows)
      if (std::abs(std::log(row.T / T)) < std::abs(std::log(best->T / T))) best = &row;
    return *best;
  };
  const auto a = nearest(low), b = nearest(high);
  return std::log(b.R_tot / a.R_tot) / std::log(b.T / a.T);
}

std::vector<Statement> knot_statements(const Study& study) {
  std::string coils, ratio;
  for (int n = 2; n <= 6; ++n) {
    coils += fmt::format("{}n = {}: {:.2f}", n > 2 ? ", " : "", n,
                         mean_slope(study.at(fmt::format("knot-{}", n)), 0.5, 2.5));
    ratio += fmt::format("{}{:.2f}", n > 2 ? ", " : "",
                         capstan::knot_of_coil(2.5, n) / capstan::knot_of_loops(2.5, n));
  }
  const double loop =
      std::log(capstan::knot_of_loops(2.5, 1) / capstan::knot_of_loops(0.5, 1)) / std::log(5.0);
  const StudyRun& turn = study.at("2pi");
  const double stable = std::log(turn.stable_force(2.5) / turn.stable_force(0.5)) / std::log(5.0);
  return {{"the superlinearity of one continuous coil grows with the number of loops; that of n separate "
           "loops does not",
           fmt::format("mean α from T = 0.5 to 2.5, coils: {}; n loops: {:.2f} for every n", coils, loop),
           Verdict::agrees, ""},
          {"α of a 2π wrap falls from 1 + π/2 to 1",
           fmt::format("flat loop: {:.4f} at T = 1/2, {:.4f} at T = 40", capstan::log_slope(0.5, 2.0 * M_PI),
                       capstan::log_slope(40.0, 2.0 * M_PI)),
           Verdict::agrees, ""},
          {"α ≈ 1.6 for a loop agrees with the measured 1.59 ± 0.03",
           fmt::format("mean α from T = 0.5 to 2.5, the range of the measurements: {:.2f} for a flat loop, "
                       "{:.2f} for the stable "
                       "states of a free one",
                       loop, stable),
           Verdict::differs,
           "a loop that is held flat (in a knot it is set so plastically) has the slope of the measurements "
           "at T ≈ 1; a free "
           "elastic loop is helical below T = 1.29 and its slope there is below 1"},
          {"predicted forces exceed the measured ones",
           "not compared: the measurements are not available as numbers", Verdict::remark,
           "`windlass plot RUN --csv DATA` lays them over a run"},
          {"—", fmt::format("one coil against n loops at T = 2.5, ratio of forces for n = 2 to 6: {}", ratio),
           Verdict::remark, ""}};
}

}  // namespace

Figure surgical_knot(const Study& study, const Canvas& canvas) {
  output::Picture picture{"surgical-knot", 7.0, 5.4, opening};
  picture.body +=
      closed_form + tension_axis(0.4, 10) + force_axis(0.9, 600, "R_{tot}  [EI/ρ²]") + contact_limit;
  picture.body += "  set key at graph 0.09, graph 0.97 left top reverse Left samplen 2.5\n";
  picture.body += output::margins(0.11, 0.97, 0.12, 0.96) + "  plot ";
  std::vector<std::string> runs{"2pi"};
  for (int n = 6; n >= 2; --n) {
    const char* colour = colours[n - 2];
    const std::string name = fmt::format("knot-{}", n);
    // Planar runs cannot become unstable in space, but count as stable in the plane or not: both are drawn.
    for (const int block : {0, 1})
      picture.body += item(name, block, 2,
                           fmt::format("lw 2 lc rgb '{}' {}", colour,
                                       block == 0 ? fmt::format("title 'n = {}'", n) : "notitle")) +
                      ", \\\n    ";
    picture.body +=
        fmt::format("{0}*R(x,2*pi) with lines lw 1.6 dt (14,9) lc rgb '{1}' notitle, \\\n    ", n, colour);
    runs.push_back(name);
  }
  picture.body +=
      "1e-9 with lines lw 2 lc rgb 'black' title 'R_{tot}(2nπ), one coil', \\\n    "
      "1e-9 with lines lw 1.6 dt (14,9) lc rgb 'black' title 'n R_{tot}(2π), n loops'\n  unset arrow 1\n";
  picture.body += inset() + "  unset multiplot\n";
  output::run_gnuplot(picture, canvas.folder, canvas.formats);
  return {"surgical-knot",
          "Surgical knots of n throws (the paper's “Total normal force … versus the superposition model”)",
          "Solid: computed flat coil of n turns; dashed: n times one flat loop (closed form). Inset: slope "
          "of one loop, flat "
          "(blue, dashed where unstable) and helical (orange). The measured knots of the paper's panel (a) "
          "are not "
          "available as numbers.",
          runs, knot_statements(study)};
}

}  // namespace windlass::figures
