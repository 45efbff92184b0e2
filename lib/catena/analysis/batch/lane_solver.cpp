#include "catena/analysis/batch/lane_solver.hpp"

#include <algorithm>

#include "catena/analysis/batch/kernels/lane_kernels.hpp"
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
      searches_(program.searched(), program.code().moving),
      applied_(program.has_loads() ? coordinates_ : 0),
      converged_(1),
      first_size_(1),
      first_turn_(1),
      contraction_(1),
      residual_(1),
      flag_(1) {
  job_.code = &program.code();
  job_.field = field_.data();
  job_.function = function_.data();
  job_.unit = unit_.data();
  job_.frame = frame_.data();
  job_.matrix = matrix_.data();
  job_.right = right_.data();
  job_.tail = tail_.data();
  job_.exchange = exchange_.data();
  if (program.is_watched() || program.takes_forces())
    evaluators_ = std::make_unique<LaneEvaluators>(program.shared_plan(), program.code().moving);
  job_.applied = applied_.data();
  job_.load = load_.data();
  job_.search = LaneSearches::search;
  job_.searches = &searches_;
  job_.found.converged = converged_.data();
  job_.found.first_size = first_size_.data();
  job_.found.first_turn = first_turn_.data();
  job_.found.contraction = contraction_.data();
  job_.found.residual = residual_.data();
  for (int slot = 0; slot < program.slots(); ++slot)
    std::fill(matrix_[slot], matrix_[slot] + lane_count, program.initial()[at(slot)]);
}

bool LaneSolver::put_design(int lane, const Model& model, double length_scale) {
  model_[at(lane)] = &model;
  unit_[0][lane] = 1 / length_scale;
  searches_.set_design(lane, model);
  return program_.put(model, length_scale, lane, field_, function_, frame_);
}

bool LaneSolver::set_design(int lane, const Model& model, double length_scale) {
  if (evaluators_) evaluators_->set_design(lane, model);
  return put_design(lane, model, length_scale);
}

bool LaneSolver::set_designs(const Model& model, double length_scale) {
  if (evaluators_) evaluators_->set_designs(model);
  const bool finite = put_design(0, model, length_scale);
  model_.fill(&model);
  for (int lane = 1; lane < lane_count && !searches_.empty(); ++lane) searches_.set_design(lane, model);
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
  job_.found.margin = state.margin.data();
  job_.lambda = state.lambda.data();
  job_.turned = state.turned.data();
  if (!searches_.empty()) searches_.go_to(state.places);
  lane_kernels().solve(job_);
  if (evaluators_ || !searches_.empty()) refuse_trouble(state, lanes);
  if (!searches_.empty()) searches_.keep_places(state.places);
  if (program_.has_loads()) lane_kernels().find_loads(job_);
}

void LaneSolver::refuse_trouble(const LaneState& state, int lanes) {
  for (int lane = 0; lane < lanes; ++lane) {
    const char*& trouble = trouble_[at(lane)];
    trouble = nullptr;
    if (!converged(lane)) continue;
    trouble = searches_.trouble(frame_.data(), state.places, lane);
    if (!trouble && evaluators_) trouble = evaluators_->go_to(lane, state.t[at(lane)], state.q, state.qd);
    if (trouble)
      converged_[0][lane] = 0;
    else if (program_.takes_forces())
      evaluators_->find(lane, applied_);
  }
}

unsigned LaneSolver::flagged() const {
  unsigned lanes = 0;
  for (int lane = 0; lane < lane_count; ++lane) lanes |= (flag_[0][lane] == 1 ? 1U : 0U) << lane;
  return lanes;
}

unsigned LaneSolver::foretell(const LaneState& before, const LaneState& after, double remaining_part,
                              LaneState& state) {
  const bool any = lane_kernels().foretell({coordinates_, program_.code().tails, before.t.data(), after.t.data(),
                                            state.t.data(), before.q.data(), before.qd.data(), before.qdd.data(),
                                            after.q.data(), after.qd.data(), after.qdd.data(), before.margin.data(),
                                            after.margin.data(), remaining_part, state.q.data(), flag_.data()});
  return any ? flagged() : 0;
}

unsigned LaneSolver::judge(const LaneState& before, const LaneState& state, const Rules& rules) {
  const bool all = lane_kernels().judge(
      {coordinates_, program_.code().tails, before.q.data(), state.q.data(), before.margin.data(), state.margin.data(),
       converged_.data(), first_turn_.data(), contraction_.data(), rules.largest_turn, rules.largest_contraction,
       rules.longest_step, rules.sudden_part, flag_.data()});
  return all ? (1U << lane_count) - 1 : flagged();
}

unsigned LaneSolver::watch(const LaneState& state, double least_part, LaneNumbers& largest) {
  const bool any =
      lane_kernels().watch({program_.code().tails, least_part, state.margin.data(), largest.data(), flag_.data()});
  return any ? flagged() : 0;
}

}  // namespace catena
