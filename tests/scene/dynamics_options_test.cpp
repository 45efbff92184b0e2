// --estimate-error and checkpoints as a user meets them: what they add to results, and where they are refused.
#include <gtest/gtest.h>

#include <bit>

#include "scene/run_text.hpp"

namespace catena {
namespace {

using testing::run_text;
using testing::StoringSink;
using testing::TextRun;

std::string pendulum(const std::string& analyses) {
  return R"({"catena": 1, "gravity": [0, -9.81],
    "bodies": {"a": {"rod": {"from": [0, 0], "to": [1, 0]}, "mass": 1},
               "b": {"rod": {"from": [1, 0], "to": [2, 0]}, "mass": 1}},
    "constraints": [{"type": "revolute", "name": "O", "i": "ground", "j": "a.from"},
                    {"type": "revolute", "name": "A", "i": "a.to", "j": "b.from"}],
    "analyses": [)" +
         analyses + R"(], "outputs": ["a.angle", "b.angle", "A.fx", "energy.balance"]})";
}

const std::string swing = R"({"type": "dynamics", "until": 5, "every": 0.125, "tolerance": 1e-8})";

RunOptions estimating() {
  RunOptions options;
  options.estimate_error = true;
  return options;
}

const FieldValue* field(const TextRun& run, const std::string& name) {
  for (const NamedField& field : run.analysis().fields) {
    if (field.name == name) return &field.value;
  }
  return nullptr;
}

bool warns(const TextRun& run, const std::string& words) {
  for (const std::string& warning : run.analysis().report.warnings) {
    if (warning.find(words) != std::string::npos) return true;
  }
  return false;
}

TEST(ErrorEstimateInScenes, IsAFieldOfFourKinds) {
  const TextRun plain = run_text(pendulum(swing));
  const TextRun run = run_text(pendulum(swing), estimating());
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  ASSERT_TRUE(field(run, "estimated_error"));
  const auto& records = std::get<std::vector<FieldRecord>>(*field(run, "estimated_error"));
  ASSERT_EQ(records.size(), 4u);
  EXPECT_EQ(std::get<std::string>(records[1][0].second), "angle");
  const double angle = std::get<double>(records[1][1].second);
  double difference = 0;
  for (const char* name : {"a.angle", "b.angle"}) {
    const std::vector<double> asked = plain.column(name), given = run.column(name);
    ASSERT_EQ(asked.size(), given.size());
    for (std::size_t k = 0; k < asked.size(); ++k) difference = std::max(difference, std::abs(asked[k] - given[k]));
  }
  EXPECT_EQ(angle, difference) << "the run that was asked for is the one that is made without an estimate";
  EXPECT_GT(angle, 1e-12);
  EXPECT_LT(angle, 1e-7);
  EXPECT_TRUE(warns(run, "estimated_error is how far"));
  EXPECT_FALSE(field(plain, "estimated_error"));
}

TEST(ErrorEstimateInScenes, IsAKeyToo) {
  const TextRun run = run_text(pendulum(
      R"({"type": "dynamics", "until": 1, "step": 0.01, "estimate_error": true,
          "events": [{"name": "down", "when": "a.angle", "value": "-90 deg", "action": "stop"}]})"));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  EXPECT_TRUE(field(run, "estimated_error")) << "an event that ends both runs alike is no obstacle";
  EXPECT_TRUE(warns(run, "steps half as long"));
}

TEST(ErrorEstimateInScenes, IsRefusedWhereItMeansNothing) {
  const TextRun driven = run_text(
      R"({"catena": 1, "bodies": {"a": {}}, "constraints": [{"type": "weld", "i": "ground", "j": "a"}],
          "analyses": [{"type": "kinematics", "at": 0}]})",
      estimating());
  EXPECT_EQ(driven.outcome.exit_code, 2);
  EXPECT_NE(driven.outcome.error_text.find("no dynamics analysis"), std::string::npos) << driven.outcome.error_text;
  const TextRun breaking = run_text(pendulum(R"({"type": "dynamics", "until": 1,
                   "events": [{"name": "break", "when": "a.angle", "value": -1, "action": "release", "element": "A"}]})"),
                                    estimating());
  EXPECT_EQ(breaking.outcome.exit_code, 1);
  EXPECT_NE(breaking.analysis().report.message.find("release"), std::string::npos);
  const TextRun sharp = run_text(pendulum(R"({"type": "dynamics", "until": 1, "tolerance": 2e-14})"), estimating());
  EXPECT_EQ(sharp.outcome.exit_code, 1);
  EXPECT_NE(sharp.analysis().report.message.find("1e-13"), std::string::npos) << sharp.analysis().report.message;
}

TEST(ErrorEstimateInScenes, TellsOfMotionsInWhichErrorsGrow) {
  const TextRun run =
      run_text(pendulum(R"({"type": "dynamics", "until": 60, "tolerance": 1e-6, "estimate_error": true})"));
  ASSERT_EQ(run.outcome.exit_code, 0);
  EXPECT_TRUE(warns(run, "times the tolerance"));
}

/// Of the run that pauses and of the one taken up, every column, bit for bit.
void expect_same_end(const TextRun& whole, const TextRun& rest) {
  const ResultStorage& all = whole.sink.rows.back();
  const ResultStorage& end = rest.sink.rows.back();
  for (const ColumnInfo& column : whole.outcome.analyses.back().columns) {
    const std::vector<double> want = all.column(column.name), got = end.column(column.name);
    ASSERT_LT(got.size(), want.size());
    ASSERT_GT(got.size(), 0u);
    for (std::size_t k = 0; k < got.size(); ++k) {
      const double expected = want[want.size() - got.size() + k];
      EXPECT_EQ(std::bit_cast<std::uint64_t>(got[k]), std::bit_cast<std::uint64_t>(expected))
          << column.name << " " << k;
    }
  }
}

class CheckpointInScenes : public ::testing::Test {
 protected:
  TextRun run(const std::string& text, double every, const std::string& restart = "") {
    RunOptions options;
    options.checkpoint = restart.empty() ? file_ : "";
    options.checkpoint_every = every;
    options.restart = restart;
    return run_text(text, options);
  }
  /// The file as it is when the run has come to time `cut`.
  std::string checkpoint_before(const std::string& text, double every, double cut) {
    const std::string copy = folder_ / "early";
    RunOptions options;
    options.checkpoint = file_;
    options.checkpoint_every = every;
    std::atomic<bool> cancel = false;
    options.cancel = &cancel;
    options.progress = [&](const Progress& progress) { cancel = progress.fraction * 4 >= cut; };
    run_text(text, options);
    std::filesystem::copy_file(file_, copy, std::filesystem::copy_options::overwrite_existing);
    return copy;
  }
  testing::TemporaryFolder folder_;
  std::string file_ = folder_ / "saved";
};

TEST_F(CheckpointInScenes, GoesOnBitForBit) {
  for (const char* method : {"auto", "rk8", "rk5", "adams", "baumgarte", "partitioning"}) {
    const std::string text =
        pendulum(R"({"type": "dynamics", "until": 5, "every": 0.125, "method": ")" + std::string(method) + R"("})");
    const TextRun whole = run(text, 1.7), rest = run(text, 0, file_);
    ASSERT_EQ(whole.outcome.exit_code + rest.outcome.exit_code, 0)
        << whole.outcome.error_text << rest.outcome.error_text;
    expect_same_end(whole, rest);
    EXPECT_TRUE(warns(rest, "taken up from a checkpoint at t = 3.4"));
    EXPECT_EQ(rest.last("t"), 5);
  }
}

// A pin breaks, a latch closes and an instant is noted, before the checkpoint and after it.
TEST_F(CheckpointInScenes, GoesOnThroughEvents) {
  const auto scene = [](const std::string& method) {
    return R"({"catena": 1, "gravity": [0, -9.81],
      "bodies": {"a": {"rod": {"from": [0, 0], "to": [1, 0]}, "mass": 1},
                 "b": {"rod": {"from": [1, 0], "to": [2, 0]}, "mass": 1}},
      "constraints": [{"type": "revolute", "name": "O", "i": "ground", "j": "a.from"},
                      {"type": "revolute", "name": "A", "i": "a.to", "j": "b.from"},
                      {"type": "absolute_angle", "name": "latch", "i": "a", "value": "-100 deg"}],
      "forces": [{"type": "torque", "i": "b", "torque": {"harmonic": {"amplitude": 3, "omega": 5}}}],
      "analyses": [{"type": "dynamics", "until": 4, "every": 0.125, "method": ")" +
           method + R"(", "events": [
        {"name": "low", "when": "b.vy", "value": -1},
        {"name": "break", "when": "a.angle", "value": -1, "action": "release", "element": "A"},
        {"name": "close", "when": "a.angle", "value": "-100 deg", "action": "engage", "element": "latch"}]}],
      "outputs": ["a.angle", "b.angle", "b.y", "O.fx", "energy"]})";
  };
  for (const char* method : {"rk8", "rk5", "adams", "baumgarte", "partitioning"}) {
    for (const double every : {0.13, 0.5, 1.1}) {
      const TextRun whole = run(scene(method), every);
      ASSERT_EQ(whole.outcome.exit_code, 0) << whole.outcome.error_text << whole.analysis().report.message;
      const auto& events = std::get<std::vector<FieldRecord>>(*field(whole, "events"));
      ASSERT_GE(events.size(), 3u);
      // Taken up from the last checkpoint, and from one that a run wrote which was cut off half way.
      for (const double cut : {4.0, 0.6}) {
        if (every > cut) continue;
        const TextRun rest = run(scene(method), 0, checkpoint_before(scene(method), every, cut));
        ASSERT_EQ(rest.outcome.exit_code, 0) << rest.outcome.error_text << rest.analysis().report.message;
        expect_same_end(whole, rest);
        EXPECT_EQ(std::get<std::vector<FieldRecord>>(*field(rest, "events")), events) << method << " " << cut;
      }
    }
  }
}

// The file is of the second analysis: the first is not made again, the third follows.
TEST_F(CheckpointInScenes, SkipsTheAnalysesBefore) {
  const std::string three = pendulum(R"({"type": "dynamics", "until": 1}, {"type": "dynamics", "until": 3}, )"
                                     R"({"type": "check"})");
  const TextRun whole = run(three, 0.8), rest = run(three, 0, file_);
  ASSERT_EQ(rest.outcome.exit_code, 0) << rest.outcome.error_text;
  ASSERT_EQ(rest.outcome.analyses.size(), 2u);
  EXPECT_EQ(rest.outcome.analyses[1].type, "check");
  EXPECT_EQ(rest.last("t"), 3);
  EXPECT_EQ(rest.last("b.angle"), whole.last("b.angle", 1));
}

TEST_F(CheckpointInScenes, RefusesWhatIsNotIts) {
  const std::string text = pendulum(swing);
  run(text, 1.7);
  const auto refused = [&](const TextRun& outcome, const char* why) {
    EXPECT_EQ(outcome.outcome.exit_code, 4);
    EXPECT_EQ(outcome.sink.runs, 0);
    EXPECT_NE(outcome.outcome.error_text.find(why), std::string::npos) << outcome.outcome.error_text;
    EXPECT_NE(outcome.outcome.error_text.find(folder_.path().string()), std::string::npos);
  };
  refused(run(pendulum(R"({"type": "dynamics", "until": 6})"), 0, file_), "another scene");
  refused(run(text, 0, folder_ / "missing"), "no checkpoint");
  RunOptions other;
  other.restart = file_;
  other.verb = "dynamics";
  other.verb_options = {{"until", "2"}};
  refused(run_text(text, other), "another");
  const std::string whole = testing::read_file(file_);
  for (std::size_t cut = 0; cut < whole.size(); cut += 7) {
    const std::string damaged = folder_ / "damaged";
    std::ofstream(damaged, std::ios::binary) << whole.substr(0, cut);
    refused(run(text, 0, damaged), damaged.c_str());
    std::string changed = whole;
    changed[cut] = static_cast<char>(changed[cut] ^ 1);
    std::ofstream(damaged, std::ios::binary) << changed;
    refused(run(text, 0, damaged), damaged.c_str());
  }
}

TEST_F(CheckpointInScenes, SaysWhereItCannotBeWrittenBeforeTheRun) {
  file_ = folder_ / "none" + "/saved";
  const TextRun outcome = run(pendulum(swing), 1);
  EXPECT_EQ(outcome.outcome.exit_code, 4);
  EXPECT_EQ(outcome.sink.runs, 0);
}

TEST_F(CheckpointInScenes, LeavesOneFile) {
  run(pendulum(swing), 0.5);
  EXPECT_EQ(folder_.entries(), 1u);
}

}  // namespace
}  // namespace catena
