// Second derivatives of one element's share of the action: part of collocation_arc.ipp.
#pragma once

#include "windlass/bvp/collocation_arc.hpp"

namespace windlass::bvp {

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

}  // namespace windlass::bvp
