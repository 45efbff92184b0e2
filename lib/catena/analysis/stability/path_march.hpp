// One run along a path of equilibria (path.hpp): its start, its steps, and what is done at critical points between
// them.
//
// A step goes a given length along the tangent t and is corrected on the plane across it,
//
//   <t, x - x0> = s,      s halved where Newton fails, the direction bends by more than 25 degrees, or the points at
//   its
//                         ends do not lie on one smooth path
//
// Where the number of negative modes changes, the critical points in the step get rows and records; at the first branch
// point the path goes over to another branch if that was asked for. The value at which the path is to end is reached
// exactly: from the prediction if that is near, else by interpolation along the step. Singular: no step of 1e-9 can be
// made; a value that the scene does not allow.
#pragma once

#include <functional>

#include "catena/analysis/run/watched_elements.hpp"
#include "catena/analysis/spectrum/certificate.hpp"
#include "catena/analysis/stability/path.hpp"

namespace catena {

class Path::March {
 public:
  March(Path& path, const std::function<bool(double, const Snapshot&)>& observe)
      : path_(path),
        system_(path.path_),
        options_(path.options_),
        observe_(observe),
        to_(path.options_.to),
        watched_(path.evaluator_) {}

  Report run(PathReport& report);
  const PathPoint& point() const { return x_; }

 private:
  enum class Progress { going, finished, stuck, cancelled };

  // The equilibrium at the present value: the configuration itself if it is one, else the nearest stable one.
  Report find_start();
  // A start without stiffness against some motion: where paths cross, one of them must have been chosen.
  Report start_at_critical_point(const Certificate& certificate);
  // Why no row is written any more: an element has left its curve, or the user stopped.
  Report stopped() const;
  bool write(const PathPoint& x);
  bool passes_end(double before, double after) const { return (before - to_) * (after - to_) <= 0 && before != to_; }

  // Whether one smooth path leads from the present point to the next one: it leaves its tangent by no more of its way
  // than its direction turns. A path that ends, and another that begins beside it, do not meet.
  bool is_smooth(const PathPoint& next, const PathPoint& direction) const;
  // The end itself where the prediction reaches it; false if it is not near the prediction: the path bends before it.
  bool step_to_end(PathPoint& next, double& s);
  // The point with the wanted value of the parameter between the start of the step and `s`; then s is its place.
  bool find_end(PathPoint& next, double& s);
  // From the present point to the next one.
  Progress step();
  // Rows and records of the critical points in a step; `left`: the path went over to another branch. False: cancelled.
  bool pass(const std::vector<CriticalPoint>& points, bool& left);
  // Onto the branch that crosses at the critical point, to the side asked for.
  bool leave(const CriticalPoint& critical);

  Path& path_;
  PathSystem& system_;
  const PathOptions& options_;
  const std::function<bool(double, const Snapshot&)>& observe_;
  PathReport* report_ = nullptr;
  PathPoint x_, direction_;
  double to_, length_ = 0;
  WatchedElements watched_;
  Report left_curve_;
  int modes_ = 0;
  bool switched_ = false;
};

}  // namespace catena
