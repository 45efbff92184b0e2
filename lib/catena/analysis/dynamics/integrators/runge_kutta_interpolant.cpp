// RungeKutta::interpolate: the state between the last two, from the stages of the step or from its ends.
#include <algorithm>
#include <iterator>
#include <limits>
#include <utility>

#include "catena/analysis/dynamics/integrators/runge_kutta.hpp"

namespace catena {
namespace {

// Between the ends of a step across a singular position its stages may say much less than the step itself: tolerances
// of a step below which rounding alone leaves too much, 1e-10 of the motion and more; and the position residual, in
// these tolerances (fifty are a tenth of the run's), that what is interpolated may have otherwise.
constexpr double fine_tolerance = 2e-11, interpolated_residual = 50;

}  // namespace

// Evaluates the three stages that the interpolant of order 8 needs besides those of the step. False: a stage cannot be
// evaluated.
bool RungeKutta::prepare_interpolant() {
  const Tableau& table = dormand_prince_8();
  const double h = t_ - t_before_;
  stage_[12] = slope_;
  for (std::size_t s = 13; s < 16; ++s) {
    stage_.combine(table.a[s], h, y_before_, y_stage_);
    const double t = t_before_ + table.c[s] * h;
    const auto evaluate = [&](bool projected) {
      return (!projected || project_stage(t, Side::after)) && motion_.derivative(t, Side::after, y_stage_, stage_[s]);
    };
    if (!evaluate(trials_.project_stages())) return false;
    // The step's own stages may have kept clear of a singular position that lies near this one: what such a stage says
    // may be wrong by any amount, and rows between are found as in a step across that position.
    ratios_.note_between(motion_.equations().smallest_pivot_ratio());
    if (trials_.project_stages() || !dips()) continue;
    if (!meets_constraints()) return false;
    trials_.begin_projecting();
    if (!evaluate(true)) return false;
  }
  dense_.set(ends(), stage_);
  return true;
}

// Projects and balances the end of a cut step like that of a whole one.
bool RungeKutta::finish_cut() {
  EquationsOfMotion& equations = motion_.equations();
  if (!equations.factorize(t_new_, Side::after, motion_.q(std::span<const double>(y_new_)))) return false;
  equations.project_position(motion_.q(std::span(y_new_)), 4);
  equations.project_velocity(motion_.qd(std::span(y_new_)), scale_.rate());
  return balance(t_new_ - t_);
}

// A step across a singular position, cut at t: from its start or from its end, whichever has stages further from that
// position. False: neither can be made, or both end too near to it. Both are projected, as the step was, behind which
// other methods have gone back to their own ways.
bool RungeKutta::integrate_to(double t, std::span<double> y) {
  bool found = false;
  const bool crossing = std::exchange(crossing_, true);
  double least = std::numeric_limits<double>::infinity();
  const auto try_from_present_end = [&] {
    t_new_ = t;
    if (!evaluate_stages(t - t_) || !(ratios_.roughness() < least)) return;
    // Rounding of a cut step that no balance of energy corrects, in tolerances: one that ends beside the singular
    // position makes more of it than the interpolant across.
    if (!watches_energy() && rounding_of_crossing(t - t_) > 1) return;
    if (!finish_cut()) return;
    found = true;
    least = ratios_.roughness();
    std::copy(y_new_.begin(), y_new_.end(), y.begin());
  };
  const auto exchange_ends = [&] {
    y_.swap(y_before_);
    std::swap(t_, t_before_);
  };
  exchange_ends();
  try_from_present_end();
  exchange_ends();
  stage_[0].swap(slope_);
  try_from_present_end();
  stage_[0].swap(slope_);
  crossing_ = crossing;
  return found;
}

void RungeKutta::interpolate(double t, std::span<double> y) {
  const bool fine = scale_.step_tolerance < fine_tolerance;
  // Cut steps overwrite the step's own stages, and stages between may tell of a singular position.
  get_interpolant_ready();
  if (trials_.project_stages() && fine && integrate_to(t, y)) return;
  evaluate_interpolant(t, y);
  if (trials_.project_stages() && !fine) {
    EquationsOfMotion& equations = motion_.equations();
    equations.evaluator().set_time(t);
    if (!(equations.position_residual(motion_.q(std::span<const double>(y))) <
          interpolated_residual * scale_.step_tolerance)) {
      integrate_to(t, y);
    }
  }
  if (work_told_) balance_between(t, y);
}

// What drivers have done by then, from the energy of the mechanism on its constraints.
void RungeKutta::balance_between(double t, std::span<double> y) {
  EquationsOfMotion& equations = motion_.equations();
  if (!equations.factorize(t, Side::after, motion_.q(std::span<const double>(y)))) return;
  equations.project_position(motion_.q(y), 4);
  equations.project_velocity(motion_.qd(y), scale_.rate());
  energy_.restore_work(motion_, balanced_ends(t, t - t_before_, y_before_, y));
}

void RungeKutta::get_interpolant_ready() {
  if (dense_.needs_stages() && !prepare_interpolant()) dense_.use_ends(true);
}

void RungeKutta::evaluate_interpolant(double t, std::span<double> y) {
  const double s = (t - t_before_) / (t_ - t_before_);
  get_interpolant_ready();
  if (!dense_.by_ends()) return dense_.evaluate(y_before_, s, y);
  move_by_ends(ends(), motion_.coordinates(), s, scale_, y);
  if (motion_.works() > 0) work_by_ends(s, y);
}

// The integrals by Gauss's rule of three points (order 6) along that motion: powers have no derivatives from which a
// polynomial could be as good. Cubics where a power cannot be evaluated.
void RungeKutta::work_by_ends(double s, std::span<double> y) {
  constexpr double places[] = {0.11270166537925831, 0.5, 0.88729833462074169};
  constexpr double weights[] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
  const std::size_t first = 2 * motion_.coordinates();
  const double h = t_ - t_before_, r = 1 - s;
  std::copy(y_before_.begin(), y_before_.end(), y_stage_.begin());
  std::vector<double>& power = stage_[1];
  bool known = true;
  for (std::size_t i = first; i < y.size(); ++i) y[i] = y_before_[i];
  for (std::size_t k = 0; k < std::size(places) && known; ++k) {
    move_by_ends(ends(), motion_.coordinates(), places[k] * s, scale_, y_stage_);
    known = derivative(t_before_ + places[k] * s * h, Side::after, y_stage_, power);
    for (std::size_t i = first; i < y.size(); ++i) y[i] += weights[k] * s * h * power[i];
  }
  for (std::size_t i = first; i < y.size() && !known; ++i) {
    const double y0 = y_before_[i], y1 = y_[i], d0 = h * stage_[0][i], d1 = h * slope_[i];
    y[i] = y0 + s * (y1 - y0 + r * ((1 - 2 * s) * (y0 - y1) + r * d0 - s * d1));
  }
}

}  // namespace catena
