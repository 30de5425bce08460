#include "windlass/rod/layered_line.hpp"

namespace windlass::rod {

using Eigen::Vector2d;
using Number = LayeredSection::Number;

namespace {

/// The variables of a section as numbers, m₃ still missing where the twist is given.
struct Variables {
  Number psi, bend, twist, around, axial, travel;
};

Variables of_section(const Friction& friction, double psi, double bend, double twist, const Vector2d& n) {
  return {Number::variable(psi, LayeredSection::psi),
          Number::variable(bend, LayeredSection::bend),
          Number::variable(twist, LayeredSection::twist),
          Number::variable(n(0), LayeredSection::around),
          Number::variable(n(1), LayeredSection::axial),
          Number::variable(friction.travel, LayeredSection::travel)};
}

/// All that depends on (ψ, ψ', m₃, n, ω) alone.
void fill(const SurfaceDensity& rod, const Friction& friction, const Variables& x, const Number& m3,
          LayeredSection& out) {
  const double b = rod.bending_stiffness, k = friction.compliance, mu = friction.mu, r = friction.arm;
  const Number c = cos(x.psi), s = sin(x.psi), c2 = c * c, cos2 = c2 - s * s, soft = k * b * c2 * c2;
  const Number divisor = 1.0 + soft, divisor_psi = -4.0 * k * b * c2 * c * s;
  const Number whole = 1.0 + k * (x.around * c + x.axial * s - m3 * s * c),
               whole_psi = k * (x.axial * c - x.around * s - m3 * cos2);
  const Number stretch = whole / divisor;
  // h and f = h/E − B sin ψ cos ψ (3 − k B cos⁴ψ)/D, with ∂/∂ψ.
  const Number g = (x.around - m3 * s) * s - x.axial * c,
               g_psi = (x.around - m3 * s) * c - m3 * c * s + x.axial * s;
  const Number h = m3 - k * b * c2 * g, h_psi = k * b * (2.0 * c * s * g - c2 * g_psi);
  const Number f = h / whole - b * s * c * (3.0 - soft) / divisor;
  const Number f_psi = (h_psi - h * whole_psi / whole) / whole - b * cos2 * (3.0 - soft) / divisor +
                       4.0 * b * s * c * divisor_psi / (divisor * divisor);
  // Balance: n_θ, n₂ and ψ''.
  const Number hoop = x.around - m3 * s - b * stretch * c2 * c, n2 = hoop * s - x.axial * c;
  const Number turn = stretch * (n2 + m3 * c2 - b * stretch * s * c2 * c) * (1.0 / b);
  // The direction of slip (e_z − ω λ t)/|..|, in (e_θ, e_z), along t and b = N × t.
  const Number speed = x.travel * stretch, size = sqrt(1.0 - 2.0 * speed * s + speed * speed);
  const Number d_around = -speed * c / size, d_axial = (1.0 - speed * s) / size, d_along = (s - speed) / size,
               d_across = c / size;
  out.stretch = stretch;
  out.normal = x.bend * f;
  out.pressure = stretch * c * hoop - turn * f - x.bend * x.bend * f_psi;
  out.lever = mu * d_along * (r + k * b * c2) / whole;
  out.drag[0] = mu * (1.0 - r) * d_around, out.drag[1] = mu * d_axial;
  out.across = r * mu * d_across;
  // ∂f/∂n_a, ∂f/∂n_z, ∂f/∂m₃, by what friction changes of these: −α = −ψ' Σ.
  const Number by_whole = h / (whole * whole), tilted = k * b * c2;
  const Number by_around = -tilted * s / whole - by_whole * k * c,
               by_axial = tilted * c / whole - by_whole * k * s,
               by_moment = (1.0 + tilted * s * s) / whole + by_whole * k * s * c;
  out.share = x.bend * (by_around * out.drag[0] + by_axial * out.drag[1] + by_moment * out.across);
  out.momenta[0] = b * x.bend, out.momenta[1] = m3;
  out.moved[0] = stretch * c, out.moved[1] = stretch * s;
  const double bent = b * stretch.value * c2.value,
               longer = k > 0.0 ? (hoop * c + x.axial * s).value : 0.0;  // the tension
  out.stored = 0.5 * (b * x.bend.value * x.bend.value + bent * bent / b +
                      m3.value * m3.value / rod.twisting_stiffness + k * longer * longer);
}

}  // namespace

LayeredSection LayeredSection::at(const SurfaceDensity& rod, const Friction& friction, double psi,
                                  const Vector2d& slope, const Vector2d& n) {
  const Variables x = of_section(friction, psi, slope(0), slope(1), n);
  const double b = rod.bending_stiffness, t = rod.twisting_stiffness, k = friction.compliance;
  const Number c = cos(x.psi), s = sin(x.psi), sc = s * c, c2 = c * c, cos2 = c2 - s * s;
  // N, Q and λ = (1 + k N)/(1 + k Q) of rod/extensible_density.hpp.
  const Number force = x.around * c + x.axial * s - t * x.twist * sc, bent = b * c2 * c2 + t * sc * sc;
  const Number stretch = (1.0 + k * force) / (1.0 + k * bent), m3 = t * (x.twist + stretch * sc);
  LayeredSection out;
  fill(rod, friction, x, m3, out);
  const Number force_psi = x.axial * c - x.around * s - t * x.twist * cos2,
               bent_psi = -4.0 * b * c2 * c * s + 2.0 * t * sc * cos2;
  out.load = stretch * (0.5 * stretch * bent_psi - force_psi);
  return out;
}

LayeredSection LayeredSection::with_momentum(const SurfaceDensity& rod, const Friction& friction, double psi,
                                             const Vector2d& momentum, const Vector2d& n) {
  const Variables x = of_section(friction, psi, momentum(0) / rod.bending_stiffness, momentum(1), n);
  LayeredSection out;
  fill(rod, friction, x, x.twist, out);
  return out;
}

}  // namespace windlass::rod
