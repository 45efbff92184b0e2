// Derivatives of columns by the state that they show, and by design parameters at a fixed state.
//
//   c(q, qd, qdd, lambda, p)   =>   c_q, c_qd, c_qdd, c_lambda and c_p: what adjoints begin with
//
// Columns read few bodies and elements: only coordinates of these and multipliers of these are varied, four at a time,
// in the dual numbers of a mechanism with derivatives. Coordinates that are no unknowns count among p. Work and
// dissipated energy have no derivative: c_p is not a number. Units of the columns over those of what is varied.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "catena/assembly/design/design_mechanism.hpp"
#include "catena/columns/column_set.hpp"
#include "catena/columns/design_state.hpp"

namespace catena {

/// Of a weighted sum of columns; vectors over coordinates, rows of the plan (solver's scale) and parameters.
struct StateSlopes {
  std::vector<double> by_q, by_qd, by_qdd, by_lambda, by_p;
};

/// What contacts do at the state of a group's mechanism, and the rows whose multipliers that follows from.
struct ContactSlopes {
  std::function<const DesignContacts*(std::size_t group, std::span<const DesignScalar> lambda)> at{};
  std::vector<int> rows{};
};

class ColumnSlopes {
 public:
  /// `groups`: mechanisms with derivatives by four parameters each, `parameters` in all; they must outlive this object.
  ColumnSlopes(const Model& model, const ColumnSet& columns, std::vector<DesignMechanism*> groups, int parameters,
               ContactSlopes contacts = {});

  /// Takes the columns at a snapshot, to whose time all groups are set.
  void look(const Snapshot& snapshot);
  /// slopes += weight x those of a column at the last look().
  void add(std::size_t column, double weight, StateSlopes& slopes) const;
  StateSlopes empty() const;
  /// Whether a multiplier is in the column.
  bool reads_multipliers(std::size_t column) const;

 private:
  enum class Level { q, qd, qdd, lambda };
  struct Variable {
    Level level;
    int index;  // coordinate, or row
  };
  void collect(const Model& model);
  std::vector<DesignScalar>& values(Level level);
  void evaluate(std::size_t group, const Snapshot& snapshot, std::vector<DesignScalar>& out);

  const ColumnSet& columns_;
  std::vector<DesignMechanism*> groups_;
  std::size_t parameters_;
  ContactSlopes contacts_;
  std::vector<Variable> variables_;
  std::vector<DesignScalar> q_, qd_, qdd_, lambda_, still_, moved_;
  std::vector<double> slope_;     // by column, then variable
  std::vector<double> explicit_;  // by column, then parameter
};

}  // namespace catena
