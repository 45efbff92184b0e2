// A design in lanes between its rows: the mechanism at any instant that measures ask for, at several instants at once.
//
// Every lane holds the same design at another instant. Newton's iteration starts from the quintic of Hermite through
// the two rows around it,
//
//   q = sum of weights (u) x q, h qd, h^2 qdd of both       u = (t - t0) / h      h = t1 - t0
//
// which is so near that no other branch is: a correction above 1e-2 rad or length scales, a block that changes the sign
// of its determinant, or one that comes near to a singular position, is taken for a motion that has to be followed in
// other ways; then lost() tells so.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "catena/analysis/batch/lane_columns.hpp"
#include "catena/analysis/batch/lane_motion.hpp"
#include "catena/columns/snapshot.hpp"

namespace catena {

class LaneLook {
 public:
  /// `program` must outlive this object, `evaluator` is that of its plan and is set to every instant that is looked at.
  /// `columns`: what values() gives, if lanes have them.
  LaneLook(const LaneProgram& program, Evaluator& evaluator, std::optional<LaneColumns> columns);

  bool has_columns() const { return columns_.has_value(); }
  /// The design in a lane of a motion, whose evaluator has been given its model; `instants` are those of its rows, in
  /// order. All of them must outlive the looks.
  void follow(const LaneMotion& motion, int lane, const Model& model, std::span<const double> instants);
  /// The mechanism at an instant of the motion, valid until the next call; nothing where it is lost.
  std::optional<Snapshot> at(double t);
  /// Its columns there, without a snapshot, and its pace: how fast bodies turn, rad/s, and move, in length scales;
  /// nothing where it is lost.
  std::optional<double> values(double t, std::span<double> out);
  /// Instants that will be asked for, at most lane_count.
  void expect(std::span<const double> instants);
  bool lost() const { return lost_; }

 private:
  /// Where an instant is at hand: a row, or a lane in which it was looked at.
  struct Place {
    int row, lane;
  };
  std::optional<Place> find(double t);
  std::optional<Place> find_seen(double t);
  bool row_at(double t);
  double pace_of(const double* qd, int lane) const;
  void foretell(int lane, double t);
  bool is_sound(int lane) const;
  Snapshot show(double t, double residual);

  LaneSolver solver_;
  Evaluator& evaluator_;
  std::optional<LaneColumns> columns_,
      row_columns_;  // of the instants in lanes; of one row
  const LaneMotion* motion_ = nullptr;
  int motion_lane_ = 0;
  std::span<const double> instants_;
  LaneState seen_;
  std::array<bool, lane_count> is_seen_{};
  std::array<int, lane_count> row_before_{};  // of the instants in lanes
  int next_lane_ = 0,
      next_row_ = 0;                           // where instants are looked for first: they come in order
  std::vector<double> q_, qd_, qdd_, lambda_;  // of a snapshot, in plan order
  std::vector<CurvePlace> places_;             // of a snapshot
  std::vector<Vec2<double>> shift_;            // from the origins of the evaluator's
                                               // coordinates to that of the frames
  bool lost_ = false;
};

}  // namespace catena
