#include "contact_cell.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "knot_runs.hpp"
#include "windlass/output/atomic_file.hpp"
#include "windlass/output/rod_curve.hpp"
#include "windlass/rod/capstan.hpp"

namespace windlass::figures {

namespace {

bool is_line(const equilibrium::Solution& state, std::size_t arc) {
  return arc < state.arcs.size() && state.arcs[arc].kind == equilibrium::ArcKind::line;
}

}  // namespace

int lines_of(const equilibrium::Solution& state) {
  int lines = 0;  // one that strands press on is several arcs
  for (std::size_t k = 0; k < state.arcs.size(); ++k)
    lines += is_line(state, k) && (k == 0 || !is_line(state, k - 1));
  return lines;
}

int touches_of(const equilibrium::Solution& state) {
  int touches = 0;
  for (std::size_t k = 0; k < state.joints.size(); ++k)
    touches += state.joints[k].kind == equilibrium::JointKind::touch && !is_line(state, k) &&
               (k == 0 || !is_line(state, k - 1));
  return touches;
}

int strand_contacts_of(const equilibrium::Solution& state) {
  std::vector<const equilibrium::JointRecord*> touches;  // each once, along the rod
  for (std::size_t k = 0; k < state.joints.size(); ++k)
    if (state.joints[k].partner >= static_cast<int>(k)) touches.push_back(&state.joints[k]);
  const auto other = [&](const equilibrium::JointRecord& joint) {
    return state.joints.at(static_cast<std::size_t>(joint.partner)).s;
  };
  constexpr double next =
      0.1;  // [ρ] touches that stand for a line are nearer to each other along both strands
  std::vector<const equilibrium::JointRecord*> ends;  // the last touch of each contact so far
  for (const auto* touch : touches) {
    const auto of = std::ranges::find_if(ends, [&](const auto* end) {
      return std::abs(touch->s - end->s) < next && std::abs(other(*touch) - other(*end)) < next;
    });
    if (of == ends.end())
      ends.push_back(touch);
    else
      *of = touch;
  }
  return static_cast<int>(ends.size());
}

namespace {

/// Place round the axis [π].
double place(const Eigen::Vector3d& r) { return std::atan2(r.x(), -r.y()) / M_PI; }

/// Ends a line that a block of a data file draws; two empty lines would end the block.
void interrupt(std::string& block) {
  if (!block.ends_with("\n\n")) block += "\n";
}

ContactCell make_cell(const StudyRun& study, const std::string& stem, double tension, const Canvas& canvas) {
  ContactCell cell{stem, study.stable_state(tension), 0.0, 0.0};
  const output::RodCurve curve = output::dense_curve(cell.state);
  std::string pressed = "# place/pi | p | z; one block a line contact\n? ? ?\n",
              forces = "# place/pi | f | z\n? ? ?\n", between = "# place/pi | z\n? ?\n",
              strands = "# place/pi | f between strands | z\n? ? ?\n";
  double reach = 0.0;  // arclength of the outermost contacts
  for (const auto& force : output::point_forces(cell.state)) {
    (force.partner ? strands : forces) += fmt::format("{} {} {}\n", place(force.r), force.size, force.r.z());
    if (!force.partner) cell.highest_force = std::max(cell.highest_force, force.size);
    reach = std::max(reach, std::abs(force.s));
  }
  const auto round_the_back = [&](std::size_t i) {  // from one edge of the unrolled cylinder to the other
    return i > 0 && std::abs(place(curve.r[i]) - place(curve.r[i - 1])) > 1.0;
  };
  for (std::size_t i = 0; i < curve.s.size(); ++i) {
    if (round_the_back(i)) interrupt(between), interrupt(pressed);
    if (std::abs(curve.s[i]) <= reach) between += fmt::format("{} {}\n", place(curve.r[i]), curve.r[i].z());
    if (cell.state.arcs[curve.arc[i]].kind != equilibrium::ArcKind::line) continue;
    if (i > 0 && curve.arc[i] != curve.arc[i - 1]) interrupt(pressed);
    pressed += fmt::format("{} {} {}\n", place(curve.r[i]), curve.p[i], curve.r[i].z());
    cell.highest_pressure = std::max(cell.highest_pressure, curve.p[i]);
  }
  output::replace_file(canvas.folder / (stem + ".dat"),
                       std::string_view(pressed + "\n\n" + forces + "\n\n" + between + "\n\n" + strands));
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

std::vector<std::optional<ContactCell>> knot_cells(const Study& study, const Canvas& canvas) {
  std::vector<std::optional<ContactCell>> cells;
  for (const double tension : contact_tensions) {
    cells.emplace_back();
    for (const std::string& name : {clove_hitch_down_run(simulated), clove_hitch_up_run(simulated)}) {
      const StudyRun& run = study.at(name);
      const auto [low, high] = std::ranges::minmax_element(run.run.rows, {}, &output::BranchRow::T);
      if (low->T <= tension && tension <= high->T)
        cells.back() = make_cell(run, fmt::format("pressure-clove-hitch-{}", tension), tension, canvas);
    }
  }
  return cells;
}

std::string contact_heading(const ContactCell& cell) {
  constexpr double degrees = 180.0 / M_PI, flat = 1e-7;
  const int strands = strand_contacts_of(cell.state);
  std::string words = strands == 0 ? cell.state.topology
                                   : fmt::format("{} lines, {} touches, {} contacts of strands",
                                                 lines_of(cell.state), touches_of(cell.state), strands);
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
