// Rows as CSV (RFC 4180): a line of column names, then one line a row; "\r\n" ends a line.
//
// Numbers are exact, a number that is not finite leaves its field empty, names with commas, quotes or line ends are
// quoted. Units are not in the file, so that every reader takes the names as they are: the report beside it has them.
#pragma once

#include <string>
#include <vector>

#include "catena/results/row_writer.hpp"

namespace catena {

class CsvWriter final : public RowWriter {
 public:
  /// Writes to `output`, which must outlive the writer; failures are kept by it and do not stop the analysis.
  explicit CsvWriter(TextOutput& output) : output_(output) {}

  void begin(std::span<const ColumnInfo> columns) override;
  bool row(std::span<const double> values) override;

 private:
  TextOutput& output_;
  std::string line_;
  std::vector<bool> is_status_;  // by column
};

}  // namespace catena
