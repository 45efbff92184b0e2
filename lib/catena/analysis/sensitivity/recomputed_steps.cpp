#include "catena/analysis/sensitivity/recomputed_steps.hpp"

#include <algorithm>
#include <cmath>

#include "catena/base/at.hpp"

namespace catena {
namespace {

// Steps are joined while the end is missed by no more than so many times what they miss it by one after the other.
// Where two miss it by a thousand times that, the motion's own steps are as long as the method allows, and none are
// joined any more; so often at the start of a motion, where the first steps of multistep methods are tiny.
constexpr double more_misfit = 2, far_more_misfit = 1e3;
constexpr int far_tries_at_start = 3, far_tries = 1;
// After one step too many, so many blocks pass before the next is tried.
constexpr int blocks_between_tries = 8;
// States before and after an instant that differ by less are one: whole turns are 6.
constexpr double same_state = 1e-6;
// Below this misfits are rounding.
constexpr double rounding = 1e-14;

void add_weighted(std::vector<double>& y, double weight, const std::vector<double>& k) {
  for (std::size_t i = 0; i < y.size(); ++i) y[i] += weight * k[i];
}

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

RecomputedSteps::Stage::Stage(const Evaluator& of, std::size_t size) : evaluator(of), equations(evaluator) {
  y.assign(size, 0.0);
  slope.assign(size, 0.0);
  lambda.assign(at(of.plan().rows), 0.0);
}

RecomputedSteps::RecomputedSteps(const Evaluator& evaluator)
    : evaluator_(evaluator), size_(2 * at(evaluator.plan().coordinates())) {
  for (int s = 0; s < dormand_prince_8().stages; ++s) stages_.push_back(make_stage());
}

std::unique_ptr<RecomputedSteps::Stage> RecomputedSteps::make_stage() {
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
    Stage& stage = *stages_[at(s)];
    std::copy(step.begin.begin(), step.begin.end(), stage.y.begin());
    for (const StageTerm& term : table.a[at(s)]) add_weighted(stage.y, h * term.weight, stages_[at(term.stage)]->slope);
    const bool at_end = table.c[at(s)] == 1;
    singular_at_ = at_end ? step.to : step.from + table.c[at(s)] * h;
    if (!evaluate(stage, singular_at_, at_end ? Side::before : Side::after)) return false;
  }
  return true;
}

bool RecomputedSteps::prepare_interpolant(const Step& step) {
  const Tableau& table = dormand_prince_8();
  const double h = step.to - step.from;
  while (stages_.size() < table.c.size()) stages_.push_back(make_stage());
  for (int s = table.stages; s < static_cast<int>(table.c.size()); ++s) {
    Stage& stage = *stages_[at(s)];
    const bool at_end = s == table.stages;
    std::copy_n((at_end ? step.end : step.begin).begin(), size_, stage.y.begin());
    for (const StageTerm& term : table.a[at(s)]) {
      if (!at_end) add_weighted(stage.y, h * term.weight, stages_[at(term.stage)]->slope);
    }
    singular_at_ = at_end ? step.to : step.from + table.c[at(s)] * h;
    if (!evaluate(stage, singular_at_, at_end ? Side::before : Side::after)) return false;
  }
  return true;
}

double RecomputedSteps::misfit(const Step& step) const {
  const double h = step.to - step.from;
  double off[2] = {0, 0}, way[2] = {0, 0};
  for (std::size_t i = 0; i < step.end.size(); ++i) {
    double moved = 0;
    for (const StageTerm& term : dormand_prince_8().b) moved += h * term.weight * stages_[at(term.stage)]->slope[i];
    const std::size_t kind = i >= size_ / 2;
    off[kind] = std::max(off[kind], std::abs(step.begin[i] + moved - step.end[i]));
    way[kind] = std::max(way[kind], std::abs(moved));
  }
  return std::max(way[0] > 0 ? off[0] / way[0] : 0, way[1] > 0 ? off[1] / way[1] : 0);
}

void RecomputedSteps::begin_anew() {
  at_once_ = 1;
  single_misfit_ = 0;
  waits_ = 1;
  far_ = 0;
}

// Not across an instant at which the state was replaced (angles moved by whole turns).
std::size_t RecomputedSteps::join(std::span<const Step> steps, From from, Step& joined) {
  const std::size_t given = steps.size();
  const auto part = [&](std::size_t count) { return from == From::front ? steps.first(count) : steps.last(count); };
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
      return std::abs(a - b) <= same_state * std::max({1.0, std::abs(a), std::abs(b)});
    });
  };
  const bool joins = far_ < (from == From::front ? far_tries_at_start : far_tries);
  const std::size_t wanted = joins ? std::min(most_at_once, at_once_ + (waits_ > 0 ? 0 : 1)) : 1;
  std::size_t count = 1;
  while (count < std::min(wanted, given) && follows(count + 1)) ++count;
  bool is_known = count == wanted;
  waits_ = std::max(waits_ - 1, 0);
  for (; count > 1; count -= std::max<std::size_t>(count / 4, 1)) {
    if (!take(count)) return 0;
    const double missed = misfit(joined), usual = single_misfit_ + rounding;
    if (missed <= more_misfit * usual) break;
    waits_ = blocks_between_tries;
    is_known = true;
    if (count == 2 && missed > far_more_misfit * usual) ++far_;
  }
  if (count == 1) {
    if (!take(1)) return 0;
    single_misfit_ = std::max(single_misfit_, misfit(joined));
  }
  // Where fewer were given than wanted nothing is learned about how many can be taken.
  if (is_known || count > at_once_) at_once_ = count;
  return count;
}

}  // namespace catena
