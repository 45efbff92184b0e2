// What dynamics must not do, whatever the method: take memory from the heap step after step.
#include "catena/analysis/dynamics/dynamics_with_events.hpp"
#include "catena/elements/constraints/friction.hpp"
#include "economy/allocations.hpp"
#include "oracles/dynamics_mechanisms.hpp"

namespace catena {
namespace {

using testing::allocations;
using testing::four_bars;
using testing::rod_chain;
using testing::squeezer;

/// Counts what is allocated from the twentieth step and the third row on: by then every kind of work was done once.
class CountingObserver final : public RowObserver {
 public:
  bool observe(const Snapshot&) override {
    ++rows_;
    return true;
  }
  bool proceed(double) override {
    ++steps_;
    if (steps_ >= 20 && rows_ >= 3 && before_ < 0) {
      before_ = allocations;
      first_step_ = steps_;
    }
    last_ = allocations;
    return true;
  }
  long counted() const { return last_ - before_; }
  long steps() const { return before_ < 0 ? 0 : steps_ - first_step_; }

 private:
  long rows_ = 0, steps_ = 0, first_step_ = 0, before_ = -1, last_ = 0;
};

class DynamicsAllocation : public ::testing::TestWithParam<IntegrationMethod> {};

template <class Motion>
void check(Motion& motion, double until) {
  CountingObserver observer;
  const Needs everything{.velocity = true, .acceleration = true, .multipliers = true, .work = true};
  const AnalysisReport report = motion.run(TimeGrid::range(0, until, until / 200), everything, observer);
  ASSERT_TRUE(report.ok()) << report.message;
  EXPECT_GT(observer.steps(), 20);
  EXPECT_EQ(observer.counted(), 0) << observer.steps() << " steps";
}

void check(const std::shared_ptr<Model>& model, double until, IntegrationMethod method) {
  Dynamics dynamics(model, {}, {.method = method, .tolerance = 1e-8});
  check(dynamics, until);
}

TEST_P(DynamicsAllocation, NoneAStepOfAChain) { check(rod_chain(5), 2, GetParam()); }
TEST_P(DynamicsAllocation, NoneAStepWithASpringAndLoops) { check(squeezer(), 0.03, GetParam()); }
TEST_P(DynamicsAllocation, NoneAStepThroughAFlatPosition) { check(four_bars(2), 2, GetParam()); }

// A rod that spins about a pin that rubs: friction and the pin's reaction depend on each other.
TEST_P(DynamicsAllocation, NoneAStepWithDryFriction) {
  const std::shared_ptr<Model> model = rod_chain(1);
  model->bodies[0].angular_velocity = 20;
  model->bodies[0].velocity = {0, 10};
  model->bodies[0].velocity_given = model->bodies[0].angular_velocity_given = true;
  Friction<> friction;
  friction.joint = model->find_element("pin1");
  friction.mu = 0.3;
  friction.radius = 0.02;
  model->add("rub", friction, ground, 0, 0.0);
  DynamicsWithEvents motion(model, {}, {.method = GetParam(), .tolerance = 1e-8}, {}, {.analysis = "dynamics"});
  check(motion, 2);
}

std::string method_name(const ::testing::TestParamInfo<IntegrationMethod>& info) {
  return std::string(to_string(info.param));
}
INSTANTIATE_TEST_SUITE_P(Methods, DynamicsAllocation, ::testing::ValuesIn(testing::all_methods), method_name);

}  // namespace
}  // namespace catena
