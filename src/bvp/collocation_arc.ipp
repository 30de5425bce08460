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

template <class Density>
void CollocationArc<Density>::element_hessian(const Nodes& q, const ArcPoint& at, int element,
                                              Eigen::MatrixXd& k) const {
  if constexpr (stretches)
    stretched_hessian(q, at, element, k);
  else if constexpr (A == 1)
    scalar_hessian(q, at, element, k);
  else
    vector_hessian(q, at, element, k);
}

template <class Density>
void CollocationArc<Density>::vector_hessian(const Nodes& q, const ArcPoint& at, int element,
                                             Eigen::MatrixXd& k) const requires(A > 1 && !stretches) {
  const int m = stages(), columns = inner() + 2 * D, length = inner() + E - 1;
  const double h = mesh_[element + 1] - mesh_[element], inverse = 1.0 / (h * at.length);
  const Eigen::Map<const Force> n(at.n);
  // Sums over the Gauss points in ambient coordinates, a Lagrange point or a pair of them each; projected at the end.
  using Block = Eigen::Matrix<double, A, A>;
  std::array<std::array<Block, max_points>, max_points> pairs;
  std::array<Eigen::Matrix<double, P, A>, max_points> forces;
  std::array<Ambient, max_points> ambient, by_length;
  std::array<Block, max_points> of_value, of_slope;
  for (int i = 0; i <= m; ++i) {
    for (int j = 0; j <= i; ++j) pairs[i][j].setZero();
    forces[i].setZero(), ambient[i].setZero(), by_length[i].setZero();
  }
  k.bottomRows(P + 1).setZero();
  Ambient value, slope;
  Eigen::Matrix<double, 2 * A, 1> gz;
  Eigen::Matrix<double, 2 * A, 2 * A> hz;
  Force d;
  Eigen::Matrix<double, P, A> dd;
  for (int g = 0; g < m; ++g) {
    evaluate(table_, q, g, inverse, value, slope);
    density_.second(value, slope, n, gz, hz, d, dd);
    const double w = h * table_.weight(g), wl = w * at.length;
    // Derivatives with the length: q' = q_σ/(h ℓ).
    const Ambient value_by_length = gz.template head<A>() - hz.template topRightCorner<A, A>() * slope,
                  slope_by_length = -hz.template bottomRightCorner<A, A>() * slope;
    const Block qq = wl * hz.template topLeftCorner<A, A>(), qs = wl * hz.template topRightCorner<A, A>(),
                sq = wl * hz.template bottomLeftCorner<A, A>(),
                ss = wl * hz.template bottomRightCorner<A, A>();
    for (int i = 0; i <= m; ++i) {
      const double v = table_.value(g, i), s = inverse * table_.slope(g, i);
      of_value[i] = v * qq + s * qs;
      of_slope[i] = v * sq + s * ss;
      for (int j = 0; j <= i; ++j) pairs[i][j] += v * of_value[j] + s * of_slope[j];
      forces[i] -= (wl * v) * dd;
      by_length[i] += (w * v) * value_by_length + (w * s) * slope_by_length;
      ambient[i] += (wl * v) * gz.template head<A>() + (wl * s) * gz.template tail<A>();
    }
    k.template block<1, P>(length, columns) -= w * d.transpose();
    k(length, length) -= w / at.length * slope.dot(slope_by_length);
  }
  std::array<Eigen::Matrix<double, A, D>, max_points> basis;
  for (int i = 0; i <= m; ++i) {
    const int c = column(i);
    basis[i] = density_.basis(q.col(i));
    k.template block<P, D>(columns, c) = forces[i] * basis[i];
    k.template block<1, D>(length, c) = by_length[i].transpose() * basis[i];
    for (int j = 0; j <= i; ++j) {
      const Eigen::Matrix<double, D, D> block = basis[i].transpose() * (pairs[i][j] * basis[j]);
      if (c >= column(j))
        k.template block<D, D>(c, column(j)) = block;
      else
        k.template block<D, D>(column(j), c) = block.transpose();
    }
    const double radial = density_.radial(q.col(i), ambient[i]);
    for (int j = 0; j < D; ++j) k(c + j, c + j) += radial;
  }
}

/// With ζ = (q, q', n(s)) at a Gauss point, a function of the nodes, n and ℓ, its share of the action is S = w ℓ L(ζ):
/// S'' = w ℓ ζ'ᵀ L'' ζ' + w ℓ L'·ζ'' + the derivatives of w ℓ, where ζ'' is that of q' = q_σ/(h ℓ) alone.
template <class Density>
void CollocationArc<Density>::stretched_hessian(const Nodes& q, const ArcPoint& at, int element,
                                                Eigen::MatrixXd& k) const requires(stretches) {
  constexpr int most = A * max_points + P + 1, Z = 2 * A + P;
  const int m = stages(), n_at = A * (m + 1), l_at = n_at + P;
  const double h = mesh_[element + 1] - mesh_[element], inverse = 1.0 / (h * at.length);
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, most, most> all(l_at + 1, l_at + 1);
  Eigen::Matrix<double, Z, Eigen::Dynamic, 0, Z, most> motion(Z, l_at + 1), bent(Z, l_at + 1);
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, most, 1> forces(n_at);  // S' with the nodes
  all.setZero(), forces.setZero();
  Ambient value, slope;
  Eigen::Matrix<double, 2 * A, 1> gz;
  Eigen::Matrix<double, 2 * A, 2 * A> hz;
  Force d;
  Eigen::Matrix<double, P, 2 * A> d_z;
  Eigen::Matrix<double, P, P> d_n;
  Eigen::Matrix<double, Z, Z> second;
  for (int g = 0; g < m; ++g) {
    evaluate(table_, q, g, inverse, value, slope);
    density_.second(value, slope, force_there(at, element, g), at.compliance, gz, hz, d, d_z, d_n);
    const double w = h * table_.weight(g), wl = w * at.length;
    second << hz, -d_z.transpose(), -d_z, -d_n;
    motion.setZero();
    for (int i = 0; i <= m; ++i)
      for (int c = 0; c < A; ++c) {
        motion(c, A * i + c) = table_.value(g, i);
        motion(A + c, A * i + c) = inverse * table_.slope(g, i);
      }
    motion.template block<P, P>(2 * A, n_at).setIdentity();
    motion.template block<A, 1>(A, l_at) = -slope / at.length;
    if (at.weight)
      motion.template block<P, 1>(2 * A, l_at) =
          -along(at, element, g) / at.length * Eigen::Map<const Force>(at.weight);
    bent.noalias() = wl * second * motion;
    all.noalias() += motion.transpose() * bent;
    for (int i = 0; i <= m; ++i) {
      const double v = table_.value(g, i), s = inverse * table_.slope(g, i);
      all.col(l_at).template segment<A>(A * i) += w * v * gz.template head<A>();
      forces.template segment<A>(A * i) += wl * (v * gz.template head<A>() + s * gz.template tail<A>());
    }
    all.col(l_at).template segment<P>(n_at) -= w * d;
    all(l_at, l_at) -= 2.0 * w * d.dot(motion.template block<P, 1>(2 * A, l_at));
  }
  const int columns = inner() + 2 * D, length = inner() + E - 1;
  std::array<Eigen::Matrix<double, A, D>, max_points> basis;
  k.template block<P, P>(columns, columns) = all.template block<P, P>(n_at, n_at);
  k.template block<1, P>(length, columns) = all.col(l_at).template segment<P>(n_at).transpose();
  k(length, length) = all(l_at, l_at);
  for (int i = 0; i <= m; ++i) {
    const int c = column(i);
    basis[i] = density_.basis(q.col(i));
    k.template block<P, D>(columns, c) = all.template block<P, A>(n_at, A * i) * basis[i];
    k.template block<1, D>(length, c) = all.col(l_at).template segment<A>(A * i).transpose() * basis[i];
    for (int j = 0; j <= i; ++j) {
      const Eigen::Matrix<double, D, D> block =
          basis[i].transpose() * (all.template block<A, A>(A * i, A * j) * basis[j]);
      if (c >= column(j))
        k.template block<D, D>(c, column(j)) = block;
      else
        k.template block<D, D>(column(j), c) = block.transpose();
    }
    const double radial = density_.radial(q.col(i), forces.template segment<A>(A * i));
    for (int j = 0; j < D; ++j) k(c + j, c + j) += radial;
  }
}

template <class Density>
void CollocationArc<Density>::scalar_hessian(const Nodes& q, const ArcPoint& at, int element,
                                             Eigen::MatrixXd& k) const requires(A == 1 && !stretches) {
  const int m = stages(), first = inner() + 2 * D, length = inner() + E - 1;
  const double h = mesh_[element + 1] - mesh_[element], inverse = 1.0 / (h * at.length);
  const Eigen::Map<const Force> n(at.n);
  using Row = PaddedTable::Row;
  const PaddedTable& table = PaddedTable::get(m);
  const Row nodes = PaddedTable::pad(q);
  std::array<Row, max_points> pairs;  // second derivatives, a column for each Lagrange point
  std::array<Row, P + 1> forces;      // and those with n and ℓ
  for (int j = 0; j <= m; ++j) pairs[j].setZero();
  for (Row& row : forces) row.setZero();
  Ambient value, slope;
  Eigen::Matrix<double, 2 * A, 1> gz;
  Eigen::Matrix<double, 2 * A, 2 * A> hz;
  Force d;
  Eigen::Matrix<double, P, A> dd;
  k.setZero();
  for (int g = 0; g < m; ++g) {
    const Row &v = table.value[g], s = inverse * table.slope[g];
    value(0) = (v * nodes).sum(), slope(0) = (s * nodes).sum();
    density_.second(value, slope, n, gz, hz, d, dd);
    const double w = h * table_.weight(g), wl = w * at.length;
    for (int j = 0; j <= m; ++j)
      pairs[j] +=
          (wl * (hz(0, 0) * v(j) + hz(0, 1) * s(j))) * v + (wl * (hz(1, 0) * v(j) + hz(1, 1) * s(j))) * s;
    for (int c = 0; c < P; ++c) forces[c] -= (wl * dd(c)) * v;
    forces[P] += (w * (gz(0) - hz(0, 1) * slope(0))) * v - (w * hz(1, 1) * slope(0)) * s;
    k.template block<1, P>(length, first) -= w * d.transpose();
    k(length, length) += w / at.length * slope(0) * hz(1, 1) * slope(0);
  }
  for (int j = 0; j <= m; ++j) {
    for (int c = 0; c <= P; ++c) k(first + c, column(j)) = forces[c](j);
    for (int i = 0; i <= m; ++i)
      if (column(i) >= column(j)) k(column(i), column(j)) = pairs[j](i);
  }
}

template <class Density>
void CollocationArc<Density>::hold_node(Eigen::MatrixXd& block, double parts) {
  constexpr double cancelled = 1e-4;  // digits that a pivot may lose: 4 of 16
  using Square = Eigen::Matrix<double, D, D>;
  const Square pivot = Square(block.template topLeftCorner<D, D>()).template selfadjointView<Eigen::Lower>();
  const Eigen::SelfAdjointEigenSolver<Square> eigen(pivot);
  for (int k = 0; k < D; ++k) {
    if (std::abs(eigen.eigenvalues()(k)) > cancelled * parts) continue;
    Held& held = held_[held_count_++];
    held.first = interior_tangent() - stages() * D;
    held.direction = std::sqrt(parts) * eigen.eigenvectors().col(k);
    block.template topLeftCorner<D, D>() += held.direction * held.direction.transpose();
  }
}

template <class Density>
void CollocationArc<Density>::factor(const ArcPoint& at, EndsMatrix& condensed) {
  constexpr int F = P + 1;  // n and ℓ
  negative_ = 0;
  held_count_ = 0;
  Nodes q;
  Eigen::Matrix<double, E, E> carry, s;  // on (first node, current node, n, ℓ), lower triangles
  for (int e = 0; e < elements(); ++e) {
    gather(at, e, q);
    element_hessian(q, at, e, element_);
    element_factors_[e].factor(element_);
    negative_ += element_factors_[e].negative_pivots();
    s = element_.template bottomRightCorner<E, E>();  // on (left, right, n, ℓ)
    if (e == 0) {
      carry = s;
      continue;
    }
    // Eliminate the node shared with the previous elements: order (shared, first, right, n, ℓ).
    auto& node = node_;
    node.setZero();
    node.template block<D, D>(0, 0) = carry.template block<D, D>(D, D) + s.template block<D, D>(0, 0);
    node.template block<D, D>(D, 0) = carry.template block<D, D>(D, 0).transpose();
    node.template block<D, D>(2 * D, 0) = s.template block<D, D>(D, 0);
    node.template block<F, D>(3 * D, 0) =
        carry.template block<F, D>(2 * D, D) + s.template block<F, D>(2 * D, 0);
    node.template block<D, D>(D, D) = carry.template block<D, D>(0, 0);
    node.template block<F, D>(3 * D, D) = carry.template block<F, D>(2 * D, 0);
    node.template block<D, D>(2 * D, 2 * D) = s.template block<D, D>(D, D);
    node.template block<F, D>(3 * D, 2 * D) = s.template block<F, D>(2 * D, D);
    node.template block<F, F>(3 * D, 3 * D) =
        carry.template block<F, F>(2 * D, 2 * D) + s.template block<F, F>(2 * D, 2 * D);
    if (e + 1 == elements())
      hold_node(node, carry.template block<D, D>(D, D).diagonal().cwiseAbs().maxCoeff() +
                          s.template block<D, D>(0, 0).diagonal().cwiseAbs().maxCoeff());
    node_factors_[e - 1].factor(node);
    negative_ += node_factors_[e - 1].negative_pivots();
    carry = node.template bottomRightCorner<E, E>();
  }
  condensed = carry.template selfadjointView<Eigen::Lower>();
}

template <class Density>
void CollocationArc<Density>::reduce(double* rhs, EndsVector& ends) const {
  using NodeMap = Eigen::Map<Eigen::Matrix<double, D, 1>>;
  const int m = stages();
  Eigen::Matrix<double, E, 1> g;
  const auto distribute = [&](int left, int right) {  // shares of an elimination to its left and right node
    if (left == 0)
      ends.template head<D>() += g.template head<D>();
    else
      NodeMap(rhs + (left * m - 1) * D) += g.template head<D>();
    if (right == elements())
      ends.template segment<D>(D) += g.template segment<D>(D);
    else
      NodeMap(rhs + (right * m - 1) * D) += g.template segment<D>(D);
    ends.template tail<P + 1>() += g.template tail<P + 1>();
  };
  for (int e = 0; e < elements(); ++e) {
    g.setZero();
    element_factors_[e].reduce(rhs + e * m * D, g.data());
    distribute(e, e + 1);
  }
  for (int e = 1; e < elements(); ++e) {
    g.setZero();
    node_factors_[e - 1].reduce(rhs + (e * m - 1) * D, g.data());
    distribute(0, e + 1);
  }
}

template <class Density>
void CollocationArc<Density>::expand(double* x, const EndsVector& ends) const {
  using NodeMap = Eigen::Map<Eigen::Matrix<double, D, 1>>;
  const int m = stages();
  Eigen::Matrix<double, E, 1> y = ends;
  for (int e = elements() - 1; e >= 1; --e) {
    if (e + 1 < elements()) y.template segment<D>(D) = NodeMap(x + ((e + 1) * m - 1) * D);
    node_factors_[e - 1].expand(x + (e * m - 1) * D, y.data());
  }
  for (int e = 0; e < elements(); ++e) {
    y = ends;
    if (e > 0) y.template head<D>() = NodeMap(x + (e * m - 1) * D);
    if (e + 1 < elements()) y.template segment<D>(D) = NodeMap(x + ((e + 1) * m - 1) * D);
    element_factors_[e].expand(x + e * m * D, y.data());
  }
}

template <class Density>
int CollocationArc<Density>::place(int element, int column) const {
  const int interior = interior_tangent(), in = inner(), m = stages();
  if (column >= in + 2 * D) return interior + 2 * D + column - (in + 2 * D);
  const bool left = column >= in && column < in + D, right = column >= in + D;
  const int point = element * m + (left ? 0 : right ? m : column / D + 1);
  const int part = left || right ? (column - in) % D : column % D;
  if (point == 0) return interior + part;
  if (point == elements() * m) return interior + D + part;
  return (point - 1) * D + part;
}

template <class Density>
void CollocationArc<Density>::hessian(const ArcPoint& at,
                                      std::vector<Eigen::Triplet<double>>& entries) const {
  Nodes q;
  for (int e = 0; e < elements(); ++e) {
    gather(at, e, q);
    element_hessian(q, at, e, element_);
    for (int i = 0; i < element_.rows(); ++i)
      for (int j = 0; j <= i; ++j) {
        if (element_(i, j) == 0.0) continue;
        const int row = place(e, i), col = place(e, j);
        entries.emplace_back(row, col, element_(i, j));
        if (i != j) entries.emplace_back(col, row, element_(i, j));
      }
  }
}

template <class Density>
Eigen::VectorXd CollocationArc<Density>::metric(const ArcPoint& at) const {
  const Eigen::VectorXd lumped = table_.value.transpose() * table_.weight;
  Eigen::VectorXd mass = Eigen::VectorXd::Zero(interior_tangent() + E);
  for (int e = 0; e < elements(); ++e)
    for (int i = 0; i <= stages(); ++i)
      for (int j = 0; j < D; ++j)
        mass(place(e, column(i) + j)) +=
            Density::metric_scale * lumped(i) * at.length * (mesh_[e + 1] - mesh_[e]);
  return mass;
}

template <class Density>
ArcSamples CollocationArc<Density>::sample(const ArcPoint& at) const {
  const int m = stages(), count = elements() * m + 1;
  ArcSamples out{Eigen::VectorXd(count),
                 Eigen::MatrixXd(A, count),
                 Eigen::MatrixXd(D, count),
                 Eigen::MatrixXd::Zero(P, count),
                 {}};
  out.slope.resize(D, count);
  Force base = Force::Zero();
  Nodes q, g;
  Ambient value, slope;
  Eigen::Matrix<double, 2 * A, 1> gz;
  Force d;
  for (int e = 0; e < elements(); ++e) {
    const double h = mesh_[e + 1] - mesh_[e];
    gather(at, e, q);
    Force g_n = Force::Zero();
    double g_length = 0.0;
    element_gradient(q, at, e, g, g_n, g_length);
    Eigen::MatrixXd directions(P, m), loads(A, m);
    for (int j = 0; j < m; ++j) {
      evaluate(table_, q, j, 1.0 / (h * at.length), value, slope);
      if constexpr (A == D || stretches) {
        first(value, slope, force_there(at, e, j), at, gz, d);
        loads.col(j) = gz.template head<A>();
      } else {
        d = density_.direction(value);
      }
      directions.col(j) = d;
    }
    const Eigen::MatrixXd integral = h * at.length * table_.integral.transpose();
    const Eigen::MatrixXd moved = directions * integral;
    // The momentum follows from what the element gains of it, more exactly than from the polynomial's slope.
    Eigen::MatrixXd gained;
    if constexpr (A == D) gained = loads * integral;
    for (int i = 0; i <= m; ++i) {
      const int k = e * m + i;
      out.sigma(k) = mesh_[e] + h * table_.lobatto(i);
      out.q.col(k) = q.col(i);
      out.displacement.col(k) = base + moved.col(i);
      slope = q * table_.end_slope.row(i).transpose() / (h * at.length);
      if constexpr (A == D) {
        out.momentum.col(k) = gained.col(i) - g.col(0);
      } else {
        first(q.col(i), slope, Eigen::Map<const Force>(at.n), at, gz, d);  // ∂L/∂q' of a free rod knows no n
        out.momentum.col(k) = density_.basis(q.col(i)).transpose() * gz.template tail<A>();
      }
      out.slope.col(k) = density_.basis(q.col(i)).transpose() * slope;
    }
    out.momentum.col(e * m) = -density_.basis(q.col(0)).transpose() * g.col(0);
    out.momentum.col(e * m + m) = density_.basis(q.col(m)).transpose() * g.col(m);
    base -= g_n;  // ∂S/∂n of the element = −∫ d ds
    out.displacement.col(e * m + m) = base;
    out.nodes.push_back(e * m);
  }
  out.nodes.push_back(count - 1);
  return out;
}

template <class Density>
double CollocationArc<Density>::energy(const ArcPoint& at) const {
  double sum = 0.0;
  Nodes q;
  Ambient value, slope;
  for (int e = 0; e < elements(); ++e) {
    const double h = mesh_[e + 1] - mesh_[e];
    gather(at, e, q);
    for (int g = 0; g < stages(); ++g) {
      evaluate(table_, q, g, 1.0 / (h * at.length), value, slope);
      double density = 0.0;
      if constexpr (stretches)
        density = density_.elastic(value, slope, force_there(at, e, g), at.compliance);
      else
        density = density_.elastic(value, slope);
      sum += h * at.length * table_.weight(g) * density;
    }
  }
  return sum;
}

template <class Density>
std::vector<double> CollocationArc<Density>::resolution(const ArcPoint& at) const {
  std::vector<double> sizes;
  Nodes q;
  for (int e = 0; e < elements(); ++e) {
    gather(at, e, q);
    sizes.push_back((q * table_.highest.transpose()).cwiseAbs().maxCoeff());
  }
  return sizes;
}

template <class Density>
std::unique_ptr<Arc> CollocationArc<Density>::remeshed(const std::vector<double>& mesh, int stages) const {
  return make_collocation_arc<Density>(density_, mesh, stages);
}

template <class Density>
Eigen::VectorXd CollocationArc<Density>::transfer(const ArcPoint& at, const Arc& target) const {
  const std::vector<double> mesh = target.mesh();
  const int fine = target.stages();
  const Eigen::VectorXd points = CollocationTable::get(fine).lobatto;
  Eigen::VectorXd out(target.interior_ambient());
  Nodes q;
  int e = 0, gathered = -1;
  const bool same =
      mesh == mesh_;  // the error estimate: only the stages differ, so that every element is alike
  Eigen::MatrixXd basis(stages() + 1, fine);
  if (same)
    for (int i = 0; i < fine; ++i) basis.col(i) = lagrange_basis(table_.lobatto, points(i));
  for (int k = 1; k <= target.interior_nodes(); ++k) {
    const int t = k / fine;
    const double sigma = mesh[t] + (mesh[t + 1] - mesh[t]) * points(k % fine);
    if (same)
      e = t;
    else
      while (e + 1 < elements() && sigma > mesh_[e + 1]) ++e;
    if (e != gathered) gather(at, gathered = e, q);
    const double x = (sigma - mesh_[e]) / (mesh_[e + 1] - mesh_[e]);
    const Ambient value =
        same ? Ambient(q * basis.col(k % fine)) : Ambient(q * lagrange_basis(table_.lobatto, x));
    out.template segment<A>((k - 1) * A) = density_.normalised(value);
  }
  return out;
}

}  // namespace windlass::bvp
