#include "windlass/chain/variation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "neutral_turn.hpp"
#include "symmetric_factors.hpp"

namespace windlass::chain {

using contact::Parity;

namespace {

/// Of the pivot in the middle: K⁻¹ of less would be all that is left of the other eigenvalues.
constexpr double rounding = 1e-12;

}  // namespace

Variation::Variation(const Linearisation& at, Parity parity) : at_(at) {
  using Purpose = Chain::Purpose;
  const Chain& chain = at.chain_;
  const Purpose purpose = parity == Parity::odd && chain.half() ? Purpose::odd : Purpose::even;
  const Chain::Numbering numbering = chain.number(purpose);
  size_ = chain.size_ - chain.dense_size_ + numbering.size;
  for (Eigen::Index k = 0; k < numbering.size; ++k) dense_.push_back(k);
  for (int i = 0; i < chain.link_count(); ++i) place(purpose, numbering, i);
  const auto count = static_cast<Eigen::Index>(dense_.size());
  Block dense(count);
  joints_ = chain.variation_matrix(purpose, numbering, at.x_, at.loads_).entries();
  for (const auto& entry : joints_) dense(entry.row(), entry.col()) = entry.value();
  for (int i = 0; i < chain.link_count(); ++i) {
    const Place& here = places_[i];
    const auto& dofs = here.local.dofs;
    const MatrixXd share =
        chain.condensed_share(purpose, here.local, *here.part->arc, here.part->condensed, i);
    for (std::size_t r = 0; r < dofs.size(); ++r)
      for (std::size_t s = 0; s < dofs.size(); ++s) dense(dofs[r], dofs[s]) += share(r, s);
    negative_ += here.part->arc->negative_pivots();
  }
  neutral_size_ = chain.neutral_size(at.x_, at.loads_);
  phase_ = numbering.phase;
  if (phase_ >= 0) hold_phase(purpose, numbering, dense);
  if (chain.holds_knot(numbering)) hold_slide(purpose, numbering, dense);
  add_borders(dense);
  unknowns_ = dense.rows();
  dense.symmetrise();
  locations_ = numbering.location;
  const VectorXd turn = chain.neutral_turn(purpose, numbering, at.x_, at.loads_, dense);
  neutral_ = turn.size() > 0;
  if (neutral_) hold(dense, turn, usual_size(dense));
  condensed_ = dense;
  condensed_negative_ = negative_ - numbering.constraints;
  factors_ = std::make_shared<const SymmetricFactors>(dense.whole());
  negative_ += factors_->negative();
  if (factors_->least_pivot() < rounding * size_of(dense.diagonal())) {
    hold_null(dense);
    factors_ = std::make_shared<const SymmetricFactors>(dense.whole());
  }
  negative_ -= numbering.constraints;
}

void Variation::place(Chain::Purpose purpose, const Chain::Numbering& numbering, int link) {
  const Chain& chain = at_.chain_;
  const Linearisation::Part& part = at_.parts_[link];
  Place here{&part, chain.local(purpose, numbering, at_.x_, at_.loads_, link), {}, 0, points_};
  const Arc& arc = *part.arc;
  const Eigen::Index d = arc.tangent();
  if (part.tail) {  // its free end turns too
    const Eigen::Index known = here.local.columns.cols(), row = part.joint_first ? d : 0;
    here.local.columns.conservativeResize(Eigen::NoChange, known + d);
    here.local.columns.rightCols(d).setZero();
    here.local.columns.block(row, known, d, d).setIdentity();
    for (Eigen::Index c = 0; c < d; ++c) {
      here.local.dofs.push_back(static_cast<Eigen::Index>(dense_.size()));
      dense_.push_back(size_++);
    }
    here.interior = size_;
    size_ += arc.interior_tangent();
  } else {
    here.interior = chain.interior_row_[link] - chain.dense_size_ + numbering.size;
  }
  for (const Eigen::Index dof : here.local.dofs) here.at.push_back(dense_[dof]);
  if (part.slope.size() > 0) here.left = numbering.location[link], here.right = numbering.location[link + 1];
  points_ += part.root.size();
  places_.push_back(std::move(here));
}

double Variation::size_of(const VectorXd& values) const {
  const bool holds = unknowns_ > static_cast<Eigen::Index>(dense_.size());
  return std::max(values.size() > 0 ? median(values.cwiseAbs()) : 0.0, holds ? 1.0 : 0.0);
}

/// D + τ d dᵀ for the dense block D of a singular K, d the dense part of its null vector g: solves K v = f for every f with
/// gᵀf = 0, as gᵀ times the equation says that d·v = 0.
void Variation::hold(Block& dense, const VectorXd& d, double by) {
  chain::hold(dense, d, by);
  neutral_motion_ = VectorXd::Zero(size_);
  expand(d, neutral_motion_);
}

void Variation::hold_null(Block& dense) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(dense.whole());
  Eigen::Index nearest = 0;
  const double least = eigen.eigenvalues().cwiseAbs().minCoeff(&nearest);
  const double usual = size_of(eigen.eigenvalues());
  if (least > rounding * usual) return;
  hold(dense, eigen.eigenvectors().col(nearest), usual);
  // Forces of touches so near each other that they hold the same: a motion without weight, of infinite eigenvalue.
  if (!(std::abs(quotient(neutral_motion_).value) <= usual)) neutral_motion_.resize(0);
}

/// Puts the dense unknowns y into v; its interiors, reduced right sides so far, follow.
void Variation::expand(const VectorXd& y, VectorXd& v) const {
  for (std::size_t k = 0; k < dense_.size(); ++k) v(dense_[k]) = y(static_cast<Eigen::Index>(k));
  VectorXd share;
  bvp::EndsVector ends;
  for (const Place& here : places_) {
    const Arc& arc = *here.part->arc;
    if (arc.interior_nodes() == 0) continue;
    auto inside = v.segment(here.interior, arc.interior_tangent());
    for (const Chain::Border& border : here.borders) inside -= y(border.row) * border.reduced;
    share.resize(here.local.dofs.size());
    for (Eigen::Index r = 0; r < share.size(); ++r) share(r) = y(here.local.dofs[r]);
    ends.noalias() = here.local.columns * share;
    arc.expand(inside.data(), ends);
  }
}

/// K + τ M g gᵀ M, g the phase's motion of unit size: moves it out of the way and, as K g = 0, leaves all other eigenvectors
/// as they are. Written with one more unknown. A straight rod has no such motion.
void Variation::hold_phase(Chain::Purpose purpose, const Chain::Numbering& numbering, Block& dense) {
  constexpr double straight = 1e-6;  // [rad √length]
  motion_ = at_.chain_.phase_motion(purpose, numbering, at_.x_, at_.loads_);
  const VectorXd turned = rotations(motion_);
  const double size = turned.norm();
  motion_ = size > straight ? VectorXd(loads(turned) * (std::sqrt(at_.stiffest_) / size))
                            : VectorXd(VectorXd::Zero(size_));
  motion_(phase_) = 0.0;
  for (std::size_t k = 0; k < dense_.size(); ++k) {
    dense(static_cast<Eigen::Index>(k), phase_) += motion_(dense_[k]);
    dense(phase_, static_cast<Eigen::Index>(k)) += motion_(dense_[k]);
  }
}

/// As Chain::condensed_variation; struts have no tails in closed form, so that the two list their unknowns alike.
void Variation::hold_slide(Chain::Purpose purpose, const Chain::Numbering& numbering, Block& dense) {
  slide_ = numbering.slide;
  slid_by_ = at_.chain_.slid_by(purpose, numbering, at_.x_, at_.loads_);
  for (std::size_t k = 0; k < dense_.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(k);
    dense(at, slide_) = dense(slide_, at) = slid_by_(dense_[k]);
  }
}

void Variation::add_borders(Block& dense) {
  for (Place& here : places_) {
    const Arc& arc = *here.part->arc;
    if (arc.interior_nodes() == 0) continue;
    std::vector<Chain::Coupled> coupled = Chain::held_by(arc, dense);
    if (phase_ >= 0) coupled.push_back({phase_, motion_.segment(here.interior, arc.interior_tangent())});
    if (slide_ >= 0) coupled.push_back({slide_, slid_by_.segment(here.interior, arc.interior_tangent())});
    here.borders = Chain::add_borders(arc, here.local, coupled, dense);
  }
}

Variation::Doubt Variation::doubt() const {
  constexpr double close = 1e-8;  // of the largest: an eigenvalue of the block is not yet one of K
  constexpr double elimination =
      16.0;  // times the rounding of a quotient; 4 was seen, in long loops of struts
  const SmallEigenvalues small = small_eigenvalues(condensed_.whole(), close);
  Doubt out{condensed_negative_ + small.negative};
  VectorXd motion(size_);
  for (Eigen::Index k = 0; k < small.values.size(); ++k) {
    const double value = small.values(k);
    // A touch that shifts, and with it its place on the obstacle and its frame: the sign is its force's, which has an
    // event of its own.
    constexpr double mostly = 0.2;
    double shift = 0.0;
    for (const Eigen::Index row : locations_)
      if (row >= 0) shift += std::pow(small.vectors(row, k), 2);
    if (shift > mostly) continue;
    motion.setZero();
    expand(small.vectors.col(k), motion);
    const double weight = rotations(motion).squaredNorm();
    // Forces that hold the same, of touches next to each other, move nothing. A force is a negative direction,
    // however little it does by itself and whatever sign rounding gives that. Motions bring forces of up to 1e5
    // with them: weights of 1e-10.
    if (weight < std::numeric_limits<double>::epsilon()) {
      out.negative += value > 0.0;
      continue;
    }
    if (!(std::abs(value) <= elimination * quotient(motion).rounding * weight)) continue;
    ++out.rounded;
    out.negative -= value < 0.0;
  }
  return out;
}

VectorXd Variation::gathered(const Place& here, const VectorXd& v) const {
  VectorXd out(here.at.size());
  for (Eigen::Index r = 0; r < out.size(); ++r) out(r) = v(here.at[r]);
  return out;
}

VectorXd Variation::rotations(const VectorXd& v) const {
  VectorXd out(points_);
  for (const Place& here : places_) {
    const Linearisation::Part& part = *here.part;
    const Eigen::Index inner = part.arc->interior_tangent(), ends = part.root.size() - inner;
    auto turned = out.segment(here.first, part.root.size());
    turned.head(inner) = v.segment(here.interior, inner);
    turned.tail(ends).noalias() = here.local.columns.topRows(ends) * gathered(here, v);
    if (here.left >= 0) turned -= v(here.left) * part.slope.col(0);
    if (here.right >= 0) turned -= v(here.right) * part.slope.col(1);
    turned.array() *= part.root.array();
  }
  return out;
}

VectorXd Variation::loads(const Eigen::Ref<const VectorXd>& y) const {
  VectorXd out = VectorXd::Zero(size_), weighed, share;
  for (const Place& here : places_) {
    const Linearisation::Part& part = *here.part;
    const Eigen::Index inner = part.arc->interior_tangent(), ends = part.root.size() - inner;
    weighed = y.segment(here.first, part.root.size()).cwiseProduct(part.root);
    out.segment(here.interior, inner) = weighed.head(inner);
    share = here.local.columns.topRows(ends).transpose() * weighed.tail(ends);
    for (Eigen::Index r = 0; r < share.size(); ++r) out(here.at[r]) += share(r);
    if (here.left >= 0) out(here.left) -= part.slope.col(0).dot(weighed);
    if (here.right >= 0) out(here.right) -= part.slope.col(1).dot(weighed);
  }
  return out;
}

VectorXd Variation::solve(VectorXd f) const {
  const auto count = static_cast<Eigen::Index>(dense_.size());
  bvp::EndsVector ends;
  VectorXd share, y = VectorXd::Zero(unknowns_);
  for (const Place& here : places_) {
    const Arc& arc = *here.part->arc;
    if (arc.interior_nodes() == 0) continue;
    auto inside = f.segment(here.interior, arc.interior_tangent());
    for (const Chain::Border& border : here.borders) y(border.row) -= border.solved.dot(inside);
    ends.setZero(arc.ends());
    arc.reduce(inside.data(), ends);
    share.noalias() = here.local.columns.transpose() * ends;
    for (Eigen::Index r = 0; r < share.size(); ++r) f(here.at[r]) += share(r);
  }
  for (Eigen::Index k = 0; k < count; ++k) y(k) += f(dense_[k]);
  factors_->solve(y);
  expand(y, f);
  return f;
}

VectorXd Variation::product(const VectorXd& v) const {
  VectorXd out = VectorXd::Zero(size_), w, image, y(dense_.size());
  for (const Place& here : places_) {
    const Linearisation::Part& part = *here.part;
    const Eigen::Index inner = part.arc->interior_tangent(), ends = here.local.columns.rows();
    w.resize(inner + ends);
    w.head(inner) = v.segment(here.interior, inner);
    w.tail(ends) = here.local.columns * gathered(here, v);
    image.setZero(inner + ends);
    for (const auto& entry : part.hessian) image(entry.row()) += entry.value() * w(entry.col());
    out.segment(here.interior, inner) += image.head(inner);
    const VectorXd share = here.local.columns.transpose() * image.tail(ends);
    for (Eigen::Index r = 0; r < share.size(); ++r) out(here.at[r]) += share(r);
  }
  for (Eigen::Index k = 0; k < y.size(); ++k) y(k) = v(dense_[k]);
  for (const auto& entry : joints_) {
    out(dense_[entry.row()]) += 0.5 * entry.value() * y(entry.col());
    out(dense_[entry.col()]) += 0.5 * entry.value() * y(entry.row());
  }
  if (phase_ >= 0) {
    out += v(phase_) * motion_;
    out(phase_) += motion_.dot(v);
  }
  if (slide_ >= 0) {
    out += v(slide_) * slid_by_;
    out(slide_) += slid_by_.dot(v);
  }
  return out;
}

Variation::Quotient Variation::quotient(const VectorXd& v) const {
  double value = 0.0, sizes = 0.0;
  const auto add = [&](double term) {
    value += term;
    sizes += std::abs(term);
  };
  VectorXd w;
  for (const Place& here : places_) {
    const Linearisation::Part& part = *here.part;
    const Eigen::Index inner = part.arc->interior_tangent();
    w.resize(inner + here.local.columns.rows());
    w.head(inner) = v.segment(here.interior, inner);
    w.tail(here.local.columns.rows()) = here.local.columns * gathered(here, v);
    for (const auto& entry : part.hessian) add(entry.value() * w(entry.row()) * w(entry.col()));
  }
  for (const auto& entry : joints_) add(entry.value() * v(dense_[entry.row()]) * v(dense_[entry.col()]));
  if (phase_ >= 0) add(2.0 * v(phase_) * motion_.dot(v));
  if (slide_ >= 0) add(2.0 * v(slide_) * slid_by_.dot(v));
  const double size = rotations(v).squaredNorm();
  return {value / size, std::numeric_limits<double>::epsilon() * sizes / size};
}

}  // namespace windlass::chain
