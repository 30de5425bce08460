// One arc: gradient, and Hessian assembled, factored and condensed to the ends. Argument: elements; six stages.
#include <benchmark/benchmark.h>

#include "unit/equilibrium/coil.hpp"

namespace {

using windlass::test::Coil;

void run(benchmark::State& state, Coil coil, int link, bool factor) {
  auto& arc = *coil.chain.link(link).arc;
  const auto placed = coil.chain.place(coil.x, coil.loads, link);
  windlass::bvp::EndsMatrix condensed;
  windlass::bvp::EndsVector ends;
  Eigen::VectorXd interior(arc.interior_tangent());
  for (auto _ : state) {
    if (factor)
      arc.factor(placed.point(), condensed);
    else
      arc.gradient(placed.point(), interior.data(), ends);
    benchmark::DoNotOptimize(condensed.data());
    benchmark::DoNotOptimize(ends.data());
  }
  state.counters["unknowns"] = static_cast<double>(interior.size());
  state.SetComplexityN(arc.elements());
}

constexpr double tension = 1.0;
constexpr int line = 0, tail = 1;

void planar_gradient(benchmark::State& state) {
  run(state, windlass::test::planar_coil(tension, static_cast<int>(state.range(0))), tail, false);
}
void planar_factor(benchmark::State& state) {
  run(state, windlass::test::planar_coil(tension, static_cast<int>(state.range(0))), tail, true);
}
void kirchhoff_gradient(benchmark::State& state) {
  run(state, windlass::test::spatial_coil(tension, static_cast<int>(state.range(0))), tail, false);
}
void kirchhoff_factor(benchmark::State& state) {
  run(state, windlass::test::spatial_coil(tension, static_cast<int>(state.range(0))), tail, true);
}
void surface_factor(benchmark::State& state) {  // the line contact has half as many elements as the tail
  run(state, windlass::test::spatial_coil(tension, 2 * static_cast<int>(state.range(0))), line, true);
}

}  // namespace

BENCHMARK(planar_gradient)->RangeMultiplier(4)->Range(4, 256)->Complexity(benchmark::oN);
BENCHMARK(planar_factor)->RangeMultiplier(4)->Range(4, 256)->Complexity(benchmark::oN);
BENCHMARK(kirchhoff_gradient)->RangeMultiplier(4)->Range(4, 256)->Complexity(benchmark::oN);
BENCHMARK(kirchhoff_factor)->RangeMultiplier(4)->Range(4, 256)->Complexity(benchmark::oN);
BENCHMARK(surface_factor)->RangeMultiplier(4)->Range(4, 256)->Complexity(benchmark::oN);
BENCHMARK_MAIN();
