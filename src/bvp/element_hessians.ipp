// Second derivatives of one element's share of the action: part of collocation_arc.ipp.
#pragma once

#include "windlass/bvp/collocation_arc.hpp"

namespace windlass::bvp {

template <class Configuration, int P>
void CollocationArc<Configuration, P>::element_hessian(const Nodes& q, const ArcPoint& at, int element,
                                                       Eigen::MatrixXd& k) const {
  if constexpr (A == 1)
    if (!density_->stretches()) return scalar_hessian(q, at, element, k);
  vector_hessian(q, at, element, k);
}

/// With ζ = (q, q', n) at a Gauss point, a function of the nodes, n and ℓ, its share of the action is S = w ℓ L(ζ). As
/// q' = q_σ/(h ℓ), ∂ζ/∂ℓ = (0, −q'/ℓ, n_ℓ), where n_ℓ = −(s/ℓ) w of a force that falls. Terms in d_slope, d_n and n_ℓ are
/// those of a rod that stretches.
template <class Configuration, int P>
void CollocationArc<Configuration, P>::vector_hessian(const Nodes& q, const ArcPoint& at, int element,
                                                      Eigen::MatrixXd& k) const {
  const int m = stages(), columns = inner() + 2 * D, length = inner() + E - 1;
  const double h = mesh_[element + 1] - mesh_[element], inverse = 1.0 / (h * at.length);
  const bool stretches = density_->stretches();
  // Sums over the Gauss points in ambient coordinates, a Lagrange point or a pair of them each; projected at the end.
  using Block = Eigen::Matrix<double, A, A>;
  std::array<std::array<Block, max_sections>, max_sections> pairs;
  std::array<Eigen::Matrix<double, P, A>, max_sections> forces;
  std::array<Ambient, max_sections> ambient, by_length;
  std::array<Block, max_sections> of_value, of_slope;
  for (int i = 0; i <= m; ++i) {
    for (int j = 0; j <= i; ++j) pairs[i][j].setZero();
    forces[i].setZero(), ambient[i].setZero(), by_length[i].setZero();
  }
  k.bottomRows(P + 1).setZero();
  Sections<A, P> sections;
  Seconds second;
  gauss_sections(q, at, element, sections);
  density_->second(sections, second.data());
  for (int g = 0; g < m; ++g) {
    const auto& [gz, hz, d, d_q, d_slope, d_n] = second[g];
    const Ambient slope = sections.slope.col(g);
    const double w = h * table_.weight(g), wl = w * at.length;
    // Derivatives with the length: q' = q_σ/(h ℓ).
    Ambient value_by_length = gz.template head<A>() - hz.template topRightCorner<A, A>() * slope,
            slope_by_length = -hz.template bottomRightCorner<A, A>() * slope;
    k.template block<1, P>(length, columns) -= w * d.transpose();
    k(length, length) -= w / at.length * slope.dot(slope_by_length);
    if (stretches) {
      Force n_length = Force::Zero();
      if (at.weight) n_length = -along(at, element, g) / at.length * Eigen::Map<const Force>(at.weight);
      value_by_length -= at.length * (d_q.transpose() * n_length);
      slope_by_length -= at.length * (d_slope.transpose() * n_length);
      const Force d_length = d_slope * slope - at.length * (d_n * n_length);  // −ℓ ∂d/∂ℓ
      k.template block<P, P>(columns, columns) -= wl * d_n;
      k.template block<1, P>(length, columns) += w * d_length.transpose();
      k(length, length) += w * n_length.dot(d_length + d_slope * slope - 2.0 * d);
    }
    const Block qq = wl * hz.template topLeftCorner<A, A>(), qs = wl * hz.template topRightCorner<A, A>(),
                sq = wl * hz.template bottomLeftCorner<A, A>(),
                ss = wl * hz.template bottomRightCorner<A, A>();
    for (int i = 0; i <= m; ++i) {
      const double v = table_.value(g, i), s = inverse * table_.slope(g, i);
      of_value[i] = v * qq + s * qs;
      of_slope[i] = v * sq + s * ss;
      for (int j = 0; j <= i; ++j) pairs[i][j] += v * of_value[j] + s * of_slope[j];
      forces[i] -= (wl * v) * d_q;
      if (stretches) forces[i] -= (wl * s) * d_slope;
      by_length[i] += (w * v) * value_by_length + (w * s) * slope_by_length;
      ambient[i] += (wl * v) * gz.template head<A>() + (wl * s) * gz.template tail<A>();
    }
  }
  std::array<Eigen::Matrix<double, A, D>, max_sections> basis;
  for (int i = 0; i <= m; ++i) {
    const int c = column(i);
    basis[i] = Configuration::basis(q.col(i));
    k.template block<P, D>(columns, c) = forces[i] * basis[i];
    k.template block<1, D>(length, c) = by_length[i].transpose() * basis[i];
    for (int j = 0; j <= i; ++j) {
      const Eigen::Matrix<double, D, D> block = basis[i].transpose() * (pairs[i][j] * basis[j]);
      if (c >= column(j))
        k.template block<D, D>(c, column(j)) = block;
      else
        k.template block<D, D>(column(j), c) = block.transpose();
    }
    const double radial = Configuration::radial(q.col(i), ambient[i]);
    for (int j = 0; j < D; ++j) k(c + j, c + j) += radial;
  }
}

template <class Configuration, int P>
void CollocationArc<Configuration, P>::scalar_hessian(const Nodes& q, const ArcPoint& at, int element,
                                                      Eigen::MatrixXd& k) const
    requires(Configuration::ambient == 1) {
  const int m = stages(), first = inner() + 2 * D, length = inner() + E - 1;
  const double h = mesh_[element + 1] - mesh_[element], inverse = 1.0 / (h * at.length);
  using Row = PaddedTable::Row;
  const PaddedTable& table = PaddedTable::get(m);
  std::array<Row, max_sections> pairs;  // second derivatives, a column for each Lagrange point
  std::array<Row, P + 1> forces;        // and those with n and ℓ
  for (int j = 0; j <= m; ++j) pairs[j].setZero();
  for (Row& row : forces) row.setZero();
  Sections<A, P> sections;
  Seconds second;
  gauss_sections(q, at, element, sections);
  density_->second(sections, second.data());
  k.setZero();
  for (int g = 0; g < m; ++g) {
    const Row &v = table.value[g], s = inverse * table.slope[g];
    const auto& [gz, hz, d, d_q, d_slope, d_n] = second[g];
    const double w = h * table_.weight(g), wl = w * at.length, slope = sections.slope(g);
    for (int j = 0; j <= m; ++j)
      pairs[j] +=
          (wl * (hz(0, 0) * v(j) + hz(0, 1) * s(j))) * v + (wl * (hz(1, 0) * v(j) + hz(1, 1) * s(j))) * s;
    for (int c = 0; c < P; ++c) forces[c] -= (wl * d_q(c)) * v;
    forces[P] += (w * (gz(0) - hz(0, 1) * slope)) * v - (w * hz(1, 1) * slope) * s;
    k.template block<1, P>(length, first) -= w * d.transpose();
    k(length, length) += w / at.length * slope * hz(1, 1) * slope;
  }
  for (int j = 0; j <= m; ++j) {
    for (int c = 0; c <= P; ++c) k(first + c, column(j)) = forces[c](j);
    for (int i = 0; i <= m; ++i)
      if (column(i) >= column(j)) k(column(i), column(j)) = pairs[j](i);
  }
}

}  // namespace windlass::bvp
