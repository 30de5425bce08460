#include "dense_samples.hpp"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>

#include "windlass/bvp/collocation_table.hpp"
#include "windlass/rod/quaternion.hpp"

namespace windlass::equilibrium {

using chain::Piece;

Eigen::Index element_at(const Piece& piece, double s) {
  Eigen::Index first = 0;
  const Eigen::Index last = piece.s.size() - 1;
  while (first + piece.stride < last && s > piece.s(first + piece.stride)) first += piece.stride;
  return first;
}

Least least_near(const Piece& piece, const Eigen::VectorXd& values, double s, double value, double lo,
                 double hi) {
  constexpr int bits = 26;  // half of a double: a minimum is flat
  Least least{value, s};
  const Eigen::Index last = piece.s.size() - 1;
  for (const int way : {-1, 1}) {
    Eigen::Index first = element_at(piece, s);
    const Eigen::Index next = first + piece.stride;  // of an element that meets it at s
    if (way > 0 && next < last && s == piece.s(next)) first = next;
    const Eigen::VectorXd nodes = piece.s.segment(first, piece.stride + 1);
    const double begin = nodes(0), length = nodes(piece.stride) - begin, x = (s - begin) / length;
    const double from = way < 0 ? std::max(0.0, (lo - begin) / length) : x;
    const double to = way < 0 ? x : std::min(1.0, (hi - begin) / length);
    if (!(to > from)) continue;
    const Eigen::VectorXd scaled = (nodes.array() - begin) / length;
    const auto polynomial = [&](double at) {
      return bvp::lagrange_basis(scaled, at).dot(values.segment(first, piece.stride + 1));
    };
    const auto [at, found] = boost::math::tools::brent_find_minima(polynomial, from, to, bits);
    if (found < least.value) least = {found, begin + length * at};
  }
  return least;
}

namespace {

/// Least of sign·z on a piece.
double least_z(const Piece& piece, double sign) {
  const Eigen::VectorXd z = sign * piece.r.row(2).transpose();
  Eigen::Index at = 0;
  const double value = z.minCoeff(&at);
  const Eigen::Index before = std::max<Eigen::Index>(at - 1, 0), after = std::min(at + 1, z.size() - 1);
  const auto slope = [&](Eigen::Index k) { return sign * rod::directors(piece.q.col(k))(2, 2); };
  if (!(slope(before) < 0.0 && slope(after) > 0.0)) return value;
  return least_near(piece, z, piece.s(at), value, piece.s(before), piece.s(after)).value;
}

}  // namespace

double extent_in_z(const chain::Profile& shape) {
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (const Piece& piece : shape.pieces) {
    low = std::min(low, least_z(piece, 1.0));
    high = std::max(high, -least_z(piece, -1.0));
  }
  return high - low;
}

Dense dense_samples(const Piece& piece, const Eigen::VectorXd& values) {
  constexpr int parts = 24;  // of an element
  const Eigen::Index stride = piece.stride, elements = (piece.s.size() - 1) / stride;
  Dense out{Eigen::VectorXd(elements * parts + 1), Eigen::VectorXd(elements * parts + 1)};
  const double first_length = piece.s(stride) - piece.s(0);
  const Eigen::VectorXd scaled = (piece.s.head(stride + 1).array() - piece.s(0)) / first_length;  // of each
  Eigen::MatrixXd basis(parts, stride + 1);
  for (int k = 0; k < parts; ++k)
    basis.row(k) = bvp::lagrange_basis(scaled, static_cast<double>(k) / parts).transpose();
  for (Eigen::Index e = 0; e < elements; ++e) {
    const double begin = piece.s(e * stride), length = piece.s((e + 1) * stride) - begin;
    for (int k = 0; k < parts; ++k) out.s(e * parts + k) = begin + length * k / parts;
    out.value.segment(e * parts, parts).noalias() = basis * values.segment(e * stride, stride + 1);
  }
  out.s(elements * parts) = piece.s(elements * stride);
  out.value(elements * parts) = values(elements * stride);
  return out;
}

}  // namespace windlass::equilibrium
