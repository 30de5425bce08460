#include "plot_labels.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "windlass/output/branches_csv.hpp"
#include "windlass/output/gnuplot.hpp"

namespace windlass::output {

namespace {

using Place = std::pair<double, double>;  ///< in parts of the panel

/// Size of a name, in parts of the panel.
constexpr double wide = 0.085, tall = 0.06;

double part(const Axis& axis, double value) {
  return axis.log ? std::log(value / axis.low) / std::log(axis.high / axis.low)
                  : (value - axis.low) / (axis.high - axis.low);
}

bool overlaps(const Place& a, const Place& b, double width, double height) {
  return std::abs(a.first - b.first) < width && std::abs(a.second - b.second) < height;
}

/// The curves of the first panel as dense dots.
std::vector<Place> curve_places(const DiagramData& data) {
  std::vector<Place> places;
  for (const Piece& piece : data.pieces)
    for (std::size_t i = 1; i < piece.rows.size(); ++i) {
      const Place a(part(data.x, piece.rows[i - 1][0]), part(data.panels[0], piece.rows[i - 1][1])),
          b(part(data.x, piece.rows[i][0]), part(data.panels[0], piece.rows[i][1]));
      const double length = std::hypot(b.first - a.first, b.second - a.second);
      if (!std::isfinite(length)) continue;
      const int dots = std::clamp(static_cast<int>(length / 0.01), 1, 200);
      for (int k = 0; k < dots; ++k) {
        const double t = static_cast<double>(k) / dots;
        places.emplace_back(a.first + t * (b.first - a.first), a.second + t * (b.second - a.second));
      }
    }
  return places;
}

struct Choice {
  Place at;
  int side = 1;
};

/// Of the four corners round a marker the one whose name covers least; none where every corner is taken.
std::optional<Choice> choose(const Place& marker, const std::vector<Place>& curves,
                             const std::vector<Place>& taken) {
  std::optional<Choice> best;
  std::ptrdiff_t least = 0;
  for (const auto& [side, lift] :
       std::array{std::pair(1, -1), std::pair(-1, 1), std::pair(1, 1), std::pair(-1, -1)}) {
    const Place at(marker.first + side * (0.015 + wide / 2), marker.second + lift * 0.045);
    const bool outside =
        at.first < wide / 2 || at.first > 1 - wide / 2 || at.second < tall / 2 || at.second > 1 - tall / 2;
    if (outside ||
        std::any_of(taken.begin(), taken.end(), [&](const Place& t) { return overlaps(t, at, wide, tall); }))
      continue;
    const auto covered = std::count_if(curves.begin(), curves.end(),
                                       [&](const Place& c) { return overlaps(c, at, wide / 2, tall / 2); });
    if (!best || covered < least) best = Choice{at, side}, least = covered;
  }
  return best;
}

}  // namespace

std::string label_commands(const DiagramData& data) {
  const std::vector<Place> curves = curve_places(data);
  std::vector<Place> taken;
  std::string text;
  int number = 100;
  for (const SpecialMark& mark : data.special) {
    const Place marker(part(data.x, mark.values[0]), part(data.panels[0], mark.values[1]));
    if (!std::isfinite(marker.first) || !std::isfinite(marker.second)) continue;
    const auto choice = choose(marker, curves, taken);
    if (!choice) continue;
    taken.push_back(choice->at);
    text += "  set label " + std::to_string(number++) + " " + gnuplot_text(mark.label) + " at graph " +
            format_number(choice->at.first - choice->side * wide / 2) + ", graph " +
            format_number(choice->at.second) + (choice->side > 0 ? " left" : " right") + " font ',8'\n";
  }
  return text;
}

}  // namespace windlass::output
