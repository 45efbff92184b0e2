// What columns claim of their errors beside the errors that they have, over many mechanisms.
//
//   optimism = true error / claimed error       one sample a column of a run; errors relative to the column's largest
//
// A true error below a quarter of the rounding of a double is counted as that: a column may be right by chance. Where
// exact values are themselves known to a noise only, a claim is optimistic by what the error beyond that noise says,
// and pessimistic by the error as it was measured: both are the least that can be said against it.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "scene/run_text.hpp"

namespace catena::testing {

class ClaimedDigits {
 public:
  /// A column of an analysis of a run beside exact values: of the rows numbered by `rows`, or of all of them, one each.
  /// Nothing where it claims nothing. `noise`: of the exact values, absolute.
  void add(const TextRun& run, const std::string& column, const std::vector<long double>& exact,
           const std::string& what = {}, std::size_t analysis = 0, const std::vector<std::size_t>& rows = {},
           long double noise = 0) {
    const AnalysisResult& result = run.analysis(analysis);
    const std::vector<double> values = run.column(column, analysis);
    ASSERT_EQ(rows.empty() ? values.size() : rows.size(), exact.size()) << column;
    std::size_t k = 0;
    while (k < result.columns.size() && result.columns[k].name != column) ++k;
    ++asked_;
    if (k >= result.digits.size() || std::isnan(result.digits[k])) return;
    double size = 0;
    for (const double value : values) size = std::max(size, std::abs(value));
    long double error = 0;
    for (std::size_t r = 0; r < exact.size(); ++r)
      error = std::max(error, std::abs(values.at(rows.empty() ? r : rows[r]) - exact[r]));
    const double claimed = std::pow(10.0, -result.digits[k]);
    const auto part_of = [&](long double of) {
      const double part = of == 0 ? 0 : size > 0 ? static_cast<double>(of / size) : 1e300;
      // A column that claims no digit may be off by more than it is large.
      return std::max(result.digits[k] == 0 ? std::min(part, 1.0) : part, least_error);
    };
    const double certain = part_of(std::max(0.0L, error - noise));
    samples_.push_back({claimed, certain, size > 0 ? part_of(error) : certain, what + " " + column});
  }

  std::size_t size() const { return samples_.size(); }
  std::size_t asked() const { return asked_; }
  /// Never more than ten times optimistic, half of the columns not more than a hundred times pessimistic.
  void expect(const std::string& title) {
    ASSERT_FALSE(samples_.empty());
    std::sort(samples_.begin(), samples_.end(),
              [](const Sample& a, const Sample& b) { return a.optimism() > b.optimism(); });
    const auto at_part = [&](double part) {
      return samples_[static_cast<std::size_t>(part * static_cast<double>(samples_.size() - 1))].optimism();
    };
    // Pessimism is judged where most of an error is no noise of the exact values.
    std::vector<double> judged;
    for (const Sample& sample : samples_) {
      if (2 * sample.certain >= sample.error) judged.push_back(sample.error / sample.claimed);
    }
    ASSERT_FALSE(judged.empty());
    std::nth_element(judged.begin(), judged.begin() + static_cast<std::ptrdiff_t>(judged.size() / 2), judged.end());
    const double median = judged[judged.size() / 2];
    std::printf(
        "%s: %zu of %zu columns; true / claimed error %.3g (most), %.3g (1 %%), %.3g (99 %%); median of %zu: %.3g\n",
        title.c_str(), samples_.size(), asked_, samples_[0].optimism(), at_part(0.01), at_part(0.99), judged.size(),
        median);
    for (std::size_t k = 0; k < samples_.size() && samples_[k].optimism() > 10 && k < 20; ++k)
      ADD_FAILURE() << samples_[k].what << ": claimed " << samples_[k].claimed << ", true " << samples_[k].certain;
    EXPECT_GE(median, 0.01);
    // For a plot: CATENA_DIGITS_TABLE names a file, one line a column.
    if (const char* path = std::getenv("CATENA_DIGITS_TABLE")) {
      std::ofstream file(path, std::ios::app);
      for (const Sample& s : samples_) file << title << "," << s.claimed << "," << s.error << "," << s.what << "\n";
    }
  }

 private:
  static constexpr double least_error = std::numeric_limits<double>::epsilon() / 4;
  struct Sample {
    double claimed, certain, error;  // certain: what is left of the error beyond the noise of exact values
    std::string what;
    double optimism() const { return certain / claimed; }
  };
  std::vector<Sample> samples_;
  std::size_t asked_ = 0;
};

}  // namespace catena::testing
