// The parts that every analysis is made of, a call each: plan, Jacobian, accelerations, factorization with a solve.
//
//   plan            3 columns and 2 rows a rod, 8 entries of Phi_q a pin, 4 of that in the ground
//   Jacobian        Phi_q v = 0 for velocities v that keep the pins together, in units of the largest |v|
//   accelerations   of the tip, against Newton and Euler in 64 bits
//   factorizations  A x = b for a known x
#include <cmath>

#include "cases/chain_kernels.hpp"
#include "catena/analysis/kinematics/kinematics.hpp"
#include "mechanisms.hpp"
#include "suites/suites.hpp"

namespace bench {

using namespace catena;

namespace {

std::vector<double> product(const SparsePattern& pattern, std::span<const double> values, std::span<const double> x) {
  std::vector<double> y(static_cast<std::size_t>(pattern.rows));
  for (int c = 0; c < pattern.columns; ++c) {
    const auto column = static_cast<std::size_t>(c);
    for (int k = pattern.column_start[column]; k < pattern.column_start[column + 1]; ++k)
      y[static_cast<std::size_t>(pattern.row_index[static_cast<std::size_t>(k)])] +=
          values[static_cast<std::size_t>(k)] * x[column];
  }
  return y;
}

double largest(std::span<const double> values) {
  double most = 0;
  for (const double v : values) most = std::max(most, std::abs(v));
  return most;
}

void plan(Bench& bench, int rods) {
  Row row{.suite = "kernels", .problem = "chain of rods", .method = "plan", .bodies = rods};
  row.error_of = "columns, rows and entries of Phi_q too many";
  row.reference = "3 and 2 a rod, 8 a pin, 4 of that in the ground";
  row.allowed = 0;
  if (!bench.wants(row)) return;
  const auto model = chain(rods);
  const auto made = Plan::make(*model);
  row.error = std::abs(made->columns - 3 * rods) + std::abs(made->rows - 2 * rods) +
              std::abs(made->jacobian.entries() - (8 * rods - 4));
  bench.time(row, [&] { Plan::make(*model); });
  bench.add(std::move(row));
}

void jacobian(Bench& bench, int rods) {
  Row row{.suite = "kernels", .problem = "chain of rods", .method = "Jacobian", .bodies = rods};
  row.error_of = "rates of the pins' gaps, relative";
  row.reference = "velocities of a chain whose pins hold";
  row.allowed = 1e-12;
  if (!bench.wants(row)) return;
  ChainKernel kernel(rods);
  Evaluator& evaluator = kernel.evaluator;
  std::vector<double> values(static_cast<std::size_t>(evaluator.plan().trash_slot()) + 1);
  evaluator.start_jacobian(values);
  const auto evaluate = [&] {
    evaluator.set_configuration(kernel.q);
    evaluator.jacobian(values);
  };
  evaluate();
  row.error = largest(product(evaluator.plan().jacobian, values, kernel.qd)) / largest(kernel.qd);
  bench.time(row, evaluate);
  bench.add(std::move(row));
}

void factorization(Bench& bench, int dyads, const char* name, Kernel kernel) {
  Row row{.suite = "kernels", .problem = "four-bars in a row", .method = name, .bodies = 2 * dyads + 1};
  row.error_of = "solution, relative";
  row.reference = "A x = b for a known x";
  // A chain of four-bars that each halve and double motions: the condition of Phi_q stays below 1e4.
  row.allowed = 1e-9;
  if (!bench.wants(row)) return;
  Kinematics kinematics(dyad_ladder(dyads));
  if (!kinematics.move_to(0).ok()) return;
  const SparsePattern& pattern = kinematics.plan().jacobian;
  Evaluator& evaluator = kinematics.evaluator();
  std::vector<double> values(static_cast<std::size_t>(kinematics.plan().trash_slot()) + 1);
  evaluator.start_jacobian(values);
  evaluator.set_configuration(kinematics.q());
  evaluator.jacobian(values);
  values.pop_back();
  std::vector<double> known(static_cast<std::size_t>(pattern.columns));
  for (std::size_t k = 0; k < known.size(); ++k) known[k] = std::cos(static_cast<double>(k));
  const std::vector<double> right = product(pattern, values, known);
  std::vector<double> x = right;
  Counters counters;
  Factorization factors;
  bool ok = factors.analyze(pattern, kernel, counters).ok();
  const auto solve = [&] {
    ok = ok && factors.factorize(values, counters).ok();
    if (!ok) return;
    x = right;
    factors.solve(x, counters);
  };
  solve();
  if (ok) {
    row.error = 0;
    for (std::size_t k = 0; k < x.size(); ++k) row.error = std::max(row.error, std::abs(x[k] - known[k]));
    bench.time(row, solve);
  } else {
    row.failure = std::string(name) + " does not factor the matrix, or is not in this build";
  }
  bench.add(std::move(row));
}

}  // namespace

ChainKernel::ChainKernel(int rods)
    : exact(rods),
      model(chain(rods)),
      evaluator(Plan::make(*model), *model, work),
      q(evaluator.given_configuration()),
      qd(q.size()) {
  const Plan& plan = evaluator.plan();
  Vec2<double> tip{};
  for (int b = 0; b < rods; ++b) {
    const auto k = 3 * static_cast<std::size_t>(plan.plan_body[static_cast<std::size_t>(b)]);
    const double angle = model->bodies[static_cast<std::size_t>(b)].angle, rate = 0.1 * std::cos(b + 1.0);
    exact.angle[static_cast<std::size_t>(b)] = angle;
    exact.rate[static_cast<std::size_t>(b)] = rate;
    const Vec2<double> half{-0.5 * rate * std::sin(angle), 0.5 * rate * std::cos(angle)};
    qd[k] = tip.x + half.x, qd[k + 1] = tip.y + half.y, qd[k + 2] = rate;
    tip += 2.0 * half;
  }
}

double ChainKernel::tip_error(std::span<const double> qdd) const {
  const auto k = 3 * static_cast<std::size_t>(evaluator.plan().plan_body.back());
  const long double phi = exact.angle.back(), w = exact.rate.back(), alpha = qdd[k + 2];
  const long double c = 0.5L * std::cos(phi), s = 0.5L * std::sin(phi);
  const Vec2<long double> tip{qdd[k] - s * alpha - c * w * w, qdd[k + 1] + c * alpha - s * w * w};
  return static_cast<double>(norm(tip - exact.tip_acceleration()));
}

void measure_accelerations(Bench& bench, const char* suite, int rods) {
  Row row{.suite = suite, .problem = "chain of rods", .method = "accelerations", .bodies = rods};
  row.error_of = "acceleration of the tip, m/s^2";
  row.reference = "Newton-Euler in 64 bits";
  row.allowed = 1e-9;  // of 10 m/s^2, over places of up to 10^6 m in double precision
  if (!bench.wants(row)) return;
  const double before = held_bytes();
  ChainKernel kernel(rods);
  EquationsOfMotion equations(kernel.evaluator);
  std::vector<double> qdd(kernel.q.size());
  bool ok = equations.use_masses().ok() && equations.accelerations(0, Side::after, kernel.q, kernel.qd, qdd);
  // Without the exact chain's two numbers of 16 bytes a rod.
  row.bytes_per_body = (held_bytes() - before) / rods - 32;
  if (ok) {
    row.error = kernel.tip_error(qdd);
    bench.time(row, [&] { ok = ok && equations.accelerations(0, Side::after, kernel.q, kernel.qd, qdd); });
  }
  if (!ok) row.failure = "no accelerations";
  bench.add(std::move(row));
}

void kernels_suite(Bench& bench) {
  for (const int bodies : bench.brief() ? std::vector{10} : std::vector{10, 1000, 100000}) {
    plan(bench, bodies);
    jacobian(bench, bodies);
    measure_accelerations(bench, "kernels", bodies);
    factorization(bench, bodies / 2, "KLU's pivots, lists", Kernel::klu);
    if (is_compiled_in(Kernel::umfpack)) factorization(bench, bodies / 2, "UMFPACK", Kernel::umfpack);
  }
}

}  // namespace bench
