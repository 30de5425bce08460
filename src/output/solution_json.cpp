#include "windlass/output/solution_json.hpp"

#include <cmath>
#include <numbers>

#include "windlass/obstacle/scene_obstacles.hpp"
#include "windlass/output/error.hpp"
#include "windlass/output/records.hpp"

namespace windlass::output {

using equilibrium::ArcRecord;
using equilibrium::JointKind;
using equilibrium::JointRecord;
using equilibrium::Solution;
using nlohmann::ordered_json;

std::string arc_kind_name(const ArcRecord& arc) {
  if (arc.kind == equilibrium::ArcKind::line) return "line";
  return arc.role.empty() ? "gap" : arc.role;
}

namespace {
constexpr std::pair<JointKind, const char*> joint_names[] = {{JointKind::end, "end"},
                                                             {JointKind::touch, "touch"},
                                                             {JointKind::edge, "edge"},
                                                             {JointKind::infinity, "infinity"},
                                                             {JointKind::strand, "strand"}};
}  // namespace

std::string joint_kind_name(JointKind kind) {
  for (const auto& [value, name] : joint_names) {
    if (value == kind) return name;
  }
  return "unknown";
}

JointKind joint_kind_from_name(const std::string& name) {
  for (const auto& [value, known] : joint_names) {
    if (known == name) return value;
  }
  throw OutputError("unknown kind of joint \"" + name + "\"");
}

namespace {

/// Touches of the rod with itself, each once; "line": one of those that a line consists of; "mirror": with its own image under the
/// half-turn.
ordered_json self_json(const Solution& solution) {
  constexpr double same = 1e-9;
  ordered_json list = ordered_json::array();
  for (std::size_t k = 0; k < solution.joints.size(); ++k) {
    const JointRecord& joint = solution.joints[k];
    if (joint.partner <= static_cast<int>(k)) continue;
    const double other = solution.joints.at(static_cast<std::size_t>(joint.partner)).s;
    const bool mirror = std::abs(joint.s + other) < same * (1.0 + other);
    list.push_back({{"kind", joint.along_strand ? "line"
                             : mirror           ? "mirror"
                                                : "touch"},
                    {"s1", finite_or_null(joint.s)},
                    {"s2", finite_or_null(other)},
                    {"force", finite_or_null(joint.strand_force)}});
  }
  return list;
}

ordered_json contact_json(const Solution& solution) {
  ordered_json contact;
  contact["topology"] = solution.topology;
  contact["arcs"] = ordered_json::array();
  for (const ArcRecord& arc : solution.arcs) {
    contact["arcs"].push_back({{"kind", arc_kind_name(arc)},
                               {"s_begin", finite_or_null(arc.s_begin)},
                               {"s_end", finite_or_null(arc.s_end)},
                               {"force", finite_or_null(arc.force)}});
    if (!solution.has_cylinder && arc.obstacle >= 0) contact["arcs"].back()["obstacle"] = arc.obstacle + 1;
  }
  contact["joints"] = ordered_json::array();
  for (const JointRecord& joint : solution.joints) {
    contact["joints"].push_back({{"kind", joint_kind_name(joint.kind)},
                                 {"s", finite_or_null(joint.s)},
                                 {"angle", finite_or_null(joint.angle)},
                                 {"z", finite_or_null(joint.z)},
                                 {"force", finite_or_null(joint.force)}});
    if (!solution.has_cylinder) {  // the place and the obstacle say more than an angle round nothing
      contact["joints"].back()["r"] = {finite_or_null(joint.r.x()), finite_or_null(joint.r.y()),
                                       finite_or_null(joint.r.z())};
      if (joint.obstacle >= 0) contact["joints"].back()["obstacle"] = joint.obstacle + 1;
    }
    if (joint.holding != 0.0) contact["joints"].back()["holding"] = joint.holding;
  }
  contact["self"] = self_json(solution);
  return contact;
}

/// What a plate carries: points, and lines that lie on cylinder and plate at once, which only the first of two does.
/// @param number  of the plate, from 1; of two plates the second's force is that at its points
ordered_json plate_json(const Solution& solution, const scene::Scene& scene, int number) {
  ordered_json plate;
  double second = 0.0;
  for (const JointRecord& joint : solution.joints)
    if (obstacle::plate_at(scene, joint.obstacle) == 2) second += std::abs(joint.normal.z()) * joint.force;
  plate["force"] = finite_or_null(number == 2          ? second
                                  : scene.second_plate ? solution.plate_force - second
                                                       : solution.plate_force);
  plate["arcs"] = plate["joints"] = ordered_json::array();
  for (const ArcRecord& arc : solution.arcs)
    if (arc.plate_force > 0.0 && number == 1)
      plate["arcs"].push_back({{"s_begin", finite_or_null(arc.s_begin)},
                               {"s_end", finite_or_null(arc.s_end)},
                               {"force", finite_or_null(arc.plate_force)}});
  for (const JointRecord& joint : solution.joints) {
    const double force = joint.obstacle > 0 ? joint.force : joint.plate_force;
    const int of = joint.obstacle > 0 ? obstacle::plate_at(scene, joint.obstacle) : 1;
    if (force > 0.0 && of == number)
      plate["joints"].push_back({{"s", finite_or_null(joint.s)}, {"force", finite_or_null(force)}});
  }
  return plate;
}

ordered_json stability_json(const Solution& solution) {
  if (!solution.stability) return nullptr;
  ordered_json json;
  json["index"] = solution.stability->index;
  json["inertia_index"] = solution.stability->inertia_index;
  json["eigenvalues"] = ordered_json::array();
  for (const double value : solution.stability->eigenvalues)
    json["eigenvalues"].push_back(finite_or_null(value));
  json["degenerate"] = solution.stability->degenerate;
  json["sliding"] = solution.stability->sliding;
  for (const std::complex<double>& value : solution.stability->leading)
    json["leading"].push_back({finite_or_null(value.real()), finite_or_null(value.imag())});
  return json;
}

/// What the sliders hold the ends with: the force on the rod at each, outward from the axis across its line, and along e_z.
ordered_json sliders_json(const Solution& solution) {
  const auto held = [&](const ArcRecord& arc, bool at_end) {
    const double side = at_end ? 1.0 : -1.0, half = 0.5 * solution.phi;
    const Eigen::Vector3d outward(side * std::sin(half), -std::cos(half), 0.0),
        force = side * arc.n.col(at_end ? arc.n.cols() - 1 : 0);
    return ordered_json{{"across", finite_or_null(force.dot(outward))},
                        {"axial", finite_or_null(force.z() + 0.0)}};
  };
  return {{"left", held(solution.arcs.front(), false)}, {"right", held(solution.arcs.back(), true)}};
}

ordered_json parameters_json(const Solution& solution, const scene::Scene& scene) {
  if (solution.has_cylinder)
    return {{"T", finite_or_null(solution.T)}, {"phi", finite_or_null(solution.phi)}};
  ordered_json json;
  json["shortening"] = finite_or_null(solution.shortening);
  json["thrust"] = finite_or_null(solution.end_force);
  json["twist"] = finite_or_null(scene.ends.twist);
  return json;
}

ordered_json quantity(double value, const char* unit) {
  return {{"value", finite_or_null(value)}, {"unit", unit}};
}

/// The same quantities in newtons and millimetres; energies in millijoules (N mm).
ordered_json physical_json(const Solution& solution, const scene::Units& units) {
  constexpr double mm = 1e3, gram = 1e3, gravity = 9.80665;
  ordered_json json;
  if (solution.has_cylinder) {
    const double tension = solution.T * units.force;
    json["tension"] = quantity(tension, "N");
    json["hung_mass"] = quantity(tension / gravity * gram, "g");
    json["phi"] = quantity(solution.phi * 180.0 / std::numbers::pi, "deg");
    json["R_tot"] = quantity(solution.R_tot * units.force, "N");
    if (solution.F0) json["F0"] = quantity(*solution.F0 * units.force, "N");
    json["phi_star"] = quantity(solution.phi_star * 180.0 / std::numbers::pi, "deg");
    json["tilt"] = quantity(solution.tilt * 180.0 / std::numbers::pi, "deg");
  } else {
    json["end_force"] = quantity(solution.end_force * units.force, "N");
    json["end_moment"] = quantity(solution.end_moment * units.moment * mm, "N mm");
  }
  json["z_span"] = quantity(solution.z_span * units.length * mm, "mm");
  json["energy"] = quantity(solution.energy * units.energy * 1e3, "mJ");
  if (solution.self_distance)
    json["self_distance"] = quantity(*solution.self_distance * units.length * mm, "mm");
  ordered_json contact;
  contact["arcs"] = ordered_json::array();
  for (const ArcRecord& arc : solution.arcs) {
    const double pressure = arc.p.size() > 0 ? arc.p.maxCoeff() : 0.0;
    contact["arcs"].push_back({{"kind", arc_kind_name(arc)},
                               {"s_begin", quantity(arc.s_begin * units.length * mm, "mm")},
                               {"s_end", quantity(arc.s_end * units.length * mm, "mm")},
                               {"force", quantity(arc.force * units.force, "N")},
                               {"largest_pressure", quantity(pressure * units.pressure / mm, "N/mm")}});
  }
  contact["joints"] = ordered_json::array();
  for (const JointRecord& joint : solution.joints) {
    contact["joints"].push_back({{"kind", joint_kind_name(joint.kind)},
                                 {"s", quantity(joint.s * units.length * mm, "mm")},
                                 {"z", quantity(joint.z * units.length * mm, "mm")},
                                 {"force", quantity(joint.force * units.force, "N")}});
  }
  if (solution.has_cylinder) json["contact"] = contact;
  json["scales"] = {{"length", quantity(units.length * mm, "mm")},
                    {"force", quantity(units.force, "N")},
                    {"moment", quantity(units.moment * mm, "N mm")},
                    {"pressure", quantity(units.pressure / mm, "N/mm")}};
  return json;
}

}  // namespace

ordered_json to_json(const Solution& solution, const scene::Scene& scene) {
  ordered_json json;
  json["parameters"] = parameters_json(solution, scene);
  json["model"] = solution.model;
  json["model_reason"] = solution.model_reason;
  json["converged"] = solution.converged;
  json["newton_iterations"] = solution.newton_iterations;
  if (solution.has_cylinder) {
    json["R_tot"] = finite_or_null(solution.R_tot);
    if (solution.F0) json["F0"] = finite_or_null(*solution.F0);
    json["phi_star"] = finite_or_null(solution.phi_star);
  } else {
    if (scene.has_obstacles()) json["R_tot"] = finite_or_null(solution.R_tot);
    json["end_force"] = finite_or_null(solution.end_force);
    json["end_moment"] = finite_or_null(solution.end_moment);
    json["shortening"] = finite_or_null(solution.shortening);
  }
  json["tilt"] = finite_or_null(solution.tilt);
  json["z_span"] = finite_or_null(solution.z_span);
  json["energy"] = finite_or_null(solution.energy);
  if (scene.rod.extensible) json["stretch"] = finite_or_null(solution.stretch);
  json["self_distance"] = finite_or_null(solution.self_distance.value_or(std::nan("")));
  json["self_force"] = finite_or_null(solution.self_force);
  if (scene.has_obstacles() || scene.self_contact) json["contact"] = contact_json(solution);
  if (scene.plate) json["plate"] = plate_json(solution, scene, 1);
  if (scene.second_plate) {
    json["plates"] = ordered_json::array();
    for (const int number : {1, 2}) {
      ordered_json plate = plate_json(solution, scene, number);
      plate["height"] = (number == 1 ? scene.plate : scene.second_plate)->height;
      json["plates"].push_back(std::move(plate));
    }
  }
  if (solution.dragged)
    json["travel"] = {{"rate", finite_or_null(solution.travel_rate)},
                      {"pull_difference", finite_or_null(solution.pull_difference)}};
  if (scene.ends.guided()) json["sliders"] = sliders_json(solution);
  json["stability"] = stability_json(solution);
  json["invariants"] = {{"hamiltonian_drift", finite_or_null(solution.invariants.hamiltonian_drift)},
                        {"axial_torque_drift", finite_or_null(solution.invariants.axial_torque_drift)},
                        {"force_residual", finite_or_null(solution.invariants.force_residual)}};
  json["error_estimate"] = finite_or_null(solution.error_estimate);
  json["tolerance_met"] = solution.error_estimate <= scene.model.tolerance;
  json["mesh"] = {{"elements", solution.mesh.elements},
                  {"stages", solution.mesh.stages},
                  {"unknowns", solution.mesh.unknowns}};
  json["seconds"] = {{"solve", finite_or_null(solution.seconds_solve)},
                     {"stability", finite_or_null(solution.seconds_stability)},
                     {"total", finite_or_null(solution.seconds_total)}};
  if (scene.units) json["physical"] = physical_json(solution, *scene.units);
  return json;
}

}  // namespace windlass::output
