// A path of static equilibria as a parameter of the scene changes: through limit points, past branch points.
//
// From the equilibrium at the present value, in steps of a given length along the path (path_system.hpp), predicted
// along the tangent and corrected by Newton's method; shortened where that fails or the path bends. Whenever the number
// of negative modes changes, the critical points between are located, told apart and given a row of their own. At a
// branch point the path continues straight on or, on request, along the branch that leaves it to one side or the other.
// Ends at the wanted value of the parameter, exactly; with `not_converged` after the largest number of steps, `refused`
// where the parameter may not go on. A start where paths cross wants a branch (`bifurcation`, path_start.hpp).
// One-sided elements are equations while they are closed and nothing while they are open (path_gaps.cpp): where one of
// them changes, the point has a row and the path goes on with the other set, to the side on which that holds. It may
// turn back there.
// Limits: two critical points within one step whose modes cancel (one becomes stable while another turns unstable) are
// not seen; a path that only touches the wanted value between two points goes on; and where constraints lose rank (a
// rope pulled straight) multipliers pass through infinity while positions, and the path, continue smoothly.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "catena/analysis/run/analysis_report.hpp"
#include "catena/analysis/run/row_observer.hpp"
#include "catena/analysis/run/system_state.hpp"
#include "catena/analysis/stability/path_critical.hpp"

namespace catena {

struct PathOptions {
  double from = 0, to = 0;  ///< values of the parameter
  int max_steps = 500;
  double arc = 0.05;  ///< length of a step in the measure of path_system.hpp
  /// At the first branch point: 1 goes straight on, 2 and 3 leave along the mode, its largest angle (displacement,
  /// where nothing turns) positive, and against it; 0: as 1.
  int branch = 0;
};

struct PathCritical {
  bool branch = false;   ///< else a limit point
  bool flutter = false;  ///< neither: a motion begins to grow as an oscillation, or ceases to
  double omega = 0;      ///< its frequency there, rad/s
  double value = 0;      ///< of the parameter
  int row = 0;           ///< from 0: the row at this point
  std::string mode;      ///< the body that moves most in the singular mode
  int modes = 1;         ///< how many become singular there
};

/// A one-sided element that closes or opens on the path.
struct PathChange {
  int element = -1;
  bool closes = false;
  double value = 0;  ///< of the parameter
  int row = 0;       ///< from 0: the row at this point
};

struct PathReport : AnalysisReport {
  std::vector<PathCritical> critical;
  std::vector<PathChange> changes;
  std::vector<std::string> active;     ///< one-sided elements that hold at the start
  std::vector<double> negative_modes;  ///< a row: how many; 0 is stable
  std::vector<double> flutter;         ///< a row: how many pairs; only beside forces without a potential
  int steps = 0;
};

class Path {
 public:
  /// `model`: at options.from. Both must have the same structure at all values of the parameter.
  Path(std::shared_ptr<const Model> model, ModelAt model_at, const PathOptions& options,
       const PlanOptions& plan_options = {});

  const Plan& plan() const { return *plan_; }
  const std::shared_ptr<const Plan>& shared_plan() const { return plan_; }
  Evaluator& evaluator() { return evaluator_; }

  void start_from(const SystemState& state);
  /// `observe` gets the value of the parameter and the snapshot of every row; false cancels.
  PathReport run(const std::function<bool(double, const Snapshot&)>& observe);
  SystemState state() const;

 private:
  class March;

  Report follow(PathReport& report, const std::function<bool(double, const Snapshot&)>& observe);

  std::shared_ptr<const Model> model_;
  std::shared_ptr<const Plan> plan_;
  ModelAt model_at_;
  PathOptions options_;
  EvaluationWork evaluation_;
  Evaluator evaluator_;
  StaticSystem system_;
  PathSystem path_;
  double t_ = 0;
  std::vector<double> q_;
};

}  // namespace catena
