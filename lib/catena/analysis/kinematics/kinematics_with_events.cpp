#include "catena/analysis/kinematics/kinematics_with_events.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "catena/analysis/events/engaged_turns.hpp"
#include "catena/analysis/events/engagement.hpp"
#include "catena/analysis/events/first_actions.hpp"
#include "catena/analysis/run/released_elements.hpp"
#include "catena/analysis/run/report_parts.hpp"
#include "catena/analysis/run/state_conversion.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// Places in a piece may be off the cubic through its ends by this, length scales or rad. A body that turns evenly then
// turns by (384 x 1e-4)^(1/4) = 0.44 rad at most; at eight samples a parabola through three of them, vertex at an end,
// is off by some 0.055^3 / 15 = 1e-5 of a radius: shallow dips may be overlooked where two pieces meet (measured: 6 of
// 191 that were 5e-5 of a radius deep, none of 5e-3).
constexpr double largest_event_bend = 1e-4;
// Parts of a piece at which that is checked: of no period that a motion and its pieces could share.
constexpr std::array<double, 2> checked_parts = {0.3819660112501051, 0.7071067811865476};
// A piece is halved so often at most: 1e-6 of the way between two rows, at the end of which a motion may lock.
constexpr int most_halvings = 20;

/// An end of a piece.
struct Place {
  double t = 0;
  std::vector<double> q, qd;
};

}  // namespace

// Stands between Kinematics and the observer of the rows: looks for events on the way to each row before it gives it.
class KinematicsWithEvents::Rows final : public RowObserver {
 public:
  Rows(KinematicsWithEvents& owner, KinematicLook& look, RowObserver& target, std::int64_t& given, double from)
      : owner_(owner), watch_(*owner.watch_), look_(look), target_(target), given_(given), looked_to_(from) {}

  bool observe(const Snapshot& row) override {
    row_ = &row;
    watch_.know_sizes(sizes_of_motion(row.evaluator.length_scale(), row.qd));
    const bool goes_on = look_through(row.t);
    row_ = nullptr;
    if (!goes_on) return false;
    look_.return_to(row);
    ++passed_;
    if (row_given_at_ == row.t) return true;
    return give(row);
  }
  bool proceed(double t) override { return target_.proceed(t); }
  /// Looks for events up to t. False: one acts, or the analysis was cancelled.
  bool look_through(double t) {
    if (!(t > looked_to_)) return true;
    Place from = place(looked_to_);
    while (from.t < t) {
      Place to = place(breakpoint(from.t, t));
      if (!look_between(from, to, 0)) return false;
      from = std::move(to);
    }
    looked_to_ = t;
    return true;
  }

  std::int64_t passed() const { return passed_; }  ///< rows of the grid that were given
  bool cancelled() const { return cancelled_; }
  /// The first instant at which the mechanism could not be looked at.
  const std::optional<double>& unseen() const { return unseen_; }

 private:
  std::optional<Snapshot> state_at(double t) {
    std::optional<Snapshot> state = look_.at(t);
    if (!state && row_ && t == row_->t) {
      // Where the motion locks: without rates.
      state.emplace(*row_);
      no_rates_.assign(row_->q.size(), std::numeric_limits<double>::quiet_NaN());
      state->qd = no_rates_;
    }
    if (!state && !unseen_) unseen_ = t;
    return state;
  }
  Place place(double t) {
    Place place{t, {}, {}};
    if (const std::optional<Snapshot> state = state_at(t)) {
      place.q.assign(state->q.begin(), state->q.end());
      place.qd.assign(state->qd.begin(), state->qd.end());
    }
    return place;
  }
  // The first breakpoint of a function of time between two instants; the later one if there is none.
  double breakpoint(double from, double to) const {
    double next = to;
    for (const auto& function : owner_.model_->functions) next = std::min(next, function.next_breakpoint(from));
    return next;
  }
  bool is_smooth(const Place& from, const Place& to) {
    const double h = to.t - from.t;
    if (from.qd.empty() || to.qd.empty()) return true;  // cannot be looked at, and is told
    const Evaluator& evaluator = owner_.kinematics_->evaluator();
    for (const double s : checked_parts) {
      const std::optional<Snapshot> state = state_at(from.t + s * h);
      if (!state) return true;
      const double a = (1 + 2 * s) * (1 - s) * (1 - s), b = s * (1 - s) * (1 - s) * h;
      const double c = s * s * (3 - 2 * s), d = -s * s * (1 - s) * h;
      for (std::size_t k = 0; k < from.q.size(); ++k) {
        const double cubic = a * from.q[k] + b * from.qd[k] + c * to.q[k] + d * to.qd[k];
        const double bend = std::abs(state->q[k] - cubic) / (k % 3 == 2 ? 1 : evaluator.length_scale());
        if (!(bend <= largest_event_bend)) return false;  // nor where rates have no bounds
      }
    }
    return true;
  }
  bool look_between(const Place& from, const Place& to, int depth) {
    const double half = from.t + (to.t - from.t) / 2;
    if (depth < most_halvings && half > from.t && half < to.t && !is_smooth(from, to)) {
      const Place middle = place(half);
      return look_between(from, middle, depth + 1) && look_between(middle, to, depth + 1);
    }
    return look_in(from.t, to.t);
  }
  // Events of a piece, in order: each with its row.
  bool look_in(double from, double to) {
    const auto state = [&](double t) { return state_at(t); };
    while (const std::optional<FoundEvent> found = watch_.find(from, to, state)) {
      if (!show(from, found->t)) return false;
      if (!give_event(found->t)) return false;
      from = found->t;
      if (watch_.take(*found)) owner_.acting_.push_back(found->event);
      if (owner_.acting_.empty() || watch_.has_simultaneous()) continue;
      if (const std::optional<Snapshot> end = state_at(from)) {
        const bool known = std::all_of(end->qd.begin(), end->qd.end(), [](double v) { return std::isfinite(v); });
        const std::span<const double> none;
        owner_.end_ = state_of(end->evaluator, end->t, end->q, known ? end->qd : none);
      }
      return false;
    }
    return show(from, to);
  }
  bool give_event(double t) {
    // At the instant of a row of the grid that is its row.
    if (row_ && t == row_->t) {
      row_given_at_ = t;
      return give(*row_);
    }
    const std::optional<Snapshot> state = state_at(t);
    return !state || give(*state);
  }
  bool show(double from, double to) {
    if (!target_.wants_stretches() || !(to > from)) return true;
    return keep(target_.cover({from, to, [this](double t) { return state_at(t); }}));
  }
  bool give(const Snapshot& state) {
    ++given_;
    return keep(target_.observe(state));
  }
  bool keep(bool goes_on) {
    cancelled_ |= !goes_on;
    return goes_on;
  }

  KinematicsWithEvents& owner_;
  EventWatch& watch_;
  KinematicLook& look_;
  RowObserver& target_;
  std::int64_t& given_;
  double looked_to_;
  std::int64_t passed_ = 0;
  bool cancelled_ = false;
  const Snapshot* row_ = nullptr;  // the next one of the grid
  std::optional<double> row_given_at_, unseen_;
  std::vector<double> no_rates_;
};

KinematicsWithEvents::KinematicsWithEvents(std::shared_ptr<const Model> model, const PlanOptions& plan_options,
                                           const KinematicsOptions& options, std::vector<Event> events,
                                           const ColumnSources& sources)
    : given_model_(std::move(model)), model_(given_model_), plan_options_(plan_options), options_(options) {
  for (const Event& event : events) {
    if (event.action == EventAction::strike)
      throw std::invalid_argument("event \"" + event.name + "\": an impulse changes no motion that drivers determine");
  }
  FirstActions first = first_actions(events, *model_);
  plan_options_.keep_elements.insert(plan_options_.keep_elements.end(), first.acted_on.begin(), first.acted_on.end());
  plan_options_.released_elements.insert(plan_options_.released_elements.end(), first.released.begin(),
                                         first.released.end());
  inactive_ = std::move(first.ambiguous);
  make_kinematics();
  watch_ = std::make_unique<EventWatch>(std::move(events), *model_, kinematics_->plan(), sources);
}

KinematicsWithEvents::~KinematicsWithEvents() = default;

void KinematicsWithEvents::make_kinematics() {
  model_ = given_model_;
  if (!turned_.empty()) {
    const auto turned = std::make_shared<Model>(*given_model_);
    for (std::size_t e = 0; e < turned_.size(); ++e) {
      if (turned_[e] != 0) turn_value(*turned, static_cast<int>(e), turned_[e]);
    }
    model_ = turned;
  }
  kinematics_ = std::make_unique<Kinematics>(model_, plan_options_, options_);
}

void KinematicsWithEvents::start_from(const SystemState& state) {
  start_ = state;
  kinematics_->start_from(state);
  if (turn_values_to_bodies(state.held, state)) kinematics_->start_from(state);
}

Report KinematicsWithEvents::check_order(const TimeGrid& grid) const {
  Report report;
  double before = kinematics_->time();
  for (std::int64_t k = 0; k < grid.size(); ++k) {
    if (grid[k] >= before) {
      before = grid[k];
      continue;
    }
    report.status = Status::refused;
    report.message = fmt::format(
        "events are looked for forwards in time: {:.12g} s comes after {:.12g} s; list the instants of \"at\" in their "
        "order, from where the analysis starts",
        grid[k], before);
    return report;
  }
  return report;
}

// The values of elements that were engaged, moved by the turns that the bodies made without them: whether any is.
bool KinematicsWithEvents::turn_values_to_bodies(std::span<const int> elements, const SystemState& state) {
  bool turns = false;
  for (const int element : elements) {
    Evaluator& evaluator = kinematics_->evaluator();
    evaluator.set_time(state.t);
    const int whole =
        whole_turns_of(*model_, element, residuals_of(evaluator, configuration_of(evaluator, state), element));
    if (whole == 0) continue;
    turned_.resize(model_->elements.size());
    turned_[at(element)] += whole;
    turns = true;
  }
  if (turns) make_kinematics();
  return turns;
}

// Places and values of what was just engaged: whole turns first, then whether it fits.
Report KinematicsWithEvents::engage(std::span<const int> elements) {
  turn_values_to_bodies(elements, *end_);
  for (const int element : elements) {
    Evaluator& evaluator = kinematics_->evaluator();
    evaluator.set_time(end_->t);
    if (Report fits = check_fit(evaluator, configuration_of(evaluator, *end_), element); !fits.ok()) return fits;
  }
  return {};
}

// After what events did last, too.
SystemState KinematicsWithEvents::state() const {
  SystemState state = end_ ? *end_ : kinematics_->state();
  state.released = released_by_events(*given_model_, plan_options_.released_elements);
  state.held =
      held_by_events(watch_->events(), plan_options_.released_elements, start_ ? start_->held : std::vector<int>{});
  return state;
}

Report KinematicsWithEvents::act(const Event*& stop) {
  std::vector<int> engaged;
  released_.clear();
  for (const int acting : acting_) {
    const Event& event = watch_->events()[at(acting)];
    if (event.action == EventAction::stop) {
      stop = &event;
      return {};
    }
    std::vector<int>& released = plan_options_.released_elements;
    std::erase(released, event.element);
    std::erase(engaged, event.element);
    if (event.action == EventAction::engage) {
      engaged.push_back(event.element);
      continue;
    }
    released.push_back(event.element);
    released_ += fmt::format("{}event \"{}\" released \"{}\"", released_.empty() ? "" : ", ", event.name,
                             model_->element_name(event.element));
  }
  make_kinematics();
  if (Report fits = engage(engaged); !fits.ok()) return fits;
  start_ = std::move(*end_);
  end_.reset();
  kinematics_->start_from(*start_);
  return {};
}

AnalysisReport KinematicsWithEvents::run(const TimeGrid& grid, const Needs& asked, RowObserver& observer) {
  AnalysisReport total;
  total.warnings = inactive_;
  const auto end_with = [&](const Report& report) {
    total.status = report.status;
    total.message = report.message;
    return total;
  };
  singular_points_.clear();
  end_.reset();
  if (Report order = check_order(grid); !order.ok()) return end_with(order);
  Needs looked_at = asked;
  looked_at |= watch_->needs();
  looked_at.velocity = true;
  Needs needs = asked;
  needs |= watch_->needs();
  std::int64_t given = 0, next_row = 0;
  watch_->rows_given = [&] { return given; };
  for (;;) {
    acting_.clear();
    KinematicLook look(model_, plan_options_, options_, looked_at);
    // The state may be the given configuration at the start.
    look.start_from(start_ ? *start_ : SystemState{});
    Rows rows(*this, look, observer, given, kinematics_->time());
    add_part(total, kinematics_->run(grid.from_row(next_row), needs, rows));
    if (!total.ok() && !rows.cancelled() && acting_.empty()) rows.look_through(kinematics_->time());
    next_row += rows.passed();
    if (rows.unseen() && acting_.empty() && total.status != Status::lock_up) {
      total.warnings.push_back(fmt::format(
          "events may be missing next to t = {:.12g} s, where the mechanism cannot be looked at", *rows.unseen()));
    }
    const double t_end = end_ ? end_->t : kinematics_->time();
    for (const SingularPoint& point : kinematics_->singular_points()) {
      if (acting_.empty() || point.t <= t_end) singular_points_.push_back(point);
    }
    if (acting_.empty()) {
      if (total.status == Status::under_driven && !released_.empty())
        total.message = fmt::format("after {}: {}", released_, total.message);
      return total;
    }
    // The phase was cut short by them.
    total.status = Status::ok;
    total.message.clear();
    const Event* stop = nullptr;
    const double t = end_->t;
    if (Report acted = act(stop); !acted.ok()) return end_with(acted);
    // At the instant of a row of the grid the event has given it.
    while (next_row < grid.size() && grid[next_row] <= t) ++next_row;
    if (stop && next_row < grid.size())
      total.message = fmt::format("event \"{}\" ended it at t = {:.12g} s", stop->name, t);
    if (stop || next_row == grid.size()) return total;
  }
}

}  // namespace catena
