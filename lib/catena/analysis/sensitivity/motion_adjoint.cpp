#include "catena/analysis/sensitivity/motion_adjoint.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "catena/base/at.hpp"

namespace catena {
namespace {

// Most rounds of Newton's method that bring the end of a short step onto the constraints: it is as near to them as the
// tolerance of the motion.
constexpr int most_projections = 4;

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
  for (int s = 0; s <= dormand_prince_8().stages; ++s) {
    Stage& stage = *stages_.emplace_back(std::make_unique<Stage>(evaluator(), 2 * n_));
    const Report masses = stage.equations.use_masses();
    if (!masses.ok()) fail(masses.message);
    if (!stage.equations.masses().massless.empty()) fail("the adjoint of the motion is not built for massless bodies");
  }
  for (Group& group : groups())
    reached_.push_back(std::make_unique<AdjointMechanism::Reached>(mechanism_, group.mechanism));
  w_.assign(n_, 0.0);
  mu_.assign(at(plan().rows), 0.0);
  zero_rows_ = mu_;
  masses_.assign(n_, 0.0);
  for (int c = 0; c < 3 * plan().moving; ++c) {
    if (plan().column[at(c)] >= 0) masses_[at(c)] = groups().front().mechanism.mass(c).v;
  }
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

bool MotionAdjoint::recompute(const Step& step, double h) {
  const Tableau& table = dormand_prince_8();
  for (int s = 0; s < table.stages; ++s) {
    Stage& stage = *stages_[at(s)];
    std::copy(step.begin.begin(), step.begin.end(), stage.y.begin());
    for (const StageTerm& term : table.a[at(s)]) {
      const double weight = h * term.weight;
      const Vector& k = stages_[at(term.stage)]->slope;
      for (std::size_t i = 0; i < stage.y.size(); ++i) stage.y[i] += weight * k[i];
    }
    const bool at_end = table.c[at(s)] == 1;
    stage.t = step.from + table.c[at(s)] * h;
    stage.side = at_end ? Side::before : Side::after;
    const std::span<const double> y(stage.y);
    const std::span<double> qdd = std::span(stage.slope).subspan(n_);
    if (!stage.equations.accelerations(stage.t, stage.side, y.first(n_), y.subspan(n_), qdd) ||
        stage.equations.is_dependent())
      return lose(stage.t, "constraints depend on each other");
    std::copy_n(y.begin() + static_cast<std::ptrdiff_t>(n_), n_, stage.slope.begin());
    std::copy(stage.equations.multipliers().begin(), stage.equations.multipliers().end(), stage.lambda.begin());
  }
  return true;
}

void MotionAdjoint::add_parameters(double t, Side side, const AdjointWeights& weights, std::span<const double> qdd) {
  std::size_t first = 0;
  for (std::size_t g = 0; g < groups().size(); ++g) {
    Group& group = groups()[g];
    group.mechanism.set_time(t, side);
    const auto part = mechanism_.by_parameters(group.mechanism, *reached_[g], weights, qdd);
    for (std::size_t p = 0; p < at(group.count); ++p) gradient_[first + p] += part[p];
    first += at(group.count);
  }
}

// Velocities are projected after positions: back in the other order.
bool MotionAdjoint::project_back(double t, Side side, std::span<const double> values, Vector& y1) {
  if (plan().rows == 0) return true;
  Stage& end = *stages_.back();
  const std::span<double> q = std::span(y1).first(n_), qd = std::span(y1).subspan(n_);
  if (!end.equations.factorize(t, side, values.first(n_)) || end.equations.is_dependent())
    return lose(t, "constraints depend on each other");
  mechanism_.set_motion(end.evaluator, values.subspan(n_), {});
  for (const bool velocity : {true, false}) {
    const std::span<double> part = velocity ? qd : q;
    end.equations.solve_motion(part, zero_rows_, w_, mu_);
    for (std::size_t c = 0; c < n_; ++c) part[c] = masses_[c] > 0 ? masses_[c] * w_[c] : 0;
    AdjointWeights weights;
    (velocity ? weights.rate : weights.phi) = mu_;
    if (velocity) mechanism_.add_by_state(end.evaluator, weights, q, qd);
    add_parameters(t, side, weights, {});
  }
  return true;
}

bool MotionAdjoint::stage_back(Stage& stage, const Vector& k) {
  const std::span<const double> k_q = std::span(k).first(n_), k_qd = std::span(k).subspan(n_);
  stage.equations.solve_motion(k_qd, zero_rows_, w_, mu_);
  const std::span<const double> y(stage.y), qdd = std::span<const double>(stage.slope).subspan(n_);
  mechanism_.set_motion(stage.evaluator, y.subspan(n_), qdd);
  std::fill(stage.back.begin(), stage.back.end(), 0.0);
  const std::span<double> back_q = std::span(stage.back).first(n_), back_qd = std::span(stage.back).subspan(n_);
  std::copy(k_q.begin(), k_q.end(), back_qd.begin());
  const AdjointWeights weights{.w = w_, .lambda = stage.lambda, .bend = mu_};
  mechanism_.add_by_state(stage.evaluator, weights, back_q, back_qd);
  // Coordinates that are no unknowns stay where they are.
  for (std::size_t c = 0; c < n_; ++c) {
    if (c >= plan().column.size() || plan().column[c] < 0) back_q[c] = back_qd[c] = 0;
  }
  add_parameters(stage.t, stage.side, weights, qdd);
  return true;
}

bool MotionAdjoint::go_back(const Step& step, double t, std::span<const double> values, Vector y1, Vector& y0) {
  const Tableau& table = dormand_prince_8();
  const double h = t - step.from;
  if (!project_back(t, t == step.to ? Side::before : Side::after, values, y1)) return false;
  Vector k(2 * n_);
  for (int s = table.stages; s-- > 0;) {
    std::fill(k.begin(), k.end(), 0.0);
    const auto add = [&](double weight, const Vector& from) {
      for (std::size_t i = 0; i < k.size(); ++i) k[i] += h * weight * from[i];
    };
    for (const StageTerm& term : table.b) {
      if (term.stage == s) add(term.weight, y1);
    }
    for (int j = s + 1; j < table.stages; ++j) {
      for (const StageTerm& term : table.a[at(j)]) {
        if (term.stage == s) add(term.weight, stages_[at(j)]->back);
      }
    }
    if (!stage_back(*stages_[at(s)], k)) return false;
  }
  for (std::size_t i = 0; i < y0.size(); ++i) {
    y0[i] += y1[i];
    for (int s = 0; s < table.stages; ++s) y0[i] += stages_[at(s)]->back[i];
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

MotionAdjoint::Vector MotionAdjoint::state_inside(const Step& step, double t) {
  Vector y = step.begin;
  if (!recompute(step, t - step.from)) return y;
  for (const StageTerm& term : dormand_prince_8().b) {
    const Vector& k = stages_[at(term.stage)]->slope;
    for (std::size_t i = 0; i < y.size(); ++i) y[i] += (t - step.from) * term.weight * k[i];
  }
  EquationsOfMotion& equations = stages_.back()->equations;
  if (!equations.factorize(t, Side::after, std::span(y).first(n_))) return y;
  equations.project_position(std::span(y).first(n_), most_projections);
  equations.project_velocity(std::span(y).subspan(n_), 1 / (step.to - step.from));
  return y;
}

bool MotionAdjoint::add_start(const Vector& y0) {
  const Step& first = steps_.front();
  evaluator().set_time(first.from);
  StartDerivatives start(evaluator(), given_start_);
  std::size_t p0 = 0;
  std::vector<DesignScalar> y(2 * n_);
  for (Group& group : groups()) {
    const std::span<DesignScalar> q = std::span(y).first(n_), qd = std::span(y).subspan(n_);
    group.mechanism.lift_configuration(std::span(first.begin).first(n_), q);
    for (std::size_t c = 0; c < n_; ++c) qd[c] = first.begin[n_ + c];
    if (!start.find(group.mechanism, group.count, q, qd))
      return fail("the start of the motion has no derivative: " + start.why());
    for (std::size_t i = 0; i < y.size(); ++i) {
      for (std::size_t p = 0; p < at(group.count); ++p) gradient_[p0 + p] += y0[i] * y[i].d[p];
    }
    p0 += at(group.count);
  }
  return true;
}

std::optional<std::vector<double>> MotionAdjoint::gradient(std::vector<MotionPulse> pulses) {
  if (!why().empty()) return {};
  if (steps_.empty()) {
    fail("the motion was not looked at");
    return {};
  }
  gradient_.assign(at(parameters()), 0.0);
  std::sort(pulses.begin(), pulses.end(), [](const auto& a, const auto& b) { return a.t < b.t; });
  if (!pulses.empty() && (pulses.front().t < steps_.front().from || pulses.back().t > steps_.back().to)) {
    lose(pulses.front().t < steps_.front().from ? pulses.front().t : pulses.back().t, "there is no motion");
    return {};
  }
  const auto add = [&](const MotionPulse& pulse, Vector& y) {
    for (std::size_t c = 0; c < pulse.by_q.size(); ++c) y[c] += pulse.by_q[c];
    for (std::size_t c = 0; c < pulse.by_qd.size(); ++c) y[n_ + c] += pulse.by_qd[c];
  };
  Vector y1(2 * n_, 0.0), y0(2 * n_, 0.0);
  at_once_ = 1;
  single_misfit_ = 0;
  blocks_ = 0;
  waits_ = 1;  // the last step by itself tells what is usual
  joins_ = true;
  Step joined;
  for (std::size_t k = steps_.size(); k > 0;) {
    const Step& last = steps_[k - 1];
    std::fill(y0.begin(), y0.end(), 0.0);
    for (; !pulses.empty() && pulses.back().t >= last.to; pulses.pop_back()) add(pulses.back(), y1);
    const std::size_t own = k - 1;
    for (; !pulses.empty() && pulses.back().t > last.from; pulses.pop_back()) {
      Vector inside(2 * n_, 0.0);
      add(pulses.back(), inside);
      const Vector there = state_inside(last, pulses.back().t);
      if (!why().empty() || !go_back(last, pulses.back().t, there, std::move(inside), y0)) return {};
    }
    // No further than to the instant of the next pulse, nor over a step that had one inside.
    const bool had_inside = std::any_of(y0.begin(), y0.end(), [](double y) { return y != 0; });
    const std::size_t count = join(k,
                                   had_inside       ? last.from
                                   : pulses.empty() ? steps_.front().from
                                                    : pulses.back().t,
                                   joined);
    if (count == 0 || !go_back(joined, joined.to, joined.end, y1, y0)) return {};
    ++blocks_;
    k = own + 1 - count;
    std::swap(y0, y1);
  }
  for (const MotionPulse& pulse : pulses) add(pulse, y1);
  if (!add_start(y1)) return {};
  return gradient_;
}

}  // namespace catena
