#include "windlass/equilibrium/solution.hpp"

namespace windlass::equilibrium {

namespace {

void multiply(ArcRecord& arc, const scene::Units& units) {
  arc.s_begin *= units.length;
  arc.s_end *= units.length;
  arc.s *= units.length;
  arc.r *= units.length;
  arc.force *= units.force;
  arc.plate_force *= units.force;
  arc.n *= units.force;
  arc.m *= units.moment;
  arc.p *= units.pressure;
}

void multiply(JointRecord& joint, const scene::Units& units) {
  joint.s *= units.length;
  joint.z *= units.length;
  joint.r *= units.length;
  joint.force *= units.force;
  joint.plate_force *= units.force;
  joint.holding *= units.force;
  joint.strand_force *= units.force;
}

}  // namespace

void multiply(Solution& solution, const scene::Units& units) {
  for (ArcRecord& arc : solution.arcs) multiply(arc, units);
  for (JointRecord& joint : solution.joints) multiply(joint, units);
  solution.T *= units.force;
  solution.R_tot *= units.force;
  solution.self_force *= units.force;
  if (solution.F0) *solution.F0 *= units.force;
  solution.plate_force *= units.force;
  solution.pull_difference *= units.force;
  solution.end_force *= units.force;
  solution.end_moment *= units.moment;
  solution.energy *= units.energy;
  solution.weight_energy *= units.energy;
  solution.z_span *= units.length;
  if (solution.self_distance) *solution.self_distance *= units.length;
  for (double& s : solution.self_s) s *= units.length;
  solution.invariants.hamiltonian_drift *= units.force;
  solution.invariants.axial_torque_drift *= units.moment;
  solution.invariants.force_residual *= units.force;
  if (solution.stability) multiply(*solution.stability, units);
}

void multiply(Stability& stability, const scene::Units& units) {
  for (double& eigenvalue : stability.eigenvalues) eigenvalue *= units.force;
  for (std::complex<double>& eigenvalue : stability.leading) eigenvalue *= units.force;
  stability.sliding *= units.pressure;
  for (Mode& mode : stability.modes) {
    mode.eigenvalue *= units.force;
    mode.s *= units.length;
  }
}

}  // namespace windlass::equilibrium
