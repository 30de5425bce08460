// Definitions of CollocationArc; included by the files that instantiate it, one a kind of configuration.
#include <algorithm>
#include <array>
#include <stdexcept>

#include "windlass/bvp/collocation_arc.hpp"

namespace windlass::bvp {

template <class Configuration, int P>
CollocationArc<Configuration, P>::CollocationArc(std::shared_ptr<const Density> density,
                                                 std::vector<double> mesh, int stages)
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

template <class Configuration, int P>
const double* CollocationArc<Configuration, P>::node(const ArcPoint& at, int k) const {
  if (k == 0) return at.q_a;
  if (k == elements() * stages()) return at.q_b;
  return at.interior + (k - 1) * A;
}

template <class Configuration, int P>
void CollocationArc<Configuration, P>::gather(const ArcPoint& at, int element, Nodes& q) const {
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

}  // namespace

template <class Configuration, int P>
void CollocationArc<Configuration, P>::gauss_sections(const Nodes& q, const ArcPoint& at, int element,
                                                      Sections<A, P>& out) const {
  const double inverse = 1.0 / ((mesh_[element + 1] - mesh_[element]) * at.length);
  const int m = stages();
  out.count = m;
  out.q.resize(A, m), out.slope.resize(A, m);
  if constexpr (A == 1) {
    const PaddedTable& table = PaddedTable::get(m);
    const PaddedTable::Row nodes = PaddedTable::pad(q);
    for (int g = 0; g < m; ++g)
      out.q(g) = (table.value[g] * nodes).sum(), out.slope(g) = inverse * (table.slope[g] * nodes).sum();
  } else {  // products of small matrices, whose inner loops run over contiguous numbers
    out.q.noalias() = q.lazyProduct(table_.value.transpose());
    out.slope.noalias() = q.lazyProduct(table_.slope.transpose());
    out.slope *= inverse;
  }
  out.compliance = at.compliance;
  out.falls = at.weight != nullptr;
  out.n[0] = Eigen::Map<const Force>(at.n);
  if (out.falls)
    for (int g = m - 1; g >= 0; --g)
      out.n[g] = out.n[0] - along(at, element, g) * Eigen::Map<const Force>(at.weight);
}

template <class Configuration, int P>
void CollocationArc<Configuration, P>::element_gradient(Sections<A, P>& sections, const Firsts& first,
                                                        const ArcPoint& at, int element, Nodes& out,
                                                        Force& g_n, double& g_length) const {
  const double h = mesh_[element + 1] - mesh_[element];
  const int m = stages();
  for (int g = 0; g < m; ++g) {
    const double w = h * table_.weight(g);
    g_n -= w * at.length * first[g].d;
    g_length += w * (first[g].value - first[g].gz.template tail<A>().dot(sections.slope.col(g)));
    if (at.weight)  // ℓ ∂n/∂ℓ·∂L/∂n
      g_length += w * along(at, element, g) * Eigen::Map<const Force>(at.weight).dot(first[g].d);
  }
  if constexpr (A == 1) {
    const PaddedTable& table = PaddedTable::get(m);
    PaddedTable::Row sum = PaddedTable::Row::Zero();
    for (int g = 0; g < m; ++g)
      sum += (h * table_.weight(g) * at.length * first[g].gz(0)) * table.value[g] +
             (table_.weight(g) * first[g].gz(1)) * table.slope[g];
    out.resize(A, m + 1);
    for (int i = 0; i <= m; ++i) out(i) = sum(i);
  } else {
    Nodes &by_value = sections.q, &by_slope = sections.slope;  // used up
    for (int g = 0; g < m; ++g) {
      by_value.col(g) = h * table_.weight(g) * at.length * first[g].gz.template head<A>();
      by_slope.col(g) = table_.weight(g) * first[g].gz.template tail<A>();
    }
    out.noalias() = by_value.lazyProduct(table_.value);
    out.noalias() += by_slope.lazyProduct(table_.slope);
  }
}

template <class Configuration, int P>
void CollocationArc<Configuration, P>::gradient(const ArcPoint& at, double* interior,
                                                EndsVector& ends) const {
  ends.setZero(E);
  std::fill_n(interior, interior_tangent(), 0.0);
  Force g_n = Force::Zero();
  double g_length = 0.0;
  const int last = elements() * stages();
  Nodes q, g;
  Sections<A, P> sections;
  Firsts first;
  for (int e = 0; e < elements(); ++e) {
    gather(at, e, q);
    gauss_sections(q, at, e, sections);
    density_->first(sections, first.data());
    element_gradient(sections, first, at, e, g, g_n, g_length);
    for (int i = 0; i <= stages(); ++i) {
      const int k = e * stages() + i;
      const Eigen::Matrix<double, D, 1> projected = Configuration::basis(q.col(i)).transpose() * g.col(i);
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
