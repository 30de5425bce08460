#pragma once

#include <memory>
#include <optional>
#include <span>

#include "windlass/equilibrium/solution.hpp"
#include "windlass/pull/dragged_rod.hpp"
#include "windlass/scene/scene.hpp"

namespace windlass::pull {

/// How a pull is stepped, and when it is on its plateau. Lengths in ρ.
struct Options {
  double step = 0.1;     ///< largest displacement a step
  double window = 0.5;   ///< displacement over which forces are averaged
  double steady = 1e-4;  ///< relative change of F from one window to the next on a plateau
  /// @throws std::invalid_argument naming the bound violated
  void validate() const;
};

/// Largest displacement unless another is asked for [ρ].
inline constexpr double usual_reach = 50.0;
/// Length of elements that are `h` under T <= 1 [ρ]: under more, bends are as short as 1/√T.
double mesh_under(double tension, double h);

/// The end of one step; natural units.
struct Row {
  double displacement = 0.0;  ///< U, of the cylinder from rest [ρ]
  double step = 0.0;          ///< of it, this step
  Measured at;
  int iterations = 0;   ///< of Newton's method
  bool jumped = false;  ///< no equilibrium was near: the rod has moved on at this displacement to another
};

/// All that the next step follows from.
struct State {
  Eigen::VectorXd unknowns, before;  ///< now, and a step earlier
  Eigen::Matrix2Xd slip;             ///< remembered by the friction
  double displacement = 0.0, last_step = 0.0, next_step = 0.0;
};

class StepSolver;

/// The setting of a sliding scene in natural units.
Setting setting_of(const scene::Scene& natural);

/// The same rod before the pull: no friction, no plate.
scene::Scene at_rest(scene::Scene scene);

/// One pull on one mesh: quasi-static steps in the displacement from a relaxed frictionless state under the plate.
///
/// Steps are equilibria at their end (`DraggedRod`); their length follows the iterations. Where there is no equilibrium
/// near the last one, however short the step, the path has come to its end and the rod jumps: at that displacement it
/// creeps against a damping that fades, friction resisting, until it is at rest again.
class Pull {
 public:
  /// @param half_length  of half the rod [ρ]
  /// @param h            length of the elements near the coil, in (0, 0.25] [ρ]
  /// @throws std::invalid_argument for bounds violated; petsc::Error if PETSc fails
  Pull(const Setting& setting, double half_length, double h, const Options& options);
  ~Pull();
  Pull(const Pull&) = delete;
  Pull& operator=(const Pull&) = delete;

  /// Lays the rod along a frictionless equilibrium, relaxes it on this mesh without friction and moves it along the axis
  /// until it just touches the plate. @return  whether Newton's method converged
  bool start(const equilibrium::Solution& frictionless);
  void resume(State state);
  const State& state() const { return state_; }
  /// One step. nullopt: no equilibrium, not even after a jump
  std::optional<Row> advance();

  const DraggedRod& rod() const { return rod_; }
  double h() const { return h_; }
  /// What the next step begins from.
  Memory memory() const;

 private:
  /// One step without friction against a damping. @return whether Newton's method converged
  bool settle(Eigen::VectorXd& unknowns, double damping, bool plates);
  bool relax(Eigen::VectorXd& unknowns);
  /// @param span  height of the rod, which has just come under the first plate [ρ]
  bool squeeze(Eigen::VectorXd& unknowns, double span);
  void accept(const Eigen::VectorXd& unknowns, const Memory& last, const Step& step);
  /// Moves on at the same displacement. @return iterations, or −1
  int jump(double advance, Row& row);

  double half_length_, h_;
  Options options_;
  DraggedRod rod_;
  std::unique_ptr<StepSolver> solver_;
  State state_;
};

/// F, mean over the last window, once the pull is on a plateau: all of the contact slips, the rod is at rest but for travel
/// along itself, and from the window before F has not changed. @return  means of drag and R_tot
struct Plateau {
  double drag = 0.0, R_tot = 0.0;  ///< [EI/ρ²]
};
std::optional<Plateau> plateau(std::span<const Row> rows, const Options& options);

}  // namespace windlass::pull
