// Watching for events: instants at which a column passes a value.
//
//   g_k(t) = column_k - value_k changes its sign, in the direction that is watched
//
// Within a step of the integrator g is sampled on the dense output, at eight instants or more: some quarter of a radian
// of the fastest body's turn apart, and where the samples of a column do not foretell each other (event_samples.hpp) in
// halves. A change of sign, or a dip towards zero that a parabola through three samples takes beyond it, is enclosed
// and the root found to rounding in t on states that meet the constraints, hence as exact as the rows of the run. A
// column that starts at its value has no event there, nor has one that stays at its value after an event and leaves it
// to the side from which it came, as where a latch that the event closed is opened. A column that crosses its value
// twice between two samples without a visible dip is missed; so may be one that no halving foretells.
//
// Events of the list are simultaneous if the later ones' columns are at their values, to rounding, when the first one
// happens: they then have its instant, and come in the order of the list. Units: those of the columns, s.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "catena/analysis/events/event_samples.hpp"
#include "catena/analysis/events/motion_sizes.hpp"
#include "catena/analysis/events/strike.hpp"
#include "catena/analysis/motion/motion_memory.hpp"
#include "catena/columns/column_set.hpp"

namespace catena {

enum class EventDirection { any, up, down };

enum class EventAction {
  record,   ///< a row, nothing else
  stop,     ///< the analysis ends
  release,  ///< a constraint ceases to hold
  engage,   ///< a constraint begins to hold; whether it does at the start: first_actions.hpp
  strike,   ///< an impulse acts
};

struct Event {
  std::string name;
  std::string column;  ///< one column, by its name
  double value = 0;
  EventDirection direction = EventDirection::any;
  EventAction action = EventAction::record;
  int element = -1;      ///< what is released or engaged, in the model's list
  bool is_held = false;  ///< that holds from the start, as a motion before has left it
  Strike strike{};       ///< the impulse
};

/// A change of the mechanism itself: where `value` passes from the side on which it begins to the other one.
struct Transition {
  std::function<double(const Snapshot&)> value;
  int side = 1;      ///< on which it begins: -1 or 1
  double scale = 0;  ///< of what the value is a difference of, where that is larger: it decides on its rounding
};

struct FoundEvent {
  int event = 0;
  double t = 0;
};

class EventWatch {
 public:
  using StateAt = std::function<std::optional<Snapshot>(double)>;

  /// Throws ColumnError for an unknown column; std::invalid_argument for one that stands for several, or that the
  /// analysis cannot give, and for a value that is not finite; std::out_of_range for an element that does not exist.
  EventWatch(std::vector<Event> events, const Model& model, const Plan& plan, const ColumnSources& sources);

  const std::vector<Event>& events() const { return events_; }
  Needs needs() const {
    Needs all = needs_;
    return all |= transition_needs_;
  }
  /// Takes note of how large a motion is, against which the rounding of columns is measured that pass zero.
  void know_sizes(const MotionSizes& sizes);
  /// Watches these beside the events, in place of those before; `needs`: what their values are made of.
  void watch(std::vector<Transition> transitions, const Needs& needs);
  /// Whether what was found is a transition, and which.
  bool is_transition(const FoundEvent& found) const { return found.event >= static_cast<int>(events_.size()); }
  /// Whether the motion goes on in another way after it.
  bool acts(int found) const {
    if (found >= static_cast<int>(events_.size())) return true;
    const EventAction action = events_[static_cast<std::size_t>(found)].action;
    return action != EventAction::record && action != EventAction::stop;
  }
  int transition(int found) const { return found - static_cast<int>(events_.size()); }
  /// The first event in (from, to]; `state_at` gives the mechanism at an instant of that interval. Where it has some
  /// that are simultaneous with it, the next calls give these.
  std::optional<FoundEvent> find(double from, double to, const StateAt& state_at);
  /// Whether the next call of find() gives one that is simultaneous with the last.
  bool has_simultaneous() const { return !simultaneous_.empty(); }
  /// Keeps a record of an event that was found and whose row was given. True if it acts: the motion must not continue
  /// unchanged.
  bool take(const FoundEvent& found);
  /// Counts rows: called with the number of those given so far.
  std::function<std::int64_t()> rows_given;
  const std::vector<EventRecord>& records() const { return records_; }
  /// Its state, without `released` and `turned`; and takes over the state of another one.
  EventMemory memory() const {
    const auto events = static_cast<std::ptrdiff_t>(events_.size());
    return {{}, {}, sides(), {largest_.begin(), largest_.begin() + events}, records_};
  }
  void remember(const EventMemory& memory);

 private:
  /// Of its value on which a column is: -1, 1; 0: not yet seen.
  struct Side {
    int at = 0;
    bool is_expected = false;  ///< an event led there, and the column has not been seen there since
  };

  std::vector<int> sides() const;
  FoundEvent first_found(const StateAt& state_at);
  int stretches(double from, double to, const StateAt& state_at);
  struct Look;
  std::optional<FoundEvent> look_within(double from, double to, int halvings, Look& look);
  bool may_hide_a_passage(int halvings);
  std::optional<FoundEvent> first_in_samples(double from, double to, int count, const StateAt& state_at);
  void sample(const Snapshot& state, std::span<double> g);
  double watched(std::size_t k, double t, const StateAt& state_at);
  std::optional<double> passage(std::size_t k, bool three, const StateAt& state_at);
  std::optional<double> locate(std::size_t k, double before, double after, const StateAt& state_at);
  double value_at(std::size_t k, double t, const StateAt& state_at);
  /// Column k passes its value between two instants; `dips`: not for long.
  struct Enclosed {
    std::size_t k = 0;
    double before = 0, after = 0;
    bool dips = false;
    double about = 0;  // where, as a straight line has it
  };
  std::vector<Enclosed> enclose_passages(bool three, const StateAt& state_at);
  bool locate_passages(const std::vector<Enclosed>& enclosed, const StateAt& state_at);
  int side(std::size_t k, double g) const;
  bool counts(std::size_t k) const;
  double tiny(std::size_t k) const;
  double target(std::size_t k) const { return k < events_.size() ? events_[k].value : 0; }
  double value_of(std::size_t k, const Snapshot& state) const;

  std::vector<Event> events_;
  std::vector<ColumnSet> columns_;
  std::vector<Transition> transitions_;
  Needs transition_needs_;
  Needs needs_;
  std::vector<Side> side_;
  std::vector<Side> side_before_;         // at the sample before the last
  std::vector<double> largest_;           // |column| so far: what rounding is measured against
  std::vector<double> found_at_;          // when each event was last found, s
  std::array<std::vector<double>, 3> g_;  // the last samples, of all columns
  std::array<double, 3> times_{};
  EventSamples taken_;          // of the stretch that is looked at
  std::vector<double> angles_;  // of moving bodies, where a step begins
  std::vector<double> then_;    // all columns at the first transition between two samples
  std::vector<FoundEvent> found_,
      simultaneous_;  // between two samples; those that are still to be given, the next last
  std::vector<EventRecord> records_;
};

}  // namespace catena
