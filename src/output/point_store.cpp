#include "windlass/output/point_store.hpp"

#include <cmath>

#include "windlass/output/error.hpp"
#include "windlass/output/records.hpp"
#include "windlass/output/solution_json.hpp"

namespace windlass::output {

using equilibrium::ArcRecord;
using equilibrium::JointRecord;
using equilibrium::Mode;
using equilibrium::Solution;
using equilibrium::Stability;

namespace {

constexpr const char* about =
    "Equilibria of an elastic rod, written by windlass. Dimensionless: length rho, force EI/rho^2. Row i of "
    "points describes one equilibrium; its arcs are rows arc_begin[i] .. arc_begin[i]+arc_count[i]-1 of "
    "arcs, whose "
    "samples are rows sample_begin .. sample_begin+sample_count-1 of samples.";

template <class Derived>
void append(std::vector<double>& column, const Eigen::PlainObjectBase<Derived>& values) {
  column.insert(column.end(), values.data(), values.data() + values.size());
}

/// Columns [begin, begin + count) of a quantity with Rows components a sample.
template <int Rows>
Eigen::Matrix<double, Rows, Eigen::Dynamic> block(const std::vector<double>& column, std::int64_t begin,
                                                  std::int64_t count) {
  using Block = Eigen::Matrix<double, Rows, Eigen::Dynamic>;
  return Eigen::Map<const Block>(column.data() + Rows * begin, Rows, count);
}

Eigen::VectorXd segment(const std::vector<double>& column, std::int64_t begin, std::int64_t count) {
  return Eigen::Map<const Eigen::VectorXd>(column.data() + begin, count);
}

std::int64_t size_of(const std::vector<double>& column) { return static_cast<std::int64_t>(column.size()); }

void require_finite(const Solution& solution, const std::string& name) {
  bool finite = std::isfinite(solution.T) && std::isfinite(solution.phi) && std::isfinite(solution.R_tot) &&
                std::isfinite(solution.energy) && solution.restart.state.allFinite();
  for (const ArcRecord& arc : solution.arcs) {
    finite = finite && arc.s.allFinite() && arc.r.allFinite() && arc.q.allFinite() && arc.n.allFinite() &&
             arc.m.allFinite() && arc.p.allFinite();
  }
  if (!finite) throw OutputError("point " + name + " holds a number that is not finite and is not stored");
}

void require_shapes(const ArcRecord& arc, const std::string& name) {
  const auto count = arc.s.size();
  if (arc.r.cols() != count || arc.q.cols() != count || arc.n.cols() != count || arc.m.cols() != count ||
      arc.p.size() != count || count == 0) {
    throw OutputError("point " + name + " has an arc whose samples differ in number");
  }
}

/// An infinite tail ends, on disk, at its last stored sample; other doubles that do not exist become 0.
double finite_or(double value, double otherwise) { return std::isfinite(value) ? value : otherwise; }

void append_arc(PointColumns& columns, const ArcRecord& arc) {
  columns.arcs.kind.push_back(arc.kind == equilibrium::ArcKind::line ? "line" : "free");
  columns.arcs.role.push_back(arc.role);
  columns.arcs.s_begin.push_back(finite_or(arc.s_begin, arc.s[0]));
  columns.arcs.s_end.push_back(finite_or(arc.s_end, arc.s[arc.s.size() - 1]));
  columns.arcs.force.push_back(finite_or(arc.force, 0.0));
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
  joint.r = block<3>(joints.r, static_cast<std::int64_t>(row), 1);
  return joint;
}

/// Calls visit(column vector, field of the solution) for every real and integer that is stored as it stands,
/// so that writing and reading cannot get out of step.
template <class Points, class AnySolution, class Visit>
void visit_scalars(Points& p, AnySolution& x, Visit visit) {
  visit(p.T, x.T), visit(p.phi, x.phi), visit(p.R_tot, x.R_tot), visit(p.phi_star, x.phi_star);
  visit(p.tilt, x.tilt), visit(p.z_span, x.z_span), visit(p.energy, x.energy);
  visit(p.end_force, x.end_force), visit(p.end_moment, x.end_moment), visit(p.shortening, x.shortening);
  visit(p.error_estimate, x.error_estimate);
  visit(p.hamiltonian_drift, x.invariants.hamiltonian_drift);
  visit(p.axial_torque_drift, x.invariants.axial_torque_drift);
  visit(p.force_residual, x.invariants.force_residual);
  visit(p.seconds_solve, x.seconds_solve), visit(p.seconds_stability, x.seconds_stability);
  visit(p.seconds_total, x.seconds_total);
  visit(p.converged, x.converged), visit(p.newton_iterations, x.newton_iterations);
  visit(p.has_cylinder, x.has_cylinder);
  visit(p.elements, x.mesh.elements), visit(p.stages, x.mesh.stages), visit(p.unknowns, x.mesh.unknowns);
  visit(p.model, x.model), visit(p.model_reason, x.model_reason), visit(p.topology, x.topology);
  visit(p.chain, x.restart.chain);
}

struct PushBack {
  void operator()(std::vector<double>& column, double value) const {
    column.push_back(finite_or(value, 0.0));
  }
  void operator()(std::vector<std::int64_t>& column, int value) const { column.push_back(value); }
  void operator()(std::vector<std::string>& column, const std::string& value) const {
    column.push_back(value);
  }
};

struct Fetch {
  std::size_t row;
  template <class Column, class Value>
  void operator()(const Column& column, Value& value) const {
    value = static_cast<Value>(column.at(row));
  }
};

}  // namespace

void PointStore::index_point(const Key& key) {
  const std::string number = point_name(key.branch, key.point, "");
  if (position_.contains(number) || (!key.label.empty() && position_.contains(key.label))) {
    throw OutputError("point " + point_name(key.branch, key.point, key.label) + " is stored already");
  }
  position_[number] = keys_.size();
  if (!key.label.empty()) position_[key.label] = keys_.size();
  keys_.push_back(key);
}

void PointStore::append(const Key& key, const Solution& solution) {
  const std::string name = point_name(key.branch, key.point, key.label);
  require_finite(solution, name);
  for (const ArcRecord& arc : solution.arcs) require_shapes(arc, name);
  index_point(key);
  PointColumns::Points& p = columns_.points;
  p.branch.push_back(key.branch);
  p.point.push_back(key.point);
  p.label.push_back(key.label);
  visit_scalars(p, solution, PushBack{});
  p.has_F0.push_back(solution.F0.has_value());
  p.F0.push_back(finite_or(solution.F0.value_or(0.0), 0.0));
  p.arc_begin.push_back(static_cast<std::int64_t>(columns_.arcs.kind.size()));
  p.arc_count.push_back(static_cast<std::int64_t>(solution.arcs.size()));
  for (const ArcRecord& arc : solution.arcs) append_arc(columns_, arc);
  p.joint_begin.push_back(static_cast<std::int64_t>(columns_.joints.kind.size()));
  p.joint_count.push_back(static_cast<std::int64_t>(solution.joints.size()));
  for (std::size_t i = 0; i < solution.joints.size(); ++i) {
    const double first = solution.arcs.empty() ? 0.0 : solution.arcs.front().s[0];
    const double last =
        solution.arcs.empty() ? 0.0 : solution.arcs.back().s[solution.arcs.back().s.size() - 1];
    append_joint(columns_, solution.joints[i], i == 0 ? first : last);
  }
  p.state_begin.push_back(size_of(columns_.state));
  p.state_count.push_back(solution.restart.state.size());
  output::append(columns_.state, solution.restart.state);
  for (auto* column : {&p.has_stability, &p.index, &p.inertia_index, &p.degenerate, &p.eigenvalue_begin,
                       &p.eigenvalue_count, &p.mode_begin, &p.mode_count}) {
    column->push_back(0);
  }
  if (solution.stability) put_stability(*solution.stability, size() - 1);
}

/// Eigenvalues and modes are appended; earlier ones of the same point, if any, are no longer referred to.
void PointStore::put_stability(const Stability& stability, std::size_t row) {
  PointColumns::Points& p = columns_.points;
  p.has_stability[row] = 1;
  p.index[row] = stability.index;
  p.inertia_index[row] = stability.inertia_index;
  p.degenerate[row] = stability.degenerate;
  p.eigenvalue_begin[row] = size_of(columns_.eigenvalues);
  for (const double value : stability.eigenvalues) {
    if (std::isfinite(value)) columns_.eigenvalues.push_back(value);
  }
  p.eigenvalue_count[row] = size_of(columns_.eigenvalues) - p.eigenvalue_begin[row];
  p.mode_begin[row] = size_of(columns_.modes.eigenvalue);
  for (const Mode& mode : stability.modes) {
    if (!mode.displacement.allFinite() || mode.displacement.cols() != mode.s.size()) continue;
    columns_.modes.eigenvalue.push_back(finite_or(mode.eigenvalue, 0.0));
    columns_.modes.plane.push_back(mode.plane);
    columns_.modes.parity.push_back(mode.parity);
    columns_.modes.sample_begin.push_back(size_of(columns_.mode_samples.s));
    columns_.modes.sample_count.push_back(mode.s.size());
    output::append(columns_.mode_samples.s, mode.s);
    output::append(columns_.mode_samples.displacement, mode.displacement);
  }
  p.mode_count[row] = size_of(columns_.modes.eigenvalue) - p.mode_begin[row];
}

void PointStore::set_stability(const std::string& name, const Stability& stability) {
  const auto position = find(name);
  if (!position) throw OutputError("there is no stored point " + name);
  put_stability(stability, *position);
}

std::optional<std::size_t> PointStore::find(const std::string& name) const {
  const auto found = position_.find(name);
  return found == position_.end() ? std::nullopt : std::optional(found->second);
}

Solution PointStore::get(const std::string& name) const {
  if (const auto position = find(name)) return get(*position);
  std::string known;
  for (const Key& key : keys_) {
    if (!key.label.empty()) known += (known.empty() ? "" : ", ") + key.label;
  }
  throw OutputError("there is no stored point \"" + name + "\"; labelled points are: " +
                    (known.empty() ? "none" : known) + "; others are called BRANCH-POINT, such as 1-1");
}

namespace {

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

}  // namespace

Solution PointStore::get(std::size_t position) const {
  const PointColumns::Points& p = columns_.points;
  Solution solution;
  visit_scalars(p, solution, Fetch{position});
  if (p.has_F0[position] != 0) solution.F0 = p.F0[position];
  for (std::int64_t i = 0; i < p.arc_count[position]; ++i) {
    solution.arcs.push_back(read_arc(columns_, static_cast<std::size_t>(p.arc_begin[position] + i)));
  }
  for (std::int64_t i = 0; i < p.joint_count[position]; ++i) {
    solution.joints.push_back(read_joint(columns_, static_cast<std::size_t>(p.joint_begin[position] + i)));
  }
  solution.restart.state = segment(columns_.state, p.state_begin[position], p.state_count[position]);
  if (p.has_stability[position] != 0) solution.stability = read_stability(columns_, position);
  return solution;
}

PointStore PointStore::first(std::size_t count) const {
  PointStore store;
  for (std::size_t k = 0; k < count; ++k) store.append(keys_.at(k), get(k));
  return store;
}

void PointStore::write(const std::filesystem::path& path) {
  write_tables(path, point_tables(columns_), about);
}

namespace {

/// Every reference from one table into another must lie inside it: a damaged file must not be read past its end.
void require_links(const std::filesystem::path& path, const char* what,
                   const std::vector<std::int64_t>& begin, const std::vector<std::int64_t>& count,
                   std::size_t rows) {
  for (std::size_t i = 0; i < begin.size(); ++i) {
    if (begin[i] < 0 || count[i] < 0 || static_cast<std::size_t>(begin[i] + count[i]) > rows) {
      throw OutputError("cannot read " + path.string() + ": " + what + " refers to rows that are not there");
    }
  }
}

}  // namespace

PointStore PointStore::read(const std::filesystem::path& path) {
  PointStore store;
  PointColumns& columns = store.columns_;
  const std::vector<Table> tables = point_tables(columns);
  read_tables(path, tables);
  for (const Table& table : tables) {
    for (const Column& column : table.columns) {
      if (column.rows() != table.columns.front().rows()) {
        throw OutputError("cannot read " + path.string() + ": " + table.name + "/" + column.name +
                          " has a wrong length");
      }
    }
  }
  const PointColumns::Points& p = columns.points;
  require_links(path, "points", p.arc_begin, p.arc_count, columns.arcs.kind.size());
  require_links(path, "points", p.joint_begin, p.joint_count, columns.joints.kind.size());
  require_links(path, "points", p.eigenvalue_begin, p.eigenvalue_count, columns.eigenvalues.size());
  require_links(path, "points", p.mode_begin, p.mode_count, columns.modes.eigenvalue.size());
  require_links(path, "points", p.state_begin, p.state_count, columns.state.size());
  require_links(path, "arcs", columns.arcs.sample_begin, columns.arcs.sample_count, columns.samples.s.size());
  require_links(path, "modes", columns.modes.sample_begin, columns.modes.sample_count,
                columns.mode_samples.s.size());
  for (std::size_t i = 0; i < p.branch.size(); ++i) {
    store.index_point({static_cast<int>(p.branch[i]), static_cast<int>(p.point[i]), p.label[i]});
  }
  return store;
}

}  // namespace windlass::output
