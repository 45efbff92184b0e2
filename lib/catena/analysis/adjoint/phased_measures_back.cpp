// PhasedMeasures: the way back over the steps of a phase.
#include <algorithm>
#include <array>

#include "catena/analysis/adjoint/phased_measures.hpp"
#include "catena/analysis/motion/stage_sums.hpp"
#include "catena/analysis/sensitivity/recomputed_steps.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

bool is_any(std::span<const double> values) {
  return std::any_of(values.begin(), values.end(), [](double x) { return x != 0; });
}

/// Those at the last instant of what is left, taken away from it.
template <class Look>
std::span<const Look> take_last(std::span<const Look>& looks) {
  std::size_t first = looks.size() - 1;
  while (first > 0 && looks[first - 1].t == looks.back().t) --first;
  const std::span<const Look> last = looks.subspan(first);
  looks = looks.first(first);
  return last;
}

}  // namespace

void PhasedMeasures::add_gradient(std::size_t g, const PhaseTranspose::ByParameter& part, Way& way) {
  for (std::size_t p = 0; p < at(groups()[g].count); ++p) way.gradient[g * at(parameters_at_once) + p] += part[p];
}

void PhasedMeasures::add_weights(const Point& point, Way& way) {
  for (std::size_t g = 0; g < groups().size(); ++g) add_gradient(g, transpose_->by_parameters(point, group_of(g)), way);
}

// Coordinates that are no unknowns move with the parameters themselves.
bool PhasedMeasures::add_slopes(const Point& point, const StateSlopes& slopes, Way& way, Vector& y) {
  add_times(way.gradient, 1, slopes.by_p);
  Vector more(2 * n_, 0.0);
  std::copy(slopes.by_q.begin(), slopes.by_q.end(), more.begin());
  std::copy(slopes.by_qd.begin(), slopes.by_qd.end(), more.begin() + static_cast<std::ptrdiff_t>(n_));
  for (std::size_t r = 0; r < slopes.by_lambda.size(); ++r) {
    if (slopes.by_lambda[r] != 0 && equations_->shares_row(static_cast<int>(r)))
      return lose(point.t, "a measure looks at a reaction while joints share friction that is not unique");
  }
  if (is_any(slopes.by_qdd) || is_any(slopes.by_lambda)) {
    if (!transpose_->weigh(slopes.by_qdd, slopes.by_lambda)) return singular_at(point.t);
    transpose_->add_by_state(point, std::span(more).first(n_), std::span(more).subspan(n_));
    add_weights(point, way);
  }
  for (const int c : plan().coordinate) {
    y[at(c)] += more[at(c)];
    y[n_ + at(c)] += more[n_ + at(c)];
  }
  return true;
}

bool PhasedMeasures::add_looks(std::span<const Look> looks, const Point& there,
                               const std::function<Vector&(std::size_t)>& target) {
  std::map<std::size_t, StateSlopes> of_measure;
  Point point = there;
  for (const Look& look : looks) {
    Way& way = ways_[look.measure];
    way.begun = true;
    if (look.column == ColumnPulse::by_instant) {
      way.instant += look.weight;
      continue;
    }
    if (of_measure.empty()) {
      if (!transpose_->evaluate(point)) return singular_at(point.t);
      for (Group& group : groups()) group.mechanism.set_time(point.t);
      slopes_->look({.evaluator = evaluator(),
                     .t = point.t,
                     .q = point.q,
                     .qd = point.qd,
                     .qdd = point.qdd,
                     .lambda = point.lambda});
    }
    slopes_->add(look.column, look.weight, of_measure.try_emplace(look.measure, slopes_->empty()).first->second);
  }
  return std::all_of(of_measure.begin(), of_measure.end(), [&](const auto& sum) {
    return add_slopes(point, sum.second, ways_[sum.first], target(sum.first));
  });
}

bool PhasedMeasures::project_back(const Point& point, Way& way, Vector& y) {
  std::array<Vector, 2> weights;
  if (!transpose_->project_back(point, std::span(y).first(n_), std::span(y).subspan(n_), way.anchor, weights))
    return singular_at(point.t);
  for (std::size_t g = 0; g < groups().size(); ++g)
    add_gradient(g, transpose_->rows_by_parameters(point, weights[0], weights[1], group_of(g)), way);
  return true;
}

bool PhasedMeasures::add_inside(const Step& step, std::span<const Look> looks) {
  const double t = looks.front().t, h = step.to - step.from;
  const InterpolantWeights weights = interpolant_weights((t - step.from) / h);
  const Point there = point_of(t, Side::after, states_.at(t));
  std::vector<Vector> back(ways_.size());
  const bool added = add_looks(looks, there, [&](std::size_t measure) -> Vector& {
    back[measure].resize(2 * n_, 0.0);
    return back[measure];
  });
  if (!added) return false;
  for (std::size_t m = 0; m < back.size(); ++m) {
    if (back[m].empty()) continue;
    Way& way = ways_[m];
    if (!project_back(there, way, back[m])) return false;
    add_times(way.y1, weights.end, back[m]);
    add_times(way.y0, 1 - weights.end, back[m]);
    for (std::size_t s = 0; s < weights.slope.size(); ++s) add_times(way.slopes[s], h * weights.slope[s], back[m]);
  }
  return true;
}

// States, accelerations and multipliers of all stages.
bool PhasedMeasures::recompute(const Step& step, bool interpolated) {
  const Tableau& table = dormand_prince_8();
  const double h = step.to - step.from;
  Vector y(2 * n_);
  for (std::size_t s = 0; s < (interpolated ? table.c.size() : at(table.stages)); ++s) {
    const bool is_end = s == at(table.stages), at_end = table.c[s] == 1 && s <= at(table.stages);
    if (is_end)
      y = step.end;
    else
      add_stages(
          step.begin, h, table.a[s], [&](int k) { return slope_[at(k)].data(); }, y);
    const double t = at_end ? step.to : step.from + table.c[s] * h;
    stage_[s] = point_of(t, at_end ? Side::before : Side::after, y);
    if (!transpose_->evaluate(stage_[s])) return singular_at(t);
    std::copy(stage_[s].qd.begin(), stage_[s].qd.end(), slope_[s].begin());
    std::copy(stage_[s].qdd.begin(), stage_[s].qdd.end(), slope_[s].begin() + static_cast<std::ptrdiff_t>(n_));
  }
  return true;
}

bool PhasedMeasures::stage_back(std::size_t s, const Vector& k, Vector& back) {
  const std::span<const double> k_q = std::span(k).first(n_), k_qd = std::span(k).subspan(n_);
  if (!transpose_->weigh(k_qd, {})) return singular_at(stage_[s].t);
  std::fill(back.begin(), back.end(), 0.0);
  const std::span<double> back_q = std::span(back).first(n_), back_qd = std::span(back).subspan(n_);
  std::copy(k_q.begin(), k_q.end(), back_qd.begin());
  transpose_->add_by_state(stage_[s], back_q, back_qd);
  for (std::size_t c = 0; c < n_; ++c) {
    if (c >= plan().column.size() || plan().column[c] < 0) back_q[c] = back_qd[c] = 0;
  }
  return true;
}

bool PhasedMeasures::stages_back(const Step& step, bool interpolated, bool checks) {
  const Tableau& table = dormand_prince_8();
  const double h = step.to - step.from;
  static const auto of_step = stage_weights_back(false), of_interpolant = stage_weights_back(true);
  const auto& terms = interpolated ? of_interpolant : of_step;
  const std::size_t stages = interpolated ? table.c.size() : at(table.stages), last = at(table.stages);
  Vector slope(2 * n_);
  for (std::size_t s = stages; s-- > 0;) {
    if (s + 1 == last) {
      const Point end = point_of(step.to, Side::before, step.end);
      if (!transpose_->factorize(end)) return singular_at(step.to);
      for (Way& way : ways_) {
        if (way.begun && !project_back(end, way, way.y1)) return false;
      }
    }
    if (!transpose_->restore(stage_[s])) return singular_at(stage_[s].t);
    for (Way& way : ways_) {
      if (!way.begun) continue;
      const auto vector_of = [&](int j) { return (j == step_end ? way.y1 : way.back[at(j)]).data(); };
      const std::span<const double> begin =
          interpolated ? std::span<const double>(way.slopes[s]) : std::span<const double>();
      add_stages(begin, h, terms[s], vector_of, slope);
      if (!stage_back(s, slope, way.back[s])) return false;
      add_weights(stage_[s], way);
      if (checks && s < last && !errors_back(h, s, way)) return false;
      if (s == last) add_times(way.y1, 1, way.back[s]);
    }
  }
  for (Way& way : ways_) {
    if (!way.begun) continue;
    for (std::size_t s = 0; s < stages; ++s) {
      if (s != last) add_times(way.y0, 1, way.back[s]);
    }
    add_times(way.y0, 1, way.y1);
  }
  return true;
}

bool PhasedMeasures::go_back_over(std::size_t& k, std::span<const Look>& looks) {
  const Step& step = steps_[k - 1];
  const bool inside = !looks.empty() && looks.back().t > step.from;
  if (!inside && begun() == 0) {
    --k;
    return true;
  }
  hold(phases_[step.phase]);
  evaluator().go_to_curve_places(step.places);
  for (Group& group : groups()) group.mechanism.go_to_curve_places(step.places);
  if (!recompute(step, inside)) return false;
  const double h = step.to - step.from;
  const auto is_due = [&] { return aim_.divides() && checks_.is_due(h, begun()); };
  // Measures may begin inside.
  const bool may_check = is_due() || (aim_.divides() && inside && begun() < ways_.size());
  const std::vector<Way> ways_before = may_check ? ways_ : std::vector<Way>();
  const std::span<const Look> looks_before = looks;
  for (Way& way : ways_) {
    std::fill(way.y0.begin(), way.y0.end(), 0.0);
    if (inside) way.slopes.assign(dormand_prince_8().c.size(), Vector(2 * n_, 0.0));
    if (may_check) way.errors.fill(std::vector<Vector>(at(dormand_prince_8().stages), Vector(2 * n_, 0.0)));
  }
  while (!looks.empty() && looks.back().t > step.from) {
    if (!add_inside(step, take_last(looks))) return false;
  }
  const bool checks = is_due();
  if (!stages_back(step, inside, checks)) return false;
  const double missed = checks ? excess() : 0;
  if (missed > 1) {
    ways_ = ways_before;
    looks = looks_before;
    checks_.ask();
    return divide(k, parts_for(missed)) && go_back_over(k, looks);
  }
  if (checks)
    checks_.note(h, begun(), missed);
  else
    checks_.note_unchecked();
  for (Way& way : ways_) {
    if (way.begun) std::swap(way.y0, way.y1);
  }
  --k;
  return true;
}

bool PhasedMeasures::go_back_to_end(std::size_t k, std::span<const Look>& looks) {
  const Step& last = steps_[k - 1];
  const auto found = crossings_.find(k);
  const Crossing* crossing = found == crossings_.end() ? nullptr : &found->second;
  const bool ends = k == steps_.size(), moves = crossing && crossing->moves();
  const auto looks_there = [&](const Look& look) {
    return look.t >= last.to && look.column != ColumnPulse::by_instant;
  };
  if (crossing && ends && (moves || (!looks.empty() && looks_there(looks.back()))))
    return lose(last.to, "the motion ends where it goes on in another way");
  if (moves && std::any_of(looks.begin(), looks.end(), looks_there))
    return lose(last.to, "a measure looks at an instant at which the motion goes on in another way");
  const bool beyond = crossing && !ends;
  if (!looks.empty() && looks.back().t >= last.to) {
    hold(phases_[beyond ? steps_[k].phase : last.phase]);
    const Point there = point_of(last.to, Side::after, beyond ? steps_[k].begin : last.end);
    while (!looks.empty() && looks.back().t >= last.to) {
      if (!add_looks(take_last(looks), there, [this](std::size_t m) -> Vector& { return ways_[m].y1; })) return false;
    }
  }
  return !beyond || cross_back(*crossing, last);
}

// Slides that stick keep the value that they have where they begin to.
void PhasedMeasures::release_anchors(const Point& point, Way& way) {
  Vector kept(way.anchor.size(), 0.0);
  for (std::size_t k = 0; k < contacts_.points.size(); ++k) {
    if (equations_->sticks(k)) kept[at(equations_->slide_row(k))] = way.anchor[at(equations_->slide_row(k))];
  }
  std::fill(way.anchor.begin(), way.anchor.end(), 0.0);
  if (!is_any(kept)) return;
  transpose_->add_rows(kept, std::span(way.y1).first(n_));
  for (double& weight : kept) weight = -weight;
  for (std::size_t g = 0; g < groups().size(); ++g)
    add_gradient(g, transpose_->rows_by_parameters(point, kept, {}, group_of(g)), way);
}

}  // namespace catena
