// How many digits of the columns of random mechanisms are right, by their own claim and by a solution in long double:
// the quick share of stress/digits_test.cpp, which has motions under forces as well.
#include <random>

#include "analysis/sanitized.hpp"
#include "catena/analysis/stability/modes.hpp"
#include "oracles/buckling_columns.hpp"
#include "oracles/oscillators.hpp"
#include "stress/driven_digits.hpp"
#include "stress/moving_digits.hpp"
#include "stress/path_digits.hpp"
#include "stress/resting_digits.hpp"
#include "stress/touching_digits.hpp"

namespace catena::testing {
namespace {

// True over claimed error of the column omega2, both of the largest of its rows; negative: nothing to compare.
double optimism_of_modes(unsigned seed) {
  const Oscillator oscillator(seed);
  Modes modes(oscillator.model, {}, {.count = 1000});
  const ModesReport report = modes.run();
  const std::vector<long double> wanted = oscillator.omega2();
  if (!report.ok() || report.omega2.size() != wanted.size() || wanted.empty()) return -1;
  long double error = 0, claimed = 0, size = 0;
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    const long double rate = oscillator.rate();
    error = std::max(error, std::abs(report.omega2[k] - wanted[k] * rate));
    claimed = std::max<long double>(claimed, report.errors[k]);
    size = std::max(size, std::abs(wanted[k] * rate));
  }
  const long double least = size * std::numeric_limits<double>::epsilon() / 4;
  return size > 0 ? static_cast<double>(std::max(error, least) / std::max(claimed, 2 * least)) : -1;
}

// The same of the nearest buckling load.
double optimism_of_load(unsigned seed) {
  const BucklingColumn column(seed);
  Buckling buckling(column.model_at(column.present()), [&](double p) { return column.model_at(p); },
                    {.present = column.present(), .count = 1, .errors = true});
  const BucklingReport report = buckling.run();
  const long double wanted = column.nearest();
  if (!report.ok() || report.loads.empty() != std::isnan(wanted)) {
    ADD_FAILURE() << seed << ": " << report.message << ", " << report.loads.size() << " loads found, nearest "
                  << static_cast<double>(wanted);
    return -1;
  }
  if (report.loads.empty()) return -1;
  // Of two at the same distance either is right.
  const long double present = column.present(), found = report.loads[0];
  const long double error = std::abs(std::abs(found - present) - std::abs(wanted - present));
  const long double least = std::abs(wanted) * std::numeric_limits<double>::epsilon() / 4;
  const long double claimed = std::max<long double>(report.errors[0], 2 * least);
  return std::isnan(report.errors[0]) ? -1 : static_cast<double>(std::max(error, least) / claimed);
}

/// Prints them; never more than ten, and a hundredth at the median.
void expect_optimism(const char* title, std::vector<double> optimism, std::size_t least) {
  std::erase_if(optimism, [](double o) { return o < 0; });
  ASSERT_GE(optimism.size(), least);
  std::sort(optimism.begin(), optimism.end());
  std::printf("%s: true / claimed error %.3g (most), %.3g (median)\n", title, optimism.back(),
              optimism[optimism.size() / 2]);
  EXPECT_LE(optimism.back(), 10);
  EXPECT_GE(optimism[optimism.size() / 2], 0.01);
}

template <class Add>
void expect_claims(const char* title, unsigned seeds, int least, Add&& add) {
  ClaimedDigits claims;
  int compared = 0;
  for (unsigned seed = 1; seed <= seeds; ++seed) compared += add(seed, claims) == "compared";
  EXPECT_GE(compared, least);
  claims.expect(title);
}

TEST(ClaimedDigits, HoldInDrivenMotion) { expect_claims("driven", 40, 20, add_driven_digits); }
TEST(ClaimedDigits, HoldInMotionOfOneRun) {
  expect_claims("in motion, one run", size_of_test(40u, 12u), size_of_test(20, 5),
                [](unsigned seed, ClaimedDigits& claims) { return add_moving_digits(seed, claims, Runs::one); });
}
TEST(ClaimedDigits, HoldOfMethodsThatRunTwice) {
  for (const auto& [method, title] : {std::pair(Runs::adams, "adams"), std::pair(Runs::baumgarte, "baumgarte"),
                                      std::pair(Runs::partitioning, "partitioning")}) {
    const auto add = [runs = method](unsigned seed, ClaimedDigits& claims) {
      return add_moving_digits(seed, claims, runs);
    };
    expect_claims(title, 20, 10, add);
  }
}
// Both runs drift off the constraints in the same way: a rate was claimed 27 times better than it was.
TEST(ClaimedDigits, HoldOfRatesThatDrift) {
  ClaimedDigits claims;
  EXPECT_EQ(add_moving_digits(70090, claims, Runs::baumgarte), "compared");
  claims.expect("drift");
}
TEST(ClaimedDigits, HoldWithContacts) {
  expect_claims("with contacts", size_of_test(45u, 15u), size_of_test(25, 5), add_touching_digits);
}
TEST(ClaimedDigits, HoldOfPaths) {
  expect_claims("paths", size_of_test(40u, 14u), size_of_test(25, 5), add_path_digits);
}

/// Two rods under gravity that hang on each other.
Json double_pendulum(const Json& analyses) {
  return {{"catena", 1},
          {"gravity", {0, -9.81}},
          {"bodies",
           {{"a", {{"mass", 1}, {"inertia", 0.1}, {"position", {0.5, 0}}}},
            {"b", {{"mass", 1}, {"inertia", 0.1}, {"position", {1.5, 0}}}}}},
          {"constraints",
           {{{"type", "revolute"}, {"i", {"ground", {0, 0}}}, {"j", {"a", {-0.5, 0}}}},
            {{"type", "revolute"}, {"i", {"a", {0.5, 0}}}, {"j", {"b", {-0.5, 0}}}}}},
          {"analyses", analyses},
          {"outputs", {"a.angle", "b.omega"}}};
}

// The error must grow as those of the motion do: chaotic after a while, and no digit may be claimed then.
TEST(ClaimedDigits, OfALongChaoticMotionAreNone) {
  const auto run_until = [](double until) {
    const Json analysis = {{"type", "dynamics"}, {"until", until}, {"every", until / 50}};
    return run_text(double_pendulum(Json::array({analysis})).dump());
  };
  const TextRun brief = run_until(1), lasting = run_until(200);
  ASSERT_EQ(brief.analysis().digits.size(), 3u);
  EXPECT_GT(brief.analysis().digits[1], 6);
  EXPECT_LT(brief.analysis().digits[1], 13);
  ASSERT_EQ(lasting.analysis().digits.size(), 3u);
  for (const std::size_t column : {1u, 2u}) EXPECT_LE(lasting.analysis().digits[column], 0.1);
}

// An analysis does not know the errors of the motion that it goes on from.
TEST(ClaimedDigits, AreNoneOfWhatGoesOnFromAMotion) {
  const auto dynamics = [](double until, double tolerance) {
    return Json{{"type", "dynamics"}, {"until", until}, {"every", 0.1}, {"tolerance", tolerance}};
  };
  Json anew = dynamics(0.5, 1e-10), estimated = dynamics(5.7, 1e-10);
  anew["from"] = "initial";
  estimated["estimate_error"] = true;
  const Json modes = {{"type", "modes"}}, rest = {{"type", "equilibrium"}};
  const Json analyses = {dynamics(5, 1e-3), dynamics(5.5, 1e-12), estimated, modes, anew, modes, rest, modes,
                         dynamics(1, 1e-10)};
  const TextRun run = run_text(double_pendulum(analyses).dump());
  const std::vector<bool> claims = {true, false, false, false, true, false, true, true, true};
  ASSERT_EQ(run.outcome.analyses.size(), claims.size());
  for (std::size_t k = 0; k < claims.size(); ++k) {
    ASSERT_TRUE(run.analysis(k).report.ok()) << k << ": " << run.analysis(k).report.message;
    EXPECT_EQ(!run.analysis(k).digits.empty(), claims[k]) << k;
  }
}

/// A disc that turns after a function of time, by a driver or a torque, until w t = phase; columns as they are exact.
struct TimedDisc {
  double omega, until, phase;
  bool driven;

  TextRun run() const {
    Json scene = {{"catena", 1},
                  {"bodies", {{"disc", {{"mass", 1}, {"inertia", 2}, {"points", {{"rim", {1, 0}}}}}}}},
                  {"constraints", {{{"type", "revolute"}, {"i", {"ground", {0, 0}}}, {"j", {"disc", {0, 0}}}}}},
                  {"outputs", {"disc.rim.x", "disc.alpha"}}};
    const Json wave = {{"harmonic", {{"amplitude", 1}, {"omega", omega}}}};
    if (driven) {
      scene["drivers"] = Json::array({{{"type", "absolute_angle"}, {"i", "disc"}, {"value", wave}}});
      scene["analyses"] = Json::array({{{"type", "inverse_dynamics"}, {"until", until}, {"every", until / 7}}});
    } else {
      scene["forces"] = Json::array({{{"type", "torque"}, {"i", "disc"}, {"torque", wave}}});
      scene["analyses"] =
          Json::array({{{"type", "dynamics"}, {"until", until}, {"every", until / 7}, {"tolerance", 1e-6}}});
    }
    return run_text(scene.dump());
  }
  long double alpha(double t) const {
    const long double w = omega, sine = std::sin(w * t);
    return driven ? -w * w * sine : sine / 2;
  }
};

// A function of time is known to the rounding of its argument: of w t = 1e4 four digits are lost.
TEST(ClaimedDigits, CountTheRoundingOfTime) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> part(0.5, 1);
  for (const bool driven : {true, false}) {
    ClaimedDigits claims;
    for (const double phase : {1e2, 1e3, 1e4}) {
      for (int k = 0; k < size_of_test(8, 3); ++k) {
        TimedDisc disc{.omega = 300 * part(random), .until = 0, .phase = phase * part(random), .driven = driven};
        disc.until = disc.phase / disc.omega;
        const TextRun run = disc.run();
        ASSERT_TRUE(run.analysis().report.ok()) << run.analysis().report.message;
        ASSERT_EQ(run.analysis().digits.size(), 3u);
        std::vector<long double> alpha;
        for (const double t : run.column("t")) alpha.push_back(disc.alpha(t));
        claims.add(run, "disc.alpha", alpha, "w t = " + std::to_string(disc.phase));
        EXPECT_LT(run.analysis().digits[2], 16.5 - std::log10(disc.phase)) << driven;
        EXPECT_GT(run.analysis().digits[2], 14 - std::log10(disc.phase)) << driven;
      }
    }
    claims.expect(driven ? "driven by functions of late times" : "under loads of late times");
  }
}

TEST(ClaimedDigits, HoldOfOscillations) {
  std::vector<double> optimism;
  for (unsigned seed = 1; seed <= 300; ++seed) optimism.push_back(optimism_of_modes(seed));
  expect_optimism("modes", optimism, 200);
}
TEST(ClaimedDigits, HoldOfBucklingLoads) {
  std::vector<double> optimism;
  const auto last = size_of_test<std::size_t>(300, 60);
  for (unsigned seed = 1; seed <= last; ++seed) optimism.push_back(optimism_of_load(seed));
  expect_optimism("buckling", optimism, last / 2);
}

TEST(ClaimedDigits, HoldAtRest) { expect_claims("at rest", 40, 15, add_resting_digits); }

// Steps of order 5 end with the state that their last stage was evaluated at: nothing is stiff there.
TEST(ClaimedDigits, OfOrderFiveOnASpline) {
  const TextRun run = run_text(R"({"catena": 1, "gravity": [0, -9.81], "bodies": {"b": {"particle": true, "mass": 1,
    "position": [-0.3, 0.1]}}, "constraints": [{"type": "point_on_curve", "i": "ground", "j": "b",
    "curve": {"spline": {"points": [[-1, 0.2], [-0.3, 0.1], [0.3, -0.05], [0.8, 0.1], [2, 0.2]], "end": "natural"}}}], "outputs": ["b.x"],
    "analyses": [{"type": "dynamics", "method": "rk5", "until": 1, "every": 0.5}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  ASSERT_FALSE(run.analysis().digits.empty());
  for (const double digits : run.analysis().digits) EXPECT_GT(digits, 4);
}

}  // namespace
}  // namespace catena::testing
