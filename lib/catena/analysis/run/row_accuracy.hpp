// Finds how many digits of the columns of an analysis are right (columns/column_errors.hpp): sees every row, and is
// asked once after the run.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "catena/analysis/run/analysis_report.hpp"
#include "catena/columns/snapshot.hpp"

namespace catena {

class RowAccuracy {
 public:
  virtual ~RowAccuracy() = default;
  /// A row as the observer gets it, and the values of its columns.
  virtual void take(const Snapshot& snapshot, std::span<const double> values) = 0;
  /// Digits of every column, NaN where they are not known; nothing where those of no column are.
  virtual std::vector<double> digits(const AnalysisReport& report) = 0;
  /// After digits(): why it says nothing of the columns, or of some, where that is worth a sentence.
  virtual std::string why_none() const { return {}; }
  /// After digits(): how far the rows are from what was promised, where they are.
  virtual std::string doubt() const { return {}; }
};

}  // namespace catena
