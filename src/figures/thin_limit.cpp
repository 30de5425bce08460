#include <fmt/format.h>

#include <cmath>

#include "knot_runs.hpp"
#include "style.hpp"
#include "windlass/output/atomic_file.hpp"
#include "windlass/output/gnuplot.hpp"

namespace windlass::figures {

using Verdict = Statement::Verdict;

namespace {

/// States of a run in the rod's radius: r, tilt at the mid-point, R_tot less that of the thin rod.
struct Thickened {
  const char* run;
  double tension, thin_force;
  std::vector<std::array<double, 3>> states;
};

Thickened thickened(const Study& study, const char* run, double tension) {
  Thickened out{run, tension, study.at("2pi").stable_force(tension), {}};
  for (const output::BranchRow& row : study.at(run).run.rows)
    if (row.parameter) out.states.push_back({*row.parameter, row.tilt, row.R_tot - out.thin_force});
  return out;
}

void write(const Thickened& list, const Canvas& canvas) {
  std::string text = "# r/rho | tilt of the mid-point [rad] | R_tot less that of the thin rod\n";
  for (const auto& state : list.states) text += output::data_line({state[0], state[1], state[2]});
  output::replace_file(canvas.folder / fmt::format("{}.dat", list.run), std::string_view(text));
}

/// Of the thinnest rod, as a statement.
std::string thinnest(const Thickened& list) {
  const auto& first = list.states.front();
  return fmt::format("T = {}: r = {:.4g}: tilt {:.4g}, R_tot less the thin rod's {:.2g}", list.tension,
                     first[0], first[1], first[2]);
}

}  // namespace

Figure thin_limit(const Study& study, const Canvas& canvas) {
  const Thickened flat = thickened(study, thin_limit_runs[0], 2.0),
                  helix = thickened(study, thin_limit_runs[1], 1.2);
  write(flat, canvas);
  write(helix, canvas);
  output::Picture picture{"thin-limit", 9.0, 4.4, opening};
  const auto panel = [&](int column, const char* absolute) {
    return fmt::format(
        "  plot '{0}.dat' using 1:{1} with lines lw 2.4 lc rgb '{2}' title 'T = 2, flat when thin', \\\n"
        "    '{3}.dat' using 1:{1} with lines lw 2.4 lc rgb '{4}' title 'T = 1.2, a helix when thin'{5}\n",
        flat.run, column, flat_colour, helix.run, helical_colour, absolute);
  };
  picture.body +=
      "  set xrange [0:0.5]\n  set xlabel 'radius of the rod r/ρ' offset 0,0.2\n  set key top left reverse "
      "Left\n"
      "  set ylabel 'tilt at the mid-point  [rad]' offset 1.2,0\n" +
      output::margins(0.08, 0.48, 0.14, 0.9) + panel_letter('a', "tilt") + panel(2, "") +
      "  unset key\n  set ylabel 'R_{tot} less that of the thin rod  [EI/ρ²]' offset 1.2,0\n" +
      output::margins(0.58, 0.98, 0.14, 0.9) + panel_letter('b', "total contact force") + panel(3, "") +
      "  unset multiplot\n";
  output::run_gnuplot(picture, canvas.folder, canvas.formats);
  return {
      "thin-limit",
      "How the loss of stability of the flat coil becomes an imperfect pitchfork (φ = 2π; not in the paper)",
      "A rod that touches itself, the thicker the further right. Above the loss of stability of the thin rod "
      "(T = 1.286) "
      "its coil is flat, and the crossing of its tails tilts it at once; below, the helix is that of the "
      "thin rod until "
      "its strands meet.",
      {"2pi", thin_limit_runs[0], thin_limit_runs[1]},
      {{"—", thinnest(flat) + "; " + thinnest(helix), Verdict::remark, ""}}};
}

}  // namespace windlass::figures
