// Random mechanisms with redundant equations or massless bodies, of every kind of redundant_mechanisms.hpp and
// massless_mechanisms.hpp, by every method and at tolerances 1e-3 ... 1e-12, against their known motion: none may be
// wrong, at most one in a hundred refused.
//
// Twenty mechanisms a kind, others by the settings of cases.hpp; of those that are wrong or refused twenty are printed.
#include "oracles/redundant_trials.hpp"
#include "stress/cases.hpp"

namespace catena {
namespace {

using namespace testing;

double quantile(std::vector<double> values, double part) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(part * static_cast<double>(values.size() - 1))];
}

template <class Draw>
void check_kind(const std::string& name, Draw&& draw) {
  const std::vector<IntegrationMethod> methods = {IntegrationMethod::automatic, IntegrationMethod::rk8,
                                                  IntegrationMethod::rk5,       IntegrationMethod::adams,
                                                  IntegrationMethod::baumgarte, IntegrationMethod::partitioning};
  const std::vector<double> tolerances = {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12};
  TrialCounts counts;
  int shown = 20;
  const auto show = [&](unsigned seed, IntegrationMethod method, double tolerance, const TrialOutcome& outcome) {
    if (shown-- <= 0) return;
    std::printf("  seed %u, %s, %.0e: %s %s (ratio %.3g)\n", seed, std::string(to_string(method)).c_str(), tolerance,
                outcome.wrong || outcome.told ? "WRONG" : "refused", outcome.message.c_str(), outcome.ratio);
  };
  run_known_trials(draw, first_case(), stress_cases(20), methods, tolerances, counts, show);
  std::printf("%-30s %-13s %6s %6s %8s %10s %10s %10s\n", name.c_str(), "method", "runs", "wrong", "refused", "median",
              "99 %", "largest");
  int runs = 0, refused = 0;
  for (const IntegrationMethod method : methods) {
    const TrialCount& count = counts[method];
    runs += count.runs;
    refused += count.refused;
    std::printf("%-30s %-13s %6d %6d %8d %10.3g %10.3g %10.3g\n", "", std::string(to_string(method)).c_str(),
                count.runs, count.wrong, count.refused, quantile(count.ratios, 0.5), quantile(count.ratios, 0.99),
                quantile(count.ratios, 1));
    EXPECT_EQ(count.wrong + count.told, 0) << name << ", " << to_string(method);
  }
  EXPECT_LE(refused, runs / 100) << name;
}

class RedundantDynamics : public ::testing::TestWithParam<int> {};
TEST_P(RedundantDynamics, FollowsTheKnownMotion) {
  check_kind(redundant_kinds[GetParam()].name, [](unsigned seed) { return draw_redundant(GetParam(), seed); });
}
INSTANTIATE_TEST_SUITE_P(Kinds, RedundantDynamics, ::testing::Range(0, number_of_kinds));

class MasslessDynamics : public ::testing::TestWithParam<int> {};
TEST_P(MasslessDynamics, FollowsTheKnownMotion) {
  const int kind = GetParam(), own = number_of_massless_kinds;
  const std::string name = kind < own ? massless_kinds[kind].name
                                      : std::string("massless: ") + redundant_kinds[massless_variants[kind - own]].name;
  check_kind(name, [](unsigned seed) { return draw_massless(GetParam(), seed); });
}
INSTANTIATE_TEST_SUITE_P(Kinds, MasslessDynamics, ::testing::Range(0, all_massless_kinds));

}  // namespace
}  // namespace catena
