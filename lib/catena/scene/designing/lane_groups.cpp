#include "catena/scene/designing/lane_groups.hpp"

#include <algorithm>

namespace catena {
namespace {

// Groups that are remembered: a process has at most a few hundred designs at hand, in order.
constexpr std::size_t most_groups = 256;

}  // namespace

void LaneGroups::measure(std::int64_t number, Group& group) {
  std::unique_ptr<LaneDesigns> lanes;
  {
    const std::lock_guard lock(mutex_);
    if (!idle_.empty()) {
      lanes = std::move(idle_.back());
      idle_.pop_back();
    }
  }
  std::string why_not;
  if (!lanes) lanes = LaneDesigns::make(context_, why_not);
  if (lanes) {
    const std::int64_t first = number * lane_count;
    std::vector<ParameterSeeds> seeds;
    for (std::int64_t k = first; k < std::min(first + lane_count, designs_); ++k) seeds.push_back(seeds_of_(k));
    lanes->measure(seeds, std::span(group.outcomes).first(seeds.size()));
  }
  const std::lock_guard lock(mutex_);
  if (lanes)
    idle_.push_back(std::move(lanes));
  else
    is_impossible_ = true;
}

std::optional<std::vector<double>> LaneGroups::measures_of(std::int64_t k) {
  const std::int64_t number = k / lane_count;
  std::unique_lock lock(mutex_);
  if (is_impossible_) return {};
  std::shared_ptr<Group>& place = groups_[number];
  const bool is_new = !place;
  if (is_new) place = std::make_shared<Group>();
  const std::shared_ptr<Group> group = place;
  if (!is_new) {
    done_.wait(lock, [&] { return group->is_ready; });
    return group->outcomes[static_cast<std::size_t>(k % lane_count)].measures;
  }
  lock.unlock();
  const auto finish = [&] {
    const std::lock_guard again(mutex_);
    group->is_ready = true;
    for (auto old = groups_.begin(); groups_.size() > most_groups && old != groups_.end();)
      old = old->second->is_ready && old->first != number ? groups_.erase(old) : std::next(old);
    done_.notify_all();
  };
  try {
    measure(number, *group);
  } catch (...) {
    finish();
    throw;
  }
  finish();
  return group->outcomes[static_cast<std::size_t>(k % lane_count)].measures;
}

}  // namespace catena
