#include "catena/assembly/equations.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "catena/base/at.hpp"
#include "catena/base/sincos.hpp"
#include "catena/elements/all.hpp"

namespace catena {
namespace {

// Calls f(block, data) for every constraint type that has elements.
template <class Blocks, class Values, class F>
void for_each_present_block(const Blocks& blocks, const Values& values, F&& f) {
  for_each_list(blocks, values, [&](const auto& block, const auto& data, int) {
    if (block.size() > 0) f(block, data);
  });
}

template <class Block>
using OperationsOf = ConstraintOperations<typename Block::Element>;

}  // namespace

void Equations::set_time(Pose& pose, double t, Side side) const {
  if (t < pose.run.first) return set_time_along(pose, t, pose.run.first);
  if (t > pose.run.last) return set_time_along(pose, t, pose.run.last);
  pose.time = t;
  if (model_->functions.empty()) return;
  for (std::size_t k = 0; k < pose.functions.size(); ++k) pose.functions[k] = model_->functions[k].evaluate(t, side);
  spread_functions(pose);
}

void Equations::set_time_along(Pose& pose, double t, double from) const {
  pose.time = t;
  if (model_->functions.empty()) return;
  const TimeRange& run = pose.run;
  from = std::clamp(from, run.first, run.last);
  // At the end of a run the piece that holds before it, everywhere else the one that begins.
  const Side side = from == run.last && run.first < run.last ? Side::before : Side::after;
  for (std::size_t k = 0; k < pose.functions.size(); ++k)
    pose.functions[k] = model_->functions[k].continue_from(from, side, t);
  spread_functions(pose);
}

void Equations::spread_functions(Pose& pose) const {
  for_each_list(plan_->blocks, constraints_, [&](const auto& block, const auto& data, int) {
    for (const auto& timed : data.timed)
      pose.values[at(block.first_value + timed.element)] = pose.functions[at(timed.function)];
  });
  for_each_list(plan_->forces, forces_, [&](const auto& block, const auto& data, int) {
    for (const auto& timed : data.timed) {
      const std::size_t place = at(block.first_value + timed.place);
      pose.loads[place] = pose.functions[at(timed.function)].f;
      pose.load_rates[place] = pose.functions[at(timed.function)].d;
    }
  });
}

void Equations::set_configuration(Pose& pose, std::span<const double> q) const {
  update_frames(q.first(at(3 * plan_->moving)), std::span(pose.frames).first(at(plan_->moving)));
  for (std::size_t b = 0; b < pose.turns.size(); ++b) pose.frames[b].phi += pose.turns[b] * (2 * std::numbers::pi);
  stretch_ropes(pose);
  if (!pose.starts.empty()) {
    follow(pose, pose.starts);
    pose.contacts = pose.starts;
  }
}

void Equations::take_turns(Pose& pose, std::span<double> q) const {
  constexpr double low_part = 2.4492935982947064e-16;  // of 2 pi, below the double
  std::vector<int>& taken = pose.turns;
  taken.reserve(at(plan_->moving));  // now, not in the middle of a run
  for (int b = 0; b < plan_->moving; ++b) {
    double& angle = q[at(3 * b + 2)];
    if (!(std::abs(angle) > 1.5 * std::numbers::pi)) continue;
    if (taken.empty()) taken.assign(at(plan_->moving), 0);
    const double turns = std::round(angle / (2 * std::numbers::pi));
    if (!(std::abs(taken[at(b)] + turns) < std::numeric_limits<int>::max())) continue;
    angle = (angle - turns * (2 * std::numbers::pi)) - turns * low_part;
    taken[at(b)] += static_cast<int>(turns);
  }
}

void Equations::leave_out(Pose& pose, std::span<const int> rows) const {
  pose.left_out.assign(rows.begin(), rows.end());
  pose.left_out_slots.clear();
  if (rows.empty()) return;
  std::vector<char> is_out(at(plan_->rows), 0);
  for (int r : rows) is_out[at(r)] = 1;
  for (int k = 0; k < plan_->jacobian.entries(); ++k) {
    if (is_out[at(plan_->jacobian.row_index[at(k)])]) pose.left_out_slots.push_back(k);
  }
}

void Equations::phi(const Pose& pose, std::span<double> out) const {
  for_each_present_block(plan_->blocks, constraints_, [&]<class Block>(const Block& block, const auto& data) {
    OperationsOf<Block>::phi(block, data, pose, out.data());
  });
  for (int r : pose.left_out) out[at(r)] = 0;
}

void Equations::start_jacobian(std::span<double> values) const {
  std::fill(values.begin(), values.end(), 0.0);
  for_each_list(plan_->blocks, [&](const auto& block, int) {
    for (std::size_t k = 0; k < block.constant.size(); ++k) values[at(block.constant_slot[k])] += block.constant[k];
  });
}

void Equations::jacobian(const Pose& pose, std::span<double> values) const {
  for_each_list(plan_->blocks, [&](const auto& block, int) {
    // They add to what others write.
    if constexpr (Joining<typename std::remove_cvref_t<decltype(block)>::Element>) {
      for (int slot : block.slot) values[at(slot)] = 0;
    }
  });
  for_each_present_block(plan_->blocks, constraints_, [&]<class Block>(const Block& block, const auto& data) {
    OperationsOf<Block>::jacobian(block, data, pose, values.data());
  });
  for (int k : pose.left_out_slots) values[at(k)] = 0;
}

void Equations::nu(const Pose& pose, std::span<double> out) const {
  std::fill(out.begin(), out.end(), 0.0);
  for_each_present_block(plan_->blocks, constraints_, [&]<class Block>(const Block& block, const auto& data) {
    OperationsOf<Block>::nu(block, data, pose, out.data());
  });
}

void Equations::gamma(const Pose& pose, std::span<const double> qd, std::span<double> out) const {
  for_each_present_block(plan_->blocks, constraints_, [&]<class Block>(const Block& block, const auto& data) {
    OperationsOf<Block>::gamma(block, data, pose, qd.data(), out.data());
  });
}

}  // namespace catena
