#include "catena/analysis/sensitivity/recomputed_steps.hpp"

#include <algorithm>
#include <cmath>

#include "catena/analysis/motion/stage_sums.hpp"
#include "catena/analysis/motion/step_growth.hpp"
#include "catena/analysis/run/thresholds.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// Steps are joined while the end is missed by no more than so many times what they miss it by one after the other. At 8
// a tenth of the blocks would be saved, and gradients of a double pendulum be off by up to 4e-8 from those of its own
// steps, at a tolerance of 1e-7; at 2 by 1e-9.
// Where two miss it by a thousand times that, the motion's own steps are as long as the method allows, and none are
// joined any more; so often at the start of a motion, where the first steps of multistep methods are tiny.
constexpr double more_misfit = 2, far_more_misfit = 1e3;
constexpr int far_tries_at_start = 3, far_tries = 1;
// After steps that were too long together, so many blocks pass before longer ones are tried.
constexpr int blocks_between_tries = 8;
// What a block misses its end by grows with its length to the power of order + 1. The next one is as long as that
// allows, less a tenth, and changes by no more than what these powers are worth far from it.
constexpr double most_longer = 1.5, least_shorter = 0.3;

}  // namespace

InterpolantWeights interpolant_weights(double part) {
  const Tableau& table = dormand_prince_8();
  const double s = part, r = 1 - part, first = s, second = s * r, third = s * s * r;
  const double higher[] = {third * r, third * r * s, third * r * s * r, third * r * s * r * s};
  InterpolantWeights weights;
  weights.end = first - second + 2 * third;
  weights.slope[0] += second - third;
  weights.slope[12] -= third;
  for (std::size_t k = 0; k < table.interpolant.size(); ++k) {
    for (const StageTerm& term : table.interpolant[k]) weights.slope[at(term.stage)] += higher[k] * term.weight;
  }
  return weights;
}

std::array<std::vector<StageTerm>, 16> stage_weights_back(bool interpolated, const StageSum& end) {
  const Tableau& table = dormand_prince_8();
  std::array<std::vector<StageTerm>, 16> back;
  for (const StageTerm& term : end) back[at(term.stage)].push_back({step_end, term.weight});
  for (int j = 0; j < (interpolated ? step_end : table.stages); ++j) {
    if (j == table.stages) continue;
    for (const StageTerm& term : table.a[at(j)]) back[at(term.stage)].push_back({j, term.weight});
  }
  return back;
}

RecomputedSteps::Stage::Stage(const Evaluator& of, std::size_t size) : evaluator(of, work), equations(evaluator) {
  y.assign(size, 0.0);
  slope.assign(size, 0.0);
  lambda.assign(at(of.plan().rows), 0.0);
}

RecomputedSteps::Stage::Stage(const Evaluator& of, const Stage& like)
    : evaluator(of, work), equations(evaluator, like.equations), y(like.y), slope(like.slope), lambda(like.lambda) {}

RecomputedSteps::RecomputedSteps(const Evaluator& evaluator)
    : evaluator_(evaluator), size_(2 * at(evaluator.plan().coordinates())) {
  stages_.push_back(make_stage());
}

// The first stage finds the structure of the equations for all that are made after it was evaluated.
std::unique_ptr<RecomputedSteps::Stage> RecomputedSteps::make_stage() {
  if (!stages_.empty()) return std::make_unique<Stage>(evaluator_, *stages_.front());
  auto stage = std::make_unique<Stage>(evaluator_, size_);
  const Report masses = stage->equations.use_masses();
  if (!masses.ok())
    why_not_ = masses.message;
  else if (!stage->equations.masses().massless.empty())
    why_not_ = "there are massless bodies";
  return stage;
}

bool RecomputedSteps::evaluate(Stage& stage, double t, Side side) {
  stage.t = t;
  stage.side = side;
  const std::size_t n = stage.y.size() / 2;
  const std::span<const double> y(stage.y);
  if (!stage.equations.accelerations(t, side, y.first(n), y.subspan(n), std::span(stage.slope).subspan(n)) ||
      stage.equations.is_dependent())
    return false;
  std::copy_n(y.begin() + static_cast<std::ptrdiff_t>(n), n, stage.slope.begin());
  std::copy(stage.equations.multipliers().begin(), stage.equations.multipliers().end(), stage.lambda.begin());
  return true;
}

bool RecomputedSteps::recompute(const Step& step) {
  const Tableau& table = dormand_prince_8();
  const double h = step.to - step.from;
  for (int s = 0; s < table.stages; ++s) {
    if (stages_.size() == at(s)) stages_.push_back(make_stage());
    Stage& stage = *stages_[at(s)];
    add_stages(
        step.begin, h, table.a[at(s)], [this](int k) { return stages_[at(k)]->slope.data(); }, stage.y);
    const bool at_end = table.c[at(s)] == 1;
    singular_at_ = at_end ? step.to : step.from + table.c[at(s)] * h;
    if (!evaluate(stage, singular_at_, at_end ? Side::before : Side::after)) return false;
  }
  return true;
}

RecomputedSteps::Vector RecomputedSteps::end_of(const Step& step) const {
  Vector end(size_);
  add_stages(
      step.begin, step.to - step.from, dormand_prince_8().b, [this](int k) { return stages_[at(k)]->slope.data(); },
      end);
  return end;
}

bool RecomputedSteps::prepare_interpolant(const Step& step) {
  const Tableau& table = dormand_prince_8();
  const double h = step.to - step.from;
  while (stages_.size() < table.c.size()) stages_.push_back(make_stage());
  Stage& end = *stages_[at(table.stages)];
  end.y = step.end;
  singular_at_ = step.to;
  if (!evaluate(end, step.to, Side::before)) return false;
  for (int s = table.stages + 1; s < static_cast<int>(table.c.size()); ++s) {
    Stage& stage = *stages_[at(s)];
    add_stages(
        step.begin, h, table.a[at(s)], [this](int k) { return stages_[at(k)]->slope.data(); }, stage.y);
    singular_at_ = step.from + table.c[at(s)] * h;
    if (!evaluate(stage, singular_at_, Side::after)) return false;
  }
  return true;
}

double RecomputedSteps::misfit(const Step& step) {
  moved_.resize(size_);
  add_stages(
      {}, step.to - step.from, dormand_prince_8().b, [this](int k) { return stages_[at(k)]->slope.data(); }, moved_);
  double off[2] = {0, 0}, way[2] = {0, 0};
  for (const std::size_t kind : {0, 1}) {
    for (std::size_t i = kind * size_ / 2; i < (kind + 1) * size_ / 2; ++i) {
      off[kind] = std::max(off[kind], std::abs(step.begin[i] + moved_[i] - step.end[i]));
      way[kind] = std::max(way[kind], std::abs(moved_[i]));
    }
  }
  return std::max(way[0] > 0 ? off[0] / way[0] : 0, way[1] > 0 ? off[1] / way[1] : 0);
}

void RecomputedSteps::begin_anew() {
  reach_ = 0;
  single_misfit_ = 0;
  waits_ = 1;
  far_ = 0;
}

void RecomputedSteps::join_less(double length) {
  reach_ = std::min(reach_, length);
  waits_ = blocks_between_tries;
}

std::optional<RecomputedSteps::Step> RecomputedSteps::step_of(const MotionStretch& stretch, const Vector* before,
                                                              double& at) {
  Step step{stretch.from, stretch.to, {}, {}};
  const auto look = [&](double t, Vector& y) {
    const std::optional<Snapshot> state = stretch.at(at = t);
    if (!state) return false;
    y.reserve(2 * state->q.size());
    y.assign(state->q.begin(), state->q.end());
    y.insert(y.end(), state->qd.begin(), state->qd.end());
    return true;
  };
  if (before)
    step.begin = *before;
  else if (!look(stretch.from, step.begin))
    return {};
  if (!look(stretch.to, step.end)) return {};
  return step;
}

// Not across an instant at which the state was replaced (angles moved by whole turns).
std::size_t RecomputedSteps::join(std::span<const Step> steps, From from, Step& joined) {
  const std::size_t given = steps.size();
  const auto part = [&](std::size_t count) { return from == From::front ? steps.first(count) : steps.last(count); };
  const auto length = [&](std::size_t count) { return part(count).back().to - part(count).front().from; };
  const auto take = [&](std::size_t count) {
    const std::span<const Step> some = part(count);
    joined = some.front();
    joined.to = some.back().to;
    joined.end = some.back().end;
    return recompute(joined);
  };
  const auto follows = [&](std::size_t count) {
    const std::size_t k = from == From::front ? count - 2 : given - count;
    return std::equal(steps[k].end.begin(), steps[k].end.end(), steps[k + 1].begin.begin(), [](double a, double b) {
      return std::abs(a - b) <= thresholds::same_value * std::max({1.0, std::abs(a), std::abs(b)});
    });
  };
  const bool joins = far_ < (from == From::front ? far_tries_at_start : far_tries);
  const std::size_t most = joins ? std::min(most_at_once, given) : 1;
  std::size_t count = 1;
  while (count < most && length(count + 1) <= reach_ && follows(count + 1)) ++count;
  waits_ = std::max(waits_ - 1, 0);
  for (; count > 1;) {
    if (!take(count)) return 0;
    const double missed = misfit(joined), allowed = more_misfit * (single_misfit_ + thresholds::sum_rounding),
                 h = length(count);
    const double change = step_safety * std::pow(allowed / std::max(missed, thresholds::sum_rounding),
                                                 1.0 / (dormand_prince_8().order + 1));
    if (missed <= allowed) {
      // Where fewer were given than could be taken nothing is learned about how many can.
      // Of what is missed a part is the motion's own: at least one step more is tried.
      const double more = 1 + 1.01 / static_cast<double>(count);
      if (waits_ == 0) reach_ = std::max(reach_, h * std::clamp(change, std::min(more, most_longer), most_longer));
      return count;
    }
    if (count == 2 && missed > far_more_misfit * (single_misfit_ + thresholds::sum_rounding)) ++far_;
    waits_ = blocks_between_tries;
    reach_ = h * std::max(change, least_shorter);
    while (count > 1 && length(count) > reach_) --count;
  }
  if (!take(1)) return 0;
  single_misfit_ = std::max(single_misfit_, misfit(joined));
  if (waits_ == 0) reach_ = std::max(reach_, (1 + most_longer) * length(1));
  return 1;
}

}  // namespace catena
