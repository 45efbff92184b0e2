// Gradients and searches through scenes, from text to result: values, derivatives and designs against closed forms.
//
//   swing of a crank-rocker: at its ends crank and coupler lie in one line, a triangle of b +- a, c, d:
//     angle = pi - acos((d^2 + c^2 - (b +- a)^2) / (2 c d))
//   oscillator: x - 1 = A cos(w t), w^2 = k / m:  dx/dk = -A t sin(w t) w / (2 k),  dx/dm = A t sin(w t) w / (2 m)
//   path generation: the lengths of the four-bar that drew the points
//   four-bars in lanes: angles of coupler and rocker from two triangles, their rates from the closed loop
#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "cases/contact_gradients.hpp"
#include "cases/gradient_costs.hpp"
#include "catena/analysis/batch/batch.hpp"
#include "catena/elements/all.hpp"
#include "catena/model/model_add.hpp"
#include "catena/results/stored_results.hpp"
#include "catena/scene/running/scene_runner.hpp"
#include "suites/suites.hpp"

namespace bench {

using namespace catena;

namespace {

constexpr const char* four_bar = R"json({"catena": 1, "parameters": {"a": 0.1, "b": 0.25, "c": 0.2, "d": 0.3},
 "bodies": {"crank": {"points": {"end": ["a", 0]}, "angle": 1},
  "coupler": {"points": {"end": ["b", 0]}, "position": ["=a*cos(1)", "=a*sin(1)"], "angle": 0.4},
  "rocker": {"points": {"end": ["c", 0]}, "position": ["d", 0], "angle": 1.6}},
 "constraints": [{"type": "revolute", "i": "ground", "j": "crank"}, {"type": "revolute", "i": "crank.end", "j": "coupler"},
  {"type": "revolute", "i": "coupler.end", "j": "rocker.end"}, {"type": "revolute", "i": ["ground", ["d", 0]], "j": "rocker"}],
 "drivers": [{"type": "absolute_angle", "i": "crank", "value": {"polynomial": [1, 1]}}], "outputs": ["rocker.angle"],
 "analyses": [{)json";
constexpr const char* swing =
    R"json("type": "kinematics", "until": 6.3, "every": 0.1, "measures": {"least": {"min": "rocker.angle"}, "most": {"max": "rocker.angle"}}})json";

constexpr const char* oscillator = R"json({"catena": 1, "parameters": {"k": 50, "m": 2},
 "bodies": {"b": {"mass": "m", "inertia": 1, "position": [1.3, 0]}},
 "constraints": [{"type": "absolute_y", "i": "b"}, {"type": "absolute_angle", "i": "b"}],
 "forces": [{"type": "spring_damper", "i": "ground", "j": "b", "k": "k", "length": 1}], "outputs": ["b.x"],
 "analyses": [{)json";
constexpr const char* oscillation =
    R"json("type": "dynamics", "until": 2, "every": 0.5, "tolerance": 1e-10, "measures": {"end": {"final": "b.x"}}})json";

constexpr const char* path = R"json({"catena": 1, "parameters": {"a": {"value": 0.42, "min": 0.2, "max": 0.6},
  "b": {"value": 1.05, "min": 0.8, "max": 1.4}, "c": {"value": 0.95, "min": 0.6, "max": 1.2},
  "d": {"value": 1.2, "min": 0.9, "max": 1.5}},
 "bodies": {"crank": {"points": {"end": ["a", 0]}},
  "coupler": {"points": {"end": ["b", 0], "pen": [0.5, 0.3]}, "position": ["a", 0], "angle": 1},
  "rocker": {"points": {"end": ["c", 0]}, "position": ["d", 0], "angle": 1.8}},
 "constraints": [{"type": "revolute", "i": "ground", "j": "crank"}, {"type": "revolute", "i": "crank.end", "j": "coupler"},
  {"type": "revolute", "i": "coupler.end", "j": "rocker.end"}, {"type": "revolute", "i": ["ground", ["d", 0]], "j": "rocker"}],
 "drivers": [{"type": "absolute_angle", "i": "crank", "value": {"polynomial": [0, 1]}}],
 "outputs": ["coupler.pen.x", "coupler.pen.y"],
 "analyses": [{"type": "optimise", "variables": {"a": {}, "b": {}, "c": {}, "d": {}}, "minimise": "=miss^2",
  "of": {"type": "kinematics", "until": 6.283185307179586, "every": 0.5, "measures": {"miss": {
   "path": ["coupler.pen.x", "coupler.pen.y"], "timed": true, "to": [)json";

using Values = std::vector<double>;

/// Largest difference; not a number where one is missing.
double apart(const Values& found, const Values& exact) {
  if (found.size() != exact.size()) return not_measured;
  double worst = 0;
  for (std::size_t k = 0; k < exact.size(); ++k) {
    const double difference = std::abs(found[k] - exact[k]);
    if (!(difference <= worst)) worst = difference;
  }
  return worst;
}

/// Runs a text; `read` takes from its only analysis what is to be compared.
template <class Read>
void measure(Bench& bench, Row row, const std::string& text, const Values& exact, Read&& read) {
  row.suite = "design";
  if (!bench.wants(row)) return;
  RunOptions options;
  options.text = text;
  SceneOutcome outcome;
  const auto once = [&] {
    StoredResults rows;
    outcome = run_scene("design", options, rows);
  };
  once();
  if (outcome.exit_code == 0) {
    const AnalysisResult& result = outcome.analyses.front();
    row.counts = named_counts(result.report.counters);
    row.error = apart(read(result), exact);
    if (std::isnan(row.error)) row.failure = "values or derivatives are missing";
    bench.time(row, once);
  } else {
    row.failure = outcome.error_text;
  }
  bench.add(std::move(row));
}

Values values_of(const AnalysisResult& result) {
  Values values;
  for (const MeasureResult& m : result.measures) values.push_back(m.value.value_or(not_measured));
  return values;
}

Values gradients_of(const AnalysisResult& result) {
  Values values;
  for (const MeasureResult& m : result.measures) values.insert(values.end(), m.gradient.begin(), m.gradient.end());
  return values;
}

/// One end of the swing and its derivatives by a, b, c, d.
void swing_end(double sign, Values& value, Values& gradient) {
  const double a = 0.1, b = 0.25, c = 0.2, d = 0.3, s = b + sign * a;
  const double u = (d * d + c * c - s * s) / (2 * c * d), slope = 1 / std::sqrt(1 - u * u);
  value.push_back(std::acos(-1.0) - std::acos(u));
  const double by_s = -s / (c * d) * slope;
  gradient.insert(gradient.end(), {sign * by_s, by_s, (1 / d - u / c) * slope, (1 / c - u / d) * slope});
}

void swings(Bench& bench) {
  Values value, gradient;
  swing_end(1, value, gradient);   // stretched: the rocker is furthest from the crank's pivot
  swing_end(-1, value, gradient);  // folded
  std::sort(value.begin(), value.end());
  if (gradient[1] > 0) std::rotate(gradient.begin(), gradient.begin() + 4, gradient.end());
  Row row{.problem = "swing of a crank-rocker", .method = "two measures", .bodies = 3};
  row.error_of = "ends of the swing, rad";
  row.reference = "triangle in closed form";
  row.allowed = 1e-9;
  measure(bench, row, std::string(four_bar) + swing + "]}", value, values_of);
  row.method = "two measures, four derivatives each";
  row.error_of = "derivatives, rad/m";
  row.allowed = 1e-8;
  measure(bench, row,
          std::string(four_bar) + R"json("type": "sensitivity", "parameters": ["a", "b", "c", "d"], "of": {)json" +
              swing + "}]}",
          gradient, gradients_of);
}

/// Crank-rockers through a sweep, from text to rows: the ends of every swing against the triangle, and a third measure.
void sweeps(Bench& bench) {
  const int designs = bench.brief() ? 16 : 1000;
  Row row{.suite = "design", .problem = "crank-rockers, three measures", .method = "sweep, a design", .bodies = 3};
  row.setting = "one thread";
  row.error_of = "ends of the swings, rad";
  row.reference = "triangle in closed form";
  row.allowed = 1e-9;
  if (!bench.wants(row)) return;
  RunOptions options;
  options.text =
      std::string(four_bar) + fmt::format(R"json("type": "sweep", "design": "sobol", "samples": {}, "over": {{
    "a": {{"uniform": [0.095, 0.105]}}, "b": {{"uniform": [0.24, 0.26]}}, "c": {{"uniform": [0.19, 0.21]}},
    "d": {{"uniform": [0.29, 0.31]}}}}, "of": {{"type": "kinematics", "until": 6.3, "every": 0.0875, "measures": {{
    "least": {{"min": "rocker.angle"}}, "most": {{"max": "rocker.angle"}}, "rough": {{"rms": "rocker.alpha"}}}}}}}}]}})json",
                                          designs);
  const auto once = [&] {
    auto rows = std::make_unique<StoredResults>();
    const SceneOutcome outcome = run_scene("design", options, *rows);
    if (outcome.exit_code != 0) row.failure = outcome.error_text;
    return rows;
  };
  const std::unique_ptr<StoredResults> found = once();
  if (row.failure.empty()) {
    const ResultStorage& rows = *found->rows.front();
    const auto column = [&](const char* name) { return rows.column(name); };
    const Values a = column("a"), b = column("b"), c = column("c"), d = column("d");
    Values ends = column("least"), exact;
    const Values most = column("most");
    ends.insert(ends.end(), most.begin(), most.end());
    // Stretched the rocker is furthest from the crank's pivot: its angle is the least.
    for (const double sign : {1.0, -1.0}) {
      for (std::size_t k = 0; k < a.size(); ++k) {
        const double s = b[k] + sign * a[k];
        exact.push_back(std::acos(-1.0) - std::acos((d[k] * d[k] + c[k] * c[k] - s * s) / (2 * c[k] * d[k])));
      }
    }
    row.error = apart(ends, exact);
    bench.time(row, once, designs);
  }
  bench.add(std::move(row));
}

void oscillations(Bench& bench) {
  const double k = 50, m = 2, amplitude = 0.3, t = 2, w = std::sqrt(k / m),
               slope = amplitude * t * std::sin(w * t) * w / 2;
  Row row{.problem = "oscillator", .method = "motion", .setting = "1e-10", .bodies = 1};
  row.error_of = "end, m";
  row.reference = "closed form";
  row.allowed = 1e-8;  // ten times the tolerance, for ten radians
  measure(bench, row, std::string(oscillator) + oscillation + "]}", {1 + amplitude * std::cos(w * t)}, values_of);
  row.method = "motion, two derivatives";
  row.error_of = "derivatives, m a N/m and m a kg";
  measure(bench, row,
          std::string(oscillator) + R"json("type": "sensitivity", "parameters": ["k", "m"], "of": {)json" +
              oscillation + "}]}",
          {-slope / k, slope / m}, gradients_of);
}

/// The point of the coupler after the crank has turned by `crank`, of the four-bar to be found.
std::string points_of_path(int count) {
  const double a = 0.4, b = 1.1, c = 0.9, d = 1.2;
  std::string text;
  for (int k = 0; k < count; ++k) {
    const double crank = 2 * std::acos(-1.0) * k / (count - 1), x = a * std::cos(crank), y = a * std::sin(crank);
    const double distance = std::hypot(d - x, y);
    const double angle = std::atan2(-y, d - x) + std::acos((b * b + distance * distance - c * c) / (2 * b * distance));
    text += fmt::format("{}[{:.17g}, {:.17g}]", k ? ", " : "", x + 0.5 * std::cos(angle) - 0.3 * std::sin(angle),
                        y + 0.5 * std::sin(angle) + 0.3 * std::cos(angle));
  }
  return text;
}

void path_generation(Bench& bench) {
  Row row{.problem = "path generation", .method = "optimise, four lengths", .bodies = 3};
  row.error_of = "lengths, m";
  row.reference = "the four-bar that drew the points";
  row.allowed = 1e-5;  // the miss is a square: a gradient of 1e-10 leaves its root
  measure(bench, row, path + points_of_path(9) + "]}}}}]}", {0.4, 1.1, 0.9, 1.2}, [](const AnalysisResult& result) {
    Values lengths;
    for (const NamedField& field : result.fields) {
      const auto* variables = field.name == "variables" ? std::get_if<FieldRecord>(&field.value) : nullptr;
      if (!variables) continue;
      for (const auto& [name, value] : *variables) {
        if (const double* length = std::get_if<double>(&value)) lengths.push_back(*length);
      }
    }
    return lengths;
  });
}

/// A four-bar whose crank turns at 2 pi a second, and where its rocker is at the angle `crank`: angle, rate, and the
/// rate of that, rad and s.
template <class N>
struct FourBar {
  N a, b, c, d;

  std::array<N, 2> angles(N crank) const {
    const N x = d - a * std::cos(crank), y = -a * std::sin(crank), r2 = x * x + y * y;
    const N coupler = std::atan2(y, x) + std::acos((b * b + r2 - c * c) / (2 * b * std::sqrt(r2)));
    return {coupler, std::atan2(b * std::sin(coupler) - y, b * std::cos(coupler) - x)};
  }
  std::array<N, 3> rocker(N crank) const {
    const N w = 2 * std::acos(N(-1));
    const auto [u, v] = angles(crank);
    const N su = std::sin(u), cu = std::cos(u), sv = std::sin(v), cv = std::cos(v), sin_uv = su * cv - cu * sv;
    const N st = std::sin(crank), ct = std::cos(crank);
    const N du = a * w * (sv * ct - cv * st) / (b * sin_uv), dv = a * w * (su * ct - cu * st) / (c * sin_uv);
    const N x = a * ct * w * w + b * cu * du * du - c * cv * dv * dv;
    const N y = a * st * w * w + b * su * du * du - c * sv * dv * dv;
    return {v, dv, -(cu * x + su * y) / (c * sin_uv)};
  }
};

/// Designs that all turn fully: lengths within 5 % of 1 : 2.5 : 2 : 3, spread by golden parts.
FourBar<double> design_number(std::int64_t k) {
  const auto around = [k](double middle, double step) {
    const double part = step * static_cast<double>(k);
    return middle * (0.95 + 0.1 * (part - std::floor(part)));
  };
  return {around(1, 0.6180339887498949), around(2.5, 0.7548776662466927), around(2, 0.8191725133961645),
          around(3, 0.8566748838545029)};
}

void write_design(const FourBar<double>& bar, Model& model) {
  auto& pins = std::get<std::vector<ElementEntry<Revolute<double>, double>>>(model.constraints);
  pins[1].element.s_i.x = bar.a;
  pins[2].element.s_i.x = bar.b;
  pins[2].element.s_j.x = bar.c;
  pins[3].element.s_i.x = bar.d;
  const auto [coupler, rocker] = bar.angles(0);
  model.bodies[1].position = {bar.a, 0};
  model.bodies[1].angle = coupler;
  model.bodies[2].position = {bar.d, 0};
  model.bodies[2].angle = rocker;
}

/// Its crank turns at `speed`, rad/s; lengths are written by write_design().
std::shared_ptr<Model> driven_four_bar(double speed) {
  auto model = std::make_shared<Model>();
  for (const char* name : {"crank", "coupler", "rocker"}) model->add_body(name, {});
  const int ends[4][2] = {{ground, 0}, {0, 1}, {1, 2}, {ground, 2}};
  for (const auto& [i, j] : ends) model->add("", Revolute<double>{}, i, j);
  const std::vector<double> turning{0, speed};
  model->add_driver("drive", AbsoluteAngle<double>{}, 0, ground, TimeFunction<double>::polynomial(turning));
  return model;
}

void lanes(Bench& bench) {
  const std::int64_t designs = bench.brief() ? 16 : 2000;
  constexpr int positions = 100;
  Row row{.suite = "design", .problem = "four-bars, 100 positions each", .method = "in lanes, a position", .bodies = 3};
  row.setting = "one thread";
  row.error_of = "rates of the rocker, relative";
  row.reference = "two triangles and the closed loop, in 64 bits";
  row.allowed = 1e-11;
  if (!bench.wants(row)) return;
  constexpr double speed = 2 * std::numbers::pi;
  const std::shared_ptr<Model> model = driven_four_bar(speed);
  write_design(design_number(0), *model);
  BatchOptions options;
  options.same_functions = true;
  Batch batch(model, options);
  const TimeGrid grid = TimeGrid::range(0, 0.99, 0.01);
  double error = 0, largest = 0;
  volatile double kept = 0;  // so that nothing of what is timed is left out
  const auto exact_rocker = [&](std::int64_t design, int position) {
    const FourBar<double> bar = design_number(design);
    return FourBar<long double>{bar.a, bar.b, bar.c, bar.d}.rocker(speed * grid[position]);
  };
  const auto take_error = [&](const std::array<long double, 3>& exact, double angle, double rate, double acceleration) {
    error = std::max({error, static_cast<double>(std::abs(angle - exact[0])),
                      static_cast<double>(std::abs(rate - exact[1])) / speed,
                      static_cast<double>(std::abs(acceleration - exact[2])) / (speed * speed)});
  };
  const auto follow = [&](const Batch::Take& take) {
    const auto write = [](std::int64_t k, Model& design) { write_design(design_number(k), design); };
    return batch.run(designs, grid, write, take);
  };
  const BatchReport report = follow([&](const BatchRows& rows) {
    for (int lane = 0; lane < rows.designs; ++lane) {
      for (int k = 0; k < rows.rows; ++k)
        take_error(exact_rocker(rows.first + lane, k), rows.positions(k, 2, 2)[lane], rows.velocities(k, 2, 2)[lane],
                   rows.accelerations(k, 2, 2)[lane]);
    }
  });
  row.error = error;
  row.counts = {{"in lanes", static_cast<double>(report.in_lanes)}, {"failed", static_cast<double>(report.failed)}};
  const double parts = static_cast<double>(designs) * positions;
  bench.time(
      row, [&] { follow([&](const BatchRows& rows) { largest = std::max(largest, rows.velocities(9, 2, 2)[0]); }); },
      parts);
  bench.add(row);
  row.engine = "closed form by hand";
  row.method = "one after the other, a position";
  row.counts.clear();
  error = 0;
  for (std::int64_t k = 0; k < designs; ++k) {
    const FourBar<double> bar = design_number(k);
    for (int n = 0; n < positions; ++n) {
      const auto [angle, rate, acceleration] = bar.rocker(speed * grid[n]);
      take_error(exact_rocker(k, n), angle, rate, acceleration);
    }
  }
  row.error = error;
  bench.time(
      row,
      [&] {
        for (std::int64_t k = 0; k < designs; ++k) {
          const FourBar<double> bar = design_number(k);
          for (int n = 0; n < positions; ++n) largest = std::max(largest, bar.rocker(speed * grid[n])[2]);
        }
      },
      parts);
  kept = largest;
  static_cast<void>(kept);
  bench.add(row);
}

}  // namespace

void design_suite(Bench& bench) {
  swings(bench);
  sweeps(bench);
  oscillations(bench);
  path_generation(bench);
  lanes(bench);
  contact_gradients(bench);
  gradient_costs(bench);
}

}  // namespace bench
