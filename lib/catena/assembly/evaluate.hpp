// Evaluation at a pose that is kept: equations of one model (equations.hpp) and the pose that was set last. What
// analyses hold.
//
//   set_time(t)            functions of time, once a t             -> c, c', c''
//   set_configuration(q)   trigonometry, once a body               -> frames
//   phi, jacobian, nu, gamma                                       -> spans, in place; const
//
// Every value is that of Equations at pose(): a function of plan, model and pose alone. To evaluate changes nothing
// here: what was evaluated is counted in the caller's EvaluationWork, which outlives the evaluator, and of which each
// thread has its own. Nothing allocates after construction. The plan is shared.
#pragma once

#include <algorithm>
#include <memory>
#include <numbers>
#include <span>
#include <vector>

#include "catena/assembly/equations.hpp"
#include "catena/base/counters.hpp"
#include "catena/base/iteration_trace.hpp"

namespace catena {

/// What evaluations write beside their results.
struct EvaluationWork {
  Counters counters = {};
  std::vector<double> laws = {};  ///< values of the laws of state where forces were evaluated last
};

class Evaluator : public Equations {
 public:
  /// As Equations, at its given pose.
  Evaluator(std::shared_ptr<const Plan> plan, const Model& model, EvaluationWork& work)
      : Equations(std::move(plan), model), counters(work.counters), pose_(given_pose()), laws_now_(work.laws) {
    laws_now_.assign(laws().size(), 0.0);
  }
  /// The same equations at the same pose, with work of its own.
  Evaluator(const Evaluator& other, EvaluationWork& work)
      : Equations(other), counters(work.counters), trace(other.trace), pose_(other.pose_), laws_now_(work.laws) {
    laws_now_.assign(laws().size(), 0.0);
  }
  Evaluator(const Evaluator&) = delete;
  Evaluator& operator=(const Evaluator&) = delete;

  const Pose& pose() const { return pose_; }
  double time() const { return pose_.time; }
  std::span<const Frame<double>> frames() const { return pose_.frames; }
  /// The frame of a plan body in the ground frame.
  Frame<double> ground_frame(int plan_body) const { return Equations::ground_frame(pose_, plan_body); }

  /// Takes over changed parameter values of a model with the same structure; the plan stays, and contacts on curves are
  /// searched for from where they are.
  void set_model(const Model& model) {
    Equations::set_model(model, pose_.time);
    renew(pose_);
  }
  void set_time(double t, Side side = Side::after) { Equations::set_time(pose_, t, side); }
  void set_time_along(double t, double from) { Equations::set_time_along(pose_, t, from); }
  /// Until TimeLimit ends, functions of time are not evaluated before or after the run: beyond its ends set_time()
  /// continues the pieces that hold there.
  class TimeLimit;
  const TimeRange& time_limit() const { return pose_.run; }
  void set_configuration(std::span<const double> q) {
    ++counters.configurations;
    Equations::set_configuration(pose_, q);
  }
  void take_turns(std::span<double> q) { Equations::take_turns(pose_, q); }
  /// Puts the turns taken out so far back into q.
  void add_turns(std::span<double> q) const {
    for (std::size_t b = 0; b < pose_.turns.size(); ++b) q[3 * b + 2] += pose_.turns[b] * (2 * std::numbers::pi);
  }
  /// Sets the turns that were taken out to zero: from now on q holds full angles again.
  void forget_turns() { pose_.turns.clear(); }
  /// Equations that do not hold until other ones are set.
  void leave_out(std::span<const int> rows) { Equations::leave_out(pose_, rows); }
  bool is_left_out(int row) const { return std::binary_search(pose_.left_out.begin(), pose_.left_out.end(), row); }
  /// Where the contacts on curves are at this configuration, or where their searches begin next if that was told since:
  /// of elements without equations as well, none for a mechanism without curves.
  const std::vector<CurvePlace>& curve_places() const { return pose_.starts; }
  void go_to_curve_places(std::span<const CurvePlace> places) { Equations::go_to_curve_places(pose_, places); }
  void go_to_given_curve_places() { Equations::go_to_given_curve_places(pose_); }

  void phi(std::span<double> out) const {
    ++counters.phis;
    Equations::phi(pose_, out);
  }
  void jacobian(std::span<double> values) const {
    ++counters.jacobians;
    Equations::jacobian(pose_, values);
  }
  void nu(std::span<double> out) const {
    ++counters.nus;
    Equations::nu(pose_, out);
  }
  void gamma(std::span<const double> qd, std::span<double> out) const {
    ++counters.gammas;
    Equations::gamma(pose_, qd, out);
  }
  void applied_forces(std::span<const double> qd, std::span<double> Q) const {
    ++counters.forces;
    Equations::applied_forces(read_laws(qd), Q);
  }
  void add_hessians(std::span<const double> lambda, Curvature curvature, const HessianSlots& slots,
                    std::span<double> values) const {
    ++counters.hessians;
    Equations::add_hessians(read_laws({}), lambda, curvature, slots, values);
  }

  double potential_energy() const { return Equations::potential_energy(pose_); }
  double dissipation(std::span<const double> qd) const { return Equations::dissipation(moving(qd)); }
  double load_power(std::span<const double> qd) const { return Equations::load_power(read_laws(qd)); }
  double law_value(int law, std::span<const double> qd) const { return Equations::law_value(pose_, law, qd); }
  std::array<double, 6> law_gradient(int law, int body, std::span<const double> qd) const {
    return Equations::law_gradient(pose_, law, body, qd);
  }
  /// The first law whose value was not finite when forces were evaluated last, wherever that was; -1: none.
  int law_without_value() const { return Equations::law_without_value(laws_now_); }
  const NamedTable<double>* left_table(int law, std::span<const double> qd, double& where) const {
    return Equations::left_table(pose_, law, qd, where);
  }
  template <class F>
  void visit_stiffness(std::span<const double> qd, F&& f) const {
    Equations::visit_stiffness(read_laws(qd), f);
  }
  template <class F>
  void visit_constraint_hessians(std::span<const double> lambda, F&& f) const {
    Equations::visit_constraint_hessians(pose_, lambda, f);
  }

  Measured measure(int element, std::span<const double> qd, std::span<const double> qdd) const {
    return Equations::measure(pose_, element, qd, qdd);
  }
  ScalarMotion scalar_motion(int element, std::span<const double> qd) const {
    return Equations::scalar_motion(pose_, element, qd);
  }
  ElementJacobian element_jacobian(int element) const { return Equations::element_jacobian(pose_, element); }
  const char* trouble(int element) const { return Equations::trouble(pose_, element); }
  const char* rope_trouble(int element) const { return Equations::rope_trouble(pose_, element); }
  std::optional<CurveUse> curve_use(int element) const { return Equations::curve_use(pose_, element); }
  CurvePlace contact(int element) const { return Equations::contact(pose_, element); }
  Taylor<double> element_value(int element) const { return Equations::element_value(pose_, element); }

  Counters& counters;                     ///< the caller's
  const IterationTrace* trace = nullptr;  ///< told of iterations for a configuration; may be none

 private:
  MovingPose moving(std::span<const double> qd) const { return {pose_, qd.empty() ? nullptr : qd.data()}; }
  /// The same with the laws' values there.
  MovingPose read_laws(std::span<const double> qd) const {
    MovingPose at = moving(qd);
    if (laws_now_.empty()) return at;
    laws_now_.resize(laws().size());
    law_values(pose_, qd, laws_now_);
    at.laws = laws_now_.data();
    return at;
  }

  Pose pose_;
  std::vector<double>& laws_now_;  // the caller's; values where forces were evaluated last
};

class Evaluator::TimeLimit {
 public:
  TimeLimit(Evaluator& evaluator, const TimeRange& run) : evaluator_(evaluator), before_(evaluator.pose_.run) {
    evaluator_.pose_.run = run;
  }
  ~TimeLimit() { evaluator_.pose_.run = before_; }
  TimeLimit(const TimeLimit&) = delete;
  TimeLimit& operator=(const TimeLimit&) = delete;

 private:
  Evaluator& evaluator_;
  TimeRange before_;
};

}  // namespace catena
