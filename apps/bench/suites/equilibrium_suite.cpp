// A chain between two pins by every solver and from several starts, error of its joints against the exact shape; small
// oscillations of masses between springs against their closed form.
#include <cmath>

#include "cases/resting_chains.hpp"
#include "catena/analysis/stability/modes.hpp"
#include "catena/analysis/statics/equilibrium.hpp"
#include "suites/suites.hpp"

namespace bench {

using namespace catena;

namespace {

void at_rest(Bench& bench, int rods, ChainStart start, const char* method, StaticSolver solver) {
  Row row{.suite = "equilibrium",
          .problem = "chain between pins",
          .method = method,
          .setting = std::string("from ") + name_of(start),
          .bodies = rods,
          .allowed = 1e-8,  // 1e-11 of the largest force, over the softest stiffness of a chain in units of its weight
          .error_of = "worst joint, m a rod",
          .reference = "tangents of the angles, bisection in 64 bits"};
  if (!bench.wants(row)) return;
  const auto model = chain_between_pins(rods, start);
  const double before = held_bytes();
  Equilibrium chain(model, {}, {.solver = solver});
  const EquilibriumReport report = chain.solve();
  row.bytes_per_body = (held_bytes() - before) / rods;
  row.counts = named_counts(report.counters);
  row.counts.emplace_back("outer iterations", report.iterations);
  if (report.ok() && report.stable) {
    row.error = error_at_rest(chain.state().q);
    bench.time(row, [&] { Equilibrium(model, {}, {.solver = solver}).solve(); });
  } else {
    row.failure = report.ok() ? "not stable" : report.message;
  }
  bench.add(std::move(row));
}

void oscillations(Bench& bench, int masses) {
  Row row{.suite = "equilibrium",
          .problem = "masses between springs",
          .method = "modes",
          .setting = "ten lowest",
          .bodies = masses,
          .error_of = "worst frequency, relative",
          .reference = "closed form"};
  // Eigenvalues are right to rounding of the largest: the lowest, omega^2 = k/m (pi / n)^2, lose (n / pi)^2.
  row.allowed = 1e-13 * masses * masses + 1e-12;
  if (!bench.wants(row)) return;
  const auto model = masses_between_springs(masses);
  const double before = held_bytes();
  Modes modes(model, {}, {.count = 10});
  const ModesReport report = modes.run();
  row.bytes_per_body = (held_bytes() - before) / masses;
  row.counts = named_counts(report.counters);
  if (report.ok() && report.omega.size() >= 10) {
    row.error = 0;
    for (int j = 1; j <= 10; ++j)
      row.error =
          std::max(row.error, std::abs(report.omega[static_cast<std::size_t>(j - 1)] / exact_frequency(masses, j) - 1));
    bench.time(row, [&] { Modes(model, {}, {.count = 10}).run(); });
  } else {
    row.failure = report.ok() ? "fewer than ten modes" : report.message;
  }
  bench.add(std::move(row));
}

}  // namespace

void equilibrium_suite(Bench& bench) {
  const std::vector<int> sizes = bench.brief() ? std::vector{10} : std::vector{10, 100, 1000, 10000};
  for (const int rods : sizes) {
    for (const ChainStart start : {ChainStart::bent, ChainStart::zigzag, ChainStart::random})
      at_rest(bench, rods, start, "newton", StaticSolver::newton);
    at_rest(bench, rods, ChainStart::bent, "auto", StaticSolver::automatic);
    if (rods <= 1000) at_rest(bench, rods, ChainStart::bent, "ipopt", StaticSolver::ipopt);
  }
  for (const int masses : sizes) oscillations(bench, masses);
}

}  // namespace bench
