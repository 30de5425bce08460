// What arcs and joints add to the dense block of a chain.
#include <cmath>
#include <stdexcept>

#include "windlass/chain/chain.hpp"
#include "windlass/rod/quaternion.hpp"

namespace windlass::chain {

using contact::Attachment;
using contact::Side;
using contact::SmallMatrix;
using contact::SmallVector;

Attachment Chain::attachment(Purpose purpose, const VectorXd& x, const Loads& loads, int joint,
                             Side side) const {
  Attachment at = joints_[joint]->attach(side, coordinates(x, joint), loaded(x, loads, joint));
  if (purpose != Purpose::equilibrium)
    at.tested.reset();  // a second variation is of the displacements themselves
  const std::vector<int>& kept = this->kept(purpose, joint);
  const auto count = static_cast<Eigen::Index>(kept.size());
  if (count == at.dq.cols()) return at;
  for (Eigen::Index k = 0; k < count; ++k) {
    at.dq.col(k) = at.dq.col(kept[k]).eval();
    at.dx.col(k) = at.dx.col(kept[k]).eval();
    if (at.tested) at.tested->col(k) = at.tested->col(kept[k]).eval();
  }
  if (at.tested) at.tested->conservativeResize(Eigen::NoChange, count);
  at.dq.conservativeResize(Eigen::NoChange, count);
  at.dx.conservativeResize(Eigen::NoChange, count);
  return at;
}

bvp::EndsMatrix Chain::with_commutator(const Arc& arc, const bvp::EndsMatrix& symmetric,
                                       const bvp::EndsVector& gradient) {
  bvp::EndsMatrix full = symmetric;
  if (arc.ambient() != 4) return full;
  // D_{w'} D_w S − D_w D_{w'} S = 2 g·(w' × w) for increments on the right of a quaternion.
  for (int at : {0, 3}) {
    const Eigen::Vector3d g = gradient.segment(at, 3);
    Eigen::Matrix3d cross;
    cross << 0.0, -g(2), g(1), g(2), 0.0, -g(0), -g(1), g(0), 0.0;
    full.block(at, at, 3, 3) += cross;
  }
  return full;
}

Chain::Local Chain::local(Purpose purpose, const Numbering& numbering, const VectorXd& x, const Loads& loads,
                          int link) const {
  const Arc& arc = *links_[link].arc;
  const int d = arc.tangent(), forces = arc.forces(), ends = arc.ends(), length = arc.length_end();
  Local l;
  const Attachment left = attachment(purpose, x, loads, link, Side::right);
  const Attachment right = attachment(purpose, x, loads, link + 1, Side::left);
  const bool drags = dragged() && purpose == Purpose::equilibrium,
             travels = drags && travel() != Travel::none;
  l.columns = MatrixXd::Zero(ends, left.dq.cols() + right.dq.cols() + 2 + forces + travels);
  l.rows = l.columns;
  Eigen::Index k = 0;
  const auto coordinates_of = [&](const Attachment& at, int joint, Side side, int first_end) {
    const auto drag = drags ? drag_at(x, loads, link, side) : std::nullopt;
    for (Eigen::Index c = 0; c < at.dq.cols(); ++c, ++k) {
      l.dofs.push_back(numbering.coordinate[joint] + c);
      l.columns.col(k).segment(first_end, d) = at.dq.col(c);
      l.rows.col(k).segment(first_end, d) = at.dq.col(c);
      if (drag) l.rows.col(k).segment(first_end, d) += drag->by_gradient.row(kept_[joint][c]).transpose();
      if (side == Side::left && arc.carried() > 0) l.rows.col(k).tail(arc.carried()) = at.test().col(c);
    }
  };
  const auto arclength_of = [&](int joint, double sign, Side arc_side, int first_end) {
    if (numbering.location[joint] < 0) return;
    l.dofs.push_back(numbering.location[joint]);
    l.columns(length, k) = sign;
    if (purpose != Purpose::equilibrium) {
      l.rows(length, k) = sign;
    } else {
      const Joint::Location c = location(x, joint);
      if (c.side == arc_side && c.by_gradient.size() == d)
        l.rows.col(k).segment(first_end, d) = c.by_gradient;
    }
    ++k;
  };
  coordinates_of(left, link, Side::right, 0);
  arclength_of(link, -1.0, Side::right, 0);
  if (links_[link].pull == 0)
    for (int i = 0; i < forces; ++i, ++k) {
      l.dofs.push_back(numbering.force[link] + i);
      l.columns(2 * d + i, k) = l.rows(2 * d + i, k) = 1.0;
    }
  coordinates_of(right, link + 1, Side::left, d);
  arclength_of(link + 1, 1.0, Side::left, d);
  if (travels) {
    l.dofs.push_back(numbering.slide);
    if (gauges_.travel == Travel::blocked)
      l.columns.col(k).segment(2 * d, forces) = force_by_travel(loads, link);
    else if (arc.carried() > 0)
      l.columns(length + 1, k) = 1.0;
    ++k;
  }
  l.columns.conservativeResize(ends, k);
  l.rows.conservativeResize(ends, k);
  return l;
}

Chain::StretchAt Chain::stretch_at(const VectorXd& x, const Loads& loads, int joint) const {
  StretchAt out;
  Eigen::Vector3d n = Eigen::Vector3d::Zero();
  std::optional<Attachment> free;
  for (const int link : {joint - 1, joint}) {
    if (link < 0 || link >= link_count() || links_[link].arc->ambient() != 4) continue;
    out.links.push_back(link);
    n += Eigen::Vector3d(force(x, loads, link));
    if (!free)
      free = joints_[joint]->attach(link == joint ? Side::right : Side::left, coordinates(x, joint), loads);
  }
  if (!free) return out;
  const double share = loads.compliance / static_cast<double>(out.links.size());
  const Eigen::Matrix3d d = rod::directors(rod::Quaternion(free->q));
  Eigen::Matrix3d turned;  // of the tangent, with increments of half the angle
  turned << -2.0 * d.col(1), 2.0 * d.col(0), Eigen::Vector3d::Zero();
  out.value = 1.0 + share * n.dot(d.col(2));
  out.by_w = share * (turned * free->dq).transpose() * n;
  out.by_n = share * d.col(2);
  return out;
}

void Chain::add_travel(const VectorXd& x, const Loads& loads, int link, Side side,
                       const SmallVector& gradient, const SmallVector& force, Block& dense) const {
  const int joint = side == Side::right ? link : link + 1;
  const double sign = side == Side::right ? -1.0 : 1.0;
  const Eigen::Index first = numbering_.coordinate[joint];
  if (gauges_.travel == Travel::blocked) {
    const Attachment at = attachment(Purpose::equilibrium, x, loads, joint, side);
    dense.block(first, numbering_.slide, at.dx.cols(), 1) +=
        sign * at.test().transpose() * force_by_travel(loads, link);
    return;
  }
  // Smooth in ω, and a matter of a few numbers: by differences.
  const Loads here = loaded(x, loads, joint);
  const auto taken = [&](double travel) {
    Loads at = here;
    at.travel = travel;
    SmallVector f = sign * joints_[joint]->attach(side, coordinates(x, joint), at).test().transpose() * force;
    if (const auto drag = joints_[joint]->drag(side, coordinates(x, joint), at, gradient)) f += drag->value;
    return f;
  };
  constexpr double h = 1e-5;
  const SmallVector by_travel = (taken(here.travel + h) - taken(here.travel - h)) / (2.0 * h);
  const StretchAt stretch = loads.compliance == 0.0 ? StretchAt{} : stretch_at(x, loads, joint);
  for (std::size_t k = 0; k < kept_[joint].size(); ++k) {
    const Eigen::Index row = first + static_cast<Eigen::Index>(k);
    dense(row, numbering_.slide) += by_travel(kept_[joint][k]) * stretch.value;
    if (stretch.links.empty()) continue;
    const double by_stretch = by_travel(kept_[joint][k]) * travelled(x);
    for (std::size_t c = 0; c < kept_[joint].size(); ++c)
      dense(row, first + static_cast<Eigen::Index>(c)) += by_stretch * stretch.by_w(kept_[joint][c]);
    for (const int side_link : stretch.links)
      if (numbering_.force[side_link] >= 0)
        dense.block(row, numbering_.force[side_link], 1, 3) += by_stretch * stretch.by_n.transpose();
  }
}

void Chain::add_joint_terms(Purpose purpose, const Numbering& numbering, const VectorXd& x,
                            const Loads& loads, int link, const bvp::EndsVector& gradient,
                            Block& dense) const {
  const Arc& arc = *links_[link].arc;
  const int d = arc.tangent();
  const SmallVector n = force(x, loads, link), n_end = force_at_end(x, loads, link, n, gradient);
  const bool drags = dragged() && purpose == Purpose::equilibrium;
  for (const Side side :
       {Side::right, Side::left}) {  // of the joint: the arc starts at its right, ends at its left
    const int joint = side == Side::right ? link : link + 1;
    const double sign = side == Side::right ? -1.0 : 1.0;
    const Attachment at = attachment(purpose, x, loads, joint, side);
    const Eigen::Index first = numbering.coordinate[joint], count = at.dx.cols();
    const int all = joints_[joint]->tangent();
    SmallMatrix bend = SmallMatrix::Zero(all, all);
    const SmallVector g = gradient.segment(side == Side::right ? 0 : d, d),
                      f = side == Side::right ? SmallVector(-n) : n_end;
    joints_[joint]->curvature(side, coordinates(x, joint), loaded(x, loads, joint), g, f, bend);
    if (drags) {
      if (const auto drag = drag_at(x, loads, link, side)) bend += drag->by_w;
      if (travel() != Travel::none)
        add_travel(x, loads, link, side, g, side == Side::right ? n : n_end, dense);
    }
    const std::vector<int>& kept = this->kept(purpose, joint);
    for (Eigen::Index r = 0; r < count; ++r)
      for (Eigen::Index c = 0; c < count; ++c) dense(first + r, first + c) += bend(kept[r], kept[c]);
    if (links_[link].pull != 0) continue;
    const Eigen::Index row = numbering.force[link];
    dense.block(row, first, n.size(), count) += sign * at.dx;
    dense.block(first, row, count, n.size()) += sign * at.test().transpose();
  }
  if (loads.weighs()) add_weight(purpose, numbering, x, loads, link, dense);
}

/// Of the term n(ℓ)·X_b, n(ℓ) = n − w ℓ: the derivatives −w·∂X_b with the arclengths of the link's ends.
void Chain::add_weight(Purpose purpose, const Numbering& numbering, const VectorXd& x, const Loads& loads,
                       int link, Block& dense) const {
  const Attachment at = attachment(purpose, x, loads, link + 1, Side::left);
  const SmallVector by_length = -at.dx.transpose() * weight_on(loads, link);
  const Eigen::Index first = numbering.coordinate[link + 1];
  for (const int joint : {link, link + 1}) {
    const Eigen::Index location = numbering.location[joint];
    if (location < 0) continue;
    const double sign = joint == link ? -1.0 : 1.0;
    for (Eigen::Index c = 0; c < by_length.size(); ++c) {
      dense(first + c, location) += sign * by_length(c);
      // In variations arclengths have rows of the Lagrangian, in equilibrium those of their conditions.
      if (purpose != Purpose::equilibrium) dense(location, first + c) += sign * by_length(c);
    }
  }
}

/// Derivatives of what Chain::stretching() adds to a location condition.
void Chain::add_stretching(const VectorXd& x, const Loads& loads, int joint, Block& dense) const {
  const Side side = location(x, joint).side;
  const auto stretched = stretching(x, loads, joint, side);
  if (!stretched) return;
  const Eigen::Index row = numbering_.location[joint];
  for (std::size_t k = 0; k < kept_[joint].size(); ++k)
    dense(row, numbering_.coordinate[joint] + static_cast<Eigen::Index>(k)) +=
        stretched->by_w(kept_[joint][k]);
  const int link = side == Side::right ? joint : joint - 1;
  if (numbering_.force[link] >= 0)
    dense.block(row, numbering_.force[link], 1, stretched->by_n.size()) += stretched->by_n.transpose();
  else if (travel() == Travel::blocked)
    dense(row, numbering_.slide) += stretched->by_n.dot(SmallVector(force_by_travel(loads, link)));
  if (side == Side::right || !loads.weighs()) return;
  const double by_length = -stretched->by_n.dot(SmallVector(weight_on(loads, link)));
  dense(row, row) += by_length;
  if (numbering_.location[link] >= 0) dense(row, numbering_.location[link]) -= by_length;
}

/// Of what pulls on an end on a slider, the derivative with τ of T ± τ: dead loads are linear in the tension.
SmallVector Chain::by_pull(const VectorXd& x, const Loads& loads, int end) const {
  Loads more = loads;
  more.tension += 1.0;
  return (end == 0 ? -1.0 : 1.0) * (joints_[end]->dead_load(coordinates(x, end), more) -
                                    joints_[end]->dead_load(coordinates(x, end), loads));
}

void Chain::add_pulled(const VectorXd& x, const Loads& loads, Block& dense) const {
  for (const int j : {0, joint_count() - 1}) {
    const SmallVector pulled = by_pull(x, loads, j);
    for (std::size_t k = 0; k < kept_[j].size(); ++k)
      dense(numbering_.coordinate[j] + static_cast<Eigen::Index>(k), numbering_.slide) += pulled(kept_[j][k]);
  }
}

void Chain::add_locations(const VectorXd& x, const Loads& loads, Block& dense) const {
  for (int j = 0; j < joint_count(); ++j) {
    const Eigen::Index row = numbering_.location[j];
    if (row < 0 || coupling_of_[j] >= 0) continue;
    const SmallVector by_w = location(x, j).by_w;
    for (std::size_t k = 0; k < kept_[j].size(); ++k)
      dense(row, numbering_.coordinate[j] + k) += by_w(kept_[j][k]);
    if (loads.compliance != 0.0) add_stretching(x, loads, j, dense);
    if (const auto lift = joints_[j]->lift(coordinates(x, j), loaded(x, loads, j))) {
      for (std::size_t k = 0; k < kept_[j].size(); ++k)
        dense(row, numbering_.coordinate[j] + static_cast<Eigen::Index>(k)) += lift->by_w(kept_[j][k]);
      if (travel() == Travel::free) dense(row, numbering_.slide) += lift->by_travel;
    }
  }
  if (slide_at_ < 0) return;
  if (gauges_.travel == Travel::blocked) add_pulled(x, loads, dense);
  if (slides_) dense(numbering_.slide, numbering_.slide) += 1.0;
  for (int j = 0; j < joint_count(); ++j) {
    const double share = slide_share(j);
    if (share == 0.0) continue;
    if (!slides_) dense(numbering_.slide, numbering_.location[j]) += share;
    if (gauges_.travel == Travel::none) dense(numbering_.coordinate[j], numbering_.slide) += share;
  }
}

VectorXd Chain::phase_motion(Purpose purpose, const Numbering& numbering, const VectorXd& x,
                             const Loads& loads) const {
  VectorXd motion = VectorXd::Zero(numbering.size + size_ - dense_size_);
  const double spin = *gauges_.phase;
  for (int j = 0; j < joint_count(); ++j) {
    const SmallVector turned = joints_[j]->turned(coordinates(x, j), 1.0, spin);
    const std::vector<int>& kept = this->kept(purpose, j);
    for (std::size_t k = 0; k < kept.size(); ++k) motion(numbering.coordinate[j] + k) = turned(kept[k]);
  }
  for (int i = 0; i < link_count(); ++i) {
    if (numbering.force[i] >= 0)
      motion.segment<3>(numbering.force[i]) =
          Eigen::Vector3d::UnitX().cross(Eigen::Vector3d(force(x, loads, i)));
    const Eigen::Index first = interior_row_[i] + numbering.size - dense_size_;
    for (int k = 0; k < links_[i].arc->interior_nodes(); ++k)
      motion.segment<3>(first + 3 * k) = rod::turn_increment(
          Eigen::Map<const Eigen::Vector4d>(interior(x, i) + 4 * k), Eigen::Vector3d::UnitX(), spin);
  }
  return motion;
}

}  // namespace windlass::chain
