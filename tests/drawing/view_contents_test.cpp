// What pages say of a run: units and words of columns, measures, names of other models; and that looking changes
// nothing.
#include <gtest/gtest.h>

#include <cmath>

#include "catena/scene/viewing/view_document.hpp"
#include "drawing/packed_text.hpp"
#include "drawing/recorded_text.hpp"

namespace catena::testing {
namespace {

/// The column of this name.
const json& column_of(const json& analysis, const std::string& name) {
  for (const json& column : analysis.at("columns")) {
    if (column.at("name") == name) return column;
  }
  throw std::out_of_range(name);
}

// A column of one's own has the unit that its author or its inputs give it; a status is a word.
TEST(ViewDocument, UnitsAndWordsAreThoseOfTheColumns) {
  const json own = json::parse(view_document(record_text(R"({"catena": 1, "bodies": {"a": {}},
    "constraints": [{"type": "revolute", "i": "ground", "j": "a"}],
    "drivers": [{"type": "absolute_angle", "i": "a", "value": {"polynomial": [0, 1]}}],
    "columns": {"speed": {"value": "=2*a.omega", "unit": "m/s"}}, "outputs": ["speed", "a.omega"],
    "analyses": [{"type": "kinematics", "until": 1, "every": 0.5}]})")
                                                 .record()));
  EXPECT_EQ(column_of(own.at("analyses")[0], "speed").at("unit"), "m/s");
  EXPECT_EQ(column_of(own.at("analyses")[0], "a.omega").at("unit"), "rad/s");
  EXPECT_FALSE(column_of(own.at("analyses")[0], "speed").contains("words"));
  const RecordedText swept = record_text(R"({"catena": 1, "parameters": {"a": 1},
    "bodies": {"p": {"rod": {"from": [0, 0], "to": ["a", 0]}}},
    "constraints": [{"type": "revolute", "i": "ground", "j": "p.from"}, {"type": "absolute_y", "i": "p.to", "value": 1.5}],
    "analyses": [{"type": "sweep", "over": {"a": [1, 2]},
                  "of": {"type": "kinematics", "at": 0, "measures": {"last": {"final": "p.angle"}}}}]})");
  const json sweep = json::parse(view_document(swept.record())).at("analyses")[0];
  const json& status = column_of(sweep, "status");
  const std::vector<double> values = numbers_in<double>(status.at("values"));
  ASSERT_EQ(values.size(), 2u) << swept.outcome.error_text;
  const auto word = [&](double value) { return status.at("words").at(std::to_string(static_cast<int>(value))); };
  EXPECT_NE(word(values[0]), "ok") << "a bar of 1 m does not reach 1.5 m";
  EXPECT_EQ(word(values[1]), "ok");
}

TEST(ViewDocument, HasMeasuresWithTheirDerivatives) {
  const RecordedText run = record_text(R"({"catena": 1, "parameters": {"a": 3}, "bodies": {"p": {}},
    "constraints": [{"type": "revolute", "i": "ground", "j": "p"}],
    "drivers": [{"type": "absolute_angle", "i": "p", "value": {"polynomial": [0, "a"]}}],
    "analyses": [{"type": "sensitivity", "parameters": ["a"],
                  "of": {"type": "kinematics", "until": 2, "measures": {"turned": {"final": "p.angle"}}}}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  const json page = json::parse(view_document(run.record()));
  const json& measures = page.at("analyses")[0].at("measures");
  ASSERT_EQ(measures.size(), 1u) << run.outcome.error_text;
  EXPECT_EQ(measures[0].at("name"), "turned");
  EXPECT_EQ(measures[0].at("unit"), "rad");
  EXPECT_NEAR(measures[0].at("value").get<double>(), 6, 1e-12);
  EXPECT_NEAR(measures[0].at("gradient").at("a").get<double>(), 2, 1e-9);
}

// Parameters of an analysis may change how many bodies there are, and where their points lie.
TEST(ViewDocument, AnalysesWithOtherBodiesHaveNamesOfTheirOwn) {
  const RecordedText run = record_text(R"({"catena": 1, "parameters": {"n": 2, "a": 1},
    "replicate": [{"count": "n", "bodies": {"b{k}": {"position": ["=k", 0], "points": {"tip": ["a", 0]}}},
      "drivers": [{"type": "absolute_x", "i": "b{k}", "value": {"polynomial": ["=k", 1]}},
                  {"type": "absolute_y", "i": "b{k}", "value": 0}, {"type": "absolute_angle", "i": "b{k}", "value": 0}]}],
    "analyses": [{"type": "kinematics", "until": 1, "every": 0.5},
                 {"type": "kinematics", "until": 1, "every": 0.5, "from": "initial", "set": {"n": 4}},
                 {"type": "kinematics", "until": 1, "every": 0.5, "from": "initial", "set": {"a": 5}}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  const json page = json::parse(view_document(run.record()));
  EXPECT_EQ(page.at("bodies").size(), 2u);
  const auto drawing = [&](int k) { return page.at("drawings").at(page.at("analyses")[k].at("drawing").get<int>()); };
  EXPECT_FALSE(drawing(0).contains("bodies")) << "those of the scene";
  EXPECT_EQ(drawing(1).at("bodies"), json({"b1", "b2", "b3", "b4"}));
  EXPECT_EQ(drawing(1).at("elements").at("name").size(), 12u);
  EXPECT_EQ(drawing(1).at("given").size(), 12u);
  EXPECT_EQ(drawing(2).at("points").at("at"), json({5, 0, 5, 0}));
  EXPECT_EQ(numbers_in<float>(page.at("analyses")[1].at("poses").at("frames")).size(), 3u * 3 * 4);
}

// Drawings ask for more than the columns need; the columns stay the same to the last digit.
TEST(ViewDocument, DrawingChangesNoRow) {
  for (const char* name : {"crank_rocker", "jansen_leg", "six_bar", "slider_crank_joints", "cam_followers",
                           "four_bar_gradients", "path_generation", "two_bar_truss"}) {
    SCOPED_TRACE(name);
    const std::string path = std::string(CATENA_DATA_DIR "/scenes/") + name + ".json";
    RunRecorder plain, drawn;
    RunOptions options;
    ASSERT_EQ(run_scene(path, options, plain).exit_code, 0);
    options.poses = &drawn;
    ASSERT_EQ(run_scene(path, options, drawn).exit_code, 0);
    ASSERT_EQ(plain.record().analyses.size(), drawn.record().analyses.size());
    for (std::size_t a = 0; a < plain.record().analyses.size(); ++a) {
      const ThinnedRows &without = plain.record().analyses[a].rows, &with = drawn.record().analyses[a].rows;
      ASSERT_EQ(without.size(), with.size());
      ASSERT_EQ(plain.record().analyses[a].result.measures.size(), drawn.record().analyses[a].result.measures.size());
      for (std::size_t m = 0; m < plain.record().analyses[a].result.measures.size(); ++m)
        EXPECT_EQ(plain.record().analyses[a].result.measures[m].value,
                  drawn.record().analyses[a].result.measures[m].value);
      for (std::size_t k = 0; k < with.size(); ++k) {
        for (std::size_t c = 0; c < with[k].size(); ++c) {
          ASSERT_EQ(std::isnan(with[k][c]), std::isnan(without[k][c])) << a << ' ' << k << ' ' << c;
          if (std::isnan(with[k][c])) continue;
          ASSERT_EQ(with[k][c], without[k][c]) << a << ' ' << k << ' ' << c;
        }
      }
    }
  }
}

}  // namespace
}  // namespace catena::testing
