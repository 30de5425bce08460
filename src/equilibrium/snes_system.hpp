#pragma once

#include <optional>
#include <stdexcept>
#include <string>

#include "windlass/equilibrium/snes_newton.hpp"
#include "windlass/petsc/handles.hpp"

namespace windlass::equilibrium {

/// PETSc's objects for one number of unknowns, and the bordered system they look at.
class SnesSystem {
 public:
  explicit SnesSystem(Eigen::Index size);
  SnesSystem(const SnesSystem&) = delete;
  SnesSystem& operator=(const SnesSystem&) = delete;

  Eigen::Index size() const { return size_; }
  bool busy() const { return system_ != nullptr; }
  /// @param part  of each correction; null: corrections are taken whole
  continuation::CorrectorReport solve(continuation::Problem& problem, const continuation::Borders& borders,
                                      continuation::Iterate& iterate, const continuation::Options& options,
                                      const SnesNewton::Part* part);

 private:
  // What PETSc calls; `context` is the SnesSystem.
  static PetscErrorCode evaluate(SNES snes, Vec increment, Vec residual, void* context);
  static PetscErrorCode linearise(SNES, Vec, Mat, Mat, void*) { return 0; }  // due() has done it
  static PetscErrorCode absorb(SNES snes, PetscInt iteration);
  static PetscErrorCode judge(SNES snes, PetscInt iteration, PetscReal x_norm, PetscReal step_norm,
                              PetscReal residual_norm, SNESConvergedReason* reason, void* context);
  static PetscErrorCode shorten(SNESLineSearch search, Vec increment, Vec step, PetscBool* changed,
                                void* context);
  static PetscErrorCode apply_inverse(PC pc, Vec right_side, Vec solution);
  static PetscErrorCode multiply(Mat shell, Vec in, Vec out);
  static PetscErrorCode nothing(Mat, MatAssemblyType) { return 0; }

  void create_solver();
  /// The options of this solve, with what the user says to PETSc in place of their own.
  const continuation::Options& with_users(const continuation::Options& options);
  /// The iterate at an increment from the base.
  void move_to(Vec increment);
  /// The correction due at the iterate, and what the stopping rule says of it.
  void find_correction();
  /// In the metric of the problem; from a far guess all unknowns count, those too that the metric leaves out.
  double length_of_correction() const;
  /// J v by a central difference.
  void difference(const Eigen::VectorXd& v, Eigen::VectorXd& out);
  /// Runs f; what the problem throws becomes the failure of the solve. @returns whether it threw nothing
  template <class F>
  bool reported(F&& f);

  const Eigen::Index size_;
  petsc::SnesHandle snes_;
  petsc::VecHandle increment_vector_, residual_vector_;
  petsc::MatHandle matrix_;
  std::optional<double> residual_tolerance_, increment_tolerance_;  ///< the user's
  std::optional<int> most_;

  // One solve.
  continuation::BorderedSystem* system_ = nullptr;
  continuation::StoppingRule* rule_ = nullptr;
  const SnesNewton::Part* part_ = nullptr;
  continuation::CorrectorReport report_;
  continuation::Iterate base_, iterate_;
  Eigen::VectorXd increment_;   ///< of iterate_ from base_
  Eigen::VectorXd defect_;      ///< at iterate_
  Eigen::VectorXd correction_;  ///< due there
  bool inside_ = false;         ///< F exists at iterate_
  bool due_ = false;            ///< correction_ is that of iterate_
  bool done_ = false;           ///< and the last one
  int corrections_ = 0, most_corrections_ = 0;
  double first_ = 0.0, first_residual_ = 0.0;  ///< of the first correction
  Eigen::VectorXd work_;
  continuation::Options own_;  ///< where the user's words change them
};

template <class F>
bool SnesSystem::reported(F&& f) {
  try {
    f();
    return true;
  } catch (const petsc::Error&) {
    throw;
  } catch (const std::domain_error& error) {
    report_.failure = std::string("outside the domain: ") + error.what();
  } catch (const std::runtime_error& error) {
    report_.failure = error.what();
  }
  return false;
}

}  // namespace windlass::equilibrium
