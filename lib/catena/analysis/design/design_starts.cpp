#include "catena/analysis/design/design_starts.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <random>
#include <thread>

#include "catena/base/at.hpp"

namespace catena {
namespace {

/// Of the given start for number 0, random within the bounds for others; in parts of the ranges.
std::vector<std::vector<double>> starts_of(const DesignProblem& problem, const DesignOptions& options) {
  std::mt19937_64 random(options.seed);
  std::vector<std::vector<double>> starts;
  for (int number = 0; number < options.starts; ++number) {
    std::vector<double>& u = starts.emplace_back(problem.start.size());
    for (std::size_t v = 0; v < u.size(); ++v) {
      // The same numbers on every machine: 53 bits of the generator's own.
      const double any = static_cast<double>(random() >> 11) * 0x1.0p-53;
      u[v] = number > 0 ? any : (problem.start[v] - problem.lower[v]) / (problem.upper[v] - problem.lower[v]);
    }
  }
  return starts;
}

/// The searches beside the first one.
class OtherStarts {
 public:
  OtherStarts(const DesignProblem& problem, const DesignOptions& options, DesignSearch& search,
              std::vector<std::vector<double>> starts, int evaluations)
      : problem_(problem), options_(options), search_(search), starts_(std::move(starts)), trials_(starts_.size()) {
    // None can count more designs than the first start leaves.
    options_.max_evaluations -= evaluations;
    options_.improved = {};
  }

  /// Takes one start after the other, until there are no more.
  void work() {
    for (std::size_t k = next_++; k < trials_.size(); k = next_++) {
      Trial& trial = trials_[k];
      try {
        if (!enough_) run(trial, starts_[k]);
      } catch (...) {
        const std::lock_guard lock(mutex_);
        if (!thrown_) thrown_ = std::current_exception();
        enough_ = true;
      }
      const std::lock_guard lock(mutex_);
      trial.done = true;
      put_together();
    }
  }
  /// The first start is done: what others found may follow. `end`: how it ended.
  void follow(MinimiserEnd end) {
    const std::lock_guard lock(mutex_);
    end_ = end;
    if (!search_.go_on()) enough_ = true;  // there are no designs left for others
    put_together();
  }
  /// How the search that found the best design ended, once all are done.
  MinimiserEnd end() const {
    if (thrown_) std::rethrow_exception(thrown_);
    return *end_;
  }

 private:
  struct Trial {
    DesignOutcome outcome{};
    std::optional<DesignSearch> search{};
    MinimiserEnd end = MinimiserEnd::failed;
    bool done = false;
  };

  void run(Trial& trial, std::vector<double> u) {
    trial.search.emplace(problem_, options_, trial.outcome);
    trial.search->take_sizes(search_);
    if (!trial.search->go_on() || !trial.search->begin(u)) return;
    trial.end = minimise(*trial.search, minimiser_options(options_, trial.outcome.evaluations, u.size()), u);
  }

  void put_together() {
    for (; end_ && first_ < trials_.size() && trials_[first_].done; ++first_) {
      Trial& trial = trials_[first_];
      if (!trial.search || !search_.go_on()) {
        enough_ = true;  // none of those that follow counts
        continue;
      }
      const int improvements = search_.improvements();
      const bool all = search_.absorb(*trial.search);
      if (search_.improvements() > improvements) end_ = all ? trial.end : MinimiserEnd::slow;
      trial.search.reset();
    }
  }

  const DesignProblem& problem_;
  DesignOptions options_;
  DesignSearch& search_;  // of the first start; all come together there
  const std::vector<std::vector<double>> starts_;
  std::vector<Trial> trials_;
  std::atomic<std::size_t> next_ = 0;
  std::atomic<bool> enough_ = false;
  // Behind the mutex.
  std::mutex mutex_;
  std::size_t first_ = 0;  // of those not put together
  std::optional<MinimiserEnd> end_;
  std::exception_ptr thrown_;
};

}  // namespace

MinimiserOptions minimiser_options(const DesignOptions& options, int evaluations, std::size_t variables) {
  return {.method = options.method,
          .lower = std::vector<double>(variables, 0.0),
          .upper = std::vector<double>(variables, 1.0),
          .x_tolerance = options.tolerance,
          .f_tolerance = part_of_gain * options.tolerance,
          .constraint_tolerance = options.tolerance,
          .max_evaluations = std::max(1, options.max_evaluations - evaluations),
          .seed = options.seed};
}

std::optional<MinimiserEnd> search_from_all_starts(const DesignProblem& problem, const DesignOptions& options,
                                                   DesignSearch& search, const DesignOutcome& outcome) {
  std::vector<std::vector<double>> starts = starts_of(problem, options);
  std::size_t k = 0;
  while (k < starts.size() && (k == 0 || search.go_on()) && !search.begin(starts[k])) ++k;
  if (outcome.x.empty()) return {};
  std::vector<double> u = starts[k];
  starts.erase(starts.begin(), starts.begin() + static_cast<std::ptrdiff_t>(k) + 1);
  const int other_threads = std::min(options.threads - 1, static_cast<int>(starts.size()));
  OtherStarts others(problem, options, search, std::move(starts), outcome.evaluations);
  const MinimiserOptions wanted = minimiser_options(options, outcome.evaluations, u.size());
  {
    std::vector<std::jthread> threads;
    for (int n = 0; n < other_threads; ++n) threads.emplace_back([&] { others.work(); });
    others.follow(minimise(search, wanted, u));
    others.work();
  }
  return others.end();
}

}  // namespace catena
