// sweep: analyses repeated over values of parameters; one row a design, whatever the number of threads.
//
// Designs are dealt out in order to threads that work in one process on models of their own; their rows are given in
// the order of the designs, held back while an earlier one is under way. A design that cannot be analysed has its
// status and no numbers. Memory holds the rows of a few designs a thread. Where the scene allows, designs are computed
// in lanes, as many side by side as a thread takes at once (lane_designs.hpp); those that leave their lanes are
// analysed by themselves. Which designs are side by side does not depend on the number of threads.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <condition_variable>
#include <cstdio>
#include <exception>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <thread>

#include "catena/analysis/batch/lane_kernels.hpp"
#include "catena/analysis/design/sweep_plan.hpp"
#include "catena/scene/designing/lane_designs.hpp"
#include "catena/scene/designing/measured_design.hpp"

namespace catena {
namespace {

/// What came of one design.
struct SweptDesign {
  std::vector<double> row;
  Status status = Status::ok;
  std::unique_ptr<DesignSink> seen;  // by who draws, if at all
};

class Sweep {
 public:
  explicit Sweep(AnalysisContext& context)
      : context_(context), plan_(context.task.sweep), count_(plan_.designs()), width_(context.task.sweep.over.size()) {
    for (const AnalysisTask& inner : context.task.of) measures_ += inner.measures.size();
  }

  /// Gives all rows in order; returns how many.
  std::int64_t run(int threads);
  const std::map<std::string, std::int64_t>& failed() const { return failed_; }
  bool stopped() const { return stopped_; }
  /// Of the designs that were in lanes, or why none were.
  std::string describe_lanes() const;
  std::int64_t in_lanes() const { return in_lanes_; }

 private:
  SweptDesign begin(std::int64_t k, ParameterSeeds& seeds) const;
  void analyse(std::int64_t k, const ParameterSeeds& seeds, SweptDesign& design) const;
  void finish(SweptDesign& design, Status status, const std::vector<double>& measures) const;
  void work_in_lanes(LaneDesigns& lanes);
  void show(std::int64_t k, SweptDesign& design);
  void work();
  bool take_next(std::int64_t& first, int& count);
  void give(std::int64_t k, SweptDesign design);
  bool cancelled() const { return context_.cancel && context_.cancel->load(std::memory_order_relaxed); }

  AnalysisContext& context_;
  SweepPlan plan_;
  std::int64_t count_;
  std::size_t width_, measures_ = 0;
  // Shared by the threads, behind the mutex.
  std::mutex mutex_;
  std::condition_variable room_;
  std::int64_t next_ = 0, given_ = 0;
  std::map<std::int64_t, SweptDesign> waiting_;
  std::map<std::string, std::int64_t> failed_;
  std::exception_ptr trouble_;
  bool stopped_ = false;
  std::string no_lanes_, why_left_;  // why no design was in lanes; why the first one left
  std::int64_t in_lanes_ = 0, left_ = 0, first_left_ = 0;
  // Rows that may wait for an earlier design, before threads pause.
  static constexpr std::size_t most_waiting = 1024;
};

SweptDesign Sweep::begin(std::int64_t k, ParameterSeeds& seeds) const {
  SweptDesign design;
  design.row.assign(2 + width_ + measures_, std::numeric_limits<double>::quiet_NaN());
  design.row[0] = static_cast<double>(k + 1);
  const auto values = std::span(design.row).subspan(1, width_);
  plan_.values(k, values);
  seeds = context_.seeds;
  for (std::size_t p = 0; p < width_; ++p) seeds.push_back({context_.task.sweep.over[p].parameter, values[p]});
  return design;
}

void Sweep::analyse(std::int64_t k, const ParameterSeeds& seeds, SweptDesign& design) const {
  std::vector<double> measures;
  if (context_.poses) design.seen = context_.poses->watch_design(k, count_);
  const Status status = measure_design(context_, seeds, design.seen.get(), measures);
  finish(design, status, measures);
}

void Sweep::finish(SweptDesign& design, Status status, const std::vector<double>& measures) const {
  design.status = status;
  if (status == Status::ok)
    std::copy(measures.begin(), measures.end(), design.row.begin() + static_cast<std::ptrdiff_t>(1 + width_));
  design.row.back() = static_cast<double>(status);
}

void Sweep::show(std::int64_t k, SweptDesign& design) {
  DesignLabel label{.name = fmt::format("design {}", k + 1), .row = k, .values = {}};
  for (std::size_t p = 0; p < width_; ++p) {
    const auto parameter = static_cast<std::size_t>(context_.task.sweep.over[p].parameter);
    label.values.emplace_back(context_.models->names().all()[parameter], design.row[1 + p]);
  }
  context_.poses->add_design(std::move(label), std::move(design.seen));
}

bool Sweep::take_next(std::int64_t& first, int& count) {
  std::unique_lock lock(mutex_);
  room_.wait(lock, [&] { return stopped_ || waiting_.size() < most_waiting || next_ >= count_; });
  if (stopped_ || next_ >= count_) return false;
  first = next_;
  count = static_cast<int>(std::min<std::int64_t>(count, count_ - next_));
  next_ += count;
  return true;
}

void Sweep::give(std::int64_t k, SweptDesign design) {
  const std::lock_guard lock(mutex_);
  waiting_.emplace(k, std::move(design));
  for (auto first = waiting_.begin(); first != waiting_.end() && first->first == given_ && !stopped_;
       first = waiting_.begin()) {
    SweptDesign& one = first->second;
    if (one.status != Status::ok) ++failed_[std::string(to_string(one.status))];
    if (one.seen) show(given_, one);
    if (!context_.rows.row(one.row)) stopped_ = true;
    waiting_.erase(first);
    ++given_;
    if (context_.progress) context_.progress(static_cast<double>(given_) / static_cast<double>(count_));
  }
  if (cancelled()) stopped_ = true;
  room_.notify_all();
}

void Sweep::work() {
  try {
    std::string why_not;
    if (const std::unique_ptr<LaneDesigns> lanes = LaneDesigns::make(context_, why_not)) {
      work_in_lanes(*lanes);
      return;
    }
    {
      const std::lock_guard lock(mutex_);
      no_lanes_ = why_not;
    }
    std::int64_t k = 0;
    ParameterSeeds seeds;
    for (int count = 1; take_next(k, count);) {
      SweptDesign design = begin(k, seeds);
      analyse(k, seeds, design);
      give(k, std::move(design));
    }
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
  std::array<SweptDesign, static_cast<std::size_t>(lane_count)> designs;
  std::int64_t first = 0;
  for (int count = lane_count; take_next(first, count); count = lane_count) {
    const auto n = static_cast<std::size_t>(count);
    for (std::size_t lane = 0; lane < n; ++lane)
      designs[lane] = begin(first + static_cast<std::int64_t>(lane), seeds[lane]);
    lanes.measure(std::span(seeds).first(n), std::span(outcomes).first(n));
    for (std::size_t lane = 0; lane < n; ++lane) {
      const std::int64_t k = first + static_cast<std::int64_t>(lane);
      const LaneDesigns::Outcome& outcome = outcomes[lane];
      if (outcome.measures)
        finish(designs[lane], Status::ok, *outcome.measures);
      else
        analyse(k, seeds[lane], designs[lane]);
      {
        const std::lock_guard lock(mutex_);
        ++(outcome.measures ? in_lanes_ : left_);
        if (!outcome.measures && (why_left_.empty() || k < first_left_)) {
          first_left_ = k;
          why_left_ = outcome.why_not;
        }
      }
      give(k, std::move(designs[lane]));
    }
  }
}

std::string Sweep::describe_lanes() const {
  if (!no_lanes_.empty()) return fmt::format("no design in lanes: {}", no_lanes_);
  std::string text = fmt::format("{} designs in lanes of {}", in_lanes_, lane_kernels().name);
  if (left_ > 0)
    text += fmt::format(", {} by themselves, the first one design {}: {}", left_, first_left_ + 1, why_left_);
  return text;
}

std::int64_t Sweep::run(int threads) {
  std::vector<std::jthread> others;
  for (int n = 1; n < threads; ++n) others.emplace_back([this] { work(); });
  work();
  others.clear();
  if (trouble_) std::rethrow_exception(trouble_);
  return given_;
}

}  // namespace

void run_sweep(AnalysisContext& context, AnalysisResult& result) {
  const AnalysisTask& task = context.task;
  std::vector<ColumnInfo> info{{"design", UnitKind::none}};
  for (const SweepRange& range : task.sweep.over)
    info.push_back({context.models->names().all()[static_cast<std::size_t>(range.parameter)], UnitKind::own});
  for (const AnalysisTask& inner : task.of) {
    for (const PlacedMeasure& measure : inner.measures) info.push_back({measure.request.name, UnitKind::own});
  }
  info.push_back({"status", UnitKind::none});
  info.back().is_status = true;
  context.rows.begin(info);
  Sweep sweep(context);
  const std::int64_t rows = sweep.run(context.threads);
  if (context.verbose) fmt::print(stderr, "sweep: {}\n", sweep.describe_lanes());
  if (sweep.stopped()) {
    result.report.status = Status::cancelled;
    result.report.message = fmt::format("stopped after {} designs; their rows are kept", rows);
  }
  FieldRecord failed;
  std::int64_t failures = 0;
  for (const auto& [status, count] : sweep.failed()) {
    failed.emplace_back(status, count);
    failures += count;
  }
  if (failures > 0)
    result.report.warnings.push_back(
        fmt::format("{} of {} designs could not be analysed: see their status", failures, rows));
  result.has_rows = true;
  result.columns = std::move(info);
  result.rows = rows;
  result.fields.push_back({"designs", rows});
  result.fields.push_back({"failed", std::move(failed)});
  result.fields.push_back({"in_lanes", sweep.in_lanes()});
}

}  // namespace catena
