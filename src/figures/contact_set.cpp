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

Statement wrapping_statement(const std::vector<Drawn>& list) {
  std::string text;
  double worst = 0.0;
  for (const Drawn& one : list)
    for (const double tension : {0.55, 1.0, 2.0, 5.0})
      if (const auto state = two_turns_at(one.states, tension)) {
        const double flat = 2.0 * capstan::phi_star(tension, 4.0 * M_PI);
        worst = std::max(worst, std::abs(state->wrapping / flat - 1.0));
        text += fmt::format("{}R/r = {}, T = {}: {:.3f} π ({:.3f} π)", text.empty() ? "" : "; ",
                            one.thickness.name, tension, state->wrapping / M_PI, flat / M_PI);
      }
  constexpr double relatively_good = 0.1;  // the paper's words for its own scatter
  return {"2φ* follows the planar formula for T ≥ 0.5 relatively well, for R/r from 5 to 1",
          fmt::format("(formula in brackets) {}; largest difference {:.1f} %", text, 100.0 * worst),
          worst < relatively_good ? Verdict::agrees : Verdict::differs,
          "the differences are those of the helix below the loss of flatness; the thickness adds next to "
          "nothing"};
}

Statement points_statement(const std::vector<Drawn>& list) {
  std::string text, topology;
  double most = 0.0;
  for (const Drawn& one : list)
    for (const double tension : {0.45, 0.3, 0.15})
      if (const auto state = two_turns_at(one.states, tension)) {
        text += fmt::format("{}R/r = {}, T = {}: {:.3f} π of {:.3f} π", text.empty() ? "" : "; ",
                            one.thickness.name, tension, state->lines / M_PI, state->wrapping / M_PI);
        most = std::max(most, state->lines / state->wrapping);
        topology = state->topology;
      }
  constexpr double mostly_points = 0.5;
  return {
      "below T = 0.5 the wrapping angle decreases sharply, towards discrete point contacts",
      "line contact of 2φ*: " + text + "; contact at the lowest of these: " + topology,
      most < mostly_points ? Verdict::agrees : Verdict::differs,
      "what decreases is the line, which gives up its ends; 2φ*, which counts the outermost touches, hardly "
      "changes"};
}

}  // namespace

Figure contact_set(const Study& study, const Canvas& canvas) {
  const std::vector<Drawn> list = drawn(study);
  write_states(list, canvas);
  output::Picture picture{"contact-set", 9.0, 4.4, opening};
  picture.body += closed_form + tension_axis(0.1, 40) + contact_limit + "  set yrange [2.4:4.05]\n";
  const std::string formula =
      "  plot 2*phistar(x,4*pi)/pi with lines lw 9 lc rgb '#d0d0d0' title 'closed form'";
  picture.body += "  set key bottom right reverse Left samplen 3\n  set ylabel 'angle / π' offset 1,0\n";
  picture.body += output::margins(0.08, 0.49, 0.14, 0.9) +
                  panel_letter('a', "between the outermost contacts, 2φ^*") + formula +
                  curves(list, "1:3", true) + "\n  unset ylabel\n  unset key\n";
  picture.body += output::margins(0.57, 0.98, 0.14, 0.9) + panel_letter('b', "along lines on the cylinder") +
                  formula + curves(list, "1:4", false) + "\n  unset multiplot\n";
  output::run_gnuplot(picture, canvas.folder, canvas.formats);
  return {"contact-set",
          "Contact at φ = 4π for three ratios of radii (the paper's second appendix)",
          "Against the planar closed form (grey). (a) what the paper plots; (b) the part of it that is line "
          "contact. Vertical line: T = 1/2. Numbers at a tension are interpolated between computed states.",
          runs(list),
          {wrapping_statement(list),
           points_statement(list),
           {"at high tension portions of the rod overlap or pass beneath adjacent loops while sliding",
            "not computed: these are states at rest; here each tail lies over the strand that it crosses",
            Verdict::remark, ""}}};
}

}  // namespace windlass::figures
