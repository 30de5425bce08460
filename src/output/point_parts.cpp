#include "point_parts.hpp"
#include "windlass/output/solution_json.hpp"

namespace windlass::output {

using equilibrium::ArcRecord;
using equilibrium::JointRecord;
using equilibrium::Mode;
using equilibrium::Stability;

namespace {

/// Columns [begin, begin + count) of a quantity with Rows components a sample.
template <int Rows>
Eigen::Matrix<double, Rows, Eigen::Dynamic> block(const std::vector<double>& column, std::int64_t begin,
                                                  std::int64_t count) {
  using Block = Eigen::Matrix<double, Rows, Eigen::Dynamic>;
  return Eigen::Map<const Block>(column.data() + Rows * begin, Rows, count);
}

}  // namespace

void append_arc(PointColumns& columns, const ArcRecord& arc) {
  columns.arcs.kind.push_back(arc.kind == equilibrium::ArcKind::line ? "line" : "free");
  columns.arcs.role.push_back(arc.role);
  columns.arcs.s_begin.push_back(finite_or(arc.s_begin, arc.s[0]));
  columns.arcs.s_end.push_back(finite_or(arc.s_end, arc.s[arc.s.size() - 1]));
  columns.arcs.force.push_back(finite_or(arc.force, 0.0));
  columns.arcs.obstacle.push_back(arc.obstacle);
  columns.arcs.sample_begin.push_back(size_of(columns.samples.s));
  columns.arcs.sample_count.push_back(arc.s.size());
  append(columns.samples.s, arc.s);
  append(columns.samples.r, arc.r);
  append(columns.samples.q, arc.q);
  append(columns.samples.n, arc.n);
  append(columns.samples.m, arc.m);
  append(columns.samples.p, arc.p);
}

ArcRecord read_arc(const PointColumns& columns, std::size_t row) {
  const PointColumns::Arcs& arcs = columns.arcs;
  const std::int64_t begin = arcs.sample_begin[row], count = arcs.sample_count[row];
  ArcRecord arc;
  arc.kind = arcs.kind[row] == "line" ? equilibrium::ArcKind::line : equilibrium::ArcKind::free;
  arc.role = arcs.role[row];
  arc.s_begin = arcs.s_begin[row];
  arc.s_end = arcs.s_end[row];
  arc.force = arcs.force[row];
  arc.obstacle = static_cast<int>(arcs.obstacle[row]);
  arc.s = segment(columns.samples.s, begin, count);
  arc.r = block<3>(columns.samples.r, begin, count);
  arc.q = block<4>(columns.samples.q, begin, count);
  arc.n = block<3>(columns.samples.n, begin, count);
  arc.m = block<3>(columns.samples.m, begin, count);
  arc.p = segment(columns.samples.p, begin, count);
  return arc;
}

void append_joint(PointColumns& columns, const JointRecord& joint, double nearest_s) {
  columns.joints.kind.push_back(joint_kind_name(joint.kind));
  columns.joints.s.push_back(finite_or(joint.s, nearest_s));
  columns.joints.angle.push_back(finite_or(joint.angle, 0.0));
  columns.joints.z.push_back(finite_or(joint.z, 0.0));
  columns.joints.force.push_back(finite_or(joint.force, 0.0));
  columns.joints.holding.push_back(finite_or(joint.holding, 0.0));
  columns.joints.obstacle.push_back(joint.obstacle);
  columns.joints.partner.push_back(joint.partner);
  columns.joints.strand_force.push_back(finite_or(joint.strand_force, 0.0));
  for (const double component : joint.normal) columns.joints.normal.push_back(finite_or(component, 0.0));
  for (const double component : joint.r) columns.joints.r.push_back(finite_or(component, 0.0));
}

JointRecord read_joint(const PointColumns& columns, std::size_t row) {
  const PointColumns::Joints& joints = columns.joints;
  JointRecord joint;
  joint.kind = joint_kind_from_name(joints.kind[row]);
  joint.s = joints.s[row];
  joint.angle = joints.angle[row];
  joint.z = joints.z[row];
  joint.force = joints.force[row];
  joint.holding = joints.holding[row];
  joint.obstacle = static_cast<int>(joints.obstacle[row]);
  joint.partner = static_cast<int>(joints.partner[row]);
  joint.strand_force = joints.strand_force[row];
  joint.normal = block<3>(joints.normal, static_cast<std::int64_t>(row), 1);
  joint.r = block<3>(joints.r, static_cast<std::int64_t>(row), 1);
  return joint;
}

void put_stability(PointColumns& columns, const Stability& stability, std::size_t row) {
  PointColumns::Points& p = columns.points;
  p.has_stability[row] = 1;
  p.index[row] = stability.index;
  p.inertia_index[row] = stability.inertia_index;
  p.degenerate[row] = stability.degenerate;
  p.eigenvalue_begin[row] = size_of(columns.eigenvalues);
  for (const double value : stability.eigenvalues) {
    if (std::isfinite(value)) columns.eigenvalues.push_back(value);
  }
  p.eigenvalue_count[row] = size_of(columns.eigenvalues) - p.eigenvalue_begin[row];
  p.mode_begin[row] = size_of(columns.modes.eigenvalue);
  for (const Mode& mode : stability.modes) {
    if (!mode.displacement.allFinite() || mode.displacement.cols() != mode.s.size()) continue;
    columns.modes.eigenvalue.push_back(finite_or(mode.eigenvalue, 0.0));
    columns.modes.plane.push_back(mode.plane);
    columns.modes.parity.push_back(mode.parity);
    columns.modes.sample_begin.push_back(size_of(columns.mode_samples.s));
    columns.modes.sample_count.push_back(mode.s.size());
    append(columns.mode_samples.s, mode.s);
    append(columns.mode_samples.displacement, mode.displacement);
  }
  p.mode_count[row] = size_of(columns.modes.eigenvalue) - p.mode_begin[row];
}

Stability read_stability(const PointColumns& columns, std::size_t row) {
  const PointColumns::Points& p = columns.points;
  Stability stability;
  stability.index = static_cast<int>(p.index[row]);
  stability.inertia_index = static_cast<int>(p.inertia_index[row]);
  stability.degenerate = p.degenerate[row] != 0;
  const auto first = columns.eigenvalues.begin() + p.eigenvalue_begin[row];
  stability.eigenvalues.assign(first, first + p.eigenvalue_count[row]);
  for (std::int64_t i = p.mode_begin[row]; i < p.mode_begin[row] + p.mode_count[row]; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const std::int64_t begin = columns.modes.sample_begin[k], count = columns.modes.sample_count[k];
    stability.modes.push_back({columns.modes.eigenvalue[k], columns.modes.plane[k], columns.modes.parity[k],
                               segment(columns.mode_samples.s, begin, count),
                               block<3>(columns.mode_samples.displacement, begin, count)});
  }
  return stability;
}

}  // namespace windlass::output
