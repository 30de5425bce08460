#pragma once

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <complex>
#include <optional>
#include <string>
#include <vector>

#include "windlass/scene/scene.hpp"

/// One computed equilibrium as a plain value: what is written to disk, plotted, and checked.
///
/// Everything is dimensionless (PHYSICS: ρ = 1, EI = 1) and in the world frame; the cylinder's axis is e_z.
/// The whole rod is described, both halves, also when only half of it was solved. A planar rod lies in z = 0.
namespace windlass::equilibrium {

enum class ArcKind { free, line };  ///< printed as "gap"/"tail" (free) or "line"
enum class JointKind {
  end,
  touch,
  edge,
  infinity,
  strand  ///< touches another strand of the rod, and no obstacle
};        ///< infinity: start of a closed-form infinite tail's far end

/// One stretch of rod in one contact state, sampled at its mesh nodes.
///
/// Shapes: s (N), r (3×N), q (4×N as w,x,y,z; unit; body→world, d3 = tangent), n (3×N), m (3×N), p (N).
/// n on a line arc is the internal force, which varies along it; on a free arc all columns are equal.
struct ArcRecord {
  ArcKind kind = ArcKind::free;
  std::string role;                   ///< "tail", "gap" or "line"
  double s_begin = 0.0, s_end = 0.0;  ///< material arclength, s = 0 at the mid-point [ρ]
  double force = 0.0;                 ///< line: ∫ p ds [EI/ρ²]; free: 0
  int obstacle = -1;                  ///< line: the obstacle it lies on, its place in the scene
  double plate_force = 0.0;  ///< line on a plate, too: what that carries [EI/ρ²]; not kept in run folders
  Eigen::VectorXd s;
  Eigen::Matrix3Xd r;
  Eigen::Matrix4Xd q;
  Eigen::Matrix3Xd n;
  Eigen::Matrix3Xd m;
  Eigen::VectorXd p;  ///< contact force per length, 0 on free arcs [EI/ρ³]
};

struct JointRecord {
  JointKind kind = JointKind::end;
  double s = 0.0;                               ///< [ρ]
  double angle = 0.0;                           ///< place round the axis, unrolled, 0 at the south pole [rad]
  double z = 0.0;                               ///< [ρ]
  double force = 0.0;                           ///< size of the contact point force, >= 0 [EI/ρ²]
  Eigen::Vector3d r = Eigen::Vector3d::Zero();  ///< position [ρ]
  int obstacle = -1;                            ///< of a contact, its place in the scene
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< of a contact: the direction of its force on the rod
  /// Force along the circumference that holds the rod against sliding along itself [EI/ρ²], at the outermost contacts: zero
  /// to rounding at an equilibrium. What is not is no equilibrium, and the certificate fails.
  double holding = 0.0;
  /// Of a contact with another strand (a touch may have one, too): that strand's joint, its place in Solution::joints, and the
  /// size of the force between them, along the line between their places.
  int partner = -1;
  double strand_force = 0.0;
  double plate_force = 0.0;  ///< of a plate at the same place [EI/ρ²]; not kept in run folders
  /// Is it one of the touches that a line between strands consists of? Not kept in run folders.
  bool along_strand = false;
  Eigen::Vector3d holding_direction() const { return {std::cos(angle), std::sin(angle), 0.0}; }
};

struct Invariants {
  double hamiltonian_drift = 0.0;   ///< max |H - H(first sample)| along the rod
  double axial_torque_drift = 0.0;  ///< max drift of (m + r×n)·e_z
  double force_residual = 0.0;      ///< |sum of end pulls and contact forces|
};

struct Mesh {
  int elements = 0;
  int stages = 0;
  int unknowns = 0;
};

struct Mode {
  double eigenvalue = 0.0;
  std::string plane;              ///< "in" or "out"
  std::string parity;             ///< "even" or "odd" under the half-turn
  Eigen::VectorXd s;              ///< N
  Eigen::Matrix3Xd displacement;  ///< 3×N, largest entry 1
};

struct Stability {
  int index = 0;                    ///< number of negative eigenvalues (SLEPc and inertia agree)
  int inertia_index = 0;            ///< the second opinion, from the factorisation
  std::vector<double> eigenvalues;  ///< lowest first
  /// Index and eigenvalues are those of the rod held against sliding along itself; this judges the slide: d²Π/dδ² [EI/ρ³].
  double sliding = 0.0;
  bool degenerate = false;  ///< a contact carries zero force to within tolerance
  std::vector<Mode> modes;
  /// Of a dragged state, whose load has no potential: eigenvalues of (K, metric), the least real part first.
  std::vector<std::complex<double>> leading;
};

/// Opaque restart data: enough to rebuild the discrete problem and its unknowns exactly.
struct Restart {
  std::string chain;      ///< serialised chain description (topology, meshes), JSON text
  Eigen::VectorXd state;  ///< the discrete unknowns
};

struct Solution {
  double T = 0.0, phi = 0.0;
  std::string model;  ///< rung: "closed_form", "planar", "kirchhoff_half", "kirchhoff_full"
  std::string model_reason;
  bool converged = false;
  int newton_iterations = 0;

  bool has_cylinder = true;
  double R_tot = 0.0;        ///< sum of sizes of all contact forces, pressure integrated; without a plate's
  std::optional<double> F0;  ///< mu R_tot, where the scene has mu
  double plate_force = 0.0;  ///< sum of the sizes of the plate's forces [EI/ρ²]
  /// The cylinder slips along the rod: F0 is then mu Σ N d_z of this state, and one of the two is an unknown of it.
  bool dragged = false;
  double travel_rate = 0.0;      ///< ω: the rod runs along itself at ω times the cylinder's speed
  double pull_difference = 0.0;  ///< τ: the pulls are T ± τ [EI/ρ²]
  double phi_star = 0.0;         ///< half the angle between the outermost contacts [rad]
  double tilt = 0.0;             ///< inclination of the mid-point tangent to the plane z = 0 [rad]
  double z_span = 0.0;           ///< max z - min z over the rod [ρ]
  double energy = 0.0;           ///< of bending, twisting and stretching [EI/ρ]
  double stretch = 0.0;          ///< largest |ε| of a rod that stretches [-]
  double weight_energy = 0.0;    ///< −∫ w·r ds of its weight [EI/ρ]; not kept in run folders
  /// Closest approach of the rod to itself, see chain::self_distance [ρ]; empty where it nowhere comes back to itself.
  std::optional<double> self_distance;
  std::array<double, 2> self_s = {0.0, 0.0};  ///< between these places
  double self_force = 0.0;                    ///< sum of the sizes of the forces between strands [EI/ρ²]
  // struts (no cylinder)
  double end_force = 0.0;   ///< thrust positive
  double end_moment = 0.0;  ///< axial end moment
  double shortening = 0.0;  ///< end shortening / length

  std::string topology;             ///< e.g. "tail edge line edge tail"
  std::vector<ArcRecord> arcs;      ///< from s = -L/2 to L/2
  std::vector<JointRecord> joints;  ///< in the same order; joints.size() == arcs.size() + 1
  std::optional<Stability> stability;
  Invariants invariants;
  double error_estimate = 0.0;  ///< relative, of R_tot (strut: of end_force)
  Mesh mesh;
  double seconds_solve = 0.0, seconds_stability = 0.0, seconds_total = 0.0;
  Restart restart;
};

/// Direction of the force of the other strand at a joint that touches one.
Eigen::Vector3d strand_direction(const Solution& solution, const JointRecord& joint);

/// The same state in other units: every quantity multiplied by its unit. `restart` stays: it is the solver's own.
void multiply(Solution& solution, const scene::Units& units);
void multiply(Stability& stability, const scene::Units& units);

}  // namespace windlass::equilibrium
