// Rows kept in memory, one after the other, for use in C++.
#pragma once

#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "catena/base/row_sink.hpp"

namespace catena {

class ResultStorage final : public RowSink {
 public:
  /// Keeps at most `limit` values (eight bytes each) and stops the analysis at the first row beyond that; the rows kept
  /// remain.
  explicit ResultStorage(std::size_t limit = std::numeric_limits<std::size_t>::max()) : limit_(limit) {}

  void begin(std::span<const ColumnInfo> columns) override;
  bool row(std::span<const double> values) override;

  std::span<const ColumnInfo> columns() const { return columns_; }
  std::size_t rows() const { return rows_; }
  // Row and column numbers out of range throw std::out_of_range.

  /// Values of a row, in the order of the columns.
  std::span<const double> operator[](std::size_t row) const {
    require(row, rows_, "row");
    return std::span(values_).subspan(row * columns_.size(), columns_.size());
  }
  double at(std::size_t row, std::size_t column) const {
    require(row, rows_, "row");
    require(column, columns_.size(), "column");
    return values_[row * columns_.size() + column];
  }
  /// All rows behind each other.
  std::span<const double> values() const { return values_; }
  std::optional<std::size_t> find(std::string_view column) const;
  /// All values of a column; an empty vector if there is none of this name.
  std::vector<double> column(std::string_view name) const;

 private:
  static void require(std::size_t number, std::size_t count, const char* what) {
    if (number < count) return;
    throw std::out_of_range(std::string("there is no ") + what + " number " + std::to_string(number) + " among " +
                            std::to_string(count));
  }

  std::size_t limit_;
  std::size_t rows_ = 0;
  std::vector<ColumnInfo> columns_;
  std::vector<double> values_;
};

}  // namespace catena
