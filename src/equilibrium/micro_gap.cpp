#include "windlass/equilibrium/micro_gap.hpp"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>

#include "windlass/bvp/collocation_table.hpp"

namespace windlass::equilibrium {

using chain::Piece;
using Where = MicroGap::Where;

Least least_near(const Piece& piece, const Eigen::VectorXd& values, Eigen::Index k) {
  constexpr int bits = 26;  // half of a double: a minimum is flat
  Least least{values(k), piece.s(k)};
  for (const Eigen::Index from : {k - 1, k}) {
    if (from < 0 || from + 1 >= values.size()) continue;
    const Eigen::Index first = from / piece.stride * piece.stride;
    const Eigen::VectorXd nodes = piece.s.segment(first, piece.stride + 1);
    const double begin = nodes(0), length = nodes(piece.stride) - begin;
    const Eigen::VectorXd scaled = (nodes.array() - begin) / length;
    const auto polynomial = [&](double x) {
      return bvp::lagrange_basis(scaled, x).dot(values.segment(first, piece.stride + 1));
    };
    const auto [x, value] = boost::math::tools::brent_find_minima(polynomial, scaled(from - first),
                                                                  scaled(from + 1 - first), bits);
    if (value < least.value) least = {value, begin + length * x};
  }
  return least;
}

namespace {

/// Derivatives of the pressure at s on the element there.
struct Slopes {
  double first, second;
};

Slopes slopes_at(const Piece& line, double s) {
  constexpr double part =
      0.02;  // of the element: the polynomial is known there, and rounding stays below 1e-9
  Eigen::Index first = 0;
  const Eigen::Index last = line.s.size() - 1;
  while (first + line.stride < last && s > line.s(first + line.stride)) first += line.stride;
  const Eigen::VectorXd nodes = line.s.segment(first, line.stride + 1);
  const double length = nodes(line.stride) - nodes(0);
  const Eigen::VectorXd scaled = (nodes.array() - nodes(0)) / length;
  const auto value = [&](double x) {
    return bvp::lagrange_basis(scaled, x).dot(line.p.segment(first, line.stride + 1));
  };
  const double x = (s - nodes(0)) / length, h = part * length;
  const double before = value(x - part), here = value(x), after = value(x + part);
  return {(after - before) / (2.0 * h), (after - 2.0 * here + before) / (h * h)};
}

/// A pressure that does not curve, or rise, gives a gap no size of its own: an arc's business.
constexpr double least_slope = 1e-9;

void size_inside(MicroGap& gap, const Slopes& slopes, double begin, double end, const Scales& scales) {
  const double a = std::max(slopes.second, least_slope * scales.pressure), depth = std::max(0.0, -gap.p);
  const double half = std::sqrt(10.0 * depth / a);
  gap.from = gap.s - half;
  gap.to = gap.s + half;
  gap.height = depth / scales.pressure * std::pow(half, 4) / 72.0;
  const double room = std::min(gap.s - begin, end - gap.s);
  gap.room = half > 0.0 ? std::min(1.0, room / half - 1.0) : 1.0;
}

void size_beside_touch(MicroGap& gap, const Slopes& slopes, const Scales& scales) {
  const bool begin = gap.where == Where::begin;
  const double b = std::max((begin ? 1.0 : -1.0) * slopes.first, least_slope * scales.pressure);
  const double length = 5.0 / 3.0 * std::max(0.0, -gap.p) / b;
  gap.from = begin ? gap.s : gap.s - length;
  gap.to = begin ? gap.s + length : gap.s;
  gap.height = height_of_gap(b * length * length / 20.0, length, true, scales);
}

MicroGap gap_at_end(const Piece& line, Where where, bool mid, const Scales& scales) {
  const Eigen::Index k = where == Where::begin ? 0 : line.s.size() - 1;
  MicroGap gap{where, line.s(k), line.p(k)};
  constexpr double far = 1e9;  // beyond the mid-point the line goes on
  if (mid)
    size_inside(gap, slopes_at(line, gap.s), gap.s - far, gap.s + far, scales);
  else
    size_beside_touch(gap, slopes_at(line, gap.s), scales);
  return gap;
}

bool covered(const std::vector<MicroGap>& gaps, double s) {
  return std::any_of(gaps.begin(), gaps.end(),
                     [&](const MicroGap& gap) { return s >= gap.from && s <= gap.to; });
}

Least least_outside(const Piece& line, const std::vector<MicroGap>& gaps) {
  Eigen::Index k = -1;
  for (Eigen::Index i = 0; i < line.s.size(); ++i)
    if (!covered(gaps, line.s(i)) && (k < 0 || line.p(i) < line.p(k))) k = i;
  if (k < 0) return {line.p.maxCoeff(), line.s(0)};
  const Least refined = least_near(line, line.p, k);
  return covered(gaps, refined.s) ? Least{line.p(k), line.s(k)} : refined;
}

}  // namespace

double height_of_gap(double force, double length, bool beside_touch, const Scales& scales) {
  // a/720 h⁶ with f = a h³/15; the largest of s² (l − s)³ is 108/3125 l⁵, at s = 2l/5, with f = b l²/20.
  const double part = beside_touch ? 108.0 / 3125.0 / 6.0 : 1.0 / 48.0;
  return part * std::max(0.0, force) / scales.force * std::pow(length, 3);
}

LineContact line_contact(const Piece& line, const chain::MicroGaps& gaps, bool begins_at_mid,
                         bool ends_at_mid, const Scales& scales) {
  LineContact out;
  if (gaps.begin) out.gaps.push_back(gap_at_end(line, Where::begin, begins_at_mid, scales));
  if (gaps.end) out.gaps.push_back(gap_at_end(line, Where::end, ends_at_mid, scales));
  for (int i = 0; i < gaps.inside; ++i) {
    const Least least = least_outside(line, out.gaps);
    MicroGap gap{Where::inside, least.s, least.value};
    size_inside(gap, slopes_at(line, gap.s), line.s(0), line.s(line.s.size() - 1), scales);
    out.gaps.push_back(gap);
  }
  const Least least = least_outside(line, out.gaps);
  out.least_pressure = least.value;
  out.s = least.s;
  return out;
}

}  // namespace windlass::equilibrium
