// Receives the state of a mechanism at the instants of an analysis.
#pragma once

#include "catena/columns/snapshot.hpp"

namespace catena {

class RowObserver {
 public:
  virtual ~RowObserver() = default;
  /// Called at every row; quantities that were not needed are empty spans. Returning false cancels the analysis.
  virtual bool observe(const Snapshot& snapshot) = 0;
  /// Called now and then between rows that are far apart, with the time reached. Returning false cancels.
  virtual bool proceed(double t) {
    static_cast<void>(t);
    return true;
  }
};

/// Adapts a callable.
template <class F>
class RowFunction final : public RowObserver {
 public:
  explicit RowFunction(F f) : f_(std::move(f)) {}
  bool observe(const Snapshot& snapshot) override { return f_(snapshot); }

 private:
  F f_;
};

}  // namespace catena
