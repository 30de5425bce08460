#include "windlass/rod/line_contact.hpp"

#include <cmath>
#include <stdexcept>

#include "windlass/bvp/collocation_arc.hpp"
#include "windlass/rod/extensible_density.hpp"
#include "windlass/rod/plane_density.hpp"
#include "windlass/rod/surface_density.hpp"

namespace windlass::rod {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

bool is_flat(const obstacle::Surface& surface) { return surface.curvature() == 0.0; }

bool isotropic_straight(const Material& rod) {
  return rod.stiffness(0) == rod.stiffness(1) && rod.natural.isZero();
}

/// Unit cylinder, isotropic and naturally straight rod, B = EI, m₃ the twisting moment (PHYSICS, "Line contact"):
///     m = (Bψ', −B cos²ψ, m₃),   n_θ = n_a − m₃ sin ψ − B cos³ψ,
///     n₁ = ψ'(m₃ − 3B sin ψ cos ψ),  n₂ = n_θ sin ψ − n_z cos ψ,  n₃ = n_θ cos ψ + n_z sin ψ,
///     Bψ'' = n₂ + m₃ cos²ψ − B sin ψ cos³ψ,
///     p = −n₁' + cos ψ n_θ,  n₁' = ψ''(m₃ − 3B sin ψ cos ψ) − 3Bψ'² cos 2ψ      (m₃' = 0).
LineSection on_cylinder(double b, const Vector2d& q, const Vector2d& momentum, const Vector2d& n) {
  const double c = std::cos(q(0)), s = std::sin(q(0)), slope = momentum(0) / b, m3 = momentum(1);
  const double around = n(0) - m3 * s - b * c * c * c;
  const double n1 = slope * (m3 - 3.0 * b * s * c), n2 = around * s - n(1) * c, n3 = around * c + n(1) * s;
  const double bend = (n2 + m3 * c * c - b * s * c * c * c) / b;
  const double p = c * around - bend * (m3 - 3.0 * b * s * c) + 3.0 * b * slope * slope * (c * c - s * s);
  return {{n1, n2, n3}, {b * slope, -b * c * c, m3}, p, c * around};
}

/// The same of a rod that stretches by λ = 1 + k n₃, k = 1/EA (PHYSICS, "Rods that stretch"): m = (Bψ', −Bλ cos²ψ, m₃),
///     n_θ = n_a − m₃ sin ψ − Bλ cos³ψ,   λ (1 + kB cos⁴ψ) = 1 + k (n_a cos ψ + n_z sin ψ − m₃ sin ψ cos ψ),
///     λ n₁ = ψ' A + Bλ' cos²ψ,  A = m₃ − 3Bλ sin ψ cos ψ,   n_θ' = −λ cos ψ n₁,
///     λ' (1 + kB cos⁴ψ) = −kψ' G,  G = A cos²ψ + n₂,   Bψ'' = λ (n₂ + m₃ cos²ψ − Bλ sin ψ cos³ψ),
///     p = λ cos ψ n_θ − n₁'.
/// A function of its own, or the compiler shares products with the other, and rounds that one otherwise.
[[gnu::noinline]] LineSection on_stretching_cylinder(const Material& rod, const Vector2d& q,
                                                     const Vector2d& momentum, const Vector2d& n) {
  const double b = rod.bending_stiffness, k = rod.compliance;
  const double c = std::cos(q(0)), s = std::sin(q(0)), rate = momentum(0) / b, m3 = momentum(1);
  const double divisor = 1.0 + k * b * c * c * c * c, divisor_rate = -4.0 * k * b * c * c * c * s * rate;
  const double stretch = (1.0 + k * (n(0) * c + n(1) * s - m3 * s * c)) / divisor;
  const double around = n(0) - m3 * s - b * stretch * c * c * c;
  const double n2 = around * s - n(1) * c, n3 = around * c + n(1) * s;
  const double a = m3 - 3.0 * b * stretch * s * c, g = a * c * c + n2;
  const double stretch_rate = -k * rate * g / divisor;
  const double n1 = (rate * a + b * stretch_rate * c * c) / stretch;
  const double bend = stretch * (n2 + m3 * c * c - b * stretch * s * c * c * c) / b;
  const double a_rate = -3.0 * b * (stretch_rate * s * c + stretch * rate * (c * c - s * s));
  const double n2_rate = rate * n3 - stretch * c * s * n1;
  const double g_rate = -2.0 * c * s * rate * a + c * c * a_rate + n2_rate;
  const double stretch_bend = (-k * (bend * g + rate * g_rate) - stretch_rate * divisor_rate) / divisor;
  const double n1_rate =
      (bend * a + rate * a_rate + b * (stretch_bend * c * c - 2.0 * stretch_rate * c * s * rate) -
       stretch_rate * n1) /
      stretch;
  const double hoop = stretch * c * around;
  return {{n1, n2, n3}, {b * rate, -b * stretch * c * c, m3}, hoop - n1_rate, hoop};
}

/// A quantity along the rod with its first and second derivative.
struct Jet {
  double v = 0.0, d = 0.0, dd = 0.0;
};
Jet operator+(const Jet& a, const Jet& b) { return {a.v + b.v, a.d + b.d, a.dd + b.dd}; }
Jet operator*(double k, const Jet& a) { return {k * a.v, k * a.d, k * a.dd}; }
Jet operator*(const Jet& a, const Jet& b) {
  return {a.v * b.v, a.d * b.v + a.v * b.d, a.dd * b.v + 2.0 * a.d * b.d + a.v * b.dd};
}
Jet inverse(const Jet& a) {
  const double i = 1.0 / a.v;
  return {i, -a.d * i * i, (2.0 * a.d * a.d * i - a.dd) * i * i};
}
Jet sine(const Jet& a) {
  const double s = std::sin(a.v), c = std::cos(a.v);
  return {s, c * a.d, c * a.dd - s * a.d * a.d};
}
Jet cosine(const Jet& a) {
  const double s = std::sin(a.v), c = std::cos(a.v);
  return {c, -s * a.d, -s * a.dd - c * a.d * a.d};
}

/// Plane. With the moments about N and t, m_N' = n₂ and m₃' = −m₂ ψ', the curvature follows from the material,
///     ψ' = (m_N + K₁û₁ cos χ − K₂û₂ sin χ)/(K₁ cos²χ + K₂ sin²χ),   χ' = m₃/C + û₃,
///     m₂ = (K₁ − K₂) sin χ cos χ ψ' − K₁û₁ sin χ − K₂û₂ cos χ,
/// and what the surface takes from the other balances: n₁ = ψ' m₃ − m₂', p = −n₁'. Of a rod that stretches by λ = 1 + k n₃ and
/// weighs w = (w_N, w₂, w₃) a length: m_N' = λ n₂, n₁ = (ψ' m₃ − m₂')/λ, n₂' = ψ' n₃ − w₂, n₃' = −ψ' n₂ − w₃, p = −n₁' − w_N.
LineSection on_plane(const Material& rod, const Vector2d& q, const Vector2d& momentum, const Vector2d& n,
                     const Vector3d& weight) {
  const double k1 = rod.stiffness(0), k2 = rod.stiffness(1), c3 = rod.stiffness(2);
  const double f1 = k1 * rod.natural(0), f2 = k2 * rod.natural(1);
  const double n2 = n(0) * std::sin(q(0)) - n(1) * std::cos(q(0)),
               n3 = n(0) * std::cos(q(0)) + n(1) * std::sin(q(0));
  const double stretch = rod.stretch(n3);
  Jet chi{q(1), momentum(1) / c3 + rod.natural(2), 0.0}, about_normal{momentum(0), stretch * n2, 0.0};
  double twist_slope = 0.0, stretch_slope = 0.0;
  Jet rate, m2;
  for (int pass = 0; pass < 2; ++pass) {  // the second derivatives need the first pass' values
    const Jet s = sine(chi), c = cosine(chi);
    rate = (about_normal + f1 * c + (-f2) * s) * inverse(k1 * (c * c) + k2 * (s * s));
    m2 = (k1 - k2) * (s * c * rate) + (-f1) * s + (-f2) * c;
    twist_slope = -m2.v * rate.v;
    chi.dd = twist_slope / c3;
    stretch_slope = -rod.compliance * (rate.v * n2 + weight(2));
    about_normal.dd = stretch * (rate.v * n3 - weight(1)) + stretch_slope * n2;
  }
  const double n1 = (rate.v * momentum(1) - m2.d) / stretch;
  const double p = (m2.dd - rate.d * momentum(1) - rate.v * twist_slope + stretch_slope * n1) / stretch;
  return {{n1, n2, n3}, {momentum(0), m2.v, momentum(1)}, p - weight(0), -weight(0)};
}

/// (w·N, w·(t × N), w·t) of a rod on a plane.
Vector3d weight_in_frame(const obstacle::Surface& surface, const Material& rod, double psi) {
  if (rod.weight.isZero()) return Vector3d::Zero();
  const obstacle::Chart here = surface.chart(Vector2d::Zero());
  const double c = std::cos(psi), s = std::sin(psi);
  return {rod.weight.dot(here.normal), rod.weight.dot(here.tangents * Vector2d(s, -c)),
          rod.weight.dot(here.tangents * Vector2d(c, s))};
}

}  // namespace

std::unique_ptr<bvp::Arc> make_line_arc(const obstacle::Surface& surface, const Material& rod,
                                        const std::vector<double>& mesh, int stages) {
  const PlaneDensity on_plane{rod.stiffness, rod.natural};
  if (is_flat(surface) && rod.stretches)
    return bvp::make_collocation_arc(Extensible<PlaneDensity>{on_plane}, mesh, stages);
  if (is_flat(surface)) return bvp::make_collocation_arc(on_plane, mesh, stages);
  if (!isotropic_straight(rod))
    throw std::invalid_argument("a line contact needs an isotropic, naturally straight rod");
  const SurfaceDensity on_cylinder{rod.bending_stiffness, rod.stiffness(2)};
  if (rod.stretches) return bvp::make_collocation_arc(Extensible<SurfaceDensity>{on_cylinder}, mesh, stages);
  return bvp::make_collocation_arc(on_cylinder, mesh, stages);
}

LineSection line_section(const obstacle::Surface& surface, const Material& rod, const Vector2d& q,
                         const Vector2d& momentum, const Vector2d& n) {
  if (is_flat(surface)) return on_plane(rod, q, momentum, n, weight_in_frame(surface, rod, q(0)));
  return rod.compliance == 0.0 ? on_cylinder(rod.bending_stiffness, q, momentum, n)
                               : on_stretching_cylinder(rod, q, momentum, n);
}

Vector2d line_forces(const obstacle::Surface& surface, const Vector2d& u, const Vector3d& r,
                     const Vector3d& n, const Vector3d& m) {
  const obstacle::Chart at = surface.chart(u);
  // The momentum of a turn about the axis of curvature is a torque, that of a translation a force.
  if (is_flat(surface)) return at.tangents.transpose() * n;
  return {at.tangents.col(1).dot(m + r.cross(n)), at.tangents.col(1).dot(n)};
}

std::optional<double> buckling_margin(const obstacle::Surface& surface, const Material& rod, double twist,
                                      double tension, double length) {
  if (!is_flat(surface)) return std::nullopt;
  const double s = std::sin(twist), c = std::cos(twist);
  const double compliance = s * s / rod.stiffness(0) + c * c / rod.stiffness(1);
  return 1.0 + rod.stretch(tension) * tension * length * length * compliance / (4.0 * M_PI * M_PI);
}

}  // namespace windlass::rod
