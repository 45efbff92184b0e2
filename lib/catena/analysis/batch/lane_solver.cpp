#include "catena/analysis/batch/lane_solver.hpp"

#include <algorithm>

#include "catena/analysis/batch/lane_kernels.hpp"
#include "catena/base/at.hpp"

namespace catena {

LaneSolver::LaneSolver(const LaneProgram& program)
    : program_(program),
      coordinates_(3 * program.code().moving),
      field_(program.fields()),
      function_(program.functions()),
      frame_(5 * program.code().frames),
      unit_(1),
      matrix_(program.slots()),
      right_(program.code().rows),
      tail_(largest_tail * largest_tail * program.code().tails),
      exchange_(largest_tail * largest_tail * program.code().tails),
      load_(program.has_loads() ? coordinates_ : 0),
      converged_(1),
      first_size_(1),
      first_turn_(1),
      contraction_(1),
      residual_(1),
      u_(1),
      h_(1) {
  job_.code = &program.code();
  job_.field = field_.data();
  job_.function = function_.data();
  job_.unit = unit_.data();
  job_.frame = frame_.data();
  job_.matrix = matrix_.data();
  job_.right = right_.data();
  job_.tail = tail_.data();
  job_.exchange = exchange_.data();
  job_.load = load_.data();
  job_.converged = converged_.data();
  job_.first_size = first_size_.data();
  job_.first_turn = first_turn_.data();
  job_.contraction = contraction_.data();
  job_.residual = residual_.data();
  for (int slot = 0; slot < program.slots(); ++slot)
    std::fill(matrix_[slot], matrix_[slot] + lane_count, program.initial()[at(slot)]);
}

bool LaneSolver::set_design(int lane, const Model& model, double length_scale) {
  model_[at(lane)] = &model;
  unit_[0][lane] = 1 / length_scale;
  return program_.put(model, length_scale, lane, field_, function_, frame_);
}

bool LaneSolver::set_designs(const Model& model, double length_scale) {
  const bool finite = set_design(0, model, length_scale);
  model_.fill(&model);
  for (LaneNumbers* numbers : {&field_, &function_, &frame_, &unit_}) numbers->spread(0);
  return finite;
}

void LaneSolver::solve(LaneState& state, int lanes) {
  if (shared_) {
    program_.put_functions(*model_[0], state.t[0], 0, function_);
    program_.spread_functions(function_);
  } else {
    for (int lane = 0; lane < lanes; ++lane)
      program_.put_functions(*model_[at(lane)], state.t[at(lane)], lane, function_);
  }
  job_.lanes = lanes;
  job_.tolerance = tolerance;
  job_.velocity = job_.acceleration = true;
  job_.q = state.q.data();
  job_.qd = state.qd.data();
  job_.qdd = state.qdd.data();
  job_.margin = state.margin.data();
  job_.lambda = state.lambda.data();
  lane_kernels().solve(job_);
  if (program_.has_loads()) lane_kernels().find_loads(job_);
  for (int b = 0; b < program_.code().moving; ++b) std::copy(frame_[5 * b + 3], frame_[5 * b + 5], state.turned[2 * b]);
}

void LaneSolver::foretell(const LaneState& before, const LaneState& after, LaneState& state) {
  for (int lane = 0; lane < lane_count; ++lane) {
    const double h = after.t[at(lane)] - before.t[at(lane)];
    h_[0][lane] = h != 0 ? h : 1;
    u_[0][lane] = h != 0 ? (state.t[at(lane)] - before.t[at(lane)]) / h : 1;
  }
  lane_kernels().foretell({coordinates_, before.q.data(), before.qd.data(), before.qdd.data(), after.q.data(),
                           after.qd.data(), after.qdd.data(), u_.data(), h_.data(), state.q.data()});
}

}  // namespace catena
