#include "windlass/pull/dragged_rod.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "windlass/discrete_rod/bending_density.hpp"
#include "windlass/discrete_rod/strand_pairs.hpp"
#include "windlass/discrete_rod/strand_term.hpp"
#include "windlass/pull/rounded.hpp"

namespace windlass::pull {

using discrete_rod::cubic_weights;
using discrete_rod::OpenSpline;
using discrete_rod::Quadrature;
using discrete_rod::Weights;
using Eigen::Index;
using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// One element: residual and matrix by its control points and its tension.
struct DraggedRod::Local {
  int element;
  double length;
  Spline::Controls controls;
  double tension;
  bool derivatives;
  Eigen::Matrix<double, 13, 1> residual = Eigen::Matrix<double, 13, 1>::Zero();
  Eigen::Matrix<double, 13, 13> matrix = Eigen::Matrix<double, 13, 13>::Zero();
};

/// One quadrature point: the force per length there and what it is made of.
struct DraggedRod::Place {
  Vector3d r, normal = Vector3d::Zero(), force = Vector3d::Zero();
  Matrix3d by_place = Matrix3d::Zero();  ///< ∂force/∂r
  double pressure = 0.0, drag = 0.0, plate = 0.0;
  Vector2d slip = Vector2d::Zero();  ///< with that of the step
  bool sticks = false;
};

DraggedRod::DraggedRod(Spline spline, const Setting& given, double h)
    : setting(given),
      spline_(std::move(spline)),
      bed_(4.0 / std::pow(1.5 * h, 4)),
      rounding_(softest * given.tension / bed_),
      left_(-std::cos(0.5 * given.angle), std::sin(0.5 * given.angle), 0.0),
      right_(std::cos(0.5 * given.angle), std::sin(0.5 * given.angle), 0.0) {}

DraggedRod::Vector DraggedRod::unknowns(const Vector& controls) const {
  Vector u = Vector::Zero(size());
  u.head(spline_.size()) = controls;
  u.segment(spline_.size(), spline_.elements()).setConstant(setting.tension);
  return u;
}

DraggedRod::Place DraggedRod::at(const Local& local, int q, const Memory& last, const Step& step) const {
  Place out;
  out.r = local.controls * cubic_weights(Quadrature::place[static_cast<std::size_t>(q)], 0);
  const Index k = Quadrature::points * local.element + q;
  const Vector3d from = last.place.col(k);
  out.force = -step.damping * (out.r - from);
  out.by_place = -step.damping * Matrix3d::Identity();
  for (const double side : {1.0, -1.0}) {  // the plate above, the second one below
    const double height = side > 0.0 ? setting.plate : setting.below;
    if (!step.plates || !std::isfinite(height)) continue;
    const auto [depth, slope] = rounded(side * (out.r(2) - height), rounding_);
    out.plate += bed_ * depth;
    out.force(2) -= side * bed_ * depth;
    out.by_place(2, 2) -= bed_ * slope;
  }
  const double distance = out.r.head<2>().norm();
  const auto [depth, slope] = rounded(1.0 - distance, rounding_);
  if (depth <= 0.0) return out;
  const Vector3d N(out.r(0) / distance, out.r(1) / distance, 0.0), round(-N(1), N(0), 0.0);
  const double p = out.pressure = bed_ * depth;
  out.normal = N;
  out.force += p * N;
  out.by_place += p / distance * round * round.transpose() - bed_ * slope * N * N.transpose();
  if (!step.dragged) return out;
  out.slip = last.slip.col(k) + Vector2d(-round.dot(from), out.r(2) - from(2) - step.advance);
  const Coulomb::Traction traction = setting.coulomb(out.slip);
  out.sticks = traction.sticks;
  const Vector2d unit = traction.by_pressure;
  out.drag = p * unit(1);
  Eigen::Matrix<double, 3, 2> frame = Eigen::Matrix<double, 3, 2>::Zero();
  frame.col(0) = round;
  frame(2, 1) = 1.0;
  Eigen::Matrix<double, 2, 3> slip_by_place = Eigen::Matrix<double, 2, 3>::Zero();
  slip_by_place.row(0) = N.dot(from) / distance * round.transpose();
  slip_by_place(1, 2) = 1.0;
  out.force += p * frame * unit;
  out.by_place += frame * (p * traction.by_slip * slip_by_place - bed_ * slope * unit * N.transpose()) -
                  p * unit(0) / distance * N * round.transpose();
  return out;
}

namespace {

/// Bending energy and length of an element, with what they derive to by its control points.
struct ElementShape {
  double bending = 0.0, length = 0.0;
  Eigen::Matrix<double, 12, 1> by_bending = Eigen::Matrix<double, 12, 1>::Zero(),
                               by_length = Eigen::Matrix<double, 12, 1>::Zero();
  Eigen::Matrix<double, 12, 12> bending_twice = Eigen::Matrix<double, 12, 12>::Zero(),
                                length_twice = Eigen::Matrix<double, 12, 12>::Zero();

  ElementShape(const OpenSpline::Controls& controls, bool derivatives) {
    for (std::size_t q = 0; q < Quadrature::points; ++q)
      add(controls, Quadrature::place[q], Quadrature::weight[q], derivatives);
  }
  void add(const OpenSpline::Controls& controls, double t, double weight, bool derivatives) {
    const Weights first = cubic_weights(t, 1), second = cubic_weights(t, 2);
    const Vector3d along = controls * first;
    const discrete_rod::BendingDensity density(along, controls * second);
    const double norm = along.norm();
    const Vector3d tangent = along / norm;
    const Matrix3d across = (Matrix3d::Identity() - tangent * tangent.transpose()) / norm;
    bending += weight * density.value;
    length += weight * norm;
    for (int a = 0; a < 4; ++a) {
      by_bending.segment<3>(3 * a) +=
          weight * (first(a) * density.gradient.head<3>() + second(a) * density.gradient.tail<3>());
      by_length.segment<3>(3 * a) += weight * first(a) * tangent;
      if (!derivatives) continue;
      for (int b = 0; b < 4; ++b) {
        length_twice.block<3, 3>(3 * a, 3 * b) += weight * first(a) * first(b) * across;
        bending_twice.block<3, 3>(3 * a, 3 * b) +=
            weight * (first(a) * first(b) * density.hessian.topLeftCorner<3, 3>() +
                      second(a) * second(b) * density.hessian.bottomRightCorner<3, 3>() +
                      first(a) * second(b) * density.hessian.topRightCorner<3, 3>() +
                      second(a) * first(b) * density.hessian.bottomLeftCorner<3, 3>());
      }
    }
  }
};

}  // namespace

void DraggedRod::add_shape(Local& local) const {
  const ElementShape shape(local.controls, local.derivatives);
  const double k = setting.compliance, h = local.length, N = local.tension;
  const double strain = k * (N - shape.bending / h);
  local.residual.head<12>() += (1.0 + strain) * shape.by_bending + N * shape.by_length;
  local.residual(12) = shape.length - h * (1.0 + strain);
  if (!local.derivatives) return;
  local.matrix.topLeftCorner<12, 12>() += (1.0 + strain) * shape.bending_twice + N * shape.length_twice -
                                          k / h * shape.by_bending * shape.by_bending.transpose();
  local.matrix.col(12).head<12>() += k * shape.by_bending + shape.by_length;
  local.matrix.row(12).head<12>() = local.matrix.col(12).head<12>().transpose();
  local.matrix(12, 12) = -h * k;
}

void DraggedRod::add_contact(Local& local, const Memory& last, const Step& step) const {
  for (int q = 0; q < Quadrature::points; ++q) {
    const auto here = static_cast<std::size_t>(q);
    const Place place = at(local, q, last, step);
    const double weight = Quadrature::weight[here] * local.length;
    const Weights w = cubic_weights(Quadrature::place[here], 0);
    for (int a = 0; a < 4; ++a) {
      local.residual.segment<3>(3 * a) -= weight * w(a) * place.force;
      if (!local.derivatives) continue;
      for (int b = 0; b < 4; ++b)
        local.matrix.block<3, 3>(3 * a, 3 * b) -= weight * w(a) * w(b) * place.by_place;
    }
  }
}

/// The pulls, what holds the outermost control points (a free end is straight, at no cost), and where the travel is
/// blocked the equation of τ.
void DraggedRod::add_ends(const Vector& u, Vector& residual,
                          std::vector<Eigen::Triplet<double>>* entries) const {
  const int last = spline_.elements() - 1;
  const Index travel = size() - 1;
  const double difference = setting.blocked ? u(travel) : 0.0;
  double lead = 0.0;
  for (const auto& [element, t, direction, sign] :
       {std::tuple{0, 0.0, left_, -1.0}, std::tuple{last, 1.0, right_, 1.0}}) {
    const Spline::Controls controls = Spline::controls(u, element);
    const Weights end = cubic_weights(t, 0), second = cubic_weights(t, 2);
    const double stiffness = 1.0 / std::pow(spline_.length(element), 3);
    const Vector3d bend = controls * second;
    lead += 0.5 * sign * direction.dot(controls * end);
    for (int a = 0; a < 4; ++a) {
      const Index row = Spline::begin(element) + 3 * a;
      residual.segment<3>(row) +=
          stiffness * second(a) * bend - end(a) * (setting.tension + sign * difference) * direction;
      if (!entries) continue;
      for (int c = 0; c < 3; ++c) {
        for (int b = 0; b < 4; ++b)
          entries->emplace_back(row + c, Spline::begin(element) + 3 * b + c,
                                stiffness * second(a) * second(b));
        if (!setting.blocked) continue;
        entries->emplace_back(row + c, travel, -sign * end(a) * direction(c));
        entries->emplace_back(travel, row + c, 0.5 * sign * end(a) * direction(c));
      }
    }
  }
  if (setting.blocked) residual(travel) = lead;
}

/// Strands that touch: places of one that are nearer than 2r to another, the corner of the bed rounded like those of the others.
void DraggedRod::add_strands(const Vector& u, Vector& residual,
                             std::vector<Eigen::Triplet<double>>* entries) const {
  if (!(setting.radius > 0.0)) return;
  const double reach = 2.0 * setting.radius;
  for (const discrete_rod::StrandPair& pair :
       discrete_rod::strand_pairs(spline_, u, reach + rounding_, M_PI * setting.radius)) {
    const discrete_rod::StrandDistance apart =
        discrete_rod::strand_distance(Spline::controls(u, pair.element), pair.t,
                                      Spline::controls(u, pair.other), pair.other_t, pair.distance);
    const auto [depth, slope] = rounded(reach - pair.distance, rounding_);
    const double weight = 0.5 * bed_ * pair.weight;
    const auto place = [&](int k) {
      return k < 12 ? Spline::begin(pair.element) + k : Spline::begin(pair.other) + k - 12;
    };
    for (int k = 0; k < 24; ++k) residual(place(k)) -= weight * depth * apart.slope(k);
    if (!entries) continue;
    for (int k = 0; k < 24; ++k)
      for (int j = 0; j < 24; ++j)
        entries->emplace_back(
            place(k), place(j),
            weight * (slope * apart.slope(k) * apart.slope(j) - depth * apart.curvature(k, j)));
  }
}

void DraggedRod::evaluate(const Vector& u, const Memory& last, const Step& step, Vector& residual,
                          Sparse* matrix) const {
  residual = Vector::Zero(size());
  std::vector<Eigen::Triplet<double>> entries;
  if (matrix) entries.reserve(169 * static_cast<std::size_t>(spline_.elements()) + 200);
  for (int e = 0; e < spline_.elements(); ++e) {
    Local local{e, spline_.length(e), Spline::controls(u, e), u(tension(e)), matrix != nullptr};
    add_shape(local);
    add_contact(local, last, step);
    residual.segment<12>(Spline::begin(e)) += local.residual.head<12>();
    residual(tension(e)) = local.residual(12);
    if (!matrix) continue;
    const auto place = [&](int k) { return k < 12 ? Spline::begin(e) + k : tension(e); };
    for (int k = 0; k < 13; ++k)
      for (int j = 0; j < 13; ++j) entries.emplace_back(place(k), place(j), local.matrix(k, j));
  }
  add_ends(u, residual, matrix ? &entries : nullptr);
  add_strands(u, residual, matrix ? &entries : nullptr);
  if (!matrix) return;
  matrix->resize(size(), size());
  matrix->setFromTriplets(entries.begin(), entries.end());
}

Measured DraggedRod::measured(const Vector& u, const Memory& last, const Step& step) const {
  Measured out;
  out.z_low = HUGE_VAL, out.z_high = -HUGE_VAL;
  if (setting.blocked) out.pull_difference = u(size() - 1);
  double stuck = 0.0, moved = 0.0;
  for (int e = 0; e < spline_.elements(); ++e) {
    const Local local{e, spline_.length(e), Spline::controls(u, e), 0.0, false};
    for (int q = 0; q < Quadrature::points; ++q) {
      const auto here = static_cast<std::size_t>(q);
      const Place place = at(local, q, last, step);
      const double weight = Quadrature::weight[here] * local.length;
      out.drag += weight * place.drag;
      out.plate_force += weight * place.plate;
      out.R_tot += weight * place.pressure;
      if (place.sticks) stuck += weight * place.pressure;
      out.z_low = std::min(out.z_low, place.r(2));
      out.z_high = std::max(out.z_high, place.r(2));
      if (place.pressure <= 0.0) continue;
      const Vector3d tangent = (local.controls * cubic_weights(Quadrature::place[here], 1)).normalized();
      const Vector3d way = place.r - last.place.col(Quadrature::points * e + q);
      moved += weight * place.pressure * (way - way.dot(tangent) * tangent).norm();
    }
  }
  if (out.R_tot > 0.0) out.sticking = stuck / out.R_tot, out.moved = moved / out.R_tot;
  return out;
}

std::vector<PlaceLoad> DraggedRod::loads(const Vector& u, const Memory& last, const Step& step) const {
  std::vector<PlaceLoad> out;
  for (int e = 0; e < spline_.elements(); ++e) {
    const Local local{e, spline_.length(e), Spline::controls(u, e), 0.0, false};
    for (int q = 0; q < Quadrature::points; ++q) {
      const auto here = static_cast<std::size_t>(q);
      const Place place = at(local, q, last, step);
      out.push_back({spline_.knot(e) + Quadrature::place[here] * local.length,
                     Quadrature::weight[here] * local.length * place.force, place.pressure, place.plate});
    }
  }
  return out;
}

Memory DraggedRod::memory(const Vector& u, const Memory& last, const Step& step) const {
  Memory out = fresh_memory(u);
  for (int e = 0; e < spline_.elements(); ++e) {
    const Local local{e, spline_.length(e), Spline::controls(u, e), 0.0, false};
    for (int q = 0; q < Quadrature::points; ++q)
      out.slip.col(Quadrature::points * e + q) = setting.coulomb.kept(at(local, q, last, step).slip);
  }
  return out;
}

Memory DraggedRod::fresh_memory(const Vector& u) const {
  const Index points = Quadrature::points * static_cast<Index>(spline_.elements());
  Memory out{Eigen::Matrix3Xd(3, points), Eigen::Matrix2Xd::Zero(2, points)};
  for (int e = 0; e < spline_.elements(); ++e)
    for (int q = 0; q < Quadrature::points; ++q)
      out.place.col(Quadrature::points * e + q) =
          Spline::position(u, e, Quadrature::place[static_cast<std::size_t>(q)]);
  return out;
}

}  // namespace windlass::pull
