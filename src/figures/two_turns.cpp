#include "two_turns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "windlass/output/atomic_file.hpp"
#include "windlass/output/gnuplot.hpp"

namespace windlass::figures {

std::vector<Drawn> drawn(const Study& study) {
  std::vector<Drawn> list;
  for (const Thickness& thickness : thicknesses)
    if (thickness.colour != nullptr) list.push_back({thickness, two_turns(study, thickness)});
  return list;
}

double spread(const std::vector<Drawn>& list, double tension) {
  double least = HUGE_VAL, most = 0.0;
  for (const Drawn& one : list) {
    const auto state = two_turns_at(one.states, tension);
    if (!state) return -1.0;
    least = std::min(least, state->R_tot), most = std::max(most, state->R_tot);
  }
  return most / least - 1.0;
}

std::string file_of(const Thickness& thickness) { return fmt::format("two-turns-{}.dat", thickness.name); }

void write_states(const std::vector<Drawn>& list, const Canvas& canvas) {
  for (const Drawn& one : list) {
    std::string text = "# T | R_tot | wrapping angle/pi | angle along lines/pi\n";
    for (const TwoTurns& state : one.states)
      text += output::data_line({state.T, state.R_tot, state.wrapping / M_PI, state.lines / M_PI});
    output::replace_file(canvas.folder / file_of(one.thickness), std::string_view(text));
  }
}

std::string curves(const std::vector<Drawn>& list, const std::string& columns, bool titles) {
  std::string text;
  double width = 1.4 + 1.8 * static_cast<double>(list.size() - 1);
  for (auto one = list.rbegin(); one != list.rend(); ++one, width -= 1.8)
    text += fmt::format(", \\\n    '{}' using {} with lines lw {} lc rgb '{}' {}", file_of(one->thickness),
                        columns, width, one->thickness.colour,
                        titles ? fmt::format("title 'R/r = {}'", one->thickness.name) : "notitle");
  return text;
}

std::vector<std::string> runs(const std::vector<Drawn>& list) {
  std::vector<std::string> names{"4pi"};
  for (const Drawn& one : list)
    names.insert(names.end(), {two_turns_down_run(one.thickness), two_turns_up_run(one.thickness)});
  return names;
}

}  // namespace windlass::figures
