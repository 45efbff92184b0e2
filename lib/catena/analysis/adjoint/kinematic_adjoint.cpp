#include "catena/analysis/adjoint/kinematic_adjoint.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "catena/base/at.hpp"

namespace catena {

KinematicAdjoint::KinematicAdjoint(const Evaluator& evaluator, const DesignModels& models, int parameters)
    : StateDerivatives(evaluator, models, parameters),
      system_(evaluator.shared_plan(), SaddleBlock::none),
      mechanism_(this->evaluator()) {
  for (Group& group : groups())
    reached_.push_back(std::make_unique<AdjointMechanism::Reached>(mechanism_, group.mechanism));
  zero_rows_.assign(at(plan().rows), 0.0);
  zero_loads_.assign(at(plan().coordinates()), 0.0);
}

bool KinematicAdjoint::singular_at(double t) {
  return fail(fmt::format("at t = {:.9g} s the mechanism is in a singular configuration, which has no derivative", t));
}

bool KinematicAdjoint::factorize(const Snapshot& snapshot, const Evaluator& there) {
  if (instant_at(snapshot.t).moves())
    return fail(fmt::format("at t = {:.9g} s a function of time jumps at an instant that moves with the parameters",
                            snapshot.t));
  if (!system_.factorize(jacobian(there), [] {})) return singular_at(snapshot.t);
  mechanism_.set_motion(there, snapshot.qd, snapshot.qdd);
  return true;
}

bool KinematicAdjoint::find(const Snapshot& snapshot) {
  evaluator().set_time(snapshot.t);
  evaluator().set_configuration(snapshot.q);
  if (!factorize(snapshot, evaluator())) return false;
  // Of all: columns read functions of time as well.
  for (Group& group : groups()) group.mechanism.set_time(snapshot.t);
  return true;
}

bool KinematicAdjoint::add_gradient(const Snapshot& snapshot, std::span<const double> by_q, std::span<double> out) {
  // Places ask for no more than the snapshot's own evaluator shows.
  if (!factorize(snapshot, snapshot.evaluator)) return false;
  // Which parameters contradict them is seen by carrying derivatives forward alone.
  if (!system_.dependent_rows().empty()) return fail("constraints depend on each other");
  const std::span<double> load = loads_scratch();
  std::copy(by_q.begin(), by_q.end(), load.begin());
  mu0_ = zero_rows_;
  if (!system_.solve(load, mu0_)) return singular_at(snapshot.t);
  std::size_t first = 0;
  for (std::size_t g = 0; g < groups().size(); ++g) {
    Group& group = groups()[g];
    if (reached_[g]->asks_mechanism()) group.mechanism.set_time(snapshot.t);
    const auto part = mechanism_.by_parameters(group.mechanism, *reached_[g], {.phi = mu0_}, {});
    for (std::size_t p = 0; p < at(group.count); ++p) out[first + p] += part[p];
    first += at(group.count);
  }
  return true;
}

bool KinematicAdjoint::solve(const Snapshot& snapshot, StateSlopes& by) {
  w_ = zero_loads_;
  mu2_ = zero_rows_;
  // What is asked of rows goes in as mu2 and comes out as w; see SaddleSystem::solve().
  if (!by.by_lambda.empty()) {
    std::copy(by.by_lambda.begin(), by.by_lambda.end(), mu2_.begin());
    if (!system_.solve(w_, mu2_)) return false;
  }
  const bool reacts = !by.by_lambda.empty(), accelerates = reacts || !by.by_qdd.empty();
  mu2_ = zero_rows_;
  if (accelerates) {
    std::vector<double> load = by.by_qdd.empty() ? zero_loads_ : by.by_qdd;
    for (int c = 0; reacts && c < 3 * plan().moving; ++c)
      load[at(c)] -= groups().front().mechanism.mass(c).v * w_[at(c)];
    if (!system_.solve(load, mu2_)) return false;
    AdjointWeights weights{.bend = mu2_};
    if (reacts) {
      weights.w = w_;
      weights.lambda = snapshot.lambda;
    }
    mechanism_.add_by_state(evaluator(), weights, by.by_q, by.by_qd);
  }
  mu1_ = mu0_ = zero_rows_;
  if (!snapshot.qd.empty()) {
    if (!system_.solve(by.by_qd, mu1_)) return false;
    mechanism_.add_by_state(evaluator(), AdjointWeights{.rate = mu1_}, by.by_q, by.by_qd);
  }
  return system_.solve(by.by_q, mu0_);
}

bool KinematicAdjoint::derive(const ColumnSet& columns, const Snapshot& snapshot, std::span<double> out,
                              std::span<double> change) {
  std::fill(change.begin(), change.end(), 0.0);
  std::fill(out.begin(), out.end(), std::numeric_limits<double>::quiet_NaN());
  if (columns.needs().work)
    return fail("work and dissipated energy, which are summed up over time, have no derivative");
  if (!find(snapshot)) return false;
  // Which parameters contradict them is seen by carrying derivatives forward alone.
  if (!system_.dependent_rows().empty()) return fail("constraints depend on each other");
  if (columns_ != &columns) {
    slopes_ = std::make_unique<ColumnSlopes>(evaluator().model(), columns, mechanisms(), parameters());
    columns_ = &columns;
  }
  slopes_->look(snapshot);
  const auto all = at(parameters());
  for (std::size_t k = 0; k < columns.size(); ++k) {
    StateSlopes by = slopes_->empty();
    slopes_->add(k, 1, by);
    if (!slopes_->reads_multipliers(k)) by.by_lambda.clear();
    if (!solve(snapshot, by)) return singular_at(snapshot.t);
    AdjointWeights weights{.phi = mu0_, .rate = mu1_, .bend = mu2_};
    if (!by.by_lambda.empty()) {
      weights.w = w_;
      weights.lambda = snapshot.lambda;
    }
    for (std::size_t g = 0, first = 0; g < groups().size(); first += parameters_at_once, ++g) {
      const auto part = mechanism_.by_parameters(groups()[g].mechanism, *reached_[g], weights, snapshot.qdd);
      for (std::size_t p = 0; p < at(groups()[g].count); ++p) out[k * all + first + p] = by.by_p[first + p] + part[p];
    }
  }
  return true;
}

}  // namespace catena
