// Rows of numbers kept within a limit: where they become too many, every second one goes, and from then on only every
// second, fourth, eighth ... one is taken. The first and the last row are always there.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace catena {

class ThinnedRows {
 public:
  /// `limit`: of values, at least three rows of them.
  explicit ThinnedRows(std::size_t limit = 0) : limit_(limit) {}

  void begin(std::size_t width) { width_ = width; }
  void add(std::span<const double> row) {
    last_.assign(row.begin(), row.end());
    if (seen_++ % stride_ != 0) return;
    if (kept() >= 3 && (kept() + 1) * width_ > limit_) thin();
    if ((seen_ - 1) % stride_ == 0) values_.insert(values_.end(), row.begin(), row.end());
  }

  /// How many there were, and one in how many is kept.
  std::int64_t seen() const { return seen_; }
  std::int64_t stride() const { return stride_; }
  /// How many are there, the last one among them.
  std::size_t size() const { return kept() + (last_is_apart() ? 1 : 0); }
  std::span<const double> operator[](std::size_t k) const {
    return k < kept() ? std::span(values_).subspan(k * width_, width_) : std::span<const double>(last_);
  }
  /// The number among all rows of the one that is kept as k.
  std::int64_t number(std::size_t k) const { return k < kept() ? static_cast<std::int64_t>(k) * stride_ : seen_ - 1; }

 private:
  std::size_t kept() const { return width_ == 0 ? 0 : values_.size() / width_; }
  bool last_is_apart() const { return seen_ > 0 && width_ > 0 && (seen_ - 1) % stride_ != 0; }
  void thin() {
    std::size_t half = 0;
    for (std::size_t k = 0; k < kept(); k += 2, ++half) {
      for (std::size_t c = 0; c < width_; ++c) values_[half * width_ + c] = values_[k * width_ + c];
    }
    values_.resize(half * width_);
    stride_ *= 2;
  }

  std::size_t limit_, width_ = 0;
  std::int64_t seen_ = 0, stride_ = 1;
  std::vector<double> values_, last_;
};

}  // namespace catena
