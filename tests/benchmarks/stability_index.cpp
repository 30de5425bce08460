// The index of a coil by inertia, given the factorisation Newton leaves; both parities. Argument: elements.
#include <benchmark/benchmark.h>

#include "unit/equilibrium/coil.hpp"

namespace {

using Eigen::MatrixXd;
using windlass::contact::Parity;

void inertia(benchmark::State& state, bool spatial) {
  const int elements = static_cast<int>(state.range(0));
  auto coil =
      spatial ? windlass::test::spatial_coil(1.5, elements) : windlass::test::planar_coil(1.5, elements);
  const MatrixXd none(coil.chain.size(), 0);
  coil.chain.factor(coil.x, coil.loads, none, none, MatrixXd(0, 0));
  for (auto _ : state) {
    benchmark::DoNotOptimize(coil.chain.index(coil.x, coil.loads, Parity::even));
    benchmark::DoNotOptimize(coil.chain.index(coil.x, coil.loads, Parity::odd));
  }
}

}  // namespace

BENCHMARK_CAPTURE(inertia, planar, false)->Arg(12)->Arg(48);
BENCHMARK_CAPTURE(inertia, spatial, true)->Arg(12)->Arg(48);
BENCHMARK_MAIN();
