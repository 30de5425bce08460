#include "windlass/output/point_store.hpp"

#include <cmath>

#include "point_parts.hpp"
#include "windlass/output/error.hpp"
#include "windlass/output/records.hpp"

namespace windlass::output {

using equilibrium::ArcRecord;
using equilibrium::Solution;
using equilibrium::Stability;

namespace {

constexpr const char* about =
    "Equilibria of an elastic rod, written by windlass. Dimensionless: length rho, force EI/rho^2. Row i of "
    "points describes one equilibrium; its arcs are rows arc_begin[i] .. arc_begin[i]+arc_count[i]-1 of "
    "arcs, whose "
    "samples are rows sample_begin .. sample_begin+sample_count-1 of samples.";

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

/// Calls visit(column vector, field of the solution) for every real and integer that is stored as it stands,
/// so that writing and reading cannot get out of step.
template <class Points, class AnySolution, class Visit>
void visit_scalars(Points& p, AnySolution& x, Visit visit) {
  visit(p.T, x.T), visit(p.phi, x.phi), visit(p.R_tot, x.R_tot), visit(p.phi_star, x.phi_star);
  visit(p.tilt, x.tilt), visit(p.z_span, x.z_span), visit(p.energy, x.energy);
  visit(p.self_force, x.self_force);
  visit(p.plate_force, x.plate_force), visit(p.dragged, x.dragged);
  visit(p.travel_rate, x.travel_rate), visit(p.pull_difference, x.pull_difference);
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
  p.has_self_distance.push_back(solution.self_distance.has_value());
  p.self_distance.push_back(finite_or(solution.self_distance.value_or(0.0), 0.0));
  p.self_s1.push_back(solution.self_s[0]);
  p.self_s2.push_back(solution.self_s[1]);
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
  if (solution.stability) put_stability(columns_, *solution.stability, size() - 1);
}

void PointStore::set_stability(const std::string& name, const Stability& stability) {
  const auto position = find(name);
  if (!position) throw OutputError("there is no stored point " + name);
  put_stability(columns_, stability, *position);
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

Solution PointStore::get(std::size_t position) const {
  const PointColumns::Points& p = columns_.points;
  Solution solution;
  visit_scalars(p, solution, Fetch{position});
  if (p.has_F0[position] != 0) solution.F0 = p.F0[position];
  if (p.has_self_distance[position] != 0) solution.self_distance = p.self_distance[position];
  solution.self_s = {p.self_s1[position], p.self_s2[position]};
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
