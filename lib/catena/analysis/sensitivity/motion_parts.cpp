// Steps of the motion that are too long for derivatives, in parts: of MotionDerivatives, and of MotionAdjoint back.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "catena/analysis/motion/stage_sums.hpp"
#include "catena/analysis/sensitivity/motion_adjoint.hpp"
#include "catena/analysis/sensitivity/motion_derivatives.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

double largest_of(std::span<const double> y) {
  double largest = 0;
  for (const double x : y) largest = std::max(largest, std::abs(x));
  return largest;
}

}  // namespace

double MotionDerivatives::excess() {
  if (!aim_.divides()) return 0;
  const double h = step_.to - step_.from;
  double error = 0;
  if (by_tangents_) {
    error = tangents_->error(h, rows_.begin, rows_.end, aim_);
  } else {
    for (std::size_t k = 0; k < tracks_.size(); ++k) {
      const Track& track = tracks_[k];
      error = std::max(error, error_of_derivatives(h, track.begin, track.end, track.stage, aim_, k));
    }
  }
  return error / aim_.allowed();
}

// As if the step had not been taken.
void MotionDerivatives::undo_step() {
  for (Track& track : tracks_) track.end = track.begin;
}

bool MotionDerivatives::take_in_parts(const Step& step, double missed) {
  parts_.clear();
  ++divided_;
  return divide(step, missed);
}

bool MotionDerivatives::divide(const Step& whole, double missed) {
  const int count = parts_for(missed);
  const double h = whole.to - whole.from;
  if (!is_long_enough(h / count, whole.from)) {
    return fail(fmt::format(
        "at t = {:.9g} s derivatives change too fast, beside a motion that does not, for steps of any length",
        whole.from));
  }
  Step part = whole;
  for (int k = 1; k <= count; ++k) {
    part.to = k == count ? whole.to : whole.from + h * k / count;
    part.end = k == count ? whole.end : RecomputedSteps::Vector{};
    if (!take_part(part)) return false;
    const Step taken = step_;
    if (const double again = excess(); again > 1) {
      undo_step();
      if (!divide(taken, again)) return false;
    } else {
      parts_.push_back({taken, {}});
      for (const Track& track : tracks_) parts_.back().begin.push_back(track.begin);
    }
    part.from = taken.to;
    part.begin = taken.end;
  }
  return true;
}

bool MotionDerivatives::take_part(const Step& part) {
  begin_block(part.from, part.begin);
  step_ = part;
  watched_.recomputed = true;
  by_tangents_ = tangents_ && again_->recompute(step_);
  if (by_tangents_) {
    if (step_.end.empty()) step_.end = again_->end_of(step_);
    by_tangents_ = take_by_tangents();
  }
  if (!by_tangents_ && !take_in_dual_numbers()) return false;
  const Step taken = step_;
  note_block(std::span(&taken, 1));
  return true;
}

bool MotionDerivatives::return_to_part(double t) {
  std::size_t k = parts_.size() - 1;
  while (k > 0 && parts_[k].step.from > t) --k;
  for (std::size_t g = 0; g < tracks_.size(); ++g) tracks_[g].end = parts_[k].begin[g];
  while (!pending_.empty() && is_part(pending_.front())) pending_.erase(pending_.begin());
  std::vector<Step> rest;
  for (std::size_t later = k + 1; later < parts_.size(); ++later) rest.push_back(parts_[later].step);
  pending_.insert(pending_.begin(), rest.begin(), rest.end());
  return take_part(parts_[k].step);
}

bool MotionAdjoint::is_due(double h) const { return aim_.divides() && (bends_ || checks_.is_due(h, begun())); }

std::size_t MotionAdjoint::begun() const {
  return at(static_cast<int>(std::count_if(ways_.begin(), ways_.end(), [](const Way& way) { return way.begun; })));
}

double MotionAdjoint::error_back(double h, const StageSum& error, const Way& way) {
  const auto terms = stage_weights_back(false, error);
  const auto vector_of = [&](int j) { return (j == step_end ? way.y1 : back_[at(j)]).data(); };
  Vector sum(2 * n_, 0.0);
  for (int s = dormand_prince_8().stages; s-- > 0;) {
    add_stages({}, h, terms[at(s)], vector_of, slope_);
    stage_back(s, slope_, nullptr);
    add_times(sum, 1, back_[at(s)]);
  }
  double worst = 0;
  for (const std::size_t first : {std::size_t{0}, n_}) {
    const auto part = [&](const Vector& y) { return largest_of(std::span(y).subspan(first, n_)); };
    const double size = std::max(part(way.y0), part(way.y1));
    if (size > 0) worst = std::max(worst, part(sum) / size);
  }
  return worst;
}

double MotionAdjoint::excess(const Step& step, const Way& way) {
  const double h = step.to - step.from;
  const double high = error_back(h, dormand_prince_8().error, way);
  if (high <= aim_.allowed()) return high / aim_.allowed();  // no less than what both are together
  return error_of_step(high, error_back(h, dormand_prince_8().error_low, way)) / aim_.allowed();
}

// States where parts begin are those of the recomputed motion.
bool MotionAdjoint::divide(std::size_t& k, int parts) {
  const Step whole = steps_[k - 1];
  const double h = (whole.to - whole.from) / parts;
  if (!is_long_enough(h, whole.from)) return lose(whole.from, "the adjoint changes too fast for steps of any length,");
  std::vector<Step> some;
  Step part = whole;
  for (int number = 1; number < parts; ++number) {
    part.to = whole.from + h * number;
    if (!again_.recompute(part)) return lose(again_.singular_at(), "constraints depend on each other");
    part.end = again_.end_of(part);
    some.push_back(part);
    part.from = part.to;
    part.begin = part.end;
  }
  part.to = whole.to;
  part.end = whole.end;
  some.push_back(part);
  replace_by_parts(steps_, crossings_, k, some);
  return true;
}

}  // namespace catena
