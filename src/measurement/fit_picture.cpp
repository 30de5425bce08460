#include "windlass/measurement/fit_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "windlass/output/atomic_file.hpp"
#include "windlass/output/error.hpp"
#include "windlass/output/gnuplot.hpp"
#include "windlass/output/stable_state.hpp"

namespace windlass::measurement {

namespace fs = std::filesystem;

namespace {

constexpr double grams_per_newton = 1e3 / 9.80665;

/// Stable arms of the run: T, mu R_tot and the ends of its 95 % interval.
std::string curve_data(const output::Run& run, const FrictionFit& fit, double force) {
  std::string text =
      "# stable arms of the run: T | mu R_tot | with the low | and the high end of mu's 95 % interval\n";
  const auto line = [&](const output::BranchRow& row) {
    return fmt::format("{} {} {} {}\n", row.T * force, fit.mu * row.R_tot * force,
                       fit.low * row.R_tot * force, fit.high * row.R_tot * force);
  };
  bool open = false;
  for (std::size_t i = 1; i < run.rows.size(); ++i) {
    const output::BranchRow &a = run.rows[i - 1], &b = run.rows[i];
    const bool stable = a.branch == b.branch && output::index_between(a, b) == 0;
    if (stable && !open) text += line(a);
    if (stable) text += line(b);
    if (!stable && open) text += "\n";
    open = stable;
  }
  return text;
}

std::string point_data(std::span<const ComparedPoint> points, double mu, double force) {
  std::string text = "# T | F0 | its error (0: none given) | F0/(mu R_tot) | error of that\n";
  for (const ComparedPoint& point : points) {
    const double model = mu * point.R_tot, error = point.measured.F0_error.value_or(0.0);
    text += fmt::format("{} {} {} {} {}\n", point.measured.T * force, point.measured.F0 * force,
                        error * force, point.measured.F0 / model, error / model);
  }
  return text;
}

/// Range of T that holds the points, and that of F0 over it.
struct Window {
  double low = HUGE_VAL, high = 0.0, least = HUGE_VAL, most = 0.0;

  void include(std::span<const ComparedPoint> points, double mu) {
    for (const ComparedPoint& point : points) {
      low = std::min(low, point.measured.T), high = std::max(high, point.measured.T);
      for (const double force : {point.measured.F0, mu * point.R_tot}) {
        most = std::max(most, force);
        if (force > 0.0) least = std::min(least, force);
      }
    }
  }
};

std::string upper_panel(const Window& window, double force, bool physical, bool has_left_out) {
  const double x_low = 0.85 * window.low * force, x_high = 1.18 * window.high * force;
  const double y_low = 0.75 * window.least * force, y_high = 1.35 * window.most * force;
  std::string text = output::margins(0.13, 0.95, 0.40, physical ? 0.85 : 0.92);
  text +=
      fmt::format("  set log xy\n  set xrange [{}:{}]\n  set yrange [{}:{}]\n", x_low, x_high, y_low, y_high);
  text += output::log_tics("ytics", y_low, y_high);
  text += "  set format x ''\n  set key bottom right reverse Left samplen 2.5\n";
  text += physical ? "  set ylabel 'sliding strength F_0  [N]'\n"
                   : "  set ylabel 'sliding strength F_0  [EI/ρ²]'\n";
  if (physical)
    text += fmt::format(
        "  set log x2\n  set x2range [{}:{}]\n  set xtics nomirror\n{}"
        "  set x2label 'mass hung at each end  [g]' offset 0,-0.3\n",
        x_low * grams_per_newton, x_high * grams_per_newton,
        output::log_tics("x2tics", x_low * grams_per_newton, x_high * grams_per_newton));
  text +=
      "  plot 'fit-curve.dat' using 1:3:4 with filledcurves lc rgb '#bcd6e8' title '95 % interval', \\\n"
      "    '' using 1:2 with lines lw 2 lc rgb '#0072b2' title 'μ R_{tot}(T), stable states', \\\n"
      "    'fit-points.dat' using 1:2:3 with yerrorbars pt 7 ps 0.7 lc rgb 'black' title 'measured'";
  if (has_left_out)
    text +=
        ", \\\n    'fit-left-out.dat' using 1:2:3 with yerrorbars pt 6 ps 0.7 lc rgb '#888888' title 'left "
        "out'";
  return text + "\n";
}

std::string lower_panel(const Window& window, double force, bool physical, bool has_left_out) {
  std::string text = output::margins(0.13, 0.95, 0.11, 0.36);
  text += output::log_tics("xtics", 0.85 * window.low * force, 1.18 * window.high * force);
  text +=
      "  unset log y\n  set yrange [*:*]\n  set ytics autofreq\n  set format x '%g'\n  unset key\n  unset "
      "x2tics\n  unset x2label\n"
      "  set xtics mirror\n  set ylabel 'F_0 / (μ R_{tot})'\n";
  text += physical ? "  set xlabel 'tension T  [N]'\n" : "  set xlabel 'tension T  [EI/ρ²]'\n";
  text +=
      "  plot 1 with lines lw 2 lc rgb '#0072b2', \\\n"
      "    'fit-points.dat' using 1:4:5 with yerrorbars pt 7 ps 0.7 lc rgb 'black'";
  if (has_left_out)
    text += ", \\\n    'fit-left-out.dat' using 1:4:5 with yerrorbars pt 6 ps 0.7 lc rgb '#888888'";
  return text + "\n";
}

}  // namespace

std::vector<fs::path> draw_fit(const output::Run& run, const FrictionFit& fit,
                               std::span<const ComparedPoint> points, std::span<const ComparedPoint> left_out,
                               const std::optional<scene::Units>& units, const fs::path& folder,
                               const std::vector<std::string>& formats) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw output::OutputError("cannot make the folder " + folder.string() + ": " + error.message());
  const double force = units ? units->force : 1.0;
  output::replace_file(folder / "fit-curve.dat", std::string_view(curve_data(run, fit, force)));
  output::replace_file(folder / "fit-points.dat", std::string_view(point_data(points, fit.mu, force)));
  if (!left_out.empty())
    output::replace_file(folder / "fit-left-out.dat", std::string_view(point_data(left_out, fit.mu, force)));
  Window window;
  window.include(points, fit.mu);
  window.include(left_out, fit.mu);
  output::Picture picture{"fit", 6.0, 6.2, {}};
  picture.body = "  set multiplot\n  set tics font ',9'\n  set grid lc rgb '#dddddd'\n";
  picture.body += "  set label 1 " +
                  output::gnuplot_text(
                      fmt::format("{}:  μ = {:.4g} ± {:.2g}", run.info.scene, fit.mu, fit.standard_error)) +
                  " at screen 0.54, screen 0.965 center font ',11'\n";
  picture.body += upper_panel(window, force, units.has_value(), !left_out.empty()) + "  unset label\n";
  picture.body += lower_panel(window, force, units.has_value(), !left_out.empty()) + "  unset multiplot\n";
  return output::run_gnuplot(picture, folder, formats);
}

}  // namespace windlass::measurement
