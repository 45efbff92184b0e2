// Motions under forces by every method at tolerances 1e-3 ... 1e-12: error against processor time, the picture that
// decides which method serves.
#include <array>
#include <cmath>
#include <functional>

#include "cases/exact_chain.hpp"
#include "cases/parallelogram.hpp"
#include "cases/reference_file.hpp"
#include "catena/analysis/dynamics/dynamics.hpp"
#include "catena/elements/all.hpp"
#include "catena/model/model_add.hpp"
#include "moving_mechanisms.hpp"
#include "suites/suites.hpp"

namespace bench {

using namespace catena;

namespace {

struct Problem {
  std::string name;
  std::shared_ptr<Model> model;
  TimeGrid grid;
  std::string error_of, reference;
  /// Error of a row.
  std::function<double(const SystemState&)> error;
  /// The largest error over the tolerance that is right: ten (README.md) times the length scale, m, or the radian that
  /// the tolerance refers to; where flat positions are passed, for every one of them.
  double growth;
};

double far_end_error(const SystemState& s, std::size_t body, const Vec2<long double>& exact) {
  const long double phi = s.q[3 * body + 2];
  return static_cast<double>(norm(Vec2<long double>{s.q[3 * body] + 0.5L * std::cos(phi) - exact.x,
                                                    s.q[3 * body + 1] + 0.5L * std::sin(phi) - exact.y}));
}

Problem falling_chain(int rods, double until) {
  ExactChain chain(rods);
  chain.move(until, static_cast<int>(100 * until));
  return {.name = std::to_string(rods) + " rods fall",
          .model = straight_chain(rods),
          .grid = TimeGrid::instant(until),
          .error_of = "worst joint, m",
          .reference = "Newton-Euler in 64 bits, extrapolation of order 16",
          .error =
              [ends = chain.ends()](const SystemState& s) {
                double worst = 0;
                for (std::size_t b = 0; b < ends.size(); ++b) worst = std::max(worst, far_end_error(s, b, ends[b]));
                return worst;
              },
          .growth = 10.0 * rods};
}

Problem four_bars_through_flat(int n) {
  auto exact = std::make_shared<Parallelogram>(n);
  const auto start = std::make_shared<Parallelogram>(n);
  return {.name = "A02, N = " + std::to_string(n),
          .model = four_bars(n),
          .grid = TimeGrid::range(0, 10, 0.025),
          .error_of = "end of a crank, m",
          .reference = "one angle in 64 bits, order 6",
          .error =
              [exact, start](const SystemState& s) {
                if (s.t == 0) *exact = *start;
                const Vec2<double> end = exact->crank_end(s.t);
                return far_end_error(s, 0, {end.x, end.y});
              },
          .growth = 10.0 * (n + 1) * 20};
}

Problem andrews(const Bench& bench) {
  const auto angle = [&](const char* when, int k) {
    return reference_value(bench.options().references, "andrews_t003", when + std::string("/q/") + std::to_string(k));
  };
  // beta, Theta, gamma, Phi, delta, Omega, epsilon; what each body turned by is a sum of some.
  std::array<double, 7> turned{}, d{};
  for (int k = 0; k < 7; ++k) d[static_cast<std::size_t>(k)] = angle("t=0.03", k) - angle("initial", k);
  turned = {d[0], d[0] + d[1], d[2], d[3] + d[4], d[4], d[5] + d[6], d[6]};
  const auto model = squeezer();
  return {.name = "Andrews' squeezer",
          .model = model,
          .grid = TimeGrid::instant(0.03),
          .error_of = "worst angle, rad",
          .reference = "data/reference/andrews_t003.json",
          .error =
              [turned, model](const SystemState& s) {
                double worst = 0;
                for (std::size_t b = 0; b < 7; ++b)
                  worst = std::max(worst, std::abs(s.q[3 * b + 2] - model->bodies[b].angle - turned[b]));
                return worst;
              },
          .growth = 10};
}

Problem car(const Bench& bench) {
  std::array<double, 4> exact{};
  const char* names[] = {"xl", "yl", "xr", "yr"};
  for (std::size_t k = 0; k < 4; ++k)
    exact[k] = reference_value(bench.options().references, "caraxis_t3", std::string("t=3/") + names[k]);
  return {.name = "car axis",
          .model = car_axis(),
          .grid = TimeGrid::instant(3),
          .error_of = "worst place, m",
          .reference = "data/reference/caraxis_t3.json",
          .error =
              [exact](const SystemState& s) {
                double worst = 0;
                for (std::size_t k = 0; k < 4; ++k)
                  worst = std::max(worst, std::abs(s.q[3 * (1 + k / 2) + k % 2] - exact[k]));
                return worst;
              },
          .growth = 10};
}

/// A wheel behind a viscous coupling to a shaft that swings, from rest: omega' = -rate (omega - cos t), which steps of
/// an explicit method follow no further than some 1 / rate each.
Problem stiff_coupling() {
  constexpr double rate = 1e5;
  auto model = std::make_shared<Model>();
  const int shaft = model->add_body("shaft", {.mass = 1, .inertia = 1});
  const int wheel = model->add_body("wheel", {.mass = 1, .inertia = 1});
  model->bodies[static_cast<std::size_t>(wheel)].angular_velocity_given = true;
  model->add("bearing", Revolute<>{}, ground, shaft);
  model->add("pin", Revolute<>{}, ground, wheel);
  model->add_driver("drive", AbsoluteAngle<>{}, shaft, ground, TimeFunction<double>::harmonic(1, 1, 0));
  Bushing<> coupling;
  coupling.ct = rate;
  model->add_force("coupling", coupling, shaft, wheel);
  return {.name = "stiff coupling",
          .model = model,
          .grid = TimeGrid::instant(3),
          .error_of = "angle, rad",
          .reference = "closed form",
          .error =
              [wheel](const SystemState& s) {
                const long double k = rate, t = s.t, a = k * k / (1 + k * k), b = k / (1 + k * k);
                const long double exact = a * std::sin(t) + b * (1 - std::cos(t)) + a * std::expm1(-k * t) / k;
                return static_cast<double>(std::abs(s.q[3 * static_cast<std::size_t>(wheel) + 2] - exact));
              },
          .growth = 10};
}

/// False where a still smaller tolerance would take longer than it is worth.
bool measure(Bench& bench, const Problem& problem, IntegrationMethod method, double tolerance) {
  Row row{.suite = "dynamics",
          .problem = problem.name,
          .method = std::string(to_string(method)),
          .setting = tolerance_text(tolerance),
          .bodies = static_cast<int>(problem.model->bodies.size()),
          .error_of = problem.error_of,
          .reference = problem.reference};
  if (!bench.wants(row)) return true;
  const DynamicsOptions options{.method = method, .tolerance = tolerance};
  constexpr double rounding = 1e-10;  // of some hundred steps in double precision
  double worst = 0;
  RowFunction look([&](const Snapshot& s) {
    worst = std::max(worst, problem.error(state_of(s.evaluator, s.t, s.q)));
    return true;
  });
  const double before = held_bytes();
  Dynamics dynamics(problem.model, {}, options);
  const AnalysisReport report = dynamics.run(problem.grid, {}, look);
  row.bytes_per_body = (held_bytes() - before) / row.bodies;
  row.counts = named_counts(report.counters);
  if (report.ok()) {
    row.error = worst;
    if (method != IntegrationMethod::baumgarte) row.allowed = std::max(problem.growth * tolerance, rounding);
    RowFunction nothing([](const Snapshot&) { return true; });
    bench.time(row, [&] { Dynamics(problem.model, {}, options).run(problem.grid, {}, nothing); });
  } else {
    row.failure = report.message;
  }
  constexpr double long_run = 1.5;  // s
  const bool worth = !(row.seconds > long_run);
  bench.add(std::move(row));
  return worth;
}

}  // namespace

void dynamics_suite(Bench& bench) {
  std::vector<std::function<Problem()>> problems{[] { return falling_chain(2, 2); }, [&] { return andrews(bench); },
                                                 [&] { return car(bench); }};
  if (!bench.brief()) {
    problems.insert(problems.begin(), [] { return falling_chain(40, 1); });
    problems.emplace_back([] { return four_bars_through_flat(2); });
    problems.emplace_back([] { return four_bars_through_flat(40); });
    problems.emplace_back(stiff_coupling);
  }
  for (const auto& make : problems) {
    const Problem problem = make();
    for (std::size_t m = 0; m < integration_methods.size(); ++m) {
      for (int digits = bench.brief() ? 4 : 3; digits <= (bench.brief() ? 7 : 12); digits += bench.brief() ? 3 : 1) {
        if (!follows_tolerance(static_cast<IntegrationMethod>(m))) break;
        if (!measure(bench, problem, static_cast<IntegrationMethod>(m), std::pow(10, -digits))) break;
      }
    }
  }
}

}  // namespace bench
