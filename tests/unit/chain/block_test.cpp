#include <boost/test/unit_test.hpp>
#include <random>

#include "windlass/chain/block.hpp"
#include "windlass/chain/block_factors.hpp"

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using windlass::chain::Block;

/// What neighbours add to each other, the last row and column full as a border's are.
MatrixXd fill(Block& block, Index n) {
  std::mt19937 engine(7);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  MatrixXd whole = MatrixXd::Zero(n, n);
  block.reset(n);
  constexpr Index wide = 6;
  for (Index at = 0; at + wide <= n; at += 3) {
    const MatrixXd share = MatrixXd::NullaryExpr(wide, wide, [&] { return number(engine); });
    block.block(at, at, wide, wide) += share;
    whole.block(at, at, wide, wide) += share;
  }
  for (Index k = 0; k < n; ++k) {
    const double value = number(engine);
    block(k, n - 1) -= value, block(n - 1, k) += 2.0 * value;
    whole(k, n - 1) -= value, whole(n - 1, k) += 2.0 * value;
  }
  return whole;
}

// One stored whole and one kept by columns.
constexpr Index sizes[] = {40, Block::large + 50};

}  // namespace

BOOST_AUTO_TEST_SUITE(block)

BOOST_AUTO_TEST_CASE(is_the_matrix_of_what_was_added) {
  for (const Index n : sizes) {
    Block block;
    MatrixXd whole = fill(block, n);
    BOOST_TEST(block.by_columns() == (n > Block::large));
    BOOST_TEST((block.whole() == whole));
    BOOST_TEST((block * VectorXd::Ones(n) - whole.rowwise().sum()).norm() < 1e-13 * n);
    BOOST_TEST(block.largest() == whole.cwiseAbs().maxCoeff());
    BOOST_TEST((block.largest_rows() == VectorXd(whole.cwiseAbs().rowwise().maxCoeff())));
    BOOST_TEST((block.diagonal() == VectorXd(whole.diagonal())));
    MatrixXd again = MatrixXd::Zero(n, n);
    for (const auto& entry : block.entries()) again(entry.row(), entry.col()) += entry.value();
    BOOST_TEST((again == whole));
    block.symmetrise();
    BOOST_TEST((block.whole() == MatrixXd(0.5 * (whole + whole.transpose()))));
    block.grow();
    BOOST_TEST(block.rows() == n + 1);
    BOOST_TEST(block.whole().bottomRows(1).isZero(0.0));
    BOOST_TEST(block.whole().rightCols(1).isZero(0.0));
  }
}

BOOST_AUTO_TEST_CASE(one_that_is_reset_is_zero_and_tells_what_is_not_finite) {
  for (const Index n : sizes) {
    Block block;
    fill(block, n);
    block.reset(n);
    BOOST_TEST(block.whole().isZero(0.0));
    BOOST_TEST(block.all_finite());
    block(3, 5) = NAN;
    BOOST_TEST(!block.all_finite());
  }
}

BOOST_AUTO_TEST_CASE(factors_solve_and_know_the_sign_of_the_determinant) {
  for (const Index n : sizes) {
    Block block;
    const MatrixXd whole = fill(block, n);
    windlass::chain::BlockFactors factors;
    factors.compute(block);
    const VectorXd x = VectorXd::LinSpaced(n, -1.0, 2.0);
    // Rounding times the condition of a random matrix of a few hundred rows, 1e4 or so.
    constexpr double rounding = 1e-9;
    BOOST_TEST((factors.solve(whole * x, false) - x).norm() < rounding);
    BOOST_TEST((factors.solve(whole.transpose() * x, true) - x).norm() < rounding);
    const Eigen::PartialPivLU<MatrixXd> reference(whole);
    const int negative = static_cast<int>((reference.matrixLU().diagonal().array() < 0.0).count());
    const double sign = (negative % 2 == 0 ? 1.0 : -1.0) * reference.permutationP().determinant();
    BOOST_TEST(factors.determinant_sign() == sign);
    block.block(0, 0, n, n) -= 2.0 * whole;  // −A, on the same pattern or a full one
    factors.compute(block);
    BOOST_TEST(factors.determinant_sign() == (n % 2 == 0 ? sign : -sign));
  }
}

BOOST_AUTO_TEST_SUITE_END()
