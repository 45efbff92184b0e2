#include "catena/analysis/adjoint/phased_measures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "catena/base/at.hpp"

namespace catena {
namespace {

bool is_among(const std::vector<int>& numbers, int number) {
  return std::find(numbers.begin(), numbers.end(), number) != numbers.end();
}

}  // namespace

PhasedMeasures::~PhasedMeasures() = default;

PhasedMeasures::PhasedMeasures(PhasedDesign design, GivenByModel start)
    : StateDerivatives(Plan::make(*design.contacts.model, design.all_rows), *design.contacts.model, design.models,
                       design.parameters),
      n_(at(plan().coordinates())),
      contacts_(std::move(design.contacts)),
      models_(std::move(design.models)),
      open_plan_(Plan::make(*contacts_.model, design.open_rows)),
      events_(std::move(design.events)),
      sizes_(std::move(design.sizes)),
      given_start_(start),
      aim_(std::move(design.aim)) {
  if (const std::string why = AdjointMechanism::why_not(*contacts_.model, true); !why.empty()) {
    fail("the adjoint of the motion is not built where " + why);
    return;
  }
  adjoint_ = std::make_unique<AdjointMechanism>(evaluator());
  equations_ = std::make_unique<PhaseEquations>(evaluator(), contacts_);
  std::vector<AdjointMechanism::Reached::SlideOfContact> slides;
  for (const ContactPoint& point : contacts_.points) {
    const bool touches = point.kind == ContactKind::rigid || point.kind == ContactKind::compliant;
    if (touches && point.has_friction()) slides.push_back({point.slide, point.element});
  }
  for (Group& group : groups()) {
    places_.push_back(design_places(group.mechanism.model(), contacts_.points));
    reached_.push_back(std::make_unique<AdjointMechanism::Reached>(*adjoint_, group.mechanism, slides));
    if (std::string trouble = trouble_with_places(group.mechanism.model()); !trouble.empty()) fail(std::move(trouble));
  }
  transpose_ = std::make_unique<PhaseTranspose>(*equations_, *adjoint_, groups().front().mechanism, places_.front());
  stage_.resize(dormand_prince_8().c.size());
  slope_.assign(stage_.size(), Vector(2 * n_));
}

bool PhasedMeasures::lose(double t, std::string_view what) {
  return fail(fmt::format("at t = {:.9g} s {}, which the adjoint of the motion does not pass", t, what));
}

bool PhasedMeasures::singular_at(double t) { return lose(t, "constraints depend on each other, or friction wedges"); }

bool PhasedMeasures::find(const Snapshot&) { return false; }

bool PhasedMeasures::crosses_at(double t) const {
  return std::any_of(crossings_.begin(), crossings_.end(),
                     [&](const auto& crossing) { return steps_[crossing.first - 1].to == t; });
}

// Searches along curves go on from there.
bool PhasedMeasures::look_at(const MotionStretch& stretch, double t, Vector& y, std::vector<CurvePlace>* places) {
  const std::optional<Snapshot> state = stretch.at(t);
  if (!state) return lose(t, "the motion could not be looked at");
  y.assign(state->q.begin(), state->q.end());
  y.insert(y.end(), state->qd.begin(), state->qd.end());
  const std::vector<CurvePlace>& there = state->evaluator.curve_places();
  evaluator().go_to_curve_places(there);
  for (Group& group : groups()) group.mechanism.go_to_curve_places(there);
  if (places) *places = there;
  return true;
}

PhasedMeasures::Point PhasedMeasures::point_of(double t, Side side, const Vector& y) const {
  const auto middle = y.begin() + static_cast<std::ptrdiff_t>(n_);
  return {t, side, {y.begin(), middle}, {middle, y.end()}};
}

// A step of the motion, in parts where its forces are smooth in these alone.
bool PhasedMeasures::keep_steps(const MotionStretch& stretch) {
  take_parts(smooth_parts(stretch, power_places(contacts_, phases_.back().states, places_)));
  if (part_ends().empty()) return lose(stretch.to, "the motion could not be looked at");
  double from = stretch.from;
  for (const double to : part_ends()) {
    Step step{from, to, {}, {}, {}, phases_.size() - 1};
    if (!look_at(stretch, from, step.begin, &step.places) || !look_at(stretch, to, step.end, nullptr)) return false;
    steps_.push_back(std::move(step));
    from = to;
  }
  return true;
}

void PhasedMeasures::cover(const MotionStretch& stretch) {
  if (!why().empty()) return;
  if (phases_.empty()) phases_.emplace_back();
  if (steps_.empty() && instant_at(stretch.from).moves()) {
    lose(stretch.from, "the motion begins at a jump of a function of time that moves");
    return;
  }
  const MovingInstant& instant = instant_at(stretch.to);
  if (std::any_of(instant.rate.begin(), instant.rate.end(), [](double rate) { return std::isnan(rate); })) {
    lose(stretch.to, "functions of time jump together that move apart with the parameters");
    return;
  }
  if (!keep_steps(stretch)) return;
  ended_by_ = {};
  if (stretch.ended_by >= 0) find_rate(stretch);
  if (instant.order != 1 && !instant.moves()) return;
  Crossing crossing{phases_.back(), true};
  crossing.phase.jumps.clear();
  crossing.phase.functions_jump = true;
  crossing.rate = instant.rate;
  crossings_.insert_or_assign(steps_.size(), std::move(crossing));
}

// How fast what ends the stretch changes there.
void PhasedMeasures::find_rate(const MotionStretch& stretch) {
  ended_by_.number = stretch.ended_by;
  const int listed = static_cast<int>(events_.size());
  if (stretch.ended_by < listed) {
    ended_by_.by_time = rate_at_end(stretch, events_[at(stretch.ended_by)].column);
    return;
  }
  const MotionPhase& phase = phases_.back();
  const std::size_t transition = at(stretch.ended_by - listed);
  if (transition >= phase.watched.size()) return;
  const WatchedPlace& watched = phase.watched[transition];
  hold(phase);
  Point end = point_of(stretch.to, Side::before, steps_.back().end);
  if (!transpose_->evaluate(end)) return;
  PhaseEquations::EndRate rate = transpose_->rate_of_end(end, watched);
  ended_by_.by_time = rate.rate;
  ended_by_.trouble = std::move(rate.trouble);
  if (rate.rate || !ended_by_.trouble.empty()) return;
  ended_by_.by_time = rate_at_end(stretch, [&](double t) -> std::optional<double> {
    Vector y;
    if (!look_at(stretch, t, y, nullptr)) return {};
    Point there = point_of(t, Side::before, y);
    if (!transpose_->evaluate(there)) return {};
    return transpose_->end_value(there, watched);
  });
}

PhasedMeasures::Crossing PhasedMeasures::crossing_of(const MotionPhase& phase) {
  Crossing crossing{phase};
  if (phase.functions_jump) crossing.rate = instant_at(phase.t).rate;
  const MotionPhase& last = phases_.back();
  int number = -1;
  if (phase.ended_by >= 0 && at(phase.ended_by) < last.watched.size()) {
    number = static_cast<int>(events_.size()) + phase.ended_by;
    crossing.place = last.watched[at(phase.ended_by)];
  } else if (!phase.events.empty()) {
    number = crossing.event = phase.events.front();
  }
  if (!crossing.is_found()) return crossing;
  crossing.rate.clear();
  if (ended_by_.number == number) {
    crossing.by_time = ended_by_.by_time;
    crossing.trouble = ended_by_.trouble;
  } else if (crossing.place) {
    hold(last);
    Point end = point_of(phase.t, Side::before, steps_.back().end);
    if (!transpose_->evaluate(end)) return crossing;
    PhaseEquations::EndRate rate = transpose_->rate_of_end(end, *crossing.place);
    crossing.by_time = rate.rate;
    crossing.trouble = std::move(rate.trouble);
  }
  return crossing;
}

// Rows that a jump meets, or whose place ends the phase, are met whatever the parameters are.
bool PhasedMeasures::holds_for_sure(int element, const MotionPhase& phase, const Crossing& crossing) const {
  for (std::size_t k = 0; k < contacts_.points.size(); ++k) {
    const bool is_gap = contacts_.points[k].element == element, is_slide = contacts_.points[k].slide == element;
    if (!is_gap && !is_slide) continue;
    if (crossing.place && crossing.place->place == k) return true;
    for (const VelocityJump& jump : phase.jumps) {
      for (const ImpactPlace& place : jump.places) {
        if (place.place == k && (is_slide ? place.sticks : place.was_hit)) return true;
      }
    }
  }
  return false;
}

/// Why the way back does not lead across, as a phrase; empty: it may.
std::string PhasedMeasures::obstacle_of(const MotionPhase& phase, const Crossing& crossing) const {
  if (const auto known = crossings_.find(steps_.size()); known != crossings_.end() && !known->second.same_phase)
    return "the motion goes on in another way twice";
  const bool several = phase.events.size() > 1 || (!phase.events.empty() && crossing.place);
  if (several || (crossing.is_found() && phase.functions_jump))
    return "several events act at once, or one where a function of time jumps";
  for (const VelocityJump& jump : phase.jumps) {
    if (jump.other_law) return "another law of impacts takes the place of Newton's";
    if (jump.settles) return "a motion that rocks ever faster comes to rest";
    if (std::count_if(jump.places.begin(), jump.places.end(), [](const ImpactPlace& p) { return p.was_hit; }) > 1)
      return "several contacts close at once";
  }
  for (const int element : phases_.back().released) {
    if (is_among(phase.released, element) || holds_for_sure(element, phase, crossing)) continue;
    return fmt::format("\"{}\" begins to hold besides", contacts_.model->element_name(element));
  }
  return {};
}

void PhasedMeasures::begin(const MotionPhase& phase) {
  if (!why().empty()) return;
  if (steps_.empty()) {
    phases_.assign(1, phase);
    const auto hits = [](const VelocityJump& jump) { return !jump.places.empty(); };
    if (std::any_of(phase.jumps.begin(), phase.jumps.end(), hits)) lose(phase.t, "the motion begins with an impact");
    return;
  }
  if (phase.t != steps_.back().to) {
    lose(phase.t, "the motion could not be looked at");
    return;
  }
  Crossing crossing = crossing_of(phase);
  if (const std::string why = obstacle_of(phase, crossing); !why.empty()) {
    lose(phase.t, why);
    return;
  }
  crossings_.insert_or_assign(steps_.size(), std::move(crossing));
  phases_.push_back(phase);
}

void PhasedMeasures::keep(const Snapshot& snapshot) {
  if (!why().empty()) return;
  const auto [place, is_new] = states_.try_emplace(snapshot.t);
  // Where the motion goes on in another way measures look at the state after that.
  if (!is_new && !crosses_at(snapshot.t)) return;
  place->second.assign(snapshot.q.begin(), snapshot.q.end());
  place->second.insert(place->second.end(), snapshot.qd.begin(), snapshot.qd.end());
}

}  // namespace catena
