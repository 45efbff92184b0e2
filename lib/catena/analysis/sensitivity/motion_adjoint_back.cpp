// MotionAdjoint: the way back.
#include <algorithm>
#include <limits>

#include "catena/analysis/motion/stage_sums.hpp"
#include "catena/analysis/sensitivity/motion_adjoint.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

bool any(const std::vector<double>& y) {
  return std::any_of(y.begin(), y.end(), [](double x) { return x != 0; });
}

}  // namespace

void MotionAdjoint::add_parameters(double t, Side side, const AdjointWeights& weights, std::span<const double> qdd,
                                   Way& way) {
  std::size_t first = 0;
  for (std::size_t g = 0; g < groups().size(); ++g) {
    Group& group = groups()[g];
    if (reached_[g]->asks_mechanism()) group.mechanism.set_time(t, side);
    const auto part = mechanism_.by_parameters(group.mechanism, *reached_[g], weights, qdd);
    for (std::size_t p = 0; p < at(group.count); ++p) way.gradient[first + p] += part[p];
    first += at(group.count);
  }
}

MotionAdjoint::Stage& MotionAdjoint::end_stage() {
  if (end_) return *end_;
  end_ = again_.make_stage();
  end_->t = std::numeric_limits<double>::quiet_NaN();  // it has no factors yet
  return *end_;
}

bool MotionAdjoint::factorize_end(double t, Side side, std::span<const double> values) {
  if (plan().rows == 0) return true;
  // The first stage of the block before, which lies after this one, may be at the same state.
  if (end_->t == t && std::equal(values.begin(), values.end(), end_->y.begin())) return true;
  end_->t = t;
  std::copy(values.begin(), values.end(), end_->y.begin());
  if (end_->equations.factorize(t, side, values.first(n_)) && !end_->equations.is_dependent()) return true;
  end_->t = std::numeric_limits<double>::quiet_NaN();
  return lose(t, "constraints depend on each other");
}

// Velocities are projected after positions: back in the other order.
void MotionAdjoint::project_back(double t, Side side, std::span<const double> values, Way& way, Vector& y1) {
  if (plan().rows == 0) return;
  const std::span<double> q = std::span(y1).first(n_), qd = std::span(y1).subspan(n_);
  mechanism_.set_motion(end_->evaluator, values.subspan(n_), {}, side);
  for (const bool velocity : {true, false}) {
    const std::span<double> part = velocity ? qd : q;
    end_->equations.solve_motion(part, zero_rows_, w_, mu_);
    for (std::size_t c = 0; c < n_; ++c) part[c] = masses_[c] > 0 ? masses_[c] * w_[c] : 0;
    AdjointWeights weights;
    (velocity ? weights.rate : weights.phi) = mu_;
    if (velocity) mechanism_.add_by_state(end_->evaluator, weights, q, qd);
    add_parameters(t, side, weights, {}, way);
  }
}

void MotionAdjoint::stage_back(int number, const Vector& k, Way* way) {
  Stage& stage = again_.stage(number);
  Vector& back = back_[at(number)];
  const std::span<const double> k_q = std::span(k).first(n_), k_qd = std::span(k).subspan(n_);
  stage.equations.solve_motion(k_qd, zero_rows_, w_, mu_);
  const std::span<const double> y(stage.y), qdd = std::span<const double>(stage.slope).subspan(n_);
  mechanism_.set_motion(stage.evaluator, y.subspan(n_), qdd, stage.side);
  std::fill(back.begin(), back.end(), 0.0);
  const std::span<double> back_q = std::span(back).first(n_), back_qd = std::span(back).subspan(n_);
  std::copy(k_q.begin(), k_q.end(), back_qd.begin());
  const AdjointWeights weights{.w = w_, .lambda = stage.lambda, .bend = mu_};
  mechanism_.add_by_state(stage.evaluator, weights, back_q, back_qd);
  // Coordinates that are no unknowns stay where they are.
  for (std::size_t c = 0; c < n_; ++c) {
    if (c >= plan().column.size() || plan().column[c] < 0) back_q[c] = back_qd[c] = 0;
  }
  if (way) add_parameters(stage.t, stage.side, weights, qdd, *way);
}

void MotionAdjoint::go_back(const Step& step, Way& way, bool interpolated) {
  const Tableau& table = dormand_prince_8();
  const double h = step.to - step.from;
  static const auto of_step = stage_weights_back(false), of_interpolant = stage_weights_back(true);
  const auto& terms = interpolated ? of_interpolant : of_step;
  const int stages = interpolated ? static_cast<int>(table.c.size()) : table.stages;
  for (int s = stages; s-- > 0;) {
    // Stage 12 is the step's end: all before it are reached through the projection there.
    if (s == table.stages - 1) project_back(step.to, Side::before, step.end, way, way.y1);
    const auto vector_of = [&](int j) { return (j == step_end ? way.y1 : back_[at(j)]).data(); };
    const std::span<const double> begin =
        interpolated ? std::span<const double>(way.slopes[at(s)]) : std::span<const double>();
    add_stages(begin, h, terms[at(s)], vector_of, slope_);
    stage_back(s, slope_, &way);
    if (s == table.stages) add_times(way.y1, 1, back_[at(s)]);
  }
  for (int s = 0; s < stages; ++s) {
    if (s != table.stages) add_times(way.y0, 1, back_[at(s)]);
  }
  add_times(way.y0, 1, way.y1);
}

bool MotionAdjoint::add_start(const Vector& y0, Vector& gradient) {
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
    if (!start.lack().empty()) lack_derivatives(start.lack());
    for (std::size_t i = 0; i < y.size(); ++i) {
      for (std::size_t p = 0; p < at(group.count); ++p) gradient[p0 + p] += y0[i] * y[i].d[p];
    }
    p0 += at(group.count);
  }
  return true;
}

std::optional<std::vector<double>> MotionAdjoint::gradient(std::vector<MotionPulse> pulses) {
  std::optional<Gradients> all = gradients({std::move(pulses)});
  if (!all) return {};
  return std::move(all->front());
}

// Goes back over a block of the first k steps, the last ones, to the instant of the next pulse at most; k: the number
// of those that are left.
bool MotionAdjoint::go_back_over_block(std::size_t& k, std::span<const Look>& looks, Step& joined) {
  const Step& last = steps_[k - 1];
  const double next = looks.empty() ? steps_.front().from : looks.back().pulse->t;
  // A step that has a pulse inside is taken by itself.
  const bool inside = !looks.empty() && next > last.from;
  const double bound = inside ? last.from : next;
  std::size_t given = 1;
  while (given < std::min(k, RecomputedSteps::most_at_once) && steps_[k - given - 1].from >= bound &&
         !crossings_.contains(k - given))
    ++given;
  const auto singular = [&] { return lose(again_.singular_at(), "constraints depend on each other"); };
  const std::size_t count =
      again_.join(std::span<const Step>(steps_).subspan(k - given, given), RecomputedSteps::From::back, joined);
  if (count == 0) return singular();
  static_cast<void>(end_stage());  // after the first stage, which has been evaluated now
  const double h = joined.to - joined.from;
  // Measures may begin inside.
  const bool may_check = is_due(h) || (aim_.divides() && inside && begun() < ways_.size());
  const std::vector<Way> ways = may_check ? ways_ : std::vector<Way>();
  const std::span<const Look> looks_before = looks;
  for (Way& way : ways_) {
    std::fill(way.y0.begin(), way.y0.end(), 0.0);
    if (inside) way.slopes.assign(dormand_prince_8().c.size(), Vector(2 * n_, 0.0));
  }
  if (inside && !again_.prepare_interpolant(joined)) return singular();
  while (!looks.empty() && looks.back().pulse->t > joined.from) {
    if (!add_inside(joined, take_last(looks))) return false;
  }
  if (!factorize_end(joined.to, Side::before, joined.end)) return false;
  const bool checks = is_due(h);
  double missed = 0;
  for (Way& way : ways_) {
    if (!way.begun) continue;
    go_back(joined, way, inside);
    if (checks) missed = std::max(missed, excess(joined, way));
    std::swap(way.y0, way.y1);
  }
  if (missed > 1) {
    ways_ = ways;
    looks = looks_before;
    checks_.ask();
    if (count > 1)
      again_.join_less(h / parts_for(missed));
    else if (!divide(k, parts_for(missed)))
      return false;
    return go_back_over_block(k, looks, joined);
  }
  if (checks)
    checks_.note(h, begun(), missed);
  else
    checks_.note_unchecked();
  again_.exchange_first(end_);
  ++blocks_;
  k -= count;
  return true;
}

bool MotionAdjoint::go_back_to_end(std::size_t k, std::span<const Look>& looks) {
  const Step& last = steps_[k - 1];
  const auto found = crossings_.find(k);
  const MotionCrossing* crossing = found == crossings_.end() ? nullptr : &found->second;
  const bool ends = k == steps_.size(), moves = crossing && crossing->moves();
  const auto looks_there = [&](const Look& look) { return look.pulse->t >= last.to && !look.pulse->by_q.empty(); };
  if (crossing && ends && (moves || (!looks.empty() && looks_there(looks.back()))))
    return lose(last.to, "the motion ends where it goes on in another way");
  if (moves && std::any_of(looks.begin(), looks.end(), looks_there))
    return lose(last.to, "a measure looks at an instant at which the motion goes on in another way");
  const std::span<const double> values = crossing && !ends ? steps_[k].begin : last.end;
  const auto end_of_way = [this](std::size_t m) -> Vector& { return end_of(m); };
  while (!looks.empty() && looks.back().pulse->t >= last.to) {
    if (!add_pulses(take_last(looks), last.to, Side::after, values, end_of_way)) return false;
  }
  return !crossing || ends || cross_back(*crossing, last);
}

std::optional<MotionAdjoint::Gradients> MotionAdjoint::gradients(
    const std::vector<std::vector<MotionPulse>>& measures) {
  if (!why().empty()) return {};
  if (steps_.empty()) {
    fail("the motion was not looked at");
    return {};
  }
  const std::optional<std::vector<Look>> all_looks = looks_at(measures);
  if (!all_looks) return {};
  std::span<const Look> looks = *all_looks;
  const Way still{.y1 = Vector(2 * n_, 0.0), .y0 = Vector(2 * n_, 0.0), .gradient = Vector(at(parameters()), 0.0)};
  ways_.assign(measures.size(), still);
  again_.begin_anew();
  if (end_) end_->t = std::numeric_limits<double>::quiet_NaN();
  blocks_ = 0;
  checks_ = {};
  Step joined;
  for (std::size_t k = steps_.size(); k > 0;) {
    if (!go_back_to_end(k, looks)) return {};
    if (!go_back_over_block(k, looks, joined)) return {};
  }
  const Step& first = steps_.front();
  const auto end_of_way = [this](std::size_t m) -> Vector& { return end_of(m); };
  if (!looks.empty() && !add_pulses(looks, first.from, Side::after, first.begin, end_of_way)) return {};
  Gradients gradients;
  for (Way& way : ways_) {
    if (any(way.y1) && !add_start(way.y1, way.gradient)) return {};
    gradients.push_back(std::move(way.gradient));
  }
  return gradients;
}

}  // namespace catena
