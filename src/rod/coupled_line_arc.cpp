#include "windlass/rod/coupled_line_arc.hpp"

#include <algorithm>
#include <cmath>

#include "windlass/bvp/collocation_arc.hpp"

namespace windlass::rod {

using bvp::ArcPoint;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

CoupledLineArc::CoupledLineArc(const SurfaceDensity& rod, const std::vector<double>& mesh, int stages)
    : rod_(rod),
      still_(bvp::make_collocation_arc(rod, mesh, stages)),
      mesh_(mesh),
      table_(bvp::CollocationTable::get(stages)),
      stage_(bvp::gauss_stages(table_)),
      at_start_(bvp::lagrange_basis(table_.gauss, 0.0)),
      at_end_(bvp::lagrange_basis(table_.gauss, 1.0)),
      rate_(stages, stages) {
  for (int k = 0; k < stages; ++k) rate_.col(k) = bvp::lagrange_slopes(table_.gauss, table_.gauss(k));
}

const double* CoupledLineArc::node(const ArcPoint& at, int k) const {
  if (k == 0) return at.q_a;
  if (k == points()) return at.q_b;
  return at.interior + (k - 1) * 2;
}

int CoupledLineArc::place(int k, int j) const {
  if (k == 0) return interior_tangent() + j;
  if (k == points()) return interior_tangent() + 3 + j;
  return (k - 1) * 2 + j;
}

double CoupledLineArc::share(int g, int k) const {
  const int m = stages(), e = k / m;
  const double part = mesh_[e + 1] - mesh_[e];
  if (g == points() || g / m > e) return part * table_.weight(k % m);
  return g / m == e ? part * stage_(g % m, k % m) : 0.0;
}

void CoupledLineArc::place_points(const ArcPoint& at, State& out) const {
  const int m = stages(), count = points();
  out.q.setZero(2, count), out.slope.setZero(2, count);
  for (int k = 0; k < count; ++k) {
    const int e = k / m;
    for (int i = 0; i <= m; ++i) {
      const Eigen::Map<const Vector2d> here(node(at, e * m + i));
      out.q.col(k) += table_.value(k % m, i) * here;
      out.slope.col(k) += table_.slope(k % m, i) / step(at, e) * here;
    }
  }
  out.p.setZero(count);
  out.n = Eigen::Map<const Vector2d>(at.n).replicate(1, count);
}

void CoupledLineArc::look(const ArcPoint& at, State& out) const {
  const int m = stages(), count = points();
  out.at.resize(count);
  for (int k = 0; k < count; ++k)
    out.at[k] = LayeredSection::at(rod_, friction(at), out.q(0, k), out.slope.col(k), out.n.col(k));
  out.tilt.assign(elements() + 1, 0.0);
  for (int e = 0; e <= elements(); ++e) {
    double stretch = 0.0;  // of the elements that meet there
    const int sides = e > 0 && e < elements() ? 2 : 1;
    for (int g = 0; g < m; ++g) {
      if (e > 0) stretch += at_end_(g) * out.at[(e - 1) * m + g].stretch.value / sides;
      if (e < elements()) stretch += at_start_(g) * out.at[e * m + g].stretch.value / sides;
    }
    const double psi = node(at, e * m)[0], c = std::cos(psi), speed = at.travel * stretch;
    const double along =
        (std::sin(psi) - speed) / std::sqrt(1.0 - 2.0 * speed * std::sin(psi) + speed * speed);
    out.tilt[e] = at.friction * along * (at.arm + at.compliance * rod_.bending_stiffness * c * c);
  }
}

Eigen::Matrix2Xd CoupledLineArc::dragged_force(const ArcPoint& at, const State& state) const {
  const int count = points();
  Eigen::Matrix2Xd n = Eigen::Map<const Vector2d>(at.n).replicate(1, count + 1);
  for (int k = 0; k < count; ++k) {
    const Vector2d drag(state.at[k].drag[0].value, state.at[k].drag[1].value);
    for (int g = k - k % stages(); g <= count; ++g) n.col(g) -= at.length * share(g, k) * state.p(k) * drag;
  }
  return n;
}

double CoupledLineArc::improve(const ArcPoint& at, State& out) const {
  const int m = stages(), count = points();
  look(at, out);
  // Forms in p; in the last column what is off.
  Rows rhs = Rows::Zero(2 * (count + 1), count + 1);
  const Eigen::Matrix2Xd dragged = dragged_force(at, out);
  for (int g = 0; g <= count; ++g) {
    for (int k = 0; k < count; ++k)
      for (int i = 0; i < 2; ++i) rhs(2 * g + i, k) = -at.length * share(g, k) * out.at[k].drag[i].value;
    if (g < count) rhs.block<2, 1>(2 * g, count) = dragged.col(g) - out.n.col(g);
  }
  const Rows n = respond(at, out, rhs);
  Rows carried(count, count + 1), sources(count, count + 1);
  for (int j = 0; j < count; ++j) {
    const LayeredSection& x = out.at[j];
    const double weight = step(at, j / m) * table_.weight(j % m), p = out.p(j);
    const auto by_n = [&](const LayeredSection::Number& number) {
      return number.by.segment<2>(LayeredSection::around).transpose() * n.middleRows<2>(2 * j);
    };
    carried.row(j) = p * by_n(x.lever);
    carried(j, j) += x.lever.value, carried(j, count) += x.lever.value * p;
    sources.row(j) = -weight * (p * by_n(x.share) + by_n(x.pressure));
    sources(j, j) += weight * (1.0 - x.share.value);
    sources(j, count) += weight * ((1.0 - x.share.value) * p - x.pressure.value);
  }
  Rows flux = upwind(out, carried);
  if (flows_in_at_start(out)) flux(0, count) = -at.q_a[2];
  if (flows_in_at_end(out)) flux(elements(), count) = at.q_b[2];
  const Rows all = pressure_rows(carried, sources, flux);
  out.system.compute(all.leftCols(count));
  const VectorXd by = -out.system.solve(all.col(count));
  out.n_by_p = n.leftCols(count);
  const VectorXd moved = out.n_by_p * by + n.col(count);
  out.p += by;
  for (int g = 0; g < count; ++g) out.n.col(g) += moved.segment<2>(2 * g);
  return std::max(by.lpNorm<Eigen::Infinity>(), moved.lpNorm<Eigen::Infinity>());
}

void CoupledLineArc::solve_pressure(const ArcPoint& at, State& out) const {
  constexpr int most = 20;
  constexpr double enough = 1e-9;  // the next step would be its square
  for (int k = 0; k < most; ++k) {
    const double moved = improve(at, out);
    const bool linear = at.compliance == 0.0;
    if (linear || !(moved > enough * (1.0 + out.p.lpNorm<Eigen::Infinity>()))) break;
  }
  look(at, out);
  const Eigen::Matrix2Xd n = dragged_force(at, out);
  out.n_end = n.rightCols<1>();
  Rows carried(points(), 1);
  for (int k = 0; k < points(); ++k) carried(k, 0) = out.at[k].lever.value * out.p(k);
  out.flux = upwind(out, carried);
  if (flows_in_at_start(out)) out.flux(0) = -at.q_a[2];
  if (flows_in_at_end(out)) out.flux(elements()) = at.q_b[2];
}

void CoupledLineArc::add_balance(const ArcPoint& at, State& out) const {
  const int m = stages();
  out.nodal.setZero(2, points() + 1);
  out.displacement.setZero();
  for (int k = 0; k < points(); ++k) {
    const int e = k / m, g = k % m;
    const LayeredSection& x = out.at[k];
    const Vector2d load(x.load.value, -x.across.value * out.p(k)),
        momenta(x.momenta[0].value, x.momenta[1].value);
    const double w = table_.weight(g), h = step(at, e);
    out.displacement += h * w * Vector2d(x.moved[0].value, x.moved[1].value);
    for (int i = 0; i <= m; ++i)
      out.nodal.col(e * m + i) += h * w * table_.value(g, i) * load + w * table_.slope(g, i) * momenta;
  }
}

CoupledLineArc::State CoupledLineArc::evaluate(const ArcPoint& at) const {
  State out;
  place_points(at, out);
  solve_pressure(at, out);
  add_balance(at, out);
  return out;
}

LayeredSection CoupledLineArc::end_section(const ArcPoint& at, const State& state, bool start) const {
  const Vector2d momentum = start ? Vector2d(-state.nodal.col(0)) : Vector2d(state.nodal.rightCols<1>()),
                 n = start ? Vector2d(Eigen::Map<const Vector2d>(at.n)) : state.n_end;
  return LayeredSection::with_momentum(rod_, friction(at), (start ? at.q_a : at.q_b)[0], momentum, n);
}

void CoupledLineArc::gradient(const ArcPoint& at, double* interior, bvp::EndsVector& ends) const {
  const State state = evaluate(at);
  const int last = elements();
  Eigen::Map<VectorXd>(interior, interior_tangent()) =
      Eigen::Map<const VectorXd>(state.nodal.data() + 2, interior_tangent());
  ends.setZero(this->ends());
  ends.segment<2>(0) = state.nodal.leftCols<1>();
  ends.segment<2>(3) = state.nodal.rightCols<1>();
  ends(2) = -end_section(at, state, true).normal.value;
  ends(5) = end_section(at, state, false).normal.value;
  if (!flows_in_at_start(state)) ends(2) += state.flux(0);
  if (!flows_in_at_end(state)) ends(5) -= state.flux(last);
  ends.segment<2>(6) = -state.displacement;
  ends.tail<2>() = state.n_end - Eigen::Map<const Vector2d>(at.n);
}

Eigen::VectorXd CoupledLineArc::metric(const ArcPoint& at) const {
  const int inner = interior_tangent();
  VectorXd mass = VectorXd::Zero(inner + ends());
  const VectorXd still = still_->metric(at);
  mass.head(inner + 2) = still.head(inner + 2);
  mass.segment<2>(inner + 3) = still.segment<2>(inner + 2);
  return mass;
}

std::vector<double> CoupledLineArc::resolution(const ArcPoint& at) const { return still_->resolution(at); }

double CoupledLineArc::energy(const ArcPoint& at) const {
  const State state = evaluate(at);
  double sum = 0.0;
  for (int k = 0; k < points(); ++k)
    sum += step(at, k / stages()) * table_.weight(k % stages()) * state.at[k].stored;
  return sum;
}

std::pair<double, double> CoupledLineArc::layers(const ArcPoint& at) const {
  const State state = evaluate(at);
  return {flows_in_at_start(state) ? -end_section(at, state, true).lever.value : 0.0,
          flows_in_at_end(state) ? end_section(at, state, false).lever.value : 0.0};
}

bvp::ArcSamples CoupledLineArc::sample(const ArcPoint& at) const {
  const int m = stages(), last = elements();
  State state = evaluate(at);
  bvp::ArcSamples out = still_->sample(at);
  const Eigen::Index count = out.sigma.size();
  out.force.resize(2, count), out.pressure.resize(count), out.lever.resize(count);
  for (int k = 0; k < points(); ++k) out.pressed += step(at, k / m) * table_.weight(k % m) * state.p(k);
  // Slopes of the nodes' polynomial are of order M at the Gauss points, and with them p; those by the momentum are more exact.
  // What p adds to the momentum is of the order of the radius: it takes two rounds.
  const Vector2d first = -state.nodal.col(0);
  for (int round = 0; round < 2; ++round) {
    sharpen(at, first, state);
    solve_pressure(at, state);
  }
  MatrixXd to_nodes(m + 1, m);
  for (int i = 0; i <= m; ++i)
    to_nodes.row(i) = bvp::lagrange_basis(table_.gauss, table_.lobatto(i)).transpose();
  Vector2d force = Eigen::Map<const Vector2d>(at.n), momentum = first, moved = Vector2d::Zero();
  for (int e = 0; e < last; ++e) {
    Eigen::Matrix2Xd rates(2, m), directions(2, m);
    for (int g = 0; g < m; ++g) {
      const LayeredSection& x = state.at[e * m + g];
      rates.col(g) = -state.p(e * m + g) * Vector2d(x.drag[0].value, x.drag[1].value);
      directions.col(g) = Vector2d(x.moved[0].value, x.moved[1].value);
    }
    const MatrixXd integral = step(at, e) * table_.integral.transpose();
    out.force.middleCols(e * m, m + 1) = (rates * integral).colwise() + force;
    out.momentum.middleCols(e * m, m + 1) = (loads(state, e) * integral).colwise() + momentum;
    out.displacement.middleCols(e * m, m + 1) = (directions * integral).colwise() + moved;
    out.pressure.segment(e * m, m + 1) = to_nodes * state.p.segment(e * m, m);
    force = out.force.col((e + 1) * m);
    momentum = out.momentum.col((e + 1) * m);
    moved = out.displacement.col((e + 1) * m);
  }
  for (Eigen::Index k = 0; k < count; ++k)
    out.lever(k) =
        LayeredSection::with_momentum(rod_, friction(at), out.q(0, k), out.momentum.col(k), out.force.col(k))
            .lever.value;
  for (int e = 0; e <= last; ++e)  // where elements end p is what flows there
    if (const double w = out.lever(e * m); w != 0.0) out.pressure(e * m) = state.flux(e) / w;
  return out;
}

Eigen::Matrix2Xd CoupledLineArc::loads(const State& state, int element) const {
  Eigen::Matrix2Xd out(2, stages());
  for (int g = 0; g < stages(); ++g) {
    const int k = element * stages() + g;
    out.col(g) << state.at[k].load.value, -state.at[k].across.value * state.p(k);
  }
  return out;
}

void CoupledLineArc::sharpen(const ArcPoint& at, Vector2d momentum, State& state) const {
  const int m = stages();
  for (int e = 0; e < elements(); ++e) {
    const double h = step(at, e);
    const Eigen::Matrix2Xd gained = loads(state, e);
    for (int g = 0; g < m; ++g) {
      const int k = e * m + g;
      const Vector2d here = momentum + h * gained * stage_.row(g).transpose();
      const double psi = state.q(0, k),
                   stretch = LayeredSection::with_momentum(rod_, friction(at), psi, here, state.n.col(k))
                                 .stretch.value;
      state.slope.col(k) << here(0) / rod_.bending_stiffness,
          here(1) / rod_.twisting_stiffness - stretch * std::sin(psi) * std::cos(psi);
    }
    momentum += h * gained * table_.weight;
  }
}

}  // namespace windlass::rod
