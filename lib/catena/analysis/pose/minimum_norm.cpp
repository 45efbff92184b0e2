#include "catena/analysis/pose/minimum_norm.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "catena/analysis/run/name_list.hpp"
#include "catena/analysis/run/thresholds.hpp"
#include "catena/base/at.hpp"
#include "catena/linalg/rank/dependence.hpp"
#include "catena/model/attachment.hpp"

namespace catena {
namespace {

// A reaction counts as ambiguous if a random set of multipliers differs from the least equivalent one by this part.
constexpr double ambiguous_part = thresholds::same_value;

/// Inverts the positive definite n x n matrix (n <= 3) in place, by pivots; rows 3 apart.
void invert(double* a, int n) {
  for (int p = 0; p < n; ++p) {
    const double pivot = 1 / a[4 * p];
    a[4 * p] = 1;
    for (int c = 0; c < n; ++c) a[3 * p + c] *= pivot;
    for (int r = 0; r < n; ++r) {
      if (r == p) continue;
      const double factor = a[3 * r + p];
      a[3 * r + p] = 0;
      for (int c = 0; c < n; ++c) a[3 * r + c] -= factor * a[3 * p + c];
    }
  }
}

}  // namespace

MinimumNorm::MinimumNorm(const Evaluator& evaluator) : evaluator_(evaluator) {
  const Plan& plan = evaluator.plan();
  for (std::size_t e = 0; e < plan.element_row.size(); ++e) {
    if (plan.element_row[e] < 0 || evaluator.is_left_out(plan.element_row[e])) continue;
    const Evaluator::ElementJacobian jacobian = evaluator.element_jacobian(static_cast<int>(e));
    Block block;
    block.element = static_cast<int>(e);
    block.first_row = plan.element_row[e];
    block.rows = jacobian.rows;
    block.columns = 3 * jacobian.bodies;
    for (int k = 0; k < block.columns; ++k) block.column[k] = plan.column_of(jacobian.body_i, jacobian.body_j, k);
    blocks_.push_back(block);
  }
  make_pattern();
}

void MinimumNorm::make_pattern() {
  const int columns = evaluator_.plan().columns;
  std::vector<MatrixEntry> entries;
  for (int c = 0; c < columns; ++c) entries.push_back({c, c});
  for (Block& block : blocks_) {
    block.first_slot = static_cast<int>(entries.size()) - columns;
    for (int a = 0; a < block.columns; ++a) {
      for (int b = 0; b <= a; ++b) {
        if (block.column[a] < 0 || block.column[b] < 0) continue;
        entries.push_back({std::max(block.column[a], block.column[b]), std::min(block.column[a], block.column[b])});
      }
    }
  }
  SlottedPattern built = build_pattern(columns, columns, entries);
  pattern_ = std::move(built.pattern);
  diagonal_.assign(built.slot.begin(), built.slot.begin() + columns);
  slot_.assign(built.slot.begin() + columns, built.slot.end());
  values_.resize(pattern_.row_index.size());
  right_hand_side_.resize(at(columns));
  y_.resize(at(columns));
}

// Phi_k and W_k^-1 of one element. The reaction is taken on body j, on the only body of absolute constraints.
void MinimumNorm::load(Block& block) const {
  const Evaluator::ElementJacobian jacobian = evaluator_.element_jacobian(block.element);
  const Attachment attachment = attachment_of(evaluator_.model(), block.element);
  const bool two = jacobian.bodies == 2;
  const Frame<double> frame = evaluator_.frames()[at(two ? jacobian.body_j : jacobian.body_i)];
  const Vec2<double> turned = perpendicular(frame.axis(two ? attachment.point_j : attachment.point_i));
  const double length = evaluator_.length_scale();
  const int first = two ? 3 : 0;
  double wrench[3][3] = {};
  for (int r = 0; r < block.rows; ++r) {
    const double* row = jacobian.entries + 6 * r + first;
    wrench[r][0] = row[0];
    wrench[r][1] = row[1];
    wrench[r][2] = (row[2] - turned.x * row[0] - turned.y * row[1]) / length;
  }
  for (int r = 0; r < block.rows; ++r) {
    for (int s = 0; s < block.rows; ++s) {
      double sum = 0;
      for (int k = 0; k < 3; ++k) sum += wrench[r][k] * wrench[s][k];
      block.inverse_metric[3 * r + s] = sum;
    }
  }
  invert(block.inverse_metric, block.rows);
  std::copy(std::begin(jacobian.entries), std::end(jacobian.entries), block.jacobian);
  block.scale = jacobian.scale;
}

bool MinimumNorm::factorize() {
  std::fill(values_.begin(), values_.end(), 0.0);
  for (Block& block : blocks_) {
    load(block);
    const int* slot = slot_.data() + block.first_slot;
    for (int a = 0; a < block.columns; ++a) {
      double weighted[3] = {};  // row a of Phi_k^T W_k^-1
      for (int r = 0; r < block.rows; ++r) {
        for (int s = 0; s < block.rows; ++s) weighted[s] += block.jacobian[6 * r + a] * block.inverse_metric[3 * r + s];
      }
      for (int b = 0; b <= a; ++b) {
        if (block.column[a] < 0 || block.column[b] < 0) continue;
        double sum = 0;
        for (int s = 0; s < block.rows; ++s) sum += weighted[s] * block.jacobian[6 * s + b];
        values_[at(*slot++)] += sum;
      }
    }
  }
  Counters& counters = evaluator_.counters;
  if (!analyzed_) {
    if (!factorization_.analyze(pattern_, {.form = SymmetricForm::ldl}, counters).ok()) return false;
    analyzed_ = true;
  }
  // The factored matrix differs from the true one by its diagonal only; refinement uses the true one, block by block.
  // A coordinate along a free motion has a diagonal of rounding, of which a part would keep nothing from being
  // singular.
  double largest[2] = {};  // of displacements, of angles
  const Plan& plan = evaluator_.plan();
  for (std::size_t c = 0; c < diagonal_.size(); ++c) {
    double& of_its_kind = largest[plan.coordinate[c] % 3 == 2];
    of_its_kind = std::max(of_its_kind, values_[at(diagonal_[c])]);
  }
  for (std::size_t c = 0; c < diagonal_.size(); ++c) {
    const double of_its_kind = largest[plan.coordinate[c] % 3 == 2];
    double& value = values_[at(diagonal_[c])];
    value +=
        of_its_kind > 0 ? dependence::regularisation * value + std::numeric_limits<double>::epsilon() * of_its_kind : 1;
  }
  return factorization_.factorize(values_, 0, counters).ok();
}

double MinimumNorm::solve(std::span<const double> loads, std::span<double> lambda) {
  const Plan& plan = evaluator_.plan();
  double size = 0;
  for (std::size_t c = 0; c < y_.size(); ++c) {
    right_hand_side_[c] = loads[at(plan.coordinate[c])];
    size = std::max(size, std::abs(right_hand_side_[c]));
  }
  // lambda of the published equations from y, into the solver's; and Phi_q^T lambda subtracted from r.
  const auto spread = [&](std::span<const double> y, std::span<double> r) {
    for (const Block& block : blocks_) {
      double stretched[3] = {}, multiplier[3] = {};
      for (int k = 0; k < block.columns; ++k) {
        if (block.column[k] < 0) continue;
        for (int s = 0; s < block.rows; ++s) stretched[s] += block.jacobian[6 * s + k] * y[at(block.column[k])];
      }
      for (int s = 0; s < block.rows; ++s) {
        for (int t = 0; t < block.rows; ++t) multiplier[s] += block.inverse_metric[3 * s + t] * stretched[t];
        lambda[at(block.first_row + s)] = multiplier[s] / block.scale;
      }
      for (int k = 0; k < block.columns; ++k) {
        if (block.column[k] < 0) continue;
        for (int s = 0; s < block.rows; ++s) r[at(block.column[k])] -= block.jacobian[6 * s + k] * multiplier[s];
      }
    }
  };
  const auto residual = [&](std::span<const double> y, std::span<double> r) {
    std::copy(right_hand_side_.begin(), right_hand_side_.end(), r.begin());
    spread(y, r);
    double left = 0;
    for (double value : r) left = std::max(left, std::abs(value));
    return size > 0 ? left / size : left;
  };
  y_ = right_hand_side_;
  const Refinement outcome =
      factorization_.solve_refined(y_, residual, {.tolerance = 1e-15, .max_steps = 5}, evaluator_.counters);
  residual(y_, right_hand_side_);  // leaves lambda at the last y
  return outcome.residual;
}

std::vector<int> MinimumNorm::find_ambiguous() {
  const Plan& plan = evaluator_.plan();
  std::vector<double> loads(at(3 * plan.moving), 0.0), any(at(plan.rows)), least(any);
  // Reactions that are all of the same size, of no special ratio.
  for (const Block& block : blocks_) {
    for (int s = 0; s < block.rows; ++s) {
      const double size = std::sqrt(block.inverse_metric[4 * s]) / block.scale;
      any[at(block.first_row + s)] = size * (1 + std::abs(std::sin(1.7 * (block.first_row + s) + 0.3)));
      for (int k = 0; k < block.columns; ++k) {
        if (block.column[k] < 0) continue;
        const int coordinate = plan.coordinate[at(block.column[k])];
        loads[at(coordinate)] += block.jacobian[6 * s + k] * block.scale * any[at(block.first_row + s)];
      }
    }
  }
  solve(loads, least);
  std::vector<int> elements;
  for (const Block& block : blocks_) {
    for (int s = 0; s < block.rows; ++s) {
      const auto row = at(block.first_row + s);
      if (std::abs(any[row] - least[row]) > ambiguous_part * std::abs(any[row])) {
        elements.push_back(block.element);
        break;
      }
    }
  }
  return elements;
}

std::string MinimumNorm::name_ambiguous() { return element_names(evaluator_.model(), find_ambiguous()); }

const std::string& MinimumNorm::ambiguity() {
  if (ambiguity_) return *ambiguity_;
  const std::string names = name_ambiguous();
  return ambiguity_.emplace(
      names.empty()
          ? names
          : fmt::format("reactions of {} are not unique, since constraints depend on each other: the least are given",
                        names));
}

}  // namespace catena
