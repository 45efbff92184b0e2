// How many digits of the columns are right where mechanisms side by side are integrated apart: each of them carries the
// error of its own motion (motion_accuracy.hpp) and judges the columns that are named in it.
//
//   e = sum over the parts in which the column is named of the part's e           size: that of the rows of all
//
// A column of one body is in one part alone; energies and momenta are sums over all of them, t is that of every part.
// Nothing is said of columns that no part knows by name, those of points and own ones among them, and of those of a
// part whose own error is lost or that has contacts.
#pragma once

#include <memory>
#include <vector>

#include "catena/analysis/accuracy/motion_accuracy.hpp"
#include "catena/analysis/dynamics/dynamics_of_islands.hpp"

namespace catena {

class AccuracyOfIslands final : public RowAccuracy {
 public:
  /// Of the rows of analysis.run(); both must outlive this object, and it the run.
  AccuracyOfIslands(DynamicsOfIslands& analysis, const ColumnSet& columns, const ColumnSources& sources);
  ~AccuracyOfIslands() override;

  void take(const Snapshot& snapshot, std::span<const double> values) override;
  std::vector<double> digits(const AnalysisReport& report) override;

 private:
  class Part;
  DynamicsOfIslands& analysis_;
  const ColumnSet& columns_;
  ColumnErrors errors_;
  std::vector<std::unique_ptr<Part>> parts_;
};

}  // namespace catena
