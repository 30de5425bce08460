#include "windlass/petsc/handles.hpp"

#include <algorithm>
#include <cassert>
#include <vector>

namespace windlass::petsc {

using Eigen::Index;
using Sparse = Eigen::SparseMatrix<double>;

VecHandle zero_vector(Index n) {
  VecHandle vector;
  check(VecCreateSeq(PETSC_COMM_SELF, static_cast<PetscInt>(n), vector.put()));
  check(VecSet(vector, 0.0));
  return vector;
}

MatHandle aij(const Sparse& matrix) {
  const Eigen::SparseMatrix<double, Eigen::RowMajor, PetscInt> rows = matrix;  // compressed
  MatHandle out;
  check(MatCreateSeqAIJ(PETSC_COMM_SELF, rows.rows(), rows.cols(), 0, nullptr, out.put()));
  check(MatSeqAIJSetPreallocationCSR(out, rows.outerIndexPtr(), rows.innerIndexPtr(), rows.valuePtr()));
  return out;
}

MatHandle symmetric(const Sparse& matrix) {
  assert(matrix.rows() == matrix.cols());
  // Column k of the lower triangle is row k of the upper one, which is what SBAIJ stores.
  const Index n = matrix.cols();
  std::vector<PetscInt> start(n + 1, 0), column;
  std::vector<double> value;
  column.reserve(matrix.nonZeros() / 2 + n);
  value.reserve(matrix.nonZeros() / 2 + n);
  for (Index k = 0; k < n; ++k) {
    column.push_back(static_cast<PetscInt>(k));
    value.push_back(0.0);
    for (Sparse::InnerIterator entry(matrix, k); entry; ++entry) {
      if (entry.row() == k) value[start[k]] = entry.value();
      if (entry.row() <= k) continue;
      column.push_back(static_cast<PetscInt>(entry.row()));
      value.push_back(entry.value());
    }
    start[k + 1] = static_cast<PetscInt>(column.size());
  }
  const PetscInt size = static_cast<PetscInt>(n);
  MatHandle out;
  check(MatCreateSeqSBAIJ(PETSC_COMM_SELF, 1, size, size, 0, nullptr, out.put()));
  check(MatSeqSBAIJSetPreallocationCSR(out, 1, start.data(), column.data(), value.data()));
  return out;
}

void copy(const Eigen::VectorXd& from, Vec to) {
  PetscInt n = 0;
  PetscScalar* entries = nullptr;
  check(VecGetLocalSize(to, &n));
  assert(n == from.size());
  check(VecGetArrayWrite(to, &entries));
  std::copy_n(from.data(), n, entries);
  check(VecRestoreArrayWrite(to, &entries));
}

void copy(Vec from, Eigen::VectorXd& to) {
  PetscInt n = 0;
  const PetscScalar* entries = nullptr;
  check(VecGetLocalSize(from, &n));
  to.resize(n);
  check(VecGetArrayRead(from, &entries));
  std::copy_n(entries, n, to.data());
  check(VecRestoreArrayRead(from, &entries));
}

}  // namespace windlass::petsc
