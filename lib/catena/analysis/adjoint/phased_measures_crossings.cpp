// PhasedMeasures: back across instants at which the motion goes on in another way.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "catena/analysis/adjoint/phased_measures.hpp"
#include "catena/analysis/run/thresholds.hpp"
#include "catena/base/at.hpp"

namespace catena {

/// What contacts do, as columns read it.
ContactSlopes PhasedMeasures::contact_slopes() {
  ContactSlopes contacts;
  what_contacts_do_.resize(groups().size());
  contacts.at = [this](std::size_t g, std::span<const DesignScalar> lambda) {
    equations_->contacts({groups()[g].mechanism, places_[g], at(groups()[g].count)}, lambda, what_contacts_do_[g]);
    return &what_contacts_do_[g];
  };
  for (std::size_t k = 0; k < contacts_.points.size(); ++k) {
    const PlaceLaw law = equations_->law(places_.front()[k], k);
    for (const int row : {law.gap_row, law.slide_row}) {
      if (row >= 0) contacts.rows.push_back(row);
    }
    if (law.joint_row >= 0) contacts.rows.insert(contacts.rows.end(), {law.joint_row, law.joint_row + 1});
  }
  return contacts;
}

// As forward derivatives take them: what is there first, then the impact that follows.
void PhasedMeasures::find_blows(const Crossing& crossing, Passage& passage) const {
  using Blow = Passage::Blow;
  for (const VelocityJump& jump : crossing.phase.jumps) {
    std::vector<int> released = jump.released;
    for (const ContactPoint& point : contacts_.points) {
      released.push_back(point.element);
      if (point.has_friction()) released.push_back(point.slide);
    }
    if (jump.meets_constraints) {
      passage.blows.push_back(Blow{jump, released});
      passage.blows.back().jump.places.clear();
    }
    if (jump.places.empty()) continue;
    VelocityJump impact = jump;
    impact.strike.reset();
    std::erase_if(impact.places, [](const ImpactPlace& place) { return !place.presses; });
    for (const ImpactPlace& place : impact.places) {
      std::erase(released, contacts_.points[place.place].element);
      if (place.sticks) std::erase(released, contacts_.points[place.place].slide);
    }
    passage.blows.push_back(Blow{std::move(impact), std::move(released)});
  }
  // Functions of time that jump while the same equations hold.
  if (crossing.phase.functions_jump && crossing.phase.jumps.empty())
    passage.blows.push_back(Blow{{.meets_constraints = true}, crossing.phase.released, crossing.phase.states});
  for (Blow& blow : passage.blows) {
    blow.step.jump = &blow.jump;
    if (blow.jump.strike) blow.step.strikes = &events_[at(blow.jump.event)].strikes;
  }
}

bool PhasedMeasures::find_passage(const Crossing& crossing, const Step& last, Passage& passage) {
  passage.before = point_of(last.to, Side::before, last.end);
  hold(phases_[last.phase]);
  if (!transpose_->evaluate(passage.before)) return singular_at(last.to);
  Point there{last.to, Side::after, passage.before.q, passage.before.qd};
  find_blows(crossing, passage);
  for (Passage::Blow& blow : passage.blows) {
    equations_->hold(blow.released, blow.states);
    blow.step.before = there;
    if (!transpose_->jump(blow.step)) return singular_at(last.to);
    there.qd = blow.step.after.qd;
  }
  hold(crossing.phase);
  passage.after = std::move(there);
  return transpose_->evaluate(passage.after) || singular_at(last.to);
}

// An instant that is not known matters only where the motion jumps or bends.
bool PhasedMeasures::bends(const Passage& passage) const {
  if (!passage.blows.empty()) return true;
  double change = 0, size = 0;
  for (const int c : plan().coordinate) {
    const double before = passage.before.qdd[at(c)], after = passage.after.qdd[at(c)];
    change = std::max(change, std::abs(after - before));
    size = std::max({size, std::abs(before), std::abs(after)});
  }
  return change > thresholds::no_jump * size;
}

// By what determines the instant.
bool PhasedMeasures::end_back(const Crossing& crossing, const Step& last, Passage& passage, Way& way) {
  const Point& before = passage.before;
  for (std::size_t p = 0; p < crossing.rate.size(); ++p) way.gradient[p] += way.instant * crossing.rate[p];
  if (!crossing.is_found() || way.instant == 0) return true;
  if (!crossing.by_time || *crossing.by_time == 0) {
    if (!bends(passage)) return true;
    if (!crossing.trouble.empty()) return fail(crossing.trouble);
    return lose(last.to, "the motion goes on in another way at an instant that has no derivative");
  }
  const double weight = -way.instant / *crossing.by_time;
  hold(phases_[last.phase]);
  if (!transpose_->restore(before)) return singular_at(last.to);
  if (!crossing.place) {
    const DesignEvent& event = events_[at(crossing.event)];
    ColumnSlopes slopes(evaluator().model(), event.column, mechanisms(), parameters(), contact_slopes());
    for (Group& group : groups()) group.mechanism.set_time(before.t, Side::before);
    slopes.look({.evaluator = evaluator(),
                 .t = before.t,
                 .q = before.q,
                 .qd = before.qd,
                 .qdd = before.qdd,
                 .lambda = before.lambda});
    StateSlopes sum = slopes.empty();
    slopes.add(0, weight, sum);
    for (std::size_t p = 0; p < sum.by_p.size(); ++p) sum.by_p[p] -= weight * event.value_rate[p];
    return add_slopes(before, sum, way, way.y1);
  }
  StateSlopes sum{Vector(n_, 0.0), Vector(n_, 0.0), {}, Vector(at(plan().rows), 0.0), Vector(at(parameters()), 0.0)};
  transpose_->add_end(before, *crossing.place, weight, sum.by_q, sum.by_qd, sum.by_lambda);
  for (std::size_t g = 0; g < groups().size(); ++g) {
    const DesignScalar value = transpose_->end_value(before, *crossing.place, group_of(g));
    for (std::size_t p = 0; p < at(groups()[g].count); ++p)
      sum.by_p[g * at(parameters_at_once) + p] = weight * value.d[p];
  }
  return add_slopes(before, sum, way, way.y1);
}

bool PhasedMeasures::cross_back(const Crossing& crossing, const Step& last) {
  checks_.ask();
  Passage passage;
  if (!find_passage(crossing, last, passage)) return false;
  const auto along = [this](const Vector& y, const Point& point) {
    const auto middle = y.begin() + static_cast<std::ptrdiff_t>(n_);
    return std::inner_product(y.begin(), middle, point.qd.begin(), 0.0) +
           std::inner_product(middle, y.end(), point.qdd.begin(), 0.0);
  };
  for (Way& way : ways_) {
    release_anchors(passage.after, way);
    way.instant -= along(way.y1, passage.after);
  }
  for (auto blow = passage.blows.rbegin(); blow != passage.blows.rend(); ++blow) {
    equations_->hold(blow->released, blow->states);
    for (Way& way : ways_) {
      const std::span<double> q = std::span(way.y1).first(n_), qd = std::span(way.y1).subspan(n_);
      if (!way.begun) continue;
      if (!transpose_->jump_back(blow->step, q, qd, way.instant)) return singular_at(last.to);
      for (std::size_t g = 0; g < groups().size(); ++g)
        add_gradient(g, transpose_->jump_by_parameters(blow->step, group_of(g), g), way);
    }
  }
  for (Way& way : ways_) {
    if (!way.begun) continue;
    way.instant += along(way.y1, passage.before);
    if (!end_back(crossing, last, passage, way)) return false;
    way.instant = 0;
  }
  return true;
}

}  // namespace catena
