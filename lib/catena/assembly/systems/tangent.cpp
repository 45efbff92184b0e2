#include "catena/assembly/systems/tangent.hpp"

#include <algorithm>
#include <cmath>

#include "catena/base/at.hpp"

namespace catena {
namespace {

constexpr std::size_t entries_of_element = std::tuple_size_v<ElementMatrix>;

constexpr auto transposed_entry = [] {
  std::array<std::size_t, entries_of_element> place{};
  for (std::size_t k = 0; k < place.size(); ++k) place[k] = 6 * (k % 6) + k / 6;
  return place;
}();

}  // namespace

void Tangent::arrange(std::span<const int> rows, bool yielding) {
  const Plan& plan = *plan_;
  const int columns = plan.columns, size = columns + static_cast<int>(rows.size());
  std::vector<MatrixEntry> places;
  // Slots hold places in that list until the pattern is known.
  const auto add = [&](std::vector<int>& slots, int row, int column) {
    const bool there = row >= 0 && column >= 0;
    slots.push_back(there ? static_cast<int>(places.size()) : -1);
    if (there) places.push_back({row, column});
  };
  for (auto* slots : {&diagonal_slot_, &jacobian_slot_, &force_slot_, &curvature_slot_}) slots->clear();
  for (int c = 0; c < columns && block_ != SaddleBlock::none; ++c) add(diagonal_slot_, c, c);
  for (int r = columns; r < size && yielding; ++r) add(diagonal_slot_, r, r);
  std::vector<int> place(at(plan.rows), -1);
  for (std::size_t k = 0; k < rows.size(); ++k) place[at(rows[k])] = columns + static_cast<int>(k);
  for (int c = 0; c < columns; ++c) {
    for (int k = plan.jacobian.column_start[at(c)]; k < plan.jacobian.column_start[at(c) + 1]; ++k) {
      const int row = place[at(plan.jacobian.row_index[at(k)])];
      add(jacobian_slot_, row, c);
      add(jacobian_slot_, c, row);
    }
  }
  const auto add_element = [&](std::vector<int>& slots, int i, int j) {
    int column[6];
    for (int k = 0; k < 6; ++k) column[k] = plan.column_of(i, j, k);
    for (const int row : column) {
      for (const int c : column) add(slots, row, c);
    }
  };
  if (block_ == SaddleBlock::elements) {
    const auto add_all = [&](std::vector<int>& slots, const auto& block) {
      for (int e = 0; e < block.size(); ++e) add_element(slots, block.body_i[at(e)], block.body_j[at(e)]);
    };
    for_each_list(plan.forces, [&](const auto& block, int) { add_all(force_slot_, block); });
    for (const auto& [acted, read] : plan.law_pairs) add_element(force_slot_, acted, read);
    for_each_list(plan.blocks, [&](const auto& block, int) { add_all(curvature_slot_, block); });
  }
  SlottedPattern built = build_pattern(size, size, places);
  pattern_ = std::move(built.pattern);
  for (auto* slots : {&diagonal_slot_, &jacobian_slot_, &force_slot_, &curvature_slot_}) {
    for (int& slot : *slots) slot = slot < 0 ? pattern_.entries() : built.slot[at(slot)];
  }
}

void Tangent::begin(std::span<const double> jacobian) {
  values_.assign(pattern_.row_index.size() + 1, 0.0);
  for (std::size_t k = 0; 2 * k < jacobian_slot_.size(); ++k) {
    values_[at(jacobian_slot_[2 * k])] = jacobian[k];
    values_[at(jacobian_slot_[2 * k + 1])] = jacobian[k];
  }
}

void Tangent::set_compliance(double e) {
  for (std::size_t k = at(plan_->columns); k < diagonal_slot_.size(); ++k) values_[at(diagonal_slot_[k])] = -e;
}

void Tangent::add_stiffness(const Evaluator& evaluator, std::span<const double> lambda, bool transposed) {
  const int* slot = force_slot_.data();
  evaluator.visit_stiffness({}, [&](int, int, const ElementMatrix& m) {
    for (std::size_t k = 0; k < m.size(); ++k) values_[at(slot[transposed ? transposed_entry[k] : k])] += m[k];
    slot += m.size();
  });
  add_curvature(evaluator, lambda);
}

void Tangent::add_curvature(const Evaluator& evaluator, std::span<const double> lambda) {
  const int* slot = curvature_slot_.data();
  evaluator.visit_constraint_hessians(lambda, [&](int, int, const ElementMatrix& m) {
    for (std::size_t k = 0; k < m.size(); ++k) values_[at(slot[k])] += m[k];
    slot += m.size();
  });
}

void Tangent::multiply(std::span<const double> x, std::span<double> y, bool transposed) const {
  const int columns = plan_->columns, size = static_cast<int>(y.size());
  std::fill(y.begin(), y.end(), 0.0);
  for (int c = 0; c < size; ++c) {
    for (int k = pattern_.column_start[at(c)]; k < pattern_.column_start[at(c) + 1]; ++k) {
      const int r = pattern_.row_index[at(k)];
      if (r >= (c < columns ? size : columns)) break;  // not asked for, or E
      y[at(transposed ? c : r)] += values_[at(k)] * x[at(transposed ? r : c)];
    }
  }
}

double Tangent::largest_stiffness(std::span<const double> inverse_arms) const {
  const auto inverse_arm = [&](int c) { return inverse_arms.empty() ? 1.0 : inverse_arms[at(c)]; };
  double largest = 0;
  for (int c = 0; c < plan_->columns; ++c) {
    for (int k = pattern_.column_start[at(c)]; k < pattern_.column_start[at(c) + 1]; ++k) {
      const int r = pattern_.row_index[at(k)];
      if (r >= plan_->columns) break;
      largest = std::max(largest, std::abs(values_[at(k)]) * inverse_arm(c) * inverse_arm(r));
    }
  }
  return largest;
}

}  // namespace catena
