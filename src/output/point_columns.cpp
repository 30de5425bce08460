#include "windlass/output/point_store.hpp"

/// Names, units and meanings of every dataset of points.h5: the one place that documents the file.
namespace windlass::output {

namespace {

Table points_table(PointColumns::Points& p) {
  Table table{"points", "one row a point; X_begin and X_count select its rows of the table X", {}};
  table.columns = {
      {"branch", "1", "branch number", &p.branch},
      {"point", "1", "number within the branch", &p.point},
      {"label", "", "name of a special point, else empty", &p.label},
      {"model", "", "rung of the model ladder", &p.model},
      {"model_reason", "", "why this rung", &p.model_reason},
      {"topology", "", "contact topology", &p.topology},
      {"T", "EI/rho^2", "tension", &p.T},
      {"phi", "rad", "capstan angle", &p.phi},
      {"R_tot", "EI/rho^2", "sum of the sizes of all contact forces", &p.R_tot},
      {"F0", "EI/rho^2", "sliding strength mu R_tot, where has_F0 is 1", &p.F0},
      {"phi_star", "rad", "half the angle between the outermost contacts", &p.phi_star},
      {"tilt", "rad", "inclination of the mid-point tangent to the plane z = 0", &p.tilt},
      {"z_span", "rho", "extent in z", &p.z_span},
      {"energy", "EI/rho", "energy of bending, twisting and stretching", &p.energy},
      {"self_distance", "rho", "closest approach of the rod to itself, where has_self_distance is 1",
       &p.self_distance},
      {"self_s1", "rho", "where, and", &p.self_s1},
      {"self_s2", "rho", "to where", &p.self_s2},
      {"self_force", "EI/rho^2", "sum of the sizes of the forces between strands", &p.self_force},
      {"plate_force", "EI/rho^2", "sum of the sizes of the plate's forces", &p.plate_force},
      {"travel_rate", "1", "while the cylinder slips: the rod's speed along itself over the cylinder's",
       &p.travel_rate},
      {"pull_difference", "EI/rho^2", "the same: the pulls are T +- this", &p.pull_difference},
      {"end_force", "EI/rho^2", "strut: thrust", &p.end_force},
      {"end_moment", "EI/rho", "strut: axial end moment", &p.end_moment},
      {"shortening", "1", "strut: end shortening / length", &p.shortening},
      {"error_estimate", "1", "relative error estimate", &p.error_estimate},
      {"hamiltonian_drift", "EI/rho^2", "drift of m.u - W + n.d3", &p.hamiltonian_drift},
      {"axial_torque_drift", "EI/rho", "drift of (m + r x n).e_z", &p.axial_torque_drift},
      {"force_residual", "EI/rho^2", "size of the sum of all external forces", &p.force_residual},
      {"seconds_solve", "s", "time of the solve", &p.seconds_solve},
      {"seconds_stability", "s", "time of the stability analysis", &p.seconds_stability},
      {"seconds_total", "s", "time of everything", &p.seconds_total},
      {"converged", "1", "1 when Newton converged", &p.converged},
      {"newton_iterations", "1", "Newton iterations", &p.newton_iterations},
      {"has_cylinder", "1", "0 for a strut", &p.has_cylinder},
      {"dragged", "1", "1 where the cylinder slips along the rod", &p.dragged},
      {"has_F0", "1", "1 when the scene has a friction coefficient", &p.has_F0},
      {"has_self_distance", "1", "0 where the rod nowhere comes back to itself", &p.has_self_distance},
      {"has_stability", "1", "1 when index and eigenvalues were computed", &p.has_stability},
      {"index", "1", "number of negative eigenvalues", &p.index},
      {"inertia_index", "1", "the same from the inertia of a factorisation", &p.inertia_index},
      {"degenerate", "1", "1 when a contact carries no force or an eigenvalue is zero to rounding",
       &p.degenerate},
      {"elements", "1", "mesh elements", &p.elements},
      {"stages", "1", "collocation stages an element", &p.stages},
      {"unknowns", "1", "discrete unknowns", &p.unknowns},
      {"chain", "", "restart: discrete problem (JSON)", &p.chain},
  };
  const auto link = [&table](const char* name, PointColumns::Integers& values) {
    table.columns.push_back({name, "1", "rows of another table", &values});
  };
  link("arc_begin", p.arc_begin);
  link("arc_count", p.arc_count);
  link("joint_begin", p.joint_begin);
  link("joint_count", p.joint_count);
  link("eigenvalue_begin", p.eigenvalue_begin);
  link("eigenvalue_count", p.eigenvalue_count);
  link("mode_begin", p.mode_begin);
  link("mode_count", p.mode_count);
  link("state_begin", p.state_begin);
  link("state_count", p.state_count);
  return table;
}

Table arcs_table(PointColumns::Arcs& a) {
  return {"arcs",
          "stretches of rod in one contact state, in order of s",
          {{"kind", "", "free | line", &a.kind},
           {"role", "", "tail | gap | line", &a.role},
           {"s_begin", "rho", "material arclength of the beginning, 0 at the mid-point", &a.s_begin},
           {"s_end", "rho", "material arclength of the end", &a.s_end},
           {"force", "EI/rho^2", "integral of p", &a.force},
           {"obstacle", "1", "of a line: the obstacle it lies on, its place in the scene from 0; else -1",
            &a.obstacle},
           {"sample_begin", "1", "first row in samples", &a.sample_begin},
           {"sample_count", "1", "number of rows in samples", &a.sample_count}}};
}

Table samples_table(PointColumns::Samples& s) {
  return {"samples",
          "the rod at its mesh nodes, world frame, cylinder axis e_z",
          {{"s", "rho", "material arclength", &s.s},
           {"r", "rho", "position x, y, z", &s.r, 3},
           {"q", "1", "unit quaternion w, x, y, z of the directors, body to world, d3 = tangent", &s.q, 4},
           {"n", "EI/rho^2", "internal force x, y, z", &s.n, 3},
           {"m", "EI/rho", "internal moment x, y, z", &s.m, 3},
           {"p", "EI/rho^3", "contact force per length, 0 off the cylinder", &s.p}}};
}

Table joints_table(PointColumns::Joints& j) {
  return {
      "joints",
      "places where arcs meet, in order of s: arc k lies between joints k and k+1 of its point",
      {{"kind", "", "end | touch | edge | infinity | strand", &j.kind},
       {"s", "rho", "material arclength", &j.s},
       {"angle", "rad", "place round the axis, unrolled, 0 at the south pole", &j.angle},
       {"z", "rho", "height", &j.z},
       {"force", "EI/rho^2", "size of the contact point force", &j.force},
       {"holding", "EI/rho^2",
        "force round the cylinder that holds the rod against sliding along itself, zero at an equilibrium",
        &j.holding},
       {"obstacle", "1", "of a contact: its obstacle's place in the scene from 0; else -1", &j.obstacle},
       {"partner", "1", "of a contact with another strand: that strand's joint, from 0; else -1", &j.partner},
       {"strand_force", "EI/rho^2", "size of the force between the two strands", &j.strand_force},
       {"normal", "1", "of a contact: direction of its force on the rod", &j.normal, 3},
       {"r", "rho", "position x, y, z", &j.r, 3}}};
}

}  // namespace

std::vector<Table> point_tables(PointColumns& columns) {
  PointColumns::Modes& modes = columns.modes;
  PointColumns::ModeSamples& mode_samples = columns.mode_samples;
  return {points_table(columns.points),
          arcs_table(columns.arcs),
          samples_table(columns.samples),
          joints_table(columns.joints),
          {"eigenvalues",
           "lowest eigenvalues of the second variation, lowest first",
           {{"value", "EI/rho^3", "eigenvalue", &columns.eigenvalues}}},
          {"modes",
           "eigenmodes",
           {{"eigenvalue", "EI/rho^3", "eigenvalue", &modes.eigenvalue},
            {"plane", "", "in | out of the plane z = 0", &modes.plane},
            {"parity", "", "even | odd under the half-turn", &modes.parity},
            {"sample_begin", "1", "first row in mode_samples", &modes.sample_begin},
            {"sample_count", "1", "number of rows in mode_samples", &modes.sample_count}}},
          {"mode_samples",
           "displacement of eigenmodes",
           {{"s", "rho", "material arclength", &mode_samples.s},
            {"displacement", "1", "x, y, z; largest entry 1", &mode_samples.displacement, 3}}},
          {"state", "restart: discrete unknowns", {{"value", "1", "unknown", &columns.state}}}};
}

}  // namespace windlass::output
