// RungeKutta::advance: the size of steps, and the measures near singular positions.
#include <algorithm>
#include <cmath>
#include <optional>

#include "catena/analysis/dynamics/integrators/runge_kutta.hpp"
#include "catena/linalg/rank/dependence.hpp"

namespace catena {
namespace {

// A passage may lie within a step of which a pivot ratio is this small, compared with those at both ends, or of which
// one end is, compared with the other.
constexpr double dip_inside = 0.35, dip_at_end = 0.02;
// The size that is tried after a step one of whose places cannot be evaluated, and the error that one counts as whose
// error is not a number.
constexpr double cut_of_failure = 0.25, error_of_failure = 1e10;

}  // namespace

void RungeKutta::reject(double h) {
  ++motion_.equations().evaluator().counters.rejected;
  h_ = h;
  order_.reject();
}

// After a step of size h that reached a place which cannot be evaluated.
RungeKutta::Trial RungeKutta::cut_short(double h) {
  culprit_ = -1;
  if (is_fixed()) return Trial::failed;
  reject(cut_of_failure * h);
  return Trial::again;
}

// Repeats a step of size h that failed near a singular position. False: no other size succeeds, h_ is unchanged.
bool RungeKutta::try_crossing(double h, const Judgement& judged) {
  if (!trials_.project_stages()) {
    trials_.begin_projecting();
    h_ = h;
    return true;
  }
  const std::optional<double> other = trials_.next(h, judged.error, judged.rounding, ratios());
  if (!other) return false;
  if (!trials_.takes_best()) ++motion_.equations().evaluator().counters.rejected;
  h_ = *other;
  return true;
}

// Whether the step passes beside a singular position.
bool RungeKutta::passes_beside() const {
  const double end = pivot_ratio(), least = std::min(ratios_.at_start(), end), most = std::max(ratios_.at_start(), end);
  return std::min(ratios_.smallest(), least) < dependence::near_passage &&
         (ratios_.smallest() < dip_inside * least || least < dip_at_end * most);
}

// Whether the step of size h has ended on another branch and is to be repeated with shorter ones. The passage is where
// the sines, roots of the pivot ratios, would be zero if they changed in proportion to time.
bool RungeKutta::leaves_branch(double h) {
  if (!passes_beside()) return false;
  EquationsOfMotion& equations = motion_.equations();
  const double end = pivot_ratio();
  const bool near = std::min({ratios_.smallest(), ratios_.at_start(), end}) < dependence::singular_passage;
  if (!branches_) {
    if (near && equations.plan().rows > 0) turn_.pass_unjudged(t_new_);
    return false;
  }
  const double before = std::sqrt(ratios_.at_start()), s = before / (before + std::sqrt(end));
  const std::span<const double> y(y_), next(y_new_);
  const std::span<const double> q0 = motion_.q(y), v0 = motion_.qd(y), q1 = motion_.q(next), v1 = motion_.qd(next);
  y_stage_.assign(y_.size(), 0.0);
  const std::span<double> middle = motion_.q(std::span(y_stage_));
  for (std::size_t k = 0; k < middle.size(); ++k) {
    const double r = 1 - s;
    middle[k] = r * r * ((1 + 2 * s) * q0[k] + s * h * v0[k]) + s * s * ((3 - 2 * s) * q1[k] - r * h * v1[k]);
  }
  Evaluator& evaluator = equations.evaluator();
  const std::vector<CurvePlace> places = evaluator.curve_places();
  const BranchKeeping::Course course = branches_->course(equations, q0, q1, middle);
  evaluator.go_to_curve_places(places);
  evaluator.set_configuration(q1);
  if (course == BranchKeeping::Course::left_within_rounding) turn_.go_straight_on(t_new_, branches_->gap());
  if (course == BranchKeeping::Course::crossed) turn_.cross(t_new_);
  if (course == BranchKeeping::Course::unjudged && near) turn_.pass_unjudged(t_new_);
  return course == BranchKeeping::Course::left;
}

bool RungeKutta::advance(double limit) {
  double usual = is_fixed() ? options_.fixed_step : h_;  // s; a step that a limit shortens leaves it as it is
  if (!begin_step()) return false;
  h_ = usual;
  Trial outcome = Trial::again;
  while (outcome == Trial::again) outcome = try_step(limit, usual);
  return outcome == Trial::made;
}

bool RungeKutta::begin_step() {
  const bool nears = ratios_.at_start() < dependence::near_passage;
  trials_.begin();
  order_.begin(nears && !is_fixed());
  // A choice of coordinates made at a singular position serves nowhere.
  if (!projects() && nears && !begin_projection()) return false;
  if (!follow_motion()) return false;
  std::copy(slope_.begin(), slope_.end(), stage_[0].begin());
  motion_.equations().evaluator().take_turns(motion_.q(std::span(y_)));
  dense_.forget();
  return true;
}

RungeKutta::Length RungeKutta::next_length(double limit) const {
  const double remaining = limit - t_;
  Length length{h_, h_ * (is_fixed() ? 1 + 1e-9 : 1.01) >= remaining};
  if (length.lands) {
    length.h = remaining;
  } else if (!is_fixed() && !trials_.made_detours() && 2 * h_ > remaining) {
    // Two equal steps instead of a long one and a tiny one.
    length.h = remaining / 2;
  }
  return length;
}

// One trial of a step; a next one has the size h_.
RungeKutta::Trial RungeKutta::try_step(double limit, double& usual) {
  motion_.equations().evaluator().go_to_curve_places(curve_places_);
  if (turn_.gives_up(t_new_)) {
    h_ = usual = turn_.step_that_left();
    order_.forget_rejections();
  }
  const auto [h, lands] = next_length(limit);
  if ((h < scale_.smallest_step(t_) && !lands) || order_.gives_up()) return Trial::failed;
  t_new_ = lands ? limit : t_ + h;
  motion_.switches().begin_step(t_);
  if (!evaluate_stages(h)) return cut_short(h);
  switches_ = motion_.switches().found();
  if (!projects() && ratios_.smallest() < dependence::near_passage)
    return begin_projection() ? Trial::again : Trial::failed;
  const Judgement judged = judge(h);
  // Errors of stages across the constraints affect each other in a dip, and the estimate does not contain all of it.
  const bool doubtful = !is_fixed() && !trials_.project_stages();
  if ((!judged.accurate || doubtful) && projects() && dips() && try_crossing(h, judged)) return Trial::again;
  if (!judged.accurate) {
    // Where a force bends within the step errors fall with its square at best.
    const double growth = switches_.any() ? step_growth(judged.error, 2) : judged.growth;
    reject(h * std::min(growth, 1.0));
    return Trial::again;
  }
  error_.of_step = std::max(judged.error, 1.0);
  if (!judged.factored && !factorize_new_point()) return cut_short(h);
  if (trials_.ends_too_near(pivot_ratio()) && !turn_.is_under_way() && !lands && !is_fixed() && projects()) {
    if (const std::optional<double> other = trials_.detour(h, judged.error, ratios())) {
      ++motion_.equations().evaluator().counters.rejected;
      h_ = *other;
      return Trial::again;
    }
    trials_.end_near();
  }
  if (!finish_step()) return cut_short(h);
  if (projects() && !turn_.is_given_up() && leaves_branch(h)) {
    if (!is_fixed()) {
      turn_.begin(h, branches_->gap());
      reject(BranchTurn::shortened * h);
      return Trial::again;
    }
    turn_.go_straight_on(t_new_, branches_->gap());
  }
  accept(judged.growth, std::max(usual, h));
  return Trial::made;
}

// The step of size h by its errors; near a singular position its end may be factored for that.
RungeKutta::Judgement RungeKutta::judge(double h) {
  Judgement judged;
  double error = is_fixed() ? 0 : error_size(h);
  if (!(error <= 1) && std::isfinite(error)) error = compared_with_end(h, error);
  if (!(error <= 1) && std::isfinite(error) && projects()) {
    judged.factored = factorize_new_point();
    if (judged.factored) error = filtered_error(h, error);
  }
  if (!is_fixed() && motion_.works() > 0) error = std::max(error, error_of_work(h));
  if (!std::isfinite(error)) error = error_of_failure;
  judged.error = error;
  judged.growth = order_.growth(error);
  if (trials_.project_stages() && !is_fixed() && dips()) judged.rounding = rounding_of_crossing(h);
  judged.accurate = std::max(error, trials_.takes_best() ? 0 : judged.rounding) <= trials_.accepted_error();
  return judged;
}

void RungeKutta::accept(double growth, double proposed) {
  const double h = t_new_ - t_;
  ++motion_.equations().evaluator().counters.steps;
  dense_.use_ends(tableau().order == 5);
  order_.accept();
  if (crossing_) {
    ++projected_steps_;
    crossing_ = pivot_ratio() < dependence::clear_of_passage;
    if (partitions()) partition_->forget();
  }
  t_before_ = t_;
  t_ = t_new_;
  y_before_.swap(y_);
  y_.swap(y_new_);
  slope_.swap(slope_new_);
  curve_places_ = motion_.equations().evaluator().curve_places();
  observe_ratio();
  observe_rates();
  if (ratios_.at_start() > dependence::clear_of_passage) turn_.end();
  // A step that was shortened by a limit does not change the usual step.
  h_ = order_.was_rejected() ? h * std::min(growth, 1.0) : std::max(h * growth, h < proposed ? proposed : 0.0);
}

}  // namespace catena
