// What is read off a solved arc, and its move to another mesh: part of collocation_arc.ipp.
#pragma once

#include "windlass/bvp/collocation_arc.hpp"

namespace windlass::bvp {

template <class Configuration, int P>
Eigen::VectorXd CollocationArc<Configuration, P>::metric(const ArcPoint& at) const {
  const Eigen::VectorXd lumped = table_.value.transpose() * table_.weight;
  Eigen::VectorXd mass = Eigen::VectorXd::Zero(interior_tangent() + E);
  for (int e = 0; e < elements(); ++e)
    for (int i = 0; i <= stages(); ++i)
      for (int j = 0; j < D; ++j)
        mass(place(e, column(i) + j)) +=
            Configuration::metric_scale * lumped(i) * at.length * (mesh_[e + 1] - mesh_[e]);
  return mass;
}

template <class Configuration, int P>
ArcSamples CollocationArc<Configuration, P>::sample(const ArcPoint& at) const {
  const int m = stages(), count = elements() * m + 1;
  ArcSamples out{Eigen::VectorXd(count),
                 Eigen::MatrixXd(A, count),
                 Eigen::MatrixXd(D, count),
                 Eigen::MatrixXd::Zero(P, count),
                 {}};
  out.slope.resize(D, count);
  Force base = Force::Zero();
  Nodes q, g;
  Sections<A, P> sections;
  Firsts first;
  for (int e = 0; e < elements(); ++e) {
    const double h = mesh_[e + 1] - mesh_[e];
    gather(at, e, q);
    Force g_n = Force::Zero();
    double g_length = 0.0;
    gauss_sections(q, at, e, sections);
    density_->first(sections, first.data());
    element_gradient(sections, first, at, e, g, g_n, g_length);
    Eigen::MatrixXd directions(P, m), loads(A, m);
    for (int j = 0; j < m; ++j) {
      loads.col(j) = first[j].gz.template head<A>();
      directions.col(j) = first[j].d;
    }
    const Eigen::MatrixXd integral = h * at.length * table_.integral.transpose();
    const Eigen::MatrixXd moved = directions * integral;
    // The momentum follows from what the element gains of it, more exactly than from the polynomial's slope.
    Eigen::MatrixXd gained;
    if constexpr (A == D) gained = loads * integral;
    sections.q = q;
    sections.slope.resize(A, m + 1);
    sections.slope.noalias() = q.lazyProduct(table_.end_slope.transpose());
    sections.slope /= h * at.length;
    sections.falls = false;  // ∂L/∂q' of a free rod knows no n
    sections.count = m + 1;
    if constexpr (A != D) density_->first(sections, first.data());
    for (int i = 0; i <= m; ++i) {
      const int k = e * m + i;
      out.sigma(k) = mesh_[e] + h * table_.lobatto(i);
      out.q.col(k) = q.col(i);
      out.displacement.col(k) = base + moved.col(i);
      const auto basis = Configuration::basis(q.col(i));
      if constexpr (A == D)
        out.momentum.col(k) = gained.col(i) - g.col(0);
      else
        out.momentum.col(k) = basis.transpose() * first[i].gz.template tail<A>();
      out.slope.col(k) = basis.transpose() * sections.slope.col(i);
    }
    out.momentum.col(e * m) = -Configuration::basis(q.col(0)).transpose() * g.col(0);
    out.momentum.col(e * m + m) = Configuration::basis(q.col(m)).transpose() * g.col(m);
    base -= g_n;  // ∂S/∂n of the element = −∫ d ds
    out.displacement.col(e * m + m) = base;
    out.nodes.push_back(e * m);
  }
  out.nodes.push_back(count - 1);
  return out;
}

template <class Configuration, int P>
double CollocationArc<Configuration, P>::energy(const ArcPoint& at) const {
  double sum = 0.0;
  Nodes q;
  Sections<A, P> sections;
  std::array<double, max_sections> density;
  for (int e = 0; e < elements(); ++e) {
    gather(at, e, q);
    gauss_sections(q, at, e, sections);
    density_->elastic(sections, density.data());
    for (int g = 0; g < stages(); ++g)
      sum += (mesh_[e + 1] - mesh_[e]) * at.length * table_.weight(g) * density[g];
  }
  return sum;
}

template <class Configuration, int P>
std::vector<double> CollocationArc<Configuration, P>::resolution(const ArcPoint& at) const {
  std::vector<double> sizes;
  Nodes q;
  for (int e = 0; e < elements(); ++e) {
    gather(at, e, q);
    sizes.push_back((q * table_.highest.transpose()).cwiseAbs().maxCoeff());
  }
  return sizes;
}

template <class Configuration, int P>
std::unique_ptr<Arc> CollocationArc<Configuration, P>::remeshed(const std::vector<double>& mesh,
                                                                int stages) const {
  return std::make_unique<CollocationArc>(density_, mesh, stages);
}

template <class Configuration, int P>
Eigen::VectorXd CollocationArc<Configuration, P>::transfer(const ArcPoint& at, const Arc& target) const {
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
    out.template segment<A>((k - 1) * A) = Configuration::normalised(value);
  }
  return out;
}

}  // namespace windlass::bvp
