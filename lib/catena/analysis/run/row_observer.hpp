// Receives the state of a mechanism at the instants of an analysis, and, if it asks for it, anywhere between them.
#pragma once

#include <functional>
#include <optional>

#include "catena/columns/snapshot.hpp"

namespace catena {

/// A stretch of a motion, from one instant to a later one, in which the motion is smooth: one step of an integrator, or
/// a part of it. at(t): the mechanism at an instant of it; valid until the next one is asked for; nothing where it
/// cannot be had.
struct MotionStretch {
  double from = 0, to = 0;
  std::function<std::optional<Snapshot>(double)> at;
  /// May be empty. Told of instants of the stretch that will probably be asked for next, at most eight: an analysis
  /// that computes several at once does so.
  std::function<void(std::span<const double>)> expect = {};
  /// The event that ends it, by its number: in the list, then among the changes of the mechanism itself; -1: none.
  int ended_by = -1;
  /// The motion goes on in another way from its end, at an instant that the motion itself determines.
  bool ends_phase = false;

  void announce(std::span<const double> instants) const {
    if (expect) expect(instants);
  }
};

class StageWatcher;  // motion/stage_watcher.hpp

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
  /// Whether it wants to see the stretches between rows as well.
  virtual bool wants_stretches() const { return false; }
  /// One after the other and without gaps, each before the rows that lie in it. Returning false cancels.
  virtual bool cover(const MotionStretch& stretch) {
    static_cast<void>(stretch);
    return true;
  }
  /// What sees the stages of the steps; nullptr: nothing does.
  virtual StageWatcher* stage_watcher() { return nullptr; }
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
