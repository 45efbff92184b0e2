// `auto` goes over to implicit steps where stiffness makes explicit ones short, and back where they are no longer worth
// their matrix.
//
// Explicit steps that are short beside the motion are suspicious: more than `many` of them in 1 / rate, the time in
// which the mechanism changes (error_scale.hpp). Whether stiffness is the cause or a vibration that must be followed,
// only a trial tells: the other method makes some steps from the same state, and takes over if it goes further in the
// same time. A trial that was lost is made again after twice as many steps, so that all of them cost a small part.
#include <algorithm>
#include <limits>
#include <utility>

#include "catena/analysis/dynamics/dynamics.hpp"

namespace catena {
namespace {

// A trial costs as much as some 700 explicit steps: beside twice as many after each that is lost, a part of the run
// that falls.
constexpr std::int64_t steps_between_looks = 500;
// Order 8 takes 30 steps in 1 / rate at a tolerance of 1e-12, the calibrated motions of tests/oracles among them.
constexpr double many = 200;
constexpr int steps_of_a_trial = 12, explicit_steps_of_a_trial = 100;
// Time of an implicit step in explicit ones: three stages, some four corrections, two factorizations: measured as 20 to
// 60 from one body to forty.
constexpr double cost_of_implicit = 60;

}  // namespace

// Of an integrator of this method that starts here: the time that its last steps took on average; 0: it does not get
// on.
double Dynamics::try_method(IntegrationMethod method, int steps, double limit) {
  const IntegrationMethod present = std::exchange(methods_.present, method);
  std::vector<double> turned(q_.size(), 0.0);
  evaluator_.add_turns(turned);
  const std::vector<CurvePlace> places = evaluator_.curve_places();
  const std::unique_ptr<Integrator> trial = make_integrator(*under_way_.motion, run_.grid.last());
  trial->remember(under_way_.integrator->memory());
  double length = 0;
  if (trial->start(t_, under_way_.integrator->state())) {
    double from = t_;
    int made = 0;
    while (made < steps && trial->time() < limit && trial->advance(limit)) {
      // The first half begins with short steps.
      if (++made == steps / 2) from = trial->time();
    }
    if (made == steps) length = (trial->time() - from) / (steps - steps / 2);
    if (made < steps && trial->time() >= limit) length = (trial->time() - t_) / made;
  }
  methods_.present = present;
  evaluator_.forget_turns();
  evaluator_.take_turns(turned);
  evaluator_.go_to_curve_places(places);
  return length;
}

void Dynamics::begin_with(IntegrationMethod method) {
  if (!stiffness_.wanted) return;
  const bool implicit = method == IntegrationMethod::radau, is_implicit = methods_.present == IntegrationMethod::radau;
  if (implicit == is_implicit) return;
  if (implicit) stiffness_.explicit_method = methods_.present;
  methods_.present = implicit ? method : stiffness_.explicit_method;
}

// Not where a motion pauses, whose memory holds no method.
void Dynamics::begin_looking_for_stiffness() {
  const std::int64_t steps = evaluator_.counters.steps;
  stiffness_ = {
      .wanted = stiffness_.wanted,
      .may_change = stiffness_.wanted && !origin_.resumed && pause_after_ == std::numeric_limits<double>::infinity(),
      .step = steps,
      .next = steps + steps_between_looks,
      .wait = steps_between_looks,
      .t = t_,
      .explicit_method = stiffness_.explicit_method};
  methods_.used = {methods_.present};
}

bool Dynamics::look_for_stiffness(double limit) {
  const std::int64_t steps = evaluator_.counters.steps;
  if (!stiffness_.may_change || steps < stiffness_.next || t_ >= limit || !under_way_.integrator->may_pause())
    return true;
  const double length = (t_ - stiffness_.t) / static_cast<double>(std::max<std::int64_t>(steps - stiffness_.step, 1));
  stiffness_.step = steps;
  stiffness_.t = t_;
  stiffness_.next = steps + stiffness_.wait;
  const bool implicit = methods_.present == IntegrationMethod::radau;
  if (!implicit && many * length * under_way_.integrator->rate() >= 1) return true;
  const IntegrationMethod other = implicit ? stiffness_.explicit_method : IntegrationMethod::radau;
  const double gained = try_method(other, implicit ? explicit_steps_of_a_trial : steps_of_a_trial, limit);
  stiffness_.step = evaluator_.counters.steps;
  const bool better = implicit ? gained * cost_of_implicit > length : gained > cost_of_implicit * length;
  stiffness_.wait = better ? steps_between_looks : 2 * stiffness_.wait;
  stiffness_.next = stiffness_.step + stiffness_.wait;
  if (better) {
    stiffness_.explicit_method = methods_.present == IntegrationMethod::radau ? other : methods_.present;
    methods_.present = other;
    if (std::find(methods_.used.begin(), methods_.used.end(), methods_.present) == methods_.used.end())
      methods_.used.push_back(methods_.present);
  }
  // A trial leaves the equations where it ended.
  std::unique_ptr<Integrator> next = better ? make_integrator(*under_way_.motion, run_.grid.last()) : nullptr;
  if (!next) return under_way_.motion->derivative(t_, Side::before, under_way_.integrator->state(), row_.slope);
  next->remember(under_way_.integrator->memory());
  const bool started = next->start(t_, under_way_.integrator->state());
  if (started) under_way_.integrator = std::move(next);
  return started;
}

}  // namespace catena
