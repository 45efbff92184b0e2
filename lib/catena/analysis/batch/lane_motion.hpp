// The motions of a group of designs, followed side by side from row to row: positions, velocities, accelerations.
//
// Every lane steps from one of its rows to the next under the rules by which Kinematics accepts a step
// (kinematics/kinematics_march.cpp): the prediction was close, Newton contracted well, no body turned far, and no
// block's determinant changed its sign or fell towards zero; and places of contact went on as they did before. A lane
// that breaks one halves its own step while the others wait; one that cannot go on, or comes so near to a singular
// position that more is needed than a step, leaves the group with the reason, and nothing of the others changes. Such
// designs are for Kinematics itself. Allocates when it is made, and where a group has more rows than any before.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "catena/analysis/batch/lane_solver.hpp"
#include "catena/analysis/kinematics/course/contact_jumps.hpp"

namespace catena {

// Below this part of its largest value, or of 1 in rad and length scales, a determinant leaves positions, which meet
// the equations to 1e-15, with an error of 1e-12.
inline constexpr double least_margin = 1e-3;

class LaneMotion {
 public:
  /// `program` must outlive this object.
  explicit LaneMotion(const LaneProgram& program);

  /// Puts a design into a lane, at its given configuration. The model must outlive the motion. Lanes that are not used
  /// hold the first design once more. False where a number of it is not finite.
  bool set_design(int lane, const Model& model, double length_scale);
  LaneSolver& solver() { return solver_; }
  const LaneSolver& solver() const { return solver_; }
  /// Another configuration to start from: x, y, phi of the moving bodies in the ground frame; where the model's
  /// contacts on curves were found there.
  void set_start(int lane, std::span<const double> q, std::span<const CurvePlace> places);

  /// Solves for positions at t, one instant a lane, from the start in every lane. Returns the lanes in which the start
  /// was so near that the assembled configuration is the nearest one, as Kinematics judges it.
  unsigned assemble(const std::array<double, lane_count>& t);
  /// Goes through the rows of lanes, all as many, from where they were assembled: instant(row, lane). Lanes that leave
  /// the group are no longer in alive().
  template <class Instant>
  void run(unsigned lanes, int rows, Instant&& instant) {
    begin(lanes, rows);
    for (int k = 0; k < rows && alive_ != 0; ++k) {
      std::array<double, lane_count> t{};
      for (int lane = 0; lane < lane_count; ++lane) t[static_cast<std::size_t>(lane)] = instant(k, lane);
      row_ = &rows_[static_cast<std::size_t>(k)];
      move_to(t);
      keep_row();
    }
    use_own_states();
  }

  unsigned alive() const { return alive_; }
  /// Why a lane left the group.
  const std::string& why(int lane) const { return why_[static_cast<std::size_t>(lane)]; }
  /// A row that was computed elsewhere: x, y, phi in the ground frame, and rates where there are some.
  void put_row(int row, int lane, std::span<const double> q, std::span<const double> qd, std::span<const double> qdd,
               std::span<const double> lambda);
  /// Rows without numbers.
  void clear_rows(int lane, int rows);
  int coordinates() const { return coordinates_; }
  int tails() const { return tails_; }
  /// x, y, phi of the moving bodies of all lanes at a row; their rates.
  const double* q(int row) const { return row_of(row).q.data(); }
  const double* qd(int row) const { return row_of(row).qd.data(); }
  const double* qdd(int row) const { return row_of(row).qdd.data(); }
  /// Cosine and sine of the angle of every moving body.
  const double* turned(int row) const { return row_of(row).turned.data(); }
  /// Multipliers of the solver's rows, where the program has loads.
  const double* lambda(int row) const { return row_of(row).lambda.data(); }
  const double* margin(int row) const { return row_of(row).margin.data(); }
  const LaneNumbers& places(int row) const { return row_of(row).places; }

 private:
  void begin(unsigned lanes, int rows);
  void move_to(const std::array<double, lane_count>& t);
  void advance(unsigned lanes, const std::array<double, lane_count>& t, int depth);
  unsigned attempt(unsigned lanes, const std::array<double, lane_count>& t);
  void take(unsigned lanes);
  unsigned steady_contacts(unsigned lanes);
  void leave(unsigned lanes, const char* why);
  void watch_margins();
  void keep_row();
  void use_own_states();
  void make_own(LaneState*& state);
  LaneState* free_state();
  bool is_own(const LaneState* state) const { return state >= own_.data() && state < own_.data() + own_.size(); }
  const LaneState& row_of(int row) const { return rows_[static_cast<std::size_t>(row)]; }

  LaneSolver solver_;
  int coordinates_, tails_, multipliers_;
  LaneNumbers largest_margin_;
  // Rows are solved for where they are kept: the state to which lanes go is the row, where all lanes go there at once.
  std::vector<LaneState> rows_, own_;
  LaneState *before_ = nullptr, *now_ = nullptr, *next_ = nullptr, *row_ = nullptr;
  std::array<bool, lane_count> has_before_{};
  std::array<std::string, lane_count> why_;
  std::vector<ContactJumps> jumps_;         // one a lane, where contacts are searched for
  std::vector<CurvePlace> places_, nexts_;  // of a lane
  unsigned alive_ = 0;
};

}  // namespace catena
