#include "nodal_rod.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "windlass/obstacle/cylinder.hpp"

namespace windlass::equilibrium {

using Eigen::Index;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Vector = NodalRod::Vector;

namespace {

const obstacle::Cylinder cylinder;

Vector3d place_of(const Vector& x, int node) {
  return {x(NodalRod::position(node)), x(NodalRod::position(node) + 1), 0.0};
}

Vector2d along(double theta) { return {std::cos(theta), std::sin(theta)}; }
Vector2d across(double theta) { return {-std::sin(theta), std::cos(theta)}; }

/// Softness of the contact, far below the mesh error. A node pulled on, λ < 0, must show a gap when SNESVI sets λ = 0:
/// with a gap of zero to rounding the method would hold it or let it go by chance and never end.
constexpr double compliance = 1e-8;

/// Weight of the element's second node at the two Gauss points.
constexpr double gauss[] = {0.21132486540518711775, 0.78867513459481288225};

/// ∫ (cos θ, sin θ) ds over an element of length h.
Vector2d chord(double theta_a, double theta_b, double h) {
  Vector2d sum = Vector2d::Zero();
  for (const double w : gauss) sum += 0.5 * h * along((1.0 - w) * theta_a + w * theta_b);
  return sum;
}

/// Uniform where the rod may touch, with elements growing along the tail, where it is straight within a few decay
/// lengths 1/√T.
std::vector<double> node_places(const contact::Loads& loads, int elements) {
  constexpr double share_near = 0.8;
  const double near = std::min(0.5 * loads.angle + 1.5, 0.8 * loads.half_length),
               far = loads.half_length - near;
  const int fine = std::max(1, static_cast<int>(share_near * elements)),
            coarse = std::max(1, elements - fine);
  const double h = near / fine;
  std::vector<double> s;
  for (int k = 0; k <= fine; ++k) s.push_back(k * h);
  // Elements h q, h q², … fill the rest: q by bisection (the sum grows with q).
  double low = 0.1, high = 10.0;
  const auto filled = [&](double q) {
    double sum = 0.0, step = h;
    for (int k = 0; k < coarse; ++k) sum += step *= q;
    return sum;
  };
  for (int i = 0; i < 60; ++i) (filled(0.5 * (low + high)) < far ? low : high) = 0.5 * (low + high);
  double step = h;
  for (int k = 0; k < coarse; ++k) s.push_back(s.back() + (step *= low));
  s.back() = loads.half_length;
  return s;
}

}  // namespace

NodalRod::NodalRod(const contact::Loads& loads, const DiscoveryOptions& options)
    : loads_(loads), clamped_(options.clamped), s_(node_places(loads, options.elements)) {
  const double reach = 1.5 * length(0);  // elements grow from the first coarse one on
  while (near_nodes_ + 1 < nodes() && length(near_nodes_) < reach) ++near_nodes_;
}

Vector2d NodalRod::pull() const { return loads_.tension * along(0.5 * loads_.angle); }

std::vector<std::pair<Index, double>> NodalRod::held() const {
  std::vector<std::pair<Index, double>> out = {{theta(0), 0.0}, {position(0), 0.0}};
  if (clamped_) out.emplace_back(theta(nodes() - 1), 0.5 * loads_.angle);
  return out;
}

Vector NodalRod::first_guess() const {
  const double wound = 0.5 * loads_.angle, root = std::sqrt(loads_.tension);
  const double beta = std::acos(std::max(1.0 - 0.5 / loads_.tension, -1.0));
  const double edge = std::max(wound - beta, 0.0), pressure = std::max(loads_.tension - 0.5, 0.0);
  const auto angle = [&](double s) {
    return s <= edge ? s
                     : wound - 4.0 * std::atan(std::tan(0.25 * (wound - edge)) * std::exp(root * (edge - s)));
  };
  Vector x = Vector::Zero(size());
  x.segment<2>(position(0)) = Vector2d(0.0, -1.0);
  int last_touching = 0;
  for (int k = 0; k < nodes(); ++k) {
    x(theta(k)) = angle(s_[k]);
    if (s_[k] <= edge) last_touching = k;
    if (k == 0) continue;
    const double h = length(k - 1);
    x.segment<2>(position(k)) = x.segment<2>(position(k - 1)) + chord(x(theta(k - 1)), x(theta(k)), h);
    const bool free = s_[k] > edge;
    x.segment<2>(internal_force(k - 1)) = free ? pull() : Vector2d(pressure * along(s_[k] - 0.5 * h));
    if (!free) x(contact_force(k)) = pressure * h;
  }
  x(contact_force(0)) = 0.5 * pressure * length(0);
  x(contact_force(last_touching)) += loads_.tension * std::sin(wound - edge);  // the point force at the edge
  return x;
}

void NodalRod::add_element(const Vector& x, int e, Vector& f) const {
  const double h = length(e), theta_a = x(theta(e)), theta_b = x(theta(e + 1));
  const double moment = (theta_b - theta_a) / h;
  const Vector2d n = x.segment<2>(internal_force(e));
  f(theta(e)) -= moment;
  f(theta(e + 1)) += moment;
  for (const double w : gauss) {
    const double angle = (1.0 - w) * theta_a + w * theta_b, turn = 0.5 * h * n.dot(across(angle));
    f(theta(e)) -= (1.0 - w) * turn;
    f(theta(e + 1)) -= w * turn;
  }
  const Vector2d step = x.segment<2>(position(e + 1)) - x.segment<2>(position(e));
  f.segment<2>(internal_force(e)) = step - chord(theta_a, theta_b, h);
  f.segment<2>(position(e)) -= n;
  f.segment<2>(position(e + 1)) += n;
}

Vector NodalRod::residual(const Vector& x) const {
  Vector f = Vector::Zero(size());
  for (int e = 0; e + 1 < nodes(); ++e) add_element(x, e, f);
  for (int k = 0; k < nodes(); ++k) {
    const Vector3d r = place_of(x, k);
    f.segment<2>(position(k)) -= x(contact_force(k)) * cylinder.normal(r).head<2>();
    f(contact_force(k)) = cylinder.gap(r) + compliance * x(contact_force(k));
  }
  f.segment<2>(position(nodes() - 1)) -= pull();
  for (const auto& [place, value] : held()) f(place) = x(place) - value;
  return f;
}

void NodalRod::add_element(const Vector& x, int e, Triplets& entries) const {
  const double h = length(e), theta_a = x(theta(e)), theta_b = x(theta(e + 1));
  const Index a = theta(e), b = theta(e + 1), n = internal_force(e);
  const Vector2d force = x.segment<2>(n);
  const auto symmetric_pair = [&](Index i, Index j, double value) {
    entries.emplace_back(i, j, value);
    entries.emplace_back(j, i, value);
  };
  double aa = 1.0 / h, ab = -1.0 / h, bb = 1.0 / h;
  Vector2d turn_a = Vector2d::Zero(), turn_b = Vector2d::Zero();
  for (const double w : gauss) {
    const double angle = (1.0 - w) * theta_a + w * theta_b, stretch = 0.5 * h * force.dot(along(angle));
    aa += (1.0 - w) * (1.0 - w) * stretch;
    ab += w * (1.0 - w) * stretch;
    bb += w * w * stretch;
    turn_a -= 0.5 * h * (1.0 - w) * across(angle);
    turn_b -= 0.5 * h * w * across(angle);
  }
  entries.emplace_back(a, a, aa);
  entries.emplace_back(b, b, bb);
  symmetric_pair(a, b, ab);
  for (int i = 0; i < 2; ++i) {
    symmetric_pair(n + i, a, turn_a(i));
    symmetric_pair(n + i, b, turn_b(i));
    symmetric_pair(n + i, position(e) + i, -1.0);
    symmetric_pair(n + i, position(e + 1) + i, 1.0);
  }
}

NodalRod::Sparse NodalRod::jacobian(const Vector& x) const {
  Triplets entries;
  entries.reserve(64 * nodes());
  for (int e = 0; e + 1 < nodes(); ++e) add_element(x, e, entries);
  for (int k = 0; k < nodes(); ++k) {
    entries.emplace_back(contact_force(k), contact_force(k), compliance);
    const Vector3d r = place_of(x, k), normal = cylinder.normal(r);
    const Eigen::Matrix3d curvature = -x(contact_force(k)) * cylinder.hessian(r);
    for (int i = 0; i < 2; ++i) {
      entries.emplace_back(contact_force(k), position(k) + i, normal(i));
      entries.emplace_back(position(k) + i, contact_force(k), -normal(i));
      for (int j = 0; j < 2; ++j) entries.emplace_back(position(k) + i, position(k) + j, curvature(i, j));
    }
  }
  std::vector<bool> is_held(size(), false);
  for (const auto& [place, value] : held()) is_held[place] = true;
  std::erase_if(entries, [&](const auto& entry) { return is_held[entry.row()]; });
  for (const auto& [place, value] : held()) entries.emplace_back(place, place, 1.0);
  for (Index k = 0; k < size(); ++k) entries.emplace_back(k, k, 0.0);  // SNESVI writes on the diagonal
  Sparse out(size(), size());
  out.setFromTriplets(entries.begin(), entries.end());
  return out;
}

}  // namespace windlass::equilibrium
