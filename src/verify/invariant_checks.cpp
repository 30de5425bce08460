#include "checks.hpp"

namespace windlass::verify {

using equilibrium::ArcRecord;
using equilibrium::JointKind;
using equilibrium::Solution;

namespace {

/// Range of a quantity that should be constant.
class Drift {
 public:
  void add(double value) {
    low_.add(value);
    high_.add(-value);
  }
  /// From here on another constant.
  void restart() { widest_ = value(), low_ = {}, high_ = {}; }
  double value() const { return low_.any() ? std::max(widest_, -high_.value() - low_.value()) : widest_; }

 private:
  double widest_ = 0.0;
  Smallest low_, high_;
};

}  // namespace

void check_invariants(const Solution& solution, const scene::Scene& scene, const Scales& scales,
                      CheckList& list) {
  const Stiffness law(scene.rod);
  Drift hamiltonian, torque, axial_force, twist;
  Largest free_force;
  for (std::size_t k = 0; k < solution.arcs.size(); ++k) {
    const ArcRecord& arc = solution.arcs[k];
    if (solution.joints[k].holding != 0.0)  // a force along the rod changes them
      for (Drift* drift : {&hamiltonian, &torque, &axial_force}) drift->restart();
    for (Eigen::Index i = 0; i < arc.s.size(); ++i) {
      const Section x = sample(arc, i);
      hamiltonian.add(law.hamiltonian(x) / scales.force);
      torque.add((x.m + x.r.cross(x.n)).z() / scales.force);
      axial_force.add(x.n.z() / scales.force);
      twist.add(x.m.dot(tangent(x)) / scales.moment);
      if (arc.kind == equilibrium::ArcKind::free) free_force.add((x.n - arc.n.col(0)).norm() / scales.force);
    }
  }
  list.at_most("hamiltonian_drift", hamiltonian.value(), tight, "range of H = m·u - W + n·d3, / max(B, T)");
  list.at_most("axial_torque_drift", torque.value(), tight, "range of (m + r×n)·e_z, / max(B, T)");
  list.at_most("axial_force_drift", axial_force.value(), tight, "range of n_z, / max(B, T)");
  list.at_most("free_arc_force", free_force.value(), tight, "change of n along free arcs, / max(B, T)");
  const bool isotropic =
      scene.rod.bending_stiffness == scene.rod.bending_stiffness_2 && scene.rod.natural_curvature == 0.0;
  if (isotropic) list.at_most("twist_drift", twist.value(), tight, "range of m·d3, / sqrt(B max(B, T))");
  if (!solution.has_cylinder || solution.joints.back().kind != JointKind::infinity) return;
  const double at_end = law.hamiltonian(last_section(solution.arcs.back()));
  list.at_most("infinite_tail", std::abs(at_end - solution.T) / scales.force, tight,
               "H against T, its value on an infinite tail, / max(B, T)");
}

}  // namespace windlass::verify
