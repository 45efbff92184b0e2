#include "catena/analysis/batch/lane_static_system.hpp"

#include <algorithm>
#include <cmath>

#include "catena/analysis/batch/kernels/lane_kernels.hpp"
#include "catena/base/at.hpp"

namespace catena {

const LaneStaticKernels& LaneStaticSystem::kernels() { return *lane_kernels().statics; }

LaneStaticSystem::LaneStaticSystem(const LaneProgram& program)
    : q(program.plan().columns),
      lambda(program.plan().rows),
      change(program.plan().columns),
      next_lambda(program.plan().rows),
      shift(1),
      by_weights(1),
      program_(program),
      field_(program.fields()),
      function_(program.functions()),
      frame_(5 * program.code().frames),
      unit_(1),
      matrix_(program.slots()),
      right_(program.plan().rows),
      inverse_arm_(program.plan().columns),
      origin_(2 * program.plan().moving),
      length_(1),
      mask_(1),
      gradient_(program.plan().columns),
      told_(rest_numbers) {
  const Plan& plan = program.plan();
  const int n = plan.columns, m = plan.rows, free = n - m;
  factored_.stiffness = LaneNumbers(n * n);
  factored_.reduced = LaneNumbers(n * n);
  factored_.reflector = LaneNumbers(n * m);
  factored_.factor = LaneNumbers(m);
  factored_.diagonal = LaneNumbers(m);
  factored_.lower = LaneNumbers(free * free);
  work_ = LaneNumbers(2 * n);
  for (int c = 0; c < n; ++c) {
    for (int k = plan.jacobian.column_start[at(c)]; k < plan.jacobian.column_start[at(c) + 1]; ++k) {
      entry_row_.push_back(plan.jacobian.row_index[at(k)]);
      entry_column_.push_back(c);
    }
  }
  for (int slot = 0; slot < program.slots(); ++slot)
    std::fill(matrix_[slot], matrix_[slot] + lane_count, program.initial()[at(slot)]);
  LaneJob& equations = job_.equations;
  equations.code = &program.code();
  equations.field = field_.data();
  equations.function = function_.data();
  equations.unit = unit_.data();
  equations.frame = frame_.data();
  equations.q = q.data();
  equations.lambda = lambda.data();
  equations.matrix = matrix_.data();
  equations.right = right_.data();
  equations.lanes = lane_count;
  job_.columns = n;
  job_.entries = static_cast<int>(entry_row_.size());
  job_.entry_row = entry_row_.data();
  job_.entry_column = entry_column_.data();
  job_.inverse_arm = inverse_arm_.data();
  job_.origin = origin_.data();
  job_.length = length_.data();
  job_.mask = mask_.data();
  job_.shift = shift.data();
  job_.by_weights = by_weights.data();
  job_.gradient = gradient_.data();
  job_.change = change.data();
  job_.next_lambda = next_lambda.data();
  job_.stiffness = factored_.stiffness.data();
  job_.reduced = factored_.reduced.data();
  job_.reflector = factored_.reflector.data();
  job_.factor = factored_.factor.data();
  job_.diagonal = factored_.diagonal.data();
  job_.lower = factored_.lower.data();
  job_.work = work_.data();
  job_.told = told_.data();
}

bool LaneStaticSystem::set_design(int lane, const Evaluator& evaluator) {
  const Model& model = evaluator.model();
  const double scale = evaluator.length_scale();
  bool finite = program_.put(model, scale, lane, field_, function_, frame_);
  program_.put_functions(model, evaluator.time(), lane, function_);
  length_[0][lane] = scale;
  unit_[0][lane] = 1 / scale;
  const std::vector<double> radius = evaluator.attachment_radii();
  for (int b = 0; b < program_.plan().moving; ++b) {
    const Vec2<double> from = evaluator.origin(b);
    origin_[2 * b][lane] = from.x;
    origin_[2 * b + 1][lane] = from.y;
    inverse_arm_[3 * b][lane] = inverse_arm_[3 * b + 1][lane] = 1;
    inverse_arm_[3 * b + 2][lane] = 1 / radius[at(b)];
    finite = finite && std::isfinite(from.x) && std::isfinite(from.y) && std::isfinite(1 / radius[at(b)]);
  }
  return finite;
}

void LaneStaticSystem::set_mask(LaneSet lanes) {
  for (int lane = 0; lane < lane_count; ++lane) mask_[0][lane] = has(lanes, lane) ? 1 : 0;
}

double LaneStaticSystem::missed(const LaneNumbers& multipliers, int lane) const {
  double sum = 0;
  for (int r = 0; r < rows(); ++r) sum += multipliers[r][lane] * right_[r][lane];
  return sum;
}

void LaneStaticSystem::reflect(LaneSet lanes) {
  set_mask(lanes);
  kernels().reflect(job_);
}

void LaneStaticSystem::correct(LaneSet lanes) {
  set_mask(lanes);
  kernels().correct(job_);
}

}  // namespace catena
