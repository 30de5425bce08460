#include <fmt/format.h>

#include <cmath>

#include "style.hpp"
#include "windlass/output/gnuplot.hpp"
#include "windlass/rod/capstan.hpp"

namespace windlass::figures {

namespace capstan = rod::capstan;
using Verdict = Statement::Verdict;

namespace {

/// 2 phi_star/π of the stable state.
double wrapping(const StudyRun& study, double tension) {
  return 2.0 * study.stable_state(tension).phi_star / M_PI;
}

}  // namespace

Figure wrapping_angle(const Study& study, const Canvas& canvas) {
  const StudyRun& run = study.at("4pi");
  output::Picture picture{"wrapping-angle", 6.4, 4.4, opening};
  picture.body += closed_form + tension_axis(0.1, 40) + contact_limit;
  picture.body +=
      "  set yrange [2.9:4.05]\n  set ylabel 'wrapping angle 2φ^* / π'\n"
      "  set key bottom right reverse Left samplen 3\n";
  picture.body += output::margins(0.12, 0.96, 0.14, 0.95);
  const std::string flat = fmt::format("lc rgb '{}' ", flat_colour),
                    helical = fmt::format("lc rgb '{}' ", helical_colour);
  const auto twice = [&](int block, const std::string& style) {
    return fmt::format("'4pi.dat' index {} using 1:(2*$3) with lines {}", block, style);
  };
  picture.body +=
      "  plot 2*phistar(x,4*pi)/pi with lines lw 7 lc rgb '#d0d0d0' title 'closed form', \\\n    " +
      twice(0, flat + "lw 2 title 'flat, stable'") + ", \\\n    " +
      twice(1, flat + "lw 1.3 dt (14,9) title 'flat, unstable'") + ", \\\n    " +
      twice(3, flat + "lw 1.3 dt (14,9) notitle") + ", \\\n    " +
      twice(4, helical + "lw 2 title 'helical, stable'") + ", \\\n    " +
      twice(5, helical + "lw 1.3 dt (14,9) title 'helical, unstable'") + "\n  unset multiplot\n";
  output::run_gnuplot(picture, canvas.folder, canvas.formats);
  return {"wrapping-angle",
          "Wrapping angle at φ = 4π (the paper's “Evolution of the total wrapping angle”)",
          "Angle round the axis between the outermost contacts. Vertical line: T = 1/2, the end of the flat "
          "line contact.",
          {"4pi"},
          {{"2φ* follows the planar closed form for T ≥ 0.5 and tends to 4π",
            fmt::format("the stable state has 2φ* = {:.4f} π at T = 10 (closed form {:.4f} π), {:.4f} π at T "
                        "= 0.9 ({:.4f} π)",
                        wrapping(run, 10.0), 2.0 * capstan::phi_star(10.0, run.phi()) / M_PI,
                        wrapping(run, 0.9), 2.0 * capstan::phi_star(0.9, run.phi()) / M_PI),
            Verdict::agrees,
            fmt::format("exactly while the coil is flat, above T = {:.4f}; close to it on the helix",
                        run.flat_event("branch_point").value_or(0.0))},
           {"below T = 0.5 the wrapping angle decreases sharply, towards discrete point contacts",
            fmt::format("the helix keeps 2φ* = {:.4f} π at T = 0.4 and {:.4f} π at T = 0.15 (contact: {})",
                        wrapping(run, 0.4), wrapping(run, 0.15), run.stable_state(0.15).topology),
            Verdict::differs,
            "outermost contacts are counted here, and they stay; what shrinks is the line contact between "
            "them. The "
            "simulated rod is as thick as 0.4 R, has friction, and touches itself"}}};
}

}  // namespace windlass::figures
