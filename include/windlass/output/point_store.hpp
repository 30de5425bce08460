#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "windlass/equilibrium/solution.hpp"
#include "windlass/output/table.hpp"

namespace windlass::output {

/// Every solution of a run, the content of points.h5.
///
/// Stored column by column over all points (tables points, arcs, samples, joints, eigenvalues, modes,
/// mode_samples, state), each row of a table pointing at its rows of the next: `arc_begin`/`arc_count` of a
/// point, `sample_begin`/`sample_count` of an arc. Appending costs microseconds and a file of thousands of
/// points has a few dozen datasets, where a group a point costs 0.3 ms a point to create (measured, HDF5 1.10).
/// Samples of an infinite tail end where its stored samples end: no infinity is written.
///
/// PointColumns is that content, one vector a dataset; its description (units, meaning) is in point_columns.cpp.
struct PointColumns {
  using Reals = std::vector<double>;
  using Integers = std::vector<std::int64_t>;
  using Texts = std::vector<std::string>;

  struct Points {
    Integers branch, point, converged, newton_iterations, has_cylinder, has_F0, dragged, has_self_distance,
        has_stability, index, inertia_index, degenerate, elements, stages, unknowns;
    Integers arc_begin, arc_count, joint_begin, joint_count, eigenvalue_begin, eigenvalue_count, mode_begin,
        mode_count, state_begin, state_count;
    Reals T, phi, R_tot, F0, self_distance, self_s1, self_s2, phi_star, tilt, z_span, energy, self_force,
        plate_force, travel_rate, pull_difference, end_force, end_moment, shortening, error_estimate;
    Reals hamiltonian_drift, axial_torque_drift, force_residual, seconds_solve, seconds_stability,
        seconds_total;
    Texts label, model, model_reason, topology, chain;
  } points;
  struct Arcs {
    Integers sample_begin, sample_count, obstacle;
    Reals s_begin, s_end, force;
    Texts kind, role;
  } arcs;
  struct Samples {
    Reals s, r, q, n, m, p;
  } samples;
  struct Joints {
    Integers obstacle, partner;
    Reals s, angle, z, force, holding, strand_force, r, normal;
    Texts kind;
  } joints;
  struct Modes {
    Integers sample_begin, sample_count;
    Reals eigenvalue;
    Texts plane, parity;
  } modes;
  struct ModeSamples {
    Reals s, displacement;
  } mode_samples;
  Reals eigenvalues, state;
};

/// The tables of points.h5 as views of `columns`.
std::vector<Table> point_tables(PointColumns& columns);

/// Position-keyed store of solutions.
class PointStore {
 public:
  struct Key {
    int branch = 0, point = 0;
    std::string label;
  };

  /// @throws OutputError naming the file when it is unreadable, truncated or inconsistent
  static PointStore read(const std::filesystem::path& path);
  /// @throws OutputError when the file cannot be written; the previous file is then untouched
  void write(const std::filesystem::path& path);

  /// @throws OutputError when a number of the solution is not finite, or the name is already taken
  void append(const Key& key, const equilibrium::Solution& solution);
  /// Replaces the stability record of a stored point. @throws OutputError when there is no such point
  void set_stability(const std::string& name, const equilibrium::Stability& stability);

  /// A store of the first `count` points alone.
  PointStore first(std::size_t count) const;

  std::size_t size() const { return keys_.size(); }
  const std::vector<Key>& keys() const { return keys_; }
  /// Position of a point called by its label or "BRANCH-POINT"; empty when there is none.
  std::optional<std::size_t> find(const std::string& name) const;
  equilibrium::Solution get(std::size_t position) const;
  /// @throws OutputError listing what there is when there is no such point
  equilibrium::Solution get(const std::string& name) const;

 private:
  void index_point(const Key& key);

  PointColumns columns_;
  std::vector<Key> keys_;
  std::map<std::string, std::size_t> position_;
};

}  // namespace windlass::output
