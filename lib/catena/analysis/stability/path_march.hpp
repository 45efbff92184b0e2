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
#include <optional>

#include "catena/analysis/run/watched_elements.hpp"
#include "catena/analysis/spectrum/certificate.hpp"
#include "catena/analysis/spectrum/static_balance.hpp"
#include "catena/analysis/stability/path.hpp"
#include "catena/analysis/statics/solvers/static_gaps.hpp"

namespace catena {

/// The cosine between the directions at both ends of a step, at least.
inline constexpr double largest_bend = 0.9;

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
  // That configuration, with its multipliers, and how well they balance its loads; one-sided elements may be violated.
  Report take_place(Imbalance& left);
  // A start without stiffness against some motion: where paths cross, one of them must have been chosen.
  Report start_at_critical_point(const Certificate& certificate);
  // Why no row is written any more: an element has left its curve, or the user stopped.
  Report stopped() const;
  // Stability of the point x factored last; where it is not found, unjudged_ remembers the value.
  std::optional<PathStability> stability_of(const PathPoint& x);
  // Takes it as that of the present point; false where it is not found.
  bool judge(const PathPoint& x);
  // Why the path does not go on where stability is not known.
  Report unjudged() const;
  bool write(const PathPoint& x);
  bool passes_end(double before, double after) const { return (before - to_) * (after - to_) <= 0 && before != to_; }

  // Whether one smooth path leads from the present point to the next one: it leaves its tangent by no more of its way
  // than its direction turns. A path that ends, and another that begins beside it, do not meet.
  bool is_smooth(const PathPoint& next, const PathPoint& direction) const;
  // The end itself where the prediction reaches it; false if it is not near the prediction: the path bends before it.
  bool step_to_end(PathPoint& next, double& s);
  // The point with the wanted value of the parameter between the start of the step and `s`; then s is its place.
  bool find_end(PathPoint& next, double& s);
  // Whether one-sided elements change in a step by `s` that leads to `next`; then these are the first place where some
  // do, and changing_ says which. False in `located`: the step is too long to find it.
  bool change_within(PathPoint& next, double& s, bool& located);
  // Lets those that change do so at the present point, and turns the path to the side on which they hold.
  Report change_gaps();
  // The largest fault of those that change at a point; faults_ has all of them.
  double largest_fault(const PathPoint& x);
  // A point of the path ahead: its place on the step, whether it is the last, and how many iterations it took.
  struct Trial {
    PathPoint point;
    double s = 0;
    bool last = false;
    int iterations = 0;
  };
  // Solves a step of the present length, cut short where it passes the end of the path or a change. False: too long.
  bool find_next(Trial& trial);
  // A point ahead with the path's direction there.
  struct Side {
    double s = 0;
    PathPoint point, direction;
  };
  double angle(const PathPoint& a, const PathPoint& b) const;
  bool solve_at(double s, Side& side);
  // Whether the path has a corner within a step by `s`, and its point just behind.
  bool find_corner(double s, Side& behind);
  // The same where the path turns back at the present point, so that nothing lies ahead.
  bool find_turn(Side& behind);
  // To the point behind a corner; `written`: not cancelled. False, and nothing done, where something else comes first.
  bool go_round(Side behind, bool& written);
  // From the present point to the next one.
  Progress step();
  Progress turn_back();
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
  ActiveSet gaps_;
  std::vector<std::size_t> changing_;  // by their place in Plan::gap_rows
  std::vector<double> faults_;
  int changed_here_ = 0;  // how often some did without a step between
  PathStability modes_;
  std::optional<double> unjudged_;  // value of the parameter where stability was not found
  bool switched_ = false;
};

}  // namespace catena
