// Bodies that bounce, turn over, rub and stick, at tolerances 1e-3 ... 1e-11, against exact motions. Without digits,
// which are a second run's: no engine beside gives any.
#include <fmt/format.h>

#include <cmath>
#include <functional>

#include "cases/contact_problems.hpp"
#include "catena/scene/loading/scene.hpp"
#include "suites/suites.hpp"

namespace bench {

using namespace catena;

namespace {

struct TouchingProblem {
  std::string_view name;
  int bodies;
  double until;
  std::string body_list{}, constraints{}, forces{}, outputs{};  ///< of the scene
  std::function<double(const AnalysisOutcome&)> error{};
};

double last(const AnalysisOutcome& run, const std::string& column) { return run.column(column).back(); }

/// A contact of this place with the floor.
std::string contact_of(const std::string& place, double radius, const std::string& keys) {
  return fmt::format(
      R"({{"type": "contact", "i": "ground", "j": "{}", "radius": {}, {},
 "curve": {{"line": {{"point": [0, 0], "axis": [1, 0]}}}}}})",
      place, radius, keys);
}

std::string restitution_of(double e) { return fmt::format(R"("restitution": {})", e); }

double off(const AnalysisOutcome& run, const std::string& column, long double exact) {
  return std::abs(last(run, column) - static_cast<double>(exact));
}

/// Adds to a list of a scene.
void add_to(std::string& list, const std::string& entry) { list += (list.empty() ? "" : ", ") + entry; }

TouchingProblem bouncing_balls() {
  using Of = BouncingBalls;
  TouchingProblem problem{.name = Of::name, .bodies = Of::count, .until = Of::until};
  for (int k = 0; k < Of::count; ++k) {
    const std::string ball = fmt::format("ball{}", k);
    add_to(problem.body_list,
           fmt::format(R"("{}": {{"mass": {}, "inertia": {}, "position": [{:.17g}, {:.17g}]}})", ball, Of::mass,
                       0.4 * Of::mass * Of::radius * Of::radius, Of::ball(k).x, Of::ball(k).y));
    add_to(problem.forces, contact_of(ball, Of::radius, restitution_of(Of::restitution)));
    add_to(problem.outputs, fmt::format(R"("{}.y")", ball));
  }
  problem.error = [](const AnalysisOutcome& run) {
    double worst = 0;
    for (int k = 0; k < Of::count; ++k) worst = std::max(worst, off(run, fmt::format("ball{}.y", k), exact_ball(k)));
    return worst;
  };
  return problem;
}

TouchingProblem bouncing_dumbbells() {
  using Of = BouncingDumbbells;
  TouchingProblem problem{.name = Of::name, .bodies = Of::count, .until = Of::until};
  for (int k = 0; k < Of::count; ++k) {
    const std::string bar = fmt::format("bar{}", k);
    const Dumbbell start = Of::dumbbell(k);
    add_to(problem.body_list,
           fmt::format(R"("{}": {{"mass": {}, "inertia": {}, "position": [{:.17g}, {:.17g}], "angle": {:.17g},
 "angular_velocity": {:.17g}, "points": {{"right": [{}, 0], "left": [{}, 0]}}}})",
                       bar, Of::mass, Of::inertia, start.x, start.y, start.angle, start.spin, Of::half_length,
                       -Of::half_length));
    for (const char* end : {".right", ".left"})
      add_to(problem.forces, contact_of(bar + end, Of::radius, restitution_of(Of::restitution)));
    add_to(problem.outputs, fmt::format(R"("{0}.y", "{0}.angle")", bar));
  }
  problem.error = [](const AnalysisOutcome& run) {
    double worst = 0;
    for (int k = 0; k < Of::count; ++k) {
      const auto [y, angle] = exact_dumbbell(k);
      worst = std::max({worst, off(run, fmt::format("bar{}.y", k), y),
                        Of::half_length * off(run, fmt::format("bar{}.angle", k), angle)});
    }
    return worst;
  };
  return problem;
}

TouchingProblem rubbing_block() {
  using Of = RubbingBlock;
  TouchingProblem problem{.name = Of::name, .bodies = 1, .until = Of::until, .outputs = R"("block.x")"};
  problem.body_list = fmt::format(R"("block": {{"mass": {}, "particle": true, "position": [{}, {}]}})", Of::mass,
                                  Of::start, Of::half_size);
  problem.forces = contact_of("block", Of::half_size, fmt::format(R"("mu": {})", Of::friction));
  add_to(problem.forces,
         fmt::format(R"({{"type": "spring_damper", "i": ["ground", [-10, {}]], "j": "block", "k": {}, "length": 10}})",
                     Of::half_size, Of::stiffness));
  problem.error = [](const AnalysisOutcome& run) { return off(run, "block.x", exact_block()); };
  return problem;
}

TouchingProblem sliding_chain() {
  using Of = SlidingChain;
  TouchingProblem problem{.name = Of::name, .bodies = Of::count, .until = Of::until};
  const std::string rubs = fmt::format(R"("mu": {})", Of::friction);
  for (int k = 0; k < Of::count; ++k) {
    const std::string link = fmt::format("link{}", k);
    add_to(problem.body_list,
           fmt::format(R"("{}": {{"mass": {}, "inertia": {}, "position": [{:.17g}, {:.17g}], "velocity": [{}, 0],
 "points": {{"right": [{}, 0], "left": [{}, 0]}}}})",
                       link, Of::mass, Of::inertia, Of::x(k), Of::radius + Of::drop, Of::speed, Of::half_length,
                       -Of::half_length));
    add_to(problem.forces, contact_of(link + ".left", Of::radius, rubs));
    if (k > 0)
      add_to(problem.constraints,
             fmt::format(R"({{"type": "revolute", "i": "link{}.right", "j": "{}.left"}})", k - 1, link));
    add_to(problem.outputs, fmt::format(R"("{}.x")", link));
  }
  add_to(problem.forces, contact_of(fmt::format("link{}.right", Of::count - 1), Of::radius, rubs));
  problem.error = [](const AnalysisOutcome& run) {
    double worst = 0;
    for (int k = 0; k < Of::count; ++k)
      worst = std::max(worst, off(run, fmt::format("link{}.x", k), Of::x(k) + exact_slide()));
    return worst;
  };
  return problem;
}

void measure_touching(Bench& bench, const TouchingProblem& problem, double tolerance) {
  Row row{.suite = "contact",
          .problem = std::string(problem.name),
          .method = "scene",
          .setting = tolerance_text(tolerance),
          .bodies = problem.bodies,
          .allowed = 10 * tolerance,  // README.md
          .error_of = "worst place, m",
          .reference = "closed forms between impacts in 64 bits"};
  if (!bench.wants(row)) return;
  Scene scene = Scene::loads(fmt::format(
      R"({{"catena": 1, "gravity": [0, {:.17g}], "bodies": {{{}}}, "constraints": [{}], "forces": [{}], "outputs": [{}],
 "analyses": [{{"type": "dynamics", "at": [{}], "tolerance": {}, "digits": false}}]}})",
      -contact_gravity, problem.body_list, problem.constraints, problem.forces, problem.outputs, problem.until,
      tolerance));
  const SceneResults results = scene.run();
  const AnalysisOutcome& run = results["dynamics"];
  row.counts = named_counts(run.report().counters);
  if (run.ok()) {
    row.error = problem.error(run);
    bench.time(row, [&] { scene.run(); });
  } else {
    row.failure = run.report().message;
  }
  bench.add(std::move(row));
}

}  // namespace

void contact_suite(Bench& bench) {
  for (const TouchingProblem& problem : {bouncing_balls(), bouncing_dumbbells(), rubbing_block(), sliding_chain()}) {
    for (int digits = bench.brief() ? 4 : 3; digits <= (bench.brief() ? 8 : 11); digits += bench.brief() ? 4 : 1)
      measure_touching(bench, problem, std::pow(10, -digits));
  }
}

}  // namespace bench
