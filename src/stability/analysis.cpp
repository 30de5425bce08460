#include "windlass/stability/analysis.hpp"

#include <algorithm>
#include <cmath>

#include "dragged_spectrum.hpp"
#include "windlass/equilibrium/start.hpp"

namespace windlass::stability {

using contact::Parity;
using continuation::Vector;
using equilibrium::Mode;
using equilibrium::RodProblem;
using equilibrium::Stability;

namespace {

/// A contact that carries less than this is reported as degenerate.
constexpr double zero_force = 1e-9;

bool is_half(const RodProblem& problem) { return problem.topology().half; }

/// The symmetry that parities are told by: a half chain's own, of a full chain the half-turn, and the mirror where a cylinder drags.
chain::Symmetry symmetry_of(const RodProblem& problem) {
  if (is_half(problem)) return problem.topology().symmetry;
  return problem.dragged() ? chain::Symmetry::mirror : chain::Symmetry::half_turn;
}

/// Parity of a full chain's mode: sign of ∫ d(−s)·S d(s) ds, d from that of the mid-point on: a shift of the whole rod,
/// which depends on where a gauge holds it, has no part in it.
std::string parity_of(const Eigen::VectorXd& s, Eigen::Matrix3Xd d, chain::Symmetry symmetry) {
  double sum = 0.0;
  Eigen::Index mid = 0;
  s.cwiseAbs().minCoeff(&mid);
  d.colwise() -= Eigen::Vector3d(d.col(mid));
  for (Eigen::Index k = 0; k < s.size(); ++k) {
    Eigen::Index twin = 0;
    (s.array() + s(k)).abs().minCoeff(&twin);
    sum += d.col(twin).dot(contact::image(symmetry).cwiseProduct(d.col(k)));
  }
  return sum >= 0.0 ? "even" : "odd";
}

}  // namespace

Mode mode_of(RodProblem& problem, const Vector& x, const Vector& p, const Vector& increment, Parity parity) {
  constexpr double step = 1e-6;
  const double size = std::max(increment.lpNorm<Eigen::Infinity>(), 1e-300);
  const chain::Profile base = problem.profile(x, p);
  const chain::Profile moved = problem.profile(problem.retract(x, (step / size) * increment), p);
  std::vector<double> s;
  std::vector<Eigen::Vector3d> d;
  for (std::size_t i = 0; i < base.pieces.size(); ++i) {
    const chain::Piece& piece = base.pieces[i];
    for (Eigen::Index k = s.empty() ? 0 : piece.stride; k < piece.s.size(); k += piece.stride) {
      s.push_back(piece.s(k));
      d.push_back((moved.pieces[i].r.col(k) - piece.r.col(k)) / step);
    }
  }
  const bool half = is_half(problem);
  const Eigen::Index count = static_cast<Eigen::Index>(s.size()), total = half ? 2 * count - 1 : count;
  Mode mode;
  mode.s.resize(total);
  mode.displacement.resize(3, total);
  const chain::Symmetry symmetry = symmetry_of(problem);
  const Eigen::Vector3d image = (parity == Parity::odd ? -1.0 : 1.0) * contact::image(symmetry);
  for (Eigen::Index k = 0; k < count; ++k) {
    const Eigen::Index right = half ? count - 1 + k : k;
    mode.s(right) = s[k];
    mode.displacement.col(right) = d[k];
    if (!half) continue;
    mode.s(count - 1 - k) = -s[k];
    mode.displacement.col(count - 1 - k) = k == 0 ? d[k] : Eigen::Vector3d(image.cwiseProduct(d[k]));
  }
  const double largest = mode.displacement.cwiseAbs().maxCoeff();
  if (largest > 0.0) mode.displacement /= largest;
  mode.plane = mode.displacement.row(2).norm() > mode.displacement.topRows(2).norm() ? "out" : "in";
  mode.parity =
      half ? (parity == Parity::odd ? "odd" : "even") : parity_of(mode.s, mode.displacement, symmetry);
  return mode;
}

int neutral_modes(const RodProblem& problem) {
  const chain::Chain& chain = problem.chain();
  int hinges = 0;
  for (int j = 0; j < chain.joint_count(); ++j) hinges += !chain.joint(j).fixed_in_variations().empty();
  return problem.topology().half ? 2 * hinges : hinges;
}

namespace {

/// Of a dragged state; its index counts the eigenvalues of negative real part. That of a half chain is judged on the full one.
Stability analyse_dragged(RodProblem& given, const Vector& at_x, const Vector& p, int count) {
  if (is_half(given)) {
    const equilibrium::Started whole = equilibrium::unfold(given, at_x, p, 0);
    return analyse_dragged(*whole.problem, whole.x, p, count);
  }
  RodProblem& problem = given;
  const Vector& x = at_x;
  Stability out;
  for (const chain::Contact& c : problem.profile(x, p).contacts) out.degenerate |= c.force < zero_force;
  const contact::Loads loads = problem.loads(p);
  out.leading = leading_eigenvalues(problem.chain().dragged_variation(x, loads), count);
  for (const std::complex<double>& value : out.leading) {
    out.index += value.real() < 0.0;
    out.eigenvalues.push_back(value.real());
  }
  out.inertia_index = out.index;
  equilibrium::multiply(out, problem.units());
  return out;
}

}  // namespace

Stability analyse(RodProblem& given, const Vector& at_x, const Vector& p, int count, bool modes,
                  SpectrumSolver& solver) {
  if (given.dragged()) return analyse_dragged(given, at_x, p, count);
  Stability out;
  out.inertia_index = given.total_index(at_x, p);
  out.sliding = given.sliding_stiffness(at_x, p);
  for (const chain::Contact& c : given.profile(at_x, p).contacts) out.degenerate |= c.force < zero_force;
  // A mode's shape is drawn from the chain's own unknowns, so that closed-form tails need some.
  const auto meshed = modes ? equilibrium::with_meshed_tails(given, at_x, p) : std::nullopt;
  RodProblem& problem = meshed ? *meshed->problem : given;
  const Vector& x = meshed ? meshed->x : at_x;
  const chain::Chain& chain = problem.factored(x, p);
  const chain::Linearisation linearised(chain, problem.rod(), x, problem.loads(p));
  std::vector<Mode> all;
  for (const Parity parity : {Parity::even, Parity::odd}) {
    if (parity == Parity::odd && !is_half(problem)) continue;
    const chain::Variation variation(linearised, parity);
    const Spectrum spectrum = solver.lowest(variation, count);
    out.index += spectrum.index;
    out.degenerate |= spectrum.rounded;
    for (Eigen::Index k = 0; k < spectrum.eigenvalues.size(); ++k) {
      Mode mode;
      if (modes)
        mode = mode_of(problem, x, p, chain.as_increment(spectrum.eigenvectors.col(k), parity), parity);
      mode.eigenvalue = spectrum.eigenvalues(k);
      all.push_back(std::move(mode));
    }
  }
  std::sort(all.begin(), all.end(), [](const Mode& a, const Mode& b) { return a.eigenvalue < b.eigenvalue; });
  if (static_cast<int>(all.size()) > std::max(count, out.index)) all.resize(std::max(count, out.index));
  for (const Mode& mode : all) out.eigenvalues.push_back(mode.eigenvalue);
  if (modes) out.modes = std::move(all);
  // An arc about to buckle by itself, see contact::spatial::FreeRodEnd: zero to second order.
  out.degenerate |= neutral_modes(problem) > 0;
  equilibrium::multiply(out, given.units());
  return out;
}

}  // namespace windlass::stability
