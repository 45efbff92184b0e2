// Units in which results are shown.
#include "catena/scene/numbers/output_units.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "catena/scene/writing/units_sink.hpp"
#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

TEST(OutputUnits, OfEveryKindOfColumn) {
  OutputUnits units;
  units.ask({{"angle", "deg"}, {"length", "mm"}, {"force", "kN"}});
  const double degree = 180 / std::numbers::pi;
  const struct {
    const char* si;
    const char* unit;
    double factor;
  } cases[] = {{"m", "mm", 1e3},
               {"rad", "deg", degree},
               {"m/s", "mm/s", 1e3},
               {"rad/s", "deg/s", degree},
               {"m/s^2", "mm/s^2", 1e3},
               {"N", "kN", 1e-3},
               {"N m", "kN mm", 1},
               {"N/m", "kN/mm", 1e-6},
               {"N m/rad", "kN mm/deg", 1 / degree},
               {"J", "kN mm", 1},
               {"W", "kN mm/s", 1},
               {"s", "s", 1},
               {"kg", "kg", 1},
               {"1", "1", 1},
               {"", "", 1}};
  for (const auto& c : cases) {
    SCOPED_TRACE(c.si);
    const OutputUnits::Conversion to = units.of(c.si);
    EXPECT_EQ(to.unit, c.unit);
    EXPECT_NEAR(to.factor / c.factor, 1, 1e-15);
  }
}

TEST(OutputUnits, NothingElseChanges) {
  OutputUnits units;
  units.ask({{"mass", "g"}});
  EXPECT_EQ(units.of("kg").unit, "g");
  EXPECT_EQ(units.of("J").unit, "J");
  EXPECT_EQ(units.of("N m").unit, "N m");
}

TEST(OutputUnits, SayWhatIsWrong) {
  EXPECT_EQ(OutputUnits::problem("angle", "deg"), std::nullopt);
  EXPECT_EQ(OutputUnits::problem("angle", "mm"), "\"mm\" is not a unit of angle");
  EXPECT_EQ(OutputUnits::problem("length", "1"), "expected a unit here; an expression begins with =");
  EXPECT_NE(OutputUnits::problem("lenght", "mm")->find("\"length\""), std::string::npos);
  EXPECT_NE(OutputUnits::problem("length", "furlong")->find("unknown unit"), std::string::npos);
  const TextRun run =
      run_text(R"({"catena": 1, "units": {"angle": "mm"}, "bodies": {"b": {"mass": 1, "inertia": 1}}})");
  EXPECT_EQ(run.outcome.exit_code, 3);
  EXPECT_NE(run.outcome.error_text.find("\"mm\" is not a unit of angle"), std::string::npos) << run.outcome.error_text;
}

// What was sent last, in the units in which it came.
class Kept final : public ResultSink, private RowSink {
 public:
  void begin_run(const RunHeader&) override {}
  RowSink& begin_analysis(std::string_view) override { return *this; }
  void end_analysis(const AnalysisResult& r) override { result = r; }
  void end_run() override {}
  void begin(std::span<const ColumnInfo> given) override { columns.assign(given.begin(), given.end()); }
  bool row(std::span<const double> values) override {
    last.assign(values.begin(), values.end());
    return true;
  }
  AnalysisResult result;
  std::vector<ColumnInfo> columns;
  std::vector<double> last;
};

// Half a turn a second, shown in degrees; measures and extremes too. The outcome itself stays in SI.
TEST(OutputUnits, ConvertColumnsMeasuresAndExtremes) {
  Kept kept;
  UnitsSink shown(kept, {{"time", "ms"}});
  TemporaryFolder folder;
  const std::string path = folder / "scene.json";
  std::ofstream(path) << R"({"catena": 1, "units": {"angle": "deg", "time": "min"},
    "bodies": {"b": {"mass": 1, "inertia": 1}},
    "constraints": [{"type": "absolute_x", "i": "b", "value": 0}, {"type": "absolute_y", "i": "b", "value": 0}],
    "drivers": [{"type": "absolute_angle", "name": "turn", "i": "b", "value": {"polynomial": [0, "0.5 rev/s"]}}],
    "outputs": ["b.angle", "b.omega"],
    "analyses": [{"type": "kinematics", "until": 1, "every": 0.5,
                  "measures": {"largest": {"max": "b.angle"}, "sum": {"integral": "b.angle"}}}]})";
  const SceneOutcome outcome = run_scene(path, {}, shown);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.error_text;
  ASSERT_EQ(kept.columns.size(), 3U);
  EXPECT_EQ(kept.columns[0].unit_text(), "ms");
  EXPECT_EQ(kept.columns[1].unit_text(), "deg");
  EXPECT_EQ(kept.columns[2].unit_text(), "deg/ms");
  EXPECT_NEAR(kept.last[0], 1000, 1e-9);
  EXPECT_NEAR(kept.last[1], 180, 1e-9);
  EXPECT_NEAR(kept.last[2], 0.18, 1e-12);
  ASSERT_EQ(kept.result.measures.size(), 2U);
  EXPECT_EQ(kept.result.measures[0].unit, "deg");
  EXPECT_NEAR(kept.result.measures[0].value.value_or(0), 180, 1e-9);
  EXPECT_NEAR(kept.result.measures[0].t.value_or(0), 1000, 1e-9);
  EXPECT_NEAR(kept.result.measures[1].value.value_or(0), 90 * 1000, 1e-6);
  ASSERT_EQ(kept.result.extremes.size(), 2U);
  EXPECT_NEAR(kept.result.extremes[0].largest, 180, 1e-9);
  EXPECT_NEAR(kept.result.extremes[0].largest_t, 1000, 1e-9);
  EXPECT_NEAR(outcome.analyses[0].measures[0].value.value_or(0), std::numbers::pi, 1e-12);
}

// Angles w t after 2 s of a body that w turns, and x = L cos(w t): derivatives are in deg and mm a unit of the
// parameter in SI, in columns, extremes and gradients alike.
TEST(OutputUnits, ConvertDerivativesAsWhatIsDifferentiated) {
  Kept kept;
  UnitsSink shown(kept, {});
  TemporaryFolder folder;
  const std::string path = folder / "scene.json";
  std::ofstream(path) << R"({"catena": 1, "units": {"angle": "deg", "length": "mm"},
    "parameters": {"w": "30 deg/s", "L": 0.5},
    "bodies": {"b": {"mass": 1, "inertia": 1, "points": {"end": ["L", 0]}}},
    "constraints": [{"type": "revolute", "i": "ground", "j": "b", "at": [0, 0]}],
    "drivers": [{"type": "absolute_angle", "name": "turn", "i": "b", "value": {"polynomial": [0, "w"]}}],
    "outputs": ["b.angle", "b.end.x"],
    "analyses": [{"type": "sensitivity", "parameters": ["w", "L"], "of": {"type": "kinematics", "until": 2, "every": 1,
                  "measures": {"turn": {"final": "b.angle"}, "way": {"final": "b.end.x"}}}}]})";
  const SceneOutcome outcome = run_scene(path, {}, shown);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.error_text;
  const double degrees = 180 / std::numbers::pi, slope = -0.5 * 2 * std::sin(std::numbers::pi / 3);
  const auto value = [&](std::string_view name) {
    const auto at =
        std::find_if(kept.columns.begin(), kept.columns.end(), [&](const auto& c) { return c.name == name; });
    return at == kept.columns.end() ? NAN : kept.last[static_cast<std::size_t>(at - kept.columns.begin())];
  };
  EXPECT_NEAR(value("d(b.angle)/d(w)"), 2 * degrees, 1e-10);
  EXPECT_NEAR(value("d(b.end.x)/d(w)"), 1000 * slope, 1e-9);
  EXPECT_NEAR(value("d(b.end.x)/d(L)"), 1000 * 0.5, 1e-9);
  ASSERT_EQ(kept.result.measures.size(), 2U);
  EXPECT_NEAR(kept.result.measures[0].gradient[0], 2 * degrees, 1e-10);
  EXPECT_NEAR(kept.result.measures[1].gradient[0], 1000 * slope, 1e-9);
  EXPECT_NEAR(kept.result.measures[1].gradient[1], 1000 * 0.5, 1e-9);
  const auto extreme = std::find_if(kept.result.extremes.begin(), kept.result.extremes.end(),
                                    [](const auto& e) { return e.name == "d(b.end.x)/d(L)"; });
  ASSERT_NE(extreme, kept.result.extremes.end());
  EXPECT_NEAR(extreme->largest, 1000, 1e-9);
}

}  // namespace
}  // namespace catena::testing
