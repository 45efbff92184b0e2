#include "catena/linalg/rank/upper_trapezoid.hpp"

#include <cmath>
#include <cstddef>

namespace catena {

UpperTrapezoid::UpperTrapezoid(std::span<const std::int64_t> column_start, std::span<const std::int64_t> row_index,
                               std::span<const double> values)
    : column_start_(column_start), row_index_(row_index), values_(values) {
  const int columns = static_cast<int>(column_start.size()) - 1;
  for (int place = 0; place < columns; ++place) {
    double pivot = 0;
    for (std::int64_t k = begin(place); k < end(place); ++k)
      if (row_index[k] == rank()) pivot = values[k];
    if (pivot != 0) {
      live_.push_back(place);
      diagonal_.push_back(pivot);
    } else {
      dead_.push_back(place);
    }
  }
  work_.assign(live_.size(), 0.0);
  terms_.assign(live_.size(), 0.0);
  reached_.assign(live_.size(), false);
}

/// Depth-first search without recursion: chains of a million links are deeper than any call stack.
void UpperTrapezoid::search(int row) {
  if (reached_[row]) return;
  reached_[row] = true;
  stack_.push_back({row, begin(live_[row])});
  while (!stack_.empty()) {
    Visit& visit = stack_.back();
    if (visit.next == end(live_[visit.row])) {
      finish_order_.push_back(visit.row);
      stack_.pop_back();
      continue;
    }
    const int fed = static_cast<int>(row_index_[visit.next++]);
    if (reached_[fed]) continue;
    reached_[fed] = true;
    stack_.push_back({fed, begin(live_[fed])});
  }
}

void UpperTrapezoid::combination_of(int place, double negligible, std::vector<Entry>& combination) {
  finish_order_.clear();
  for (std::int64_t k = begin(place); k < end(place); ++k) search(static_cast<int>(row_index_[k]));
  double square = 0;
  for (std::int64_t k = begin(place); k < end(place); ++k) {
    work_[row_index_[k]] = values_[k];
    terms_[row_index_[k]] = std::abs(values_[k]);
    square += values_[k] * values_[k];
  }
  const double length = std::sqrt(square);
  for (auto i = finish_order_.rbegin(); i != finish_order_.rend(); ++i) {
    if (std::abs(work_[*i]) > negligible * (terms_[*i] + length)) {
      const double coefficient = work_[*i] / diagonal_[*i];
      for (std::int64_t k = begin(live_[*i]); k < end(live_[*i]); ++k) {
        const double term = values_[k] * coefficient;
        work_[row_index_[k]] -= term;
        terms_[row_index_[k]] += std::abs(term);
      }
      combination.push_back({*i, coefficient});
    }
    work_[*i] = terms_[*i] = 0;
    reached_[*i] = false;
  }
}

void UpperTrapezoid::append_null_vectors(std::span<const int> order, double negligible, SparseVectors& vectors) {
  std::vector<Entry> combination;
  for (int place : dead_) {
    combination.clear();
    combination_of(place, negligible, combination);
    vectors.index.push_back(order[place]);
    vectors.value.push_back(1);
    for (const Entry& entry : combination) {
      vectors.index.push_back(order[live_[entry.row]]);
      vectors.value.push_back(-entry.value);
    }
    vectors.start.push_back(static_cast<int>(vectors.index.size()));
  }
}

}  // namespace catena
