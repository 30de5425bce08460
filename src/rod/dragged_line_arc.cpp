#include "windlass/rod/dragged_line_arc.hpp"

#include <cmath>

#include "windlass/bvp/collocation_arc.hpp"

namespace windlass::rod {

using bvp::ArcPoint;
using Eigen::MatrixXd;
using Eigen::Vector2d;

Slip slip(double psi, double travel) {
  const double c = std::cos(psi), s = std::sin(psi);
  const double size = std::sqrt(1.0 - 2.0 * travel * s + travel * travel);
  Slip out;
  out.d = Vector2d(-travel * c, 1.0 - travel * s) / size;
  const double by_psi = -travel * c / size, by_travel = (travel - s) / size;  // of the size
  out.by_psi = (Vector2d(travel * s, -travel * c) - by_psi * out.d) / size;
  out.by_travel = (Vector2d(-c, -s) - by_travel * out.d) / size;
  return out;
}

LinePressure line_pressure(const SurfaceDensity& rod, const Vector2d& q, const Vector2d& slope,
                           const Vector2d& n) {
  const double b = rod.bending_stiffness, c = std::cos(q(0)), s = std::sin(q(0)), cos2 = c * c - s * s;
  const double m3 = rod.twisting_stiffness * rod.twist(q, slope), w = slope(0);
  // n_θ, ψ'' and n₁ = ψ' k of rod/line_contact.cpp: p = cos ψ n_θ − ψ'' k + 3B ψ'² cos 2ψ.
  const double around = n(0) - m3 * s - b * c * c * c, k = m3 - 3.0 * b * s * c;
  const double bend = (around * s - n(1) * c + m3 * c * c - b * s * c * c * c) / b;
  LinePressure out;
  out.p = c * around - bend * k + 3.0 * b * w * w * cos2;
  const double around_psi = -m3 * c + 3.0 * b * c * c * s;
  const double bend_psi =
      (around_psi * s + around * c + n(1) * s - 2.0 * m3 * c * s) / b - (c * c * c * c - 3.0 * s * s * c * c);
  const double by_psi =
      -s * around + c * around_psi - bend_psi * k + 3.0 * b * bend * cos2 - 12.0 * b * w * w * s * c;
  const double by_moment = -c * s - bend - k * cos2 / b;
  out.by_z << by_psi + by_moment * rod.twisting_stiffness * cos2, 0.0, 6.0 * b * w * cos2,
      by_moment * rod.twisting_stiffness;
  out.by_n << c - s * k / b, c * k / b;
  return out;
}

DraggedLineArc::DraggedLineArc(const SurfaceDensity& rod, const std::vector<double>& mesh, int stages)
    : rod_(rod),
      still_(bvp::make_collocation_arc(rod, mesh, stages)),
      mesh_(mesh),
      table_(bvp::CollocationTable::get(stages)),
      stage_(bvp::gauss_stages(table_)) {
  const int all = interior_tangent() + ends();
  matrix_.setZero(all, all);
  carry_.setZero(2, all);
  at_stages_.setZero(2 * stages, all);
}

const double* DraggedLineArc::node(const ArcPoint& at, int k) const {
  if (k == 0) return at.q_a;
  if (k == elements() * stages()) return at.q_b;
  return at.interior + (k - 1) * 2;
}

int DraggedLineArc::place(int k, int j) const {
  if (k == 0) return interior_tangent() + j;
  if (k == elements() * stages()) return interior_tangent() + 2 + j;
  return (k - 1) * 2 + j;
}

void DraggedLineArc::evaluate(const ArcPoint& at, int element, const Vector2d& n, Element& out) const {
  const int m = stages();
  const double h = (mesh_[element + 1] - mesh_[element]) * at.length;
  out.nodes.resize(2, m + 1), out.n.resize(2, m), out.rate.resize(2, m);
  for (int i = 0; i <= m; ++i) out.nodes.col(i) = Eigen::Map<const Vector2d>(node(at, element * m + i));
  out.q = out.nodes.lazyProduct(table_.value.transpose());
  out.slope = out.nodes.lazyProduct(table_.slope.transpose()) / h;
  // p is affine in n: the forces at the stages solve a linear system.
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 2 * max_points, 2 * max_points> system(2 * m,
                                                                                                  2 * m);
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 2 * max_points, 1> forces(2 * m);
  system.setIdentity();
  for (int g = 0; g < m; ++g) forces.segment<2>(2 * g) = n;
  for (int k = 0; k < m; ++k) {
    out.slips[k] = slip(out.q(0, k), at.travel);
    const LinePressure free = line_pressure(rod_, out.q.col(k), out.slope.col(k), Vector2d::Zero());
    const Vector2d drag = -at.friction * h * out.slips[k].d;
    for (int g = 0; g < m; ++g) {
      system.block<2, 2>(2 * g, 2 * k) -= stage_(g, k) * drag * free.by_n.transpose();
      forces.segment<2>(2 * g) += stage_(g, k) * free.p * drag;
    }
  }
  forces = system.partialPivLu().solve(forces).eval();
  out.n_end = n;
  for (int k = 0; k < m; ++k) {
    out.n.col(k) = forces.segment<2>(2 * k);
    out.pressure[k] = line_pressure(rod_, out.q.col(k), out.slope.col(k), out.n.col(k));
    out.rate.col(k) = -at.friction * out.pressure[k].p * out.slips[k].d;
    out.n_end += h * table_.weight(k) * out.rate.col(k);
  }
}

void DraggedLineArc::element_gradient(const ArcPoint& at, int element, const Element& state,
                                      Eigen::Matrix<double, 2, Eigen::Dynamic, 0, 2, max_points>& g,
                                      Vector2d& displacement) const {
  const double h = (mesh_[element + 1] - mesh_[element]) * at.length;
  g.setZero(2, stages() + 1);
  Eigen::Vector4d gz;
  Vector2d d;
  for (int k = 0; k < stages(); ++k) {
    rod_.first(state.q.col(k), state.slope.col(k), state.n.col(k), gz, d);
    const double w = table_.weight(k);
    displacement += h * w * d;
    for (int i = 0; i <= stages(); ++i)
      g.col(i) += h * w * table_.value(k, i) * gz.head<2>() + w * table_.slope(k, i) * gz.tail<2>();
  }
}

void DraggedLineArc::gradient(const ArcPoint& at, double* interior, bvp::EndsVector& ends) const {
  ends.setZero(this->ends());
  std::fill_n(interior, interior_tangent(), 0.0);
  const int inner = interior_tangent();
  Element state;
  state.n_end = Eigen::Map<const Vector2d>(at.n);
  Vector2d displacement = Vector2d::Zero();
  Eigen::Matrix<double, 2, Eigen::Dynamic, 0, 2, max_points> g;
  for (int e = 0; e < elements(); ++e) {
    evaluate(at, e, Vector2d(state.n_end), state);
    element_gradient(at, e, state, g, displacement);
    for (int i = 0; i <= stages(); ++i)
      for (int j = 0; j < 2; ++j) {
        const int row = place(e * stages() + i, j);
        (row < inner ? interior[row] : ends(row - inner)) += g(j, i);
      }
  }
  ends.segment<2>(4) = -displacement;
  ends.tail<2>() = state.n_end - Eigen::Map<const Vector2d>(at.n);
}

void DraggedLineArc::linearise(const ArcPoint& at) const {
  const int forces = interior_tangent() + 4, change = interior_tangent() + length_end() + 1;
  matrix_.setZero();
  carry_.setZero();
  carry_.block<2, 2>(0, forces).setIdentity();
  Element state;
  state.n_end = Eigen::Map<const Vector2d>(at.n);
  for (int e = 0; e < elements(); ++e) {
    evaluate(at, e, Vector2d(state.n_end), state);
    linearise(at, e, state);
  }
  matrix_.middleRows<2>(change) = carry_;
  matrix_.block<2, 2>(change, forces) -= Eigen::Matrix2d::Identity();
}

void DraggedLineArc::linearise(const ArcPoint& at, int element, const Element& state) const {
  const int m = stages(), inner = interior_tangent(), length = inner + length_end(), travel = length + 1;
  const double part = mesh_[element + 1] - mesh_[element], h = part * at.length;
  // Change of (q, q') at a Gauss point with the element's nodes, then with ℓ.
  Eigen::Matrix<double, 4, Eigen::Dynamic, 0, 4, max_local> z(4, 2 * m + 3);
  std::array<int, max_local> column;
  for (int i = 0; i <= m; ++i)
    for (int j = 0; j < 2; ++j) column[2 * i + j] = place(element * m + i, j);
  column[2 * m + 2] = length;
  const auto motion = [&](int k) {
    z.setZero();
    for (int i = 0; i <= m; ++i)
      for (int j = 0; j < 2; ++j) {
        z(j, 2 * i + j) = table_.value(k, i);
        z(2 + j, 2 * i + j) = table_.slope(k, i) / h;
      }
    z.block<2, 1>(2, 2 * m + 2) = -state.slope.col(k) / at.length;
  };
  // Of the rates of n: with what is at the stage, and with n there.
  const auto rate_by_z = [&](int k) {
    Eigen::Matrix<double, 2, 4> out = state.slips[k].d * state.pressure[k].by_z.transpose();
    out.col(0) += state.pressure[k].p * state.slips[k].by_psi;
    return Eigen::Matrix<double, 2, 4>(-at.friction * out);
  };
  const auto rate_by_n = [&](int k) {
    return Eigen::Matrix2d(-at.friction * state.slips[k].d * state.pressure[k].by_n.transpose());
  };
  MatrixXd system = MatrixXd::Identity(2 * m, 2 * m);
  for (int g = 0; g < m; ++g) at_stages_.middleRows<2>(2 * g) = carry_;
  std::array<Eigen::Matrix<double, 2, Eigen::Dynamic, 0, 2, max_local>, max_points> direct;
  for (int k = 0; k < m; ++k) {
    motion(k);
    direct[k] = rate_by_z(k) * z;
    const Vector2d by_travel = -at.friction * state.pressure[k].p * state.slips[k].by_travel;
    for (int g = 0; g < m; ++g) {
      const double a = stage_(g, k);
      system.block<2, 2>(2 * g, 2 * k) -= h * a * rate_by_n(k);
      for (int c = 0; c < 2 * m + 3; ++c)
        at_stages_.block<2, 1>(2 * g, column[c]) += h * a * direct[k].col(c);
      at_stages_.block<2, 1>(2 * g, length) += part * a * state.rate.col(k);
      at_stages_.block<2, 1>(2 * g, travel) += h * a * by_travel;
    }
  }
  at_stages_ = system.partialPivLu().solve(at_stages_).eval();
  Eigen::Vector4d gz;
  Eigen::Matrix4d hz;
  Vector2d d;
  Eigen::Matrix2d dd;
  for (int k = 0; k < m; ++k) {
    const double w = table_.weight(k);
    rod_.second(state.q.col(k), state.slope.col(k), state.n.col(k), gz, hz, d, dd);
    motion(k);
    const Eigen::Matrix<double, 4, Eigen::Dynamic, 0, 4, max_local> bent = hz * z;
    const auto forces = at_stages_.middleRows<2>(2 * k);
    for (int i = 0; i <= m; ++i)
      for (int j = 0; j < 2; ++j) {
        const int row = column[2 * i + j];
        const double value = h * w * table_.value(k, i), slope = w * table_.slope(k, i);
        for (int c = 0; c < 2 * m + 3; ++c)
          matrix_(row, column[c]) += value * bent(j, c) + slope * bent(2 + j, c);
        matrix_(row, length) += part * w * table_.value(k, i) * gz(j);
        matrix_.row(row) -= value * (dd.col(j).transpose() * forces);  // ∂L/∂q holds −n·∂d/∂q
      }
    for (int c = 0; c < 2 * m + 3; ++c)
      matrix_.block<2, 1>(inner + 4, column[c]) -= h * w * (dd * z.topRows<2>().col(c));
    matrix_.block<2, 1>(inner + 4, length) -= part * w * d;
    for (int c = 0; c < 2 * m + 3; ++c) carry_.col(column[c]) += h * w * direct[k].col(c);
    carry_ += h * w * (rate_by_n(k) * forces);
    carry_.col(length) += part * w * state.rate.col(k);
    carry_.col(travel) -= h * w * at.friction * state.pressure[k].p * state.slips[k].by_travel;
  }
}

Eigen::VectorXd DraggedLineArc::metric(const ArcPoint& at) const {
  Eigen::VectorXd mass = Eigen::VectorXd::Zero(interior_tangent() + ends());
  const Eigen::VectorXd still = still_->metric(at);
  mass.head(still.size()) = still;
  return mass;
}

bvp::ArcSamples DraggedLineArc::sample(const ArcPoint& at) const {
  const int m = stages();
  bvp::ArcSamples out = still_->sample(at);
  out.force.resize(2, out.sigma.size());
  Element state;
  state.n_end = Eigen::Map<const Vector2d>(at.n);
  Eigen::Matrix<double, 2, Eigen::Dynamic, 0, 2, max_points> g, loads(2, m);
  Eigen::Vector4d gz;
  Vector2d d, displacement;
  for (int e = 0; e < elements(); ++e) {
    const Vector2d before = state.n_end;
    evaluate(at, e, before, state);
    element_gradient(at, e, state, g, displacement);
    for (int k = 0; k < m; ++k) {
      rod_.first(state.q.col(k), state.slope.col(k), state.n.col(k), gz, d);
      loads.col(k) = gz.head<2>();
    }
    const double h = (mesh_[e + 1] - mesh_[e]) * at.length;
    const MatrixXd integral = h * table_.integral.transpose();
    out.force.middleCols(e * m, m + 1) = (state.rate * integral).colwise() + before;
    out.momentum.middleCols(e * m, m + 1) = (loads * integral).colwise() - Vector2d(g.col(0));
    out.momentum.col((e + 1) * m) = g.col(m);
    out.force.col((e + 1) * m) = state.n_end;
  }
  return out;
}

}  // namespace windlass::rod
