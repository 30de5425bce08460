// Definitions of CollocationArc; included by the files that instantiate it, one a density.
#include <algorithm>
#include <array>
#include <stdexcept>

#include "windlass/bvp/collocation_arc.hpp"

namespace windlass::bvp {

template <class Density>
CollocationArc<Density>::CollocationArc(Density density, std::vector<double> mesh, int stages)
    : density_(std::move(density)), mesh_(std::move(mesh)), table_(CollocationTable::get(stages)) {
  if (mesh_.size() < 2) throw std::invalid_argument("an arc's mesh needs at least one element");
  element_factors_.resize(mesh_.size() - 1);
  node_factors_.resize(mesh_.size() - 2);
  for (auto& factor : element_factors_) factor.resize(inner(), E);
  for (auto& factor : node_factors_) factor.resize(D, E);
  for (Held& held : held_) held.direction.setZero(D);
  element_.setZero(inner() + E, inner() + E);
  node_.setZero(D + E, D + E);
}

template <class Density>
const double* CollocationArc<Density>::node(const ArcPoint& at, int k) const {
  if (k == 0) return at.q_a;
  if (k == elements() * stages()) return at.q_b;
  return at.interior + (k - 1) * A;
}

template <class Density>
void CollocationArc<Density>::gather(const ArcPoint& at, int element, Nodes& q) const {
  q.resize(A, stages() + 1);
  for (int i = 0; i <= stages(); ++i) q.col(i) = Eigen::Map<const Ambient>(node(at, element * stages() + i));
}

namespace {

/// Rows of a table, one a Gauss point, padded with zeros to a fixed length that fills whole vector registers.
struct PaddedTable {
  static constexpr int length = 12;
  static_assert(length >= max_stages + 2);
  using Row = Eigen::Array<double, length, 1>;
  std::array<Row, max_stages + 1> value, slope;

  explicit PaddedTable(int stages) {
    const CollocationTable& table = CollocationTable::get(stages);
    for (int g = 0; g < stages; ++g) {
      value[g].setZero(), slope[g].setZero();
      value[g].head(stages + 1) = table.value.row(g).transpose().array();
      slope[g].head(stages + 1) = table.slope.row(g).transpose().array();
    }
  }

  static const PaddedTable& get(int stages) {
    static const auto tables = [] {
      std::vector<PaddedTable> all;
      for (int m = min_stages; m <= max_stages + 1; ++m) all.emplace_back(m);
      return all;
    }();
    return tables[stages - min_stages];
  }

  template <class Nodes>
  static Row pad(const Nodes& q) {
    Row out = Row::Zero();
    for (Eigen::Index i = 0; i < q.size(); ++i) out(i) = q(i);
    return out;
  }
};

/// Value and derivative of an element's polynomial at Gauss point g.
template <class Nodes, class Ambient>
void evaluate(const CollocationTable& table, const Nodes& q, int g, double inverse, Ambient& value,
              Ambient& slope) {
  value.setZero();
  slope.setZero();
  for (int i = 0; i <= table.stages; ++i) {
    value += table.value(g, i) * q.col(i);
    slope += table.slope(g, i) * q.col(i);
  }
  slope *= inverse;
}

}  // namespace

template <class Density>
void CollocationArc<Density>::element_gradient(const Nodes& q, const ArcPoint& at, int element, Nodes& out,
                                               Force& g_n, double& g_length) const {
  const double h = mesh_[element + 1] - mesh_[element], inverse = 1.0 / (h * at.length);
  const int m = stages();
  if constexpr (A == 1) {
    const PaddedTable& table = PaddedTable::get(m);
    const PaddedTable::Row nodes = PaddedTable::pad(q);
    PaddedTable::Row sum = PaddedTable::Row::Zero();
    Ambient value, slope;
    Eigen::Vector2d gz;
    Force d;
    for (int g = 0; g < m; ++g) {
      value(0) = (table.value[g] * nodes).sum(), slope(0) = inverse * (table.slope[g] * nodes).sum();
      const double lagrangian = first(value, slope, force_there(at, element, g), at, gz, d);
      const double w = h * table_.weight(g), wl = w * at.length;
      g_n -= wl * d;
      g_length += w * (lagrangian - gz(1) * slope(0));
      if constexpr (stretches) g_length += w * fallen(at, element, g, d);
      sum += (wl * gz(0)) * table.value[g] + (table_.weight(g) * gz(1)) * table.slope[g];
    }
    out.resize(A, m + 1);
    for (int i = 0; i <= m; ++i) out(i) = sum(i);
    return;
  }
  // All Gauss points at once: products of small matrices, whose inner loops run over contiguous numbers.
  Nodes values(A, m), slopes(A, m);
  values.noalias() = q.lazyProduct(table_.value.transpose());
  slopes.noalias() = q.lazyProduct(table_.slope.transpose());
  slopes *= inverse;
  Eigen::Matrix<double, 2 * A, 1> gz;
  Force d;
  for (int g = 0; g < m; ++g) {
    const Ambient value = values.col(g), slope = slopes.col(g);
    const double lagrangian = first(value, slope, force_there(at, element, g), at, gz, d);
    const double w = h * table_.weight(g), wl = w * at.length;
    g_n -= wl * d;
    g_length += w * (lagrangian - gz.template tail<A>().dot(slope));
    if constexpr (stretches) g_length += w * fallen(at, element, g, d);
    values.col(g) = wl * gz.template head<A>();
    slopes.col(g) = table_.weight(g) * gz.template tail<A>();
  }
  out.noalias() = values.lazyProduct(table_.value);
  out.noalias() += slopes.lazyProduct(table_.slope);
}

template <class Density>
void CollocationArc<Density>::gradient(const ArcPoint& at, double* interior, EndsVector& ends) const {
  ends.setZero(E);
  std::fill_n(interior, interior_tangent(), 0.0);
  Force g_n = Force::Zero();
  double g_length = 0.0;
  const int last = elements() * stages();
  Nodes q, g;
  for (int e = 0; e < elements(); ++e) {
    gather(at, e, q);
    element_gradient(q, at, e, g, g_n, g_length);
    for (int i = 0; i <= stages(); ++i) {
      const int k = e * stages() + i;
      const Eigen::Matrix<double, D, 1> projected = density_.basis(q.col(i)).transpose() * g.col(i);
      if (k == 0)
        ends.template head<D>() += projected;
      else if (k == last)
        ends.template segment<D>(D) += projected;
      else
        Eigen::Map<Eigen::Matrix<double, D, 1>>(interior + (k - 1) * D) += projected;
    }
  }
  ends.template segment<P>(2 * D) = g_n;
  ends(E - 1) = g_length;
}

}  // namespace windlass::bvp

#include "arc_quantities.ipp"
#include "element_condensation.ipp"
#include "element_hessians.ipp"
