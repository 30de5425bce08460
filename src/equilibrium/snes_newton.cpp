#include "windlass/equilibrium/snes_newton.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "windlass/petsc/handles.hpp"

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
using petsc::guard;

class SnesNewton::System {
public:
  explicit System(Index size);
  System(const System &) = delete;
  System &operator=(const System &) = delete;

  Index size() const { return size_; }
  CorrectorReport solve(Problem &problem, const Borders &borders,
                        Iterate &iterate, const Options &options);

private:
  // What PETSc calls; `context` is the System.
  static PetscErrorCode evaluate(SNES snes, Vec increment, Vec residual,
                                 void *context);
  static PetscErrorCode linearise(SNES, Vec, Mat, Mat, void *) {
    return 0;
  } // judge() has done it
  static PetscErrorCode absorb(SNES snes, PetscInt iteration);
  static PetscErrorCode judge(SNES snes, PetscInt iteration, PetscReal x_norm,
                              PetscReal step_norm, PetscReal residual_norm,
                              SNESConvergedReason *reason, void *context);
  static PetscErrorCode apply_inverse(PC pc, Vec right_side, Vec solution);
  static PetscErrorCode multiply(Mat shell, Vec in, Vec out);
  static PetscErrorCode nothing(Mat, MatAssemblyType) { return 0; }

  /// Takes the correction due at the iterate, and says whether it is the last.
  bool step(PetscInt iteration);
  /// The iterate at an increment from the base.
  void move_to(Vec increment);

  Index size_;
  petsc::SnesHandle snes_;
  petsc::VecHandle increment_vector_, residual_vector_;
  petsc::MatHandle matrix_;

  // One solve.
  BorderedSystem *system_ = nullptr;
  const Options *options_ = nullptr;
  StoppingRule *rule_ = nullptr;
  CorrectorReport report_;
  Iterate base_, iterate_;
  VectorXd increment_;  ///< of iterate_ from base_
  VectorXd defect_;     ///< at iterate_
  VectorXd correction_; ///< due there
  double first_ = 0.0;  ///< length of the first correction
  VectorXd work_, work2_;
};

SnesNewton::System::System(Index size) : size_(size) {
  const PetscInt n = static_cast<PetscInt>(size);
  check(SNESCreate(PETSC_COMM_SELF, snes_.put()));
  increment_vector_ = petsc::zero_vector(size);
  residual_vector_ = petsc::zero_vector(size);
  check(SNESSetFunction(snes_, residual_vector_, evaluate, this));
  check(SNESSetApplicationContext(snes_, this));
  check(SNESSetType(snes_, SNESNEWTONLS));
  check(SNESSetUpdate(snes_, absorb));
  check(SNESSetConvergenceTest(snes_, judge, this, nullptr));
  SNESLineSearch search = nullptr;
  check(SNESGetLineSearch(snes_, &search));
  check(SNESLineSearchSetType(search, SNESLINESEARCHBASIC));
  check(MatCreateShell(PETSC_COMM_SELF, n, n, n, n, this, matrix_.put()));
  check(MatShellSetOperation(matrix_, MATOP_MULT,
                             reinterpret_cast<void (*)()>(multiply)));
  check(MatShellSetOperation(matrix_, MATOP_ASSEMBLY_END,
                             reinterpret_cast<void (*)()>(nothing)));
  check(SNESSetJacobian(snes_, matrix_, matrix_, linearise, this));
  KSP ksp = nullptr;
  PC pc = nullptr;
  check(SNESGetKSP(snes_, &ksp));
  check(KSPSetType(ksp, KSPPREONLY));
  check(KSPGetPC(ksp, &pc));
  check(PCSetType(pc, PCSHELL));
  check(PCShellSetContext(pc, this));
  check(PCShellSetApply(pc, apply_inverse));
  check(SNESSetFromOptions(snes_));
}

CorrectorReport SnesNewton::System::solve(Problem &problem,
                                          const Borders &borders,
                                          Iterate &iterate,
                                          const Options &options) {
  base_ = iterate_ = iterate;
  BorderedSystem system(problem, borders, iterate_);
  StoppingRule rule(options);
  system_ = &system;
  rule_ = &rule;
  options_ = &options;
  report_ = {};
  increment_.resize(0);
  check(VecSet(increment_vector_, 0.0));
  check(SNESSolve(snes_, nullptr, increment_vector_));
  SNESConvergedReason reason = SNES_CONVERGED_ITERATING;
  check(SNESGetConvergedReason(snes_, &reason));
  report_.converged = reason > 0;
  if (!report_.converged && report_.failure.empty()) {
    const char *text = nullptr;
    check(SNESGetConvergedReasonString(snes_, &text));
    report_.failure = text;
  }
  report_.factorizations = system.factorizations();
  iterate = iterate_;
  return report_;
}

void SnesNewton::System::move_to(Vec increment) {
  petsc::copy(increment, work_);
  if (increment_.size() == work_.size() && increment_ == work_)
    return;
  iterate_ = base_;
  if ((work_.array() != 0.0).any())
    system_->add(work_);
  increment_ = work_;
}

PetscErrorCode SnesNewton::System::evaluate(SNES snes, Vec increment,
                                            Vec residual, void *context) {
  return guard([&] {
    System &self = *static_cast<System *>(context);
    try {
      self.move_to(increment);
      self.defect_ = self.system_->defect();
      self.work_ = -self.defect_;
      petsc::copy(self.work_, residual);
    } catch (const petsc::Error &) {
      throw;
    } catch (const std::domain_error &error) {
      self.report_.failure = std::string("outside the domain: ") + error.what();
      check(SNESSetFunctionDomainError(snes));
    } catch (const std::runtime_error &error) {
      self.report_.failure = error.what();
      check(SNESSetFunctionDomainError(snes));
    }
  });
}

PetscErrorCode SnesNewton::System::absorb(SNES snes, PetscInt) {
  return guard([&] {
    void *context = nullptr;
    Vec increment = nullptr;
    check(SNESGetApplicationContext(snes, &context));
    check(SNESGetSolution(snes, &increment));
    System &self = *static_cast<System *>(context);
    self.move_to(increment);
    self.base_ = self.iterate_;
    self.increment_.setZero();
    check(VecSet(increment, 0.0));
  });
}

bool SnesNewton::System::step(PetscInt iteration) {
  bool fresh = iteration == 0;
  if (fresh)
    system_->factor();
  correction_ = system_->solve(defect_);
  double length = system_->length(correction_);
  if (iteration == 0)
    first_ = length;
  if (iteration == 1)
    report_.contraction = length / first_;
  if (iteration > 0 && rule_->slow(length)) {
    system_->factor();
    correction_ = system_->solve(defect_);
    length = system_->length(correction_);
    fresh = true;
  }
  report_.residual = system_->residual();
  report_.increment = length;
  const bool done =
      rule_->last(length, report_.residual, system_->state_size());
  if (length > options_->newton_tolerance)
    ++report_.iterations;
  report_.factored_here = done && fresh && rule_->negligible(length);
  if (done && !report_.factored_here)
    system_->add(correction_);
  return done;
}

PetscErrorCode SnesNewton::System::judge(SNES snes, PetscInt iteration,
                                         PetscReal, PetscReal, PetscReal,
                                         SNESConvergedReason *reason,
                                         void *context) {
  return guard([&] {
    System &self = *static_cast<System *>(context);
    *reason = SNES_DIVERGED_INNER;
    try {
      const bool done = self.step(iteration);
      PetscInt most = 0;
      check(SNESGetTolerances(snes, nullptr, nullptr, nullptr, &most, nullptr));
      most = std::min<PetscInt>(most, self.options_->max_newton);
      *reason = done                ? SNES_CONVERGED_SNORM_RELATIVE
                : iteration >= most ? SNES_DIVERGED_MAX_IT
                                    : SNES_CONVERGED_ITERATING;
    } catch (const petsc::Error &) {
      throw;
    } catch (const std::domain_error &error) {
      self.report_.failure = std::string("outside the domain: ") + error.what();
    } catch (const std::runtime_error &error) {
      self.report_.failure = error.what();
    }
  });
}

PetscErrorCode SnesNewton::System::apply_inverse(PC pc, Vec right_side,
                                                 Vec solution) {
  return guard([&] {
    System *self = nullptr;
    check(PCShellGetContext(pc, &self));
    petsc::copy(right_side, self->work_);
    // Mostly the residual, for which the correction is known.
    const bool known = self->work_ == -self->defect_;
    self->work_ = known ? VectorXd(-self->correction_)
                        : self->system_->solve(self->work_);
    petsc::copy(self->work_, solution);
  });
}

PetscErrorCode SnesNewton::System::multiply(Mat shell, Vec in, Vec out) {
  return guard([&] {
    System *self = nullptr;
    check(MatShellGetContext(shell, &self));
    petsc::copy(in, self->work_);
    // A line search asks for J·δ, which is the residual; other solvers than
    // KSPPREONLY ask for more.
    if (self->work_ == -self->correction_) {
      self->work_ = -self->defect_;
    } else {
      constexpr double small = 1e-6;
      const Iterate here = self->iterate_;
      const VectorXd v = self->work_;
      const double step = small / std::max(v.lpNorm<Eigen::Infinity>(), 1e-300);
      self->system_->add(step * v);
      const VectorXd ahead = self->system_->defect();
      self->iterate_ = here;
      self->system_->add(-step * v);
      self->work_ = (self->system_->defect() - ahead) / (2.0 * step);
      self->iterate_ = here;
    }
    petsc::copy(self->work_, out);
  });
}

SnesNewton::SnesNewton() = default;
SnesNewton::~SnesNewton() = default;

CorrectorReport SnesNewton::solve(Problem &problem, const Borders &borders,
                                  Iterate &iterate, const Options &options) {
  const Index size = problem.size() + borders.c.cols();
  std::unique_ptr<System> *kept = nullptr;
  for (auto &system : systems_)
    if (system && system->size() == size)
      kept = &system;
  if (!kept) {
    kept = &systems_[next_];
    next_ = 1 - next_;
    *kept = std::make_unique<System>(size);
  }
  try {
    return (*kept)->solve(problem, borders, iterate, options);
  } catch (...) {
    kept->reset(); // PETSc's objects may be left locked in the middle of a
                   // solve
    throw;
  }
}

} // namespace windlass::equilibrium
