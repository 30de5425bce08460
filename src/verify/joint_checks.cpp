#include <algorithm>
#include <cmath>
#include <numbers>

#include "checks.hpp"

namespace windlass::verify {

using Eigen::Vector3d;
using equilibrium::ArcKind;
using equilibrium::ArcRecord;
using equilibrium::JointKind;
using equilibrium::JointRecord;
using equilibrium::Solution;

namespace {

/// A strand pulls a joint between two parts of a line off the obstacle by a point force: a beam of EI = 1, pressed by p beside,
/// rises by (3/4)⁴ F⁴/72p³. Where that is no height at all the line stands for it.
double judged(const JointRecord& joint, const ArcRecord& before, const ArcRecord& after,
              const Scales& scales) {
  if (joint.force >= 0.0 || before.kind != ArcKind::line || after.kind != ArcKind::line)
    return joint.force / scales.force;
  const double pressure = std::min(before.p(before.p.size() - 1), after.p(0));
  const double height = std::pow(0.75 * joint.force, 4) / (72.0 * std::pow(pressure, 3));
  return pressure > 0.0 && height < tight ? 0.0 : joint.force / scales.force;
}

/// Strands that touch along a line do so at places that divide it (see chain/coupling.hpp): there they need not be nearest. What
/// counts is how much nearer they can be half way to a neighbouring touch. 1 elsewhere.
double distance_that_counts(const Solution& solution, std::size_t k) {
  const auto& joints = solution.joints;
  const auto other = [&](std::size_t a) { return joints[static_cast<std::size_t>(joints[a].partner)].s; };
  // The next touch of the same two strands: others, and edges, may be between.
  constexpr double at_most = 0.1, rates = 4.0;
  const auto reach = [&](int step) {
    const int count = static_cast<int>(joints.size());
    for (int at = static_cast<int>(k) + step; at >= 0 && at < count; at += step) {
      const auto a = static_cast<std::size_t>(at);
      const double distance = std::abs(joints[a].s - joints[k].s);
      const bool next = joints[a].partner >= 0 && std::abs(joints[a].partner - joints[k].partner) == 1;
      if (next && at == static_cast<int>(k) + step) return distance;
      if (distance > at_most) return HUGE_VAL;
      if (joints[a].partner >= 0 && std::abs(other(a) - other(k)) < rates * distance) return distance;
    }
    return HUGE_VAL;
  };
  const double farther = std::max(reach(-1), reach(1));
  return std::isinf(farther) ? 1.0 : 0.5 * farther;
}

/// Inside a line between strands a touch may pull with what would open them, over the span h to its neighbours by Fh³/12, by a height
/// that costs no energy: beside the edge of a line on the cylinder, whose point force pushes a strand off the other, by 4e-9.
constexpr double opened = 1e-8;
double judged_between(const Solution& solution, std::size_t k, const Scales& scales) {
  const double force = solution.joints[k].strand_force, span = distance_that_counts(solution, k);
  return force < 0.0 && span < 1.0 && -force * 8.0 * span * span * span / 12.0 < opened
             ? 0.0
             : force / scales.force;
}

/// What such a touch pulls, the strand's obstacle bears in part: a pull, too, that lifts the strand off it by less than
/// that height. Elsewhere as it is judged without a strand.
double judged_under_strand(const Solution& solution, std::size_t k, const Scales& scales) {
  const JointRecord& joint = solution.joints[k];
  const double span = joint.partner >= 0 ? distance_that_counts(solution, k) : 1.0;
  const bool borne = joint.force < 0.0 && joint.strand_force < 0.0 && span < 1.0 &&
                     -joint.force * 8.0 * span * span * span / 12.0 < tight;
  return borne ? 0.0 : judged(joint, solution.arcs[k - 1], solution.arcs[k], scales);
}

/// Is an arc a line on the cylinder that lies in the plate, too?
bool lines_on_plate(const ArcRecord& arc, const scene::Scene& scene) {
  return arc.kind == ArcKind::line && on_plate(arc, scene);
}

}  // namespace

void check_joints(const Solution& solution, const scene::Scene& scene, const Scales& scales,
                  CheckList& list) {
  const std::vector<Shape> shapes = shapes_of(scene, solution.travel_rate);
  const Stiffness law(scene.rod);
  Largest position, frame, moment, force, surface, tangency, holding, apart, along;
  Smallest contact, between;
  for (std::size_t k = 0; k < solution.joints.size(); ++k) {
    const JointRecord& joint = solution.joints[k];
    const bool in_contact = joint.kind == JointKind::touch || joint.kind == JointKind::edge;
    holding.add(std::abs(joint.holding) / scales.force);
    if (in_contact) {
      const bool inside = k > 0 && k + 1 < solution.joints.size();
      contact.add(inside ? judged_under_strand(solution, k, scales) : joint.force / scales.force);
    }
    if (joint.kind == JointKind::end && joint.obstacle > 0) {  // on a plate
      const Shape* shape = shape_of(shapes, joint.obstacle);
      contact.add(joint.force / scales.force);
      surface.add(shape ? std::abs(shape->gap(joint.r)) : NAN);
    }
    if (joint.partner >= 0) between.add(judged_between(solution, k, scales));
    if (k == 0 || k + 1 == solution.joints.size()) continue;
    const Section before = last_section(solution.arcs[k - 1]), after = first_section(solution.arcs[k]);
    position.add((before.r - after.r).norm());
    position.add((joint.r - after.r).norm());
    frame.add(frame_distance(before.q, after.q));
    Vector3d turn = after.m - before.m;
    Vector3d jump = after.n - before.n + joint.holding * joint.holding_direction();
    if (in_contact) {
      const Shape* shape = shape_of(shapes, joint.obstacle);
      // balance of the joint: n(after) - n(before) + f N = 0
      const Vector3d outward =
          shape ? shape->outward(after.r, tangent(after)) : Vector3d(Vector3d::Constant(NAN));
      if (shape) {
        const ArcRecord &left = solution.arcs[k - 1], &right = solution.arcs[k];
        const bool held = lines_on_plate(left, scene) || lines_on_plate(right, scene) ||
                          (on_plate(left, scene) && on_plate(right, scene));
        // Friction along a rod that stretches changes the stretch: at a point it slips with the mean of the two.
        const Vector3d slope = 0.5 * (law.stretch(before) + law.stretch(after)) * tangent(after);
        const double curvature = after.m.z() / (scene.rod.bending_stiffness * law.stretch(after));
        jump += joint.force * (held ? shape->beside_plate(curvature) : *shape).push(after.r, slope);
        turn += joint.force * shape->couple(after.r, slope);
      }
      surface.add(shape ? std::abs(shape->gap(after.r)) : NAN);
      tangency.add(std::abs(outward.dot(tangent(after))));
    }
    if (joint.partner >= 0) {
      const Vector3d e = equilibrium::strand_direction(solution, joint);
      const JointRecord& other = solution.joints[static_cast<std::size_t>(joint.partner)];
      Vector3d push = joint.strand_force * e;
      const ArcRecord &left = solution.arcs[k - 1], &right = solution.arcs[k];
      if (joint.obstacle == 0 && on_plate(left, scene) && on_plate(right, scene) &&
          (lines_on_plate(left, scene) || lines_on_plate(right, scene))) {  // it takes what is towards it
        const double side = scene.plate->side == scene::PlateSide::above ? 1.0 : -1.0;
        push.z() = side * std::min(side * push.z(), 0.0);
      }
      jump += push;
      apart.add(std::abs((joint.r - other.r).norm() - 2.0 * scene.rod_radius));
      apart.add(std::abs(joint.strand_force - other.strand_force) / scales.force);
      along.add(std::abs(e.dot(tangent(after))) * distance_that_counts(solution, k));
    }
    force.add(jump.norm() / scales.force);
    moment.add(turn.norm() / scales.moment);
  }
  if (between.any()) {
    list.at_least("strand_force", between.value(), -tight, "smallest force between strands, / max(1, T)");
    list.at_most("strand_contact", apart.value(), tight,
                 "distance of touching strands against 2 rod.radius, and their forces against each other");
    list.at_most("strand_tangency", along.value(), tight,
                 "slope to each other of strands that touch; inside a line of theirs: times half the "
                 "distance to the next touch");
  }
  if (scene.self_contact && solution.self_distance)
    list.at_least("self_distance", *solution.self_distance - 2.0 * scene.rod_radius, -tight,
                  "closest approach of the rod to itself less 2 rod.radius");
  list.at_most("joint_position", position.value(), tight,
               "jump of r at joints, and against the joint's own r");
  list.at_most("joint_frame", frame.value(), tight, "jump of q at joints");
  list.at_most("joint_moment", moment.value(), tight,
               scene.friction_arm() > 0.0
                   ? "jump of m plus the friction's moment at joints, / max(1, sqrt(T))"
                   : "jump of m at joints, / max(1, sqrt(T))");
  list.at_most("joint_force", force.value(), tight,
               "jump of n plus contact and holding force at joints, / max(1, T)");
  list.at_most("holding", holding.value(), tight,
               "force that holds the rod against sliding along itself, / max(1, T): no equilibrium with it");
  if (!contact.any()) return;
  list.at_least("point_force", contact.value(), -tight,
                "smallest contact point force, / max(1, T), but for pulls that lift the rod off a line by "
                "less than 1e-9");
  list.at_most("contact_position", surface.value(), tight,
               "distance of touches and edges from their obstacles");
  list.at_most("tangency", tangency.value(), tight, "slope to the obstacle at touches and edges");
}

namespace {

/// One end of the rod: the section there, the pull that acts on it, and what sign n has.
struct End {
  const JointRecord& joint;
  Section section;
  Vector3d pull;  // external force on the end
  double side;    // +1 at s = L/2, where n = pull; -1 at s = -L/2, where n = -pull
  scene::EndKind kind;
};

/// The frame of a clamped end: tangent along the pull and no turn about it from the planar frame, d2 = -e_z.
double clamp_error(const End& end) {
  const Eigen::Matrix3d d = rotation(end.section.q);
  const Vector3d along = end.side * end.pull.normalized();
  return std::max((d.col(2) - along).norm(), (d.col(1) + Vector3d::UnitZ()).norm());
}

/// What a universal joint of the axes e_z and d1 leaves free of moment; and d1, which stays normal to e_z.
double jointed_moment(const End& end) {
  const Vector3d d1 = rotation(end.section.q).col(0);
  return std::max(std::abs(end.section.m.dot(d1)), std::abs(end.section.m.z()));
}
double spin_error(const End& end) { return std::abs(rotation(end.section.q)(2, 0)); }

/// Distance of an end from the line that its slider moves along: parallel to the pull, at that distance from the axis on the side
/// where a coil leaves, and at the plate's height.
double guide_error(const End& end, const scene::Scene& scene) {
  const Vector3d along = end.pull.normalized(), outward = end.side * along.cross(Vector3d::UnitZ());
  const double height = scene.plate ? scene.plate->height : 0.0;
  return std::max(std::abs(end.section.r.dot(outward) - scene.ends.guide_offset),
                  std::abs(end.section.r.z() - height));
}

void check_capstan_ends(const End (&ends)[2], const scene::Scene& scene, const Scales& scales,
                        CheckList& list) {
  const std::vector<Shape> shapes = shapes_of(scene, 0.0);
  Largest pull, moment, clamp, spin, guide;
  for (const End& end : ends) {
    const Shape* plate = end.joint.obstacle > 0 ? shape_of(shapes, end.joint.obstacle) : nullptr;
    Vector3d off = end.side * end.section.n - end.pull;
    if (plate) off -= end.joint.force * plate->outward(end.section.r, tangent(end.section));
    // A slider takes what is across its line.
    pull.add((scene.ends.guided() ? std::abs(off.dot(end.pull.normalized())) : off.norm()) / scales.force);
    if (scene.ends.guided()) guide.add(guide_error(end, scene));
    if (end.joint.kind == JointKind::infinity) continue;
    if (end.kind == scene::EndKind::clamped) {
      clamp.add(clamp_error(end));
    } else if (end.kind == scene::EndKind::spin_held) {
      spin.add(spin_error(end));
      moment.add(jointed_moment(end) / scales.moment);
    } else {
      moment.add(end.section.m.norm() / scales.moment);
    }
  }
  list.at_most("end_pull", pull.value(), tight, "internal force at the ends against the pulls, / max(1, T)");
  if (moment.any())
    list.at_most("end_moment", moment.value(), tight, "moment that the ends are free of, / max(1, sqrt(T))");
  if (guide.any())
    list.at_most("end_guide", guide.value(), tight, "distance of ends on sliders from their lines");
  if (spin.any()) list.at_most("end_spin", spin.value(), tight, "d1 of ends that cannot spin, along e_z");
  if (clamp.any())
    list.at_most("end_clamp", clamp.value(), tight, "frame of clamped ends against the pull and the plane");
}

void check_strut_ends(const End (&ends)[2], const Scales& scales, CheckList& list) {
  Largest moment, clamp;
  for (const End& end : ends) {
    if (end.kind == scene::EndKind::clamped)
      clamp.add((tangent(end.section) - Vector3d::UnitX()).norm());
    else
      moment.add(end.section.m.norm() / scales.moment);
  }
  if (moment.any()) list.at_most("end_moment", moment.value(), tight, "moment at pinned ends");
  if (clamp.any()) list.at_most("end_clamp", clamp.value(), tight, "tangent of clamped ends against e_x");
}

}  // namespace

void check_ends(const Solution& solution, const scene::Scene& scene, const Scales& scales, CheckList& list) {
  const Vector3d right(std::cos(solution.phi / 2), std::sin(solution.phi / 2), 0.0);
  const Vector3d left(-right.x(), right.y(), 0.0);
  const double difference = solution.pull_difference;
  const End ends[2] = {{solution.joints.front(), first_section(solution.arcs.front()),
                        (solution.T - difference) * left, -1.0, scene.ends.left_kind()},
                       {solution.joints.back(), last_section(solution.arcs.back()),
                        (solution.T + difference) * right, 1.0, scene.ends.right_kind()}};
  if (solution.has_cylinder) {
    check_capstan_ends(ends, scene, scales, list);
  } else {
    check_strut_ends(ends, scales, list);
  }
}

namespace {

/// Of the forces on the two ends, along e_z: what sliders push with, and plates that the ends touch.
double axial_push(const Solution& solution) {
  return last_section(solution.arcs.back()).n.z() - first_section(solution.arcs.front()).n.z();
}

/// What the plates push the rod down with, those that its ends touch left out: of all their forces, which are reported as one sum of
/// sizes, those of plates below it count against the others.
double push_of_plates(const Solution& solution, const std::vector<Shape>& shapes) {
  double sum = solution.plate_force;
  for (std::size_t k = 0; k < solution.joints.size(); ++k) {
    const JointRecord& joint = solution.joints[k];
    const bool end = joint.kind == JointKind::end;
    if (joint.obstacle <= 0 || joint.kind == JointKind::strand) continue;
    const Shape* shape = shape_of(shapes, joint.obstacle);
    const Section at =
        k < solution.arcs.size() ? first_section(solution.arcs[k]) : last_section(solution.arcs.back());
    const double up = shape ? shape->outward(at.r, tangent(at)).z() : NAN;
    if (up > 0.0) sum -= 2.0 * joint.force * up;
    if (end) sum += joint.force * up;
  }
  return sum;
}

}  // namespace

void check_totals(const Solution& solution, const scene::Scene& scene, const Scales& scales,
                  CheckList& list) {
  if (scene.rod.infinite()) {
    const auto finite = std::count_if(solution.joints.begin(), solution.joints.end(),
                                      [](const auto& joint) { return joint.kind == JointKind::end; });
    list.at_most("rod_length", static_cast<double>(finite), 0.0, "ends of an infinite rod that are not");
  } else {
    const double length =
        solution.arcs.back().s[solution.arcs.back().s.size() - 1] - solution.arcs.front().s[0];
    list.at_most("rod_length", std::abs(length / scene.rod.length - 1.0), tight,
                 "length of the stored rod against the scene's, relative");
  }
  double sum = 0.0, first = 0.0, last = 0.0;
  bool any = false;
  for (const ArcRecord& arc : solution.arcs)
    if (!solution.has_cylinder || arc.obstacle <= 0) sum += arc.force;  // not a plate's
  for (const JointRecord& joint : solution.joints) {
    if (joint.kind != JointKind::touch && joint.kind != JointKind::edge) continue;
    if (solution.has_cylinder && joint.obstacle > 0) continue;  // a plate's
    sum += joint.force;
    if (!any) first = joint.angle;
    last = joint.angle;
    any = true;
  }
  if (any)
    list.at_most("total_contact_force", std::abs(sum - solution.R_tot) / std::max(scales.force, sum), tight,
                 "reported R_tot against the sum of all contact forces, / max(1, T, R_tot)");
  if (!solution.has_cylinder) {
    const Section end = last_section(solution.arcs.back());
    list.at_most("end_force", std::abs(solution.end_force + end.n.x()) / scales.force, tight,
                 "reported thrust against -n·e_x at the end, / max(1, thrust)");
    const double length = solution.arcs.back().s_end - solution.arcs.front().s_begin;
    const double chord = (end.r - first_section(solution.arcs.front()).r).x();
    list.at_most("shortening", std::abs(solution.shortening - (1.0 - chord / length)), tight,
                 "reported shortening against the distance of the ends along e_x");
    return;
  }
  list.at_most("load",
               std::max(std::abs(solution.T - scene.load.tension) / scales.force,
                        std::abs(solution.phi - scene.load.angle)),
               tight, "stored T and phi against those of the scene, T / max(1, T)");
  if (solution.dragged)
    list.at_most(
        "axial_balance",
        std::abs(solution.F0.value_or(NAN) - push_of_plates(solution, shapes_of(scene, 0.0)) +
                 axial_push(solution)) /
            scales.force,
        tight,
        "reported F0, what the cylinder drags with, against what plates and sliders carry, / max(1, T)");
  if (any) {
    list.at_most("contact_angle", std::abs(0.5 * (last - first) - solution.phi_star), tight,
                 "reported phi_star against the outermost contacts");
  }
}

}  // namespace windlass::verify
