#include "catena/results/column_extremes.hpp"

#include <cmath>

namespace catena {

void ColumnExtremes::begin(std::span<const ColumnInfo> columns) {
  all_.clear();
  rows_ = 0;
  timed_ = !columns.empty() && columns.front().unit == UnitKind::time;
  is_status_.clear();
  for (const ColumnInfo& column : columns) {
    all_.push_back({.name = column.name,
                    .unit = std::string(column.unit_text()),
                    .differentiated_unit = column.differentiated_unit});
    is_status_.push_back(column.is_status);
  }
  target_.begin(columns);
}

bool ColumnExtremes::row(std::span<const double> values) {
  const double t = timed_ ? values.front() : static_cast<double>(rows_);
  for (std::size_t k = 0; k < all_.size(); ++k) {
    ColumnExtreme& extreme = all_[k];
    if (is_status_[k] || !std::isfinite(values[k])) continue;
    if (!extreme.any || values[k] < extreme.least) {
      extreme.least = values[k];
      extreme.least_t = t;
    }
    if (!extreme.any || values[k] > extreme.largest) {
      extreme.largest = values[k];
      extreme.largest_t = t;
    }
    extreme.any = true;
  }
  ++rows_;
  return target_.row(values);
}

std::vector<ColumnExtreme> ColumnExtremes::extremes() const {
  if (rows_ < 2) return {};
  std::vector<ColumnExtreme> shown;
  for (std::size_t k = timed_ ? 1 : 0; k < all_.size(); ++k) {
    if (all_[k].any) shown.push_back(all_[k]);
  }
  return shown;
}

}  // namespace catena
