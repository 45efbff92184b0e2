// A few random mechanisms with redundant equations or massless bodies, of every kind, against their known motion; many
// more in tests/stress/redundant_dynamics_test.cpp.
#include "oracles/redundant_trials.hpp"

namespace catena {
namespace {

using namespace testing;

template <class Draw>
void check(Draw&& draw) {
  TrialCounts counts;
  run_known_trials(
      draw, 1, 1,
      {IntegrationMethod::automatic, IntegrationMethod::rk5, IntegrationMethod::adams, IntegrationMethod::baumgarte,
       IntegrationMethod::partitioning},
      {1e-4, 1e-8}, counts, [](unsigned seed, IntegrationMethod method, double tolerance, const TrialOutcome& outcome) {
        ADD_FAILURE() << "seed " << seed << ", " << to_string(method) << ", tolerance " << tolerance << ": "
                      << outcome.message << ", error " << outcome.ratio << " times what is allowed";
      });
}

class RedundantMotion : public ::testing::TestWithParam<int> {};
TEST_P(RedundantMotion, IsTheKnownOne) {
  check([](unsigned seed) { return draw_redundant(GetParam(), seed); });
}
INSTANTIATE_TEST_SUITE_P(Kinds, RedundantMotion, ::testing::Range(0, number_of_kinds));

class MasslessMotion : public ::testing::TestWithParam<int> {};
TEST_P(MasslessMotion, IsTheKnownOne) {
  check([](unsigned seed) { return draw_massless(GetParam(), seed); });
}
INSTANTIATE_TEST_SUITE_P(Kinds, MasslessMotion, ::testing::Range(0, all_massless_kinds));

// What was wrong once: rows within steps across flat positions, dependent equations beside very unequal masses that
// were taken for independent, steps whose stages lay beside a flat position, and massless bodies on which nothing acts.
TEST(RedundantMotions, OfCasesThatWereWrong) {
  struct Case {
    bool massless;
    int kind;
    unsigned seed;
    IntegrationMethod method;
    double tolerance;
  };
  using enum IntegrationMethod;
  for (const Case& c : {Case{true, 4, 4, rk5, 1e-5}, Case{true, 4, 4, rk5, 1e-12}, Case{true, 4, 4, baumgarte, 1e-5},
                        Case{true, 4, 4, baumgarte, 1e-12}, Case{true, 5, 1, baumgarte, 1e-10},
                        Case{false, 0, 20020, rk5, 1e-8}, Case{false, 0, 10023, baumgarte, 1e-11},
                        Case{false, 0, 10023, partitioning, 1e-12}, Case{false, 1, 10012, rk8, 1e-12},
                        Case{false, 1, 10018, adams, 1e-12}, Case{true, 8, 30102, automatic, 1e-6}}) {
    const std::optional<KnownMotion> motion =
        c.massless ? draw_massless(c.kind, c.seed) : draw_redundant(c.kind, c.seed);
    ASSERT_TRUE(motion);
    const TrialOutcome outcome = run_trial_of(*motion, known_rows(*motion),
                                              {.method = c.method, .tolerance = c.tolerance, .max_steps = 100'000});
    EXPECT_TRUE(outcome.ok && !outcome.wrong)
        << motion->kind << ", seed " << c.seed << ", " << to_string(c.method) << ", tolerance " << c.tolerance << ": "
        << outcome.message << ", error " << outcome.ratio << " times what is allowed";
  }
}

}  // namespace
}  // namespace catena
