#pragma once

#include "windlass/equilibrium/newton.hpp"
#include "windlass/petsc/handles.hpp"

namespace windlass::equilibrium {

/// SNES and the chain it looks at, for one number of unknowns.
class NewtonSolver::System {
 public:
  System(Eigen::Index size, const NewtonOptions& options);
  System(const System&) = delete;
  System& operator=(const System&) = delete;

  bool fits(const chain::Chain& chain, const NewtonOptions& options) const;
  NewtonResult solve(chain::Chain& chain, Eigen::VectorXd& x, const contact::Loads& loads);

 private:
  // What PETSc calls; `context` is the System.
  static PetscErrorCode evaluate(SNES snes, Vec increment, Vec residual, void* context);
  static PetscErrorCode linearise(SNES snes, Vec increment, Mat operator_matrix, Mat preconditioner,
                                  void* context);
  static PetscErrorCode absorb(SNES snes, PetscInt iteration);
  static PetscErrorCode judge(SNES snes, PetscInt iteration, PetscReal x_norm, PetscReal step_norm,
                              PetscReal residual_norm, SNESConvergedReason* reason, void* context);
  static PetscErrorCode apply_inverse(PC pc, Vec right_side, Vec solution);
  static PetscErrorCode multiply(Mat shell, Vec in, Vec out);

  void create_matrix();  ///< the shell round the chain's own solver
  void choose_lu();
  void assemble();  ///< chain.jacobian() at the base
  /// base := retract(base, δ), δ := 0.
  void rebase(Vec increment);
  /// Factors the chain's matrix at the base; false, with the reason kept, if it is singular.
  bool factor();
  /// Measures residual and increment still due where SNES stopped; true if they are accepted.
  bool measure();
  /// Increment still due, J⁻¹ residual, from the last factorisation.
  void measure_increment(const Eigen::VectorXd& residual);
  bool accepted() const;
  /// Is the residual all rounding, though the increment is above its tolerance?
  bool nothing_left() const;

  Eigen::Index size_;
  NewtonOptions options_;
  bool assembled_ = false;
  petsc::SnesHandle snes_;
  petsc::VecHandle increment_vector_, residual_vector_;
  petsc::MatHandle matrix_;

  chain::Chain* chain_ = nullptr;
  const contact::Loads* loads_ = nullptr;
  Eigen::VectorXd base_, delta_, value_, solution_;
  Eigen::VectorXd trial_increment_, trial_;  ///< where the residual was last evaluated
  double scale_ = 1.0, residual_ = 0.0, increment_ = 0.0;
  double residual_tolerance_ = 0.0, increment_tolerance_ = 0.0;
  bool factored_ = false;  ///< the chain holds a factorisation made in this solve
  bool started_ = false;   ///< the residual at the starting state exists
  std::string failure_;    ///< why the matrix could not be factored

  // The product J·v PETSc's line search asks for is the right-hand side it has just solved for.
  Eigen::VectorXd solved_, solved_for_;
};

}  // namespace windlass::equilibrium
