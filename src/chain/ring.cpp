#include "windlass/chain/ring.hpp"

#include <cmath>

#include "windlass/contact/spatial_joints.hpp"

namespace windlass::chain {

using Eigen::Vector3d;

Profile ring_profile(const Loads& loads) {
  constexpr int samples = 201;
  const double half = loads.half_length, radius = half / M_PI;
  const double rest = loads.twist - std::copysign(2.0 * M_PI, loads.twist);
  const rod::Quaternion middle = contact::spatial::surface_frame(0.0, M_PI, 0.0);
  const auto frame = [&](double turned, double part) {
    return rod::product(rod::rotation(Vector3d::UnitZ(), turned),
                        rod::product(middle, rod::rotation(Vector3d::UnitZ(), 0.5 * rest * part)));
  };
  // Turning one way or the other gives the same rotation at the end, but opposite quaternions: a full turn of twist.
  const rod::Quaternion end = rod::product(contact::spatial::surface_frame(0.0, 0.0, 0.0),
                                           rod::rotation(Vector3d::UnitZ(), 0.5 * loads.twist));
  const double way = frame(M_PI, 1.0).dot(end) > 0.0 ? 1.0 : -1.0;
  Piece ring;
  ring.stretch = Stretch::tail;
  ring.s = VectorXd::LinSpaced(samples, 0.0, half);
  ring.r.setZero(3, samples);
  ring.n.setZero(3, samples);
  ring.m.setZero(3, samples);
  ring.q.resize(4, samples);
  for (VectorXd* zero : {&ring.angle, &ring.heading, &ring.p, &ring.inclination}) zero->setZero(samples);
  for (int k = 0; k < samples; ++k) {
    const double part = static_cast<double>(k) / (samples - 1), turned = way * M_PI * part;
    ring.r.col(k) = way * radius * Vector3d(-std::sin(turned), 1.0 + std::cos(turned), 0.0);
    ring.heading(k) = M_PI + turned;
    ring.q.col(k) = frame(turned, part);
  }
  Profile out;
  out.pieces.push_back(std::move(ring));
  return out;
}

}  // namespace windlass::chain
