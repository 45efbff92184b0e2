#include "catena/analysis/sensitivity/motion_adjoint.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "catena/base/at.hpp"

namespace catena {
namespace {

// Steps are joined while the end is missed by no more than so many times what they miss it by one after the other;
// where two miss it by a thousand times that, the motion's own steps are as long as the method allows.
constexpr double more_misfit = 2, far_more_misfit = 1e3;
constexpr std::size_t most_at_once = 16;
// After one step too many, so many blocks pass before the next is tried.
constexpr int blocks_between_tries = 8;
// States before and after an instant that differ by less are one: whole turns are 6.
constexpr double same_state = 1e-6;
// Below this misfits are rounding.
constexpr double rounding = 1e-14;

void add_to(std::vector<double>& y, double weight, const std::vector<double>& k) {
  for (std::size_t i = 0; i < y.size(); ++i) y[i] += weight * k[i];
}

}  // namespace

MotionAdjoint::Stage::Stage(const Evaluator& of, std::size_t size) : evaluator(of), equations(evaluator) {
  for (Vector* v : {&y, &slope, &back}) v->assign(size, 0.0);
  lambda.assign(at(of.plan().rows), 0.0);
}

MotionAdjoint::~MotionAdjoint() = default;

MotionAdjoint::MotionAdjoint(const Evaluator& of, const DesignModels& models, int parameters, GivenByModel start)
    : StateDerivatives(of, models, parameters),
      n_(at(plan().coordinates())),
      given_start_(start),
      mechanism_(evaluator()) {
  if (const std::string why = AdjointMechanism::why_not(evaluator().model()); !why.empty()) {
    fail("the adjoint of the motion is not built where " + why);
    return;
  }
  for (int s = 0; s < dormand_prince_8().stages; ++s) stages_.push_back(make_stage());
  end_ = make_stage();
  for (Group& group : groups())
    reached_.push_back(std::make_unique<AdjointMechanism::Reached>(mechanism_, group.mechanism));
  w_.assign(n_, 0.0);
  mu_.assign(at(plan().rows), 0.0);
  zero_rows_ = mu_;
  zero_loads_ = w_;
  slope_.assign(2 * n_, 0.0);
  masses_.assign(n_, 0.0);
  for (int c = 0; c < 3 * plan().moving; ++c) {
    if (plan().column[at(c)] >= 0) masses_[at(c)] = groups().front().mechanism.mass(c).v;
  }
}

std::unique_ptr<MotionAdjoint::Stage> MotionAdjoint::make_stage() {
  auto stage = std::make_unique<Stage>(evaluator(), 2 * n_);
  const Report masses = stage->equations.use_masses();
  if (!masses.ok()) fail(masses.message);
  if (!stage->equations.masses().massless.empty()) fail("the adjoint of the motion is not built for massless bodies");
  return stage;
}

int MotionAdjoint::reached_elements() const {
  int sum = 0;
  for (const auto& reached : reached_) sum += reached->elements();
  return sum;
}

bool MotionAdjoint::lose(double t, std::string_view what) {
  return fail(fmt::format("at t = {:.9g} s {}, which the adjoint of the motion does not pass", t, what));
}

bool MotionAdjoint::find(const Snapshot&) { return false; }

void MotionAdjoint::cover(const MotionStretch& stretch) {
  if (!why().empty()) return;
  Step step{stretch.from, stretch.to, Vector(2 * n_), Vector(2 * n_)};
  for (const bool end : {false, true}) {
    const std::optional<Snapshot> state = stretch.at(end ? stretch.to : stretch.from);
    if (!state) {
      lose(end ? stretch.to : stretch.from, "the motion could not be looked at");
      return;
    }
    Vector& y = end ? step.end : step.begin;
    std::copy(state->q.begin(), state->q.end(), y.begin());
    std::copy(state->qd.begin(), state->qd.end(), y.begin() + static_cast<std::ptrdiff_t>(n_));
  }
  if (steps_.empty() && instant_at(stretch.from).moves()) {
    lose(stretch.from, "the motion begins at a jump of a function of time that moves");
    return;
  }
  const MovingInstant& instant = instant_at(stretch.to);
  if (instant.order == 1 || instant.moves()) {
    lose(stretch.to, "a function of time jumps");
    return;
  }
  steps_.push_back(std::move(step));
}

bool MotionAdjoint::evaluate(Stage& stage, double t, Side side) {
  stage.t = t;
  stage.side = side;
  const std::span<const double> y(stage.y);
  const std::span<double> qdd = std::span(stage.slope).subspan(n_);
  if (!stage.equations.accelerations(t, side, y.first(n_), y.subspan(n_), qdd) || stage.equations.is_dependent())
    return lose(t, "constraints depend on each other");
  std::copy_n(y.begin() + static_cast<std::ptrdiff_t>(n_), n_, stage.slope.begin());
  std::copy(stage.equations.multipliers().begin(), stage.equations.multipliers().end(), stage.lambda.begin());
  return true;
}

bool MotionAdjoint::recompute(const Step& step, double h) {
  const Tableau& table = dormand_prince_8();
  for (int s = 0; s < table.stages; ++s) {
    Stage& stage = *stages_[at(s)];
    std::copy(step.begin.begin(), step.begin.end(), stage.y.begin());
    for (const StageTerm& term : table.a[at(s)]) add_to(stage.y, h * term.weight, stages_[at(term.stage)]->slope);
    const bool at_end = table.c[at(s)] == 1;
    if (!evaluate(stage, step.from + table.c[at(s)] * h, at_end ? Side::before : Side::after)) return false;
  }
  return true;
}

bool MotionAdjoint::prepare_interpolant(const Step& step) {
  const Tableau& table = dormand_prince_8();
  const double h = step.to - step.from;
  while (stages_.size() < table.c.size()) stages_.push_back(make_stage());
  for (int s = table.stages; s < static_cast<int>(table.c.size()); ++s) {
    Stage& stage = *stages_[at(s)];
    const bool at_end = s == table.stages;
    std::copy_n((at_end ? step.end : step.begin).begin(), 2 * n_, stage.y.begin());
    for (const StageTerm& term : table.a[at(s)]) {
      if (!at_end) add_to(stage.y, h * term.weight, stages_[at(term.stage)]->slope);
    }
    const double t = at_end ? step.to : step.from + table.c[at(s)] * h;
    if (!evaluate(stage, t, at_end ? Side::before : Side::after)) return false;
  }
  return true;
}

double MotionAdjoint::misfit(const Step& step) const {
  const double h = step.to - step.from;
  double off[2] = {0, 0}, way[2] = {0, 0};
  for (std::size_t i = 0; i < step.end.size(); ++i) {
    double moved = 0;
    for (const StageTerm& term : dormand_prince_8().b) moved += h * term.weight * stages_[at(term.stage)]->slope[i];
    const std::size_t kind = i >= n_;
    off[kind] = std::max(off[kind], std::abs(step.begin[i] + moved - step.end[i]));
    way[kind] = std::max(way[kind], std::abs(moved));
  }
  return std::max(way[0] > 0 ? off[0] / way[0] : 0, way[1] > 0 ? off[1] / way[1] : 0);
}

// Not across an instant at which the state was replaced (angles moved by whole turns), nor one that a pulse needs.
std::size_t MotionAdjoint::join(std::size_t end, double bound, Step& joined) {
  const auto take = [&](std::size_t count) {
    joined = steps_[end - count];
    joined.to = steps_[end - 1].to;
    joined.end = steps_[end - 1].end;
    return recompute(joined, joined.to - joined.from);
  };
  const auto follows = [&](std::size_t count) {
    const Step& first = steps_[end - count];
    return first.from >= bound &&
           std::equal(first.end.begin(), first.end.end(), steps_[end - count + 1].begin.begin(),
                      [](double a, double b) {
                        return std::abs(a - b) <= same_state * std::max({1.0, std::abs(a), std::abs(b)});
                      });
  };
  const std::size_t wanted = joins_ ? std::min(most_at_once, at_once_ + (waits_ > 0 ? 0 : 1)) : 1;
  std::size_t count = 1;
  while (count < std::min(wanted, end) && follows(count + 1)) ++count;
  waits_ = std::max(waits_ - 1, 0);
  for (; count > 1; count -= std::max<std::size_t>(count / 4, 1)) {
    if (!take(count)) return 0;
    const double missed = misfit(joined), usual = single_misfit_ + rounding;
    if (missed <= more_misfit * usual) break;
    waits_ = blocks_between_tries;
    if (count == 2 && missed > far_more_misfit * usual) joins_ = false;
  }
  if (count == 1) {
    if (!take(1)) return 0;
    single_misfit_ = std::max(single_misfit_, misfit(joined));
  }
  at_once_ = count;
  return count;
}

}  // namespace catena
