// Designs in lanes for processes that are handed single ones: those that would stand side by side in one process are
// computed together by the first that asks for one of them, so that the numbers of a design depend on no other process.
//
//   group of design k = floor(k / lane_count)
//
// A thread that asks for a design of a group under way waits for it.
#pragma once

#include <array>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "catena/scene/designing/lane_designs.hpp"

namespace catena {

class LaneGroups {
 public:
  /// `designs`: how many there are; `seeds_of`: the parameters of one. `context` must outlive it.
  LaneGroups(const AnalysisContext& context, std::int64_t designs, std::function<ParameterSeeds(std::int64_t)> seeds_of)
      : context_(context), designs_(designs), seeds_of_(std::move(seeds_of)) {}

  /// Measures of design k; nothing where it is to be analysed by itself. Any number of threads may ask at once.
  std::optional<std::vector<double>> measures_of(std::int64_t k);

 private:
  struct Group {
    bool is_ready = false;
    std::array<LaneDesigns::Outcome, static_cast<std::size_t>(lane_count)> outcomes{};
  };
  void measure(std::int64_t number, Group& group);

  const AnalysisContext& context_;
  std::int64_t designs_;
  std::function<ParameterSeeds(std::int64_t)> seeds_of_;
  std::mutex mutex_;
  std::condition_variable done_;
  std::map<std::int64_t, std::shared_ptr<Group>> groups_;
  std::vector<std::unique_ptr<LaneDesigns>> idle_;
  bool is_impossible_ = false;
};

}  // namespace catena
