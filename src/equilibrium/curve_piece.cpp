#include "windlass/equilibrium/curve_piece.hpp"

#include <cmath>

#include "windlass/obstacle/cylinder.hpp"

namespace windlass::equilibrium {

using Eigen::Vector3d;

chain::Piece without_torsion(const std::vector<CurvePlace>& places, const rod::Quaternion& first,
                             const Vector3d& pull, const std::vector<discrete_rod::PointLoad>& loads) {
  const auto count = static_cast<Eigen::Index>(places.size());
  chain::Piece piece;
  piece.s.resize(count), piece.angle.setZero(count), piece.heading.setZero(count), piece.p.setZero(count);
  piece.inclination.setZero(count);
  piece.r.resize(3, count), piece.n.resize(3, count), piece.m.resize(3, count), piece.q.resize(4, count);
  Vector3d before = Vector3d::UnitX();
  for (Eigen::Index k = 0; k < count; ++k) {
    const CurvePlace& place = places[static_cast<std::size_t>(k)];
    const Vector3d tangent = place.slope.normalized();
    piece.s(k) = place.s;
    piece.r.col(k) = place.r;
    piece.m.col(k) = tangent.cross(place.bend) / place.slope.squaredNorm();
    if (k == 0) {
      piece.q.col(k) = first;
    } else {
      piece.q.col(k) = rod::product(rod::turn_between(before, tangent), piece.q.col(k - 1));
      const double angle = obstacle::Cylinder::angle(piece.r.col(k));
      piece.angle(k) = piece.angle(k - 1) + std::remainder(angle - piece.angle(k - 1), 2.0 * M_PI);
    }
    before = tangent;
  }
  Vector3d n = pull;
  auto load = loads.rbegin();
  for (Eigen::Index k = count; k-- > 0;) {
    for (; load != loads.rend() && load->s > piece.s(k); ++load) n += load->force;
    piece.n.col(k) = n;
  }
  return piece;
}

}  // namespace windlass::equilibrium
