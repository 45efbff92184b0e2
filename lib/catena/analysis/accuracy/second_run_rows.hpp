// The rows of the second run of a motion, for second_run.cpp and second_run_compared.cpp alone.
#pragma once

#include <functional>
#include <vector>

#include "catena/analysis/accuracy/second_run.hpp"

namespace catena {

/// Keeps those rows of the second run whose like was kept of the first.
class SecondRun::OtherRows final : public RowObserver {
 public:
  OtherRows(const ColumnSet& columns, std::int64_t every, const std::function<bool()>& proceed, bool keeps_places)
      : columns_(columns), every_(every), proceed_(proceed), keeps_places_(keeps_places), row_(columns.size()) {}
  bool observe(const Snapshot& snapshot) override {
    if (given++ % every_ != 0) return proceed_();
    columns_.evaluate(snapshot, row_);
    t.push_back(snapshot.t);
    values.insert(values.end(), row_.begin(), row_.end());
    if (keeps_places_) places.take(snapshot.q);
    return proceed_();
  }
  bool proceed(double) override { return proceed_(); }

  std::vector<double> t, values;
  ToleranceCheck places;
  std::int64_t given = 0;

 private:
  const ColumnSet& columns_;
  std::int64_t every_;
  const std::function<bool()>& proceed_;
  bool keeps_places_;
  std::vector<double> row_;
};

}  // namespace catena
