// Elimination of the first unknowns of a symmetric matrix, against dense algebra.
#include "windlass/bvp/partial_elimination.hpp"

#include <boost/test/unit_test.hpp>

using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr int eliminated = 7, kept = 5;

MatrixXd symmetric(unsigned seed) {
  std::srand(seed);
  const MatrixXd a = MatrixXd::Random(eliminated + kept, eliminated + kept);
  return a + a.transpose();
}

int negative(const MatrixXd& a) {
  return static_cast<int>((Eigen::SelfAdjointEigenSolver<MatrixXd>(a).eigenvalues().array() < 0.0).count());
}

}  // namespace

BOOST_AUTO_TEST_SUITE(partial_elimination)

BOOST_AUTO_TEST_CASE(schur_complement_solution_and_inertia) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const MatrixXd full = symmetric(seed);
    windlass::bvp::PartialElimination elimination;
    elimination.resize(eliminated, kept);
    MatrixXd work = full;
    work.triangularView<Eigen::StrictlyUpper>().setConstant(1e300);  // only the lower triangle is read
    elimination.factor(work);
    const MatrixXd schur = MatrixXd(work.bottomRightCorner(kept, kept).selfadjointView<Eigen::Lower>());
    const MatrixXd a = full.topLeftCorner(eliminated, eliminated),
                   b = full.bottomLeftCorner(kept, eliminated);
    const MatrixXd expected = full.bottomRightCorner(kept, kept) - b * a.partialPivLu().solve(b.transpose());
    // Pivots are not exchanged: growth of a few hundred on these matrices.
    const double bound = 1e-9 * expected.norm();
    BOOST_TEST((schur - expected).norm() < bound);
    BOOST_TEST(elimination.negative_pivots() + negative(schur) == negative(full));

    const VectorXd rhs = VectorXd::Random(eliminated + kept);
    VectorXd f = rhs.head(eliminated), g = rhs.tail(kept);
    elimination.reduce(f.data(), g.data());
    const VectorXd y = schur.partialPivLu().solve(g);
    elimination.expand(f.data(), y.data());
    VectorXd solution(eliminated + kept);
    solution << f, y;
    BOOST_TEST((full * solution - rhs).norm() < 1e-8 * full.norm() * solution.norm());
  }
}

BOOST_AUTO_TEST_CASE(a_vanishing_pivot_is_replaced_and_the_rest_stays_finite) {
  MatrixXd full = symmetric(3);
  full(0, 0) = 0.0;
  windlass::bvp::PartialElimination elimination;
  elimination.resize(eliminated, kept);
  elimination.factor(full);
  BOOST_TEST(MatrixXd(full.bottomRightCorner(kept, kept)).allFinite());
}

BOOST_AUTO_TEST_SUITE_END()
