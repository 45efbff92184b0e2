#include "catena/linalg/kernels/elimination_list.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "catena/base/at.hpp"

namespace catena {
namespace {

std::uint64_t bit(int k) { return std::uint64_t{1} << k; }
std::uint64_t bits_above(int k) { return k == 63 ? 0 : ~std::uint64_t{0} << (k + 1); }

}  // namespace

bool EliminationList::serves(std::span<const int> block_start) {
  for (std::size_t b = 0; b + 1 < block_start.size(); ++b) {
    if (block_start[b + 1] - block_start[b] > largest_block) return false;
  }
  return true;
}

EliminationList::EliminationList(const SparsePattern& pattern, const Order& order, std::span<const double> entry_scale)
    : row_(order.row.begin(), order.row.end()),
      column_(order.column.begin(), order.column.end()),
      block_start_(order.block_start.begin(), order.block_start.end()),
      row_place_(row_.size()),
      first_of_(row_.size()),
      places_(row_.size()),
      entry_scale_(entry_scale.begin(), entry_scale.end()),
      pivot_(row_.size()),
      inverse_(row_.size()),
      work_(row_.size()) {
  for (std::size_t p = 0; p < row_.size(); ++p) row_place_[at(row_[p])] = static_cast<int>(p);
  for (std::size_t b = 0; b + 1 < block_start_.size(); ++b)
    std::fill(first_of_.begin() + block_start_[b], first_of_.begin() + block_start_[b + 1], block_start_[b]);
  find_fill(pattern);
  list_products();
  list_entries(pattern);
  value_.resize(index_.size());
  factor_.resize(entries_.size());
}

// Row i of a block gets, where it has an entry in column p, those of row p to the right of p.
void EliminationList::find_fill(const SparsePattern& pattern) {
  std::vector<std::uint64_t> filled(row_.size(), 0);
  for (std::size_t p = 0; p < row_.size(); ++p) {
    for (int k = pattern.column_start[at(column_[p])]; k < pattern.column_start[at(column_[p]) + 1]; ++k) {
      const int row = row_place_[at(pattern.row_index[at(k)])];
      if (row >= first_of_[p]) filled[at(row)] |= bit(static_cast<int>(p) - first_of_[p]);
    }
  }
  for (std::size_t b = 0; b + 1 < block_start_.size(); ++b) {
    const int first = block_start_[b], size = block_start_[b + 1] - first;
    const auto entries = [&](int row) -> std::uint64_t& { return filled[at(first + row)]; };
    for (int p = 0; p < size; ++p) {
      for (int i = p + 1; i < size; ++i) {
        if (entries(i) & bit(p)) entries(i) |= entries(p) & bits_above(p);
      }
    }
    for (int p = 0; p < size; ++p) {
      Place& place = places_[at(first + p)];
      place = {static_cast<int>(index_.size()), 0, 0, 0};
      index_.push_back(first + p);
      for (int i = p + 1; i < size; ++i) {
        if (entries(i) & bit(p)) index_.push_back(first + i), ++place.below;
      }
      for (std::uint64_t rest = entries(p) & bits_above(p); rest != 0; rest &= rest - 1) {
        index_.push_back(first + std::countr_zero(rest));
        ++place.right;
      }
    }
  }
}

void EliminationList::list_products() {
  for (Place& place : places_) {
    place.target = static_cast<int>(target_.size());
    for (int i = 1; i <= place.below; ++i) {
      for (int j = 1; j <= place.right; ++j)
        target_.push_back(slot_in_block(index_[at(place.pivot + i)], index_[at(place.pivot + place.below + j)]));
    }
  }
}

// Block by block from the last one: forwards through L, backwards through U, then what it means for earlier blocks.
void EliminationList::list_entries(const SparsePattern& pattern) {
  slot_.resize(pattern.row_index.size());
  std::vector<std::vector<Entry>> above;  // of every column of a block, in U
  for (std::size_t b = block_start_.size() - 1; b-- > 0;) {
    const int first = block_start_[b], end = block_start_[b + 1];
    above.assign(at(end - first), {});
    for (int p = first; p < end; ++p) {
      const Place place = places_[at(p)];
      int slot = place.pivot + 1;
      for (; slot <= place.pivot + place.below; ++slot) entries_.push_back({index_[at(slot)], p, slot});
      for (; slot <= place.pivot + place.below + place.right; ++slot)
        above[at(index_[at(slot)] - first)].push_back({p, index_[at(slot)], slot});
    }
    for (int p = end - 1; p >= first; --p)
      entries_.insert(entries_.end(), above[at(p - first)].begin(), above[at(p - first)].end());
    for (int p = first; p < end; ++p) {
      for (int k = pattern.column_start[at(column_[at(p)])]; k < pattern.column_start[at(column_[at(p)]) + 1]; ++k) {
        const int row = row_place_[at(pattern.row_index[at(k)])];
        slot_[at(k)] = row >= first ? slot_in_block(row, p) : static_cast<int>(index_.size());
        if (row >= first) continue;
        entries_.push_back({row, p, slot_[at(k)]});
        index_.push_back(row);
      }
    }
  }
}

// Where entry (row, column) of a block stands: with the pivot of the earlier of both.
int EliminationList::slot_in_block(int row_place, int column_place) const {
  const Place& place = places_[at(std::min(row_place, column_place))];
  if (row_place == column_place) return place.pivot;
  const int begin = row_place > column_place ? place.pivot + 1 : place.pivot + 1 + place.below;
  const int end = row_place > column_place ? begin + place.below : begin + place.right;
  const int wanted = std::max(row_place, column_place);
  return static_cast<int>(std::lower_bound(index_.begin() + begin, index_.begin() + end, wanted) - index_.begin());
}

void EliminationList::factor(std::span<const double> values) {
  // Entries that fill in begin at zero.
  std::fill(value_.begin(), value_.end(), 0.0);
  for (std::size_t k = 0; k < values.size(); ++k) value_[at(slot_[k])] = values[k] * entry_scale_[k];
  double* const value = value_.data();
  const int* target = target_.data();
  for (std::size_t p = 0; p < places_.size(); ++p) {
    const Place& place = places_[p];
    pivot_[p] = value[place.pivot];
    const double inverse = inverse_[p] = 1 / pivot_[p];
    const double* const below = value + place.pivot + 1;
    const double* const right = below + place.below;
    for (int i = 0; i < place.below; ++i) {
      const double multiplier = below[i] * inverse;
      for (int j = 0; j < place.right; ++j) value[*target++] -= multiplier * right[j];
    }
  }
  for (std::size_t k = 0; k < entries_.size(); ++k)
    factor_[k] = value[entries_[k].slot] * inverse_[at(entries_[k].target)];
}

double EliminationList::largest_multiplier(int place) const {
  const Place& at_place = places_[at(place)];
  double largest = 0;
  for (int k = at_place.pivot + 1; k <= at_place.pivot + at_place.below; ++k) {
    const double size = std::abs(value_[at(k)] * inverse_[at(place)]);
    if (!(size <= largest)) largest = size;
  }
  return largest;
}

template <class V>
void EliminationList::solve_in(std::span<V> x, std::span<const double> row_factor,
                               std::span<const double> column_factor, std::span<V> work) const {
  V* const w = work.data();
  for (std::size_t p = 0; p < row_.size(); ++p) w[p] = inverse_[p] * (row_factor[at(row_[p])] * x[at(row_[p])]);
  for (std::size_t k = 0; k < entries_.size(); ++k) w[entries_[k].target] -= factor_[k] * w[entries_[k].source];
  for (std::size_t p = 0; p < row_.size(); ++p)
    x[at(column_[p])] = column_factor.empty() ? w[p] : column_factor[at(column_[p])] * w[p];
}

template void EliminationList::solve_in(std::span<double>, std::span<const double>, std::span<const double>,
                                        std::span<double>) const;
template void EliminationList::solve_in(std::span<Lanes>, std::span<const double>, std::span<const double>,
                                        std::span<Lanes>) const;

void EliminationList::solve_transposed(std::span<double> x, std::span<const double> row_factor,
                                       std::span<const double> column_factor) {
  double* const w = work_.data();
  for (std::size_t p = 0; p < row_.size(); ++p)
    w[p] = column_factor.empty() ? x[at(column_[p])] : x[at(column_[p])] * column_factor[at(column_[p])];
  for (std::size_t k = entries_.size(); k-- > 0;) w[entries_[k].source] -= factor_[k] * w[entries_[k].target];
  for (std::size_t p = 0; p < row_.size(); ++p) x[at(row_[p])] = w[p] * inverse_[p] * row_factor[at(row_[p])];
}

}  // namespace catena
