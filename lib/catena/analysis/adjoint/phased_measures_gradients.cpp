// PhasedMeasures: the way back as a whole, and its end at the start of the motion.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "catena/analysis/adjoint/phased_measures.hpp"
#include "catena/analysis/run/thresholds.hpp"
#include "catena/base/at.hpp"

namespace catena {

// Whether the rows of the first phase hold whatever the parameters are is seen by the derivatives of the start.
bool PhasedMeasures::add_start() {
  const Step& first = steps_.front();
  hold(phases_.front());
  const Point point = point_of(first.from, Side::after, first.begin);
  if (!transpose_->factorize(point)) return singular_at(first.from);
  for (Way& way : ways_) release_anchors(point, way);
  EvaluationWork work;
  Evaluator open(open_plan_, *contacts_.model, work);
  open.go_to_curve_places(first.places);
  open.set_time(first.from);
  open.set_configuration(point.q);
  StartDerivatives start(open, given_start_);
  std::vector<char> always;
  for (const int element : plan().row_element) always.push_back(open_plan_->element_row[at(element)] >= 0);
  for (std::size_t g = 0; g < groups().size(); ++g) {
    Group& group = groups()[g];
    DesignMechanism mechanism(open, models_[g]);
    DesignVector q(n_), qd(n_), anchor(at(plan().rows));
    mechanism.lift_configuration(point.q, q);
    lift(point.qd, qd);
    if (!start.find(mechanism, group.count, q, qd))
      return fail("the start of the motion has no derivative: " + start.why());
    group.mechanism.go_to_curve_places(first.places);
    group.mechanism.set_time(first.from);
    group.mechanism.set_state(q, qd);
    group.mechanism.rows(group.rows);
    for (std::size_t k = 0; k < contacts_.points.size(); ++k) {
      if (equations_->sticks(k)) anchor[at(equations_->slide_row(k))].d = group.rows[at(equations_->slide_row(k))].f.d;
    }
    for (std::size_t p = 0; p < at(group.count); ++p) {
      const std::size_t number = g * at(parameters_at_once) + p;
      const double size = number < sizes_.size() && sizes_[number] != 0 ? std::abs(sizes_[number]) : 1;
      const double none = thresholds::solved * std::max(evaluator().length_scale(), 1.0) / size;
      const int row = equations_->row_not_met(group.rows, anchor, q, qd, p, none, always);
      if (row >= 0) {
        const int element = plan().row_element[at(row)];
        return lose(first.from,
                    fmt::format("\"{}\" holds, but a parameter opens it", contacts_.model->element_name(element)));
      }
      for (Way& way : ways_) {
        for (std::size_t c = 0; c < n_; ++c)
          way.gradient[number] += way.y1[c] * q[c].d[p] + way.y1[n_ + c] * qd[c].d[p];
      }
    }
  }
  if (!start.lack().empty()) lack_derivatives(start.lack());
  return true;
}

std::optional<MeasureAdjoint::MeasureGradients> PhasedMeasures::find_gradients(
    const ColumnSet& columns, const std::vector<std::vector<ColumnPulse>>& pulses) {
  if (columns.needs().work) fail("work and dissipated energy, which are summed up over time, have no derivative");
  if (steps_.empty()) fail("the motion was not looked at");
  if (!why().empty()) return {};
  std::vector<Look> all;
  for (std::size_t m = 0; m < pulses.size(); ++m) {
    for (const ColumnPulse& pulse : pulses[m]) {
      if (pulse.column == ColumnPulse::by_instant && !crosses_at(pulse.t)) continue;
      if (pulse.column == ColumnPulse::by_instant || states_.contains(pulse.t))
        all.push_back({pulse.t, m, pulse.column, pulse.weight});
      else
        lose(pulse.t, "the motion was not looked at");
    }
  }
  std::stable_sort(all.begin(), all.end(), [](const Look& a, const Look& b) { return a.t < b.t; });
  if (!all.empty() && (all.front().t < steps_.front().from || all.back().t > steps_.back().to))
    lose(all.back().t, "there is no motion");
  if (!why().empty()) return {};
  slopes_ = std::make_unique<ColumnSlopes>(evaluator().model(), columns, mechanisms(), parameters(), contact_slopes());
  const Vector still(2 * n_, 0.0);
  ways_.assign(pulses.size(), Way{.y1 = still,
                                  .y0 = still,
                                  .gradient = Vector(at(parameters()), 0.0),
                                  .anchor = Vector(at(plan().rows), 0.0),
                                  .back = std::vector<Vector>(dormand_prince_8().c.size(), still)});
  std::span<const Look> looks(all);
  checks_ = {};
  for (std::size_t k = steps_.size(); k > 0;) {
    if (!go_back_to_end(k, looks) || !go_back_over(k, looks)) return {};
  }
  hold(phases_.front());
  const Point begin = point_of(steps_.front().from, Side::after, steps_.front().begin);
  if (!looks.empty() && !add_looks(looks, begin, [this](std::size_t m) -> Vector& { return ways_[m].y1; })) return {};
  if (!add_start()) return {};
  MeasureGradients gradients;
  for (Way& way : ways_) gradients.push_back(std::move(way.gradient));
  return gradients;
}

}  // namespace catena
