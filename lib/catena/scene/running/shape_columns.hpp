// The shapes of modes as columns: by how much each of the outputs changes when the mechanism moves along a shape.
//
// The change of a place, angle or length along a shape is its rate of change in a motion with that shape as velocity:
// crank.x shows what crank.vx would. Outputs without a rate among the columns (forces, energies) are left out.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "catena/columns/column_set.hpp"

namespace catena {

class ShapeColumns {
 public:
  /// `outputs`: names that exist; none mean x, y and angle of every body. The plan must outlive this object.
  ShapeColumns(const Model& model, const Plan& plan, const std::vector<std::string>& outputs,
               std::string_view analysis);

  std::span<const ColumnInfo> info() const { return info_; }
  /// What was left out, in a sentence; empty if nothing was.
  const std::string& note() const { return note_; }
  /// out: info().size() values. `shape` over the plan's columns; the evaluator must be at q.
  void evaluate(const Evaluator& evaluator, std::span<const double> q, std::span<const double> shape,
                std::span<double> out);

 private:
  const Plan& plan_;
  std::vector<ColumnInfo> info_;
  std::optional<ColumnSet> columns_;
  std::vector<double> qd_;
  std::string note_;
};

}  // namespace catena
