#include "windlass/output/tube_view.hpp"

#include <algorithm>

#include "windlass/output/gnuplot.hpp"

namespace windlass::output {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

using Colour = std::array<double, 3>;  ///< red, green, blue, 0 to 255

Colour parts(unsigned colour) {
  return {static_cast<double>(colour >> 16), static_cast<double>(colour >> 8 & 0xffU),
          static_cast<double>(colour & 0xffU)};
}

/// From one colour towards another.
unsigned mixed(unsigned from, unsigned to, double share) {
  const Colour a = parts(from), b = parts(to);
  unsigned colour = 0;
  for (std::size_t k = 0; k < 3; ++k)
    colour = colour << 8 | static_cast<unsigned>(std::lround((1.0 - share) * a[k] + share * b[k]));
  return colour;
}

/// Perpendicular to the tangent as it is seen; `before` where the rod points at the eye.
Vector2d side_of(const Eigen::Quaterniond& q, const View& view, const Vector2d& before) {
  const Vector2d along = view.project(q * Vector3d::UnitZ());
  constexpr double end_on = 1e-6;
  if (along.norm() < end_on) return before;
  return Vector2d(-along.y(), along.x()) / along.norm();
}

/// @param half  width over that of the tube
/// @param over  longer by this at either end, but no longer than the rod
/// @param short_of  less this, at the rod's ends
std::string strip(const TubePiece& piece, double half, double over, double short_of, unsigned colour) {
  std::string text;
  const auto corner = [&](std::size_t end, double across) {
    const Vector2d& side = piece.side[end];
    const Vector2d along = Vector2d(side.y(), -side.x()).normalized();
    const double by = (end == 0 ? -1.0 : 1.0) * std::min(over, piece.rest[end] - short_of);
    const Vector2d at = piece.centre[end] + by * along + across * side;
    text += data_line({at.x(), at.y(), static_cast<double>(colour)});
  };
  corner(0, -half), corner(0, half), corner(1, half), corner(1, -half);
  return text + "\n";
}

}  // namespace

std::vector<TubePiece> tube_pieces(const RodCurve& curve, double radius, const View& view,
                                   const std::function<unsigned(std::size_t place)>& colour_of) {
  std::vector<TubePiece> pieces;
  Vector2d side = Vector2d::UnitY();
  for (std::size_t i = 0; i + 1 < curve.s.size(); ++i) {
    const Vector2d here = side_of(curve.q[i], view, side);
    side = side_of(curve.q[i + 1], view, here);
    if (!(curve.s[i + 1] > curve.s[i])) continue;  // the two sides of a joint
    TubePiece piece;
    piece.middle = 0.5 * (curve.r[i] + curve.r[i + 1]);
    piece.depth = view.towards.dot(piece.middle);
    piece.centre = {view.project(curve.r[i]), view.project(curve.r[i + 1])};
    piece.side = {radius * here, radius * side};
    piece.rest = {curve.s[i] - curve.s.front(), curve.s.back() - curve.s[i + 1]};
    piece.colour = colour_of(i);
    pieces.push_back(piece);
  }
  std::stable_sort(pieces.begin(), pieces.end(),
                   [](const TubePiece& a, const TubePiece& b) { return a.depth < b.depth; });
  return pieces;
}

Stroke stroke_of(double rod_radius, double picture_width) {
  if (!(rod_radius > 0.0)) return {};
  return {std::max(rod_radius, 0.004 * picture_width), 0.003 * picture_width};
}

std::string tube_polygons(const TubePiece& piece, const Stroke& stroke) {
  constexpr unsigned dark = 0x262626, light = 0xffffff;
  const double body = 1.0 - std::min(0.35, stroke.edge / stroke.radius);
  // What is drawn later is longer, or the ends of the pieces show as lines across the rod.
  const double w = stroke.edge;
  return strip(piece, 1.0, 0.5 * w, 0.0, dark) + strip(piece, body, 2.0 * w, w, piece.colour) +
         strip(piece, 0.45 * body, 3.5 * w, w, mixed(piece.colour, light, 0.25));
}

unsigned pressure_colour(double share) {
  struct Stop {
    double share;
    unsigned colour;
  };
  constexpr Stop stops[] = {{0.0, 0xfde725}, {0.33, 0xf98e09}, {0.66, 0xbc3754}, {1.0, 0x57106e}};
  for (std::size_t k = 1; k < std::size(stops); ++k)
    if (share <= stops[k].share)
      return mixed(
          stops[k - 1].colour, stops[k].colour,
          std::clamp((share - stops[k - 1].share) / (stops[k].share - stops[k - 1].share), 0.0, 1.0));
  return stops[std::size(stops) - 1].colour;
}

}  // namespace windlass::output
