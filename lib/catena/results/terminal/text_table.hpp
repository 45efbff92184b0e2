// Rows as an aligned table for people: names, units, rounded numbers. A single row is set as a list, one line a column.
//
// Rows and columns that do not fit are counted in the output, never cut silently: the first and the last rows are
// shown, and as many columns as the width allows. Only the rows shown are kept, so that memory stays bounded.
#pragma once

#include <cstdint>
#include <string>

#include "catena/base/row_sink.hpp"

namespace catena {

struct TableLimits {
  std::size_t first_rows = 15;  ///< shown from the beginning
  std::size_t last_rows = 5;    ///< and from the end
  std::size_t width = 120;      ///< characters a line
  std::size_t list_lines = 45;  ///< columns shown of a single row
  /// Shows everything, regardless of the other limits.
  static TableLimits none();
};

class TextTable final : public RowSink {
 public:
  explicit TextTable(const TableLimits& limits = {}) : limits_(limits) {}

  void begin(std::span<const ColumnInfo> columns) override;
  bool row(std::span<const double> values) override;

  struct Text {
    std::string lines;       ///< each one ended; empty if there are no columns
    bool shortened = false;  ///< something was left out
  };
  /// The table so far. `digits`: how many of each column are right, NaN or none where that is not known; no others are
  /// shown.
  Text text(std::span<const double> digits = {}) const;

 private:
  Text list(std::span<const double> digits) const;
  Text grid(std::span<const double> digits) const;
  /// Of the values of a column, 0 where it is not known.
  double error_of(std::size_t column, std::span<const double> digits) const;
  std::size_t kept_rows() const { return kept_columns_ == 0 ? 0 : values_.size() / kept_columns_; }
  /// Values of a kept column from the first row shown to the last.
  std::vector<double> shown(std::size_t column) const;

  TableLimits limits_;
  std::vector<ColumnInfo> columns_;  // the kept ones
  std::size_t all_columns_ = 0, kept_columns_ = 0;
  std::vector<double> largest_;  // magnitude of these in all rows
  std::uint64_t rows_ = 0;
  std::vector<double> values_;  // rows kept; the last ones in a ring behind the first ones
};

}  // namespace catena
