// How many digits of the columns of a path are right, its parameter among them: a row is a point of the path, and its
// error the way to the nearest point of the true one. Limit points are no harder than others: there a small error of
// the parameter makes a large one of the place, and both move along the path. At flutter the place along the path
// counts as well: the parameter of that row is the load at which values meet (flutter_place.hpp).
//
//   [ K      Phi_q^T  F_p ] [ dq      ]     [ r   ]         e = |c(row) - c(0)| + 2 sqrt(mean (c(k) - c(0))^2) / s
//   [ Phi_q  0        Phi_p ] [ dlambda ] = - [ Phi ]
//   [    <t, .>           ] [ dp      ]     [ 0   ]         t the direction of the path, <,> that of path_system.hpp
//
// c(0): after one more Newton step, of every row; c(k): with s rounding of the balance and of the constraints put in at
// random (equilibrium_accuracy.hpp, whose estimate this is with one equation more), of some twenty rows, the first, the
// last and those at critical points among them. At branch points the equations are singular along the branch that
// crosses, and a row there is as far off along it as the search left it: nothing is said of paths that pass one, nor
// of those with one-sided elements, of functions of late times, and of reactions where equations depend on each other.
#pragma once

#include <memory>
#include <vector>

#include "catena/analysis/accuracy/disturbance.hpp"
#include "catena/analysis/accuracy/row_terms.hpp"
#include "catena/analysis/stability/path.hpp"
#include "catena/columns/column_errors.hpp"
#include "catena/columns/column_set.hpp"

namespace catena {

class PathAccuracy {
 public:
  /// Of the rows of analysis.run(): the parameter, and behind it `columns`, which must outlive this object. `first`:
  /// the model at options.from. Functions of time are frozen at t.
  PathAccuracy(const Path& analysis, std::shared_ptr<const Model> first, ModelAt model_at, const PathOptions& options,
               double t, const ColumnSet& columns);

  void take(double value, const Snapshot& snapshot, std::span<const double> row);
  /// Of the parameter and of every column, not a number where it is not known; nothing where none is.
  std::vector<double> digits(const PathReport& report);

 private:
  struct Row {
    PathPoint point;
    std::vector<double> values;
  };
  std::vector<std::size_t> chosen(const PathReport& report) const;
  bool examine(const Row& row, bool disturbed);
  bool take_place_of_flutter(const Row& row);
  bool answer(const PathPoint& tangent, std::span<const double> right_side);
  bool disturb(const PathPoint& mended, const PathPoint& tangent, std::span<const double> rounding);
  bool values_at(const PathPoint& x, std::vector<double>& values);

  std::shared_ptr<const Model> first_;
  const ColumnSet& columns_;
  std::vector<ColumnInfo> info_;
  EvaluationWork evaluation_;
  Evaluator evaluator_;
  StaticSystem system_;
  PathSystem path_;
  std::vector<Vec2<double>> origin_;  // of the first model's bodies
  RowTerms terms_;
  Disturbance random_;
  ColumnErrors errors_;
  std::vector<Row> rows_;
  // Of the row that is looked at.
  PathPoint change_;
  std::vector<double> right_side_, solution_, moduli_, mended_values_, other_, square_;
};

}  // namespace catena
