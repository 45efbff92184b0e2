// A run of DynamicsWithEvents from phase to phase, in one go or in parts.
#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "catena/analysis/dynamics/dynamics_with_events.hpp"
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

void DynamicsWithEvents::begin(const TimeGrid& grid, const Needs& needs) {
  grid_ = grid;
  needs_ = needs;
  rows_ = rows_before_;
  watch_->rows_given = [this] { return rows_; };
  total_ = {};
  total_.warnings = inactive_;
  singular_points_.clear();
  end_.reset();
  if (!resumed_) jolts_.clear();
  next_row_ = first_row_;
  last_action_ = -1;
  at_once_ = 0;
  in_phase_ = over_ = false;
  if (!contacts_.any()) {
    tell({.t = dynamics_->time()});
    return;
  }
  if (const Report started = resumed_ ? taken_up_ : start_contacts(); !started.ok()) {
    over_ = true;
    give_up(started);
    if (started.status == Status::lock_up && contacts_.started() && contacts_.blocked())
      singular_points_.push_back(*contacts_.blocked());
  }
}

void DynamicsWithEvents::begin_phase() {
  in_phase_ = true;
  if (!watch_->events().empty() || contacts_.any()) dynamics_->watch(watch_.get());
  // The next multiple that lies clearly ahead.
  dynamics_->pause_after((std::floor(dynamics_->time() / pauses_.every * (1 + 1e-12)) + 1) * pauses_.every);
  dynamics_->begin(grid_.from_row(next_row_), needs_);
}

bool DynamicsWithEvents::go_on(std::int64_t rows, RowObserver& observer) {
  CountingObserver counted(observer, rows_);
  while (!over_) {
    if (!in_phase_) begin_phase();
    if (dynamics_->go_on(rows - next_row_, counted) && rows < grid_.size()) return true;
    over_ = !end_phase(counted);
  }
  return total_.ok() && next_row_ >= rows;
}

AnalysisReport DynamicsWithEvents::end() {
  if (in_phase_) take_report();
  over_ = true;
  if (std::string remark = contacts_.remark_on_impacts(); !remark.empty()) total_.warnings.push_back(std::move(remark));
  return std::move(total_);
}

// What the phase that ends has to say.
void DynamicsWithEvents::take_report() {
  in_phase_ = false;
  add_part(total_, dynamics_->end());
  const std::vector<SingularPoint>& points = dynamics_->singular_points();
  singular_points_.insert(singular_points_.end(), points.begin(), points.end());
  jolts_.insert(jolts_.end(), dynamics_->jolts().begin(), dynamics_->jolts().end());
  next_row_ += dynamics_->next_row();
  if (!total_.ok() && !contacts_.trouble().empty()) {
    total_.status = Status::inconsistent;
    total_.message = fmt::format("at t = {:.12g} s: {}", dynamics_->time(), contacts_.trouble());
  }
}

// The run ends with what a report says. False, always.
bool DynamicsWithEvents::give_up(const Report& report) {
  total_.status = report.status;
  total_.message = report.message;
  return false;
}

Report DynamicsWithEvents::change(bool acts, const Event*& stop) {
  const bool sum_up_work = needs_.work || watch_->needs().work;
  if (dynamics_->jumped()) return meet_jump(sum_up_work);
  if (acts) return act(sum_up_work, stop);
  return change_contacts(watch_->transition(dynamics_->stopped_by()), sum_up_work);
}

bool DynamicsWithEvents::end_phase(RowObserver& rows) {
  take_report();
  const int stopped_by = dynamics_->stopped_by();
  if (total_.ok() && dynamics_->paused()) {
    save_and_resume(rows_, next_row_);
    return taken_up_.ok() || give_up(taken_up_);
  }
  const bool jumped = dynamics_->jumped();
  if (!total_.ok() || (stopped_by < 0 && !jumped)) return false;
  const bool acts = !jumped && !watch_->is_transition({stopped_by, 0});
  at_once_ = dynamics_->time() > last_action_ ? 1 : at_once_ + 1;
  last_action_ = dynamics_->time();
  const std::string first = acts ? watch_->events()[static_cast<std::size_t>(stopped_by)].name : std::string();
  const Event* stop = nullptr;
  Report next = change(acts, stop);
  if (next.ok() && stop) {
    if (next_row_ < grid_.size())
      total_.message = fmt::format("event \"{}\" ended it at t = {:.12g} s", stop->name, end_->t);
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
    if (next.status == Status::lock_up) end_in_lock_up(needs_, rows);
    return false;
  }
  return next_row_ < grid_.size();
}

}  // namespace catena
