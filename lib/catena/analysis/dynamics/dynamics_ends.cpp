// Dynamics where a curve or a table of an element ends, or a rope leaves a pulley: the run ends at that instant, with
// the rows before it.
#include <algorithm>
#include <cmath>

#include "catena/analysis/dynamics/dynamics.hpp"

namespace catena {
namespace {

// Places within a step that are checked, its end among them: a point that leaves a curve and returns within a quarter
// of a step moves faster than the step's error allows.
constexpr int samples = 4;
// Bodies that are driven turn far in one step: between two places no further than this, rad; ropes are followed over
// 0.3 (equations_ropes.cpp).
constexpr double most_turn = 0.25;

}  // namespace

// Curves and tables of elements, and of laws of state, at the evaluator's configuration, which is that of y.
Report Dynamics::check_ends_at(std::span<const double> y) const {
  Report report = watched_.check();
  return report.ok() && watched_.has_law_ends() ? watched_.check_laws(y.subspan(q_.size(), q_.size())) : report;
}

// Checks the last step, which began at `from`.
Report Dynamics::check_curve_ends(double from, RowObserver& observer) {
  const auto left_at = [&](double t) {
    if (t == under_way_.integrator->time()) {
      std::copy(under_way_.integrator->state().begin(), under_way_.integrator->state().end(), row_.y.begin());
    } else {
      under_way_.integrator->interpolate(t, row_.y);
    }
    evaluator_.set_time(t);
    evaluator_.set_configuration(std::span<const double>(row_.y).first(q_.size()));
    return !check_ends_at(row_.y).ok();
  };
  int places = samples;
  const std::span<const double> qd = under_way_.integrator->state().subspan(q_.size(), q_.size());
  double turn = 0;
  for (std::size_t k = 2; k < qd.size(); k += 3) turn = std::max(turn, std::abs(qd[k]) * (t_ - from));
  places = std::max(places, static_cast<int>(std::ceil(std::min(turn, 1e4) / most_turn)));
  double inside = from, outside = from;
  for (int k = 1; k <= places && outside == from; ++k) {
    const double t = k == places ? t_ : from + (t_ - from) * k / places;
    (left_at(t) ? outside : inside) = t;
  }
  if (outside == from) return {};
  for (double middle = inside + (outside - inside) / 2; middle != inside && middle != outside;
       middle = inside + (outside - inside) / 2) {
    (left_at(middle) ? outside : inside) = middle;
  }
  t_ = inside;
  if (attached_.events) {
    if (const Report found = find_events(from, observer); !found.ok() || run_.stopped_by >= 0) return found;
  }
  while (run_.next_row < run_.grid.size() && run_.grid[run_.next_row] <= inside) {
    if (const Report given = give_row(run_.grid[run_.next_row++], observer); !given.ok()) return given;
  }
  left_at(outside);
  return check_ends_at(row_.y);
}

}  // namespace catena
