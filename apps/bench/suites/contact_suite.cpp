// Bodies that bounce, turn over, rub and stick, at tolerances 1e-3 ... 1e-11, against exact motions.
#include <fmt/format.h>

#include <cmath>
#include <functional>

#include "catena/scene/loading/scene.hpp"
#include "suites/contact_problems.hpp"
#include "suites/suites.hpp"

namespace bench {

using namespace catena;

namespace {

struct TouchingProblem {
  std::string_view name;
  int bodies;
  std::string text;  ///< of the scene, but for its analysis
  double until;
  std::string outputs;
  double error_growth;  ///< the largest error over the tolerance that is right
  std::function<double(const AnalysisOutcome&)> error;
};

double last(const AnalysisOutcome& run, const std::string& column) { return run.column(column).back(); }

constexpr const char* floor_curve = R"("curve": {"line": {"point": [0, 0], "axis": [1, 0]}})";

/// Ten times the tolerance (README.md), once more for each impact that may let an error grow.
constexpr double growth_of_impacts = 100;

TouchingProblem bouncing_balls() {
  using Of = BouncingBalls;
  std::string bodies, contacts, outputs;
  for (int k = 0; k < Of::count; ++k) {
    const char* comma = k == 0 ? "" : ",";
    bodies += fmt::format(R"({}"ball{}": {{"mass": {}, "inertia": {}, "position": [{:.17g}, {:.17g}]}})", comma, k,
                          Of::mass, 0.4 * Of::mass * Of::radius * Of::radius, Of::ball(k).x, Of::ball(k).y);
    contacts +=
        fmt::format(R"({}{{"type": "contact", "i": "ground", "j": "ball{}", "radius": {}, "restitution": {}, {}}})",
                    comma, k, Of::radius, Of::restitution, floor_curve);
    outputs += fmt::format(R"({}"ball{}.y")", comma, k);
  }
  return {.name = Of::name,
          .bodies = Of::count,
          .text = fmt::format(R"("bodies": {{{}}}, "forces": [{}])", bodies, contacts),
          .until = Of::until,
          .outputs = outputs,
          .error_growth = growth_of_impacts,
          .error = [](const AnalysisOutcome& run) {
            double worst = 0;
            for (int k = 0; k < Of::count; ++k)
              worst =
                  std::max(worst, std::abs(last(run, fmt::format("ball{}.y", k)) - static_cast<double>(exact_ball(k))));
            return worst;
          }};
}

TouchingProblem bouncing_dumbbells() {
  using Of = BouncingDumbbells;
  std::string bodies, contacts, outputs;
  for (int k = 0; k < Of::count; ++k) {
    const char* comma = k == 0 ? "" : ",";
    const Dumbbell start = Of::dumbbell(k);
    bodies += fmt::format(
        R"({}"bar{}": {{"mass": {}, "inertia": {}, "position": [{:.17g}, {:.17g}], "angle": {:.17g}, "angular_velocity": {:.17g},
 "points": {{"right": [{}, 0], "left": [{}, 0]}}}})",
        comma, k, Of::mass, Of::inertia, start.x, start.y, start.angle, start.spin, Of::half_length, -Of::half_length);
    for (const char* end : {"right", "left"})
      contacts +=
          fmt::format(R"({}{{"type": "contact", "i": "ground", "j": "bar{}.{}", "radius": {}, "restitution": {}, {}}})",
                      contacts.empty() ? "" : ",", k, end, Of::radius, Of::restitution, floor_curve);
    outputs += fmt::format(R"({0}"bar{1}.y","bar{1}.angle")", comma, k);
  }
  return {.name = Of::name,
          .bodies = Of::count,
          .text = fmt::format(R"("bodies": {{{}}}, "forces": [{}])", bodies, contacts),
          .until = Of::until,
          .outputs = outputs,
          .error_growth = growth_of_impacts,
          .error = [](const AnalysisOutcome& run) {
            double worst = 0;
            for (int k = 0; k < Of::count; ++k) {
              const auto exact = exact_dumbbell(k);
              worst = std::max(worst, std::abs(last(run, fmt::format("bar{}.y", k)) - static_cast<double>(exact[0])));
              worst = std::max(worst, Of::half_length * std::abs(last(run, fmt::format("bar{}.angle", k)) -
                                                                 static_cast<double>(exact[1])));
            }
            return worst;
          }};
}

TouchingProblem rubbing_block() {
  using Of = RubbingBlock;
  return {
      .name = Of::name,
      .bodies = 1,
      .text = fmt::format(
          R"("bodies": {{"block": {{"mass": {}, "particle": true, "position": [{}, {}]}}}},
 "forces": [{{"type": "contact", "i": "ground", "j": "block", "radius": {}, "mu": {}, {}}},
            {{"type": "spring_damper", "i": ["ground", [-10, {}]], "j": "block", "k": {}, "length": 10}}])",
          Of::mass, Of::start, Of::half_size, Of::half_size, Of::friction, floor_curve, Of::half_size, Of::stiffness),
      .until = Of::until,
      .outputs = R"("block.x")",
      .error_growth = growth_of_impacts,
      .error = [](const AnalysisOutcome& run) {
        return std::abs(last(run, "block.x") - static_cast<double>(exact_block()));
      }};
}

void measure_touching(Bench& bench, const TouchingProblem& problem, double tolerance) {
  Row row{.suite = "contact",
          .problem = std::string(problem.name),
          .method = "scene",
          .setting = tolerance_text(tolerance),
          .bodies = problem.bodies,
          .allowed = std::max(problem.error_growth * tolerance, 1e-10),
          .error_of = "worst place, m",
          .reference = "closed forms between impacts in 64 bits"};
  if (!bench.wants(row)) return;
  Scene scene = Scene::loads(fmt::format(
      R"({{"catena": 1, "gravity": [0, {:.17g}], {}, "outputs": [{}], "analyses": [{{"type": "dynamics", "at": [{}], "tolerance": {}}}]}})",
      -contact_gravity, problem.text, problem.outputs, problem.until, tolerance));
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
  for (const TouchingProblem& problem : {bouncing_balls(), bouncing_dumbbells(), rubbing_block()}) {
    for (int digits = bench.brief() ? 4 : 3; digits <= (bench.brief() ? 8 : 11); digits += bench.brief() ? 4 : 1)
      measure_touching(bench, problem, std::pow(10, -digits));
  }
}

}  // namespace bench
