#include <boost/test/unit_test.hpp>
#include <random>

#include "support/petsc_session.hpp"
#include "windlass/chain/frontal_inertia.hpp"

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using windlass::chain::Block;

/// What a rod with touches leads to: neighbours that couple, of either sign, and between some of them multipliers, whose diagonal is
/// zero; next to each other these hold nearly the same. One full row.
Block saddle(Index places, double alike, unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  constexpr Index wide = 4;
  const Index touches = places / 3, n = places + touches + 1;
  Block block(n);
  const auto add = [&](Index r, Index c, double value) {
    block(r, c) += value;
    if (r != c) block(c, r) += value;
  };
  for (Index at = 0; at + wide <= places; ++at)
    for (Index r = 0; r < wide; ++r)
      for (Index c = 0; c <= r; ++c) add(at + r, at + c, number(engine));
  for (Index t = 0; t < touches; ++t) {
    const Index near = 3 * t, far = places - 1 - near;  // of another strand
    const double push = number(engine);
    add(places + t, near, push), add(places + t, far, -push);
    if (t > 0) add(places + t, near - 3, alike), add(places + t, far, alike);
  }
  for (Index k = 0; k < places; ++k) add(n - 1, k, number(engine));
  return block;
}

}  // namespace

BOOST_FIXTURE_TEST_SUITE(frontal_inertia, windlass::test::PetscSession)

BOOST_AUTO_TEST_CASE(counts_what_the_eigenvalues_do) {
  for (const Index places : {30, 300, 900})  // the first is stored whole
    for (const double alike : {0.0, 1.0, 1e4})
      for (const unsigned seed : {1u, 2u, 3u}) {
        const Block block = saddle(places, alike, seed);
        const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(block.whole(), Eigen::EigenvaluesOnly);
        const auto negative = (eigen.eigenvalues().array() < 0.0).count();
        BOOST_TEST(windlass::chain::pivot_signs(block).negative == negative);
      }
}

BOOST_AUTO_TEST_CASE(tells_of_a_singular_matrix) {
  for (const Index places : {30, 600}) {
    Block block = saddle(places, 0.0, 4);
    const Index n = block.rows();
    for (Index k = 0; k < n; ++k)  // the second row is the first now
      block(1, k) = block(0, k);
    for (Index k = 0; k < n; ++k) block(k, 1) = block(k, 0);
    block(1, 1) = block(0, 0);
    constexpr double rounding = 1e-12;  // of n operations with numbers of size 4
    BOOST_TEST(windlass::chain::pivot_signs(block).least < rounding);
  }
}

BOOST_AUTO_TEST_SUITE_END()
