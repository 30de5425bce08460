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

using Eigen::Vector3d;

/// A direction along all walls, that of e_x if it is one; nothing where there is none.
std::optional<Vector3d> along_all(const std::vector<scene::Wall>& walls) {
  constexpr double none = 1e-9;
  Eigen::MatrixXd normals(walls.size(), 3);
  for (std::size_t k = 0; k < walls.size(); ++k)
    normals.row(static_cast<Eigen::Index>(k)) = Shape::of(walls[k]).wall()->transpose();
  Eigen::FullPivLU<Eigen::MatrixXd> factors(normals);
  const Eigen::MatrixXd ways = factors.setThreshold(none).kernel();
  if (ways.isZero(none)) return std::nullopt;
  const Eigen::HouseholderQR<Eigen::MatrixXd> orthonormal(ways);
  const Eigen::MatrixXd basis = orthonormal.householderQ() * Eigen::MatrixXd::Identity(3, ways.cols());
  const Vector3d projected = basis * basis.row(0).transpose();  // of e_x
  return projected.norm() > none ? Vector3d(projected.normalized()) : Vector3d(basis.col(0));
}

/// What plates push the rod with at a joint; its ends' pushes are part of the force that they carry.
Vector3d push_of_plate(const equilibrium::JointRecord& joint, const Solution& solution,
                       const std::vector<Shape>& shapes) {
  const bool contact = joint.kind == JointKind::touch || joint.kind == JointKind::edge;
  if (!solution.has_cylinder || joint.obstacle <= 0 || !contact) return Vector3d::Zero();
  const Shape* shape = shape_of(shapes, joint.obstacle);
  return shape ? Vector3d(joint.force * shape->outward(joint.r, Vector3d::UnitX()))
               : Vector3d(Vector3d::Constant(NAN));
}

/// The virial of all contact forces about the axis: with n·t = H − m·u/2 along the rod,
/// R_tot + 2r Σ F_self = H L − E − [n·r] from end to end. Of rods without natural strains. (For long tails H is T, n·r the
/// pull times the projection of the end's place on it, and this the identity of scaling all lengths.) Stretch and weight add
/// ∫ (ε n·t − 2 w·r) ds, for λ n·t = H − w·r − m·u/2 + ε n·t/2 then, and the weight has a virial, too.
void check_scaling(const Solution& solution, const scene::Scene& scene, const Scales& scales, double virial,
                   CheckList& list) {
  const bool strained = scene.rod.natural_curvature != 0.0 || scene.rod.natural_twist != 0.0;
  if (!scene.walls.empty() || strained || solution.joints.back().kind == JointKind::infinity) return;
  const ArcRecord &first = solution.arcs.front(), &last = solution.arcs.back();
  const double length = last.s(last.s.size() - 1) - first.s(0);
  const double h = Stiffness(scene.rod).hamiltonian(last_section(last));
  const double ends = last.r.rightCols<1>().dot(last.n.rightCols<1>()) - first.r.col(0).dot(first.n.col(0));
  const double pulls = h * length - ends + virial;
  double forces = solution.R_tot + 2.0 * scene.rod_radius * solution.self_force;
  const std::vector<Shape> shapes = shapes_of(scene, 0.0);
  for (const auto& joint : solution.joints) forces += push_of_plate(joint, solution, shapes).dot(joint.r);
  const double size = std::max({scales.force, std::abs(pulls), forces, solution.energy});
  // Nothing but the mesh is in this: R_tot is asked for to model.tolerance.
  list.at_most("scaling", std::abs(forces - (pulls - solution.energy)) / size,
               std::max(tight, scene.model.tolerance),
               "R_tot + 2r (forces between strands) against H L - energy - change of n·r, relative");
}

}  // namespace

void check_invariants(const Solution& solution, const scene::Scene& scene, const Scales& scales,
                      double virial, CheckList& list) {
  const Stiffness law(scene.rod);
  Drift hamiltonian, torque, axial_force, twist;
  Largest free_force;
  // Walls push across e_z and have moments about it: the force along all of them is what is kept, if there is such a way.
  const bool walls = !scene.walls.empty(), dragged = solution.dragged;  // friction changes what it works on
  Vector3d strand_push = Vector3d::Zero();                              // of other strands, up to here
  double strand_torque = 0.0;
  const std::vector<Shape> shapes = shapes_of(scene, solution.travel_rate);
  const std::optional<Vector3d> along = walls ? along_all(scene.walls) : Vector3d(Vector3d::UnitZ());
  for (std::size_t k = 0; k < solution.arcs.size(); ++k) {
    const ArcRecord& arc = solution.arcs[k];
    if (solution.joints[k].holding != 0.0)  // a force along the rod changes them
      for (Drift* drift : {&hamiltonian, &torque, &axial_force}) drift->restart();
    if (const auto& joint = solution.joints[k]; joint.partner >= 0) {
      const Vector3d push = joint.strand_force * equilibrium::strand_direction(solution, joint);
      strand_push += push;
      strand_torque += joint.r.cross(push).z();
    }
    strand_push += push_of_plate(solution.joints[k], solution, shapes);
    // The moment of the friction at a touch of the cylinder is judged there (joint_moment).
    if (k > 0 && scene.friction_arm() > 0.0 && solution.joints[k].obstacle == 0) twist.restart();
    const bool dragged_line =
        arc.kind == equilibrium::ArcKind::line && arc.obstacle == 0 && scene.friction_arm() > 0.0;
    if (arc.s_end - arc.s_begin < tight) continue;  // vanishes at an event, and has no section of its own
    for (Eigen::Index i = 0; i < arc.s.size(); ++i) {
      const Section x = sample(arc, i);
      hamiltonian.add(law.hamiltonian(x) / scales.force);
      torque.add(((x.m + x.r.cross(x.n)).z() + strand_torque) / scales.force);
      // What the weight has taken of n up to here, and on this arc.
      const Vector3d fallen = (arc.s[i] - solution.arcs.front().s[0]) * law.weight,
                     here = (arc.s[i] - arc.s[0]) * law.weight;
      if (along) axial_force.add((x.n + strand_push + fallen).dot(*along) / scales.force);
      if (dragged_line) twist.restart();
      twist.add(x.m.dot(tangent(x)) / scales.moment);
      if (arc.kind == equilibrium::ArcKind::free)
        free_force.add((x.n + here - arc.n.col(0)).norm() / scales.force);
    }
  }
  if (!dragged)
    list.at_most("hamiltonian_drift", hamiltonian.value(), tight, "range of H = m·u - W + n·d3, / max(1, T)");
  if (!walls && !law.weighs() && solution.travel_rate == 0.0)
    list.at_most("axial_torque_drift", torque.value(), tight, "range of (m + r×n)·e_z, / max(1, T)");
  if (along && !dragged)
    list.at_most("axial_force_drift", axial_force.value(), tight,
                 walls ? "range of the force along the walls, / max(1, T)" : "range of n_z, / max(1, T)");
  list.at_most("free_arc_force", free_force.value(), tight, "change of n along free arcs, / max(1, T)");
  const bool isotropic =
      scene.rod.bending_stiffness == scene.rod.bending_stiffness_2 && scene.rod.natural_curvature == 0.0;
  if (isotropic) list.at_most("twist_drift", twist.value(), tight, "range of m·d3, / max(1, sqrt(T))");
  if (!dragged) check_scaling(solution, scene, scales, virial, list);
  if (!solution.has_cylinder || solution.joints.back().kind != JointKind::infinity) return;
  const double at_end = law.hamiltonian(last_section(solution.arcs.back()));
  list.at_most("infinite_tail", std::abs(at_end - solution.T) / scales.force, tight,
               "H against T, its value on an infinite tail, / max(1, T)");
}

}  // namespace windlass::verify
