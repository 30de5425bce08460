// Sliding of a rod along itself: what it costs, and how a knot round nothing is held against it while directions are counted.
#include "windlass/chain/chain.hpp"
#include "windlass/rod/quaternion.hpp"

namespace windlass::chain {

namespace {

/// At the Lagrange points of an arc: their places, by how much a slide along the rod and a turn of all of it turn the sections
/// there, in their frames, and the metric.
struct Turned {
  VectorXd sigma;
  MatrixXd by_slide, by_turn, mass;
};

}  // namespace

// A slide by δ turns the section at s by u(s) δ, u = dφ/ds. Variations are held by ∫ u·δφ ds = 0, φ at material points: where K of the
// slide is zero, whatever the sign that rounding or the touches of a line give it, this leaves the other directions as they are. A turn ω of the
// whole rod about the line of its ends costs nothing either and is no slide: u is taken less its part along ω.
VectorXd Chain::slid_by(Purpose purpose, const Numbering& numbering, const VectorXd& x,
                        const Loads& loads) const {
  std::vector<Turned> arcs(links_.size());
  double along = 0.0, whole_turn = 0.0;
  const auto turn = [&](const bvp::ArcSamples& samples) {
    MatrixXd out = MatrixXd::Zero(samples.slope.rows(), samples.slope.cols());
    for (Eigen::Index k = 0; k < out.cols() && gauges_.phase; ++k)
      out.col(k) = rod::turn_increment(samples.q.col(k), Eigen::Vector3d::UnitX(), *gauges_.phase);
    return out;
  };
  for (int i = 0; i < link_count(); ++i) {
    const Arc& arc = *links_[i].arc;
    const Placed placed = place(x, loads, i);
    const bvp::ArcSamples samples = arc.sample(placed.point());
    if (samples.slope.size() == 0) continue;  // of no length
    const VectorXd mass = arc.metric(placed.point());
    const Eigen::Index d = arc.tangent(), inner = arc.interior_tangent(), last = samples.sigma.size() - 1;
    Turned& at = arcs[i] = {samples.sigma, samples.slope, turn(samples), MatrixXd(d, last + 1)};
    at.mass << mass.segment(inner, d), mass.head(inner).reshaped(d, last - 1), mass.segment(inner + d, d);
    along += (at.by_slide.array() * at.mass.array() * at.by_turn.array()).sum();
    whole_turn += (at.by_turn.array().square() * at.mass.array()).sum();
  }
  const Eigen::Index shift = numbering.size - dense_size_;
  VectorXd out = VectorXd::Zero(size_ + shift);
  double whole = 0.0;
  for (int i = 0; i < link_count(); ++i) {
    const Turned& at = arcs[i];
    const Eigen::Index inner = links_[i].arc->interior_tangent(), d = links_[i].arc->tangent(),
                       last = at.sigma.size() - 1;
    if (last < 0) continue;
    MatrixXd held = at.by_slide;
    if (whole_turn > 0.0) held -= along / whole_turn * at.by_turn;
    held.array() *= at.mass.array();
    out.segment(interior_row_[i] + shift, inner) = held.middleCols(1, last - 1).reshaped();
    const Local l = local(purpose, numbering, x, loads, i);
    const VectorXd share = l.columns.topRows(d).transpose() * held.col(0) +
                           l.columns.middleRows(d, d).transpose() * held.col(last);
    for (std::size_t r = 0; r < l.dofs.size(); ++r) out(l.dofs[r]) += share(static_cast<Eigen::Index>(r));
    // A touch that moves along the rod takes the arc's sections along; the material stays.
    const VectorXd size = (held.array() * at.by_slide.array()).colwise().sum().transpose();
    const double right = at.sigma.dot(size);
    if (numbering.location[i] >= 0) out(numbering.location[i]) -= size.sum() - right;
    if (numbering.location[i + 1] >= 0) out(numbering.location[i + 1]) -= right;
    whole += size.sum();
  }
  return out / whole;
}

double Chain::sliding_stiffness(const VectorXd& x, const Loads& loads) const {
  const Purpose purpose = half() ? Purpose::odd : Purpose::even;
  // A knot takes the touches of its lines along.
  const Numbering numbering = number(purpose, gauges_.knot);
  if (numbering.slide < 0) return 0.0;
  // K v + Φᵀμ = 0, Φ v = 1: the slide of size one that costs least, and −μ = v·K v. A half chain has half the energy.
  BlockFactors dense;
  const Block block = condensed_variation(purpose, numbering, x, loads, arcs(), condensed_);
  dense.compute(block);
  const VectorXd v = dense.solve(VectorXd::Unit(block.rows(), numbering.slide), false);
  return -(half() ? 2.0 : 1.0) * v(numbering.slide);
}

}  // namespace windlass::chain
