// Driven linkages over one second: error of positions against closed forms by tolerance; and a slider-crank with its
// velocities and accelerations.
#include <cmath>
#include <functional>

#include "cases/driven_problems.hpp"
#include "catena/analysis/kinematics/kinematics.hpp"
#include "catena/elements/constraints/absolute_angle.hpp"
#include "catena/elements/constraints/absolute_y.hpp"
#include "catena/elements/constraints/revolute.hpp"
#include "catena/model/model_add.hpp"
#include "mechanisms.hpp"
#include "suites/suites.hpp"

namespace bench {

using namespace catena;

namespace {

struct Motion {
  std::shared_ptr<Model> model;
  TimeGrid grid;
  KinematicsOptions options{};
  Needs needs{};
};

/// Runs once for errors and counts, then for the time, without looking at the rows.
void measure(Bench& bench, Row row, const Motion& motion, const std::function<double(const Snapshot&)>& error) {
  row.suite = "kinematics";
  row.setting = tolerance_text(motion.options.tolerance);
  row.bodies = static_cast<int>(motion.model->bodies.size());
  row.reference = "closed form in 64 bits";
  if (!bench.wants(row)) return;
  double worst = 0;
  RowFunction look([&](const Snapshot& s) {
    worst = std::max(worst, error(s));
    return true;
  });
  const double before = held_bytes();
  Kinematics kinematics(motion.model, {}, motion.options);
  const AnalysisReport report = kinematics.run(motion.grid, motion.needs, look);
  row.bytes_per_body = (held_bytes() - before) / row.bodies;
  row.counts = named_counts(report.counters);
  if (report.ok()) {
    row.error = worst;
    RowFunction nothing([](const Snapshot&) { return true; });
    bench.time(row, [&] { Kinematics(motion.model, {}, motion.options).run(motion.grid, motion.needs, nothing); });
  } else {
    row.failure = report.message;
  }
  bench.add(std::move(row));
}

void measure_positions(Bench& bench, const DrivenProblem& problem, double tolerance) {
  const int size = bench.brief() ? 3 : 25;
  Row row{.problem = problem.name, .method = "positions", .error_of = problem.error_of};
  // The tolerance is that of residuals: positions are off by it times what the linkage makes of it, below 100 here.
  row.allowed = 100 * tolerance + problem.rounding;
  measure(bench, row,
          {.model = problem.make(size),
           .grid = TimeGrid::range(0, 1, bench.brief() ? 0.1 : 0.005),
           .options = {.tolerance = tolerance}},
          [&](const Snapshot& s) { return problem.error(state_of(s.evaluator, s.t, s.q).q, size, s.t); });
}

constexpr double crank = 0.1, rod = 0.3, speed = 100;

/// A crank of 0.1 m that turns 100 rad/s, a rod of 0.3 m, a slider on the line of the crank's pin.
std::shared_ptr<Model> slider_crank() {
  auto model = std::make_shared<Model>();
  const int turning = add_rod(*model, "crank", {0, 0}, {crank, 0});
  const int pushing = add_rod(*model, "rod", {crank, 0}, {crank + rod, 0});
  const int slider = model->add_body("slider", {.mass = 1, .inertia = 1, .position = {crank + rod, 0}});
  model->add("O", Revolute<>{{0, 0}, {-crank / 2, 0}}, ground, turning);
  model->add("A", Revolute<>{{crank / 2, 0}, {-rod / 2, 0}}, turning, pushing);
  model->add("B", Revolute<>{{rod / 2, 0}, {0, 0}}, pushing, slider);
  model->add("height", AbsoluteY<>{}, slider, ground, 0.0);
  model->add("upright", AbsoluteAngle<>{}, slider, ground, 0.0);
  const double turn[] = {0, speed};
  model->add_driver("drive", AbsoluteAngle<>{}, turning, ground, TimeFunction<double>::polynomial(turn));
  return model;
}

/// x = r cos a + w, w^2 = l^2 - r^2 sin^2 a; derivatives by a, twice, of w^2: w w' = -r^2 sin a cos a.
double slider_error(const Snapshot& s, int order) {
  const long double a = speed * static_cast<long double>(s.t), r = crank, l = rod, sa = std::sin(a), ca = std::cos(a);
  const long double w = std::sqrt(l * l - r * r * sa * sa), w1 = -r * r * sa * ca / w;
  const long double w2 = (-r * r * (ca * ca - sa * sa) - w1 * w1) / w;
  // Relative to the largest magnitudes: r + l, about r omega and r omega^2.
  if (order == 0) {
    const double x = state_of(s.evaluator, s.t, s.q).q[6];
    return static_cast<double>(std::abs(x - (r * ca + w)) / (r + l));
  }
  const std::size_t x = 3 * static_cast<std::size_t>(s.evaluator.plan().plan_body[2]);
  if (order == 1) return static_cast<double>(std::abs(s.qd[x] - speed * (-r * sa + w1)) / (r * speed));
  return static_cast<double>(std::abs(s.qdd[x] - speed * speed * (-r * ca + w2)) / (r * speed * speed));
}

void rates(Bench& bench) {
  const char* names[] = {"positions", "velocities", "accelerations"};
  for (int order = 0; order < 3; ++order) {
    Row row{.problem = "slider-crank", .method = names[order], .allowed = 1e-11, .error_of = "slider, relative"};
    measure(bench, row,
            {.model = slider_crank(),
             .grid = TimeGrid::range(0, 0.0628, bench.brief() ? 0.005 : 0.0000628),
             .needs = {.velocity = order >= 1, .acceleration = order >= 2}},
            [&](const Snapshot& s) { return slider_error(s, order); });
  }
}

}  // namespace

void kinematics_suite(Bench& bench) {
  for (const DrivenProblem& problem : driven_problems()) {
    for (int digits = bench.brief() ? 9 : 3; digits <= 12; digits += 3)
      measure_positions(bench, problem, std::pow(10, -digits));
  }
  rates(bench);
}

}  // namespace bench
