// Designs of optimisations and sweeps in the data of pages: which are there, and that each is what its parameters make
// it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "catena/scene/viewing/view_document.hpp"
#include "drawing/packed_text.hpp"
#include "drawing/recorded_text.hpp"

namespace catena::testing {
namespace {

/// A bar on a pin whose end is held at a height: its angle is asin(height / length) where it reaches.
std::string bar_scene(const std::string& analysis) {
  return R"({"catena": 1, "parameters": {"length": 2, "height": 1},
    "bodies": {"bar": {"mass": 1, "rod": {"from": [0, 0], "to": ["length", 0]}}},
    "constraints": [{"type": "revolute", "i": "ground", "j": "bar.from"},
                    {"type": "absolute_y", "i": "bar.to", "value": "height"}],
    "outputs": ["bar.angle"], "analyses": [)" +
         analysis + "]}";
}

constexpr const char* turned = R"({"type": "kinematics", "at": 0, "measures": {"turned": {"final": "bar.angle"}}})";

/// Angle of the only body at the last pose of a design's last analysis.
double last_angle(const json& design) {
  const json& frames = design.at("analyses").back().at("poses").at("frames");
  return numbers_in<float>(frames).back();
}

TEST(ViewDesigns, OfAnOptimisationAreItsStartAndItsEnd) {
  const RecordedText run = record_text(bar_scene(std::string(R"({"type": "optimise", "of": )") + turned +
                                                 R"(, "variables": {"length": {"min": 1.2, "max": 3}},
      "minimise": "=(turned - 0.4)^2", "tolerance": 1e-12})"));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  const json optimise = json::parse(view_document(run.record())).at("analyses")[0];
  const json& designs = optimise.at("designs");
  ASSERT_EQ(designs.size(), 2u);
  EXPECT_EQ(designs[0].at("name"), "start");
  EXPECT_FALSE(designs[0].contains("row"));
  EXPECT_EQ(designs[0].at("values"), json({{"length", 2}}));
  EXPECT_NEAR(last_angle(designs[0]), std::asin(0.5), 1e-6);
  EXPECT_EQ(designs[1].at("name"), "best");
  EXPECT_EQ(designs[1].at("row"), optimise.at("rows").at("total").get<int>() - 1);
  EXPECT_NEAR(designs[1].at("values").at("length"), 1 / std::sin(0.4), 1e-4);
  EXPECT_NEAR(last_angle(designs[1]), 0.4, 1e-5);
  EXPECT_NEAR(designs[1].at("analyses")[0].at("measures")[0].at("value"), 0.4, 1e-5);
  EXPECT_EQ(designs[1].at("analyses")[0].at("columns")[1].at("name"), "bar.angle");
  EXPECT_NE(designs[0].at("analyses")[0].at("drawing"), designs[1].at("analyses")[0].at("drawing"))
      << "bars of two lengths";
}

// Random bars, some of which do not reach: the poses are those of their parameters, whatever the number of threads.
TEST(ViewDesigns, OfASweepAreThoseOfItsRows) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> length(1, 2), height(0.2, 1.2);
    std::vector<double> lengths, heights;
    for (int k = 0; k < 4; ++k) lengths.push_back(length(random)), heights.push_back(height(random));
    const std::string scene = bar_scene(fmt::format(
        R"({{"type": "sweep", "design": "together", "over": {{"length": [{}], "height": [{}]}}, "of": {}}})",
        fmt::join(lengths, ", "), fmt::join(heights, ", "), turned));
    const RecordedText alone = record_text(scene, {}, 1), together = record_text(scene, {}, 3);
    const json sweep = json::parse(view_document(alone.record())).at("analyses")[0];
    EXPECT_EQ(sweep.at("designs").size(), 4u);
    const json other = json::parse(view_document(together.record())).at("analyses")[0];
    for (std::size_t k = 0; k < 4; ++k) {
      const json& design = sweep.at("designs")[k];
      EXPECT_EQ(design.at("row"), k);
      EXPECT_EQ(design.at("values").at("length"), lengths[k]);
      EXPECT_EQ(design.at("name"), fmt::format("design {}", k + 1));
      EXPECT_EQ(design.at("analyses")[0].at("poses").at("frames"),
                other.at("designs")[k].at("analyses")[0].at("poses").at("frames"));
      const json& inner = design.at("analyses")[0];
      if (heights[k] > lengths[k]) {
        EXPECT_NE(inner.at("status"), "ok") << seed << ' ' << k;
      } else {
        ASSERT_EQ(inner.at("status"), "ok") << seed << ' ' << k;
        EXPECT_NEAR(last_angle(design), std::asin(heights[k] / lengths[k]), 1e-6) << seed << ' ' << k;
      }
    }
  }
}

TEST(ViewDesigns, OfManySomeAreKeptAndTheRestIsTold) {
  const std::string sweep =
      bar_scene(std::string(R"({"type": "sweep", "over": {"length": {"from": 1.5, "to": 3, "count": 21}}, "of": )") +
                turned + "}");
  const RecordedText run = record_text(sweep, {.designs = 6});
  const json page = json::parse(view_document(run.record()));
  const json& designs = page.at("analyses")[0].at("designs");
  ASSERT_EQ(designs.size(), 6u) << "every fourth";
  for (std::size_t k = 0; k < designs.size(); ++k) EXPECT_EQ(designs[k].at("row"), 4 * k);
  ASSERT_EQ(page.at("notes").size(), 1u);
  EXPECT_NE(page.at("notes")[0].get<std::string>().find("6 of 21 designs"), std::string::npos) << page.at("notes");
  const RecordedText large = record_text(sweep, {.design_parts = 5});
  EXPECT_FALSE(json::parse(view_document(large.record())).at("analyses")[0].contains("designs"))
      << "two mechanisms of three parts are more than five";
}

// A sensitivity shows the motion that it is of.
TEST(ViewDesigns, SensitivitiesHaveThePosesOfTheirAnalysis) {
  const RecordedText run = record_text(R"({"catena": 1, "parameters": {"a": 3}, "bodies": {"p": {}},
    "constraints": [{"type": "revolute", "i": "ground", "j": "p"}],
    "drivers": [{"type": "absolute_angle", "i": "p", "value": {"polynomial": [0, "a"]}}],
    "analyses": [{"type": "sensitivity", "parameters": ["a"], "of": {"type": "kinematics", "until": 2, "every": 0.5}}]})");
  const json poses = json::parse(view_document(run.record())).at("analyses")[0].at("poses");
  EXPECT_EQ(poses.at("count"), 5);
  EXPECT_NEAR(numbers_in<float>(poses.at("frames")).back(), 6, 1e-6);
}

TEST(ViewUnits, AreThoseAskedForOfWhatTheRunHas) {
  const RecordedText run = record_text(R"({"catena": 1, "units": {"angle": "deg", "time": "ms"}, "bodies": {"p": {}},
    "constraints": [{"type": "revolute", "i": "ground", "j": "p"}],
    "drivers": [{"type": "absolute_angle", "i": "p", "value": {"polynomial": [0, 1]}}],
    "outputs": ["p.angle", "p.omega"], "analyses": [{"type": "kinematics", "until": 1, "every": 0.5}]})");
  const json page = json::parse(view_document(run.record(), {{"time", "min"}, {"length", "mm"}}));
  const json& units = page.at("units");
  EXPECT_EQ(units.at("m"), json({{"unit", "mm"}, {"factor", 1000.0}}));
  EXPECT_EQ(units.at("s").at("unit"), "min") << "the command line comes before the scene";
  EXPECT_NEAR(units.at("rad").at("factor"), 180 / std::numbers::pi, 1e-12);
  EXPECT_EQ(units.at("rad/s").at("unit"), "deg/min");
  EXPECT_NEAR(units.at("rad/s").at("factor"), 180 / std::numbers::pi * 60, 1e-9);
  EXPECT_FALSE(units.contains("N")) << "as it is";
  EXPECT_EQ(page.at("analyses")[0].at("columns")[1].at("unit"), "rad") << "the data are in SI";
  EXPECT_TRUE(json::parse(view_document(record_text(bar_scene(turned)).record())).at("units").empty());
}

TEST(ViewArrows, OfTooManyBodiesAreLeftOutAndItIsSaid) {
  const std::string scene = R"({"catena": 1, "replicate": [{"count": 20,
      "bodies": {"b{k}": {"mass": 1, "inertia": 1, "position": ["=k", 0]}}}],
    "gravity": [0, -9.81], "analyses": [{"type": "dynamics", "until": 1, "every": 0.5}]})";
  const json few = json::parse(view_document(record_text(scene, {.arrow_parts = 20}).record()));
  EXPECT_EQ(few.at("analyses")[0].at("poses").at("arrows"), true);
  EXPECT_EQ(numbers_in<float>(few.at("analyses")[0].at("poses").at("velocities")).size(), 3u * 20 * 3);
  EXPECT_TRUE(few.at("notes").empty());
  const json many = json::parse(view_document(record_text(scene, {.arrow_parts = 19}).record()));
  EXPECT_EQ(many.at("analyses")[0].at("poses").at("arrows"), false);
  EXPECT_FALSE(many.at("analyses")[0].at("poses").contains("velocities"));
  ASSERT_EQ(many.at("notes").size(), 1u);
  EXPECT_NE(many.at("notes")[0].get<std::string>().find("20 bodies and elements"), std::string::npos);
}

}  // namespace
}  // namespace catena::testing
