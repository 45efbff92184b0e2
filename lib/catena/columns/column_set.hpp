// The columns of an analysis, resolved once and evaluated at every row.
//
//   names -> resolve() -> info() for the sink, needs() for the analysis -> evaluate(snapshot) -> one value a column
//
// A column that the analysis cannot give is left out, and a note says so; an unknown name is an error. Changed
// parameter values keep the set: points, masses, axes and the constants of formulas are read from the evaluator's
// model. evaluate() does not allocate; own columns are evaluated with the row that shows them; sums over all bodies
// (energies, momenta) are formed once a row, reactions once an element in a run of columns.
#pragma once

#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "catena/base/design_scalar.hpp"
#include "catena/columns/own_columns.hpp"
#include "catena/columns/snapshot.hpp"

namespace catena {

class DesignState;

/// Thrown for a name that is no column; what() is a sentence with the name in it.
struct ColumnError : std::invalid_argument {
  explicit ColumnError(UnknownColumn reason)
      : std::invalid_argument("unknown column \"" + reason.name + "\": " + reason.message),
        unknown(std::move(reason)) {}
  UnknownColumn unknown;
};

/// The quantities that an analysis can put into a snapshot.
struct ColumnSources {
  std::string_view analysis;  ///< its type, for the notes
  bool timed = false;         ///< `t` is the first column
  bool velocity = false;
  bool acceleration = false;
  bool multipliers = false;
  bool work = false;  ///< work of drivers and loads, dissipation
};

class ColumnSet {
 public:
  /// Resolves `names`; none mean x, y and angle of every body. Doubled columns are kept once. Throws ColumnError, and
  /// std::invalid_argument where the plan is not that of the model.
  static ColumnSet resolve(const Model& model, const Plan& plan, std::span<const std::string> names,
                           const ColumnSources& sources);

  std::size_t size() const { return columns_.size(); }
  std::span<const ColumnInfo> info() const { return info_; }
  const Needs& needs() const { return needs_; }
  /// One sentence for each reason why columns were left out.
  std::span<const std::string> notes() const { return notes_; }

  /// out[k] = value of column k; `out` has size() values. The snapshot must hold what needs() says, and be of the same
  /// model: else std::invalid_argument.
  void evaluate(const Snapshot& snapshot, std::span<double> out) const;
  /// The same with derivatives by design parameters, which the state carries. Those of integrals over time, which no
  /// state holds, are not numbers.
  void differentiate(const DesignState& state, std::span<DesignScalar> out) const;

 private:
  std::vector<ColumnInfo> info_;
  std::vector<Column> columns_;
  OwnInputs own_inputs_;
  Needs needs_;
  std::vector<std::string> notes_;
  std::size_t coordinates_ = 0;  // of the plan
  bool only_angles_ = false;     // all rows of constraints are angles: so is their residual
};

}  // namespace catena
