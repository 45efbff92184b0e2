// Buckling: the values of a load parameter at which the current equilibrium, kept in place, loses its stability.
//
//   K(p) v = 0 on the null space of Phi_q,   K(p) = K0 + (p - p0) K'        K0 > 0: stable at the present value p0
//
// Up to 500 degrees of freedom the eigenvalues of Z^T K(p) Z, taken in the metric of K0, are followed as functions of
// p, whatever the load's dependence on it (buckling_dense.cpp). Larger ones: K0^-1 (K0 - K(p1)) v = theta v by Lanczos'
// method, p = p0 + (p1 - p0) / theta, for loads that enter K linearly; for others the inertia of K(p) tells on which
// stretch a load lies (buckling_large.cpp).
// Multipliers belong to each value of the parameter, the configuration to the present one: where the load moves the
// equilibrium, the results are estimates of linear buckling theory, and a warning is given; a path finds the true
// critical points. The values nearest to the present one come first. Refused: an equilibrium that is not stable, a
// parameter that moves constraints.
//
// Forces without a potential make K unsymmetric: besides the loads of K v = 0 (divergence) there are those at which two
// frequencies meet and one motion begins to grow (flutter), which masses decide about. Up to 500 degrees of freedom;
// not beside one-sided elements (buckling_circulatory.cpp).
//
// One-sided elements hold as they do at the present value (active_set_at.hpp); those that would open or close before a
// load is reached are named.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "catena/analysis/run/analysis_report.hpp"
#include "catena/analysis/run/system_state.hpp"
#include "catena/analysis/run/thresholds.hpp"
#include "catena/analysis/spectrum/motion_groups.hpp"
#include "catena/analysis/stability/path_system.hpp"
#include "catena/analysis/statics/active_set_at.hpp"

namespace catena {

struct BucklingOptions {
  double present = 0;  ///< value p0 of the parameter
  int count = 1;
  bool errors = false;  ///< whether to tell what rounding makes of the loads; not of those without an energy
};

struct BucklingReport : AnalysisReport {
  /// A load under forces without a potential, and the frequency, rad/s, at which it meets: 0 of divergence.
  struct Critical {
    double value = 0, omega = 0;
  };
  std::vector<double> loads;                ///< values of the parameter, nearest to the present one first
  std::vector<std::vector<double>> shapes;  ///< over columns; the largest turning or displacement is 1 rad or m
  std::vector<double> errors;               ///< of the loads, if they are wanted; not a number: not known
  std::vector<double> flutter;              ///< loads of flutter
  bool flutter_sought = false;              ///< with the masses that it depends on
  std::vector<Critical> critical;           ///< of both kinds, nearest first, as the shapes; only without an energy
  std::vector<std::string> active;          ///< one-sided elements that hold
};

class Buckling {
 public:
  /// `model`: at options.present.
  Buckling(std::shared_ptr<const Model> model, ModelAt model_at, const BucklingOptions& options,
           const PlanOptions& plan_options = {});

  const Plan& plan() const { return *plan_; }
  Evaluator& evaluator() { return evaluator_; }

  void start_from(const SystemState& state);
  BucklingReport run(const std::function<bool()>& go_on = {});

  double time() const { return t_; }
  /// The configuration, assembled, plan order.
  std::span<const double> q() const { return point_.q; }
  SystemState state() const;

 private:
  class Spectrum;
  class Search;
  class CirculatorySearch;
  class InertiaSearch;
  struct CriticalLoad {
    double distance = 0;  // p - p0
    bool flutter = false;
    double omega = 0;
    std::vector<double> shape;
  };
  struct Load {
    double distance = 0;  // p - p0
    std::vector<double> shape;
  };
  Report find(BucklingReport& report, const std::function<bool()>& go_on);
  /// Takes the system to the assembled place, with the multipliers that balance its loads best.
  Report take_place(Imbalance& left, BucklingReport& report);
  /// Names one-sided elements that would not hold as they do, at the loads that were found.
  void check_gaps(BucklingReport& report);
  /// The `count` nearest loads by Lanczos' method, or by dense algebra.
  Report find_by_lanczos(std::vector<Load>& loads, const std::function<bool()>& go_on);
  Report find_first_loads(bool within, std::vector<Load>& loads, double& step, const std::function<bool()>& go_on);
  Report find_one(double step, int order, std::optional<Load>& load, const std::function<bool()>& go_on);
  Report find_by_inertia(double step, std::vector<Load>& loads, const std::function<bool()>& go_on);
  Report find_by_dense(std::vector<Load>& loads, const std::function<bool()>& go_on);
  /// K at a value of the parameter to `matrix`, with the multipliers that belong to it.
  Report stiffness_at(double p, KktMatrix& matrix);
  /// What rounding of the multipliers at the value last taken leaves of stiffnesses: a load whose effect is below it,
  /// however large it is, has none.
  StiffnessFloor floor_under_load();
  /// Takes the system to a value of the parameter, the configuration kept, with the multipliers that belong to it.
  Report place_load(double p);
  /// Divergence and flutter, to the report.
  Report find_without_energy(BucklingReport& report, const std::function<bool()>& go_on);
  void find_errors(BucklingReport& report);
  Report not_stable() const;
  /// As many motions that nothing resists at the present value.
  static Report neutral(int count, const std::vector<std::string>& bodies);
  /// Loads by the difference of K between p0 and p0 + step: those of its `count` largest effects, in size or by value.
  Report find_with(double step, int count, bool by_value, std::vector<Load>& loads, double& effect,
                   const std::function<bool()>& go_on);

  std::shared_ptr<const Model> model_;
  std::shared_ptr<const Plan> plan_;
  BucklingOptions options_;
  EvaluationWork evaluation_;
  Evaluator evaluator_;
  StaticSystem system_;
  PathSystem path_;
  PathPoint point_;
  std::optional<MotionGroups> groups_;
  ActiveSet set_;
  std::vector<double> loaded_;  // multipliers at the value last taken
  double t_ = 0;
  bool moves_ = false;    // the load moves the equilibrium
  bool outside_ = false;  // the scene does not allow the last value
};

}  // namespace catena
