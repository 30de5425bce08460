#include <algorithm>
#include <cmath>

#include "windlass/bvp/collocation_arc.hpp"
#include "windlass/bvp/collocation_table.hpp"
#include "windlass/chain/guess.hpp"
#include "windlass/chain/variation.hpp"
#include "windlass/rod/closed_form_arcs.hpp"
#include "windlass/rod/kirchhoff_density.hpp"
#include "windlass/rod/planar_density.hpp"

namespace windlass::chain {

namespace {

constexpr int stages = 6;
/// Elements of a tail: this many at least, and on average none longer than so many decay lengths. The mesh is graded to the
/// joint: far elements are several times as long, and do not resolve modes of the continuum that live there.
constexpr int least_elements = 10;
constexpr double longest_element = 4.0;
/// An infinite tail is cut so many decay lengths out: exp(−40) is below rounding.
constexpr double straight = 40.0;

std::unique_ptr<Arc> mesh_of_tail(const RodKind& rod, double decay_lengths, bool starts_at_joint) {
  const int elements = std::max(least_elements, static_cast<int>(std::ceil(decay_lengths / longest_element)));
  std::vector<double> mesh = tail_mesh(1.0, decay_lengths, elements, stages);
  // Where the tail is straight its modes still are waves: no element longer than a few of its decay lengths.
  constexpr double longest_far = 3.0;
  mesh = split_mesh(mesh, decay_lengths, longest_far);
  if (!starts_at_joint) {
    std::reverse(mesh.begin(), mesh.end());
    for (double& node : mesh) node = 1.0 - node;
  }
  if (rod.spatial)
    return bvp::make_collocation_arc(rod::KirchhoffDensity{rod.stiffness, rod.natural}, mesh, stages);
  return bvp::make_collocation_arc(rod::PlanarDensity{rod.bending_stiffness, rod.natural_curvature()}, mesh,
                                   stages);
}

/// Scaled arclengths of an arc's nodes, both ends included.
VectorXd nodes_of(const Arc& arc) {
  const std::vector<double> mesh = arc.mesh();
  const VectorXd& lobatto = bvp::CollocationTable::get(arc.stages()).lobatto;
  VectorXd sigma(arc.interior_nodes() + 2);
  for (int e = 0; e < arc.elements(); ++e)
    sigma.segment(e * arc.stages(), arc.stages() + 1) = mesh[e] + (mesh[e + 1] - mesh[e]) * lobatto.array();
  return sigma;
}

}  // namespace

Linearisation::Linearisation(const Chain& chain, const RodKind& rod, const VectorXd& x, const Loads& loads)
    : chain_(chain), x_(x), loads_(loads) {
  const auto is_touch = [&](int j) { return chain.joint(j).kind() == contact::JointKind::touch; };
  parts_.reserve(chain.link_count());
  for (int i = 0; i < chain.link_count(); ++i) {
    const bool tail = dynamic_cast<const rod::TailArc*>(chain.link(i).arc.get()) != nullptr;
    parts_.push_back(tail ? tail_part(rod, i) : own_part(i));
    measure(parts_.back(), is_touch(i) || is_touch(i + 1));
  }
  for (const Part& part : parts_) {
    const Eigen::Index inner = part.arc->interior_tangent();
    VectorXd diagonal = VectorXd::Zero(inner);
    for (const auto& entry : part.hessian)
      if (entry.row() == entry.col() && entry.row() < inner) diagonal(entry.row()) += entry.value();
    if (inner > 0)
      stiffest_ =
          std::max(stiffest_, (diagonal.array().abs() / part.root.head(inner).array().square()).maxCoeff());
  }
}

Linearisation::Part Linearisation::own_part(int link) const {
  Part part;
  part.arc = chain_.links_[link].arc.get();
  part.placed = chain_.place(x_, loads_, link);
  part.condensed = chain_.condensed_[link];
  if (chain_.neutral(x_, loads_, link)) {
    part.shortened = chain_.shortened(x_, loads_, link, part.condensed);
    part.arc = part.shortened.get();
  }
  return part;
}

Linearisation::Part Linearisation::tail_part(const RodKind& rod, int link) const {
  const auto& formula = dynamic_cast<const rod::TailArc&>(*chain_.links_[link].arc);
  Part part;
  part.placed = chain_.place(x_, loads_, link);
  const double decay = formula.decay_length(part.placed.point());
  if (formula.infinite()) part.placed.length = straight * decay;
  const double length = part.placed.length;
  const bool starts = part.joint_first = formula.starts_at_joint();
  part.tail = mesh_of_tail(rod, length / decay, starts);
  part.arc = part.tail.get();
  VectorXd distances = length * nodes_of(*part.arc);
  if (!starts) distances = (length - distances.array()).reverse().eval();
  part.nodes = formula.configurations(part.placed.point(), distances);
  if (!starts) part.nodes = part.nodes.rowwise().reverse().eval();
  part.placed.interior = part.nodes.data() + part.nodes.rows();
  (starts ? part.placed.right : part.placed.left).q =
      starts ? part.nodes.rightCols<1>() : part.nodes.leftCols<1>();
  part.tail->factor(part.placed.point(), part.condensed);
  return part;
}

void Linearisation::measure(Part& part, bool touches) const {
  const Arc& arc = *part.arc;
  const Eigen::Index d = arc.tangent(), rows = arc.interior_tangent() + 2 * d;
  part.root = arc.metric(part.placed.point()).head(rows).cwiseSqrt();
  arc.hessian(part.placed.point(), part.hessian);
  if (!touches) return;
  const bvp::ArcSamples samples = arc.sample(part.placed.point());
  if (samples.slope.size() == 0) return;
  // The arc's samples move with a touch: the material there turns by δq − q' δs.
  part.slope.resize(rows, 2);
  const Eigen::Index last = samples.sigma.size() - 1;
  for (Eigen::Index k = 0; k <= last; ++k) {
    const Eigen::Index row = k == 0 ? rows - 2 * d : k == last ? rows - d : (k - 1) * d;
    part.slope.block(row, 0, d, 1) = (1.0 - samples.sigma(k)) * samples.slope.col(k);
    part.slope.block(row, 1, d, 1) = samples.sigma(k) * samples.slope.col(k);
  }
}

}  // namespace windlass::chain
