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

// What was wrong or refused once: rows within steps across flat positions, dependent equations beside very unequal
// masses that were taken for independent, steps whose stages lay beside a flat position, speeds behind it, steps that
// came nearer and nearer without passing it, directions left out that became dependent between two choices, massless
// bodies on which nothing acts, small masses in their place that cost digits all the way to a flat position, a stage of
// the interpolant alone that lay in one, rows in the last step beside one, cut by a choice of coordinates made
// elsewhere, and such choices made in a flat position, beside which all later ones seemed good.
TEST(RedundantMotions, OfCasesThatWereWrong) {
  struct Case {
    bool massless;
    int kind;
    unsigned seed;
    IntegrationMethod method;
    double tolerance;
  };
  using enum IntegrationMethod;
  for (const Case& c : {Case{true, 4, 4, rk5, 1e-5},
                        Case{true, 4, 4, rk5, 1e-12},
                        Case{true, 4, 4, baumgarte, 1e-5},
                        Case{true, 4, 4, baumgarte, 1e-12},
                        Case{true, 5, 1, baumgarte, 1e-10},
                        Case{false, 0, 20020, rk5, 1e-8},
                        Case{false, 0, 10023, baumgarte, 1e-11},
                        Case{false, 0, 10023, partitioning, 1e-12},
                        Case{false, 1, 10012, rk8, 1e-12},
                        Case{false, 1, 10018, adams, 1e-12},
                        Case{false, 0, 10023, rk5, 1e-12},
                        Case{false, 1, 10012, adams, 1e-12},
                        Case{false, 0, 50035, automatic, 1e-11},
                        Case{false, 0, 50029, adams, 1e-12},
                        Case{true, 4, 10012, automatic, 1e-12},
                        Case{true, 4, 10012, partitioning, 1e-12},
                        Case{true, 4, 20020, baumgarte, 1e-12},
                        Case{true, 8, 30102, automatic, 1e-6},
                        Case{true, 4, 10028, automatic, 1e-10},
                        Case{true, 4, 10029, adams, 1e-6},
                        Case{true, 4, 10029, partitioning, 1e-10},
                        Case{true, 5, 652, rk5, 1e-12},
                        Case{true, 5, 652, baumgarte, 1e-12},
                        Case{true, 5, 450, partitioning, 1e-12},
                        Case{true, 5, 68, rk8, 1e-12},
                        Case{true, 5, 301, adams, 1e-12},
                        Case{false, 0, 20011, automatic, 1e-5},
                        Case{false, 1, 40052, partitioning, 1e-11},
                        Case{false, 1, 40066, partitioning, 1e-12}}) {
    const std::optional<KnownMotion> motion =
        c.massless ? draw_massless(c.kind, c.seed) : draw_redundant(c.kind, c.seed);
    ASSERT_TRUE(motion);
    const TrialOutcome outcome = run_trial_of(*motion, known_rows(*motion),
                                              {.method = c.method, .tolerance = c.tolerance, .max_steps = 100'000});
    EXPECT_TRUE(outcome.ok && !outcome.wrong && !outcome.told)
        << motion->kind << ", seed " << c.seed << ", " << to_string(c.method) << ", tolerance " << c.tolerance << ": "
        << outcome.message << ", error " << outcome.ratio << " times what is allowed";
  }
}

// Bars that turn easily, J = 1e-6 ... 1e-3 m l^2, on couplers: the inverse of J hides that of m in the equations.
TEST(RedundantMotions, OfBodiesThatTurnEasily) {
  for (const unsigned seed : {220u, 450u, 652u}) {
    std::optional<KnownMotion> motion = draw_massless(5, seed);
    ASSERT_TRUE(motion);
    for (const double part : {1e-6, 1e-5, 1e-4, 1e-3}) {
      auto model = std::make_shared<Model>(*motion->model);
      for (BasicBody<double>& body : model->bodies) body.inertia = part * body.mass * motion->length * motion->length;
      motion->model = model;
      for (const IntegrationMethod method : {IntegrationMethod::rk5, IntegrationMethod::baumgarte}) {
        const TrialOutcome outcome =
            run_trial_of(*motion, known_rows(*motion), {.method = method, .tolerance = 1e-12, .max_steps = 100'000});
        EXPECT_TRUE(outcome.ok && !outcome.wrong)
            << "seed " << seed << ", " << part << ", " << to_string(method) << ": " << outcome.message << ", error "
            << outcome.ratio << " times what is allowed";
      }
    }
  }
}

// The same beside a pendulum, which is not to be disturbed by what balances the steps of the other.
std::optional<KnownMotion> beside_a_pendulum(int kind, unsigned seed, double times_as_heavy) {
  std::optional<KnownMotion> motion = draw_redundant(kind, seed);
  if (!motion) return motion;
  const double arm = motion->length, mass = times_as_heavy * motion->model->bodies[0].mass;
  const int body = motion->model->add_body("pendulum", {.mass = mass, .inertia = mass * arm * arm / 3});
  motion->freedoms = 2;
  motion->z[1] = 1;
  motion->rate[1] = 2 * motion->pace;
  motion->places = [arm, others = motion->places](const JetCoordinates& z) {
    std::vector<JetPlace> places = others(z);
    places.push_back({turned(z[1], {arm, 0}), z[1]});
    return places;
  };
  const JetPlace place = motion->places_of(motion->z, motion->rate).back();
  BasicBody<double>& pendulum = motion->model->bodies.back();
  pendulum.position = {static_cast<double>(place.r.x.f), static_cast<double>(place.r.y.f)};
  pendulum.angle = static_cast<double>(place.phi.f);
  pendulum.velocity = {static_cast<double>(place.r.x.d), static_cast<double>(place.r.y.d)};
  pendulum.angular_velocity = static_cast<double>(place.phi.d);
  pendulum.velocity_given = pendulum.angular_velocity_given = true;
  motion->model->add("", Revolute<>{{0, 0}, {-arm, 0}}, ground, body);
  return motion;
}

TEST(RedundantMotions, PassFlatPositionsBesideOtherMotions) {
  constexpr double most = 10;  // 24 without the balance, or refused
  for (const double times_as_heavy : {1.0, 1000.0}) {
    for (const auto& [kind, seed] : {std::pair(0, 50035u), std::pair(1, 10012u), std::pair(1, 10013u)}) {
      const std::optional<KnownMotion> motion = beside_a_pendulum(kind, seed, times_as_heavy);
      ASSERT_TRUE(motion);
      const KnownRows rows = known_rows(*motion);
      for (const IntegrationMethod method : {IntegrationMethod::rk8, IntegrationMethod::adams}) {
        const TrialOutcome outcome = run_trial_of(*motion, rows, {.method = method, .tolerance = 1e-12});
        EXPECT_TRUE(outcome.ok && outcome.ratio < most)
            << motion->kind << ", seed " << seed << ", " << to_string(method) << ", " << times_as_heavy
            << " times as heavy: " << outcome.message << ", error " << outcome.ratio << " times what is allowed";
      }
    }
  }
}

}  // namespace
}  // namespace catena
