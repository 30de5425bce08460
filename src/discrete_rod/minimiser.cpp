#include "windlass/discrete_rod/minimiser.hpp"

#include <petsctao.h>

#include <cmath>
#include <stdexcept>

#include "windlass/discrete_rod/energy.hpp"
#include "windlass/petsc/direct_solver.hpp"

namespace windlass::discrete_rod {

using Eigen::VectorXd;
using petsc::check;
using petsc::guard;

namespace {

using TaoHandle = petsc::Handle<Tao, TaoDestroy>;

PetscErrorCode objective(Tao, Vec in, PetscReal* value, void* context) {
  return guard([&] {
    VectorXd x;
    petsc::copy(in, x);
    *value = static_cast<Energy*>(context)->value(x);
  });
}

PetscErrorCode slope(Tao, Vec in, Vec out, void* context) {
  return guard([&] {
    VectorXd x;
    petsc::copy(in, x);
    petsc::copy(static_cast<Energy*>(context)->gradient(x), out);
  });
}

PetscErrorCode curvature(Tao, Vec in, Mat, Mat matrix, void* context) {
  return guard([&] {
    VectorXd x;
    petsc::copy(in, x);
    petsc::MatHandle fresh = petsc::aij(static_cast<Energy*>(context)->hessian(x));
    check(MatCopy(fresh, matrix, SAME_NONZERO_PATTERN));
  });
}

/// One minimisation from x. @returns iterations, or −1 and x as far as it came
int descend(Energy& energy, double gradient_tolerance, VectorXd& x) {
  TaoHandle tao;
  petsc::VecHandle solution = petsc::zero_vector(energy.size());
  petsc::MatHandle matrix = petsc::aij(energy.hessian(x));
  check(TaoCreate(PETSC_COMM_SELF, tao.put()));
  check(TaoSetOptionsPrefix(tao, "discrete_rod_"));
  check(TaoSetType(tao, TAONLS));
  petsc::copy(x, solution);
  check(TaoSetSolution(tao, solution));
  check(TaoSetObjective(tao, objective, &energy));
  check(TaoSetGradient(tao, nullptr, slope, &energy));
  check(TaoSetHessian(tao, matrix, matrix, curvature, &energy));
  check(TaoSetTolerances(tao, gradient_tolerance, 0.0, 0.0));
  constexpr int most = 200;
  check(TaoSetMaximumIterations(tao, most));
  KSP ksp = nullptr;
  check(TaoGetKSP(tao, &ksp));
  if (ksp) petsc::solve_directly(ksp);
  check(TaoSetFromOptions(tao));
  check(TaoSolve(tao));
  TaoConvergedReason reason = TAO_CONTINUE_ITERATING;
  check(TaoGetConvergedReason(tao, &reason));
  PetscInt iterations = 0;
  check(TaoGetIterationNumber(tao, &iterations));
  petsc::copy(solution, x);
  return reason > 0 ? static_cast<int>(iterations) : -1;
}

}  // namespace

void MinimiserOptions::validate() const {
  if (edges < 4) throw std::invalid_argument("discrete rod: edges must be >= 4");
  if (!(stretching > 0.0)) throw std::invalid_argument("discrete rod: stretching must be > 0");
  if (!(penalty >= 0.0)) throw std::invalid_argument("discrete rod: penalty must be >= 0");
}

Minimum minimise(const contact::Loads& loads, const MinimiserOptions& options) {
  options.validate();
  if (!(loads.tension > 0.5)) throw std::invalid_argument("discrete rod: tension must be > 1/2");
  if (!(loads.angle > 0.0)) throw std::invalid_argument("discrete rod: angle must be > 0");
  if (!(loads.half_length > 0.5 * loads.angle))
    throw std::invalid_argument("discrete rod: half_length must exceed half the capstan angle");
  const double h = loads.half_length / options.edges;
  const double stretching = options.stretching,
               penalty = options.penalty > 0.0 ? options.penalty : 4.0 / std::pow(h, 4);
  // Gradients are sums of forces EA·(|e|/h − 1), each exact to rounding of places of size half_length.
  constexpr double epsilon = 2.2e-16;
  const double reachable = 4.0 * epsilon * stretching * loads.half_length / h * std::sqrt(options.edges);
  Energy energy(loads, options.edges, options.clamped);
  VectorXd x = energy.first_guess();
  Minimum minimum;
  minimum.unknowns = static_cast<int>(energy.size());
  // From soft to stiff: the penetration is then never far from its new value.
  constexpr double softest = 1e3, factor = 10.0;
  for (double soft = softest;; soft *= factor) {
    const bool last = soft >= std::max(stretching, penalty);
    energy.set_stiffness(std::min(soft, stretching), std::min(soft, penalty));
    const int used = descend(energy, last ? std::max(1e-9, reachable) : 1e-5, x);
    if (used < 0) return minimum;
    minimum.iterations += used;
    if (last) break;
  }
  minimum.R_tot = energy.contact_force(x);
  minimum.converged = minimum.R_tot > 0.0;
  minimum.phi_star = energy.last_contact_angle(x);
  minimum.energy = energy.bending(x);
  return minimum;
}

}  // namespace windlass::discrete_rod
