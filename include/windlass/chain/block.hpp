#pragma once

#include <Eigen/Dense>
#include <Eigen/SparseCore>
#include <vector>

namespace windlass::chain {

/// The block of a chain's matrix that couples its arcs, a square matrix to which arcs and joints add. A small one is stored
/// whole. That of a rod with many touches, each of which knows its neighbours only, is large and nearly empty: it is kept by
/// columns, and what it costs grows with the number of touches.
class Block {
 public:
  static constexpr Eigen::Index large = 300;  ///< rows; below that a whole matrix is as fast

  Block() = default;
  explicit Block(Eigen::Index size) { reset(size); }

  /// Zero. One of the same size as before keeps the places where something was added, and the memory.
  void reset(Eigen::Index size);
  /// One more row and column, zero.
  void grow();
  Eigen::Index rows() const { return size_; }
  bool by_columns() const { return by_columns_; }

  double& operator()(Eigen::Index row, Eigen::Index column) {
    return by_columns_ ? entry(row, column) : whole_(row, column);
  }

  /// A rectangle of it, to which matrices of that size are added.
  class Part {
   public:
    template <typename Derived>
    void operator+=(const Eigen::MatrixBase<Derived>& more) {
      add(more, 1.0);
    }
    template <typename Derived>
    void operator-=(const Eigen::MatrixBase<Derived>& less) {
      add(less, -1.0);
    }

   private:
    friend class Block;
    Part(Block& of, Eigen::Index row, Eigen::Index column, Eigen::Index rows, Eigen::Index columns)
        : of_(of), row_(row), column_(column), rows_(rows), columns_(columns) {}
    template <typename Derived>
    void add(const Eigen::MatrixBase<Derived>& more, double sign) {
      eigen_assert(more.rows() == rows_ && more.cols() == columns_);
      const typename Derived::PlainObject& values = more;
      for (Eigen::Index c = 0; c < columns_; ++c)
        for (Eigen::Index r = 0; r < rows_; ++r) of_(row_ + r, column_ + c) += sign * values(r, c);
    }
    Block& of_;
    Eigen::Index row_, column_, rows_, columns_;
  };
  Part block(Eigen::Index row, Eigen::Index column, Eigen::Index rows, Eigen::Index columns) {
    return {*this, row, column, rows, columns};
  }

  /// A becomes ½(A + Aᵀ).
  void symmetrise();
  Eigen::VectorXd operator*(const Eigen::VectorXd& v) const;
  bool all_finite() const;
  double largest() const;                ///< size of the largest entry
  Eigen::VectorXd largest_rows() const;  ///< the same in each row
  Eigen::VectorXd diagonal() const;
  Eigen::MatrixXd whole() const;
  /// Entries that are not zero.
  std::vector<Eigen::Triplet<double>> entries() const;
  /// The same of a large one, in its order; more than half of where something was added may be zero.
  void copy_to(Eigen::SparseMatrix<double>& out) const;
  const Eigen::MatrixXd& stored_whole() const { return whole_; }  ///< of small ones

 private:
  struct Entry {
    int row;
    double value;
  };
  double& entry(Eigen::Index row, Eigen::Index column);
  template <typename Visit>
  void visit(const Visit& at) const;

  Eigen::Index size_ = 0;
  bool by_columns_ = false;
  Eigen::MatrixXd whole_;
  std::vector<std::vector<Entry>> columns_;  ///< rows ascend
};

}  // namespace windlass::chain
