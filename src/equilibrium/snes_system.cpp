#include "snes_system.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace windlass::equilibrium {

using continuation::BorderedSystem;
using continuation::Borders;
using continuation::CorrectorReport;
using continuation::Iterate;
using continuation::Options;
using continuation::Problem;
using continuation::StoppingRule;
using Eigen::Index;
using Eigen::VectorXd;
using petsc::check;

namespace {

constexpr PetscInt plenty = 1000;  // of iterations: the options of a solve say how many
constexpr PetscInt no_limit = -1;

}  // namespace

SnesSystem::SnesSystem(Index size) : size_(size), increment_(size), defect_(size), work_(size) {
  check(SNESCreate(PETSC_COMM_SELF, snes_.put()));
  increment_vector_ = petsc::zero_vector(size);
  residual_vector_ = petsc::zero_vector(size);
  create_solver();
  PetscReal residual = 0.0, increment = 0.0, users_residual = 0.0, users_increment = 0.0;
  PetscInt users_most = 0;
  check(SNESSetTolerances(snes_, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT, plenty, no_limit));
  check(SNESGetTolerances(snes_, &residual, nullptr, &increment, nullptr, nullptr));
  check(SNESSetFromOptions(snes_));
  check(SNESGetTolerances(snes_, &users_residual, nullptr, &users_increment, &users_most, nullptr));
  if (users_residual != residual) residual_tolerance_ = users_residual;
  if (users_increment != increment) increment_tolerance_ = users_increment;
  if (users_most != plenty) most_ = static_cast<int>(users_most);
}

void SnesSystem::create_solver() {
  const PetscInt n = static_cast<PetscInt>(size_);
  check(SNESSetFunction(snes_, residual_vector_, evaluate, this));
  check(SNESSetApplicationContext(snes_, this));
  check(SNESSetType(snes_, SNESNEWTONLS));
  check(SNESSetUpdate(snes_, absorb));
  check(SNESSetConvergenceTest(snes_, judge, this, nullptr));
  constexpr PetscInt once = -2;  // each time costs a dozen look-ups of options
  check(SNESSetLagJacobian(snes_, once));
  SNESLineSearch search = nullptr;
  check(SNESGetLineSearch(snes_, &search));
  check(SNESLineSearchSetType(search, SNESLINESEARCHBASIC));
  check(SNESLineSearchSetPreCheck(search, shorten, this));
  check(MatCreateShell(PETSC_COMM_SELF, n, n, n, n, this, matrix_.put()));
  check(MatShellSetOperation(matrix_, MATOP_MULT, reinterpret_cast<void (*)()>(multiply)));
  check(MatShellSetOperation(matrix_, MATOP_ASSEMBLY_END, reinterpret_cast<void (*)()>(nothing)));
  check(SNESSetJacobian(snes_, matrix_, matrix_, linearise, this));
  KSP ksp = nullptr;
  PC pc = nullptr;
  check(SNESGetKSP(snes_, &ksp));
  check(KSPSetType(ksp, KSPPREONLY));
  check(KSPGetPC(ksp, &pc));
  check(PCSetType(pc, PCSHELL));
  check(PCShellSetContext(pc, this));
  check(PCShellSetApply(pc, apply_inverse));
}

const Options& SnesSystem::with_users(const Options& options) {
  if (!residual_tolerance_ && !increment_tolerance_ && !most_) return options;
  own_ = options;
  if (residual_tolerance_) own_.residual_tolerance = *residual_tolerance_;
  if (increment_tolerance_) own_.newton_tolerance = *increment_tolerance_;
  if (most_) own_.max_newton = *most_;
  return own_;
}

CorrectorReport SnesSystem::solve(Problem& problem, const Borders& borders, Iterate& iterate,
                                  const Options& given, const SnesNewton::Part* part) {
  const Options& options = with_users(given);
  base_ = iterate;
  std::swap(iterate_, iterate);
  iterate_ = base_;
  BorderedSystem system(problem, borders, iterate_);
  StoppingRule rule(options, part ? StoppingRule::Guess::far : StoppingRule::Guess::near,
                    [&] { return system.noise(); });
  system_ = &system;
  rule_ = &rule;
  part_ = part;
  report_ = {};
  increment_.setZero();
  due_ = done_ = false;
  corrections_ = 0;
  most_corrections_ = options.max_newton;
  check(VecSet(increment_vector_, 0.0));
  check(SNESSolve(snes_, nullptr, increment_vector_));
  SNESConvergedReason reason = SNES_CONVERGED_ITERATING;
  check(SNESGetConvergedReason(snes_, &reason));
  report_.converged = reason > 0;
  if (report_.converged) report_.failure.clear();
  if (!report_.converged && report_.failure.empty()) {
    const char* text = nullptr;
    check(SNESGetConvergedReasonString(snes_, &text));
    report_.failure = text;
  }
  report_.factorizations = system.factorizations();
  std::swap(iterate, iterate_);
  system_ = nullptr;
  return report_;
}

void SnesSystem::move_to(Vec increment) {
  petsc::copy(increment, work_);
  if (increment_ == work_) return;
  iterate_ = base_;
  system_->add(work_);
  increment_ = work_;
  due_ = false;
}

double SnesSystem::length_of_correction() const {
  if (!part_) return system_->length(correction_);
  return correction_.lpNorm<Eigen::Infinity>() / std::max(1.0, iterate_.x.lpNorm<Eigen::Infinity>());
}

void SnesSystem::find_correction() {
  const bool first = corrections_ == 0;
  bool fresh = first || part_;
  if (fresh) system_->factor();
  correction_ = system_->solve(defect_);
  double length = length_of_correction();
  report_.residual = system_->residual();
  // F tells how fast it goes where the metric leaves out most of the corrections.
  if (first) first_ = length, first_residual_ = report_.residual;
  if (corrections_ == 1)
    report_.contraction = std::min(length / first_, report_.residual / std::max(first_residual_, 1e-300));
  if (!fresh && rule_->slow(length)) {
    system_->factor();
    correction_ = system_->solve(defect_);
    length = length_of_correction();
    fresh = true;
  }
  ++corrections_;
  done_ = rule_->last(length, report_.residual, system_->state_size(), fresh);
  due_ = true;
  report_.increment = length;
  report_.factored_here = done_ && fresh && !part_ && rule_->negligible(length);
}

void SnesSystem::difference(const VectorXd& v, VectorXd& out) {
  const double small = std::cbrt(std::numeric_limits<double>::epsilon());
  const double step = small / std::max(v.lpNorm<Eigen::Infinity>(), 1e-300);
  const Iterate here = iterate_;
  system_->add(step * v);
  const VectorXd ahead = system_->defect();
  iterate_ = here;
  system_->add(-step * v);
  out = (system_->defect() - ahead) / (2.0 * step);
  iterate_ = here;
  system_->defect();  // its norm is asked for
}

}  // namespace windlass::equilibrium
