#include "windlass/chain/variation.hpp"

#include <cmath>
#include <limits>

namespace windlass::chain {

using contact::Parity;

namespace {

/// LU factors of a symmetric matrix. One that is singular to the last bit is moved by its rounding, so that K⁻¹ exists and
/// its largest eigenvalue is the null vector's.
Eigen::PartialPivLU<MatrixXd> regular_factors(const MatrixXd& dense) {
  Eigen::PartialPivLU<MatrixXd> lu;
  if (dense.rows() == 0) return lu;
  lu.compute(dense);
  if (lu.matrixLU().diagonal().cwiseAbs().minCoeff() > 0.0) return lu;
  const double rounding = std::numeric_limits<double>::epsilon() * dense.cwiseAbs().maxCoeff();
  lu.compute(dense + rounding * MatrixXd::Identity(dense.rows(), dense.cols()));
  return lu;
}

}  // namespace

Variation::Variation(const Chain& chain, const VectorXd& x, const Loads& loads, Parity parity)
    : parity_(parity) {
  using Purpose = Chain::Purpose;
  const Purpose purpose = parity == Parity::odd && chain.half() ? Purpose::odd : Purpose::even;
  const Chain::Numbering numbering = chain.number(purpose);
  dense_size_ = numbering.size;
  size_ = chain.size_ - chain.dense_size_ + dense_size_;
  const MatrixXd dense = chain.condensed_variation(purpose, numbering, x, loads);
  negative_ = chain.negative_directions(dense, numbering);
  dense_ = regular_factors(dense);
  for (int i = 0; i < chain.link_count(); ++i) add_part(chain, numbering, x, loads, purpose, i);
  phase_ = numbering.phase;
  if (phase_ >= 0) add_phase(chain.phase_motion(purpose, numbering, x, loads));
}

void Variation::add_phase(const VectorXd& motion) {
  for (Part& part : parts_) {
    part.phase = motion.segment(part.interior, part.arc->interior_tangent());
    bvp::EndsVector ends = bvp::EndsVector::Zero(part.arc->ends());
    part.arc->reduce(part.phase.data(), ends);
    part.arc->expand(part.phase.data(), bvp::EndsVector::Zero(part.arc->ends()));
  }
  constexpr double straight = 1e-6;  // [rad √length]: a straight rod has no such motion
  const VectorXd turned = rotations(motion);
  if (turned.norm() > straight) neutral_ = turned.normalized();
}

void Variation::add_part(const Chain& chain, const Chain::Numbering& numbering, const VectorXd& x,
                         const Loads& loads, Chain::Purpose purpose, int link) {
  Part part{chain.links_[link].arc.get(),
            chain.local(purpose, numbering, x, loads, link),
            chain.place(x, loads, link),
            chain.interior_row_[link] - chain.dense_size_ + dense_size_,
            points_,
            {},
            numbering.location[link],
            numbering.location[link + 1],
            {},
            {},
            {}};
  const Arc& arc = *part.arc;
  const int d = arc.tangent(), rows = arc.interior_tangent() + 2 * d;
  part.root = arc.metric(part.placed.point()).head(rows).cwiseSqrt();
  points_ += rows;
  bvp::ArcSamples samples;
  if (part.left >= 0 || part.right >= 0) samples = arc.sample(part.placed.point());
  if (samples.slope.size() == 0) {
    part.left = part.right = -1;
  } else {
    // The arc's samples move with a touch: the material there turns by δq − q' δs.
    part.left_shift.resize(rows);
    part.right_shift.resize(rows);
    const Eigen::Index last = samples.sigma.size() - 1;
    for (Eigen::Index k = 0; k <= last; ++k) {
      const Eigen::Index row = k == 0 ? rows - 2 * d : k == last ? rows - d : (k - 1) * d;
      part.left_shift.segment(row, d) = -(1.0 - samples.sigma(k)) * samples.slope.col(k);
      part.right_shift.segment(row, d) = -samples.sigma(k) * samples.slope.col(k);
    }
  }
  parts_.push_back(std::move(part));
}

VectorXd Variation::rotations(const VectorXd& v) const {
  VectorXd out(points_);
  VectorXd y;
  for (const Part& part : parts_) {
    const Eigen::Index inner = part.arc->interior_tangent(), ends = part.root.size() - inner;
    auto turned = out.segment(part.first, part.root.size());
    y.resize(part.local.dofs.size());
    for (Eigen::Index r = 0; r < y.size(); ++r) y(r) = v(part.local.dofs[r]);
    turned.head(inner) = v.segment(part.interior, inner);
    turned.tail(ends).noalias() = part.local.columns.topRows(ends) * y;
    if (part.left >= 0) turned += v(part.left) * part.left_shift;
    if (part.right >= 0) turned += v(part.right) * part.right_shift;
    turned.array() *= part.root.array();
  }
  return out;
}

VectorXd Variation::loads(const VectorXd& y) const {
  VectorXd out = VectorXd::Zero(size_);
  VectorXd weighed, share;
  for (const Part& part : parts_) {
    const Eigen::Index inner = part.arc->interior_tangent(), ends = part.root.size() - inner;
    weighed = y.segment(part.first, part.root.size()).cwiseProduct(part.root);
    out.segment(part.interior, inner) = weighed.head(inner);
    share = part.local.columns.topRows(ends).transpose() * weighed.tail(ends);
    for (Eigen::Index r = 0; r < share.size(); ++r) out(part.local.dofs[r]) += share(r);
    if (part.left >= 0) out(part.left) += part.left_shift.dot(weighed);
    if (part.right >= 0) out(part.right) += part.right_shift.dot(weighed);
  }
  return out;
}

VectorXd Variation::solve(VectorXd f) const {
  bvp::EndsVector ends;
  VectorXd share;
  for (const Part& part : parts_) {
    if (part.arc->interior_nodes() == 0) continue;
    if (phase_ >= 0) f(phase_) -= part.phase.dot(f.segment(part.interior, part.phase.size()));
    ends.setZero(part.arc->ends());
    part.arc->reduce(f.data() + part.interior, ends);
    share = part.local.columns.transpose() * ends;
    for (Eigen::Index r = 0; r < share.size(); ++r) f(part.local.dofs[r]) += share(r);
  }
  if (dense_size_ > 0) f.head(dense_size_) = dense_.solve(f.head(dense_size_)).eval();
  for (const Part& part : parts_) {
    if (part.arc->interior_nodes() == 0) continue;
    share.resize(part.local.dofs.size());
    for (Eigen::Index r = 0; r < share.size(); ++r) share(r) = f(part.local.dofs[r]);
    ends = part.local.columns * share;
    part.arc->expand(f.data() + part.interior, ends);
    if (phase_ >= 0) f.segment(part.interior, part.phase.size()) -= f(phase_) * part.phase;
  }
  return f;
}

double Variation::rounding() const {
  double stiffest = 0.0;
  std::vector<Eigen::Triplet<double>> entries;
  for (const Part& part : parts_) {
    entries.clear();
    part.arc->hessian(part.placed.point(), entries);
    VectorXd diagonal = VectorXd::Zero(part.root.size());
    for (const auto& entry : entries)
      if (entry.row() == entry.col() && entry.row() < part.arc->interior_tangent())
        diagonal(entry.row()) += entry.value();
    for (Eigen::Index k = 0; k < part.arc->interior_tangent(); ++k)
      stiffest = std::max(stiffest, std::abs(diagonal(k)) / (part.root(k) * part.root(k)));
  }
  return std::numeric_limits<double>::epsilon() * stiffest;
}

}  // namespace windlass::chain
