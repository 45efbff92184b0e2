// sweep: analyses repeated over values of parameters; one row a design, whatever the number of threads and processes.
//
// Designs are dealt out in order to threads that work in one process on models of their own, and to other processes
// (sweep_crew.hpp); their rows are given in the order of the designs, held back while an earlier one is under way. A
// design that cannot be analysed has its status and no numbers, and its reason in the list of failures. Memory holds
// the rows of a few designs a thread. Finished designs are kept in a record, if there is one, and taken from it.
//
// Where the scene allows, designs are computed in lanes, as many side by side as a thread takes at once
// (lane_designs.hpp); those that leave their lanes are analysed by themselves. Which designs are side by side depends
// neither on the number of threads and processes nor on what the record has (lane_groups.hpp).
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <condition_variable>
#include <cstdio>
#include <deque>
#include <exception>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <thread>

#include "catena/analysis/batch/lane_kernels.hpp"
#include "catena/analysis/design/process_link.hpp"
#include "catena/analysis/design/sweep_plan.hpp"
#include "catena/results/failure_list.hpp"
#include "catena/scene/designing/lane_designs.hpp"
#include "catena/scene/designing/lane_groups.hpp"
#include "catena/scene/designing/measured_design.hpp"
#include "catena/scene/designing/scatter.hpp"
#include "catena/scene/designing/sweep_crew.hpp"
#include "catena/scene/models/sweep_record.hpp"

namespace catena {
namespace {

/// What came of one design.
struct SweptDesign : SweepRecord::Design {
  std::unique_ptr<DesignSink> seen{};  // by who draws, if at all
  bool is_recorded = false;            // it comes from the record
};

class Sweep {
 public:
  explicit Sweep(AnalysisContext& context)
      : context_(context),
        plan_(std::make_shared<SweepPlan>(context.task.sweep)),
        count_(plan_->designs()),
        width_(context.task.sweep.over.size()),
        failures_(std::make_shared<FailureList>(
            parameters(), [plan = plan_](std::int64_t k, std::span<double> out) { plan->values(k, out); })) {
    for (const AnalysisTask& inner : context.task.of) measures_ += inner.measures.size();
    if (Scatter::is_meant(context.task.sweep) && measures_ > 0) scatter_.emplace(measures_);
    if (context.sweep.link) groups_.emplace(context, count_, [this](std::int64_t k) { return seeds_of(k); });
    if (leads()) most_waiting_ *= static_cast<std::size_t>(context.sweep.link->size());
  }

  /// Gives all rows in order; returns how many. A process that another one leads gives none.
  std::int64_t run(int threads);
  const std::map<std::string, std::int64_t>& failed() const { return failed_; }
  std::shared_ptr<const LongList> failures() const { return failures_; }
  const std::optional<Scatter>& scatter() const { return scatter_; }
  bool stopped() const { return stopped_; }
  /// Of the designs that were in lanes, or why none were.
  std::string describe_lanes() const;
  std::int64_t in_lanes() const { return in_lanes_; }
  std::int64_t designs() const { return count_; }
  /// What is to be said of other processes.
  const std::vector<std::string>& troubles() const { return troubles_; }
  /// Names of the parameters.
  std::vector<std::string> parameters() const;
  bool leads() const { return context_.sweep.link && context_.sweep.link->rank() == 0; }
  bool follows() const { return context_.sweep.link && context_.sweep.link->rank() > 0; }

 private:
  ParameterSeeds seeds_of(std::int64_t k) const;
  std::optional<SweepRecord::Design> recorded(std::int64_t k) const;
  SweptDesign analyse(std::int64_t k);
  void work_in_lanes(LaneDesigns& lanes);
  void take_lane(std::int64_t k, LaneDesigns::Outcome& outcome);
  std::vector<double> row_of(std::int64_t k, const SweptDesign& design) const;
  void show(std::int64_t k, const std::vector<double>& row, SweptDesign& design);
  void work();
  void follow(int threads);
  void lead();
  bool may_take() const;
  std::int64_t next();
  bool take_next(std::int64_t& first, int& count);
  void give(std::int64_t k, SweptDesign design);
  void give_foreign(std::int64_t k, SweepRecord::Design found);
  bool ended() const { return stopped_ || given_ >= count_; }
  bool cancelled() const { return context_.cancel && context_.cancel->load(std::memory_order_relaxed); }

  AnalysisContext& context_;
  std::shared_ptr<const SweepPlan> plan_;
  std::int64_t count_;
  std::size_t width_, measures_ = 0;
  // Rows that may wait for an earlier design, before threads pause.
  std::size_t most_waiting_ = 1024;
  std::vector<std::string> troubles_;
  // Shared by the threads, behind the mutex.
  std::mutex mutex_;
  std::condition_variable room_;
  std::int64_t next_ = 0, given_ = 0;
  std::deque<std::int64_t> again_;  // designs that a lost process had
  std::map<std::int64_t, SweptDesign> waiting_;
  std::map<std::string, std::int64_t> failed_;
  std::shared_ptr<FailureList> failures_;
  std::optional<Scatter> scatter_;
  std::exception_ptr trouble_;
  bool stopped_ = false;
  std::string no_lanes_, why_left_;  // why no design was in lanes; why the first one left
  std::int64_t in_lanes_ = 0, left_ = 0, first_left_ = 0;
  std::optional<LaneGroups> groups_;  // where other processes take part
};

std::vector<std::string> Sweep::parameters() const {
  std::vector<std::string> names;
  for (const SweepRange& range : context_.task.sweep.over)
    names.push_back(context_.models->names().all()[static_cast<std::size_t>(range.parameter)]);
  return names;
}

ParameterSeeds Sweep::seeds_of(std::int64_t k) const {
  std::vector<double> values(width_);
  plan_->values(k, values);
  ParameterSeeds seeds = context_.seeds;
  for (std::size_t p = 0; p < width_; ++p) seeds.push_back({context_.task.sweep.over[p].parameter, values[p]});
  return seeds;
}

std::optional<SweepRecord::Design> Sweep::recorded(std::int64_t k) const {
  const SweepRecord* record = context_.sweep.record;
  return record ? record->find(context_.sweep.analysis, k + 1, measures_) : std::nullopt;
}

SweptDesign Sweep::analyse(std::int64_t k) {
  SweptDesign design;
  if (context_.poses) design.seen = context_.poses->watch_design(k, count_);
  std::optional<SweepRecord::Design> known = recorded(k);
  design.is_recorded = known.has_value();
  // A design that is drawn is analysed in any case.
  if (known && !design.seen) {
    static_cast<SweepRecord::Design&>(design) = std::move(*known);
    return design;
  }
  if (auto measures = groups_ && !design.seen ? groups_->measures_of(k) : std::nullopt) {
    design.status = Status::ok;
    design.measures = std::move(*measures);
    return design;
  }
  design.status = measure_design(context_, seeds_of(k), design.seen.get(), design.measures, design.message);
  if (design.status != Status::ok) design.measures.clear();
  return design;
}

std::vector<double> Sweep::row_of(std::int64_t k, const SweptDesign& design) const {
  std::vector<double> row(2 + width_ + measures_, std::numeric_limits<double>::quiet_NaN());
  row[0] = static_cast<double>(k + 1);
  plan_->values(k, std::span(row).subspan(1, width_));
  std::copy(design.measures.begin(), design.measures.end(), row.begin() + static_cast<std::ptrdiff_t>(1 + width_));
  row.back() = static_cast<double>(design.status);
  return row;
}

void Sweep::show(std::int64_t k, const std::vector<double>& row, SweptDesign& design) {
  DesignLabel label{.name = fmt::format("design {}", k + 1), .row = k, .values = {}};
  const std::vector<std::string> names = parameters();
  for (std::size_t p = 0; p < width_; ++p) label.values.emplace_back(names[p], row[1 + p]);
  context_.poses->add_design(std::move(label), std::move(design.seen));
}

// Designs that were lost are taken first, however many rows wait: for them, it may be.
bool Sweep::may_take() const { return !again_.empty() || (next_ < count_ && waiting_.size() < most_waiting_); }

std::int64_t Sweep::next() {
  if (again_.empty()) return next_++;
  const std::int64_t k = again_.front();
  again_.pop_front();
  return k;
}

bool Sweep::take_next(std::int64_t& first, int& count) {
  std::unique_lock lock(mutex_);
  room_.wait(lock, [&] { return ended() || may_take(); });
  if (ended()) return false;
  first = next();
  // Several at once only where none can be lost: they stand side by side.
  count = static_cast<int>(std::min<std::int64_t>(count, count_ - first));
  if (count > 1) next_ += count - 1;
  return true;
}

void Sweep::give(std::int64_t k, SweptDesign design) {
  // One that was stopped on the way is not done.
  const bool is_done = design.status != Status::cancelled || !cancelled();
  // One that was lost may come from two processes after all.
  const auto is_new = [&] { return is_done && k >= given_ && !waiting_.contains(k); };
  std::unique_lock lock(mutex_);
  if (SweepRecord* record = context_.sweep.record; record && is_new() && !design.is_recorded) {
    lock.unlock();
    record->add(context_.sweep.analysis, k + 1, design);
    lock.lock();
  }
  if (is_new()) waiting_.emplace(k, std::move(design));
  for (auto first = waiting_.begin(); first != waiting_.end() && first->first == given_ && !stopped_;
       first = waiting_.begin()) {
    SweptDesign& one = first->second;
    if (one.status != Status::ok) {
      ++failed_[std::string(to_string(one.status))];
      failures_->add(given_, one.status, one.message);
    }
    if (scatter_ && one.status == Status::ok) scatter_->add(one.measures);
    const std::vector<double> row = row_of(given_, one);
    if (one.seen) show(given_, row, one);
    if (!context_.rows.row(row)) stopped_ = true;
    waiting_.erase(first);
    ++given_;
    if (context_.progress) context_.progress(static_cast<double>(given_) / static_cast<double>(count_));
  }
  if (cancelled() && given_ < count_) stopped_ = true;
  room_.notify_all();
}

void Sweep::work() {
  try {
    std::string why_not;
    const std::unique_ptr<LaneDesigns> lanes = context_.sweep.link ? nullptr : LaneDesigns::make(context_, why_not);
    if (lanes) {
      work_in_lanes(*lanes);
      return;
    }
    {
      const std::lock_guard lock(mutex_);
      no_lanes_ = why_not;
    }
    std::int64_t k = 0;
    for (int count = 1; take_next(k, count);) give(k, analyse(k));
  } catch (...) {
    const std::lock_guard lock(mutex_);
    if (!trouble_) trouble_ = std::current_exception();
    stopped_ = true;
    room_.notify_all();
  }
}

void Sweep::work_in_lanes(LaneDesigns& lanes) {
  std::array<ParameterSeeds, static_cast<std::size_t>(lane_count)> seeds;
  std::array<LaneDesigns::Outcome, static_cast<std::size_t>(lane_count)> outcomes;
  std::array<std::optional<SweepRecord::Design>, static_cast<std::size_t>(lane_count)> known;
  std::int64_t first = 0;
  for (int count = lane_count; take_next(first, count); count = lane_count) {
    const auto n = static_cast<std::size_t>(count);
    bool all_known = true;
    for (std::size_t lane = 0; lane < n; ++lane) {
      const std::int64_t k = first + static_cast<std::int64_t>(lane);
      seeds[lane] = seeds_of(k);
      known[lane] = recorded(k);
      all_known = all_known && known[lane];
    }
    // Beside others that are in the record, those that are not stand in the lanes that they would have had.
    if (!all_known) lanes.measure(std::span(seeds).first(n), std::span(outcomes).first(n));
    for (std::size_t lane = 0; lane < n; ++lane) {
      const std::int64_t k = first + static_cast<std::int64_t>(lane);
      if (known[lane])
        give(k, {std::move(*known[lane]), nullptr, true});
      else
        take_lane(k, outcomes[lane]);
    }
  }
}

void Sweep::take_lane(std::int64_t k, LaneDesigns::Outcome& outcome) {
  {
    const std::lock_guard lock(mutex_);
    ++(outcome.measures ? in_lanes_ : left_);
    if (!outcome.measures && (why_left_.empty() || k < first_left_)) {
      first_left_ = k;
      why_left_ = outcome.why_not;
    }
  }
  SweptDesign design;
  if (outcome.measures) {
    design.status = Status::ok;
    design.measures = std::move(*outcome.measures);
  } else {
    design = analyse(k);
  }
  give(k, std::move(design));
}

std::string Sweep::describe_lanes() const {
  if (!no_lanes_.empty()) return fmt::format("no design in lanes: {}", no_lanes_);
  std::string text = fmt::format("{} designs in lanes of {}", in_lanes_, lane_kernels().name);
  if (left_ > 0)
    text += fmt::format(", {} by themselves, the first one design {}: {}", left_, first_left_ + 1, why_left_);
  return text;
}

// What another process found. A design that is drawn is analysed here once more, unless it was refused: by the scene,
// or because processes ended while they had it.
void Sweep::give_foreign(std::int64_t k, SweepRecord::Design found) {
  if (found.status == Status::cancelled) {
    // That process alone was told to end: another one analyses the design.
    const std::lock_guard lock(mutex_);
    again_.push_back(k);
    room_.notify_all();
    return;
  }
  SweptDesign design;
  if (context_.poses && found.status != Status::refused) design.seen = context_.poses->watch_design(k, count_);
  if (design.seen) {
    design = analyse(k);
  } else {
    static_cast<SweepRecord::Design&>(design) = std::move(found);
  }
  give(k, std::move(design));
}

void Sweep::lead() {
  const SweepRecord* record = context_.sweep.record;
  const CrewDesk desk{.take =
                          [&](std::int64_t& k) {
                            for (;;) {
                              {
                                const std::lock_guard lock(mutex_);
                                if (ended() || !may_take()) return false;
                                k = next();
                              }
                              if (!record || !record->find(context_.sweep.analysis, k + 1, measures_)) return true;
                              give(k, analyse(k));
                            }
                          },
                      .give = [&](std::int64_t k, auto found) { give_foreign(k, std::move(found)); },
                      .put_back =
                          [&](std::int64_t k) {
                            const std::lock_guard lock(mutex_);
                            again_.push_back(k);
                            room_.notify_all();
                          },
                      .done =
                          [&] {
                            const std::lock_guard lock(mutex_);
                            stopped_ = stopped_ || (cancelled() && given_ < count_);
                            if (ended()) room_.notify_all();
                            return ended();
                          }};
  troubles_ =
      lead_crew(*context_.sweep.link, desk, {context_.sweep.analysis, context_.sweep.owner, context_.sweep.patience});
}

void Sweep::follow(int threads) {
  const auto analyse_one = [&](std::int64_t k) -> SweepRecord::Design { return analyse(k); };
  follow_crew(*context_.sweep.link, analyse_one, threads, [&] { return cancelled(); },
              {context_.sweep.analysis, context_.sweep.owner, context_.sweep.patience});
}

std::int64_t Sweep::run(int threads) {
  if (follows()) return follow(threads), 0;
  std::vector<std::jthread> others;
  for (int n = leads() ? 0 : 1; n < threads; ++n) others.emplace_back([this] { work(); });
  if (leads()) {
    try {
      lead();
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!trouble_) trouble_ = std::current_exception();
      stopped_ = true;
      room_.notify_all();
    }
  } else {
    work();
  }
  others.clear();
  if (trouble_) std::rethrow_exception(trouble_);
  return given_;
}

/// What a sweep that was stopped says.
std::string stopped_text(const AnalysisContext& context, std::int64_t rows, std::int64_t designs) {
  std::string text = fmt::format("stopped after {} of {} designs; their rows are kept", rows, designs);
  if (const SweepRecord* record = context.sweep.record)
    text +=
        fmt::format(". The record \"{}\" has {} designs: --resume goes on from them", record->path(), record->size());
  return text;
}

}  // namespace

void run_sweep(AnalysisContext& context, AnalysisResult& result) {
  const AnalysisTask& task = context.task;
  std::vector<ColumnInfo> info{{"design", UnitKind::none}};
  Sweep sweep(context);
  for (std::string& name : sweep.parameters()) info.push_back({std::move(name), UnitKind::own});
  for (const AnalysisTask& inner : task.of) {
    for (const PlacedMeasure& measure : inner.measures) info.push_back({measure.request.name, UnitKind::own});
  }
  info.push_back({"status", UnitKind::none});
  info.back().is_status = true;
  if (!sweep.follows()) context.rows.begin(info);
  const std::int64_t rows = sweep.run(context.threads);
  if (context.verbose && !context.sweep.link) fmt::print(stderr, "sweep: {}\n", sweep.describe_lanes());
  if (sweep.stopped()) {
    result.report.status = Status::cancelled;
    result.report.message = stopped_text(context, rows, sweep.designs());
  }
  if (sweep.follows()) return;
  for (const std::string& trouble : sweep.troubles()) result.report.warnings.push_back(trouble);
  FieldRecord failed;
  std::int64_t failures = 0;
  for (const auto& [status, count] : sweep.failed()) {
    failed.emplace_back(status, count);
    failures += count;
  }
  if (failures > 0)
    result.report.warnings.push_back(
        fmt::format("{} of {} designs could not be analysed: \"failures\" has their reasons", failures, rows));
  result.has_rows = true;
  result.columns = std::move(info);
  result.rows = rows;
  result.fields.push_back({"designs", rows});
  result.fields.push_back({"failed", std::move(failed)});
  // What other processes had in lanes is not known.
  if (!context.sweep.link) result.fields.push_back({"in_lanes", sweep.in_lanes()});
  result.fields.push_back({"failures", sweep.failures()});
  if (sweep.scatter() && !sweep.stopped())
    result.fields.push_back({"scatter", sweep.scatter()->records(context, result.report.warnings)});
}

}  // namespace catena
