// Columns of designs in lanes: place, velocity and acceleration of bodies and their points, time, loads and powers of
// drivers, multipliers, the forces of pins, and formulas of them.
//
//   r = r_B + A s'      v = v_B + omega B s      a = a_B + alpha B s - omega^2 s      s = A s', B: a quarter turn
//   load = -lambda, or -2 c lambda of a squared value c      power = load dc/dt      of a pin: -lambda on j, lambda on
//   i
//
// What lanes follow is all that these need: no snapshot is made of it. Other columns are taken from one
// (lane_look.hpp). Numbers of all lanes stand side by side, as in lane_code.hpp. Units: m, rad, s, N.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "catena/analysis/batch/lane_solver.hpp"
#include "catena/columns/own_columns.hpp"

namespace catena {

/// Lanes first ... last - 1 at their instants; arrays as in LaneState.
struct LaneView {
  int first, last;
  const double *t, *q, *qd, *qdd, *turned, *lambda;
};

class LaneColumns {
 public:
  /// Nothing where a column is of another kind. `names` stand for one column each; `program` must outlive it.
  static std::optional<LaneColumns> make(const LaneProgram& program, const Model& model,
                                         std::span<const std::string> names);

  /// Takes over points and formulas of a design, the same in all lanes of its solver, and where the bodies stand that
  /// do not move. The model must outlive its use.
  void set_designs(const Model& model, const LaneSolver& solver);
  std::size_t size() const { return columns_.size(); }
  void evaluate(const LaneView& view);
  /// Of column k, after evaluate().
  double value(std::size_t k, int lane) const { return value_of(columns_[k], lane); }

 private:
  struct Quantity {
    Column column;  // in the numbers of the model
    Vec2<double> local{};
    LaneProgram::Constraint constraint{};
  };
  struct Source {
    bool is_own;
    std::size_t number;
  };
  LaneColumns(const LaneProgram& program, const Model& model, OwnInputs inputs)
      : program_(program), own_inputs_(std::move(inputs)), model_(&model) {}
  /// False for one that lanes do not have.
  bool add(const Column& column, Source& source);
  bool is_load_in_lanes(const Column& column) const;
  void evaluate_load(const Quantity& quantity, const LaneView& view, double* out) const;
  void evaluate_pin(const Column& column, const double* lambda, const LaneView& view, double* out) const;
  double value_of(const Source& source, int lane) const;

  const LaneProgram& program_;
  OwnInputs own_inputs_;
  std::vector<Source> columns_;
  std::vector<std::vector<Source>> inputs_;  // of own columns
  std::vector<Quantity> quantities_;
  LaneNumbers values_, fixed_;
  const Model* model_;
};

}  // namespace catena
