#include "windlass/rod/coupled_line_arc.hpp"

#include <algorithm>
#include <cmath>

#include "windlass/bvp/collocation_arc.hpp"

namespace windlass::rod {

using bvp::ArcPoint;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

namespace {

/// w = r mu d_t and r mu d_b over r mu, with their derivatives.
struct Levers {
  double along, along_psi, along_travel, across, across_psi, across_travel;
};
Levers levers(double psi, const Slip& slip) {
  const Vector2d t(std::cos(psi), std::sin(psi)), b(-t(1), t(0));
  return {t.dot(slip.d), b.dot(slip.d) + t.dot(slip.by_psi),  t.dot(slip.by_travel),
          b.dot(slip.d), -t.dot(slip.d) + b.dot(slip.by_psi), b.dot(slip.by_travel)};
}

}  // namespace

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
  out.q.setZero(2, count), out.slope.setZero(2, count), out.drag.resize(2, count);
  for (VectorXd* v : {&out.lever, &out.lever_psi, &out.lever_travel, &out.across}) v->resize(count);
  out.slips.resize(count);
  for (int k = 0; k < count; ++k) {
    const int e = k / m;
    for (int i = 0; i <= m; ++i) {
      const Eigen::Map<const Vector2d> here(node(at, e * m + i));
      out.q.col(k) += table_.value(k % m, i) * here;
      out.slope.col(k) += table_.slope(k % m, i) / step(at, e) * here;
    }
    out.slips[k] = slip(out.q(0, k), at.travel);
    const Levers of = levers(out.q(0, k), out.slips[k]);
    const double size = at.arm * at.friction;
    out.lever(k) = size * of.along, out.lever_psi(k) = size * of.along_psi;
    out.lever_travel(k) = size * of.along_travel;
    out.across(k) = size * of.across;
    out.drag.col(k) = at.friction * Vector2d((1.0 - at.arm) * out.slips[k].d(0), out.slips[k].d(1));
  }
  out.node_lever.resize(elements() + 1);
  for (int e = 0; e <= elements(); ++e) {
    const double psi = node(at, e * m)[0];
    out.node_lever(e) = at.arm * at.friction * levers(psi, slip(psi, at.travel)).along;
  }
}

CoupledLineArc::Rows CoupledLineArc::fluxes(const State& state) const {
  const int m = stages(), last = elements();
  Rows out = Rows::Zero(last + 1, points());
  for (int e = 0; e <= last; ++e) {
    const double w = state.node_lever(e);
    if ((e == 0 && flows_in_at_start(w)) || (e == last && flows_in_at_end(w))) continue;
    const bool from_right = e == 0 || (e < last && w > 0.0);
    if (from_right)
      out.row(e).segment(e * m, m) = w * at_start_.transpose();
    else
      out.row(e).segment((e - 1) * m, m) = w * at_end_.transpose();
  }
  return out;
}

void CoupledLineArc::solve_pressure(const ArcPoint& at, State& out) const {
  const int m = stages(), count = points(), last = elements();
  const Vector2d n0 = Eigen::Map<const Vector2d>(at.n);
  const Rows flux = fluxes(out);
  VectorXd given = VectorXd::Zero(last + 1);  // what flows in
  if (flows_in_at_start(out.node_lever(0))) given(0) = -at.q_a[2];
  if (flows_in_at_end(out.node_lever(last))) given(last) = at.q_b[2];
  MatrixXd matrix = MatrixXd::Zero(count, count);
  VectorXd rhs(count);
  for (int j = 0; j < count; ++j) {
    const int e = j / m, local = j % m;
    const double weight = step(at, e) * table_.weight(local);
    const LinePressure free = line_pressure(rod_, out.q.col(j), out.slope.col(j), Vector2d::Zero());
    matrix.row(j) += at_end_(local) * flux.row(e + 1) - at_start_(local) * flux.row(e);
    for (int k = 0; k < m; ++k)
      matrix(j, e * m + k) -= table_.weight(k) * rate_(local, k) * out.lever(e * m + k);
    matrix(j, j) -= weight * (1.0 - out.across(j) * out.slope(0, j));
    for (int k = 0; k < (e + 1) * m; ++k)
      matrix(j, k) -= weight * at.length * share(j, k) * free.by_n.dot(out.drag.col(k));
    rhs(j) =
        -weight * (free.p + free.by_n.dot(n0)) - at_end_(local) * given(e + 1) + at_start_(local) * given(e);
  }
  out.system.compute(matrix);
  out.p = out.system.solve(rhs);
  out.flux = flux * out.p + given;
  out.n.resize(2, count);
  out.free.resize(count);
  for (int g = 0; g <= count; ++g) {
    Vector2d n = n0;
    for (int k = 0; k < count; ++k) n -= at.length * share(g, k) * out.p(k) * out.drag.col(k);
    if (g == count) {
      out.n_end = n;
      break;
    }
    out.n.col(g) = n;
    out.free[g] = line_pressure(rod_, out.q.col(g), out.slope.col(g), n);
  }
}

void CoupledLineArc::add_balance(const ArcPoint& at, State& out) const {
  const int m = stages();
  out.nodal.setZero(2, points() + 1);
  out.displacement.setZero();
  Eigen::Vector4d gz;
  Vector2d d;
  for (int k = 0; k < points(); ++k) {
    const int e = k / m, g = k % m;
    rod_.first(out.q.col(k), out.slope.col(k), out.n.col(k), gz, d);
    gz(1) -= out.across(k) * out.p(k);
    const double w = table_.weight(g), h = step(at, e);
    out.displacement += h * w * d;
    for (int i = 0; i <= m; ++i)
      out.nodal.col(e * m + i) +=
          h * w * table_.value(g, i) * gz.head<2>() + w * table_.slope(g, i) * gz.tail<2>();
  }
}

CoupledLineArc::State CoupledLineArc::evaluate(const ArcPoint& at) const {
  State out;
  place_points(at, out);
  solve_pressure(at, out);
  add_balance(at, out);
  return out;
}

void CoupledLineArc::gradient(const ArcPoint& at, double* interior, bvp::EndsVector& ends) const {
  const State state = evaluate(at);
  const int last = elements();
  Eigen::Map<VectorXd>(interior, interior_tangent()) =
      Eigen::Map<const VectorXd>(state.nodal.data() + 2, interior_tangent());
  ends.setZero(this->ends());
  ends.segment<2>(0) = state.nodal.leftCols<1>();
  ends.segment<2>(3) = state.nodal.rightCols<1>();
  if (!flows_in_at_start(state.node_lever(0))) ends(2) = state.flux(0);
  if (!flows_in_at_end(state.node_lever(last))) ends(5) = -state.flux(last);
  ends.segment<2>(6) = -state.displacement;
  ends.tail<2>() = state.n_end - Eigen::Map<const Vector2d>(at.n);
}

Eigen::Matrix<double, 4, Eigen::Dynamic> CoupledLineArc::motion(const ArcPoint& at, const State& state,
                                                                int point) const {
  const int m = stages(), e = point / m, g = point % m;
  const double h = step(at, e);
  Eigen::Matrix<double, 4, Eigen::Dynamic> z(4, interior_tangent() + ends());
  z.setZero();
  for (int i = 0; i <= m; ++i)
    for (int j = 0; j < 2; ++j) {
      const int column = place(e * m + i, j);
      z(j, column) = table_.value(g, i);
      z(2 + j, column) = table_.slope(g, i) / h;
    }
  z.block<2, 1>(2, interior_tangent() + length_end()) = -state.slope.col(point) / at.length;
  return z;
}

CoupledLineArc::Rows CoupledLineArc::pressure_rows(const ArcPoint& at, const State& state,
                                                   const std::vector<Rows>& motions) const {
  const int m = stages(), count = points(), last = elements(), inner = interior_tangent();
  const int length = inner + length_end(), travel = length + 1;
  const double size = at.arm * at.friction;
  Rows out = Rows::Zero(count, inner + ends());
  // Fluxes change with w where elements end, or with the force beyond.
  Rows flux = Rows::Zero(last + 1, out.cols());
  for (int e = 0; e <= last; ++e) {
    const double w = state.node_lever(e), psi = node(at, e * m)[0];
    if (e == 0 && flows_in_at_start(w)) {
      flux(e, inner + 2) = -1.0;
    } else if (e == last && flows_in_at_end(w)) {
      flux(e, inner + 5) = 1.0;
    } else {
      const bool from_right = e == 0 || (e < last && w > 0.0);
      const double p = from_right ? at_start_.dot(state.p.segment(e * m, m))
                                  : at_end_.dot(state.p.segment((e - 1) * m, m));
      const Levers of = levers(psi, slip(psi, at.travel));
      flux(e, place(e * m, 0)) = size * of.along_psi * p;
      flux(e, travel) = size * of.along_travel * p;
    }
  }
  for (int j = 0; j < count; ++j) {
    const int e = j / m, local = j % m;
    const double part = (mesh_[e + 1] - mesh_[e]) * table_.weight(local), weight = part * at.length;
    out.row(j) += at_end_(local) * flux.row(e + 1) - at_start_(local) * flux.row(e);
    for (int k = 0; k < m; ++k) {
      const int point = e * m + k;
      const double each = table_.weight(k) * rate_(local, k) * state.p(point);
      out.row(j) -= each * state.lever_psi(point) * motions[point].row(0);
      out(j, travel) -= each * state.lever_travel(point);
    }
    const Levers of = levers(state.q(0, j), state.slips[j]);
    const Rows& z = motions[j];
    out.row(j) +=
        weight *
        (state.p(j) * (size * of.across_psi * state.slope(0, j) * z.row(0) + state.across(j) * z.row(2)) +
         state.free[j].by_z.transpose() * z);
    out(j, travel) += weight * state.p(j) * size * of.across_travel * state.slope(0, j);
    out(j, length) -= part * (state.p(j) * (1.0 - state.across(j) * state.slope(0, j)) - state.free[j].p);
  }
  return out;
}

CoupledLineArc::Rows CoupledLineArc::force_rows(const ArcPoint& at, const std::vector<Rows>& dragged) const {
  const int m = stages(), count = points(), inner = interior_tangent();
  Rows out = Rows::Zero(2 * (count + 1), inner + ends()), begin = Rows::Zero(2, inner + ends());
  begin.block<2, 2>(0, inner + 6).setIdentity();
  for (int e = 0; e < elements(); ++e) {
    const double h = step(at, e);
    for (int g = 0; g < m; ++g) {
      auto here = out.middleRows<2>(2 * (e * m + g));
      here = begin;
      for (int k = 0; k < m; ++k) here -= h * stage_(g, k) * dragged[e * m + k];
    }
    for (int k = 0; k < m; ++k) begin -= h * table_.weight(k) * dragged[e * m + k];
  }
  out.bottomRows<2>() = begin;
  return out;
}

void CoupledLineArc::linearise(const ArcPoint& at) const {
  const State state = evaluate(at);
  const int m = stages(), count = points(), last = elements(), inner = interior_tangent();
  const int length = inner + length_end(), travel = length + 1;
  std::vector<Rows> motions(count);
  for (int k = 0; k < count; ++k) motions[k] = motion(at, state, k);
  // Of what p drags a length, p as it is; then with its change.
  const Vector2d parts(at.friction * (1.0 - at.arm), at.friction);
  std::vector<Rows> dragged(count);
  for (int k = 0; k < count; ++k) {
    dragged[k] = state.p(k) * parts.cwiseProduct(state.slips[k].by_psi) * motions[k].row(0);
    dragged[k].col(travel) += state.p(k) * parts.cwiseProduct(state.slips[k].by_travel);
    dragged[k].col(length) += state.p(k) / at.length * state.drag.col(k);
  }
  Rows residual = pressure_rows(at, state, motions);
  const Rows given = force_rows(at, dragged);
  for (int j = 0; j < count; ++j)
    residual.row(j) += step(at, j / m) * table_.weight(j % m) *
                       (state.free[j].by_n.transpose() * given.middleRows<2>(2 * j));
  const Rows p = -state.system.solve(residual);
  for (int k = 0; k < count; ++k) dragged[k] += state.drag.col(k) * p.row(k);
  const Rows n = force_rows(at, dragged);
  balance_rows(at, state, motions, n, p);
  const Rows flux = fluxes(state);
  for (const int e : {0, last}) {
    const double w = state.node_lever(e), psi = node(at, e * m)[0], sign = e == 0 ? 1.0 : -1.0;
    if (e == 0 ? flows_in_at_start(w) : flows_in_at_end(w)) continue;
    const int row = inner + (e == 0 ? 2 : 5);
    const double trace = e == 0 ? at_start_.dot(state.p.head(m)) : at_end_.dot(state.p.tail(m));
    const Levers of = levers(psi, slip(psi, at.travel));
    matrix_.row(row) = sign * flux.row(e) * p;
    matrix_(row, place(e * m, 0)) += sign * at.arm * at.friction * of.along_psi * trace;
    matrix_(row, travel) += sign * at.arm * at.friction * of.along_travel * trace;
  }
}

void CoupledLineArc::balance_rows(const ArcPoint& at, const State& state, const std::vector<Rows>& motions,
                                  const Rows& n, const Rows& p) const {
  const int m = stages(), inner = interior_tangent(), length = inner + length_end(), travel = length + 1;
  Rows all = Rows::Zero(inner + ends(), inner + ends());
  Eigen::Vector4d gz;
  Eigen::Matrix4d hz;
  Vector2d d;
  Eigen::Matrix2d dd;
  for (int k = 0; k < points(); ++k) {
    const int e = k / m, g = k % m;
    const double part = mesh_[e + 1] - mesh_[e], h = part * at.length, w = table_.weight(g);
    rod_.second(state.q.col(k), state.slope.col(k), state.n.col(k), gz, hz, d, dd);
    gz(1) -= state.across(k) * state.p(k);
    const Levers of = levers(state.q(0, k), state.slips[k]);
    const double size = at.arm * at.friction;
    Rows change = hz * motions[k];
    change.topRows<2>() -= dd.transpose() * n.middleRows<2>(2 * k);
    change.row(1) -= state.across(k) * p.row(k) + size * of.across_psi * state.p(k) * motions[k].row(0);
    change(1, travel) -= size * of.across_travel * state.p(k);
    for (int i = 0; i <= m; ++i)
      for (int j = 0; j < 2; ++j) {
        const int row = place(e * m + i, j);
        all.row(row) +=
            h * w * table_.value(g, i) * change.row(j) + w * table_.slope(g, i) * change.row(2 + j);
        all(row, length) += part * w * table_.value(g, i) * gz(j);
      }
    all.middleRows<2>(inner + 6) -= h * w * (dd * motions[k].topRows<2>());
    all.block<2, 1>(inner + 6, length) -= part * w * d;
  }
  all.middleRows<2>(length + 1) = n.bottomRows<2>();
  all.block<2, 2>(length + 1, inner + 6) -= Eigen::Matrix2d::Identity();
  matrix_ = all;
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

std::pair<double, double> CoupledLineArc::layers(const ArcPoint& at) const {
  const auto lever = [&](double psi) {
    return at.arm * at.friction * levers(psi, slip(psi, at.travel)).along;
  };
  return {std::max(-lever(at.q_a[0]), 0.0), std::max(lever(at.q_b[0]), 0.0)};
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
  Vector2d force = Eigen::Map<const Vector2d>(at.n), momentum = first;
  for (int e = 0; e < last; ++e) {
    Eigen::Matrix2Xd rates(2, m);
    for (int g = 0; g < m; ++g) rates.col(g) = -state.p(e * m + g) * state.drag.col(e * m + g);
    const MatrixXd integral = step(at, e) * table_.integral.transpose();
    out.force.middleCols(e * m, m + 1) = (rates * integral).colwise() + force;
    out.momentum.middleCols(e * m, m + 1) = (loads(state, e) * integral).colwise() + momentum;
    out.pressure.segment(e * m, m + 1) = to_nodes * state.p.segment(e * m, m);
    force = out.force.col((e + 1) * m);
    momentum = out.momentum.col((e + 1) * m);
  }
  for (Eigen::Index k = 0; k < count; ++k) {
    const double psi = out.q(0, k);
    out.lever(k) = at.arm * at.friction * levers(psi, slip(psi, at.travel)).along;
  }
  for (int e = 0; e <= last; ++e)  // where elements end p is what flows there
    if (const double w = state.node_lever(e); w != 0.0) out.pressure(e * m) = state.flux(e) / w;
  return out;
}

Eigen::Matrix2Xd CoupledLineArc::loads(const State& state, int element) const {
  const int m = stages();
  Eigen::Matrix2Xd out(2, m);
  Eigen::Vector4d gz;
  Vector2d d;
  for (int g = 0; g < m; ++g) {
    const int k = element * m + g;
    rod_.first(state.q.col(k), state.slope.col(k), state.n.col(k), gz, d);
    out.col(g) = gz.head<2>() - Vector2d(0.0, state.across(k) * state.p(k));
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
      const double psi = state.q(0, k);
      state.slope.col(k) << here(0) / rod_.bending_stiffness,
          here(1) / rod_.twisting_stiffness - std::sin(psi) * std::cos(psi);
    }
    momentum += h * gained * table_.weight;
  }
}

}  // namespace windlass::rod
