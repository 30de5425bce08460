#include "contact_cell.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "windlass/output/atomic_file.hpp"
#include "windlass/output/rod_curve.hpp"
#include "windlass/rod/capstan.hpp"

namespace windlass::figures {

namespace {

/// Place round the axis [π]; a contact of less than a turn needs no unrolling.
double place(const Eigen::Vector3d& r) { return std::atan2(r.x(), -r.y()) / M_PI; }

ContactCell make_cell(const StudyRun& study, const std::string& stem, double tension, const Canvas& canvas) {
  ContactCell cell{stem, study.stable_state(tension), 0.0, 0.0};
  const output::RodCurve curve = output::dense_curve(cell.state);
  std::string pressed = "# place/pi | p | z; one block a line contact\n? ? ?\n",
              forces = "# place/pi | f | z\n? ? ?\n", between = "# place/pi | z\n? ?\n";
  double reach = 0.0;  // arclength of the outermost contacts
  for (const auto& force : output::point_forces(cell.state)) {
    forces += fmt::format("{} {} {}\n", place(force.r), force.size, force.r.z());
    cell.highest_force = std::max(cell.highest_force, force.size);
    reach = std::max(reach, std::abs(force.s));
  }
  for (std::size_t i = 0; i < curve.s.size(); ++i) {
    if (std::abs(curve.s[i]) <= reach) between += fmt::format("{} {}\n", place(curve.r[i]), curve.r[i].z());
    if (cell.state.arcs[curve.arc[i]].kind != equilibrium::ArcKind::line) continue;
    if (i > 0 && curve.arc[i] != curve.arc[i - 1]) pressed += "\n";
    pressed += fmt::format("{} {} {}\n", place(curve.r[i]), curve.p[i], curve.r[i].z());
    cell.highest_pressure = std::max(cell.highest_pressure, curve.p[i]);
  }
  output::replace_file(canvas.folder / (stem + ".dat"),
                       std::string_view(pressed + "\n\n" + forces + "\n\n" + between));
  return cell;
}

}  // namespace

std::vector<ContactCell> contact_cells(const Study& study, const Canvas& canvas) {
  std::vector<ContactCell> cells;
  for (const double tension : contact_tensions)
    for (const char* angle : contact_angles)
      cells.push_back(
          make_cell(study.at(angle), fmt::format("pressure-{}-{}", angle, tension), tension, canvas));
  return cells;
}

std::string contact_heading(const ContactCell& cell) {
  constexpr double degrees = 180.0 / M_PI, flat = 1e-7;
  std::string words = cell.state.topology;
  words += cell.state.z_span > flat ? fmt::format(",  helical, tilt {:.0f}°", cell.state.tilt * degrees)
                                    : ",  flat";
  return fmt::format("  set label 51 '{}' at graph 0.5, graph 1.06 center font ',9'\n", words);
}

std::string flat_contact_band(const equilibrium::Solution& state) {
  if (!rod::capstan::line_contact(state.T, state.phi)) return "  unset object 1\n";
  const double reach = rod::capstan::phi_star(state.T, state.phi) / M_PI;
  return fmt::format(
      "  set object 1 rectangle from first {}, graph 0 to first {}, graph 1 fc rgb '#e4e4e4' fs noborder "
      "behind\n",
      -reach, reach);
}

std::string column_titles(double left, double right) {
  std::string text;
  for (int column = 0; column < 2; ++column)
    text += fmt::format("  set label {} '{}' at screen {}, screen 0.978 center font ',11'\n", 60 + column,
                        contact_titles[column], column == 0 ? left : right);
  return text;
}

}  // namespace windlass::figures
