#include "catena/results/result_storage.hpp"

namespace catena {

void ResultStorage::begin(std::span<const ColumnInfo> columns) {
  columns_.assign(columns.begin(), columns.end());
  values_.clear();
  rows_ = 0;
}

bool ResultStorage::row(std::span<const double> values) {
  if (values.size() > limit_ - values_.size()) return false;
  values_.insert(values_.end(), values.begin(), values.end());
  ++rows_;
  return true;
}

std::optional<std::size_t> ResultStorage::find(std::string_view column) const {
  for (std::size_t k = 0; k < columns_.size(); ++k) {
    if (columns_[k].name == column) return k;
  }
  return {};
}

std::vector<double> ResultStorage::column(std::string_view name) const {
  std::vector<double> values;
  const std::optional<std::size_t> k = find(name);
  for (std::size_t r = 0; k && r < rows_; ++r) values.push_back(at(r, *k));
  return values;
}

}  // namespace catena
