#include "windlass/equilibrium/discovery.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "nodal_rod.hpp"
#include "windlass/obstacle/cylinder.hpp"
#include "windlass/petsc/direct_solver.hpp"

namespace windlass::equilibrium {

using Eigen::VectorXd;
using petsc::check;
using petsc::guard;

namespace {

/// A nodal force above this much of the pull counts as contact.
constexpr double active = 1e-9;

/// Nodes near the cylinder move less than this in one change of the pull [ρ].
constexpr double largest_step = 0.4;

PetscErrorCode evaluate(SNES, Vec in, Vec out, void* context) {
  return guard([&] {
    VectorXd x;
    petsc::copy(in, x);
    petsc::copy(static_cast<NodalRod*>(context)->residual(x), out);
  });
}

PetscErrorCode linearise(SNES, Vec in, Mat, Mat matrix, void* context) {
  return guard([&] {
    VectorXd x;
    petsc::copy(in, x);
    petsc::MatHandle fresh = petsc::aij(static_cast<NodalRod*>(context)->jacobian(x));
    check(MatCopy(fresh, matrix, SAME_NONZERO_PATTERN));
  });
}

/// λ >= 0, everything else free.
void set_bounds(SNES snes, const NodalRod& rod) {
  VectorXd lower = VectorXd::Constant(rod.size(), PETSC_NINFINITY);
  for (int k = 0; k < rod.nodes(); ++k) lower(NodalRod::contact_force(k)) = 0.0;
  petsc::VecHandle low = petsc::zero_vector(rod.size()), high = petsc::zero_vector(rod.size());
  petsc::copy(lower, low);
  check(VecSet(high, PETSC_INFINITY));
  check(SNESVISetVariableBounds(snes, low, high));
}

/// False where a matrix was singular (all contacts let go, nothing holds the rod): to KLU an error.
bool finished(SNES snes, Vec solution) {
  try {
    check(SNESSolve(snes, nullptr, solution));
    return true;
  } catch (const petsc::Error& error) {
    if (error.code() != PETSC_ERR_LIB) throw;
    return false;
  }
}

/// One solve by `type` from x; x is the solution on success and untouched otherwise.
bool solve(NodalRod& rod, SNESType type, SNESLineSearchType search_type, int max_iterations, VectorXd& x) {
  petsc::SnesHandle snes;
  petsc::MatHandle matrix = petsc::aij(rod.jacobian(x));
  petsc::VecHandle solution = petsc::zero_vector(rod.size()), residual = petsc::zero_vector(rod.size());
  check(SNESCreate(PETSC_COMM_SELF, snes.put()));
  check(SNESSetOptionsPrefix(snes, "discovery_"));
  check(SNESSetType(snes, type));
  check(SNESSetFunction(snes, residual, evaluate, &rod));
  check(SNESSetJacobian(snes, matrix, matrix, linearise, &rod));
  check(SNESSetTolerances(snes, 1e-10, 1e-13, 1e-14, max_iterations, -1));
  set_bounds(snes, rod);
  SNESLineSearch search = nullptr;
  check(SNESGetLineSearch(snes, &search));
  check(SNESLineSearchSetType(search, search_type));
  KSP ksp = nullptr;
  check(SNESGetKSP(snes, &ksp));
  petsc::solve_directly(ksp, MATSOLVERKLU);  // a narrow band of some 500: no dense fronts in it
  check(SNESSetFromOptions(snes));
  petsc::copy(x, solution);
  if (!finished(snes, solution)) return false;
  SNESConvergedReason reason = SNES_CONVERGED_ITERATING;
  check(SNESGetConvergedReason(snes, &reason));
  if (reason <= 0) return false;
  petsc::copy(solution, x);
  return true;
}

bool solve(NodalRod& rod, const DiscoveryOptions& options, VectorXd& x) {
  // Full steps first: the merit function of the line search has kinks where nodes come and go, and it stalls there.
  struct Attempt {
    SNESType type;
    SNESLineSearchType search;
  };
  for (const Attempt& attempt :
       {Attempt{SNESVINEWTONRSLS, SNESLINESEARCHBASIC}, Attempt{SNESVINEWTONSSLS, SNESLINESEARCHBT}})
    if (solve(rod, attempt.type, attempt.search, options.max_iterations, x)) return true;
  return false;
}

/// Largest displacement of a node near the cylinder.
double largest_move(const NodalRod& rod, const VectorXd& from, const VectorXd& to) {
  double move = 0.0;
  for (int k = 0; k <= rod.near_nodes(); ++k)
    move = std::max(move, (to - from).segment<2>(NodalRod::position(k)).norm());
  return move;
}

/// The state with every contact force moved by `shift` nodes.
VectorXd shifted(const NodalRod& rod, const VectorXd& x, int shift) {
  VectorXd out = x;
  for (int k = 0; k < rod.nodes(); ++k) {
    const int from = k - shift;
    out(NodalRod::contact_force(k)) =
        from >= 0 && from < rod.nodes() ? x(NodalRod::contact_force(from)) : 0.0;
  }
  return out;
}

/// Solves at another pull from the state before. Where a touch wanders along the rod its force must change nodes. A
/// rod pinched by one node is unstable, the node being a pin on a round surface, and an active-set method, which
/// trusts that a node that penetrates will push, then goes round in circles; started from the neighbouring nodes it
/// finds the pair that cradles the cylinder.
bool solve_nearby(NodalRod& rod, const DiscoveryOptions& options, VectorXd& x) {
  for (const int shift : {0, 1, -1, 2, -2}) {
    VectorXd trial = shifted(rod, x, shift);
    if (!solve(rod, options, trial) || largest_move(rod, x, trial) > largest_step) continue;
    x = trial;
    return true;
  }
  return false;
}

/// Weakest pull at which an infinite rod has a line contact.
double line_contact_limit(double angle) {
  return angle < std::numbers::pi ? 0.5 / (1.0 - std::cos(0.5 * angle)) : 0.5;
}

/// Down from a pull where the first guess is the closed form, in steps small enough to stay on the branch: the
/// complementarity problem has other solutions, with the rod past the cylinder.
bool descend(NodalRod& rod, double angle, const DiscoveryOptions& options, VectorXd& x) {
  constexpr double weakest_ratio = 0.98;
  const double wanted = rod.tension(), limit = line_contact_limit(angle);
  double reached = wanted > 1.1 * limit ? wanted : 1.3 * limit, ratio = 0.85;
  rod.set_tension(reached);
  x = rod.first_guess();
  if (!solve(rod, options, x)) return false;
  while (reached > wanted) {
    const double next = std::max(ratio * reached, wanted);
    rod.set_tension(next);
    if (solve_nearby(rod, options, x)) {
      reached = next;
      ratio = std::max(ratio * ratio, 0.85);
    } else if ((ratio = std::sqrt(ratio)) > weakest_ratio) {
      return false;
    }
  }
  return true;
}

NodalContact contact_of(const Discovery& d, const std::vector<double>& angle, int first, int last) {
  NodalContact out;
  double moment_s = 0.0, moment_angle = 0.0;
  for (int k = first; k <= last; ++k) {
    out.force += d.force[k];
    moment_s += d.force[k] * d.s[k];
    moment_angle += d.force[k] * angle[k];
  }
  const int count = first == 0 ? 2 * last + 1 : last - first + 1;  // with the mirror image
  if (count >= 3) {
    out.kind = NodalContact::Kind::line;
    out.s_begin = d.s[first], out.s_end = d.s[last];
    out.angle_begin = angle[first], out.angle_end = angle[last];
  } else {
    out.s_begin = out.s_end = moment_s / out.force;
    out.angle_begin = out.angle_end = moment_angle / out.force;
  }
  return out;
}

/// Angle of each node from the south pole, without jumps.
std::vector<double> unrolled_angles(const Discovery& d) {
  std::vector<double> angle = {0.0};
  for (std::size_t k = 1; k < d.s.size(); ++k) {
    const double cross = d.x[k - 1] * d.y[k] - d.y[k - 1] * d.x[k],
                 dot = d.x[k - 1] * d.x[k] + d.y[k - 1] * d.y[k];
    angle.push_back(angle.back() + std::atan2(cross, dot));
  }
  return angle;
}

Discovery describe(const NodalRod& rod, const VectorXd& x, double tension) {
  Discovery d;
  d.converged = true;
  d.s = rod.s();
  for (int k = 0; k < rod.nodes(); ++k) {
    d.theta.push_back(x(NodalRod::theta(k)));
    d.x.push_back(x(NodalRod::position(k)));
    d.y.push_back(x(NodalRod::position(k) + 1));
    d.gap.push_back(obstacle::Cylinder().gap({d.x.back(), d.y.back(), 0.0}));
    d.force.push_back(std::max(x(NodalRod::contact_force(k)), 0.0));  // the semismooth method leaves rounding
    d.R_tot += 2.0 * d.force.back();
  }
  const std::vector<double> angle = unrolled_angles(d);
  const auto touches = [&](int k) { return k < rod.nodes() && d.force[k] > active * tension; };
  for (int k = 0; k < rod.nodes(); ++k) {
    if (!touches(k)) continue;
    const int first = k;
    int last = k;
    for (; k < rod.nodes() && d.gap[k] < rod.near_contact(); ++k)
      if (touches(k)) last = k;
    d.contacts.push_back(contact_of(d, angle, first, last));
  }
  return d;
}

}  // namespace

void DiscoveryOptions::validate() const {
  if (elements < 4) throw std::invalid_argument("discovery: elements must be >= 4");
  if (max_iterations < 1) throw std::invalid_argument("discovery: max_iterations must be >= 1");
}

Discovery discover_contacts(const contact::Loads& loads, const DiscoveryOptions& options) {
  options.validate();
  if (!(loads.tension > 0.0)) throw std::invalid_argument("discovery: tension must be > 0");
  if (!(loads.angle > 0.0)) throw std::invalid_argument("discovery: angle must be > 0");
  if (!(loads.half_length > 0.5 * loads.angle))
    throw std::invalid_argument("discovery: half_length must exceed half the capstan angle");
  NodalRod rod(loads, options);
  VectorXd x;
  if (!descend(rod, loads.angle, options, x)) return {};
  return describe(rod, x, loads.tension);
}

}  // namespace windlass::equilibrium
