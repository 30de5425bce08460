#include "windlass/discrete_rod/energy.hpp"

#include <cmath>

namespace windlass::discrete_rod {

using Eigen::Index;
using Eigen::Matrix2d;
using Eigen::Vector2d;

struct Energy::Sum {
  double value = 0.0;
  bool derivatives = false;
  Vector gradient;
  std::vector<Eigen::Triplet<double>> entries;

  void add(Index i, double g) {
    if (i >= 0) gradient(i) += g;
  }
  void add(Index i, Index j, double h) {
    if (i >= 0 && j >= 0) entries.emplace_back(i, j, h);
  }
};

namespace {

/// Direction of a vector with its derivatives.
struct Direction {
  double angle;
  Vector2d slope;
  Matrix2d curvature;
  explicit Direction(const Vector2d& e) : angle(std::atan2(e(1), e(0))) {
    const double s = e.squaredNorm();
    slope = Vector2d(-e(1), e(0)) / s;
    const double mixed = (e(1) * e(1) - e(0) * e(0)) / (s * s), own = 2.0 * e(0) * e(1) / (s * s);
    curvature << own, mixed, mixed, -own;
  }
};

}  // namespace

Energy::Energy(const contact::Loads& loads, int edges, bool clamped)
    : edges_(edges),
      clamped_(clamped),
      h_(loads.half_length / edges),
      angle_(0.5 * loads.angle),
      pull_(loads.tension * Vector2d(std::cos(angle_), std::sin(angle_))) {}

Vector2d Energy::node(const Vector& x, int k) const {
  return k == 0 ? Vector2d(0.0, x(0)) : Vector2d(x.segment<2>(2 * k - 1));
}

Energy::Vector Energy::first_guess() const {
  const double tension = pull_.norm(), root = std::sqrt(tension);
  const double beta = std::acos(1.0 - 0.5 / tension), end = std::max(angle_ - beta, 0.0);
  Vector x(size());
  Vector2d at(0.0, -1.0);
  x(0) = -1.0;
  for (int k = 1; k <= edges_; ++k) {
    const double s = (k - 0.5) * h_;
    const double theta =
        s < end ? s : angle_ - 4.0 * std::atan(std::tan(0.25 * (angle_ - end)) * std::exp(root * (end - s)));
    at += h_ * Vector2d(std::cos(theta), std::sin(theta));
    x.segment<2>(2 * k - 1) = at;
  }
  return x;
}

void Energy::add_stretching(const Vector& x, Sum& sum) const {
  for (int e = 0; e < edges_; ++e) {
    const Vector2d d = edge(x, e);
    const double length = d.norm(), strain = length / h_ - 1.0;
    sum.value += 0.5 * stretching_ * h_ * strain * strain;
    if (!sum.derivatives) continue;
    const Vector2d t = d / length, force = stretching_ * strain * t;
    const Matrix2d along = t * t.transpose(),
                   k = stretching_ / h_ * along +
                       stretching_ * strain / length * (Matrix2d::Identity() - along);
    for (int a : {0, 1})
      for (int i = 0; i < 2; ++i) {
        sum.add(place(e + a, i), (a == 0 ? -1.0 : 1.0) * force(i));
        for (int b : {0, 1})
          for (int j = 0; j < 2; ++j)
            sum.add(place(e + a, i), place(e + b, j), (a == b ? 1.0 : -1.0) * k(i, j));
      }
  }
}

/// Turn from one edge to the next; at s = 0 from the mirror image of the first, at a clamped end to the pull.
void Energy::add_bending(const Vector& x, Sum& sum) const {
  for (int k = 0; k < edges_ + clamped_; ++k) {
    const bool has_left = k > 0, has_right = k < edges_;
    const Direction left(has_left ? edge(x, k - 1) : Vector2d(1.0, 0.0)),
        right(has_right ? edge(x, k) : pull_);
    const double weight = has_left && has_right ? 1.0 / h_ : 2.0 / h_;  // half a turn over half a length
    const double turn = std::remainder(right.angle - left.angle, 2.0 * M_PI);
    sum.value += 0.5 * weight * turn * turn;
    if (!sum.derivatives) continue;
    // The turn by the places of the nodes k − 1, k, k + 1.
    Eigen::Matrix<double, 6, 1> slope = Eigen::Matrix<double, 6, 1>::Zero();
    Eigen::Matrix<double, 6, 6> curvature = Eigen::Matrix<double, 6, 6>::Zero();
    const auto add = [&](const Direction& d, int first, double sign) {
      for (int a : {0, 1}) {
        const double s = a == 0 ? -sign : sign;
        slope.segment<2>(first + 2 * a) += s * d.slope;
        for (int b : {0, 1})
          curvature.block<2, 2>(first + 2 * a, first + 2 * b) += (a == b ? sign : -sign) * d.curvature;
      }
    };
    if (has_left) add(left, 0, -1.0);
    if (has_right) add(right, 2, 1.0);
    const Eigen::Matrix<double, 6, 6> hessian = weight * (slope * slope.transpose() + turn * curvature);
    for (int i = 0; i < 6; ++i) {
      const int a = k - 1 + i / 2;
      if (a < 0 || a > edges_) continue;
      sum.add(place(a, i % 2), weight * turn * slope(i));
      for (int j = 0; j < 6; ++j) {
        const int b = k - 1 + j / 2;
        if (b >= 0 && b <= edges_) sum.add(place(a, i % 2), place(b, j % 2), hessian(i, j));
      }
    }
  }
}

void Energy::add_contact(const Vector& x, Sum& sum) const {
  for (int k = 0; k <= edges_; ++k) {
    const Vector2d r = node(x, k);
    const double distance = r.norm(), depth = std::max(0.0, 1.0 - distance), weight = penalty_ * share(k);
    sum.value += 0.5 * weight * depth * depth;
    if (!sum.derivatives) continue;
    const Vector2d out = r / distance;
    const Matrix2d along = out * out.transpose();
    const Matrix2d hessian =
        depth > 0.0 ? Matrix2d(weight * along - weight * depth / distance * (Matrix2d::Identity() - along))
                    : Matrix2d::Zero();
    for (int i = 0; i < 2; ++i) {
      sum.add(place(k, i), -weight * depth * out(i));
      for (int j = 0; j < 2; ++j) sum.add(place(k, i), place(k, j), hessian(i, j));
    }
  }
}

Energy::Sum Energy::evaluate(const Vector& x, bool derivatives) const {
  Sum sum;
  sum.derivatives = derivatives;
  if (derivatives) {
    sum.gradient = Vector::Zero(size());
    sum.entries.reserve(56 * static_cast<std::size_t>(edges_));
    sum.gradient.tail<2>() -= pull_;
  }
  sum.value -= pull_.dot(node(x, edges_));
  add_stretching(x, sum);
  add_bending(x, sum);
  add_contact(x, sum);
  return sum;
}

double Energy::value(const Vector& x) const { return evaluate(x, false).value; }

Energy::Vector Energy::gradient(const Vector& x) const { return evaluate(x, true).gradient; }

Energy::Sparse Energy::hessian(const Vector& x) const {
  const Sum sum = evaluate(x, true);
  Sparse out(size(), size());
  out.setFromTriplets(sum.entries.begin(), sum.entries.end());
  return out;
}

double Energy::bending(const Vector& x) const {
  Sum sum;
  add_bending(x, sum);
  return 2.0 * sum.value;
}

double Energy::contact_force(const Vector& x) const {
  double sum = 0.0;
  for (int k = 0; k <= edges_; ++k) sum += 2.0 * penalty_ * share(k) * std::max(0.0, 1.0 - node(x, k).norm());
  return sum;
}

double Energy::last_contact_angle(const Vector& x) const {
  double angle = 0.0, last = 0.0;
  for (int k = 1; k <= edges_; ++k) {
    const Vector2d a = node(x, k - 1), b = node(x, k);
    angle += std::atan2(a(0) * b(1) - a(1) * b(0), a.dot(b));
    if (b.norm() < 1.0) last = angle;
  }
  return last;
}

}  // namespace windlass::discrete_rod
