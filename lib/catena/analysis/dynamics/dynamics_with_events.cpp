#include "catena/analysis/dynamics/dynamics_with_events.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "catena/analysis/dynamics/engaged_turns.hpp"
#include "catena/analysis/run/report_parts.hpp"
#include "catena/analysis/run/state_conversion.hpp"

namespace catena {
namespace {

// Events that act this often without time going on would do so for ever.
constexpr int most_at_once = 100;
// A constraint is engaged where it holds already, to this part of the length scale, or rad.
constexpr double misfit = 1e-6;

/// Passes rows on and counts them.
class CountingObserver final : public RowObserver {
 public:
  CountingObserver(RowObserver& target, std::int64_t before) : target_(target), rows_(before) {}
  bool observe(const Snapshot& snapshot) override {
    ++rows_;
    return target_.observe(snapshot);
  }
  bool proceed(double t) override { return target_.proceed(t); }
  bool wants_stretches() const override { return target_.wants_stretches(); }
  bool cover(const MotionStretch& stretch) override { return target_.cover(stretch); }
  std::int64_t rows() const { return rows_; }

 private:
  RowObserver& target_;
  std::int64_t rows_;
};

}  // namespace

DynamicsWithEvents::DynamicsWithEvents(std::shared_ptr<const Model> model, const PlanOptions& plan_options,
                                       const DynamicsOptions& options, std::vector<Event> events,
                                       const ColumnSources& sources)
    : contacts_(model),
      given_model_(std::move(model)),
      model_(given_model_),
      plan_options_(plan_options),
      options_(options) {
  for (const Event& event : events) {
    if (event.action != EventAction::release && event.action != EventAction::engage) continue;
    plan_options_.keep_elements.push_back(event.element);
    if (event.action == EventAction::engage) plan_options_.released_elements.push_back(event.element);
  }
  for (const Event& event : events) {
    const bool released = std::any_of(events.begin(), events.end(), [&](const Event& other) {
      return other.action == EventAction::release && other.element == event.element;
    });
    if (event.action != EventAction::engage || !released) continue;
    inactive_.push_back(
        fmt::format("\"{}\" does not hold from the start, since event \"{}\" engages it, although another event "
                    "releases it",
                    model_->element_name(event.element), event.name));
  }
  make_dynamics();
  watch_ = std::make_unique<EventWatch>(std::move(events), *model_, dynamics_->plan(), sources);
}

void DynamicsWithEvents::make_dynamics() {
  model_ = given_model_;
  PlanOptions plan = plan_options_;
  if (contacts_.any()) {
    model_ = contacts_.model();
    contacts_.add_rows(plan);
  }
  if (!turned_.empty()) {
    const auto turned = std::make_shared<Model>(*model_);
    for (std::size_t e = 0; e < turned_.size(); ++e) {
      if (turned_[e] != 0) turn_value(*turned, static_cast<int>(e), turned_[e]);
    }
    model_ = turned;
  }
  dynamics_ = std::make_unique<Dynamics>(model_, plan, options_);
  if (contacts_.any() && contacts_.started()) contacts_.attach(*dynamics_, *watch_);
}

void DynamicsWithEvents::start_from(const SystemState& state) {
  if (resumed_) return;
  start_ = state;
  dynamics_->start_from(state);
}

Report DynamicsWithEvents::start_contacts() {
  SystemState state = start_ ? *start_ : SystemState{};
  if (Report started = contacts_.start(state, plan_options_); !started.ok()) return started;
  make_dynamics();
  dynamics_->start_from(state);
  return {};
}

void DynamicsWithEvents::go_on_from(const SystemState& state, int engaged, bool sum_up_work, double work_of_strike) {
  WorkSoFar work = dynamics_->work_so_far();
  work.supplied += work_of_strike;
  work.energy += work_of_strike;
  const double energy = dynamics_->energy_in_motion();
  make_dynamics();
  dynamics_->start_from(state);
  if (engaged >= 0) turn_value_to_bodies(engaged, state);
  dynamics_->know_energy(energy);
  if (sum_up_work) dynamics_->carry_on(std::move(work));
}

Report DynamicsWithEvents::change_contacts(int transition, bool sum_up_work) {
  SystemState state = dynamics_->state();
  if (Report changed = contacts_.change(transition, state); !changed.ok()) return changed;
  go_on_from(state, -1, sum_up_work);
  return {};
}

Report DynamicsWithEvents::meet_jump(bool sum_up_work) {
  SystemState state = dynamics_->state();
  if (Report met = contacts_.meet_jump(state); !met.ok()) return met;
  go_on_from(state, -1, sum_up_work);
  return {};
}

void DynamicsWithEvents::resume(const MotionMemory& memory) {
  if (contacts_.any()) throw std::invalid_argument("a motion with contacts, stops or dry friction cannot be taken up");
  resumed_ = true;
  first_row_ = memory.next_row;
  rows_before_ = memory.rows_given;
  plan_options_.released_elements = memory.events.released;
  turned_ = memory.events.turned;
  watch_->remember(memory.events);
  make_dynamics();
  dynamics_->resume(memory);
}

void DynamicsWithEvents::save_and_resume(std::int64_t rows_given, std::int64_t next_row) {
  MotionMemory memory = dynamics_->memory();
  memory.next_row = next_row;
  memory.rows_given = rows_given;
  memory.events = watch_->memory();
  memory.events.released = plan_options_.released_elements;
  memory.events.turned = turned_;
  if (pauses_.save) pauses_.save(memory);
  resume(memory);
}

// Residuals of the rows of an element in the present state.
std::vector<double> DynamicsWithEvents::residuals_of(int element) {
  Evaluator& evaluator = dynamics_->evaluator();
  const Plan& plan = dynamics_->plan();
  evaluator.set_time(dynamics_->time());
  evaluator.set_configuration(configuration_of(evaluator, dynamics_->state()));
  std::vector<double> phi(static_cast<std::size_t>(plan.rows)), own;
  evaluator.phi(phi);
  for (std::size_t row = 0; row < phi.size(); ++row) {
    if (plan.row_element[row] == element) own.push_back(phi[row]);
  }
  return own;
}

// The value of an element that was just engaged, moved by the turns that the bodies made without it.
void DynamicsWithEvents::turn_value_to_bodies(int element, const SystemState& state) {
  const int turns = whole_turns_of(*model_, element, residuals_of(element));
  if (turns == 0) return;
  turned_.resize(model_->elements.size());
  turned_[static_cast<std::size_t>(element)] += turns;
  make_dynamics();
  dynamics_->start_from(state);
}

Report DynamicsWithEvents::check_fit(int element) {
  Report report;
  const Plan& plan = dynamics_->plan();
  const double length = dynamics_->evaluator().length_scale();
  auto row = static_cast<std::size_t>(std::max(0, plan.element_row[static_cast<std::size_t>(element)]));
  for (const double phi : residuals_of(element)) {
    const bool angle = plan.row_is_angle[row++] != 0;
    if (std::abs(phi) <= misfit * (angle ? 1 : length)) continue;
    report.status = Status::inconsistent;
    report.message = fmt::format(
        "\"{}\" cannot be engaged at t = {:.12g} s: it misses by {:.3g} {}; an event must happen where it holds",
        model_->element_name(element), dynamics_->time(), std::abs(phi), angle ? "rad" : "m");
    return report;
  }
  return report;
}

Report DynamicsWithEvents::strike(const Event& event, bool sum_up_work) {
  SystemState state = dynamics_->state();
  double work = 0;
  if (Report struck = contacts_.strike(event.strike, plan_options_, state, work); !struck.ok()) return struck;
  go_on_from(state, -1, sum_up_work, work);
  return {};
}

Report DynamicsWithEvents::act(const Event& event, bool sum_up_work) {
  if (event.action == EventAction::strike) return strike(event, sum_up_work);
  std::vector<int>& released = plan_options_.released_elements;
  const bool engage = event.action == EventAction::engage;
  std::erase(released, event.element);
  if (!engage) released.push_back(event.element);
  SystemState state = dynamics_->state();
  if (contacts_.any()) {
    if (Report changed = contacts_.change_constraints(plan_options_, state); !changed.ok()) return changed;
  }
  go_on_from(state, engage ? event.element : -1, sum_up_work);
  return engage ? check_fit(event.element) : Report{};
}

AnalysisReport DynamicsWithEvents::run(const TimeGrid& grid, const Needs& needs, RowObserver& observer) {
  CountingObserver rows(observer, rows_before_);
  watch_->rows_given = [&] { return rows.rows(); };
  AnalysisReport total;
  total.warnings = inactive_;
  singular_points_.clear();
  std::int64_t next_row = first_row_;
  TimeGrid rest = grid.from_row(next_row);
  if (contacts_.any()) {
    if (const Report started = start_contacts(); !started.ok()) {
      total.status = started.status;
      total.message = started.message;
      return total;
    }
  }
  double last_action = -1;
  int at_once = 0;
  for (;;) {
    if (!watch_->events().empty() || contacts_.any()) dynamics_->watch(watch_.get());
    // The next multiple that lies clearly ahead.
    dynamics_->pause_after((std::floor(dynamics_->time() / pauses_.every * (1 + 1e-12)) + 1) * pauses_.every);
    add_part(total, dynamics_->run(rest, needs, rows));
    const std::vector<SingularPoint>& points = dynamics_->singular_points();
    singular_points_.insert(singular_points_.end(), points.begin(), points.end());
    const int stopped_by = dynamics_->stopped_by();
    next_row += dynamics_->next_row();
    rest = grid.from_row(next_row);
    if (total.ok() && dynamics_->paused()) {
      save_and_resume(rows.rows(), next_row);
      continue;
    }
    if (!total.ok() && !contacts_.trouble().empty()) {
      total.status = Status::inconsistent;
      total.message = fmt::format("at t = {:.12g} s: {}", dynamics_->time(), contacts_.trouble());
    }
    const bool jumped = dynamics_->jumped();
    if (!total.ok() || (stopped_by < 0 && !jumped)) return total;
    const bool transition = jumped || watch_->is_transition({stopped_by, 0});
    const Event* event = transition ? nullptr : &watch_->events()[static_cast<std::size_t>(stopped_by)];
    if (event && event->action == EventAction::stop) {
      if (rest.size() > 0)
        total.message = fmt::format("event \"{}\" ended it at t = {:.12g} s", event->name, dynamics_->time());
      return total;
    }
    at_once = dynamics_->time() > last_action ? 1 : at_once + 1;
    last_action = dynamics_->time();
    const bool sum_up_work = needs.work || watch_->needs().work;
    Report next = jumped  ? meet_jump(sum_up_work)
                  : event ? act(*event, sum_up_work)
                          : change_contacts(watch_->transition(stopped_by), sum_up_work);
    if (next.ok() && at_once > most_at_once) {
      next.status = Status::step_too_small;
      next.message =
          fmt::format("{} without end at t = {:.12g} s",
                      event ? fmt::format("event \"{}\" and others follow each other", event->name) : "contacts change",
                      last_action);
    }
    if (!next.ok()) {
      total.status = next.status;
      total.message = next.message;
      return total;
    }
    if (rest.size() == 0) return total;
  }
}

}  // namespace catena
