// What depends on the state of a design beside its equations, where kernels have no formulas for it: laws of state,
// springs with curves, ropes over pulleys. Every lane's design is looked at by an evaluator of its own.
//
//   Q(t, q, qd): all applied forces of a design, gravity included      into the loads of kernels (lane_loads.hpp)
//
// A lane is in trouble where a law has no value or leaves a table, where a rope means nothing, and from where a rope
// came to touch or to leave a pulley: its forces are then those of another way. Units: N, N m, m, rad, s.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "catena/analysis/batch/kernels/lane_code.hpp"
#include "catena/analysis/batch/lane_numbers.hpp"
#include "catena/analysis/run/rope_ways_at.hpp"
#include "catena/analysis/run/watched_elements.hpp"

namespace catena {

class LaneEvaluators {
 public:
  /// `moving`: bodies that kernels solve for.
  LaneEvaluators(std::shared_ptr<const Plan> plan, int moving) : plan_(std::move(plan)), moving_(moving) {}

  /// A lane's design; the model must outlive its use.
  void set_design(int lane, const Model& model);
  /// Follows the ropes of a lane's design from its given configuration once more: where it went since does not count.
  void start_anew(int lane) { lane_of(lane).begin_ropes(); }
  /// One design for all lanes, at instants in any order: ways of ropes are not followed.
  void set_designs(const Model& model);
  /// Goes to the state of a lane and looks at it: empty, or what is wrong there.
  const char* go_to(int lane, double t, const LaneNumbers& q, const LaneNumbers& qd);
  /// Applied forces at the state that a lane went to, of the moving bodies.
  void find(int lane, LaneNumbers& applied);

 private:
  struct Lane {
    Lane(std::shared_ptr<const Plan> plan, const Model& model);
    void begin_ropes();
    const char* follow_ropes();

    EvaluationWork work;
    Evaluator evaluator;
    WatchedElements watched;
    std::vector<double> q, qd, forces;  // plan order, places relative to the evaluator's origins
    std::optional<RopeWaysAt> ropes;    // where they are followed
    const char* lost = nullptr;
  };
  Lane& lane_of(int lane) { return *lanes_[static_cast<std::size_t>(are_one_ ? 0 : lane)]; }
  Lane& begin(int lane, const Model& model);

  std::shared_ptr<const Plan> plan_;
  int moving_;
  std::array<std::unique_ptr<Lane>, static_cast<std::size_t>(lane_count)> lanes_;
  bool are_one_ = false;
};

}  // namespace catena
