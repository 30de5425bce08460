// Six lowest eigenvalues of a coil's second variation through SLEPc, beside the assembly it does without. Argument: elements.
#include <benchmark/benchmark.h>

#include "unit/equilibrium/coil.hpp"
#include "windlass/petsc/session.hpp"
#include "windlass/stability/spectrum.hpp"

namespace {

using windlass::contact::Parity;

void assembly(benchmark::State& state) {
  const auto coil = windlass::test::spatial_coil(1.5, static_cast<int>(state.range(0)));
  for (auto _ : state)
    benchmark::DoNotOptimize(coil.chain.second_variation(coil.x, coil.loads, Parity::even));
}

void spectrum(benchmark::State& state) {
  windlass::petsc::ensure_session();
  auto coil = windlass::test::spatial_coil(1.5, static_cast<int>(state.range(0)));
  const Eigen::MatrixXd none(coil.chain.size(), 0);
  coil.chain.factor(coil.x, coil.loads, none, none, Eigen::MatrixXd(0, 0));
  windlass::stability::SpectrumSolver solver;
  for (auto _ : state) {
    const windlass::chain::Linearisation linearised(coil.chain, {.spatial = true}, coil.x, coil.loads);
    benchmark::DoNotOptimize(solver.lowest(windlass::chain::Variation(linearised, Parity::even), 6));
  }
}

}  // namespace

BENCHMARK(assembly)->Arg(12)->Arg(48)->Unit(benchmark::kMillisecond);
BENCHMARK(spectrum)->Arg(12)->Arg(48)->Unit(benchmark::kMillisecond);
BENCHMARK_MAIN();
