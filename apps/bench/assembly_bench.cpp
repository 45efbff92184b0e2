// Evaluation and planning: trigonometry + Phi_q of the revolute chain, and the plan, in nanoseconds a body.
#include <benchmark/benchmark.h>

#include "catena/assembly/evaluate.hpp"
#include "mechanisms.hpp"

namespace {

void per_body(benchmark::State& state, int bodies) {
  state.counters["ns/body"] = benchmark::Counter(static_cast<double>(state.iterations()) * bodies * 1e-9,
                                                 benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void jacobian(benchmark::State& state) {
  const auto model = bench::chain(static_cast<int>(state.range(0)));
  catena::EvaluationWork work;
  catena::Evaluator evaluator(catena::Plan::make(*model), *model, work);
  const std::vector<double> q = evaluator.given_configuration();
  std::vector<double> values(static_cast<std::size_t>(evaluator.plan().trash_slot()) + 1);
  evaluator.start_jacobian(values);
  for (auto _ : state) {
    evaluator.set_configuration(q);
    evaluator.jacobian(values);
    benchmark::ClobberMemory();
  }
  per_body(state, static_cast<int>(state.range(0)));
}

void plan(benchmark::State& state) {
  const auto model = bench::chain(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(catena::Plan::make(*model));
  per_body(state, static_cast<int>(state.range(0)));
}

}  // namespace

BENCHMARK(jacobian)->RangeMultiplier(10)->Range(100, 1000000)->Unit(benchmark::kMicrosecond);
BENCHMARK(plan)->RangeMultiplier(10)->Range(100, 1000000)->Unit(benchmark::kMicrosecond);
