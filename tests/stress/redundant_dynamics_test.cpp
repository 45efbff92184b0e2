// Random mechanisms with redundant equations, of every kind of redundant_mechanisms.hpp, by every method and at
// tolerances 1e-3 ... 1e-12, against their known motion: none may be wrong, at most one in a hundred refused.
//
// CATENA_CASES: mechanisms a kind (default 20); CATENA_KIND: only that kind; CATENA_SEED: the first seed (1).
#include <cstdlib>

#include "oracles/redundant_trials.hpp"

namespace catena {
namespace {

using namespace testing;

int setting(const char* name, int otherwise) {
  const char* text = std::getenv(name);
  return text ? std::atoi(text) : otherwise;
}

double quantile(std::vector<double> values, double part) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(part * static_cast<double>(values.size() - 1))];
}

void check_kind(int kind) {
  const int only = setting("CATENA_KIND", -1);
  if (only >= 0 && only != kind) GTEST_SKIP();
  const std::vector<IntegrationMethod> methods = {IntegrationMethod::automatic, IntegrationMethod::rk8,
                                                  IntegrationMethod::rk5,       IntegrationMethod::adams,
                                                  IntegrationMethod::baumgarte, IntegrationMethod::partitioning};
  const std::vector<double> tolerances = {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12};
  std::map<IntegrationMethod, TrialCount> counts;
  int shown = setting("CATENA_SHOW", 10);
  run_redundant_trials(
      kind, static_cast<unsigned>(setting("CATENA_SEED", 1)), setting("CATENA_CASES", 20), methods, tolerances, counts,
      [&](unsigned seed, IntegrationMethod method, double tolerance, const TrialOutcome& outcome) {
        if (shown-- <= 0) return;
        std::printf("  seed %u, %s, %.0e: %s %s (ratio %.3g)\n", seed, std::string(to_string(method)).c_str(),
                    tolerance, outcome.wrong ? "WRONG" : "refused", outcome.message.c_str(), outcome.ratio);
      });
  std::printf("%-20s %-13s %6s %6s %8s %10s %10s %10s\n", redundant_kinds[kind], "method", "runs", "wrong", "refused",
              "median", "99 %", "largest");
  int runs = 0, refused = 0;
  for (const IntegrationMethod method : methods) {
    const TrialCount& count = counts[method];
    runs += count.runs;
    refused += count.refused;
    std::printf("%-20s %-13s %6d %6d %8d %10.3g %10.3g %10.3g\n", "", std::string(to_string(method)).c_str(),
                count.runs, count.wrong, count.refused, quantile(count.ratios, 0.5), quantile(count.ratios, 0.99),
                quantile(count.ratios, 1));
    EXPECT_EQ(count.wrong, 0) << redundant_kinds[kind] << ", " << to_string(method);
  }
  EXPECT_LE(refused, runs / 100) << redundant_kinds[kind];
}

class RedundantDynamics : public ::testing::TestWithParam<int> {};
TEST_P(RedundantDynamics, FollowsTheKnownMotion) { check_kind(GetParam()); }
INSTANTIATE_TEST_SUITE_P(Kinds, RedundantDynamics, ::testing::Range(0, number_of_kinds));

}  // namespace
}  // namespace catena
