// Passes rows on and keeps the least and the largest value of every column, with the instants of their rows.
//
// Where several rows have them, the first one's. Values that are not finite do not count.
#pragma once

#include <vector>

#include "catena/base/row_sink.hpp"

namespace catena {

struct ColumnExtreme {
  std::string name;
  std::string unit;
  double least = 0, largest = 0;
  double least_t = 0, largest_t = 0;  ///< s; the row's number, from 0, where rows have no time
  bool any = false;                   ///< whether there was a value
  std::string differentiated_unit;    ///< of a derivative, as in ColumnInfo
};

class ColumnExtremes final : public RowSink {
 public:
  explicit ColumnExtremes(RowSink& target) : target_(target) {}

  void begin(std::span<const ColumnInfo> columns) override;
  bool row(std::span<const double> values) override;

  /// Of all columns but the time; none before there are two rows.
  std::vector<ColumnExtreme> extremes() const;
  bool timed() const { return timed_; }

 private:
  RowSink& target_;
  std::vector<ColumnExtreme> all_;
  std::vector<bool> is_status_;  // of a column: its values are no numbers
  bool timed_ = false;
  std::size_t rows_ = 0;
};

}  // namespace catena
