#pragma once

#include <algorithm>
#include <vector>

#include "windlass/chain/guess.hpp"
#include "windlass/chain/profile.hpp"

namespace windlass::chain {

using Eigen::Vector3d;

/// d₃ of a frame (w, x, y, z).
inline Vector3d tangent(const Eigen::Vector4d& q) {
  return {2.0 * (q[1] * q[3] + q[0] * q[2]), 2.0 * (q[2] * q[3] - q[0] * q[1]),
          1.0 - 2.0 * (q[1] * q[1] + q[2] * q[2])};
}

struct Jet {
  Vector3d r, t, k;  ///< position, dr/ds, d²r/ds²
};

/// The centreline of a whole rod, element by element: a quintic between samples.
class Centreline {
 public:
  explicit Centreline(const Profile& whole) : whole_(whole) {
    if (whole.material.compliance != 0.0)
      for (const Piece& piece : whole.pieces)
        for (Eigen::Index k = 0; k < piece.s.size(); ++k) longest = std::max(longest, stretch(piece, k));
    for (std::size_t i = 0; i < whole.pieces.size(); ++i) {
      const Piece& piece = whole.pieces[i];
      begins.push_back(static_cast<int>(s.size()));
      const int last = static_cast<int>(piece.s.size()) - 1;
      for (int first = 0; first + piece.stride <= last && !piece.weld; first += piece.stride)
        add_element(piece, static_cast<int>(i), first);
    }
    begins.push_back(static_cast<int>(s.size()));
    const Piece& end = whole.pieces.back();
    const Eigen::Index last = end.s.size() - 1;
    s.push_back(end.s(last)), r.push_back(end.r.col(last)), t.push_back(tangent(end.q.col(last)));
    turned.push_back(0.0);
    double sum = 0.0;
    for (int e = 0; e < size(); ++e) {  // chord of the tangents: a little less than their angle
      turned[e] = sum;
      sum += (middle[e].t - t[e]).norm() + (t[e + 1] - middle[e].t).norm();
    }
    turned.back() = sum;
  }

  int size() const { return static_cast<int>(middle.size()); }

  Jet at(int element, double place) const {
    const auto [i, first] = where_[element];
    const Piece& piece = whole_.pieces[i];
    int k = first;
    while (k + 1 < first + piece.stride && place > piece.s(k + 1)) ++k;
    return quintic(knot(piece, k), knot(piece, k + 1), piece.s(k + 1) - piece.s(k), place - piece.s(k));
  }

  std::vector<int> begins;     ///< first element of each piece, and their number
  std::vector<double> s;       ///< where elements begin, and the end
  std::vector<Vector3d> r, t;  ///< there
  std::vector<double> turned;  ///< angle by which the rod has turned up to there [rad]
  struct Middle {
    double s;
    Vector3d r, t;
  };
  std::vector<Middle> middle;  ///< a sample inside each element
  double longest = 1.0;        ///< length of the centre line a unit of s, at most

 private:
  void add_element(const Piece& piece, int index, int first) {
    const int inside = first + piece.stride / 2;
    s.push_back(piece.s(first)), r.push_back(piece.r.col(first)), t.push_back(tangent(piece.q.col(first)));
    turned.push_back(0.0);
    middle.push_back({piece.s(inside), piece.r.col(inside), tangent(piece.q.col(inside))});
    where_.push_back({index, first});
  }

  [[gnu::noinline]] double stretch(const Piece& piece, Eigen::Index k) const {
    return whole_.material.stretch(piece.n.col(k).dot(tangent(piece.q.col(k))));
  }

  Jet knot(const Piece& piece, int k) const {
    if (whole_.material.compliance != 0.0) return stretched_knot(piece, k);
    return {piece.r.col(k), tangent(piece.q.col(k)), curvature(whole_.material, piece, k)};
  }

  /// r' = λ t, λ' = n'·t/EA + λ n·κ/EA, κ the curvature; contacts push across t. A function of its own, or the compiler rounds the
  /// other way otherwise.
  [[gnu::noinline]] Jet stretched_knot(const Piece& piece, int k) const {
    const rod::Material& rod = whole_.material;
    const Vector3d t = tangent(piece.q.col(k)), bend = curvature(rod, piece, k);
    const double by = stretch(piece, k);
    const double rate = rod.compliance * (by * piece.n.col(k).dot(bend) - rod.weight.dot(t));
    return {piece.r.col(k), by * t, by * by * bend + rate * t};
  }

  static Jet quintic(const Jet& a, const Jet& b, double h, double place) {
    const double x = place / h;
    const Vector3d rise = b.r - a.r, v0 = h * a.t, v1 = h * b.t, a0 = h * h * a.k, a1 = h * h * b.k;
    const Vector3d c3 = 10.0 * rise - 6.0 * v0 - 4.0 * v1 - 1.5 * a0 + 0.5 * a1,
                   c4 = -15.0 * rise + 8.0 * v0 + 7.0 * v1 + 1.5 * a0 - a1,
                   c5 = 6.0 * rise - 3.0 * v0 - 3.0 * v1 - 0.5 * a0 + 0.5 * a1;
    return {a.r + x * (v0 + x * (0.5 * a0 + x * (c3 + x * (c4 + x * c5)))),
            (v0 + x * (a0 + x * (3.0 * c3 + x * (4.0 * c4 + x * 5.0 * c5)))) / h,
            (a0 + x * (6.0 * c3 + x * (12.0 * c4 + x * 20.0 * c5))) / (h * h)};
  }

  struct Where {
    int piece, first;
  };
  const Profile& whole_;
  std::vector<Where> where_;
};

}  // namespace windlass::chain
