// Sliding of a rod along itself: what it costs, and how a knot round nothing is held against it while directions are counted.
#include "windlass/chain/chain.hpp"

namespace windlass::chain {

// A slide by δ turns the section at s by u(s) δ, u = dφ/ds. Variations are held by ∫ u·δφ ds = 0, φ at material points: where K of the
// slide is zero, whatever the sign that rounding or the touches of a line give it, this leaves the other directions as they are.
VectorXd Chain::slid_by(Purpose purpose, const Numbering& numbering, const VectorXd& x,
                        const Loads& loads) const {
  const Eigen::Index shift = numbering.size - dense_size_;
  VectorXd out = VectorXd::Zero(size_ + shift);
  double whole = 0.0;
  for (int i = 0; i < link_count(); ++i) {
    const Arc& arc = *links_[i].arc;
    const Placed placed = place(x, loads, i);
    const bvp::ArcSamples samples = arc.sample(placed.point());
    if (samples.slope.size() == 0) continue;  // of no length
    const VectorXd mass = arc.metric(placed.point());
    const Eigen::Index d = arc.tangent(), inner = arc.interior_tangent(), last = samples.sigma.size() - 1;
    VectorXd turn(inner + 2 * d);
    double left = 0.0, right = 0.0;  // what a touch there that moves alone takes along
    for (Eigen::Index k = 0; k <= last; ++k) {
      const Eigen::Index row = k == 0 ? inner : k == last ? inner + d : (k - 1) * d;
      turn.segment(row, d) = mass.segment(row, d).cwiseProduct(samples.slope.col(k));
      const double size = turn.segment(row, d).dot(samples.slope.col(k));
      left += (1.0 - samples.sigma(k)) * size;
      right += samples.sigma(k) * size;
    }
    whole += left + right;
    out.segment(interior_row_[i] + shift, inner) = turn.head(inner);
    const Local l = local(purpose, numbering, x, loads, i);
    const VectorXd share = l.columns.topRows(2 * d).transpose() * turn.tail(2 * d);
    for (std::size_t r = 0; r < l.dofs.size(); ++r) out(l.dofs[r]) += share(static_cast<Eigen::Index>(r));
    if (numbering.location[i] >= 0) out(numbering.location[i]) -= left;
    if (numbering.location[i + 1] >= 0) out(numbering.location[i + 1]) -= right;
  }
  return out / whole;
}

double Chain::sliding_stiffness(const VectorXd& x, const Loads& loads) const {
  const Purpose purpose = half() ? Purpose::odd : Purpose::even;
  // A knot takes the touches of its lines along.
  const Numbering numbering = number(purpose, gauges_.knot);
  if (numbering.slide < 0) return 0.0;
  // K v + Φᵀμ = 0, Φ v = 1: the slide of size one that costs least, and −μ = v·K v. A half chain has half the energy.
  const MatrixXd dense = condensed_variation(purpose, numbering, x, loads, arcs(), condensed_);
  const VectorXd v = dense.partialPivLu().solve(VectorXd::Unit(dense.rows(), numbering.slide));
  return -(half() ? 2.0 : 1.0) * v(numbering.slide);
}

}  // namespace windlass::chain
