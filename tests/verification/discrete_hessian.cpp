#include "discrete_hessian.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "windlass/rod/quaternion.hpp"

namespace windlass::test {

namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using equilibrium::Solution;

/// The centre line between the samples of a state: quintic, of place, tangent and curvature t' = m × t.
class CentreLine {
 public:
  explicit CentreLine(const Solution& state) {
    for (const auto& arc : state.arcs)
      for (Index k = 0; k < arc.s.size(); ++k) {
        if (!s_.empty() && !(arc.s(k) > s_.back())) continue;
        const Vector3d t = rod::directors(Eigen::Vector4d(arc.q.col(k))).col(2), m = arc.m.col(k);
        s_.push_back(arc.s(k)), r_.push_back(arc.r.col(k)), t_.push_back(t), c_.push_back(m.cross(t));
        pull_.push_back(arc.n.col(k).dot(t) - m.squaredNorm());
      }
  }
  double begin() const { return s_.front(); }
  double end() const { return s_.back(); }
  /// Place, tangent and curvature.
  std::array<Vector3d, 3> at(double s) const {
    const auto after = std::upper_bound(s_.begin() + 1, s_.end() - 1, s) - s_.begin();
    const auto k = static_cast<std::size_t>(after) - 1;
    const double h = s_[k + 1] - s_[k], x = (s - s_[k]) / h;
    // Power series about the left sample that meets place, tangent and curvature of the right one.
    const Vector3d a0 = r_[k], a1 = h * t_[k], a2 = 0.5 * h * h * c_[k];
    const Vector3d p = r_[k + 1] - a0 - a1 - a2, v = h * t_[k + 1] - a1 - 2.0 * a2,
                   a = h * h * c_[k + 1] - 2.0 * a2;
    const Vector3d a3 = 10.0 * p - 4.0 * v + 0.5 * a, a4 = -15.0 * p + 7.0 * v - a,
                   a5 = 6.0 * p - 3.0 * v + 0.5 * a;
    return {a0 + x * (a1 + x * (a2 + x * (a3 + x * (a4 + x * a5)))),
            (a1 + x * (2.0 * a2 + x * (3.0 * a3 + x * (4.0 * a4 + 5.0 * x * a5)))) / h,
            (2.0 * a2 + x * (6.0 * a3 + x * (12.0 * a4 + 20.0 * x * a5))) / (h * h)};
  }
  /// n·t − κ².
  double tension(double s) const {
    const auto k =
        static_cast<std::size_t>(std::upper_bound(s_.begin() + 1, s_.end() - 1, s) - s_.begin()) - 1;
    return pull_[k] + (pull_[k + 1] - pull_[k]) * (s - s_[k]) / (s_[k + 1] - s_[k]);
  }

 private:
  std::vector<double> s_, pull_;
  std::vector<Vector3d> r_, t_, c_;
};

/// A contact: the first strand at s, the other at `other` (NaN: the cylinder of radius 1).
struct ActiveContact {
  double s, other, force;
  bool along = false;  ///< of a line: it stays at s
};

std::vector<ActiveContact> active_contacts(const Solution& state) {
  std::vector<ActiveContact> out;
  for (std::size_t j = 0; j < state.joints.size(); ++j) {
    const auto& joint = state.joints[j];
    if (joint.kind == equilibrium::JointKind::touch) out.push_back({joint.s, NAN, joint.force});
    if (joint.partner >= static_cast<int>(j))
      out.push_back({joint.s, state.joints[joint.partner].s, joint.strand_force, joint.along_strand});
  }
  return out;
}

/// Weights of vertices in place, slope and curvature at a point of the polygon, cubic through four of them.
struct Stencil {
  Index first;
  std::array<double, 4> place, slope, bend;
};

Stencil stencil_at(const std::vector<double>& s, double at) {
  const auto above = std::upper_bound(s.begin(), s.end(), at) - s.begin();
  Stencil out{std::clamp<Index>(above - 2, 0, static_cast<Index>(s.size()) - 4), {}, {}, {}};
  for (int i = 0; i < 4; ++i) {
    double scale = 1.0;
    std::array<double, 3> d{};
    for (int j = 0, k = 0; j < 4; ++j) {
      if (j == i) continue;
      scale *= s[out.first + i] - s[out.first + j];
      d[k++] = at - s[out.first + j];
    }
    out.place[i] = d[0] * d[1] * d[2] / scale;
    out.slope[i] = (d[0] * d[1] + d[0] * d[2] + d[1] * d[2]) / scale;
    out.bend[i] = 2.0 * (d[0] + d[1] + d[2]) / scale;
  }
  return out;
}

struct Polygon {
  std::vector<double> s;
  std::vector<Vector3d> r;
  Index size() const { return 3 * static_cast<Index>(r.size()); }
  Vector3d edge(std::size_t i) const { return r[i + 1] - r[i]; }
  /// Rows of a weighted sum of the vertices.
  MatrixXd rows(const Stencil& at, const std::array<double, 4>& weights, double sign = 1.0) const {
    MatrixXd out = MatrixXd::Zero(3, size());
    for (int i = 0; i < 4; ++i)
      out.block<3, 3>(0, 3 * (at.first + i)) = sign * weights[i] * Matrix3d::Identity();
    return out;
  }
  Vector3d sum(const MatrixXd& rows) const { return rows * Eigen::Map<const VectorXd>(r[0].data(), size()); }
};

/// First and second variation of a distance where it is least.
struct GapVariation {
  VectorXd first;
  MatrixXd second;
};

/// |D| with D = r(s) − r(other), or P r(s) for the cylinder; what moves the place(s) of the least gap is taken out.
GapVariation gap_of(const Polygon& rod, const ActiveContact& touch) {
  const bool cylinder = std::isnan(touch.other);
  Matrix3d project = Matrix3d::Identity();
  if (cylinder) project(2, 2) = 0.0;
  const Stencil at = stencil_at(rod.s, touch.s);
  MatrixXd by_rod = project * rod.rows(at, at.place);
  std::vector<MatrixXd> slopes;
  std::vector<Vector3d> bends;
  const auto moves = [&](const Stencil& here, double sign) {
    slopes.push_back(project * rod.rows(here, here.slope, sign));
    bends.push_back(project * rod.sum(rod.rows(here, here.bend, sign)));
  };
  if (!touch.along) moves(at, 1.0);
  if (!cylinder) {
    const Stencil other = stencil_at(rod.s, touch.other);
    by_rod += rod.rows(other, other.place, -1.0);
    moves(other, -1.0);
  }
  const Vector3d d = rod.sum(by_rod);
  const double size = d.norm();
  const Vector3d e = d / size;
  const Matrix3d turn = (project - e * e.transpose()) / size;
  GapVariation out{by_rod.transpose() * e, by_rod.transpose() * turn * by_rod};
  const auto count = static_cast<Index>(slopes.size());
  MatrixXd mixed(count, rod.size()), place(count, count);
  for (Index a = 0; a < count; ++a) {
    const Vector3d at_a = rod.sum(slopes[a]);
    mixed.row(a) = at_a.transpose() * turn * by_rod + e.transpose() * slopes[a];
    for (Index b = 0; b < count; ++b) place(a, b) = at_a.dot(turn * rod.sum(slopes[b]));
    place(a, a) += e.dot(bends[a]);
  }
  out.second -= mixed.transpose() * place.ldlt().solve(mixed);
  return out;
}

Polygon polygon_of(const CentreLine& curve, const std::vector<ActiveContact>& all, double mesh) {
  double reach = 0.0;
  for (const ActiveContact& t : all)
    reach = std::max({reach, std::abs(t.s), std::isnan(t.other) ? 0.0 : std::abs(t.other)});
  constexpr double beyond = 3.0;
  // Even in the contacts, longer and longer in the tails.
  std::vector<double> s;
  const auto half = static_cast<int>(std::ceil((reach + beyond) / mesh));
  for (int k = -half; k <= half; ++k) s.push_back(k * mesh);
  constexpr double growth = 1.1, longest = 4.0;
  double step = mesh;
  while (s.back() + 1.5 * step < curve.end()) {
    s.push_back(s.back() + step), s.insert(s.begin(), -s.back());
    step = std::min(growth * step, longest * mesh);
  }
  s.push_back(curve.end()), s.insert(s.begin(), curve.begin());
  Polygon out{s, {}};
  for (const double at : s) out.r.push_back(curve.at(at)[0]);
  return out;
}

/// A quadratic form in the edges of a polygon, over its vertices.
struct Quadratic {
  const Polygon& rod;
  MatrixXd by_edges =
      MatrixXd::Zero(static_cast<Index>(rod.r.size()) - 1, static_cast<Index>(rod.r.size()) - 1);
  MatrixXd hessian() const {
    const Index edges = by_edges.rows();
    MatrixXd difference = MatrixXd::Zero(edges, edges + 1);
    for (Index i = 0; i < edges; ++i) difference(i, i) = -1.0, difference(i, i + 1) = 1.0;
    const MatrixXd by_vertex = difference.transpose() * by_edges * difference;
    MatrixXd out = MatrixXd::Zero(rod.size(), rod.size());
    for (Index i = 0; i <= edges; ++i)
      for (Index j = 0; j <= edges; ++j)
        if (by_vertex(i, j) != 0.0) out.block<3, 3>(3 * i, 3 * j) = by_vertex(i, j) * Matrix3d::Identity();
    return out;
  }
};

}  // namespace

VectorXd DiscreteHessian::eigenvalues(const Solution& state) const {
  const CentreLine curve(state);
  const std::vector<ActiveContact> contacts = active_contacts(state);
  const Polygon rod = polygon_of(curve, contacts, mesh);
  const Index n = rod.size(), edges = static_cast<Index>(rod.r.size()) - 1;
  const auto count = static_cast<Index>(contacts.size());
  // ½ ∫ |t'|² + μ (|t|² − 1), μ = n·t − κ²: t = E/ℓ, and |E| = ℓ stays. Forces of contacts are normal to t: n·t is continuous.
  Quadratic energy{rod}, mass{rod};
  MatrixXd conditions = MatrixXd::Zero(n, edges + count + 2);
  VectorXd length(edges);
  for (Index i = 0; i < edges; ++i) {
    const Vector3d edge = rod.edge(i);
    length(i) = edge.norm();
    energy.by_edges(i, i) += curve.tension(0.5 * (rod.s[i] + rod.s[i + 1])) / length(i);
    mass.by_edges(i, i) = 1.0 / length(i);
    conditions.block<3, 1>(3 * i, i) = -edge / length(i);
    conditions.block<3, 1>(3 * i + 3, i) = edge / length(i);
    if (i == 0) continue;
    const double a = length(i - 1), b = length(i), between = 0.5 * (a + b);
    energy.by_edges(i - 1, i - 1) += 1.0 / (a * a * between);
    energy.by_edges(i, i) += 1.0 / (b * b * between);
    energy.by_edges(i - 1, i) -= 1.0 / (a * b * between);
    energy.by_edges(i, i - 1) -= 1.0 / (a * b * between);
  }
  MatrixXd k = energy.hessian();
  for (Index c = 0; c < count; ++c) {
    const GapVariation gap = gap_of(rod, contacts[c]);
    conditions.col(edges + c) = gap.first;
    k -= contacts[c].force * gap.second;
  }
  // The ends of a free rod stay on e_x, and what costs nothing is held: one vertex, the turn about e_x, the slide.
  std::vector<Index> free;
  for (Index i = 0; i < n; ++i) {
    const bool end = i < 3 || i >= n - 3, pinned = !state.has_cylinder && end && i % 3 != 0;
    if (!pinned && i != 3 * (edges / 2) + (state.has_cylinder ? 2 : 0)) free.push_back(i);
  }
  Index held = edges + count;
  if (!state.has_cylinder) {
    for (Index i = 0; i <= edges; ++i)
      conditions.block<3, 1>(3 * i, held) = Vector3d::UnitX().cross(rod.r[i]);
    ++held;
  }
  if (hold_slide) {
    for (Index i = 0; i + 1 < edges; ++i) {
      const Vector3d turn = 0.5 * (rod.edge(i + 1) / length(i + 1) - rod.edge(i) / length(i));
      for (const Index e : {i, i + 1}) {
        conditions.block<3, 1>(3 * e, held) -= turn / length(e);
        conditions.block<3, 1>(3 * e + 3, held) += turn / length(e);
      }
    }
    ++held;
  }
  conditions.conservativeResize(Eigen::NoChange, held);
  const Eigen::ColPivHouseholderQR<MatrixXd> qr(conditions(free, Eigen::all));
  const MatrixXd q = qr.householderQ(), tangent = q.rightCols(q.cols() - qr.rank());
  const auto reduced = [&](const MatrixXd& of) -> MatrixXd {
    const MatrixXd kept = of(free, free);
    return tangent.transpose() * kept * tangent;
  };
  return Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd>(reduced(k), reduced(mass.hessian()),
                                                            Eigen::EigenvaluesOnly)
      .eigenvalues();
}

}  // namespace windlass::test
