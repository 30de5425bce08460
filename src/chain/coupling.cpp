#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "windlass/chain/chain.hpp"

/// Contacts of the rod with itself, see chain/coupling.hpp.

namespace windlass::chain {

using contact::SmallMatrix;
using Eigen::Matrix3d;
using Eigen::Vector3d;

void Chain::couple() {
  coupling_of_.assign(joints_.size(), -1);
  for (std::size_t k = 0; k < couplings_.size(); ++k)
    for (const int joint : {couplings_[k].first, couplings_[k].second}) {
      if (!locates(joint)) throw std::invalid_argument("a strand cannot touch another at a fixed place");
      coupling_of_[joint] = static_cast<int>(k);
    }
}

Chain::Crossing Chain::crossing(const VectorXd& x, int coupling) const {
  const Coupling& c = couplings_[coupling];
  Crossing out;
  out.coupling = c;
  out.first = joints_[c.first]->centreline(coordinates(x, c.first));
  out.second = joints_[c.second]->centreline(coordinates(x, c.second));
  const Vector3d image = c.image();
  out.second.r = image.cwiseProduct(out.second.r);
  out.second.t = image.cwiseProduct(out.second.t);
  out.second.dr = image.asDiagonal() * out.second.dr;
  out.second.dt = image.asDiagonal() * out.second.dt;
  const Vector3d d = out.first.r - out.second.r;
  out.distance = d.norm();
  if (out.distance == 0.0) throw std::domain_error("two strands are at the same place");
  out.direction = d / out.distance;
  return out;
}

namespace {

/// |D| − 2r. Of touches h apart the forces answer to it by 192 B/h³: to more digits than those of a double, from places that have
/// them. @param rest  of D, beside its double
double overlap(const Vector3d& first, const Vector3d& second, const Vector3d& rest, double radius) {
  long double square = 0.0L;
  for (int k = 0; k < 3; ++k) {
    const long double d = static_cast<long double>(first(k)) - second(k) + rest(k);
    square += d * d;
  }
  return static_cast<double>(std::sqrt(square) - 2.0L * radius);
}

}  // namespace

void Chain::add_strand_forces(const VectorXd& x, const Loads& loads, VectorXd& f) const {
  for (std::size_t k = 0; k < couplings_.size(); ++k) {
    const Coupling& c = couplings_[k];
    const Crossing at = crossing(x, static_cast<int>(k));
    const double push = c.weight() * strand_force(x, static_cast<int>(k));
    const auto pull_on = [&](int joint, const contact::Centreline& strand, double sign) {
      add_kept(sign * push * (strand.dr.transpose() * at.direction), joint, f);
    };
    pull_on(c.first, at.first, -1.0);
    pull_on(c.second, at.second, 1.0);
    const auto rest = [&](int joint) -> Vector3d {
      return joints_[joint]->surface() ? Vector3d::Zero() : Vector3d(x.segment<3>(rest_at_[joint] + 1));
    };
    const Vector3d between = rest(c.first) - c.image().cwiseProduct(rest(c.second));
    f(numbering_.strand[k]) = -c.weight() * overlap(at.first.r, at.second.r, between, loads.radius);
    f(numbering_.location[c.second]) = at.direction.dot(at.second.t);
    if (c.placed) continue;
    f(numbering_.location[c.first]) = at.direction.dot(at.first.t);
    if (c.begin < 0) continue;
    const double begin = arclength(x, loads, c.begin), whole = arclength(x, loads, c.end) - begin;
    f(numbering_.location[c.first]) = arclength(x, loads, c.first) - begin - c.part * whole;
  }
}

void Chain::add_couplings(Purpose purpose, const Numbering& numbering, const VectorXd& x,
                          Block& dense) const {
  for (std::size_t k = 0; k < couplings_.size(); ++k) {
    const Coupling& c = couplings_[k];
    const Crossing at = crossing(x, static_cast<int>(k));
    const double push = c.weight() * strand_force(x, static_cast<int>(k));
    const Vector3d e = at.direction;
    const Matrix3d turn = (Matrix3d::Identity() - e * e.transpose()) / at.distance;  // ∂e/∂D
    // The image of an odd variation has the other sign.
    const double image = purpose == Purpose::odd && c.mirrored ? -1.0 : 1.0;
    struct End {
      int joint;
      const contact::Centreline& strand;
      Eigen::Matrix3Xd dr, dt;  // of D and of the tangent, with what varies
      Vector3d force;           // on the joint itself, in the Lagrangian's sign
    };
    const auto end = [&](int joint, const contact::Centreline& strand, double sign, const Vector3d& force) {
      const std::vector<int>& varied = kept(purpose, joint);
      const auto count = static_cast<Eigen::Index>(varied.size());
      End out{joint, strand, Eigen::Matrix3Xd(3, count), Eigen::Matrix3Xd(3, count), force};
      for (Eigen::Index i = 0; i < count; ++i) {
        out.dr.col(i) = sign * strand.dr.col(varied[i]);
        out.dt.col(i) = strand.dt.col(varied[i]);
      }
      return out;
    };
    const End ends[] = {end(c.first, at.first, 1.0, -push * e),
                        end(c.second, at.second, -image, push * c.image().cwiseProduct(e))};
    for (const End& a : ends) {
      const Eigen::Index first = numbering.coordinate[a.joint], count = a.dr.cols();
      for (const End& b : ends)
        dense.block(first, numbering.coordinate[b.joint], count, b.dr.cols()) -=
            push * a.dr.transpose() * turn * b.dr;
      const int all = joints_[a.joint]->tangent();
      SmallMatrix bend = SmallMatrix::Zero(all, all);
      joints_[a.joint]->place_curvature(coordinates(x, a.joint), a.force, bend);
      const std::vector<int>& varied = kept(purpose, a.joint);
      for (Eigen::Index r = 0; r < count; ++r)
        for (Eigen::Index s = 0; s < count; ++s) dense(first + r, first + s) += bend(varied[r], varied[s]);
      if (const Eigen::Index row = numbering.strand[k]; row >= 0) {
        dense.block(row, first, 1, count) -= c.weight() * e.transpose() * a.dr;
        dense.block(first, row, count, 1) -= c.weight() * a.dr.transpose() * e;
      }
    }
    if (purpose != Purpose::equilibrium) continue;
    const int conditions = c.with_itself() ? 1 : 2;
    for (int i = 0; i < conditions; ++i) {
      const Eigen::Index row = numbering.location[ends[i].joint];
      if (i == 0 && c.placed) continue;
      if (i == 0 && c.begin >= 0) {
        dense(row, row) += 1.0;
        dense(row, numbering.location[c.begin]) -= 1.0 - c.part;
        dense(row, numbering.location[c.end]) -= c.part;
        continue;
      }
      dense.block(row, numbering.coordinate[ends[i].joint], 1, ends[i].dt.cols()) +=
          e.transpose() * ends[i].dt;
      for (const End& b : ends)
        dense.block(row, numbering.coordinate[b.joint], 1, b.dr.cols()) +=
            ends[i].strand.t.transpose() * turn * b.dr;
    }
  }
}

}  // namespace windlass::chain
