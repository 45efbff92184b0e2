// How measures scatter where the parameters of a sweep are distributed: from its designs, and to first order.
//
//   mean = sum m_k / n,  deviation^2 = sum (m_k - mean)^2 / (n - 1)       over the n designs that could be analysed
//   first order: m at the means of the parameters, deviation^2 = sum (dm/dp sigma_p)^2
//
// m the measures, p the parameters, independent of each other, sigma_p their deviations, (b - a)/sqrt(12) of one that
// is uniform between a and b. First order is exact where m is linear in p. Sums by Welford's recurrence: B. P. Welford,
// Technometrics 4 (1962), 419.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "catena/scene/running/analysis_run.hpp"

namespace catena {

class Scatter {
 public:
  /// Whether all that the sweep changes is distributed.
  static bool is_meant(const SweepRequest& request);
  explicit Scatter(std::size_t measures) : sums_(measures) {}

  /// The measures of a design that could be analysed.
  void add(std::span<const double> measures);
  /// A record a measure: `measure`, `mean`, `deviation`; `first_order_mean`, `first_order_deviation`, and of it
  /// `due_to` each parameter, dm/dp sigma_p. Runs the analyses once, at the means, with gradients. Adds to `warnings`
  /// what cannot be told.
  std::vector<FieldRecord> records(const AnalysisContext& context, std::vector<std::string>& warnings) const;

 private:
  struct Sum {
    double mean = 0, squares = 0;
  };
  std::int64_t designs_ = 0;
  std::vector<Sum> sums_;
};

}  // namespace catena
