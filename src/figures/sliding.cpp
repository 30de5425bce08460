#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sliding_data.hpp"
#include "windlass/output/gnuplot.hpp"
#include "windlass/rod/capstan.hpp"

namespace windlass::figures {

namespace capstan = rod::capstan;
using Verdict = Statement::Verdict;

namespace {

constexpr const char* dragged_colour = "#009e73";
constexpr double highest_tension = 10.0, lowest_tension = 0.3;  // tensions

/// Is the closed form defined there: a line, or below it for φ < π one touch?
bool closed_form_known(double tension, double phi) {
  return phi < M_PI || capstan::line_contact(tension, phi);
}

/// Largest relative difference of F0/μ and the closed form over a run.
double off_closed_form(const StudyRun& study) {
  double worst = 0.0;
  for (const auto& row : study.run.rows)
    if (closed_form_known(row.T, study.phi()))
      worst =
          std::max(worst, std::abs(strength_of(row, study) / capstan::total_force(row.T, study.phi()) - 1.0));
  return worst;
}

int most_negative_directions(const StudyRun& study) {
  int highest = 0;
  for (const auto& row : study.run.rows) highest = std::max(highest, row.index.value_or(0));
  return highest;
}

Statement closed_form_statement(const Study& study) {
  std::string each;
  double plane = 0.0, space = 0.0;
  int index = 0;
  for (const Angle& angle : angles) {
    const StudyRun &flat = study.at(on_plate_run(angle)), &full = study.at(in_space_run(angle));
    plane = std::max(plane, off_closed_form(flat));
    space = std::max(space, off_closed_form(full));
    index = std::max(index, most_negative_directions(full));
    each += fmt::format("{}{}: {:.1e}", each.empty() ? "" : ", ", angle.title,
                        std::max(off_closed_form(flat), off_closed_form(full)));
  }
  const StudyRun& full = study.at(in_space_run(pulled));
  constexpr double same = 1e-10;
  const auto helix = [&](const char* run) {
    return study.at(run).flat_event("branch_point").value_or(std::nan(""));
  };
  return {"F0 = μ R_tot of the planar model (the coil is held flat between plates)",
          fmt::format("flat coil on a plate, μ = {}: F0 is μ R_tot of the closed form, wherever that is "
                      "defined, to a relative {:.1e} in space (T from {} to {}, index at most {}) and {:.1e} "
                      "in the plane (down to T = {}); the larger of both at each angle: {}",
                      full.scene.friction.value(), space, highest_tension, full.run.rows.back().T, index,
                      plane, lowest_tension, each),
          std::max(plane, space) < same && index == 0 ? Verdict::agrees : Verdict::differs,
          fmt::format(
              "without plate and drag the flat coil is left for a helix at T = {:.4f} (2π) and {:.4f} (4π)",
              helix("2pi"), helix("4pi"))};
}

Statement kink_statement(const Study& study) {
  std::string where, slopes;
  bool kinks = true;
  for (const Angle& angle : {angles[0], angles[1]}) {
    const StudyRun& run = study.at(on_plate_run(angle));
    where += fmt::format("{}{:.9f} ({})", where.empty() ? "" : " and ",
                         run.flat_event("contact").value_or(std::nan("")), angle.title);
    constexpr double beside = 0.01;
    const auto above = run.log_slope_with_error(0.5 + beside), below = run.log_slope_with_error(0.5 - beside);
    slopes += fmt::format("{} {:.3f} at T = {} and {:.3f} at T = {} ({})", slopes.empty() ? "" : ",",
                          above.value, 0.5 + beside, below.value, 0.5 - beside, angle.title);
    kinks = kinks && above.value - below.value > 0.1;
  }
  return {"for φ > π F0(T) has a kink at T = 0.5",
          fmt::format("the flat coil's line gives way to two touches at T = {}; slope dlog F0/dlog T{}",
                      where, slopes),
          kinks ? Verdict::agrees : Verdict::differs,
          "it is a change of the flat coil's contact, not where a helix leaves it"};
}

Statement low_tension_statement(const Study& study, double fold) {
  const StudyRun &dragged = study.at(dragged_run), &flat = study.at(on_plate_run(pulled)),
                 &two = study.at(on_plate_run(angles[0]));
  constexpr double loose = 0.35;
  return {
      "F0 is markedly sublinear below T = 0.5 for φ > π",
      fmt::format("slope dlog F0/dlog T at T = {}: {:.3f} of the state of 2π that has left the plate; of the "
                  "flat coils {:.3f} (2π) and {:.3f} (4π)",
                  loose, dragged.stable_log_slope(loose), flat.stable_log_slope(loose),
                  two.stable_log_slope(loose)),
      Verdict::remark,
      fmt::format("at 2π there are states off the plate below T = {:.4f} only; between that and T = 1/2 the "
                  "flat coil "
                  "is what was found",
                  fold)};
}

/// @param fold  tension of the fold of the dragged states
Statement dragged_statement(const Study& study, double fold) {
  const StudyRun &dragged = study.at(dragged_run), &flat = study.at(on_plate_run(pulled));
  const auto& last = dragged.run.rows.back();
  const auto turn = std::ranges::find(dragged.run.rows, std::string("fold"), &output::BranchRow::type);
  return {"—",
          fmt::format(
              "2π: states that have left the plate are stable from T = {} up to a fold at T = {:.8f}, where "
              "F0/μ = {:.4f} (flat coil: {:.4f}), {} the flat coil's kink. Beyond the fold their index "
              "is {}; they were followed down to T = {:.4f}",
              dragged.run.rows.front().T, fold,
              turn == dragged.run.rows.end() ? std::nan("") : strength_of(*turn, dragged),
              flat.stable_force(fold), fold < 0.5 ? "below" : "above", last.index.value_or(-1), last.T),
          Verdict::remark, "the flat coil's index below T = 1/2 is that in the plane"};
}

/// @param fold  up to where the branch of 2π goes
Statement search_statement(const std::vector<Search>& list, double fold) {
  std::string some, none;
  bool missed = false;
  for (const Search& search : list) {
    missed = missed ||
             (search.dragged == 0 && search.angle.run == std::string(pulled.run) && search.tension < fold);
    std::string& text = search.dragged > 0 ? some : none;
    text += fmt::format("{}{} at T = {}", text.empty() ? "" : ", ", search.angle.title, search.tension);
    if (search.dragged > 0) text += fmt::format(" ({})", search.dragged);
  }
  return {
      "—",
      fmt::format("states off the plate at μ = 0.32 that the states without friction lead to as the friction "
                  "grows: {}; none: "
                  "{}",
                  some.empty() ? "none" : some, none),
      Verdict::remark,
      fmt::format("the search is not exhaustive{}", missed ? ": it misses the branch of 2π at a tension that "
                                                             "this reaches when it is followed"
                                                           : "")};
}

Statement pull_statement(const std::vector<PullCurve>& curves, double friction) {
  std::string text;
  for (const PullCurve& curve : curves) {
    text += fmt::format("{}T = {}: ", text.empty() ? "" : "; ", curve.tension);
    const char* what = curve.dragged ? "the state off the plate" : "the flat coil";
    if (curve.at)
      text += fmt::format("F/μ = {:.5f}, {} has {:.5f} ({:.1e} off)", curve.at->drag / friction, what,
                          curve.steady, std::abs(curve.at->drag / friction / curve.steady - 1.0));
    else
      text += fmt::format("no plateau; {} has {:.5f}", what, curve.steady);
  }
  return {"—", "plateau of a pull from rest on one mesh, 2π: " + text, Verdict::remark,
          "one mesh of a discrete rod, not extrapolated; `windlass pull` does so from three"};
}

/// Curves of one angle; the key names them.
std::string strength_curves(const Angle& angle, double phi, bool dragged) {
  const std::string flat = "sliding-" + on_plate_run(angle), next = ", \\\n    ";
  std::string text =
      fmt::format("S(x,{}) with lines lw 7 lc rgb '#d0d0d0' title 'closed form'", phi) + next +
      item(flat, 0, 2, fmt::format("lw 2 lc rgb '{}' title 'flat, on the plate'", flat_colour)) + next +
      item(flat, 1, 2, fmt::format("lw 1.3 dt (14,9) lc rgb '{}' notitle", flat_colour));
  if (dragged) {
    const std::string off = fmt::format("sliding-{}", dragged_run);
    text += next +
            item(off, 0, 2, fmt::format("lw 2 lc rgb '{}' title 'off the plate, stable'", dragged_colour)) +
            next +
            item(off, 1, 2, fmt::format("lw 1.5 dt (14,9) lc rgb '{}' title 'unstable'", dragged_colour));
  }
  if (phi > M_PI)
    text +=
        next + item(angle.run, 4, 2,
                    fmt::format("lw 1.8 dt (3,6) lc rgb '{}' title 'helix, no friction'", helical_colour));
  return text;
}

std::string panel_of_angle(const Study& study, const Angle& angle, std::size_t k) {
  const double left = 0.065 + 0.323 * static_cast<double>(k % 3), bottom = k < 3 ? 0.585 : 0.1;
  const StudyRun& run = study.at(on_plate_run(angle));
  std::string text = output::margins(left, left + 0.265, bottom, bottom + 0.35);
  text += panel_letter(static_cast<char>('a' + k), fmt::format("φ = {}", angle.title));
  const auto least =
      std::ranges::min(run.run.rows, {}, [&](const auto& row) { return strength_of(row, run); });
  text += force_axis(0.6 * strength_of(least, run), 1.6 * capstan::total_force(highest_tension, run.phi()),
                     k % 3 == 0 ? "F_0/μ  [EI/ρ²]" : "");
  return text + "  plot " + strength_curves(angle, run.phi(), angle.run == std::string(pulled.run)) + "\n";
}

std::string pull_panel(const std::vector<PullCurve>& list) {
  std::string text = output::margins(0.711, 0.976, 0.1, 0.45) +
                     panel_letter('f', "φ = 2π, pulled from rest") +
                     "  unset log x\n  set xtics auto\n  set xrange [0:6.5]\n  set xlabel 'displacement  "
                     "[ρ]' offset 0,0.4\n" +
                     force_axis(0.05, 20, "") + "  set ylabel 'F/μ  [EI/ρ²]' offset 1.8,0\n  plot ";
  constexpr const char* colours[] = {dragged_colour, "#d55e00", "#0072b2", "#cc79a7"};
  for (std::size_t k = 0; k < list.size(); ++k) {
    const PullCurve& curve = list[k];
    text += fmt::format("{} with lines lw 4 lc rgb '#d0d0d0' notitle, \\\n    ", curve.steady);
    text += fmt::format("'{}' index {} using 1:2 with lines lw 1.8 lc rgb '{}' title 'T = {}'{}", pull_file,
                        k, colours[k % std::size(colours)], curve.tension,
                        k + 1 < list.size() ? ", \\\n    " : "\n");
  }
  return text;
}

}  // namespace

Figure sliding(const Study& study, const Canvas& canvas) {
  std::vector<std::string> names;
  for (const Angle& angle : angles) names.insert(names.end(), {on_plate_run(angle), in_space_run(angle)});
  names.emplace_back(dragged_run);
  for (const std::string& name : names) write_strengths(name, study.at(name), canvas);
  const double friction = study.at(dragged_run).scene.friction.value();
  const std::vector<PullCurve> pulls = pull_curves(study);
  write_pulls(pulls, friction, canvas);

  output::Picture picture{"sliding", 10.0, 6.6, opening};
  picture.body +=
      std::string(closed_form) +
      "  S(T,phi) = T < limit(phi)*(1 - 1e-9) && phi < pi ? 2*T*sin(phi/2) : R(T,phi)\n" +
      tension_axis(0.29, 11) +
      "  set xtics (0.3, 0.5, 1, 2, 5, 10)\n  set key bottom right reverse Left samplen 2 font ',8'\n";
  for (std::size_t k = 0; k < std::size(angles); ++k) picture.body += panel_of_angle(study, angles[k], k);
  picture.body += pull_panel(pulls) + "  unset multiplot\n";
  output::run_gnuplot(picture, canvas.folder, canvas.formats);

  const auto& special = study.at(dragged_run).run.special_points;
  const auto turn = std::ranges::find(special, std::string("fold"), &output::SpecialPoint::type);
  const double fold = turn == special.end() ? std::nan("") : turn->T;
  names.insert(names.end(), {"4pi", "2pi"});
  return {
      "sliding",
      "Sliding strength of capstans that a plate holds back (the paper's “Numerical results for multiple "
      "capstans”, b–f, with friction in the shape)",
      "F0/μ at μ = 0.32, thin rod, its travel along itself blocked. Grey: the paper's closed form, below its "
      "line for φ < π one touch. Blue: the flat coil on its plate. Green: states that the cylinder has "
      "dragged "
      "off the plate, of 2π; for the other angles see what the search says. Orange dots: R_tot of the stable "
      "helix without plate and friction. (f) Force against displacement from rest; grey: F0/μ of the steady "
      "state.",
      names,
      {closed_form_statement(study), kink_statement(study), low_tension_statement(study, fold),
       dragged_statement(study, fold), search_statement(searches(study), fold),
       pull_statement(pulls, friction)}};
}

}  // namespace windlass::figures
