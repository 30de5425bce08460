#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "plot_diagram_data.hpp"
#include "plot_labels.hpp"
#include "smooth_piece.hpp"
#include "windlass/output/atomic_file.hpp"
#include "windlass/output/branches_csv.hpp"
#include "windlass/output/error.hpp"
#include "windlass/output/gnuplot.hpp"
#include "windlass/output/plot.hpp"

namespace windlass::output {

namespace fs = std::filesystem;

namespace {

/// Colours that remain distinct in print and for colour-blind readers (Okabe & Ito).
constexpr const char* colours[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                   "#e69f00", "#56b4e9", "#7f7f7f"};
constexpr int colour_count = 7;

std::string colour_of(int branch) { return colours[(branch - 1 + colour_count * 1000) % colour_count]; }

std::string line_style(const DiagramData& data, const Piece& piece) {
  if (data.locus) return "lc rgb '" + colour_of(1) + "' lw 2.2 dt solid";
  std::string style = "lc rgb '" + colour_of(piece.branch) + "'";
  if (piece.state == ArmState::stable) return style + " lw 2.2 dt solid";
  if (piece.state == ArmState::unstable) return style + " lw 1.4 dt (12,7)";
  return style + " lw 1.4 dt solid";
}

std::string marker(const std::string& type) {
  if (type == "fold") return "pt 9 ps 0.9 lc rgb 'black'";
  if (type == "branch_point") return "pt 7 ps 0.8 lc rgb 'black'";
  return "pt 4 ps 0.7 lc rgb '#555555'";
}

void write_data(const DiagramData& data, const fs::path& path) {
  std::string text = "# columns: " + data.x.name;
  for (const Axis& axis : data.panels) text += " | " + axis.name;
  text +=
      "\n# blocks (separated by two blank lines) are arms of one branch with one stability; ? = not "
      "defined; rows between the run's points are interpolated\n";
  std::vector<const Axis*> axes{&data.x};
  for (const Axis& axis : data.panels) axes.push_back(&axis);
  for (const Piece& coarse : data.pieces) {
    const Piece piece = smooth(coarse, axes);
    text += "# branch " + std::to_string(piece.branch) + ", " + arm_state_name(piece.state) + "\n";
    for (std::size_t i = 0; i < piece.rows.size(); ++i) {
      const auto& values = piece.rows[i];
      if (i > 0 && piece.breaks.contains(i)) text += "\n";
      text += data_line(values);
    }
    text += "\n\n";
  }
  replace_file(path, std::string_view(text));
}

void write_special(const DiagramData& data, const fs::path& path) {
  std::string text = "# label | type | " + data.x.name;
  for (const Axis& axis : data.panels) text += " | " + axis.name;
  text += "\n";
  for (const char* type : special_types) {
    text += std::string("# ") + type + "\n";
    for (const SpecialMark& mark : data.special) {
      if (mark.type != type) continue;
      text += "\"" + mark.label + "\" " + mark.type + " " + data_line(mark.values);
    }
    text += "\n\n";
  }
  replace_file(path, std::string_view(text));
}

void write_measured(const PlotOptions& options, const fs::path& path) {
  std::string text = "# measured: T R_tot\n";
  for (const auto& [T, force] : options.measured) text += data_line({T, force});
  replace_file(path, std::string_view(text));
}

bool has_type(const DiagramData& data, const std::string& type) {
  return std::any_of(data.special.begin(), data.special.end(),
                     [&](const SpecialMark& m) { return m.type == type; });
}

std::string tics(const char* name, const Axis& axis) {
  return axis.log ? log_tics(name, axis.low, axis.high) : std::string("  set ") + name + " autofreq\n";
}

std::string range_text(const Axis& axis) {
  return "[" + format_number(axis.low) + ":" + format_number(axis.high) + "]";
}

/// Commands of one panel; special points are named in the first only.
std::string panel_commands(const DiagramData& data, std::size_t column, const std::string& stem,
                           bool has_measured) {
  const Axis& y = data.panels[column];
  const std::string using_x_y = " using 1:" + std::to_string(column + 2);
  std::string text = "  set xlabel " + gnuplot_text(data.x.title, false) + " offset 0,0.3\n";
  const bool wide_tics = y.log && y.high >= 100.0;
  text += "  set ylabel " + gnuplot_text(y.title, false) + (wide_tics ? "\n" : " offset 0.8,0\n");
  text += data.x.log ? "  set log x\n" : "  unset log x\n";
  text += y.log ? "  set log y\n" : "  unset log y\n";
  text += "  set xrange " + range_text(data.x) + "\n  set yrange " + range_text(y) + "\n";
  if (column == 0) text += label_commands(data);
  text += tics("xtics", data.x) + tics("ytics", y) + "  plot";
  std::string separator = " ";
  for (std::size_t i = 0; i < data.pieces.size(); ++i) {
    text += separator + "'" + stem + ".dat' index " + std::to_string(i) + using_x_y + " with lines notitle " +
            line_style(data, data.pieces[i]);
    separator = ", \\\n    ";
  }
  int block = -1;  // gnuplot counts only blocks that hold data
  for (std::size_t k = 0; k < std::size(special_types); ++k) {
    if (!has_type(data, special_types[k])) continue;
    ++block;
    text += separator + "'" + stem + "-special.dat' index " + std::to_string(block) +
            " using 3:" + std::to_string(column + 4) + " with points notitle " + marker(special_types[k]);
  }
  if (has_measured && column == 0) {
    text += separator + "'" + stem +
            "-measured.dat' using 1:2 with points pt 2 ps 0.8 lc rgb 'black' title 'measured'";
  }
  return text + "\n";
}

/// A strip of its own for the legend, so that it never covers a curve.
std::string legend_commands(const DiagramData& data, double top) {
  std::map<int, bool> branches;
  std::map<ArmState, bool> states;
  if (!data.locus)
    for (const Piece& piece : data.pieces) branches[piece.branch] = true, states[piece.state] = true;
  std::string text = margins(0.02, 0.98, 0.1 * top, 0.9 * top) +
                     "  unset log\n  unset xlabel\n  unset ylabel\n  unset tics\n  unset border\n  unset "
                     "grid\n  set xrange [0:1]\n"
                     "  set yrange [0:1]\n  set key at screen 0.5, screen " +
                     format_number(0.5 * top) +
                     " center center horizontal width 1 samplen 3 font ',9'\n  plot";
  std::string separator = " ";
  const auto entry = [&](const std::string& style, const std::string& title) {
    text += separator + "NaN " + style + " title " + gnuplot_text(title);
    separator = ", \\\n    ";
  };
  if (data.locus) entry("with lines " + line_style(data, {}), data.title.substr(data.title.find(',') + 2));
  if (states.contains(ArmState::stable)) entry("with lines lc rgb 'black' lw 2.2 dt solid", "stable");
  if (states.contains(ArmState::unstable)) entry("with lines lc rgb 'black' lw 1.4 dt (12,7)", "unstable");
  if (states.contains(ArmState::unknown))
    entry("with lines lc rgb 'black' lw 1.4 dt solid", "stability not computed");
  if (branches.size() > 1 && branches.size() <= static_cast<std::size_t>(colour_count)) {
    for (const auto& [branch, unused] : branches) {
      entry("with lines lw 3 lc rgb '" + colour_of(branch) + "'", "branch " + std::to_string(branch));
    }
  }
  for (const char* type : special_types) {
    std::string title = type;
    std::replace(title.begin(), title.end(), '_', ' ');
    if (title == "contact") title = "contact event";
    if (has_type(data, type)) entry("with points " + marker(type), title);
  }
  return text + "\n";
}

/// Axes in newtons, or grams hung at each end, opposite to the dimensionless ones; gnuplot cannot link log axes, so they
/// are set alongside. The right axis only where y is a force.
std::string physical_axes(const Axis& x, double x_scale, const char* x_title, const Axis* y, double y_scale) {
  const auto scaled = [](Axis axis, double scale) {
    axis.low *= scale, axis.high *= scale;
    return axis;
  };
  const Axis x2 = scaled(x, x_scale);
  std::string text = std::string(x.log ? "  set log x2\n" : "") + "  set x2range " + range_text(x2) + "\n" +
                     tics("x2tics", x2) + "  set xtics nomirror\n  set x2label '" + x_title +
                     "' offset 0,-0.4\n";
  if (y == nullptr) return text;
  const Axis y2 = scaled(*y, y_scale);
  return text + (y2.log ? "  set log y2\n" : "") + "  set y2range " + range_text(y2) + "\n" +
         tics("y2tics", y2) + "  set ytics nomirror\n  set y2label 'contact force  [N]' offset -1,0\n";
}

constexpr const char* no_physical_axes =
    "  unset log x2\n  unset log y2\n  unset x2tics\n  unset y2tics\n  unset x2label\n  unset y2label\n"
    "  set xtics mirror\n  set ytics mirror\n";

/// Widens the ranges so that measured points are seen.
void include_measured(DiagramData& data, const std::vector<std::pair<double, double>>& measured) {
  const auto include = [](Axis& axis, double value) {
    if (axis.log && !(value > 0.0)) return;
    axis.low = std::min(axis.low, axis.log ? 0.8 * value : value);
    axis.high = std::max(axis.high, axis.log ? 1.25 * value : value);
  };
  for (const auto& [T, force] : measured) include(data.x, T), include(data.panels[0], force);
}

}  // namespace

std::vector<fs::path> plot_diagram(const Run& run, const PlotOptions& options, const fs::path& folder,
                                   const std::string& stem) {
  if (run.rows.empty()) throw OutputError("the run " + run.folder.string() + " holds no points to plot");
  DiagramData data = diagram_data(run);
  const bool against_T = run.info.has_cylinder && data.x.name == "T";
  if (!options.measured.empty() && !against_T)
    throw OutputError("measured points (T, F0) belong on a diagram in load.tension");
  include_measured(data, options.measured);
  write_data(data, folder / (stem + ".dat"));
  write_special(data, folder / (stem + "-special.dat"));
  if (!options.measured.empty()) write_measured(options, folder / (stem + "-measured.dat"));
  // margins in inches, so that one panel or four look alike
  const std::size_t columns = data.panels.size() == 1 ? 1 : 2,
                    rows = (data.panels.size() + columns - 1) / columns;
  const bool physical = options.units.has_value() && against_T;
  const double head = physical ? 0.75 : 0.42, foot = 0.62, pitch = 2.7, width = physical ? 8.8 : 8.0;
  const double height = head + foot + pitch * static_cast<double>(rows);
  Picture picture{stem, width, height, {}};
  std::string& body = picture.body;
  body +=
      "  set datafile missing '?'\n  set multiplot\n  set tics font ',9'\n  set grid lc rgb '#dddddd'\n  set "
      "key top left\n";
  body += "  set label 1 " + gnuplot_text(data.title) + " at screen 0.5, screen " +
          format_number(1 - 0.18 / height) + " center font ',11'\n";
  for (std::size_t k = 0; k < data.panels.size(); ++k) {
    const bool newtons = physical && k == 0, grams = physical && k == 1;
    const double left = k % columns == 0 ? 0.76 : width - 3.2,
                 right = columns == 1 ? width - 0.25 : left + 3.04;
    const double top = height - head - pitch * static_cast<double>(k / columns), bottom = top - pitch + 0.62;
    body += margins(left / width, right / width, bottom / height, top / height);
    const double force = physical ? options.units->force : 1.0;
    if (newtons) body += physical_axes(data.x, force, "tension  [N]", &data.panels[0], force);
    if (grams) body += physical_axes(data.x, force / 9.80665e-3, "mass hung at each end  [g]", nullptr, 1.0);
    body += panel_commands(data, k, stem, !options.measured.empty());
    if (newtons || grams) body += no_physical_axes;
    if (k == 0) body += "  unset label\n";
  }
  body += legend_commands(data, foot / height) + "  unset multiplot\n";
  return run_gnuplot(picture, folder, options.formats);
}

}  // namespace windlass::output
