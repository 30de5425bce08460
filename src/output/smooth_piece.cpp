#include "smooth_piece.hpp"

#include <math.h>  // Boost 1.74's pchip asks for ::isnan

#include <algorithm>
#include <boost/math/interpolators/pchip.hpp>
#include <cmath>
#include <utility>

namespace windlass::output {

namespace {

using Rows = std::vector<std::vector<double>>;

/// On a logarithmic axis what lies below the picture is as good as its lower edge: a value that goes to zero is at no finite place.
double drawn(const Axis& axis, double value) {
  constexpr double below = 0.1;  // of the lower edge
  return axis.log ? std::log(value > 0.0 ? std::max(value, below * axis.low) : value) : value;
}
double known(const Axis& axis, double place) { return axis.log ? std::exp(place) : place; }

/// Distance of two rows in a diagram of unit size.
double distance(const std::vector<double>& a, const std::vector<double>& b,
                const std::vector<const Axis*>& axes) {
  double sum = 0.0;
  for (std::size_t k = 0; k < axes.size(); ++k) {
    const double range = drawn(*axes[k], axes[k]->high) - drawn(*axes[k], axes[k]->low);
    const double step = (drawn(*axes[k], b[k]) - drawn(*axes[k], a[k])) / range;
    if (std::isfinite(step)) sum += step * step;
  }
  return std::sqrt(sum);
}

/// Rows without a break inside them.
Rows smooth(const Rows& rows, const std::vector<const Axis*>& axes) {
  constexpr std::size_t least = 4;  // what the interpolation needs
  constexpr double fine = 0.02;     // of the diagram
  std::vector<double> at{0.0};
  Rows apart;  // without repeated places
  for (const auto& row : rows) {
    const double step = apart.empty() ? 0.0 : distance(apart.back(), row, axes);
    if (!apart.empty() && !(step > 0.0)) continue;
    if (!apart.empty()) at.push_back(at.back() + step);
    apart.push_back(row);
  }
  if (apart.size() < least) return rows;
  std::vector<double> places;
  for (std::size_t i = 0; i + 1 < at.size(); ++i) {
    const int parts = std::min(10, 1 + static_cast<int>((at[i + 1] - at[i]) / fine));
    for (int j = 0; j < parts; ++j) places.push_back(at[i] + (at[i + 1] - at[i]) * j / parts);
  }
  places.push_back(at.back());
  Rows out(places.size(), std::vector<double>(axes.size(), std::nan("")));
  for (std::size_t k = 0; k < axes.size(); ++k) {
    // Runs of values that exist.
    for (std::size_t begin = 0, end = 0; begin < at.size(); begin = end + 1) {
      for (end = begin; end < at.size() && std::isfinite(drawn(*axes[k], apart[end][k]));) ++end;
      if (end - begin < least) continue;
      std::vector<double> x(at.begin() + static_cast<long>(begin), at.begin() + static_cast<long>(end)), y;
      for (std::size_t i = begin; i < end; ++i) y.push_back(drawn(*axes[k], apart[i][k]));
      const double low = x.front(), high = x.back();
      const boost::math::interpolators::pchip<std::vector<double>> curve(std::move(x), std::move(y));
      for (std::size_t i = 0; i < places.size(); ++i)
        if (places[i] >= low && places[i] <= high) out[i][k] = known(*axes[k], curve(places[i]));
    }
  }
  return out;
}

}  // namespace

Piece smooth(const Piece& piece, const std::vector<const Axis*>& axes) {
  Piece out{piece.branch, piece.state, {}, {}};
  for (std::size_t begin = 0, end = 0; begin < piece.rows.size(); begin = end) {
    for (end = begin + 1; end < piece.rows.size() && !piece.breaks.contains(end);) ++end;
    if (begin > 0) out.breaks.insert(out.rows.size());
    const Rows part = smooth(
        Rows(piece.rows.begin() + static_cast<long>(begin), piece.rows.begin() + static_cast<long>(end)),
        axes);
    out.rows.insert(out.rows.end(), part.begin(), part.end());
  }
  return out;
}

}  // namespace windlass::output
