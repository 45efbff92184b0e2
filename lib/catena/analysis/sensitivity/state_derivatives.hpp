// Derivatives of a mechanism's state by design parameters, at the instants at which an analysis looks at it.
//
//   find(snapshot)                q_p, qd_p, qdd_p, lambda_p of that state, by the equations of the analysis
//   differentiate(columns, ...)   of any columns, dO/dp = O_q q_p + O_qd qd_p + ... + O_p at fixed t
//                                 (apps/manual/sensitivity.md)
//   derive(columns, ...)          both; at an instant at which functions of time jump and which a parameter moves, a
//                                 column has a derivative by it only if its value and derivative are the same on both
//                                 sides
//
// Parameters come in groups of four (base/design_scalar.hpp), each with a model that carries derivatives by its own.
// The state of the analysis is only read: evaluators and factors here are copies of their own.
#pragma once

#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "catena/analysis/run/row_observer.hpp"
#include "catena/analysis/sensitivity/moving_instants.hpp"
#include "catena/assembly/design/design_mechanism.hpp"
#include "catena/columns/column_set.hpp"
#include "catena/columns/design_state.hpp"

namespace catena {

class StageWatcher;

/// The models with derivatives: parameter k belongs to group k / 4, its derivative number k % 4.
using DesignModels = std::vector<std::shared_ptr<const DesignModel>>;

class StateDerivatives {
 public:
  /// `evaluator` is copied; `parameters`: how many, at least four times as many as models less three.
  StateDerivatives(const Evaluator& evaluator, const DesignModels& models, int parameters);
  /// At the model's given pose.
  StateDerivatives(std::shared_ptr<const Plan> plan, const Model& model, const DesignModels& models, int parameters);
  virtual ~StateDerivatives();
  StateDerivatives(const StateDerivatives&) = delete;
  StateDerivatives& operator=(const StateDerivatives&) = delete;

  int parameters() const { return parameters_; }
  /// Whether these are derivatives of what measures look at alone, by adjoints.
  virtual bool goes_back() const { return false; }
  /// Derivatives of this state; false where there are none, and why() says it.
  virtual bool find(const Snapshot& snapshot) = 0;
  /// A stretch of the motion that find() may ask about from now on, if the motion has a memory.
  virtual void cover(const MotionStretch& stretch) { static_cast<void>(stretch); }
  /// There are none from now on, for this reason.
  void give_up(std::string why) { fail(std::move(why)); }
  /// Ends of the parts of the stretch covered last in which derivatives are smooth, that of the stretch the last one:
  /// what is summed up over them is so part by part. Empty: all of it is smooth.
  std::span<const double> part_ends() const { return part_ends_; }
  /// Who may see the stages of the motion's steps; nullptr: nobody needs to.
  virtual StageWatcher* stage_watcher() { return nullptr; }
  /// Why there are none; a sentence without full stop, empty where nothing went wrong so far.
  const std::string& why() const { return why_; }
  /// Why some columns have none where others have; empty if all have.
  const std::string& lack() const { return lack_; }

  /// q of the last find() with derivatives, by the parameters of a group.
  std::span<const DesignScalar> configuration(std::size_t group) const { return groups_[group].q; }

  /// out[k x parameters + p]: derivative of column k by parameter p at the state of the last find(), which was that of
  /// this snapshot. `values`, if it is not empty: the columns themselves there.
  void differentiate(const ColumnSet& columns, const Snapshot& snapshot, std::span<double> out,
                     std::span<double> values = {});
  /// find() and differentiate() of a row; not a number where there is none. `change`, if it is not empty: of every
  /// column the value just before the instant less that just after, where a parameter moves the instant; else zero.
  /// False where there are none at all, and why() says it.
  virtual bool derive(const ColumnSet& columns, const Snapshot& snapshot, std::span<double> out,
                      std::span<double> change = {});
  /// Why the last derive() left out columns at an instant that moves; empty if it did not.
  const std::string& jump() const { return jump_; }
  /// What the functions of time do at t.
  const MovingInstant& instant_at(double t);
  /// dt/dp of an instant of the motion at which it goes on in another way; nothing where it does not.
  virtual const std::vector<double>* phase_instant(double t) const {
    static_cast<void>(t);
    return nullptr;
  }

 protected:
  /// The state just before the snapshot's instant, at which functions of time jump; false where it is not known.
  virtual bool find_before(const Snapshot& snapshot) {
    static_cast<void>(snapshot);
    return false;
  }
  /// Up to which derivative of a function of time its jumps are seen: functions that stand still have values alone,
  /// whose derivatives by parameters jump where their rates do.
  virtual int seen_order() const { return 1; }
  /// Brings the mechanisms of the groups to the state of the last find(), where that was left until columns ask.
  virtual void complete_state() {}
  /// Where a motion begins at an instant that moves: no derivatives by these parameters.
  void lack_derivatives(std::string why) { lack_ = std::move(why); }
  void take_parts(std::vector<double> ends) { part_ends_ = std::move(ends); }

  /// A group of parameters: the mechanism with derivatives by them, and the state.
  struct Group {
    explicit Group(DesignMechanism design) : mechanism(std::move(design)) {}
    DesignMechanism mechanism;
    std::vector<DesignScalar> q, qd, qdd, lambda, loads;
    std::vector<Taylor<DesignScalar>> rows;
    DesignContacts contacts;
    int count = 0;  ///< of parameters
  };

  Evaluator& evaluator() { return evaluator_; }
  const Plan& plan() const { return evaluator_.plan(); }
  std::vector<Group>& groups() { return groups_; }
  std::vector<DesignMechanism*> mechanisms() {
    std::vector<DesignMechanism*> all;
    for (Group& group : groups_) all.push_back(&group.mechanism);
    return all;
  }
  bool fail(std::string why) {
    if (why_.empty()) why_ = std::move(why);
    return false;
  }
  /// Multipliers of rows that depend on each other: which of them are shown depends on the parameters.
  void leave_out_reactions(Group& group);
  /// Multipliers of rows, marked by 1, in whose mechanisms joints share friction.
  void leave_out_shares(Group& group, std::span<const char> rows);
  /// A parameter that moves this row alone of several that depend on each other: no state has a derivative by it.
  void leave_out_parameter(Group& group, std::size_t p, int row);
  /// Phi_q at the evaluator's configuration, size entries.
  std::span<const double> jacobian() { return jacobian(evaluator_); }
  /// The same where another one is, of the same plan: positions alone tell it, and functions of time.
  std::span<const double> jacobian(const Evaluator& there);
  /// Values without derivatives.
  static void lift(std::span<const double> values, std::vector<DesignScalar>& out);
  /// Lifts q (with what is given of coordinates that are no unknowns), and what the snapshot has of qd, qdd and lambda.
  void lift_state(Group& group, const Snapshot& snapshot);
  /// Scratch over coordinates and rows, for right-hand sides and solutions.
  std::span<double> loads_scratch() { return f_; }
  std::span<double> rows_scratch() { return b_; }

 private:
  void make_groups(const DesignModels& models);

  EvaluationWork evaluation_;
  Evaluator evaluator_;
  int parameters_;
  std::vector<Group> groups_;
  std::vector<double> jacobian_, f_, b_;
  std::vector<DesignScalar> values_;
  std::vector<double> part_ends_;
  std::vector<double> before_, column_before_, column_after_;  // of derive(), kept for their memory
  double instant_ = std::numeric_limits<double>::quiet_NaN();
  MovingInstant at_instant_, of_group_;  // what functions do there, together and those of one group
  std::string why_, lack_, jump_;
};

}  // namespace catena
