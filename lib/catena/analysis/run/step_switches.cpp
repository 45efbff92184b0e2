#include "catena/analysis/run/step_switches.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "catena/analysis/run/cable_slack.hpp"

namespace catena {

void StepSwitches::begin_step(double t) {
  for (std::size_t k = count_; k-- > 0;) {
    if (samples_[k].t != t) continue;
    std::swap(samples_[0], samples_[k]);
    count_ = 1;
    return;
  }
  count_ = 0;
}

void StepSwitches::find_what_switches() {
  if (known_) return;
  known_ = true;
  laws_.begin(evaluator_);
  for_each_slack(evaluator_, [this](double, double, int) { cables_ = true; });
}

bool StepSwitches::has_cables() {
  find_what_switches();
  return cables_;
}

void StepSwitches::note(double t, std::span<const double> qd) {
  find_what_switches();
  if (!laws_.any() && !cables_) return;
  std::size_t k = 0;
  while (k < count_ && samples_[k].t != t) ++k;
  if (k == samples_.size()) return;
  count_ = std::max(count_, k + 1);
  Sample& sample = samples_[k];
  sample.t = t;
  if (laws_.any()) laws_.read(qd, sample.of_laws);
  sample.of_cables.clear();
  if (cables_) for_each_slack(evaluator_, [&sample](double slack, double, int) { sample.of_cables.push_back(slack); });
}

StepSwitches::Found StepSwitches::found() const {
  if (count_ < 2) return {};
  return {.laws = laws_.any() && may_switch(&Sample::of_laws), .cables = cables_ && may_switch(&Sample::of_cables)};
}

bool StepSwitches::may_switch(Values values) const {
  std::array<std::size_t, std::tuple_size_v<decltype(samples_)>> order{};
  std::iota(order.begin(), order.end(), std::size_t{0});
  const std::span<std::size_t> taken(order.data(), count_);
  std::sort(taken.begin(), taken.end(), [this](std::size_t a, std::size_t b) { return samples_[a].t < samples_[b].t; });
  std::array<double, std::tuple_size_v<decltype(samples_)>> t{}, v{};
  for (std::size_t d = 0; d < (samples_[0].*values).size(); ++d) {
    for (std::size_t k = 0; k < count_; ++k) {
      t[k] = samples_[taken[k]].t;
      v[k] = (samples_[taken[k]].*values)[d];
    }
    if (LawSwitches::may_switch(std::span<const double>(t).first(count_), std::span<const double>(v).first(count_)))
      return true;
  }
  return false;
}

}  // namespace catena
