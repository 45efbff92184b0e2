// Many mechanisms with contacts, stops, cables and friction side by side: each moves, to the last bit, as it does in a
// scene of its own, its changes are those of its own run, and all of them together cost the sum of the single runs.
// Against closed forms as well: balls that bounce to rest, blocks that rock (G. W. Housner, Bull. Seism. Soc. Am. 53,
// 1963).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "analysis/sanitized.hpp"
#include "oracles/scene_text.hpp"
#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

constexpr double g = 9.81;
const std::string floor_line = R"("curve": {"line": {"point": [0, 0], "axis": [1, 0]}})";

/// One mechanism, with columns that nothing else has.
struct Piece {
  std::string bodies, constraints, forces, outputs;
};

struct Change {
  std::string name, kind;
  double t;

  friend bool operator==(const Change&, const Change&) = default;
};

std::vector<Change> changes_of(const TextRun& run) {
  std::vector<Change> changes;
  for (const FieldRecord& record : field<std::vector<FieldRecord>>(run, "events")) {
    Change& change = changes.emplace_back();
    for (const auto& [key, value] : record) {
      if (key == "name") change.name = std::get<std::string>(value);
      if (key == "kind") change.kind = std::get<std::string>(value);
      if (key == "t") change.t = std::get<double>(value);
    }
  }
  return changes;
}

TextRun run_of(const std::vector<Piece>& pieces, const std::string& keys, const std::string& outputs = {}) {
  Piece all;
  const auto join = [](std::string& list, const std::string& more) {
    if (!more.empty()) list += (list.empty() ? "" : ", ") + more;
  };
  for (const Piece& piece : pieces) {
    join(all.bodies, piece.bodies);
    join(all.constraints, piece.constraints);
    join(all.forces, piece.forces);
    join(all.outputs, piece.outputs);
  }
  join(all.outputs, outputs);
  TextRun run =
      run_text(R"({"catena": 1, "gravity": [0, -9.81], "bodies": {)" + all.bodies + R"(}, "constraints": [)" +
               all.constraints + R"(], "forces": [)" + all.forces + R"(], "analyses": [{"type": "dynamics", )" + keys +
               R"(}], "outputs": [)" + all.outputs + "]}");
  EXPECT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text
                                      << (run.outcome.analyses.empty() ? "" : run.analysis().report.message);
  return run;
}

/// A rod that falls on the floor and bounces on both ends, rigid or on springs, smooth or with friction.
Piece falling_rod(const std::string& k, RandomNumbers& random) {
  const double length = random(0.3, 0.9), angle = random(-1.3, 1.3), x = random(-3, 3), half = length / 2;
  const double height = half * std::abs(std::sin(angle)) + random(0.02, 0.4);
  const double c = half * std::cos(angle), s = half * std::sin(angle);
  std::string contact =
      random(0, 1) < 0.3 ? R"("k": 2e4, "c": 20)" : R"("rest_speed": 1e-3, "restitution": )" + text_of(random(0, 0.6));
  if (random(0, 1) < 0.4) contact += R"(, "mu": )" + text_of(random(0.1, 0.5));
  const double mass = random(0.2, 3), vy = random(-1, 1), vx = random(-1, 1), omega = random(-2, 2);
  Piece piece{R"("rod)" + k + R"(": {"rod": {"from": )" + pair_of(x - c, height - s) + R"(, "to": )" +
                  pair_of(x + c, height + s) + R"(}, "mass": )" + text_of(mass) + R"(, "velocity": )" +
                  pair_of(vx, vy) + R"(, "angular_velocity": )" + text_of(omega) + "}",
              "", "", R"("rod)" + k + R"(")"};
  for (const char* end : {"from", "to"}) {
    piece.forces += (piece.forces.empty() ? "" : ", ") + (R"({"type": "contact", "name": ")" + std::string(end)) + k +
                    R"(", "i": "ground", "j": "rod)" + k + "." + end + R"(", )" + contact + ", " + floor_line + "}";
    for (const char* column : {".force", ".gap", ".friction", ".slip"})
      piece.outputs += ", \"" + (end + k) + column + "\"";
  }
  return piece;
}

/// A pendulum between a stop and a cable, with friction in its pin, which is named before it is listed.
Piece bounded_pendulum(const std::string& k, RandomNumbers& random) {
  const double length = random(0.4, 1), angle = random(-1, -0.3), x = random(-3, 3);
  return {R"("arm)" + k + R"(": {"rod": {"from": )" + pair_of(x, 2) + R"(, "to": )" +
              pair_of(x + length * std::cos(angle), 2 + length * std::sin(angle)) + R"(}, "mass": 1.5})",
          R"({"type": "revolute", "name": "pin)" + k + R"(", "i": ["ground", )" + pair_of(x, 2) + R"(], "j": "arm)" +
              k + R"(.from"})",
          R"({"type": "friction", "name": "rub)" + k + R"(", "joint": "pin)" + k + R"(", "mu": 0.2, "radius": 0.03},
             {"type": "stop", "name": "stop)" +
              k + R"(", "column": "pin)" + k + R"(.angle", "min": -2.4, "max": 2, "restitution": 0.5})",
          R"("arm)" + k + R"(", "pin)" + k + R"(.angle", "pin)" + k + R"(.fx", "pin)" + k + R"(.lambda2", "rub)" + k +
              R"(.friction", "rub)" + k + R"(.slip", "stop)" + k + R"(.gap", "stop)" + k + R"(.force")"};
}

/// Nothing touches it.
Piece free_pendulum(const std::string& k, RandomNumbers& random) {
  const double length = random(0.4, 1), x = random(-3, 3);
  return {R"("free)" + k + R"(": {"rod": {"from": )" + pair_of(x, 3) + R"(, "to": )" + pair_of(x + length, 3) +
              R"(}, "mass": 1})",
          R"({"type": "revolute", "name": "hinge)" + k + R"(", "i": ["ground", )" + pair_of(x, 3) + R"(], "j": "free)" +
              k + R"(.from"})",
          "", R"("free)" + k + R"(", "hinge)" + k + R"(.fy")"};
}

TEST(SideBySide, EachFallsAsItWouldAlone) {
  const std::string keys = R"("until": 0.8, "every": 0.05, "tolerance": 1e-9)";
  const std::string sums = R"("energy", "momentum")";
  for (unsigned seed = 1; seed <= size_of_test(12u, 4u); ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    std::vector<Piece> pieces;
    const int count = 2 + static_cast<int>(random(0, 5));
    for (int k = 0; k < count; ++k) {
      const std::string number = std::to_string(k);
      pieces.push_back(random(0, 1) < 0.7 ? falling_rod(number, random) : bounded_pendulum(number, random));
    }
    if (random(0, 1) < 0.5) pieces.insert(pieces.begin() + 1, free_pendulum("x", random));
    const TextRun together = run_of(pieces, keys, sums);
    ASSERT_EQ(field<std::int64_t>(together, "integrated_apart"), static_cast<std::int64_t>(pieces.size()));
    std::vector<Change> changes;
    std::vector<TextRun> single;
    Counters counters;
    for (const Piece& piece : pieces) {
      const TextRun& alone = single.emplace_back(run_of({piece}, keys, sums));
      counters += alone.analysis().report.counters;
      if (!piece.forces.empty()) {
        const std::vector<Change> own = changes_of(alone);
        changes.insert(changes.end(), own.begin(), own.end());
      }
      for (const ColumnInfo& column : alone.analysis().columns) {
        if (column.name == "t" || column.name.starts_with("energy") || column.name.starts_with("momentum")) continue;
        if (!column.name.ends_with(".gap")) {
          EXPECT_EQ(together.column(column.name), alone.column(column.name)) << column.name;
          continue;
        }
        // What is measured on frames of other neighbours in memory, to rounding.
        const std::vector<double> a = together.column(column.name), b = alone.column(column.name);
        for (std::size_t row = 0; row < b.size(); ++row) EXPECT_NEAR(a.at(row), b[row], 2e-16) << column.name << row;
      }
    }
    std::stable_sort(changes.begin(), changes.end(), [](const Change& a, const Change& b) { return a.t < b.t; });
    EXPECT_TRUE(changes_of(together) == changes);
    EXPECT_FALSE(changes.empty());
    for (const ColumnInfo& column : together.analysis().columns) {
      if (!column.name.starts_with("energy") && !column.name.starts_with("momentum")) continue;
      const std::vector<double> sum = together.column(column.name);
      for (std::size_t row = 0; row < sum.size(); ++row) {
        double parts = 0, size = 1;
        for (const TextRun& alone : single) {
          parts += alone.column(column.name)[row];
          size += std::abs(alone.column(column.name)[row]);
        }
        EXPECT_NEAR(sum[row], parts, 1e-13 * size) << column.name << row;
      }
    }
    // What one of them meets costs the others nothing.
    const Counters& all = together.analysis().report.counters;
    EXPECT_EQ(all.symbolic, counters.symbolic);
    EXPECT_EQ(all.factorizations, counters.factorizations);
    EXPECT_EQ(all.solves, counters.solves);
    EXPECT_EQ(all.steps, counters.steps);
    EXPECT_EQ(all.rejected, counters.rejected);
  }
}

// The same with what needs all of them at once, an event of the list: steps in common, and the same motion.
TEST(SideBySide, AgreeWithARunInCommon) {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(100 + seed);
    std::vector<Piece> pieces;
    for (int k = 0; k < 3; ++k) pieces.push_back(falling_rod(std::to_string(k), random));
    // Rest speeds are given: by default they are a part of the largest speed of all that moves in one run.
    const std::string keys = R"("until": 0.4, "every": 0.05, "tolerance": 1e-10)";
    const TextRun apart = run_of(pieces, keys);
    const TextRun common = run_of(pieces, keys + R"(, "events": [{"when": "rod0.x", "value": 1e3}])");
    EXPECT_EQ(field<std::int64_t>(apart, "integrated_apart"), 3);
    for (const ColumnInfo& column : apart.analysis().columns) {
      const bool is_rate = column.name.find(".a") != std::string::npos && !column.name.ends_with(".angle");
      if (is_rate || !column.name.starts_with("rod")) continue;
      const std::vector<double> a = apart.column(column.name), b = common.column(column.name);
      ASSERT_EQ(a.size(), b.size());
      for (std::size_t row = 0; row < a.size(); ++row)
        EXPECT_NEAR(a[row], b[row], 1e-8 * (1 + std::abs(b[row]))) << column.name << row;
    }
    const std::vector<Change> a = changes_of(apart), b = changes_of(common);
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t n = 0; n < a.size(); ++n) {
      EXPECT_EQ(a[n].name + a[n].kind, b[n].name + b[n].kind);
      EXPECT_NEAR(a[n].t, b[n].t, 1e-9) << a[n].name << a[n].kind;
    }
  }
}

// Balls from heights h_k: the first impact at sqrt(2 h / g), flights shorter by e each time, rest after
// t_0 (1 + e) / (1 - e).
TEST(SideBySide, BallsBounceToRest) {
  RandomNumbers random(5);
  std::vector<Piece> pieces;
  std::vector<double> heights, parts;
  for (int k = 0; k < 25; ++k) {
    heights.push_back(random(0.05, 0.6));
    parts.push_back(random(0.2, 0.6));
    const std::string ball = "ball" + std::to_string(k), floor = "floor" + std::to_string(k);
    pieces.push_back(
        {"\"" + ball + R"(": {"particle": true, "mass": 1, "position": )" + pair_of(k, heights.back()) + "}", "",
         R"({"type": "contact", "name": ")" + floor + R"(", "i": "ground", "j": ")" + ball + R"(", "restitution": )" +
             text_of(parts.back()) + ", " + floor_line + "}",
         "\"" + ball + R"(.y", ")" + ball + R"(.vy", ")" + floor + R"(.force")"});
  }
  const TextRun run = run_of(pieces, R"("until": 2, "every": 0.1, "tolerance": 1e-10)");
  const std::vector<Change> changes = changes_of(run);
  EXPECT_TRUE(
      std::is_sorted(changes.begin(), changes.end(), [](const Change& a, const Change& b) { return a.t < b.t; }));
  for (std::size_t k = 0; k < heights.size(); ++k) {
    SCOPED_TRACE(k);
    const std::string floor = "floor" + std::to_string(k), ball = "ball" + std::to_string(k);
    const double first = std::sqrt(2 * heights[k] / g), e = parts[k], rest = first * (1 + e) / (1 - e);
    double t = first, flight = 2 * first * e;
    int impacts = 0, contacts = 0;
    for (const Change& change : changes) {
      if (change.name != floor) continue;
      if (change.kind == "impact") {
        EXPECT_NEAR(change.t, t, 1e-9);
        t += flight;
        flight *= e;
        ++impacts;
      } else if (change.kind == "contact") {
        EXPECT_NEAR(change.t, rest, 1e-9);
        ++contacts;
      }
    }
    EXPECT_GT(impacts, 4);
    EXPECT_EQ(contacts, 1);
    EXPECT_NEAR(run.last(ball + ".y"), 0, 1e-12);
    EXPECT_NEAR(run.last(floor + ".force"), g, 1e-9);
  }
}

/// Time in which a block (half diagonal R, its angle to the upright alpha) comes down from the tilt `from` at rest:
/// with w^2 = 2 (m g R / I) (cos(alpha - from) - cos(alpha - tilt)) and tilt = from (1 - u^2), by Simpson's rule.
double time_down(double alpha, double rate_square, double from) {
  constexpr int parts = 4000;
  const auto slowness = [&](double u) {
    // cos a - cos b = 2 sin((a + b) / 2) sin((b - a) / 2), b - a = from u^2.
    const double fall = from * u * u, middle = alpha - from + fall / 2;
    const double per_u = u > 0 ? 2 * std::sin(fall / 2) / (u * u) : from;
    return 2 * from / std::sqrt(2 * rate_square * std::sin(middle) * per_u);
  };
  double sum = slowness(0) + slowness(1);
  for (int n = 1; n < parts; ++n) sum += (n % 2 ? 4 : 2) * slowness(static_cast<double>(n) / parts);
  return sum / (3 * parts);
}

// y(t) after the bounce of a ball of radius 0.1 m from 1 m above the floor. A measure keeps all in one run, in which
// every one of 130 impacts is a change at the same instant.
TEST(SideBySide, MoreThanAHundredStrikeTheFloorAtOnce) {
  const TextRun run = run_text(R"({"catena": 1, "gravity": [0, -9.81], "replicate": [{"count": 130,
    "bodies": {"ball{k}": {"mass": 1, "inertia": 0.01, "position": ["=k", 1.1]}},
    "forces": [{"type": "contact", "name": "c{k}", "i": "ground", "j": "ball{k}", "radius": 0.1, "restitution": 0.5,
      "curve": {"line": {"point": [0, 0], "axis": [1, 0]}}}]}],
    "outputs": ["ball1.y", "ball130.y"], "analyses": [{"type": "dynamics", "until": 0.6, "tolerance": 1e-8,
      "measures": {"highest": {"max": "ball1.y"}}}]})");
  ASSERT_EQ(run.analysis().report.status, Status::ok) << run.analysis().report.message;
  const double t = 0.6 - std::sqrt(2 / 9.81), y = 0.1 + 0.5 * std::sqrt(2 * 9.81) * t - 0.5 * 9.81 * t * t;
  EXPECT_NEAR(run.last("ball1.y"), y, 1e-8);
  EXPECT_NEAR(run.last("ball130.y"), y, 1e-8);
}

// Slender blocks rock on their corners without slip or rebound: every impact leaves 1 - 1.5 sin^2 alpha of the angular
// velocity.
TEST(SideBySide, BlocksRock) {
  RandomNumbers random(11);
  struct Block {
    double alpha, R, tilt;
  };
  std::vector<Block> blocks;
  std::vector<Piece> pieces;
  for (int k = 0; k < 8; ++k) {
    const Block& b = blocks.emplace_back(Block{random(0.15, 0.35), random(0.3, 0.8), random(0.04, 0.1)});
    const double half_width = b.R * std::sin(b.alpha), half_height = b.R * std::cos(b.alpha);
    const std::string number = std::to_string(k), block = "block" + number;
    // Tilted by `tilt` about the right corner, which stands at (0, 0).
    const double x = -b.R * std::sin(b.alpha - b.tilt), y = b.R * std::cos(b.alpha - b.tilt);
    Piece piece{"\"" + block + R"(": {"mass": 2, "inertia": )" + text_of(2 * b.R * b.R / 3) + R"(, "position": )" +
                    pair_of(x, y) + R"(, "angle": )" + text_of(-b.tilt) + R"(, "points": {"left": )" +
                    pair_of(-half_width, -half_height) + R"(, "right": )" + pair_of(half_width, -half_height) + "}}",
                "", "", "\"" + block + R"(.omega", ")" + block + R"(.angle")"};
    for (const std::string side : {"left", "right"}) {
      piece.forces += (piece.forces.empty() ? "" : ", ") + (R"({"type": "contact", "name": ")" + side) + number +
                      R"(", "i": "ground", "j": ")" + block + "." + side + R"(", "mu": 3, )" + floor_line + "}";
    }
    pieces.push_back(piece);
  }
  const TextRun run = run_of(pieces, R"("until": 6, "every": 0.5, "tolerance": 1e-11)");
  const std::vector<Change> changes = changes_of(run);
  for (std::size_t k = 0; k < blocks.size(); ++k) {
    SCOPED_TRACE(k);
    const Block& b = blocks[k];
    const double rate_square = g / (4.0 / 3 * b.R), kept = 1 - 1.5 * std::sin(b.alpha) * std::sin(b.alpha);
    double tilt = b.tilt, t = time_down(b.alpha, rate_square, tilt);
    int impacts = 0;
    for (const Change& change : changes) {
      if (change.kind != "impact" || change.name.substr(change.name.find_first_of("0123456789")) != std::to_string(k))
        continue;
      EXPECT_NEAR(change.t, t, 2e-9) << impacts;
      EXPECT_EQ(change.name.starts_with("left"), impacts % 2 == 0);
      // Up to the next rest: cos(alpha - tilt) = cos alpha + kept^2 (cos(alpha - tilt before) - cos alpha).
      const double rise = kept * kept * (std::cos(b.alpha - tilt) - std::cos(b.alpha));
      tilt = b.alpha - std::acos(std::cos(b.alpha) + rise);
      t += 2 * time_down(b.alpha, rate_square, tilt);
      if (++impacts == 4) break;
    }
    EXPECT_EQ(impacts, 4);
  }
}

}  // namespace
}  // namespace catena::testing
