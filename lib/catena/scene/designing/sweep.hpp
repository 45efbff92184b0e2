// A sweep at work: designs are dealt out in order to threads that work in one process on models of their own, and to
// other processes (sweep_crew.hpp); their rows are given in the order of the designs, held back while an earlier one is
// under way. A design that cannot be analysed has its status and no numbers, and its reason in the list of failures.
// Memory holds the rows of a few designs a thread. Finished designs are kept in a record, if there is one, and taken
// from it.
//
// Where the scene allows, designs are computed in lanes, as many side by side as a thread takes at once
// (lane_designs.hpp); those that leave their lanes are analysed by themselves. Which designs are side by side depends
// neither on the number of threads and processes nor on what the record has (lane_groups.hpp).
#pragma once

#include <algorithm>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "catena/analysis/design/process_link.hpp"
#include "catena/analysis/design/sweep_plan.hpp"
#include "catena/results/failure_list.hpp"
#include "catena/scene/designing/lane_designs.hpp"
#include "catena/scene/designing/lane_groups.hpp"
#include "catena/scene/designing/scatter.hpp"
#include "catena/scene/models/sweep_record.hpp"

namespace catena {

/// What came of one design.
struct SweptDesign : SweepRecord::Design {
  std::unique_ptr<DesignSink> seen{};  // by a pose sink, if there is one
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
  /// Of a sweep that was stopped: the designs that have no row, and how far they had come.
  std::string describe_missing() const;
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

}  // namespace catena
