// Connects an analysis, which observes instants, with a sink, which takes rows: evaluates the columns at every instant.
#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "catena/analysis/run/row_observer.hpp"
#include "catena/base/row_sink.hpp"
#include "catena/columns/column_set.hpp"

namespace catena {

class ColumnRows final : public RowObserver {
 public:
  /// Announces the columns to the sink. Both must outlive this object; `cancel`, if given, stops the analysis when set.
  ColumnRows(const ColumnSet& columns, RowSink& sink, const std::atomic<bool>* cancel = nullptr)
      : columns_(columns), sink_(sink), cancel_(cancel), values_(columns.size()) {
    sink_.begin(columns_.info());
  }

  bool observe(const Snapshot& snapshot) override {
    columns_.evaluate(snapshot, values_);
    ++rows_;
    return sink_.row(values_) && !(cancel_ && cancel_->load(std::memory_order_relaxed));
  }

  std::int64_t rows() const { return rows_; }

 private:
  const ColumnSet& columns_;
  RowSink& sink_;
  const std::atomic<bool>* cancel_;
  std::vector<double> values_;
  std::int64_t rows_ = 0;
};

}  // namespace catena
