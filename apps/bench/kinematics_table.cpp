// Kinematics in tables: the cost of a step beside a bare refactorization and solve of the same matrix, and run time
// against error.
#include "kinematics_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "catena/analysis/kinematics/kinematics.hpp"
#include "mechanisms.hpp"
#include "timing.hpp"

namespace bench {

using namespace catena;

namespace {

/// One step (position to 1e-12, velocity, acceleration) against the factorization alone, of Phi_q at the last
/// configuration.
void step_row(const char* kind, const std::shared_ptr<Model>& model) {
  Kinematics kinematics(model);
  const int bodies = static_cast<int>(model->bodies.size());
  const double h = 0.005;
  // A million bodies take a second a step: few of them say enough.
  const int warm_up = bodies > 300000 ? 3 : 10, steps = std::clamp(1000000 / bodies, 4, 200);
  const int repeats = bodies > 30000 ? 3 : 5;
  RowFunction nothing([](const Snapshot&) { return true; });
  const Needs needs{.velocity = true, .acceleration = true};
  AnalysisReport report = kinematics.run(TimeGrid::range(0, warm_up * h, h), needs, nothing);
  double t = warm_up * h;
  const double step = least_time(repeats, 1,
                                 [&] {
                                   if (report.ok())
                                     report = kinematics.run(TimeGrid::range(t, t + steps * h, h), needs, nothing);
                                   t += steps * h;
                                 }) /
                      steps;
  if (!report.ok()) {
    fmt::print("{:8} {:8}  {}\n", kind, bodies, report.message);
    std::fflush(stdout);
    return;
  }
  // The same matrix, the same kernel, nothing else.
  Evaluator& evaluator = kinematics.evaluator();
  std::vector<double> values(static_cast<std::size_t>(kinematics.plan().trash_slot()) + 1);
  evaluator.start_jacobian(values);
  evaluator.set_configuration(kinematics.q());
  evaluator.jacobian(values);
  values.pop_back();
  Counters counters;
  const auto cost = [&](Kernel kernel) {
    Factorization factors;
    if (!factors.analyze(kinematics.plan().jacobian, kernel, counters).ok()) return std::nan("");
    std::vector<double> x(static_cast<std::size_t>(kinematics.plan().columns), 1.0);
    bool ok = true;
    const double time = least_time(bodies > 30000 ? 3 : 7, std::max(1, 20000 / bodies), [&] {
      ok = ok && factors.factorize(values, counters).ok();
      if (ok) factors.solve(x, counters);
    });
    return ok ? time : std::nan("");
  };
  const double klu = cost(Kernel::klu), umfpack = cost(Kernel::umfpack), scale = 1e9 / bodies;
  fmt::print("{:8} {:8} {:10.0f} {:10.0f} {:8.2f} {:10.0f} {:8.2f}\n", kind, bodies, step * scale, klu * scale,
             step / klu, umfpack * scale, step / umfpack);
  std::fflush(stdout);
}

/// Angle of the first rocker of the ladder, in closed form.
double exact_rocker(double crank) {
  const double b = 0.25, c = 0.2;
  const Vec2<double> tip{0.1 * std::cos(crank), 0.1 * std::sin(crank)}, pivot{0.3, -0.13};
  const Vec2<double> d = pivot - tip;
  const double distance = norm(d);
  const double coupler = std::atan2(d.y, d.x) + std::acos((b * b + distance * distance - c * c) / (2 * b * distance));
  const Vec2<double> joint = tip + b * Vec2<double>{std::cos(coupler), std::sin(coupler)} - pivot;
  return std::atan2(joint.y, joint.x);
}

}  // namespace

void print_step_costs() {
  fmt::print(
      "One kinematic step (position to 1e-12, velocity, acceleration), ns a body; factors and UMFPACK: refactor and "
      "solve of the same Phi_q, factors with KLU's order and pivots by lists of products.\n");
  fmt::print("{:8} {:>8} {:>10} {:>10} {:>8} {:>10} {:>8}\n", "linkage", "bodies", "step", "factors", "ratio",
             "UMFPACK", "ratio");
  for (int n : {50, 500, 5000, 50000, 500000}) step_row("dyads", dyad_ladder(n));
  for (int n : {50, 500, 5000, 50000, 500000}) step_row("scissor", scissor_lift(n));
  for (int side : {7, 22, 71, 224, 707}) step_row("lattice", lattice(side));
  for (int n : {50, 500, 5000, 50000, 500000}) step_row("cams", camshaft(n));
  for (int n : {100, 1000, 10000, 100000, 1000000}) step_row("gears", gear_train(n));
}

void print_kinematic_errors() {
  fmt::print(
      "\nTime against error: a driven four-bar over one second, 1001 rows, worst error of the rocker's angle.\n");
  fmt::print("{:>10} {:>12} {:>12}\n", "tolerance", "error, rad", "us a row");
  for (double tolerance : {1e-3, 1e-6, 1e-9, 1e-12}) {
    double worst = 0;
    const auto model = dyad_ladder(1);
    const int rocker = model->find_body("rocker1");
    const auto run = [&](bool check) {
      Kinematics kinematics(model, {}, {.tolerance = tolerance});
      RowFunction look([&](const Snapshot& s) {
        if (check) {
          const auto k =
              static_cast<std::size_t>(3 * s.evaluator.plan().plan_body[static_cast<std::size_t>(rocker)] + 2);
          const double error = s.q[k] - exact_rocker(0.1 * std::sin(1.5 * s.t));
          worst = std::max(worst, std::abs(std::remainder(error, 2 * std::numbers::pi)));
        }
        return true;
      });
      kinematics.run(TimeGrid::range(0, 1, 0.001), {}, look);
    };
    run(true);
    const double time = least_time(5, 3, [&] { run(false); });
    fmt::print("{:10.0e} {:12.2e} {:12.3f}\n", tolerance, worst, time / 1001 * 1e6);
  }
}

}  // namespace bench
