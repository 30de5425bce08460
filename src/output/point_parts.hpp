#pragma once

#include <cmath>

#include "windlass/equilibrium/solution.hpp"
#include "windlass/output/point_store.hpp"

/// Parts of a solution into and out of the columns of points.h5.
namespace windlass::output {

/// Double that a file can hold: an infinite tail ends, on disk, at its last stored sample; other doubles that do not exist
/// become 0.
inline double finite_or(double value, double otherwise) { return std::isfinite(value) ? value : otherwise; }

/// Rows of a column, whatever its components.
inline std::int64_t size_of(const std::vector<double>& column) {
  return static_cast<std::int64_t>(column.size());
}

template <class Derived>
void append(std::vector<double>& column, const Eigen::PlainObjectBase<Derived>& values) {
  column.insert(column.end(), values.data(), values.data() + values.size());
}

inline Eigen::VectorXd segment(const std::vector<double>& column, std::int64_t begin, std::int64_t count) {
  return Eigen::Map<const Eigen::VectorXd>(column.data() + begin, count);
}

void append_arc(PointColumns& columns, const equilibrium::ArcRecord& arc);
equilibrium::ArcRecord read_arc(const PointColumns& columns, std::size_t row);

/// @param nearest_s  stands for the place of a joint at infinity
void append_joint(PointColumns& columns, const equilibrium::JointRecord& joint, double nearest_s);
equilibrium::JointRecord read_joint(const PointColumns& columns, std::size_t row);

/// Stability of the point in that row. Eigenvalues and modes are appended; earlier ones of the same point, if any, are no
/// longer referred to.
void put_stability(PointColumns& columns, const equilibrium::Stability& stability, std::size_t row);
equilibrium::Stability read_stability(const PointColumns& columns, std::size_t row);

}  // namespace windlass::output
