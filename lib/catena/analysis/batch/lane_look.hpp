// Looks at the motion of one design between the rows that its lane has been followed to, at several instants at once.
//
// Every lane holds the same design at another instant. Newton's iteration starts from the quintic through the two rows
// around it, which is so near that no other branch is: a correction above 1e-2 rad or length scales, a block that
// changes the sign of its determinant, or one that comes near to a singular position, is taken for a motion that has to
// be followed in other ways; then lost() tells so.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "catena/analysis/batch/lane_motion.hpp"
#include "catena/columns/snapshot.hpp"

namespace catena {

class LaneLook {
 public:
  /// `program` must outlive this object, `evaluator` is that of its plan and is set to every instant that is looked at.
  LaneLook(const LaneProgram& program, Evaluator& evaluator);

  /// The design in a lane of a motion, whose evaluator has been given its model; `instants` are those of its rows, in
  /// order. All of them must outlive the looks.
  void follow(const LaneMotion& motion, int lane, const Model& model, std::span<const double> instants);
  /// The mechanism at an instant of the motion, valid until the next call; nothing where it is lost.
  std::optional<Snapshot> at(double t);
  /// The row number k.
  Snapshot row(std::size_t k);
  /// Instants that will be asked for, at most lane_count.
  void expect(std::span<const double> instants);
  bool lost() const { return lost_; }

 private:
  void gather(int lane, double t);
  Snapshot show(double t, double residual);

  LaneSolver solver_;
  Evaluator& evaluator_;
  const LaneMotion* motion_ = nullptr;
  int motion_lane_ = 0;
  std::span<const double> instants_;
  LaneState before_, after_, seen_;
  std::array<bool, lane_count> is_seen_{};
  std::vector<double> q_, qd_, qdd_;  // of a snapshot, in plan order
  std::vector<Vec2<double>> shift_;   // from the origins of the evaluator's coordinates to that of the frames
  bool lost_ = false;
};

}  // namespace catena
