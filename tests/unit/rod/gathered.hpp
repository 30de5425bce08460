#pragma once

#include <Eigen/Dense>
#include <Eigen/SparseCore>
#include <vector>

#include "windlass/bvp/arc.hpp"

/// An arc's derivatives by all of its unknowns in one list, of so many: interior, then ends.
namespace windlass::test {

inline Eigen::VectorXd gathered_gradient(const bvp::Arc& arc, const bvp::ArcPoint& at, Eigen::Index size) {
  Eigen::VectorXd out(size);
  bvp::EndsVector ends;
  arc.gradient(at, out.data(), ends);
  out.tail(arc.ends()) = ends;
  return out;
}

inline Eigen::MatrixXd gathered_hessian(const bvp::Arc& arc, const bvp::ArcPoint& at, Eigen::Index size) {
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(size, size);
  std::vector<Eigen::Triplet<double>> entries;
  arc.hessian(at, entries);
  for (const auto& e : entries) dense(e.row(), e.col()) += e.value();
  return dense;
}

}  // namespace windlass::test
