#include "windlass/chain/block.hpp"

#include <algorithm>
#include <cmath>

namespace windlass::chain {

void Block::reset(Eigen::Index size) {
  const bool same = by_columns_ && size == size_;
  size_ = size;
  by_columns_ = size > large;
  if (!by_columns_) {
    columns_.clear();
    whole_.setZero(size, size);
    return;
  }
  whole_.resize(0, 0);
  if (!same) columns_.assign(static_cast<std::size_t>(size), {});
  for (auto& column : columns_)
    for (Entry& at : column) at.value = 0.0;
}

void Block::grow() {
  ++size_;
  if (by_columns_) {
    columns_.emplace_back();
    return;
  }
  whole_.conservativeResize(size_, size_);
  whole_.row(size_ - 1).setZero();
  whole_.col(size_ - 1).setZero();
}

double& Block::entry(Eigen::Index row, Eigen::Index column) {
  auto& entries = columns_[static_cast<std::size_t>(column)];
  const int r = static_cast<int>(row);
  const auto at = std::lower_bound(entries.begin(), entries.end(), r,
                                   [](const Entry& e, int wanted) { return e.row < wanted; });
  if (at != entries.end() && at->row == r) return at->value;
  return entries.insert(at, {r, 0.0})->value;
}

template <typename Visit>
void Block::visit(const Visit& at) const {
  for (Eigen::Index c = 0; c < size_; ++c) {
    if (by_columns_)
      for (const Entry& e : columns_[static_cast<std::size_t>(c)]) at(e.row, c, e.value);
    else
      for (Eigen::Index r = 0; r < size_; ++r) at(r, c, whole_(r, c));
  }
}

void Block::symmetrise() {
  if (!by_columns_) {
    whole_ = (0.5 * (whole_ + whole_.transpose())).eval();
    return;
  }
  for (Eigen::Index c = 0; c < size_; ++c) {
    // Places that only one of the two had appear in columns before or after this one.
    for (std::size_t k = 0; k < columns_[static_cast<std::size_t>(c)].size(); ++k) {
      const int r = columns_[static_cast<std::size_t>(c)][k].row;
      if (r == c) continue;
      double& other = entry(c, r);
      double& here = columns_[static_cast<std::size_t>(c)][k].value;
      if (r < c && other == here) continue;
      other = here = 0.5 * (here + other);
    }
  }
}

Eigen::VectorXd Block::operator*(const Eigen::VectorXd& v) const {
  if (!by_columns_) return whole_ * v;
  Eigen::VectorXd out = Eigen::VectorXd::Zero(size_);
  visit([&](Eigen::Index r, Eigen::Index c, double value) { out(r) += value * v(c); });
  return out;
}

bool Block::all_finite() const {
  if (!by_columns_) return whole_.allFinite();
  bool finite = true;
  visit([&](Eigen::Index, Eigen::Index, double value) { finite = finite && std::isfinite(value); });
  return finite;
}

double Block::largest() const {
  if (!by_columns_) return size_ == 0 ? 0.0 : whole_.cwiseAbs().maxCoeff();
  double out = 0.0;
  visit([&](Eigen::Index, Eigen::Index, double value) { out = std::max(out, std::abs(value)); });
  return out;
}

Eigen::VectorXd Block::largest_rows() const {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(size_);
  visit([&](Eigen::Index r, Eigen::Index, double value) { out(r) = std::max(out(r), std::abs(value)); });
  return out;
}

Eigen::VectorXd Block::diagonal() const {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(size_);
  visit([&](Eigen::Index r, Eigen::Index c, double value) {
    if (r == c) out(r) = value;
  });
  return out;
}

Eigen::MatrixXd Block::whole() const {
  if (!by_columns_) return whole_;
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(size_, size_);
  visit([&](Eigen::Index r, Eigen::Index c, double value) { out(r, c) = value; });
  return out;
}

std::vector<Eigen::Triplet<double>> Block::entries() const {
  std::vector<Eigen::Triplet<double>> out;
  visit([&](Eigen::Index r, Eigen::Index c, double value) {
    if (value != 0.0) out.emplace_back(r, c, value);
  });
  return out;
}

void Block::copy_to(Eigen::SparseMatrix<double>& out) const {
  const auto there = [](const Entry& e) { return e.value != 0.0; };
  Eigen::Index count = 0;
  for (const auto& column : columns_) count += std::count_if(column.begin(), column.end(), there);
  out.resize(size_, size_);
  out.resizeNonZeros(count);
  int at = 0;
  for (Eigen::Index c = 0; c < size_; ++c) {
    out.outerIndexPtr()[c] = at;
    for (const Entry& e : columns_[static_cast<std::size_t>(c)]) {
      if (!there(e)) continue;
      out.innerIndexPtr()[at] = e.row;
      out.valuePtr()[at++] = e.value;
    }
  }
  out.outerIndexPtr()[size_] = at;
}

}  // namespace windlass::chain
