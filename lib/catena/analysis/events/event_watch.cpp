#include "catena/analysis/events/event_watch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "catena/analysis/run/thresholds.hpp"

namespace catena {
namespace {

// A distance from the value below this part of the column's size counts as zero.
constexpr double rounding = thresholds::carried_rounding;
// Of the time between two samples: columns that reach their values within rounding at one instant do so this near to
// it.
constexpr double one_instant = 1e-3;

}  // namespace

EventWatch::EventWatch(std::vector<Event> events, const Model& model, const Plan& plan, const ColumnSources& sources)
    : events_(std::move(events)) {
  ColumnSources untimed = sources;
  untimed.timed = false;
  for (const Event& event : events_) {
    const std::string name[] = {event.column};
    columns_.push_back(ColumnSet::resolve(model, plan, name, untimed));
    const ColumnSet& set = columns_.back();
    if (!set.notes().empty()) throw std::invalid_argument("event \"" + event.name + "\": " + set.notes().front());
    if (set.size() != 1)
      throw std::invalid_argument("event \"" + event.name + "\" watches \"" + event.column +
                                  "\", which is more than one column");
    needs_ |= set.needs();
    if (!std::isfinite(event.value))
      throw std::invalid_argument("event \"" + event.name + "\": its value is not finite");
    if (event.action == EventAction::release || event.action == EventAction::engage)
      static_cast<void>(model.element_type(event.element));  // throws for what is none
  }
  side_.assign(events_.size(), {});
  largest_.assign(events_.size(), 0);
  // What authors compute has no size that is known.
  for (std::size_t k = 0; k < events_.size(); ++k) {
    if (events_[k].value == 0 && columns_[k].info().front().unit == UnitKind::own)
      largest_[k] = MotionSizes::least_part;
  }
  found_at_.assign(events_.size(), -std::numeric_limits<double>::infinity());
  for (std::vector<double>& g : g_) g.resize(events_.size());
  angles_.resize(static_cast<std::size_t>(plan.moving));
}

void EventWatch::know_sizes(const MotionSizes& sizes) {
  for (std::size_t k = 0; k < events_.size(); ++k) {
    if (events_[k].value != 0) continue;
    largest_[k] = std::max(largest_[k], MotionSizes::least_part * sizes.of(columns_[k].info().front().unit));
  }
}

double EventWatch::tiny(std::size_t k) const { return rounding * std::max(largest_[k], std::abs(target(k))); }

int EventWatch::side(std::size_t k, double g) const {
  const double none = tiny(k);
  return g > none ? 1 : g < -none ? -1 : 0;
}

/// Whether a passage from the side last seen to the other one is in the direction that is watched.
bool EventWatch::counts(std::size_t k) const {
  if (k >= events_.size()) return side_[k].at == transitions_[k - events_.size()].side;
  return events_[k].direction == EventDirection::any ||
         (events_[k].direction == EventDirection::up) == (side_[k].at < 0);
}

void EventWatch::sample(const Snapshot& state, std::span<double> g) {
  for (std::size_t k = 0; k < side_.size(); ++k) {
    const double value = value_of(k, state);
    largest_[k] = std::max(largest_[k], std::abs(value));
    g[k] = value - target(k);
  }
}

double EventWatch::value_of(std::size_t k, const Snapshot& state) const {
  if (k >= events_.size()) return transitions_[k - events_.size()].value(state);
  double value = 0;
  columns_[k].evaluate(state, {&value, 1});
  return value;
}

void EventWatch::watch(std::vector<Transition> transitions, const Needs& needs) {
  transitions_ = std::move(transitions);
  found_.clear();
  transition_needs_ = needs;
  const std::size_t size = events_.size() + transitions_.size();
  side_.resize(events_.size());
  for (const Transition& transition : transitions_) side_.push_back({transition.side});
  largest_.resize(events_.size());
  for (const Transition& transition : transitions_) largest_.push_back(transition.scale);
  found_at_.resize(events_.size());
  found_at_.resize(size, -std::numeric_limits<double>::infinity());
  for (std::vector<double>& g : g_) g.resize(size);
}

double EventWatch::watched(std::size_t k, double t, const StateAt& state_at) {
  const std::optional<Snapshot> state = state_at(t);
  if (!state) return std::numeric_limits<double>::quiet_NaN();
  return value_of(k, *state) - target(k);
}

// Of those found between two samples, the earliest last, the first one, which takes those of the list with it that
// happen then too; of these the first in the list. The others stay for the next calls of find().
FoundEvent EventWatch::first_found(const StateAt& state_at) {
  FoundEvent first = found_.back();
  found_.pop_back();
  const auto is_listed = [&](const FoundEvent& found) { return found.event < static_cast<int>(events_.size()); };
  const double near = first.t + one_instant * (times_[2] - times_[1]);
  std::vector<FoundEvent> later;
  const bool alone = found_.empty() || found_.back().t > near;
  const std::optional<Snapshot> state = alone ? std::nullopt : state_at(first.t);
  for (; !found_.empty() && found_.back().t <= near; found_.pop_back()) {
    const FoundEvent found = found_.back();
    const auto k = static_cast<std::size_t>(found.event);
    const bool reached =
        found.t == first.t || (state && is_listed(found) && side(k, value_of(k, *state) - target(k)) == 0);
    if (is_listed(found) && reached) {
      simultaneous_.push_back({found.event, first.t});
    } else {
      later.push_back(found);
    }
  }
  found_.insert(found_.end(), later.rbegin(), later.rend());
  // What the mechanism does by itself comes after them, and is found again.
  if (is_listed(first)) {
    simultaneous_.push_back(first);
  } else {
    found_.clear();
  }
  std::sort(simultaneous_.begin(), simultaneous_.end(),
            [](const FoundEvent& a, const FoundEvent& b) { return a.event > b.event; });
  if (!simultaneous_.empty()) {
    first = simultaneous_.back();
    simultaneous_.pop_back();
  }
  bool changes = acts(first.event);
  for (const FoundEvent& found : simultaneous_) changes = changes || acts(found.event);
  const auto take_note = [&](const FoundEvent& found) {
    const auto k = static_cast<std::size_t>(found.event);
    side_before_[k] = side_[k] = {-side_[k].at, true};
    found_at_[k] = found.t;
  };
  take_note(first);
  std::for_each(simultaneous_.begin(), simultaneous_.end(), take_note);
  // The motion does not come to the last sample.
  if (changes) side_ = side_before_;
  // The last one tells up to where they were given.
  if (!found_.empty()) found_.push_back(first);
  return first;
}

/// As numbers: twice the side where it is expected.
std::vector<int> EventWatch::sides() const {
  std::vector<int> numbers;
  for (std::size_t k = 0; k < events_.size(); ++k) numbers.push_back(side_[k].at * (side_[k].is_expected ? 2 : 1));
  return numbers;
}

void EventWatch::remember(const EventMemory& memory) {
  side_.clear();
  for (const int number : memory.sides) side_.push_back({(number > 0) - (number < 0), std::abs(number) == 2});
  largest_ = memory.largest;
  records_ = memory.records;
}

bool EventWatch::take(const FoundEvent& found) {
  const Event& event = events_[static_cast<std::size_t>(found.event)];
  records_.push_back({event.name, found.event, found.t, rows_given ? rows_given() - 1 : 0});
  if (event.action == EventAction::record) return false;
  found_.clear();
  return true;
}

}  // namespace catena
