// The equations of static equilibrium of a group of designs, each lane at its own configuration: their numbers, and the
// kernels that compute with them (lane_static_code.hpp).
//
//   V_q + Phi_q^T lambda = 0      Phi = 0      functions of time frozen
//
// Coordinates as in LaneCode: x, y, phi of the moving bodies in the ground frame. Allocates when it is made.
#pragma once

#include <span>

#include "catena/analysis/batch/kernels/lane_static_code.hpp"
#include "catena/analysis/batch/lane_program.hpp"
#include "catena/assembly/evaluate.hpp"

namespace catena {

/// Some of the lanes, a bit each.
using LaneSet = unsigned;
inline bool has(LaneSet lanes, int lane) { return (lanes & 1U << lane) != 0; }
/// Calls f(lane) for each of them.
template <class F>
void for_each_lane(LaneSet lanes, F&& f) {
  for (int lane = 0; lane < lane_count; ++lane)
    if (has(lanes, lane)) f(lane);
}

class LaneStaticSystem {
 public:
  /// `program`, one of make_static(), must outlive this object.
  explicit LaneStaticSystem(const LaneProgram& program);

  /// Puts the design that an evaluator has, at its time, into a lane. False where a number is not finite.
  bool set_design(int lane, const Evaluator& evaluator);
  /// Lanes from here on are left out.
  void use(int lanes) { job_.equations.lanes = lanes; }

  // The kernels, at q.
  void look() { kernels().look(job_); }
  void weigh() { kernels().weigh(job_); }
  void reflect(LaneSet lanes);
  void balance() { kernels().balance(job_); }
  void curve() { kernels().curve(job_); }
  void stiffen() { kernels().stiffen(job_); }
  void step() { kernels().step(job_); }
  void correct(LaneSet lanes);
  void soften() { kernels().soften(job_); }
  /// lambda^T Phi, J: what the energy on the constraints exceeds that at q by, to first order.
  double missed(const LaneNumbers& multipliers, int lane) const;
  double told(LaneRest what, int lane) const { return told_[what][lane]; }

  int columns() const { return job_.columns; }
  int rows() const { return job_.equations.code->rows; }
  double length(int lane) const { return length_[0][lane]; }
  /// As StaticSystem::rounding_change(): length scales or rad.
  double rounding(int lane) const { return 1e-15 * told(rest_extent, lane) / length(lane); }
  Vec2<double> origin(int body, int lane) const { return {origin_[2 * body][lane], origin_[2 * body + 1][lane]}; }

  LaneNumbers q, lambda, change, next_lambda;
  LaneNumbers shift;       ///< of K, N/m
  LaneNumbers by_weights;  ///< 1 where corrections leave K out

 private:
  static const LaneStaticKernels& kernels();
  void set_mask(LaneSet lanes);

  const LaneProgram& program_;
  LaneNumbers field_, function_, frame_, unit_, matrix_, right_;
  LaneNumbers inverse_arm_, origin_, length_, mask_, gradient_;
  struct {
    LaneNumbers stiffness, reduced, reflector, factor, diagonal, lower;
  } factored_;
  LaneNumbers work_, told_;
  std::vector<int> entry_row_, entry_column_;
  LaneStaticJob job_{};
};

}  // namespace catena
