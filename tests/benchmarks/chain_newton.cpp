// A Newton step of a coil's half chain: residual, factorisation with one border, bordered solve. Argument: elements.
#include <benchmark/benchmark.h>

#include "unit/equilibrium/coil.hpp"

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using windlass::test::Coil;

Coil coil_of(bool spatial, std::int64_t elements) {
  const int count = static_cast<int>(elements);
  return spatial ? windlass::test::spatial_coil(1.0, count) : windlass::test::planar_coil(1.0, count);
}

void residual(benchmark::State& state, bool spatial) {
  const Coil coil = coil_of(spatial, state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(coil.chain.residual(coil.x, coil.loads));
}

void factor(benchmark::State& state, bool spatial) {
  Coil coil = coil_of(spatial, state.range(0));
  const MatrixXd b = MatrixXd::Ones(coil.chain.size(), 1), d = MatrixXd::Ones(1, 1);
  for (auto _ : state) {
    coil.chain.factor(coil.x, coil.loads, b, b, d);
    benchmark::DoNotOptimize(coil.chain.determinant_sign());
  }
}

void solve(benchmark::State& state, bool spatial) {
  Coil coil = coil_of(spatial, state.range(0));
  const MatrixXd b = MatrixXd::Ones(coil.chain.size(), 1), d = MatrixXd::Ones(1, 1);
  coil.chain.factor(coil.x, coil.loads, b, b, d);
  const VectorXd f = b, g = VectorXd::Ones(1);
  for (auto _ : state) benchmark::DoNotOptimize(coil.chain.solve(f, g));
}

}  // namespace

BENCHMARK_CAPTURE(residual, planar, false)->Arg(12)->Arg(48);
BENCHMARK_CAPTURE(residual, spatial, true)->Arg(12)->Arg(48);
BENCHMARK_CAPTURE(factor, planar, false)->Arg(12)->Arg(48);
BENCHMARK_CAPTURE(factor, spatial, true)->Arg(12)->Arg(48);
BENCHMARK_CAPTURE(solve, planar, false)->Arg(12)->Arg(48);
BENCHMARK_CAPTURE(solve, spatial, true)->Arg(12)->Arg(48);
BENCHMARK_MAIN();
