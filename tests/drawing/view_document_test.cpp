// The data of pages: version, fields and packed numbers, against what the run itself gave.
#include "catena/scene/viewing/view_document.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>

#include "catena/scene/viewing/packed_numbers.hpp"
#include "catena/scene/viewing/viewer_page.hpp"
#include "drawing/packed_text.hpp"
#include "drawing/recorded_text.hpp"

namespace catena::testing {
namespace {

using nlohmann::json;

TEST(PackedNumbers, AreBase64) {
  const std::pair<std::string, std::string> known[] = {// RFC 4648, section 10
                                                       {"", ""},
                                                       {"f", "Zg=="},
                                                       {"fo", "Zm8="},
                                                       {"foo", "Zm9v"},
                                                       {"foob", "Zm9vYg=="},
                                                       {"fooba", "Zm9vYmE="},
                                                       {"foobar", "Zm9vYmFy"}};
  for (const auto& [plain, text] : known) {
    std::string out;
    append_base64(out, {reinterpret_cast<const unsigned char*>(plain.data()), plain.size()});
    EXPECT_EQ(out, text);
    EXPECT_EQ(decoded(text), plain);
  }
}

TEST(ThinnedRows, KeepTheFirstTheLastAndEveryNth) {
  for (const std::size_t limit : {6u, 20u, 1000u}) {
    for (int count = 0; count < 70; ++count) {
      ThinnedRows rows(limit);
      rows.begin(2);
      for (int k = 0; k < count; ++k) rows.add(std::array<double, 2>{1.0 * k, -1.0 * k});
      EXPECT_EQ(rows.seen(), count);
      if (count == 0) continue;
      EXPECT_LE(rows.size() * 2, std::max<std::size_t>(limit, 6) + 2);
      EXPECT_EQ(rows.number(0), 0);
      EXPECT_EQ(rows.number(rows.size() - 1), count - 1);
      for (std::size_t k = 0; k < rows.size(); ++k) {
        EXPECT_EQ(rows[k][0], static_cast<double>(rows.number(k)));
        EXPECT_EQ(rows[k][1], -rows[k][0]);
        EXPECT_TRUE(k + 1 == rows.size() || rows.number(k) == static_cast<std::int64_t>(k) * rows.stride());
      }
    }
  }
}

const std::string pendulum = R"({"catena": 1, "name": "</script><b>", "gravity": [0, -9.81],
  "bodies": {"arm": {"mass": 1, "rod": {"from": [0, 0], "to": [1, 0]}, "points": {"tip": [0.5, 0]}},
             "bob": {"mass": 1, "inertia": 0.1, "position": [1, 0]}},
  "constraints": [{"type": "revolute", "name": "O", "i": "ground", "j": "arm.from"},
                  {"type": "weld", "name": "W", "i": "arm.tip", "j": "bob"}],
  "forces": [{"type": "point_force", "name": "push", "i": "bob", "force": [{"polynomial": [0, 2]}, 1]}],
  "analyses": [{"type": "dynamics", "until": 2, "every": 0.1}, {"type": "modes"}, {"type": "check"}]})";

TEST(ViewDocument, HasTheFieldsOfItsVersion) {
  const RecordedText run = record_text(pendulum);
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  const json page = json::parse(view_document(run.record()));
  EXPECT_EQ(page.at("catena_view"), view_version);
  EXPECT_EQ(page.at("scene"), "</script><b>");
  EXPECT_EQ(page.at("bodies"), json({"arm", "bob"}));
  EXPECT_EQ(page.at("elements").at("name"), json({"O", "W", "push"}));
  EXPECT_EQ(page.at("drawings").size(), 1u);
  ASSERT_EQ(page.at("analyses").size(), 3u);
  for (const json& analysis : page.at("analyses")) {
    for (const char* key : {"type", "status", "message", "warnings", "seconds", "redundant", "set", "fields", "drawing",
                            "rows", "columns", "poses", "shapes"})
      EXPECT_TRUE(analysis.contains(key)) << key;
    EXPECT_EQ(analysis.at("status"), "ok");
  }
  EXPECT_EQ(page.at("analyses")[1].at("shapes").size(), 1u) << "a pendulum has one mode";
  EXPECT_EQ(page.at("analyses")[2].at("poses").at("count"), 1) << "check shows the mechanism as it was assembled";
}

/// Names of all fields of an object and of the objects in it, but for those that scenes and analyses name themselves.
void collect_fields(const json& value, std::set<std::string>& names) {
  for (const json& entry : value.is_array() ? value : json::array()) collect_fields(entry, names);
  if (!value.is_object()) return;
  for (const auto& [name, member] : value.items()) {
    names.insert(name);
    if (name != "fields" && name != "parameters" && name != "set" && name != "gradient" && name != "values" &&
        name != "words")
      collect_fields(member, names);
  }
}

TEST(ViewDocument, EveryFieldIsInTheManual) {
  std::ifstream in(CATENA_DATA_DIR "/../apps/manual/viewer.md");
  const std::string manual((std::istreambuf_iterator<char>(in)), {});
  ASSERT_FALSE(manual.empty());
  std::set<std::string> names;
  collect_fields(json::parse(view_document(record_text(pendulum).record())), names);
  collect_fields(json::parse(view_document(record_text(R"({"catena": 1, "parameters": {"m": 1},
    "bodies": {"a": {"mass": "m", "inertia": 1}},
    "analyses": [{"type": "sensitivity", "parameters": ["m"],
                  "of": {"type": "dynamics", "until": 1, "measures": {"peak": {"max": "a.y"}}}},
                 {"type": "sweep", "over": {"m": [1, 2]},
                  "of": {"type": "dynamics", "until": 1, "measures": {"peak": {"max": "a.y"}}}}]})")
                                               .record())),
                 names);
  EXPECT_GT(names.size(), 40u);
  EXPECT_TRUE(names.contains("designs"));
  for (const std::string& name : names) {
    const bool told =
        manual.find("`" + name + "`") != std::string::npos || manual.find("\"" + name + "\"") != std::string::npos;
    EXPECT_TRUE(told) << name;
  }
}

// The columns of the run give the author's frames; of these bodies that is the centroid.
TEST(ViewDocument, PosesAreThoseOfTheColumns) {
  const RecordedText run = record_text(pendulum);
  const json page = json::parse(view_document(run.record()));
  const json& dynamics = page.at("analyses")[0];
  const json& frames = dynamics.at("poses").at("frames");
  ASSERT_EQ(frames.at("type"), "float32");
  const std::vector<double> values = numbers_in<float>(frames);
  const std::vector<double> base = numbers_in<double>(frames.at("base"));
  std::map<std::string, std::vector<double>> columns;
  for (const json& column : dynamics.at("columns"))
    columns[column.at("name")] = numbers_in<double>(column.at("values"));
  const std::size_t rows = columns.at("t").size();
  ASSERT_EQ(rows, 21u);
  ASSERT_EQ(values.size(), rows * 6);
  EXPECT_EQ(numbers_in<double>(dynamics.at("poses").at("t")), columns.at("t"));
  for (std::size_t k = 0; k < rows; ++k) {
    EXPECT_NEAR(base[0] + values[6 * k], columns.at("arm.x")[k], 1e-7);
    EXPECT_NEAR(base[3] + values[6 * k + 4], columns.at("bob.y")[k], 1e-7);
    EXPECT_NEAR(values[6 * k + 2], columns.at("arm.angle")[k], 1e-6);
  }
  // The force of this row, as the scene writes it.
  const std::vector<double> loads = numbers_in<float>(dynamics.at("poses").at("loads"));
  ASSERT_EQ(loads.size(), 2 * rows);
  for (std::size_t k = 0; k < rows; ++k) {
    EXPECT_NEAR(loads[2 * k], 2 * columns.at("t")[k], 1e-6);
    EXPECT_EQ(loads[2 * k + 1], 1);
  }
}

// Newton's law for the whole: the reaction at O is what is left of mass times acceleration, here by differences.
TEST(ViewDocument, ReactionsAreThoseOfTheMotion) {
  const RecordedText run = record_text(R"({"catena": 1, "gravity": [0, -9.81],
    "bodies": {"arm": {"mass": 2, "rod": {"from": [0, 0], "to": [1, 0]}}},
    "constraints": [{"type": "revolute", "name": "O", "i": "ground", "j": "arm.from"}],
    "analyses": [{"type": "dynamics", "until": 0.5, "every": 0.001}]})");
  const json page = json::parse(view_document(run.record()));
  const json& poses = page.at("analyses")[0].at("poses");
  const std::vector<double> reactions = numbers_in<float>(poses.at("reactions").at("values"));
  const std::vector<double> velocities = numbers_in<float>(poses.at("velocities"));
  for (std::size_t k = 10; k < 490; k += 48) {
    const double ay = (velocities[3 * (k + 1) + 1] - velocities[3 * (k - 1) + 1]) / 0.002;
    const double ax = (velocities[3 * (k + 1)] - velocities[3 * (k - 1)]) / 0.002;
    EXPECT_NEAR(reactions[4 * k], 0, 1e-7) << "at the pin";
    EXPECT_NEAR(reactions[4 * k + 2], 2 * ax, 2e-3) << k;
    EXPECT_NEAR(reactions[4 * k + 3], 2 * (ay + 9.81), 2e-3) << k;
  }
}

TEST(ViewDocument, LongRunsAreThinnedAndSaidToBe) {
  const RecordedText run = record_text(pendulum, {.pose_values = 200, .column_values = 30, .columns = 4});
  const json page = json::parse(view_document(run.record()));
  const json& dynamics = page.at("analyses")[0];
  EXPECT_GT(dynamics.at("poses").at("stride"), 1);
  EXPECT_EQ(dynamics.at("poses").at("total"), 21);
  EXPECT_EQ(numbers_in<double>(dynamics.at("poses").at("t")).back(), 2);
  EXPECT_EQ(dynamics.at("columns").size(), 4u);
  EXPECT_EQ(page.at("notes").size(), 3u) << page.at("notes").dump(1);
}

// 16 bits a coordinate: no further from the truth than half a step, angles modulo whole turns.
TEST(ViewDocument, ManyPosesArePackedInSixteenBits) {
  constexpr int bodies = 3400;
  const RecordedText run = record_text(R"({"catena": 1, "replicate": [{"count": )" + std::to_string(bodies) +
                                       R"(, "bodies": {"b{k}": {"position": ["=k", "=k*k/1000"]}},
          "drivers": [{"type": "absolute_x", "i": "b{k}", "value": {"polynomial": ["=k", "=k/100"]}},
                      {"type": "absolute_y", "i": "b{k}", "value": "=k*k/1000"},
                      {"type": "absolute_angle", "i": "b{k}", "value": {"polynomial": [0, "=k/10"]}}]}],
          "outputs": ["b1.x"], "analyses": [{"type": "kinematics", "until": 2, "every": 0.01}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  const json page = json::parse(view_document(run.record()));
  const json& poses = page.at("analyses")[0].at("poses");
  const json& frames = poses.at("frames");
  ASSERT_EQ(frames.at("type"), "uint16");
  const std::vector<double> values = numbers_in<std::uint16_t>(frames), t = numbers_in<double>(poses.at("t"));
  ASSERT_EQ(values.size(), t.size() * 3 * bodies);
  const std::vector<double> base = numbers_in<double>(frames.at("base"));
  const double step = frames.at("step")[0];
  EXPECT_NEAR(step, bodies / 100 * 2.0 / 65535, 1e-9) << "that of the body that moves farthest";
  const double turn = 2 * std::numbers::pi;
  for (std::size_t k = 0; k < t.size(); k += 17) {
    for (std::size_t b = 0; b < bodies; b += 97) {
      const double number = static_cast<double>(b + 1), at = values[3 * (k * bodies + b)];
      EXPECT_NEAR(base[2 * b] + step * at, number + number / 100 * t[k], 0.51 * step);
      const double angle = values[3 * (k * bodies + b) + 2] * frames.at("step")[2].get<double>();
      EXPECT_NEAR(std::remainder(angle - number / 10 * t[k], turn), 0, 0.51 * turn / 65536);
    }
  }
}

TEST(ViewerPage, HoldsItsDataWithoutMarkup) {
  if (viewer_template().empty()) GTEST_SKIP() << "built without the viewer";
  const RecordedText run = record_text(pendulum);
  const std::string page = compose_page(view_document(run.record()));
  EXPECT_EQ(page.find("</script><b>"), std::string::npos);
  const std::string opening = "id=\"catena-data\">";
  const std::size_t from = page.find(opening) + opening.size();
  const json data = json::parse(page.substr(from, page.find("</script>", from) - from));
  EXPECT_EQ(data.at("scene"), "</script><b>");
  EXPECT_EQ(page.find("http://www.w3.org/2000/svg") == std::string::npos, false) << "the page draws SVG";
  EXPECT_EQ(page.find("src=\"http"), std::string::npos) << "nothing is loaded from elsewhere";
}

}  // namespace
}  // namespace catena::testing
