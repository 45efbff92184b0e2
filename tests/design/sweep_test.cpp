// Sweeps: designs of every plan, failures as rows, the same rows whatever the number of threads.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "catena/analysis/design/sweep_plan.hpp"
#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

std::vector<std::vector<double>> designs(const SweepRequest& request) {
  const SweepPlan plan(request);
  std::vector<std::vector<double>> all(static_cast<std::size_t>(plan.designs()),
                                       std::vector<double>(request.over.size()));
  for (std::int64_t k = 0; k < plan.designs(); ++k) plan.values(k, all[static_cast<std::size_t>(k)]);
  return all;
}

SweepRange list(std::vector<double> values) {
  SweepRange range;
  range.values = std::move(values);
  return range;
}

TEST(SweepPlan, GridsCombineEverything) {
  const auto all = designs({{list({1, 2}), list({5, 6, 7})}, SweepKind::grid});
  EXPECT_EQ(all, (std::vector<std::vector<double>>{{1, 5}, {1, 6}, {1, 7}, {2, 5}, {2, 6}, {2, 7}}));
}

TEST(SweepPlan, TogetherGoesInStep) {
  const auto all = designs({{list({1, 2, 3}), list({9}), list({4, 5, 6})}, SweepKind::together});
  EXPECT_EQ(all, (std::vector<std::vector<double>>{{1, 9, 4}, {2, 9, 5}, {3, 9, 6}}));
  EXPECT_TRUE(SweepPlan::trouble({{list({1, 2}), list({4, 5, 6})}, SweepKind::together}));
  // Only a grid multiplies: four lists of 200 are 200 designs here.
  const SweepRange longer = list(std::vector<double>(200, 1.0));
  EXPECT_FALSE(SweepPlan::trouble({{longer, longer, longer, longer, longer}, SweepKind::together}));
  EXPECT_TRUE(SweepPlan::trouble({{longer, longer, longer, longer, longer}, SweepKind::grid}));
}

TEST(SweepPlan, StepsAreCountedNotKept) {
  SweepRange steps;
  steps.kind = SweepRange::Kind::steps;
  steps.first = 1;
  steps.second = 2;
  steps.count = 5;
  EXPECT_EQ(designs({{steps}, SweepKind::grid}), (std::vector<std::vector<double>>{{1}, {1.25}, {1.5}, {1.75}, {2}}));
  steps.count = 1e9 - 1;  // 8 GB if they were kept
  const SweepPlan plan({{steps}, SweepKind::grid});
  double last = 0;
  plan.values(plan.designs() - 1, {&last, 1});
  EXPECT_EQ(last, 2);
  steps.count = 1e300;
  EXPECT_TRUE(SweepPlan::trouble({{steps}, SweepKind::grid}));
  steps.count = 2;
  EXPECT_TRUE(SweepPlan::trouble({{steps, steps}, SweepKind::latin, 900'000'000}));
}

TEST(SweepPlan, SamplesHaveTheirDistribution) {
  SweepRange normal;
  normal.kind = SweepRange::Kind::normal;
  normal.first = 3;
  normal.second = 0.5;
  SweepRange uniform;
  uniform.kind = SweepRange::Kind::uniform;
  uniform.first = -1;
  uniform.second = 4;
  for (const SweepKind kind : {SweepKind::sobol, SweepKind::latin, SweepKind::random}) {
    const auto all = designs({{normal, uniform, list({1, 2, 5})}, kind, 20000, 7});
    double mean = 0, square = 0, least = 9, most = -9;
    std::map<double, int> drawn;
    for (const auto& d : all) {
      mean += d[0] / 20000;
      square += (d[0] - 3) * (d[0] - 3) / 20000;
      least = std::min(least, d[1]);
      most = std::max(most, d[1]);
      ++drawn[d[2]];
    }
    // Four deviations of the mean, and of the mean square, of independent samples.
    EXPECT_NEAR(mean, 3, 4 * 0.5 / std::sqrt(20000.0));
    EXPECT_NEAR(square, 0.25, 4 * 0.25 * std::sqrt(2 / 20000.0));
    EXPECT_GT(least, -1);
    EXPECT_LT(most, 4);
    EXPECT_LT(least, -0.99);
    // Of a list its values alone, each a third of the time.
    EXPECT_EQ(drawn.size(), 3U);
    for (const double value : {1.0, 2.0, 5.0})
      EXPECT_NEAR(drawn[value], 20000 / 3.0, 4 * std::sqrt(20000 * 2 / 9.0)) << value;
  }
}

TEST(SweepPlan, TellsWhatIsNone) {
  EXPECT_TRUE(SweepPlan::trouble({{}, SweepKind::grid}));
  SweepRange uniform;
  uniform.kind = SweepRange::Kind::uniform;
  uniform.second = 1;
  EXPECT_TRUE(SweepPlan::trouble({{uniform}, SweepKind::grid}));
  const std::vector<double> many(40000, 1.0);
  EXPECT_TRUE(SweepPlan::trouble({{list(many), list(many)}, SweepKind::grid}));
  EXPECT_THROW(SweepPlan({{list({})}, SweepKind::grid}), std::invalid_argument);
}

// A slider-crank of crank a and rod b: the stroke is 2 a, and it locks where b < a.
const std::string slider = R"({"catena": 1, "parameters": {"a": 0.1, "b": 0.3},
  "bodies": {"crank": {"rod": {"from": [0,0], "to": ["a", 0]}}, "rod": {"rod": {"from": ["a", 0], "to": ["=a+b", 0]}},
             "slide": {"position": ["=a+b", 0]}},
  "constraints": [{"type": "revolute", "i": "ground", "j": "crank.from"}, {"type": "revolute", "i": "crank.to", "j": "rod.from"},
    {"type": "revolute", "i": "rod.to", "j": "slide"},
    {"type": "translational", "i": "ground", "j": "slide", "axis_i": [1, 0]}],
  "drivers": [{"type": "absolute_angle", "i": "crank", "value": {"polynomial": [0.1, 1]}}],
  "outputs": ["slide.x"], "analyses": [{"type": "sweep", "of": {"type": "kinematics", "until": 7, "every": 0.1,
    "measures": {"stroke": {"range": "slide.x"}}}, )";

TEST(Sweep, GivesARowADesignAndItsStatus) {
  const TextRun run = run_text(slider + R"("over": {"a": [0.1, 0.2], "b": {"from": 0.15, "to": 0.45, "count": 3}}}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  const std::vector<double> a = run.column("a"), b = run.column("b"), stroke = run.column("stroke"),
                            status = run.column("status");
  ASSERT_EQ(stroke.size(), 6u);
  for (std::size_t k = 0; k < 6; ++k) {
    SCOPED_TRACE(k);
    EXPECT_EQ(run.column("design")[k], static_cast<double>(k + 1));
    if (a[k] < b[k]) {
      EXPECT_EQ(status[k], static_cast<double>(Status::ok));
      EXPECT_NEAR(stroke[k], 2 * a[k], 1e-9);
    } else {
      EXPECT_NE(status[k], static_cast<double>(Status::ok));
      EXPECT_TRUE(std::isnan(stroke[k]));
    }
  }
  // Each that failed, with its parameters and the reason.
  const auto failures = field<std::shared_ptr<const LongList>>(run, "failures");
  std::vector<std::int64_t> failed;
  failures->for_each([&](const FieldRecord& record) {
    EXPECT_EQ(record.size(), 5u);
    const auto k = std::get<std::int64_t>(record[0].second);
    failed.push_back(k);
    EXPECT_EQ(std::get<double>(record[1].second), a[static_cast<std::size_t>(k - 1)]);
    EXPECT_EQ(std::get<double>(record[2].second), b[static_cast<std::size_t>(k - 1)]);
    EXPECT_EQ(std::get<std::string>(record[3].second),
              to_string(static_cast<Status>(status[static_cast<std::size_t>(k - 1)])));
    EXPECT_FALSE(std::get<std::string>(record[4].second).empty());
    return true;
  });
  std::vector<std::int64_t> expected;
  for (std::size_t k = 0; k < 6; ++k) {
    if (!(a[k] < b[k])) expected.push_back(static_cast<std::int64_t>(k + 1));
  }
  EXPECT_EQ(failed, expected);
  EXPECT_EQ(failures->size(), static_cast<std::int64_t>(expected.size()));
}

TEST(Sweep, AMeasureThatIsNoNumberFailsTheDesign) {
  std::string text = slider + R"("over": {"a": [0.05, 0.2]}}]})";
  const std::string range = R"({"range": "slide.x"})";
  text.replace(text.find(range), range.size(), R"--({"final": "=sqrt(slide.x - 4*a)"})--");
  const TextRun run = run_text(text);
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  const std::vector<double> status = run.column("status");
  ASSERT_EQ(status.size(), 2u);
  // The root of about a + b - 4 a: of 0.35 - 0.2, and of 0.5 - 0.8.
  EXPECT_EQ(status[0], static_cast<double>(Status::ok));
  EXPECT_EQ(status[1], static_cast<double>(Status::not_converged));
  field<std::shared_ptr<const LongList>>(run, "failures")->for_each([](const FieldRecord& record) {
    EXPECT_TRUE(std::get<std::string>(record.back().second).starts_with("measure \"stroke\" has no value"));
    return true;
  });
}

// A bar on a torsion spring under a torque M, and no weight: its angle is M/k. A path leaves its last torque to what
// follows, but for an analysis that starts from the scene.
TEST(Sweep, WhatAPathLeavesHoldsForTheAnalysesAfterIt) {
  const std::string scene = R"({"catena": 1, "parameters": {"M": 1, "k": 10},
  "bodies": {"bar": {"mass": 1, "rod": {"from": [0, 0], "to": [1, 0]}}},
  "constraints": [{"type": "revolute", "i": "ground", "j": "bar.from"}],
  "forces": [{"type": "torsion_spring", "i": "ground", "j": "bar", "k": "k", "angle": 0},
             {"type": "torque", "i": "bar", "torque": "M"}],
  "outputs": ["bar.angle"],
  "analyses": [)";
  const std::string inner = R"([{"type": "path", "parameter": "M", "to": 4},
    {"type": "equilibrium", "measures": {"after": {"final": "bar.angle"}}},
    {"type": "equilibrium", "from": "initial", "measures": {"anew": {"final": "bar.angle"}}}])";
  const TextRun swept = run_text(scene + R"({"type": "sweep", "over": {"k": [10, 20]}, "of": )" + inner + "}]}");
  ASSERT_EQ(swept.outcome.exit_code, 0) << swept.outcome.error_text << swept.analysis().report.message;
  for (std::size_t design = 0; design < 2; ++design) {
    const double k = swept.column("k")[design];
    EXPECT_NEAR(swept.column("after")[design], 4 / k, 1e-9);
    EXPECT_NEAR(swept.column("anew")[design], 1 / k, 1e-9);
  }
  // The same of an analysis that follows the sensitivity of a path.
  const TextRun after = run_text(scene + R"({"type": "sensitivity", "parameters": ["k"],
    "of": {"type": "path", "parameter": "M", "to": 4}}, {"type": "equilibrium"}]})");
  ASSERT_EQ(after.outcome.exit_code, 0) << after.outcome.error_text;
  EXPECT_NEAR(after.last("bar.angle", 1), 0.4, 1e-9);
}

TEST(Sweep, ThreadsChangeNothing) {
  const std::string scene = slider + R"("over": {"a": {"uniform": [0.05, 0.2]}, "b": {"normal": [0.3, 0.05]}},
    "design": "latin", "samples": 60, "seed": 3}]})";
  RunOptions several;
  several.threads = 3;
  const TextRun one = run_text(scene), three = run_text(scene, several);
  ASSERT_EQ(one.outcome.exit_code, 0) << one.outcome.error_text;
  ASSERT_EQ(one.column("stroke").size(), 60u);
  for (const char* column : {"design", "a", "b", "stroke", "status"}) {
    const std::vector<double> x = one.column(column), y = three.column(column);
    ASSERT_EQ(x.size(), y.size());
    for (std::size_t k = 0; k < x.size(); ++k) EXPECT_TRUE(x[k] == y[k] || (std::isnan(x[k]) && std::isnan(y[k])));
  }
}

double number(const FieldRecord& record, const std::string& name) {
  for (const auto& [key, value] : record) {
    if (key == name) return std::get<double>(value);
  }
  ADD_FAILURE() << "no " << name;
  return 0;
}

// The stroke is 2 a; at the start x = a cos u + sqrt(b^2 - a^2 sin^2 u), u = 0.1.
TEST(Sweep, ToleranceToFirstOrderIsThatOfTheClosedForm) {
  std::string scene = slider + R"("over": {"a": {"normal": [0.1, 0.004]}, "b": {"uniform": [0.29, 0.31]}},
    "design": "random", "samples": 300, "seed": 5}]})";
  const std::string range = R"("stroke": {"range": "slide.x"})";
  scene.replace(scene.find(range), range.size(), range + R"(, "start": {"first": "slide.x"})");
  const TextRun run = run_text(scene);
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  const auto scatter = field<std::vector<FieldRecord>>(run, "scatter");
  ASSERT_EQ(scatter.size(), 2u);
  const double a = 0.1, b = 0.3, c = std::cos(0.1), s = std::sin(0.1), root = std::sqrt(b * b - a * a * s * s);
  const double sigma_a = 0.004, sigma_b = 0.02 / std::sqrt(12.0);
  const double by_a = (c - a * s * s / root) * sigma_a, by_b = b / root * sigma_b;
  EXPECT_NEAR(number(scatter[0], "first_order_mean"), 2 * a, 1e-9);
  EXPECT_NEAR(number(scatter[0], "first_order_deviation"), 2 * sigma_a, 1e-9);
  EXPECT_NEAR(number(scatter[0], "due_to b"), 0, 1e-9);
  EXPECT_NEAR(number(scatter[1], "first_order_mean"), a * c + root, 1e-9);
  EXPECT_NEAR(number(scatter[1], "due_to a"), by_a, 1e-9);
  EXPECT_NEAR(number(scatter[1], "due_to b"), by_b, 1e-9);
  EXPECT_NEAR(number(scatter[1], "first_order_deviation"), std::hypot(by_a, by_b), 1e-9);
  for (std::size_t m = 0; m < 2; ++m) {
    const std::vector<double> values = run.column(m == 0 ? "stroke" : "start");
    double sum = 0, squares = 0;
    for (const double value : values) sum += value;
    const double mean = sum / 300;
    for (const double value : values) squares += (value - mean) * (value - mean);
    const double deviation = std::sqrt(squares / 299);
    EXPECT_NEAR(number(scatter[m], "mean"), mean, 1e-12);
    EXPECT_NEAR(number(scatter[m], "deviation"), deviation, 1e-12);
    // Of n samples a deviation is known to deviation/sqrt(2 n): within four of these.
    EXPECT_NEAR(number(scatter[m], "first_order_deviation"), deviation, 4 * deviation / std::sqrt(600.0));
  }
  // A sweep over steps is no sample of anything.
  const TextRun steps = run_text(slider + R"("over": {"a": [0.1, 0.11]}}]})");
  for (const NamedField& entry : steps.analysis().fields) EXPECT_NE(entry.name, "scatter");
}

TEST(Sweep, NamesWhatIsWrong) {
  const auto error = [](const std::string& rest) { return run_text(slider + rest + "}]}").outcome; };
  EXPECT_EQ(error(R"("over": {"c": [1]})").exit_code, 3);
  EXPECT_NE(error(R"("over": {"c": [1]})").error_text.find("unknown parameter"), std::string::npos);
  EXPECT_NE(error(R"("over": {"a": {"from": 1, "to": 2}})").error_text.find("count"), std::string::npos);
  EXPECT_NE(error(R"("over": {"a": {"normal": [1, 0.1]}})").error_text.find("sampled"), std::string::npos);
  EXPECT_NE(error(R"("over": {"a": {"from": 0, "to": 1, "count": 1e12}})").error_text.find("less than"),
            std::string::npos);
  EXPECT_NE(error(R"("over": {"a": {"uniform": [1, 2]}}, "design": "sobol", "samples": 1000000000)")
                .error_text.find("1e+09 designs are asked for; a sweep has less than"),
            std::string::npos);
  // One mistake, one error.
  for (const char* over : {R"("over": {"a": []})", R"("over": {"a": {"from": 1, "to": 2}})"})
    EXPECT_EQ(error(over).errors.size(), 1u) << error(over).error_text;
  EXPECT_NE(error(R"("over": {"a": [1, 2], "b": [1, 2, 3]}, "design": "together")").error_text.find("one length"),
            std::string::npos);
}

}  // namespace
}  // namespace catena::testing
