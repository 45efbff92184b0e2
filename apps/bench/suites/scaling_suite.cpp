// How run times and memory grow with the number of bodies: 10 ... 10^6, every row with its error.
//
// A row's time is that of one evaluation, one step, or one whole analysis, as its method says; slopes of log time over
// log bodies are fitted by slopes.hpp.
#include <fmt/format.h>

#include <cmath>

#include "cases/chain_kernels.hpp"
#include "cases/driven_problems.hpp"
#include "cases/resting_chains.hpp"
#include "catena/analysis/dynamics/dynamics.hpp"
#include "catena/analysis/kinematics/kinematics.hpp"
#include "catena/analysis/statics/equilibrium.hpp"
#include "catena/results/stored_results.hpp"
#include "catena/scene/running/scene_runner.hpp"
#include "moving_mechanisms.hpp"
#include "suites/suites.hpp"

namespace bench {

using namespace catena;

namespace {

void kinematic_step(Bench& bench, const DrivenProblem& problem, int bodies) {
  const int size = bodies / problem.bodies_per_size;
  Row row{.suite = "scaling", .problem = problem.name, .method = "kinematic step", .bodies = bodies};
  row.error_of = problem.error_of;
  row.reference = "closed form in 64 bits";
  row.allowed = problem.rounding;
  if (!bench.wants(row)) return;
  const double before = held_bytes();
  const auto model = problem.make(size);
  Kinematics kinematics(model);
  const double h = 0.005;
  const int warm_up = 3, steps = std::clamp(100000 / bodies, 2, 100);
  RowFunction nothing([](const Snapshot&) { return true; });
  const Needs needs{.velocity = true, .acceleration = true};
  AnalysisReport report = kinematics.run(TimeGrid::range(0, warm_up * h, h), needs, nothing);
  row.bytes_per_body = (held_bytes() - before) / bodies;
  std::int64_t done = warm_up;
  if (report.ok()) {
    bench.time(
        row,
        [&] {
          if (!report.ok()) return;
          const auto from = static_cast<double>(done) * h;
          done += steps;
          report = kinematics.run(TimeGrid::range(from, static_cast<double>(done) * h, h), needs, nothing);
        },
        steps);
    row.counts = named_counts(report.counters);
  }
  if (report.ok()) {
    row.error = problem.error(kinematics.state().q, size, kinematics.time());
  } else {
    row.failure = report.message;
  }
  bench.add(std::move(row));
}

/// The chain falls for 0.05 s. Rods far from the pin stay level and fall freely: a pin's upright force is 2 - sqrt(3) =
/// 0.27 of that of the pin before, so that after 100 rods nothing is left of it in 64 bits. They are the exact chain's
/// tail.
void fall(Bench& bench, int rods) {
  constexpr double until = 0.05;
  Row row{.suite = "scaling", .problem = "rods fall", .method = "dynamics step", .setting = "1e-08", .bodies = rods};
  row.error_of = "worst height of a rod, m";
  row.reference = "Newton-Euler in 64 bits, free fall far from the pin";
  row.allowed = 1e-6;  // ten times the tolerance, over 10 m: heights of the first rods differ by that much
  if (!bench.wants(row)) return;
  const double before = held_bytes();
  const auto model = straight_chain(rods);
  Dynamics dynamics(model, {}, {.method = IntegrationMethod::adams, .tolerance = 1e-8});
  RowFunction nothing([](const Snapshot&) { return true; });
  const AnalysisReport report = dynamics.run(TimeGrid::instant(until), {}, nothing);
  row.bytes_per_body = (held_bytes() - before) / rods;
  row.counts = named_counts(report.counters);
  if (report.ok()) {
    ExactChain exact(std::min(rods, 100));
    exact.tail = rods - static_cast<int>(exact.angle.size());
    exact.move(until, 5);
    const auto ends = exact.ends();
    const std::vector<double> q = dynamics.state().q;
    long double worst = 0;
    for (std::size_t b = 0; 3 * b < q.size(); ++b) {
      const long double y =
          b >= ends.size() ? -0.5L * 9.81L * until * until : ends[b].y - 0.5L * std::sin(exact.angle[b]);
      worst = std::max(worst, std::abs(q[3 * b + 1] - y));
    }
    row.error = static_cast<double>(worst);
    const auto steps = static_cast<double>(std::max<std::int64_t>(report.counters.steps, 1));
    const auto again = [&] {
      Dynamics motion(model, {}, {.method = IntegrationMethod::adams, .tolerance = 1e-8});
      motion.run(TimeGrid::instant(until), {}, nothing);
    };
    bench.time(row, again, steps);
  } else {
    row.failure = report.message;
  }
  bench.add(std::move(row));
}

void rest(Bench& bench, int rods) {
  Row row{.suite = "scaling", .problem = "chain between pins", .method = "equilibrium", .bodies = rods};
  row.error_of = "worst joint, m a rod";
  row.reference = "tangents of the angles, bisection in 64 bits";
  row.allowed = 1e-8;
  if (!bench.wants(row)) return;
  const double before = held_bytes();
  const auto model = chain_between_pins(rods, ChainStart::bent);
  Equilibrium chain(model, {}, {.solver = StaticSolver::newton});
  const EquilibriumReport report = chain.solve();
  row.bytes_per_body = (held_bytes() - before) / rods;
  row.counts = named_counts(report.counters);
  if (report.ok()) {
    row.error = error_at_rest(chain.state().q);
    bench.time(row, [&] { Equilibrium(model, {}, {.solver = StaticSolver::newton}).solve(); });
  } else {
    row.failure = report.message;
  }
  bench.add(std::move(row));
}

/// The same chain as a scene of its own, read from text, over its rows.
std::string scene_text(int rods) {
  return fmt::format(
      R"json({{"catena": 1, "gravity": [0, -9.81], "replicate": [{{"count": {0}, "bodies": {{"link{{k}}": {{
 "mass": 1, "inertia": "=1/12", "position": ["=0.8*(k-0.5)", 0], "angle": "=acos(0.8)*(-1)^k",
 "points": {{"from": [-0.5, 0], "to": [0.5, 0]}}}}}}}}, {{"count": {1}, "first": 2, "constraints": [
 {{"type": "revolute", "name": "pin{{k}}", "i": "link{{k-1}}.to", "j": "link{{k}}.from"}}]}}],
 "constraints": [{{"type": "revolute", "name": "left", "i": "ground", "j": "link1.from"}},
 {{"type": "revolute", "name": "right", "i": ["ground", ["=0.8*{0}", 0]], "j": "link{0}.to"}}],
 "analyses": [{{"type": "equilibrium"}}], "outputs": ["left.fx", "link1.angle"]}})json",
      rods, rods - 1);
}

void read_and_rest(Bench& bench, int rods) {
  Row row{.suite = "scaling", .problem = "chain between pins", .method = "scene, read to results", .bodies = rods};
  row.error_of = "angle of the first rod, rad";
  row.reference = "tangents of the angles, bisection in 64 bits";
  row.allowed = 1e-8;
  if (!bench.wants(row)) return;
  RunOptions options;
  options.text = scene_text(rods);
  SceneOutcome outcome;
  double angle = 0;
  bench.time(row, [&] {
    StoredResults results;
    outcome = run_scene("chain", options, results);
    if (outcome.exit_code == 0) angle = results.rows.front()->column("link1.angle").front();
  });
  if (outcome.exit_code == 0) {
    const Vec2<long double> end = ends_at_rest(rods, 0.8).front();
    row.error =
        static_cast<double>(std::abs(std::remainder(angle - std::atan2(end.y, end.x), 2 * 3.14159265358979323846L)));
    row.counts = named_counts(outcome.analyses.front().report.counters);
  } else {
    row.failure = outcome.error_text;
  }
  bench.add(std::move(row));
}

/// Level rods of 1 m and 1 kg that fall on a floor, rigid with restitution or on springs with dampers: mechanisms side
/// by side, of which each has its own impacts and comes to rest before the end.
std::string falling_rods_text(int rods, bool rigid) {
  const char* floor = rigid ? R"("restitution": 0.4)" : R"("k": 1e4, "c": 100)";
  return fmt::format(
      R"json({{"catena": 1, "gravity": [0, -9.81], "replicate": [{{"count": {0}, "bodies": {{"rod{{k}}": {{"mass": 1,
 "rod": {{"from": ["=2*k", "=0.1+0.4*abs(sin(7*k))"], "to": ["=2*k+1", "=0.1+0.4*abs(sin(7*k))"]}}}}}}, "forces": [
 {{"type": "contact", "i": "ground", "j": "rod{{k}}.from", {1}, "curve": {{"line": {{"point": [0, 0], "axis": [1, 0]}}}}}},
 {{"type": "contact", "i": "ground", "j": "rod{{k}}.to", {1}, "curve": {{"line": {{"point": [0, 0], "axis": [1, 0]}}}}}}]}}],
 "analyses": [{{"type": "dynamics", "until": 1.2, "tolerance": 1e-8}}], "outputs": ["rod1.y", "rod{0}.y"]}})json",
      rods, floor);
}

void fall_on_floor(Bench& bench, int rods, bool rigid) {
  Row row{.suite = "scaling",
          .problem = rigid ? "rods fall on a floor, rigid" : "rods fall on a floor, on springs",
          .method = "scene, read to results",
          .setting = "1e-08",
          .bodies = rods};
  row.error_of = "height at rest, m";
  row.reference = rigid ? "the floor" : "m g / 2 k below the floor";
  row.allowed = 1e-8;
  if (!bench.wants(row)) return;
  RunOptions options;
  options.text = falling_rods_text(rods, rigid);
  const double rest = rigid ? 0 : -9.81 / 2e4;
  SceneOutcome outcome;
  bench.time(row, [&] {
    StoredResults results;
    outcome = run_scene("rods", options, results);
    if (outcome.exit_code != 0) return;
    row.error = 0;
    for (const std::string& name : {std::string("rod1.y"), fmt::format("rod{}.y", rods)})
      row.error = std::max(row.error, std::abs(results.rows.front()->column(name).back() - rest));
  });
  if (outcome.exit_code == 0) {
    row.counts = named_counts(outcome.analyses.front().report.counters);
  } else {
    row.failure = outcome.error_text;
  }
  bench.add(std::move(row));
}

}  // namespace

void scaling_suite(Bench& bench) {
  for (int bodies = 10; bodies <= (bench.brief() ? 100 : 1000000); bodies *= 10) {
    measure_accelerations(bench, "scaling", bodies);
    for (const DrivenProblem& problem : driven_problems()) {
      // A million bodies take a second a step: two linkages say enough.
      if (bodies <= 100000 || problem.bodies_per_size == 1 || &problem == &driven_problems().front())
        kinematic_step(bench, problem, bodies);
    }
    // The tail's pull makes the first rods stiffer, and steps more, the longer the chain: minutes for a million rods.
    if (bodies <= 100000) fall(bench, bodies);
    rest(bench, bodies);
    read_and_rest(bench, bodies);
    // Each rod has some dozen changes: ten times as many bodies take ten times as long.
    if (bodies <= 1000) {
      for (const bool rigid : {true, false}) fall_on_floor(bench, bodies, rigid);
    }
  }
}

}  // namespace bench
