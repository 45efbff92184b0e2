#include "catena/linalg/block/block_factorization.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "catena/linalg/block/block_solve.hpp"
#include "catena/linalg/block/large_block_kernels.hpp"
#include "catena/linalg/block/small_block_kernels.hpp"

namespace catena {
namespace {

// The updates of a small block are few enough to name their slots one by one.
template <class Segment>
void name_slots(const Segment* segment, int below, const int* relatives, std::vector<int>& slots) {
  for (int j = 0; j < below; ++j) {
    if (j == segment->end) ++segment;
    const int* const relative = relatives + segment->relative - segment->first;
    for (int i = j; i < below; ++i) slots.push_back(segment->panel + segment->height * relative[j] + relative[i]);
  }
}

// Nothing times what is not finite is not a number. Four sums at once take a third of the instructions of a question
// for each.
bool are_finite(const std::vector<double>& numbers) {
  double sum[4] = {};
  std::size_t k = 0;
  for (; k + 4 <= numbers.size(); k += 4) {
    for (std::size_t j = 0; j < 4; ++j) sum[j] += 0 * numbers[k + j];
  }
  for (; k < numbers.size(); ++k) sum[0] += 0 * numbers[k];
  return (sum[0] + sum[1]) + (sum[2] + sum[3]) == 0;
}

std::size_t product(int a, int b) { return static_cast<std::size_t>(a) * static_cast<std::size_t>(b); }

}  // namespace

void BlockFactorization::analyze(std::span<const MatrixEntry> entries, std::span<const int> order,
                                 std::span<const int> node_start, Counters& counters) {
  *this = BlockFactorization();
  ++counters.symbolic;
  structure_ = BlockStructure(entries, order, node_start);
  if (structure_.panel_entries > static_cast<std::size_t>(std::numeric_limits<int>::max()))
    throw std::length_error("BlockFactorization: more than 2^31 - 1 entries in L");
  panels_.resize(structure_.panel_entries);
  pivots_.resize(order.size());
  work_.resize(order.size());
  place_updates();
  // The present order of the slots.
  structure_.source = std::vector<int>();
  structure_.target = std::vector<int>();
}

// Where values and updates go: every row below a block is a column of a later one, in whose panel those after it have
// a row each.
void BlockFactorization::place_updates() {
  const int count = structure_.count();
  std::vector<int> panel_of(static_cast<std::size_t>(count) + 1, 0), block_of_place(structure_.order.size());
  for (int s = 0; s < count; ++s) {
    const BlockStructure::Block& block = structure_.blocks[s];
    panel_of[s + 1] = panel_of[s] + block.height() * block.columns;
    for (int p = block.first; p < block.first + block.columns; ++p) block_of_place[p] = s;
  }
  slots_.resize(structure_.source.size());
  for (int s = 0; s < count; ++s) {
    for (int k = structure_.blocks[s].values; k < structure_.blocks[s + 1].values; ++k) {
      slots_[structure_.source[k]] = panel_of[s] + structure_.target[k];
    }
  }
  steps_.reserve(static_cast<std::size_t>(count));
  int tallest = 0;
  for (int s = 0; s < count; ++s) {
    const BlockStructure::Block& block = structure_.blocks[s];
    const int* const below = structure_.rows.data() + block.rows;
    Step step{.first = block.first,
              .shape = static_cast<short>(detail::shape_code(block.columns, block.below)),
              .columns = block.columns,
              .below = block.below,
              .segments = 0};
    for (int j = 0; j < block.below;) {
      const int t = block_of_place[below[j]];
      const BlockStructure::Block& later = structure_.blocks[t];
      const int* list = structure_.rows.data() + later.rows;
      Segment segment{.first = j,
                      .end = j,
                      .panel = panel_of[t],
                      .height = later.height(),
                      .relative = static_cast<int>(relative_.size())};
      const int* const list_begin = list;
      for (int i = j; i < block.below; ++i) {
        if (block_of_place[below[i]] == t) {
          segment.end = i + 1;
          relative_.push_back(below[i] - later.first);
          continue;
        }
        while (*list != below[i]) ++list;
        relative_.push_back(later.columns + static_cast<int>(list - list_begin));
      }
      j = segment.end;
      segments_.push_back(segment);
      ++step.segments;
    }
    if (step.shape != 0) {
      const Segment* segment = segments_.data() + segments_.size() - step.segments;
      const int first_relative = step.segments > 0 ? segment->relative : 0;
      name_slots(segment, block.below, relative_.data(), update_slots_);
      segments_.resize(segments_.size() - static_cast<std::size_t>(step.segments));
      if (step.segments > 0) relative_.resize(static_cast<std::size_t>(first_relative));
    } else {
      tallest = std::max(tallest, block.below);
    }
    steps_.push_back(step);
  }
  column_.resize(static_cast<std::size_t>(tallest));
}

// A block of any size: its columns, then column by column their updates of later blocks.
void BlockFactorization::eliminate_large(const Step& step, double* panel, const Segment* segments, int* done) {
  const int height = step.columns + step.below;
  double* const pivots = pivots_.data() + step.first;
  *done = detail::eliminate_columns(panel, height, step.columns, pivots);
  if (*done < step.columns) return;
  for (const Segment* segment = segments; segment < segments + step.segments; ++segment) {
    const int* const relative = relative_.data() + segment->relative - segment->first;
    double* const later = panels_.data() + segment->panel;
    for (int j = segment->first; j < segment->end; ++j) {
      const int count = step.below - j;
      std::fill_n(column_.data(), count, 0.0);
      detail::add_update(panel, height, step.columns, pivots, j, column_.data(), count);
      double* const target = later + product(relative[j], segment->height);
      for (int i = 0; i < count; ++i) target[relative[j + i]] += column_[static_cast<std::size_t>(i)];
    }
  }
}

FactorResult BlockFactorization::factorize(Counters& counters) {
  ++counters.factorizations;
  counters.refactorizations += factored_before_ ? 1 : 0;
  factored_before_ = true;
  factorized_ = false;
  double* const all = panels_.data();
  double* panel = all;
  const int* slot = update_slots_.data();
  const Segment* segment = segments_.data();
  for (const Step& step : steps_) {
    int done = 0;
    const bool small = detail::with_shape(step.shape, [&](auto c, auto r) {
      done = detail::eliminate<c, r>(panel, pivots_.data() + step.first, all, slot);
      panel += c * (c + r);
      slot += r * (r + 1) / 2;
    });
    if (!small) {
      eliminate_large(step, panel, segment, &done);
      panel += product(step.columns, step.columns + step.below);
      segment += step.segments;
    }
    if (done < step.columns) return {FactorStatus::singular, structure_.order[step.first + done]};
  }
  if (!are_finite(pivots_)) {
    for (int k = 0; k < size(); ++k) {
      if (!std::isfinite(pivots_[k])) return {FactorStatus::not_finite, structure_.order[k]};
    }
  }
  factorized_ = true;
  return {};
}

FactorResult BlockFactorization::factorize(std::span<const double> values, Counters& counters) {
  if (values.size() != slots_.size())
    throw std::invalid_argument("BlockFactorization: as many values as entries are needed");
  std::fill(panels_.begin(), panels_.end(), 0.0);
  for (std::size_t k = 0; k < values.size(); ++k) panels_[static_cast<std::size_t>(slots_[k])] += values[k];
  return factorize(counters);
}

int BlockFactorization::negative_pivots() const {
  return static_cast<int>(std::count_if(pivots_.begin(), pivots_.end(), [](double d) { return d < 0; }));
}

double BlockFactorization::pivot(int row) const {
  if (!factorized_) throw std::logic_error("BlockFactorization: no valid factors");
  return pivots_[static_cast<std::size_t>(structure_.place[row])];
}

void BlockFactorization::solve(std::span<double> x, Counters& counters) {
  ++counters.solves;
  solve_in(x, work_);
}

}  // namespace catena
