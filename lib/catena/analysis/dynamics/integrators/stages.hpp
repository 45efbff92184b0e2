// Slopes k_i at the stages of a step (tableau.hpp), and weighted sums of them.
#pragma once

#include <span>
#include <vector>

#include "catena/analysis/motion/tableau.hpp"

namespace catena {

class Stages {
 public:
  /// Room for the stages of every method, with those of its interpolant.
  explicit Stages(std::size_t size) : slope_(16, std::vector<double>(size, 0.0)) {}

  std::size_t size() const { return slope_.size(); }
  std::vector<double>& operator[](std::size_t stage) { return slope_[stage]; }
  const std::vector<double>& operator[](std::size_t stage) const { return slope_[stage]; }

  /// out = from + h sum weight k; `from` may be empty.
  void combine(const StageSum& sum, double h, std::span<const double> from, std::span<double> out) const;
  /// The same of one entry, without h.
  double sum(const StageSum& weights, std::size_t entry) const {
    double all = 0;
    for (const StageTerm& term : weights) all += term.weight * slope_[static_cast<std::size_t>(term.stage)][entry];
    return all;
  }

 private:
  std::vector<std::vector<double>> slope_;
};

}  // namespace catena
