// Ropes that are wound further than their places tell, from one analysis to the next: an involute of a peg, wound up
// and off again without gravity and at rest under it, drums in driven motions, checkpoints. Against closed forms.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <vector>

#include "catena/analysis/dynamics/dynamics_with_events.hpp"
#include "catena/results/checkpoint.hpp"
#include "catena/scene/building/build_model.hpp"
#include "catena/scene/reading/scene_reader.hpp"
#include "oracles/scene_text.hpp"
#include "results/temporary_folder.hpp"
#include "scene/event_entries.hpp"
#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

constexpr double pi = std::numbers::pi;

/// A particle of 1 kg on a rope from (0, 0) over a peg of radius r at (0, -h), of which l0 is free where the straight
/// rope touches the peg: there it begins, with the speed v across the rope. Without gravity
///
///   b = p - r (cos phi, sin phi) + l (sin phi, -cos phi)      l = l0 - r c,  phi = in + c,  l^2 = l0^2 - 2 r v t
struct Involute {
  double r, h, l0, v = 3;

  double first() const { return std::sqrt(h * h - r * r); }
  double in() const { return -std::asin(r / h); }
  double length() const { return first() + l0; }
  double time_of(double contact) const {
    const double l = l0 - r * contact;
    return (l0 * l0 - l * l) / (2 * r * v);
  }
  std::array<double, 2> place(double contact) const {
    const double phi = in() + contact, l = l0 - r * contact;
    return {-r * std::cos(phi) + l * std::sin(phi), -h - r * std::sin(phi) - l * std::cos(phi)};
  }
  /// Where it comes to rest under gravity from a contact: the rope hangs down, phi a multiple of 2 pi.
  double contact_at_rest(double contact) const { return 2 * pi * std::round((in() + contact) / (2 * pi)) - in(); }

  std::string scene(const std::string& analyses, const std::string& more = "") const {
    const double x = length() * std::sin(in()), y = -length() * std::cos(in());
    return fmt::format(R"({{"catena": 1, "parameters": {{"g": 0}}, "gravity": [0, "=-g"],
      "bodies": {{"b": {{"particle": true, "mass": 1, "position": [{:.17g}, {:.17g}],
        "velocity": [{:.17g}, {:.17g}]}}}},
      "forces": [{{"type": "rope", "name": "rope", "i": "ground",
        "over": [{{"at": ["ground", [0, {:.17g}]], "radius": {:.17g}, "side": 1}}], "j": "b"{}}}],
      "outputs": ["b.x", "b.y", "rope.length", "rope.force"], "analyses": [{}]}})",
                       x, y, v * std::cos(in()), v * std::sin(in()), -h, r, more, analyses);
  }
  std::string wind(double contact) const {
    return fmt::format(R"({{"type": "dynamics", "at": [{:.17g}], "tolerance": 1e-12}})", time_of(contact));
  }
};

void expect_at(const TextRun& run, std::size_t analysis, std::array<double, 2> place, double tolerance) {
  ASSERT_LT(analysis, run.outcome.analyses.size()) << run.outcome.analyses.back().report.message;
  ASSERT_TRUE(run.analysis(analysis).report.ok()) << analysis << ": " << run.analysis(analysis).report.message;
  EXPECT_NEAR(run.last("b.x", analysis), place[0], tolerance) << analysis;
  EXPECT_NEAR(run.last("b.y", analysis), place[1], tolerance) << analysis;
}

// Wound up, the length is still that of the rope; it hangs with as many turns, and goes on to wind.
TEST(RopeTurns, GoOnFromDynamicsToWhatFollows) {
  for (unsigned seed = 0; seed <= 8; ++seed) {
    RandomNumbers random(seed);
    const double turns = seed == 0 ? 1.3 : seed == 1 ? 2.5 : random(0.8, 2.6);
    SCOPED_TRACE(turns);
    const Involute peg{.r = seed < 2 ? 0.1 : random(0.05, 0.12), .h = random(0.3, 0.5), .l0 = random(2.2, 2.6)};
    const double wound = 2 * pi * turns, more = wound + random(0.5, 2);
    const TextRun run = run_text(peg.scene(
        peg.wind(wound) + R"(, {"type": "assemble"}, {"type": "modes"}, )" + peg.wind(more) +
        R"(, {"type": "assemble"}, {"type": "equilibrium", "set": {"g": 9.81}}, {"type": "assemble", "set": {"g": 9.81}},
           {"type": "equilibrium", "set": {"g": 9.81}}, {"type": "modes", "set": {"g": 9.81}})"));
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.outcome.analyses.back().report.message;
    expect_at(run, 0, peg.place(wound), 1e-8);
    for (const std::size_t k : {0u, 1u, 3u, 4u, 5u, 6u, 7u}) {
      EXPECT_NEAR(run.last("rope.length", k), peg.length(), 1e-9) << k;
    }
    expect_at(run, 1, peg.place(wound), 1e-8);
    expect_at(run, 3, peg.place(more), 1e-8);
    const double rest = peg.contact_at_rest(more);
    for (const std::size_t k : {5u, 6u, 7u}) expect_at(run, k, {-peg.r, -peg.h - (peg.l0 - peg.r * rest)}, 1e-9);
    for (const std::size_t k : {5u, 7u}) EXPECT_NEAR(run.last("rope.force", k), 9.81, 1e-9);
    // It swings about the peg's side, its free length changing to second order alone: omega^2 = g / l.
    const std::vector<double> squares = run.column("omega2", 8);
    ASSERT_EQ(squares.size(), 1u);
    EXPECT_NEAR(squares[0], 9.81 / (peg.l0 - peg.r * rest), 1e-7);
  }
}

std::shared_ptr<const Model> model_of(const std::string& text) {
  Diagnostics diagnostics;
  const auto scene = read_scene(SourceText("scene", text), diagnostics);
  const std::vector<double> values = scene->parameters.evaluate<double>(scene->expressions, diagnostics);
  auto model = std::make_shared<Model>(build_model<double>(*scene, values, {}, diagnostics));
  EXPECT_TRUE(diagnostics.ok()) << diagnostics.text();
  return model;
}

/// Runs dynamics to t from a state, in C++.
SystemState run_on(const std::shared_ptr<const Model>& model, const SystemState& from, double t) {
  DynamicsOptions options;
  options.tolerance = 1e-12;
  DynamicsWithEvents dynamics(model, {}, options, {}, {.analysis = "dynamics", .timed = true});
  dynamics.start_from(from);
  RowFunction nothing([](const Snapshot&) { return true; });
  const AnalysisReport report = dynamics.run(TimeGrid::instant(t), {}, nothing);
  EXPECT_TRUE(report.ok()) << report.message;
  return dynamics.state();
}

// The angle of contact belongs to the state; thrown back the rope unwinds, and ends where it began.
TEST(RopeTurns, UnwindingEndsWhereItBegan) {
  for (const std::string stiffness : {"", R"(, "k": 400)"}) {
    for (const double turns : {1.3, 2.5}) {
      SCOPED_TRACE(stiffness + std::to_string(turns));
      const Involute peg{.r = 0.1, .h = 0.4, .l0 = 2.4};
      const std::shared_ptr<const Model> model = model_of(peg.scene("", stiffness));
      const double t = peg.time_of(2 * pi * turns);
      SystemState begin = run_on(model, {}, 0), end = run_on(model, begin, t);
      ASSERT_EQ(end.ropes.size(), 1u);
      EXPECT_GT(end.ropes[0].contact[1], 2 * pi * turns - (stiffness.empty() ? 1e-7 : 0.5));
      if (stiffness.empty()) {
        EXPECT_NEAR(end.ropes[0].contact[1], 2 * pi * turns, 1e-7);
        EXPECT_NEAR(end.ropes[0].theta, peg.in() - pi / 2, 1e-12);
      }
      for (double& v : end.qd) v = -v;
      const SystemState back = run_on(model, end, 2 * t);
      for (std::size_t k = 0; k < begin.q.size(); ++k) {
        EXPECT_NEAR(back.q[k], begin.q[k], 1e-8);
        EXPECT_NEAR(back.qd[k], -begin.qd[k], 1e-7);
      }
      EXPECT_NEAR(back.ropes.at(0).contact[1], 0, 1e-6);
    }
  }
}

TEST(RopeTurns, OfAnotherModelAreRefused) {
  const Involute peg{.r = 0.1, .h = 0.4, .l0 = 2.4};
  const std::shared_ptr<const Model> model = model_of(peg.scene(""));
  SystemState state = run_on(model, {}, 0.1);
  state.ropes[0].contact.pop_back();
  DynamicsWithEvents dynamics(model, {}, {}, {}, {.analysis = "dynamics", .timed = true});
  dynamics.start_from(state);
  RowFunction nothing([](const Snapshot&) { return true; });
  EXPECT_THROW(dynamics.run(TimeGrid::instant(0.2), {}, nothing), std::invalid_argument);
}

// Between the angle from which a place alone takes the rope for one beside, and a whole turn.
TEST(RopeTurns, FollowedToRestBeyondWhatAPlaceTells) {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    for (const std::string stiffness : {"", R"(, "k": 1e4)"}) {
      SCOPED_TRACE(fmt::format("{} {}", seed, stiffness));
      RandomNumbers random(seed);
      // It comes in level, below the peg, and hangs down on its near side: the contact is three quarters of a turn.
      const double r = random(0.1, 0.2), contact = random(3.6, 4.1), l = random(1, 1.5);
      const double phi = pi / 2 + contact, x = -r * std::cos(phi) + l * std::sin(phi),
                   y = -r * std::sin(phi) - l * std::cos(phi);
      const TextRun run = run_text(fmt::format(R"({{"catena": 1, "gravity": [0, -9.81], "bodies": {{"b": {{
        "particle": true, "mass": 1, "position": [{:.17g}, {:.17g}]}}}}, "forces": [{{"type": "rope", "name": "rope",
        "i": ["ground", [-2, {:.17g}]], "over": [{{"at": ["ground", [0, 0]], "radius": {:.17g}, "side": 1}}],
        "j": "b"{}}}], "outputs": ["b.x", "b.y", "rope.length", "rope.force"],
        "analyses": [{{"type": "equilibrium"}}, {{"type": "equilibrium"}}]}})",
                                               x, y, -r, r, stiffness));
      ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
      const double stretch = stiffness.empty() ? 0 : 9.81 / 1e4;
      for (const std::size_t k : {0u, 1u}) {
        EXPECT_NEAR(run.last("b.x", k), -r, 1e-9);
        EXPECT_NEAR(run.last("b.y", k), -(l + stretch - r * (1.5 * pi - contact)), 1e-9);
        EXPECT_NEAR(run.last("rope.force", k), 9.81, 1e-8);
      }
    }
  }
}

// Driven round a peg, in two analyses, with an assembly between: the way is that of tangents and arc, turn by turn.
TEST(RopeTurns, GoOnInDrivenMotions) {
  const double r = 0.1, a = 0.5, l = 2;
  const std::string wound = R"({"type": "assemble"}, {"type": "kinematics", "until": 1.2, "every": 0.005})";
  const TextRun run = run_text(fmt::format(R"({{"catena": 1, "bodies": {{"arm": {{"position": [{0}, 0],
    "points": {{"p": [{1}, 0]}}}}}}, "constraints": [{{"type": "revolute", "i": ["ground", [{0}, 0]], "j": "arm"}}],
    "drivers": [{{"type": "absolute_angle", "i": "arm", "value": {{"harmonic": {{"amplitude": 14, "omega": 1}}}}}}],
    "forces": [{{"type": "rope", "name": "rope", "i": "ground", "over": [{{"at": ["ground", [{0}, 0]], "radius": {2},
    "side": 1}}], "j": "arm.p", "length": 9}}],
    "outputs": ["arm.angle", "rope.length"], "analyses": [{3}, {{"type": "assemble"}},
      {{"type": "kinematics", "until": 3, "every": 0.005}}, {{"type": "assemble"}}]}})",
                                           a, l, r, wound));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.outcome.analyses.back().report.message;
  for (std::size_t k = 0; k < 5; ++k) {
    const std::vector<double> angle = run.column("arm.angle", k), length = run.column("rope.length", k);
    ASSERT_FALSE(angle.empty());
    for (std::size_t n = 0; n < angle.size(); ++n) {
      const double contact = angle[n] + std::asin(r / l) + std::asin(r / a);
      const double straight = std::hypot(a + l * std::cos(angle[n]), l * std::sin(angle[n]));
      const double over = std::sqrt(a * a - r * r) + std::sqrt(l * l - r * r) + r * contact;
      EXPECT_NEAR(length[n], contact > 0 ? over : straight, 1e-9) << k << ": " << angle[n];
    }
  }
  EXPECT_GT(run.last("arm.angle", 2), 4 * pi);
}

// An elastic rope is followed through checkpoints: what is taken up from one ends as the run that wrote it, bit for
// bit, and as the involute says.
TEST(RopeTurns, GoOnThroughCheckpoints) {
  const Involute peg{.r = 0.1, .h = 0.4, .l0 = 2.4};
  const double first = peg.time_of(2 * pi * 1.3), second = peg.time_of(2 * pi * 2.4);
  TemporaryFolder folder;
  const std::string file = folder / "rope", early = folder / "early";
  const std::string text = peg.scene(fmt::format(R"({{"type": "dynamics", "at": [{0:.17g}], "tolerance": 1e-11}},
        {{"type": "dynamics", "at": [{0:.17g}, {1:.17g}, {2:.17g}], "tolerance": 1e-11}}, {{"type": "assemble"}})",
                                                 first, (first + second) / 2, second),
                                     R"(, "k": 400)");
  const TextRun plain = run_text(text);
  RunOptions options;
  options.checkpoint = file;
  options.checkpoint_every = 0.05;
  options.progress = [&](const Progress& progress) {
    if (progress.number != 1 || progress.fraction < 0.3 || progress.fraction > 0.6) return;
    std::filesystem::copy_file(file, early, std::filesystem::copy_options::overwrite_existing);
  };
  const TextRun whole = run_text(text, options);
  ASSERT_EQ(whole.outcome.exit_code, 0) << whole.outcome.error_text << whole.outcome.analyses.back().report.message;
  RunOptions restart;
  restart.restart = early;
  const TextRun rest = run_text(text, restart);
  ASSERT_EQ(rest.outcome.exit_code, 0) << rest.outcome.error_text << rest.outcome.analyses.back().report.message;
  for (const char* column : {"b.x", "b.y", "rope.length", "rope.force"}) {
    EXPECT_EQ(std::bit_cast<std::uint64_t>(rest.last(column, 0)), std::bit_cast<std::uint64_t>(whole.last(column, 1)))
        << column;
    EXPECT_EQ(std::bit_cast<std::uint64_t>(rest.last(column, 1)), std::bit_cast<std::uint64_t>(whole.last(column, 2)))
        << column;
    EXPECT_NEAR(whole.last(column, 1), plain.last(column, 1), 1e-6) << column;
  }
  // Its free part is as long as the way less what is wound: two turns and more.
  const double x = whole.last("b.x", 1), y = whole.last("b.y", 1) + peg.h, d = std::hypot(x, y);
  const double wound = (whole.last("rope.length", 1) - peg.first() - std::sqrt(d * d - peg.r * peg.r)) / peg.r;
  EXPECT_GT(wound, 4 * pi);
  EXPECT_NEAR(std::remainder(std::atan2(x, -y) + std::asin(peg.r / d) - peg.in() - wound, 2 * pi), 0, 1e-9);
}

// An elastic pendulum that swings off its peg once: a run that pauses fifteen times tells of it once.
TEST(RopeTurns, WhatHappenedIsToldOnceWhateverThePauses) {
  const std::string text = R"({"catena": 1, "gravity": [0, -9.81],
    "bodies": {"b": {"particle": true, "mass": 1, "position": [0.7, -0.7]}},
    "forces": [{"type": "rope", "name": "rope", "i": "ground", "j": "b", "k": 4000,
      "over": [{"at": ["ground", [0, -0.5]], "radius": 0.05, "side": 1}]}],
    "outputs": ["b.x"], "analyses": [{"type": "dynamics", "until": 1.6, "tolerance": 1e-9}]})";
  const std::vector<EventEntry> plain = events_of(run_text(text));
  ASSERT_EQ(plain.size(), 1u);
  TemporaryFolder folder;
  RunOptions options;
  options.checkpoint = folder / "rope";
  options.checkpoint_every = 0.1;
  const std::vector<EventEntry> paused = events_of(run_text(text, options));
  ASSERT_EQ(paused.size(), 1u);
  EXPECT_NEAR(paused.front().t, plain.front().t, 1e-8);
}

TEST(RopeTurns, CheckpointsOfAnOlderFormatAreRefused) {
  TemporaryFolder folder;
  const std::string file = folder / "old";
  std::ofstream(file, std::ios::binary) << "catena checkpoint 4\n0\n";
  try {
    static_cast<void>(read_checkpoint(file));
    FAIL();
  } catch (const CheckpointError& error) {
    EXPECT_NE(std::string(error.what()).find("another version"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace catena::testing
