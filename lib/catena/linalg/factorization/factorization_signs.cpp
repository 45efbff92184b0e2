// Block determinants in one scale: their sign is the product of the pivots' signs and the parity of the row exchanges
// within a block, their size that of the pivots but for what rows were scaled by.
#include <algorithm>
#include <cmath>
#include <limits>

#include "catena/linalg/factorization/factorization.hpp"

namespace catena {

// Place k of a block holds the row that stood at place p(k) before pivoting; the parity of p by its cycles.
void Factorization::find_parities() {
  const std::span<const int> before = klu_.row_order(), after = klu_.pivot_rows();
  const std::size_t n = before.size();
  place_of_row_.resize(n);
  cycle_.resize(n);
  parities_.resize(static_cast<std::size_t>(form_.blocks));
  for (std::size_t k = 0; k < n; ++k) place_of_row_[static_cast<std::size_t>(before[k])] = static_cast<int>(k);
  for (std::size_t k = 0; k < n; ++k) cycle_[k] = place_of_row_[static_cast<std::size_t>(after[k])];
  for (int block = 0; block < form_.blocks; ++block) {
    bool odd = false;
    const auto first = static_cast<std::size_t>(form_.block_start[static_cast<std::size_t>(block)]);
    const auto last = static_cast<std::size_t>(form_.block_start[static_cast<std::size_t>(block) + 1]);
    for (std::size_t k = first; k < last; ++k) {
      // Walking a cycle marks it; every exchange after its first member changes the parity.
      while (cycle_[k] != static_cast<int>(k)) {
        std::swap(cycle_[k], cycle_[static_cast<std::size_t>(cycle_[k])]);
        odd = !odd;
      }
    }
    parities_[static_cast<std::size_t>(block)] = odd ? -1 : 1;
  }
  const std::span<const double> scale = klu_.row_scale();
  rescaling_.clear();
  if (first_scale_.empty()) {
    first_scale_.assign(scale.begin(), scale.end());
  } else if (!std::equal(scale.begin(), scale.end(), first_scale_.begin())) {
    for (const int row : after) {
      rescaling_.push_back(first_scale_[static_cast<std::size_t>(row)] / scale[static_cast<std::size_t>(row)]);
    }
  }
  parities_are_current_ = true;
}

std::span<const BlockMargin> Factorization::block_margins() {
  require_factors();
  if (umfpack_in_use_ || form_.blocks == 0) return {};
  if (margins_are_current_) return margins_;
  if (!parities_are_current_) find_parities();
  margins_.resize(static_cast<std::size_t>(form_.blocks));
  const std::span<const double> pivots = klu_.pivots();
  for (std::size_t block = 0; block < margins_.size(); ++block) {
    const int first = form_.block_start[block], last = form_.block_start[block + 1];
    const bool large = last - first > BlockMargin::largest_block;
    bool negative = parities_[block] < 0;
    double least = std::numeric_limits<double>::infinity(), product = 1;
    for (int k = first; k < last; ++k) {
      const double pivot = pivots[static_cast<std::size_t>(k)];
      const double size = std::abs(pivot) * (rescaling_.empty() ? 1 : rescaling_[static_cast<std::size_t>(k)]);
      negative ^= pivot < 0;
      least = size < least ? size : least;
      product = large ? least : product * size;
    }
    margins_[block] = negative ? BlockMargin{-least, -product} : BlockMargin{least, product};
  }
  margins_are_current_ = true;
  return margins_;
}

}  // namespace catena
