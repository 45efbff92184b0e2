// Sweep: what comes of a design, in a lane or by itself.
#include <fmt/format.h>

#include <array>
#include <limits>
#include <set>

#include "catena/analysis/batch/kernels/lane_kernels.hpp"
#include "catena/scene/designing/design_ranges.hpp"
#include "catena/scene/designing/measured_design.hpp"
#include "catena/scene/designing/sweep.hpp"

namespace catena {

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

std::string Sweep::describe_missing() const {
  std::set<std::int64_t> under_way, finished;
  for (std::int64_t k = given_; k < next_; ++k) (waiting_.contains(k) ? finished : under_way).insert(k);
  std::vector<std::string> parts;
  if (!under_way.empty()) parts.push_back(fmt::format("{} under way", design_ranges(under_way)));
  if (!finished.empty()) parts.push_back(fmt::format("{} finished behind these", design_ranges(finished)));
  if (next_ < count_) parts.push_back(fmt::format("{} to {} not begun", next_ + 1, count_));
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : "; ") + part;
  return text;
}

std::string Sweep::describe_lanes() const {
  if (!no_lanes_.empty()) return fmt::format("no design in lanes: {}", no_lanes_);
  std::string text = fmt::format("{} designs in lanes of {}", in_lanes_, lane_kernels().name);
  if (left_ > 0)
    text += fmt::format(", {} by themselves, the first one design {}: {}", left_, first_left_ + 1, why_left_);
  return text;
}

}  // namespace catena
