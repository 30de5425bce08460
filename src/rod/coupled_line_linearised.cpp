// Derivatives of a line whose pressure has layers.
#include "windlass/rod/coupled_line_arc.hpp"

namespace windlass::rod {

using bvp::ArcPoint;
using Eigen::MatrixXd;
using Eigen::Vector2d;

CoupledLineArc::Rows CoupledLineArc::upwind(const State& state, const Rows& carried) const {
  const int m = stages(), last = elements();
  Rows out = Rows::Zero(last + 1, carried.cols());
  for (int e = 0; e <= last; ++e) {
    if (flows_in(state, e)) continue;
    const bool from_right = e == 0 || (e < last && state.tilt[e] > 0.0);
    if (from_right)
      out.row(e) = at_start_.transpose() * carried.middleRows(e * m, m);
    else
      out.row(e) = at_end_.transpose() * carried.middleRows((e - 1) * m, m);
  }
  return out;
}

CoupledLineArc::Rows CoupledLineArc::pressure_rows(const Rows& carried, const Rows& sources,
                                                   const Rows& flux) const {
  const int m = stages();
  Rows out = -sources;
  for (int j = 0; j < points(); ++j) {
    const int e = j / m, local = j % m;
    out.row(j) += at_end_(local) * flux.row(e + 1) - at_start_(local) * flux.row(e);
    for (int k = 0; k < m; ++k) out.row(j) -= table_.weight(k) * rate_(local, k) * carried.row(e * m + k);
  }
  return out;
}

CoupledLineArc::Rows CoupledLineArc::respond(const ArcPoint& at, const State& state, Rows rhs) const {
  if (at.compliance == 0.0 || at.travel == 0.0) return rhs;  // the direction of slip knows no n
  const int m = stages();
  const auto by_n = [&](int k) {
    Eigen::Matrix2d out;
    for (int i = 0; i < 2; ++i)
      out.row(i) = state.p(k) * state.at[k].drag[i].by.segment<2>(LayeredSection::around).transpose();
    return out;
  };
  Rows carry = Rows::Zero(2, rhs.cols());
  for (int e = 0; e < elements(); ++e) {
    const double h = step(at, e);
    MatrixXd matrix = MatrixXd::Identity(2 * m, 2 * m);
    for (int g = 0; g < m; ++g) {
      rhs.middleRows<2>(2 * (e * m + g)) -= carry;
      for (int k = 0; k < m; ++k) matrix.block<2, 2>(2 * g, 2 * k) += h * stage_(g, k) * by_n(e * m + k);
    }
    auto here = rhs.middleRows(2 * e * m, 2 * m);
    here = matrix.partialPivLu().solve(here).eval();
    for (int k = 0; k < m; ++k) carry += h * table_.weight(k) * by_n(e * m + k) * here.middleRows<2>(2 * k);
  }
  rhs.bottomRows<2>() -= carry;
  return rhs;
}

CoupledLineArc::Rows CoupledLineArc::integrated(const ArcPoint& at, const std::vector<Rows>& rates) const {
  const int m = stages();
  const Eigen::Index columns = rates.front().cols();
  Rows out = Rows::Zero(2 * (points() + 1), columns), begin = Rows::Zero(2, columns);
  for (int e = 0; e < elements(); ++e) {
    const double h = step(at, e);
    for (int g = 0; g < m; ++g) {
      auto here = out.middleRows<2>(2 * (e * m + g));
      here = begin;
      for (int k = 0; k < m; ++k) here += h * stage_(g, k) * rates[e * m + k];
    }
    for (int k = 0; k < m; ++k) begin += h * table_.weight(k) * rates[e * m + k];
  }
  out.bottomRows<2>() = begin;
  return out;
}

CoupledLineArc::Rows CoupledLineArc::motion(const ArcPoint& at, const State& state, int point) const {
  const int m = stages(), e = point / m, g = point % m;
  const double h = step(at, e);
  Rows z = Rows::Zero(own, interior_tangent() + ends());
  for (int i = 0; i <= m; ++i) {
    z(LayeredSection::psi, place(e * m + i, 0)) = table_.value(g, i);
    for (int j = 0; j < 2; ++j) z(LayeredSection::bend + j, place(e * m + i, j)) = table_.slope(g, i) / h;
  }
  z.block<2, 1>(LayeredSection::bend, interior_tangent() + length_end()) =
      -state.slope.col(point) / at.length;
  return z;
}

Eigen::RowVectorXd CoupledLineArc::change(const LayeredSection::Number& number, const Rows& motion,
                                          const Eigen::Ref<const Rows>& n) const {
  Eigen::RowVectorXd out = number.by.head<own>().transpose() * motion;
  out += number.by.segment<2>(LayeredSection::around).transpose() * n;
  out(interior_tangent() + length_end() + 1) += number.by(LayeredSection::travel);
  return out;
}

void CoupledLineArc::linearise(const ArcPoint& at) const {
  const State state = evaluate(at);
  const int m = stages(), count = points(), last = elements(), inner = interior_tangent();
  const int length = inner + length_end(), columns = inner + ends();
  std::vector<Rows> motions(count), dragged(count);
  const Rows nothing = Rows::Zero(2, columns);
  for (int k = 0; k < count; ++k) {
    motions[k] = motion(at, state, k);
    // Of what p drags a length, p and n as they are.
    dragged[k].resize(2, columns);
    for (int i = 0; i < 2; ++i) {
      const LayeredSection::Number& drag = state.at[k].drag[i];
      dragged[k].row(i) = state.p(k) * change(drag, motions[k], nothing);
      dragged[k](i, length) += state.p(k) / at.length * drag.value;
    }
  }
  Rows given = -integrated(at, dragged);
  for (int g = 0; g <= count; ++g) given.block<2, 2>(2 * g, inner + 6) += Eigen::Matrix2d::Identity();
  const Rows kept = respond(at, state, given);  // of n, p as it is
  Rows carried(count, columns), sources(count, columns);
  for (int j = 0; j < count; ++j) {
    const LayeredSection& x = state.at[j];
    const auto here = kept.middleRows<2>(2 * j);
    const double part = (mesh_[j / m + 1] - mesh_[j / m]) * table_.weight(j % m), p = state.p(j);
    carried.row(j) = p * change(x.lever, motions[j], here);
    sources.row(j) =
        -part * at.length * (p * change(x.share, motions[j], here) + change(x.pressure, motions[j], here));
    sources(j, length) += part * ((1.0 - x.share.value) * p - x.pressure.value);
  }
  Rows flux = upwind(state, carried);
  if (flows_in_at_start(state)) flux(0, inner + 2) = -1.0;
  if (flows_in_at_end(state)) flux(last, inner + 5) = 1.0;
  const Rows p = -state.system.solve(pressure_rows(carried, sources, flux));
  const Rows n = kept + state.n_by_p * p;
  for (int j = 0; j < count; ++j)
    carried.row(j) = state.p(j) * change(state.at[j].lever, motions[j], n.middleRows<2>(2 * j)) +
                     state.at[j].lever.value * p.row(j);
  balance_rows(at, state, motions, n, p);
  end_rows(at, state, n, upwind(state, carried));
}

void CoupledLineArc::balance_rows(const ArcPoint& at, const State& state, const std::vector<Rows>& motions,
                                  const Rows& n, const Rows& p) const {
  const int m = stages(), inner = interior_tangent(), length = inner + length_end();
  Rows all = Rows::Zero(inner + ends(), inner + ends());
  for (int k = 0; k < points(); ++k) {
    const int e = k / m, g = k % m;
    const LayeredSection& x = state.at[k];
    const double part = mesh_[e + 1] - mesh_[e], h = part * at.length, w = table_.weight(g);
    const auto changed = [&](const LayeredSection::Number& number) {
      return change(number, motions[k], n.middleRows<2>(2 * k));
    };
    Rows load(2, all.cols()), momenta(2, all.cols());
    load.row(0) = changed(x.load);
    load.row(1) = -x.across.value * p.row(k) - state.p(k) * changed(x.across);
    for (int j = 0; j < 2; ++j) momenta.row(j) = changed(x.momenta[j]);
    load *= h;
    load.col(length) += part * Vector2d(x.load.value, -x.across.value * state.p(k));
    for (int i = 0; i <= m; ++i)
      for (int j = 0; j < 2; ++j)
        all.row(place(e * m + i, j)) +=
            w * (table_.value(g, i) * load.row(j) + table_.slope(g, i) * momenta.row(j));
    for (int j = 0; j < 2; ++j) {
      all.row(inner + 6 + j) -= h * w * changed(x.moved[j]);
      all(inner + 6 + j, length) -= part * w * x.moved[j].value;
    }
  }
  all.middleRows<2>(length + 1) = n.bottomRows<2>();
  all.block<2, 2>(length + 1, inner + 6) -= Eigen::Matrix2d::Identity();
  matrix_ = all;
}

void CoupledLineArc::end_rows(const ArcPoint& at, const State& state, const Rows& n, const Rows& flux) const {
  const int inner = interior_tangent(), columns = inner + ends();
  for (const bool start : {true, false}) {
    const double sign = start ? -1.0 : 1.0;
    const int first = inner + (start ? 0 : 3);
    // Changes of ψ, of ψ' and m₃ by the momentum there, and of n.
    Rows motion = Rows::Zero(own, columns), force = Rows::Zero(2, columns);
    motion(LayeredSection::psi, first) = 1.0;
    motion.row(LayeredSection::bend) = sign / rod_.bending_stiffness * matrix_.row(first);
    motion.row(LayeredSection::twist) = sign * matrix_.row(first + 1);
    if (start)
      force.block<2, 2>(0, inner + 6).setIdentity();
    else
      force = n.bottomRows<2>();
    matrix_.row(first + 2) = sign * change(end_section(at, state, start).normal, motion, force);
    const int at_end = start ? 0 : elements();
    if (!flows_in(state, at_end)) matrix_.row(first + 2) -= sign * flux.row(at_end);
  }
}

}  // namespace windlass::rod
