// The largest value of a quantity along a motion, located between samples.
//
// Where a sample is larger than its neighbours, or the parabola through the first or last three of a part has its top
// inside, and that top would be the largest so far, the top is located: by the polynomial through all samples, or,
// where that fails, by parabolas until it is known to a fiftieth of the part; then by the polynomial of degree six
// through seven instants around it, whose derivative vanishes there. Its error is of the order (1/50)^6 of what the
// part's own quartic leaves, so that the derivative of the value at this fixed instant is that of the largest value
// (the instant's own change counts to second order). At kinks, where no polynomial serves, the golden section is halved
// on.
#pragma once

#include <algorithm>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "catena/analysis/measures/motion_samples.hpp"

namespace catena {

class Extreme {
 public:
  /// quantity(values of the columns): what is to be largest.
  using Quantity = std::function<double(std::span<const double>)>;
  explicit Extreme(Quantity quantity) : quantity_(std::move(quantity)) {}

  /// Of its size: what the quantity is known to, if not better.
  void know_accuracy(double part) { tie_ = std::max(tie_, part); }
  void add(const MotionSamples& samples, const MotionSamples::Part& part, const MotionPiece& piece,
           bool with_derivative);
  /// An instant by itself.
  void add(const MotionSample& sample);

  bool empty() const { return !best_; }
  /// Its value is quantity(best().value).
  const MotionSample& best() const { return *best_; }
  double value() const { return largest_; }
  /// Other instants where the quantity is as large to 1e-9 of its size, or to what it is known to: ties.
  const std::vector<MotionSample>& others() const { return others_; }
  /// With ties and derivatives: the largest size of a derivative (by its number in a sample) at these instants and
  /// others between.
  double slope_nearby(std::size_t number) const { return number < slopes_.size() ? slopes_[number] : 0; }
  /// An instant at which the quantity is not a number; nothing if it is one everywhere.
  const std::optional<double>& undefined() const { return undefined_; }

 private:
  struct Peak {
    double t, value;
  };
  using At = std::function<std::optional<double>(double)>;
  std::optional<Peak> locate(Peak a, Peak middle, Peak b, std::optional<Peak> guess, double length,
                             const MotionPiece& piece, const At& at) const;
  std::optional<Peak> settle(double centre, double h, double known, const MotionPiece& piece, const At& at) const;
  /// Samples within `reach` of the best, s, belong to the same top, unless `valley`, the lowest value between, is below
  /// both.
  void consider(MotionSample sample, double value, double reach, double valley);
  void note_slopes(const MotionSample& sample);

  Quantity quantity_;
  std::optional<MotionSample> best_;
  double largest_ = 0, size_ = 0;
  double lowest_ = std::numeric_limits<double>::infinity();  // of the samples since the best
  double tie_ =
      1e-9;  // two values that differ by less than this part of the size are a tie: instants are known to 1e-10
  std::vector<MotionSample> others_;
  std::vector<double> slopes_;
  std::optional<double> undefined_;
};

}  // namespace catena
