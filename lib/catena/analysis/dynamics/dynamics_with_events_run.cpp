// A run of DynamicsWithEvents from phase to phase, in one go or in parts.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "catena/analysis/dynamics/dynamics_with_events.hpp"
#include "catena/analysis/motion/stage_watcher.hpp"
#include "catena/analysis/run/report_parts.hpp"

namespace catena {
namespace {

// Events that act this often without time going on would do so for ever; so would contacts that change more often than
// each closes and opens once.
constexpr int most_at_once = 100;

/// Passes rows on and counts them.
class CountingObserver final : public RowObserver {
 public:
  CountingObserver(RowObserver& target, std::int64_t& rows) : target_(target), rows_(rows) {}
  bool observe(const Snapshot& snapshot) override {
    ++rows_;
    return target_.observe(snapshot);
  }
  bool proceed(double t) override { return target_.proceed(t); }
  bool wants_stretches() const override { return target_.wants_stretches(); }
  bool cover(const MotionStretch& stretch) override { return target_.cover(stretch); }
  StageWatcher* stage_watcher() override { return target_.stage_watcher(); }

 private:
  RowObserver& target_;
  std::int64_t& rows_;
};

}  // namespace

AnalysisReport DynamicsWithEvents::run(const TimeGrid& grid, const Needs& needs, RowObserver& observer) {
  begin(grid, needs);
  go_on(grid.size(), observer);
  return end();
}

void DynamicsWithEvents::begin(const TimeGrid& grid, const Needs& needs, std::shared_ptr<std::int64_t> steps) {
  run_.steps = steps ? std::move(steps) : std::make_shared<std::int64_t>(0);
  run_.grid = grid;
  run_.needs = needs;
  run_.rows = rows_before_;
  watch_->rows_given = [this] { return run_.rows; };
  run_.total = {};
  methods_ = {dynamics_->method()};
  run_.total.warnings = inactive_;
  singular_points_.clear();
  end_.reset();
  if (!resumed_) jolts_.clear();
  run_.next_row = first_row_;
  last_action_ = -1;
  at_once_ = 0;
  run_.in_phase = run_.over = false;
  if (!contacts_.any()) {
    tell({.t = dynamics_->time()});
    return;
  }
  if (const Report started = resumed_ ? taken_up_ : start_contacts(); !started.ok()) {
    run_.over = true;
    give_up(started);
    if (started.status == Status::lock_up && contacts_.started() && contacts_.blocked())
      singular_points_.push_back(*contacts_.blocked());
  }
}

void DynamicsWithEvents::begin_phase() {
  run_.in_phase = true;
  if (!watch_->events().empty() || contacts_.any()) dynamics_->watch(watch_.get());
  // The next multiple that lies clearly ahead.
  dynamics_->pause_after((std::floor(dynamics_->time() / pauses_.every * (1 + 1e-12)) + 1) * pauses_.every);
  dynamics_->count_steps_in(run_.steps);
  dynamics_->begin(run_.grid.from_row(run_.next_row), run_.needs);
}

bool DynamicsWithEvents::go_on(std::int64_t rows, RowObserver& observer) {
  CountingObserver counted(observer, run_.rows);
  while (!run_.over) {
    if (!run_.in_phase) begin_phase();
    if (dynamics_->go_on(rows - run_.next_row, counted) && rows < run_.grid.size()) return true;
    run_.over = !end_phase(counted);
  }
  return run_.total.ok() && run_.next_row >= rows;
}

AnalysisReport DynamicsWithEvents::end() {
  if (run_.in_phase) take_report();
  run_.over = true;
  for (const std::string& remark : {contacts_.remark_on_impacts(), contacts_.remark_on_states()}) {
    if (!remark.empty()) run_.total.warnings.push_back(remark);
  }
  return std::move(run_.total);
}

// What the phase that ends has to say.
void DynamicsWithEvents::take_report() {
  run_.in_phase = false;
  add_part(run_.total, dynamics_->end());
  for (const IntegrationMethod method : dynamics_->methods()) {
    if (std::find(methods_.begin(), methods_.end(), method) == methods_.end()) methods_.push_back(method);
  }
  const std::vector<SingularPoint>& points = dynamics_->singular_points();
  singular_points_.insert(singular_points_.end(), points.begin(), points.end());
  jolts_.insert(jolts_.end(), dynamics_->jolts().begin(), dynamics_->jolts().end());
  run_.next_row += dynamics_->next_row();
  if (!run_.total.ok() && !contacts_.trouble().empty()) {
    run_.total.status = Status::inconsistent;
    run_.total.message = fmt::format("at t = {:.12g} s: {}", dynamics_->time(), contacts_.trouble());
  }
}

// The run ends with what a report says. False, always.
bool DynamicsWithEvents::give_up(const Report& report) {
  run_.total.status = report.status;
  run_.total.message = report.message;
  return false;
}

Report DynamicsWithEvents::change(bool acts, const Event*& stop) {
  const bool sum_up_work = run_.needs.work || watch_->needs().work;
  if (dynamics_->jumped()) return meet_jump(sum_up_work);
  if (acts) return act(sum_up_work, stop);
  return change_contacts(watch_->transition(dynamics_->stopped_by()), sum_up_work);
}

bool DynamicsWithEvents::end_phase(RowObserver& rows) {
  take_report();
  const int stopped_by = dynamics_->stopped_by();
  if (run_.total.ok() && dynamics_->paused()) {
    save_and_resume(run_.rows, run_.next_row);
    return taken_up_.ok() || give_up(taken_up_);
  }
  const bool jumped = dynamics_->jumped();
  if (!run_.total.ok() || (stopped_by < 0 && !jumped)) return false;
  const bool acts = !jumped && !watch_->is_transition({stopped_by, 0});
  at_once_ = dynamics_->time() > last_action_ ? 1 : at_once_ + 1;
  last_action_ = dynamics_->time();
  const std::string first = acts ? watch_->events()[static_cast<std::size_t>(stopped_by)].name : std::string();
  const Event* stop = nullptr;
  Report next = change(acts, stop);
  if (next.ok() && stop) {
    if (run_.next_row < run_.grid.size())
      run_.total.message = fmt::format("event \"{}\" ended it at t = {:.12g} s", stop->name, end_->t);
    return false;
  }
  if (next.ok() && at_once_ > most_at_once + 2 * static_cast<int>(contacts_.places())) {
    next.status = Status::step_too_small;
    next.message = fmt::format(
        "{} without end at t = {:.12g} s",
        acts ? fmt::format("event \"{}\" and others follow each other", first) : "contacts change", last_action_);
  }
  if (!next.ok()) {
    give_up(next);
    if (next.status == Status::lock_up) end_in_lock_up(run_.needs, rows);
    return false;
  }
  return run_.next_row < run_.grid.size();
}

}  // namespace catena
