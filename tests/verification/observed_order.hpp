#pragma once

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <functional>

#include "windlass/chain/guess.hpp"
#include "windlass/equilibrium/start.hpp"

namespace windlass::test {

/// A state on uniform meshes.
struct OnMeshes {
  equilibrium::RodProblem problem;
  Eigen::VectorXd x;
};

/// The state that the program found, solved again on the same contacts on other meshes.
inline OnMeshes on_meshes(const equilibrium::Started& found, const scene::Scene& scene,
                          const std::vector<chain::ArcMesh>& meshes) {
  const equilibrium::RodProblem& exact = *found.problem;
  OnMeshes out{equilibrium::RodProblem(scene, true, exact.topology(), meshes, exact.keys()), {}};
  out.x = chain::transfer_state(exact.chain(), out.problem.chain(), found.x, out.problem.loads(found.p));
  BOOST_REQUIRE(out.problem.polish(out.x, found.p) >= 0);
  return out;
}

/// The same with `elements` elements an arc.
inline OnMeshes on_uniform_meshes(const equilibrium::Started& found, const scene::Scene& scene, int stages,
                                  int elements) {
  const int arcs = found.problem->chain().link_count();
  return on_meshes(found, scene, std::vector<chain::ArcMesh>(arcs, {chain::uniform_mesh(elements), stages}));
}

/// A mesh with each element divided into equal parts.
inline std::vector<double> divided(const std::vector<double>& nodes, int parts) {
  std::vector<double> out{nodes.front()};
  for (std::size_t k = 1; k < nodes.size(); ++k)
    for (int part = 1; part <= parts; ++part)
      out.push_back(nodes[k - 1] + (nodes[k] - nodes[k - 1]) * part / parts);
  return out;
}

/// Gauss collocation of m stages is of order 2m at the nodes: from `coarse` elements to twice as many.
inline void check_order(int stages, int coarse, double exact,
                        const std::function<double(int stages, int elements)>& value) {
  const double first = std::abs(value(stages, coarse) - exact);
  const double second = std::abs(value(stages, 2 * coarse) - exact);
  const double order = std::log2(first / second);
  BOOST_TEST_CONTEXT("stages " << stages << ", errors " << first << " " << second) {
    BOOST_TEST_MESSAGE("stages " << stages << ": order " << order << ", errors " << first << " " << second);
    BOOST_TEST(order > 2 * stages - 0.6);
    BOOST_TEST(order < 2 * stages + 1.5);
  }
}

/// The same of a state on contacts that the program found, for two stages and three.
inline void check_order(double exact, const std::function<double(int stages, int elements)>& value) {
  check_order(2, 64, exact, value);
  check_order(3, 36, exact, value);
}

}  // namespace windlass::test
