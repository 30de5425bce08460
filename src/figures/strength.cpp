#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "style.hpp"
#include "windlass/output/gnuplot.hpp"
#include "windlass/output/stable_state.hpp"
#include "windlass/rod/capstan.hpp"

namespace windlass::figures {

namespace capstan = rod::capstan;
using Verdict = Statement::Verdict;

namespace {

/// Highest index on the flat branch of a run: 0 if the flat state is stable throughout.
int highest_index(const StudyRun& study) {
  int highest = 0;
  for (const auto& row : study.run.rows)
    if (row.branch == 1) highest = std::max(highest, row.index.value_or(0));
  return highest;
}

double branch_point(const Study& study, const char* run) {
  return study.at(run).flat_event("branch_point").value_or(std::nan(""));
}

/// Curves of one angle; `legend` gives them names.
std::string curves(const StudyRun& study, const std::string& run, bool legend) {
  const auto title = [&](const char* text) { return legend ? fmt::format("title '{}'", text) : "notitle"; };
  const std::string flat = fmt::format("lc rgb '{}' ", flat_colour),
                    helical = fmt::format("lc rgb '{}' ", helical_colour);
  std::string text =
      fmt::format("R(x,{}) with lines lw 7 lc rgb '#d0d0d0' {}, \\\n    ", study.phi(), title("closed form"));
  text += item(run, 0, 2, flat + "lw 2 " + title("flat, stable")) + ", \\\n    ";
  text += item(run, 1, 2, flat + "lw 1.3 dt (14,9) " + title("flat, unstable")) + ", \\\n    ";
  text += item(run, 2, 2, flat + "lw 2 notitle") + ", \\\n    " +
          item(run, 3, 2, flat + "lw 1.3 dt (14,9) notitle") + ", \\\n    ";
  text += item(run, 4, 2, helical + "lw 2 " + title("helical, stable")) + ", \\\n    ";
  return text + item(run, 5, 2, helical + "lw 1.3 dt (14,9) " + title("helical, unstable"));
}

std::string panel(const Study& study, const Angle& angle, std::size_t k) {
  const double left = 0.065 + 0.323 * static_cast<double>(k % 3), bottom = k < 3 ? 0.585 : 0.1;
  const StudyRun& run = study.at(angle.run);
  std::string text = output::margins(left, left + 0.265, bottom, bottom + 0.35);
  text += panel_letter(static_cast<char>('a' + k), fmt::format("φ = {}", angle.title));
  const double high = 1.6 * capstan::total_force(20.0, run.phi());
  text += force_axis(std::max(0.03, high * 4e-4), high, k % 3 == 0 ? "F_0/μ  [EI/ρ²]" : "");
  text += "  plot " + curves(run, angle.run, false);
  if (k == 1) text += ", \\\n    " + item("2pi-clamped", 4, 2, "lw 1.5 dt (3,6) lc rgb 'black' notitle");
  return text + "\n";
}

std::string legend(const Study& study) {
  return output::margins(0.72, 0.98, 0.1, 0.45) +
         "  unset label 50\n  unset tics\n  unset border\n  unset grid\n  unset xlabel\n  unset ylabel\n"
         "  set yrange [1e6:1e7]\n  set key center center reverse Left samplen 3 spacing 1.4 font ',10'\n  "
         "plot " +
         curves(study.at("4pi"), "4pi", true) +
         ", \\\n    1e-9 with lines lw 1.5 dt (3,6) lc rgb 'black' title 'helical, ends clamped (b)'\n";
}

/// Stable states at tensions where one that reaches higher tensions is stable too.
void add_further_states(std::vector<Statement>& list, const StudyRun& study, const char* name) {
  const auto stretches = output::stable_stretches(study.run);
  for (std::size_t k = 1; k < stretches.size(); ++k) {
    const auto& inner = stretches[k];
    const bool further = std::any_of(stretches.begin(), stretches.begin() + static_cast<std::ptrdiff_t>(k),
                                     [&](const auto& outer) { return outer.lowest < inner.lowest; });
    if (!further) continue;
    const auto& row = study.run.rows[(inner.first + inner.last) / 2];
    list.push_back(
        {"—",
         fmt::format("{}: between T = {:.4f} and {:.4f} a second state is stable ({}; R_tot = {:.3f} at T "
                     "= {:.3f}, the first has {:.3f})",
                     name, inner.lowest, inner.highest, row.topology, row.R_tot, row.T,
                     study.stable_force(row.T)),
         Verdict::remark,
         "which of the two a rod is in depends on its history; numbers here are those of the first, "
         "which a coil slackened from high tension is in"});
  }
}

std::vector<Statement> strength_statements(const Study& study) {
  std::vector<Statement> list;
  list.push_back(
      {"for φ ≤ π the configuration stays planar over the whole range of T",
       fmt::format(
           "index of the flat state, all perturbations in space, T from 40 to 0.1: at most {} (π), {} "
           "(π/2), {} (π/4)",
           highest_index(study.at("pi")), highest_index(study.at("half-pi")),
           highest_index(study.at("quarter-pi"))),
       Verdict::agrees, ""});
  list.push_back(
      {"for φ > π the coil relaxes from planar into a helix at low tension, with a kink of F0(T) at T = 0.5",
       fmt::format("the flat coil is left for a helix at T = {:.5f} (2π) and {:.5f} (4π); F0 has its kink "
                   "there. With "
                   "clamped ends it is T = {:.5f} (2π)",
                   branch_point(study, "2pi"), branch_point(study, "4pi"),
                   branch_point(study, "2pi-clamped")),
       Verdict::differs,
       "T = 1/2 is where the flat line contact ceases to exist, not where it ceases to be stable. An endless "
       "helix on the "
       "cylinder has T = (3/2) cos⁴ψ, so long coils are flat only above T = 3/2. The experiments and "
       "simulations hold the "
       "turns between plates, hold the end rotations while the cylinder moves, have rods as thick as the "
       "cylinder, whose "
       "turns touch each other, and friction; all of these keep a coil flat, and none is in this model"});
  list.push_back({"F0 is markedly sublinear below T = 0.5 for φ > π",
                  fmt::format("slope of the stable helix at T = 0.3: {:.3f} (2π), {:.3f} (4π)",
                              study.at("2pi").stable_log_slope(0.3), study.at("4pi").stable_log_slope(0.3)),
                  Verdict::agrees, ""});
  const double flat = capstan::total_force(0.6, 2.0 * M_PI), helix = study.at("2pi").stable_force(0.6);
  list.push_back(
      {"FEM and DER follow the planar closed form down to T = 0.5",
       fmt::format(
           "the stable helix carries more than the flat coil: {:.3f} against {:.3f} at T = 0.6 for 2π", helix,
           flat),
       Verdict::differs, "as above: the flat coil at that tension needs something that holds it flat"});
  for (const char* run : {"2pi", "4pi"}) add_further_states(list, study.at(run), run);
  list.push_back({"the sliding strength does not depend on R/r (1, 2.5, 5)",
                  "true by construction: only ρ = R + r enters", Verdict::agrees, ""});
  return list;
}

}  // namespace

Figure strength(const Study& study, const Canvas& canvas) {
  output::Picture picture{"strength", 10.0, 6.6, opening};
  picture.body += closed_form + tension_axis(0.1, 20) + "  unset key\n";
  for (std::size_t k = 0; k < std::size(angles); ++k) picture.body += panel(study, angles[k], k);
  picture.body += legend(study) + "  unset multiplot\n";
  output::run_gnuplot(picture, canvas.folder, canvas.formats);
  return {
      "strength",
      "Sliding strength at five capstan angles (the paper's “Numerical results for multiple capstans”, b–f)",
      "F0/μ = R_tot. Grey: the paper's closed form. Blue: flat states, orange: helical ones that leave them; "
      "dashed: "
      "unstable. Black dots in (b): the helix of a rod with clamped ends.",
      {"4pi", "2pi", "pi", "half-pi", "quarter-pi", "2pi-clamped"},
      strength_statements(study)};
}

Figure collapse(const Study& study, const Canvas& canvas) {
  output::Picture picture{"collapse", 9.0, 4.2, opening};
  picture.body += closed_form + tension_axis(0.1, 40) + force_axis(0.04, 60, "F_0/(μ φ)  [EI/ρ²]") +
                  "  set key bottom right reverse Left samplen 2.5\n";
  std::string analytical, computed, separator;
  for (const Angle& angle : angles) {
    const std::string style = fmt::format("lw 2 lc rgb '{}' ", angle.colour);
    analytical += separator + fmt::format("R(x,{0})/{0} with lines {1} title 'φ = {2}'",
                                          study.at(angle.run).phi(), style, angle.title);
    for (const int block : {0, 2, 4})
      computed += (computed.empty() ? "" : ", \\\n    ") +
                  item(angle.run, block, 5,
                       style + (block == 0 ? fmt::format("title 'φ = {}'", angle.title) : "notitle"));
    separator = ", \\\n    ";
  }
  const std::string line = ", \\\n    x with lines lw 1 dt (14,9) lc rgb 'black' title 'F_0 = μ φ T'\n";
  picture.body += output::margins(0.075, 0.485, 0.15, 0.9) +
                  panel_letter('a', "closed form of the flat coil") + "  plot " + analytical + line;
  picture.body += output::margins(0.575, 0.985, 0.15, 0.9) +
                  panel_letter('b', "stable states, flat and helical") + "  plot " + computed + line +
                  "  unset multiplot\n";
  output::run_gnuplot(picture, canvas.folder, canvas.formats);

  std::string at_one, at_ten;
  for (const Angle& angle : angles) {
    const auto ratio = [&](double T) {
      return study.at(angle.run).stable_force(T) / (study.at(angle.run).phi() * T);
    };
    at_one += fmt::format("{}{}: {:.3f}", at_one.empty() ? "" : ", ", angle.title, ratio(1.0));
    at_ten += fmt::format("{}{}: {:.3f}", at_ten.empty() ? "" : ", ", angle.title, ratio(10.0));
  }
  return {"collapse",
          "Collapse of the sliding strength (the paper's F0/φ)",
          "F0/(μ φ) against T; the dashed line is the limit of high tension. In (b) the short piece apart "
          "from the others, "
          "if any, is a second stable state of 4π.",
          {"4pi", "2pi", "pi", "half-pi", "quarter-pi"},
          {{"at high tension all curves collapse onto R_tot = φ T", "R_tot/(φ T) at T = 10: " + at_ten,
            Verdict::agrees, ""},
           {"the friction coefficient can be read off as μ = F0/(φ T)",
            "so read at T = 10 it comes out low by what these ratios lack to 1; `windlass fit` uses R_tot(T) "
            "instead",
            Verdict::agrees, ""},
           {"collapse and planar model are accurate for T ≥ 1",
            "R_tot/(φ T) of the stable states at T = 1: " + at_one, Verdict::differs,
            "2π and 4π are helical at T = 1 (see the figure before), and the angles below their limit touch "
            "at one point"}}};
}

}  // namespace windlass::figures
