// Numbers of a group of designs: lane_count values a number, aligned for the widest packs.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <new>

#include "catena/analysis/batch/kernels/lane_code.hpp"

namespace catena {

class LaneNumbers {
 public:
  LaneNumbers() = default;
  /// So many numbers, zero in all lanes.
  explicit LaneNumbers(int numbers) : size_(static_cast<std::size_t>(lane_count * std::max(numbers, 1))) {
    data_.reset(static_cast<double*>(::operator new[](size_ * sizeof(double), alignment)));
    std::fill(data_.get(), data_.get() + size_, 0.0);
  }

  LaneNumbers(const LaneNumbers& other) : size_(other.size_) {
    if (!other.data_) return;
    data_.reset(static_cast<double*>(::operator new[](size_ * sizeof(double), alignment)));
    copy(other);
  }
  LaneNumbers(LaneNumbers&&) noexcept = default;
  LaneNumbers& operator=(LaneNumbers&&) noexcept = default;
  ~LaneNumbers() = default;

  double* data() { return data_.get(); }
  const double* data() const { return data_.get(); }
  /// The values of a number, one a lane.
  double* operator[](int number) { return data_.get() + lane_count * number; }
  const double* operator[](int number) const { return data_.get() + lane_count * number; }
  std::size_t values() const { return size_; }
  /// The values of one lane into all.
  void spread(int lane) {
    for (double* number = data(); number != data() + size_; number += lane_count)
      std::fill(number, number + lane_count, number[lane]);
  }
  /// Takes over the values of as many numbers.
  void copy(const LaneNumbers& from) { std::copy(from.data(), from.data() + size_, data()); }

 private:
  static constexpr std::align_val_t alignment{64};
  struct Free {
    void operator()(double* memory) const { ::operator delete[](memory, alignment); }
  };
  std::size_t size_ = 0;
  std::unique_ptr<double[], Free> data_;
};

}  // namespace catena
