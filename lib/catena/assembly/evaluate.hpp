// Evaluation: fills values into the plan's slots. Owns the numbers of one model and the frames of one configuration.
//
//   set_time(t)            functions of time, once a t             -> c, c', c''
//   set_configuration(q)   trigonometry, once a body               -> frames
//   phi, jacobian, nu, gamma                                       -> spans, in place
//
// q, qd, qdd hold three coordinates a body in plan order and three zeros for the ground (plan.coordinates() in all);
// positions are relative to the body's origin (see plan.hpp).
// Nothing here allocates after construction. One object a thread; the plan is shared.
#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <vector>

#include "catena/assembly/hessian_slots.hpp"
#include "catena/assembly/plan.hpp"
#include "catena/assembly/state_laws.hpp"
#include "catena/base/counters.hpp"
#include "catena/base/iteration_trace.hpp"

namespace catena {

class Evaluator {
 public:
  /// The plan must be that of the model, and a model that is taken over must have the same bodies and elements:
  /// std::invalid_argument names the difference. The sizes of spans are not checked.
  Evaluator(std::shared_ptr<const Plan> plan, const Model& model);
  // Defined where the element types are complete; here they are only declared.
  Evaluator(const Evaluator&);
  Evaluator(Evaluator&&) noexcept;
  Evaluator& operator=(const Evaluator&);
  Evaluator& operator=(Evaluator&&) noexcept;
  ~Evaluator();

  const Plan& plan() const { return *plan_; }
  const std::shared_ptr<const Plan>& shared_plan() const { return plan_; }
  const Model& model() const { return *model_; }

  /// Takes over changed parameter values of a model with the same structure; the plan stays, and contacts on curves are
  /// searched for from where they are.
  void set_model(const Model& model);

  /// The given configuration: poses relative to the origins; immobile bodies where they belong. Size coordinates().
  std::vector<double> given_configuration() const;
  /// Place of the body's relative origin in the ground frame.
  Vec2<double> origin(int plan_body) const { return origin_[static_cast<std::size_t>(plan_body)]; }

  /// `side`: which derivatives are meant where a function jumps at t. Throws OutsideTable (time_function.hpp) when a
  /// table does not reach t.
  void set_time(double t, Side side = Side::after);
  /// The same by the pieces of the functions that hold at the instant `from`: for differences next to it.
  void set_time_along(double t, double from);
  /// Until TimeLimit ends, functions of time are not evaluated before or after the run: beyond its ends set_time()
  /// continues the pieces that hold there.
  class TimeLimit;
  const TimeRange& time_limit() const { return run_; }
  double time() const { return time_; }
  void set_configuration(std::span<const double> q);
  /// Takes whole turns out of the angles in q and remembers them: frames keep the full angle, while cosine and sine no
  /// longer lose digits to an angle of many turns.
  void take_turns(std::span<double> q);
  /// Puts the turns taken out so far back into q.
  void add_turns(std::span<double> q) const;
  /// Sets the remembered turns to zero: from now on q holds full angles again.
  void forget_turns() { turns_.clear(); }
  std::span<const Frame<double>> frames() const { return frames_; }
  /// The frame of a plan body in the ground frame.
  Frame<double> ground_frame(int plan_body) const;

  /// Equations that do not hold for the time being, ascending: phi() and jacobian() give zeros there until other ones
  /// are set.
  void leave_out(std::span<const int> rows);
  bool is_left_out(int row) const { return std::binary_search(left_out_.begin(), left_out_.end(), row); }
  void phi(std::span<double> out);  ///< size rows
  /// Zeroes the values and writes the entries +1 and -1, once before jacobian(); size entries + 1, the last is scratch.
  void start_jacobian(std::span<double> values) const;
  void jacobian(std::span<double> values);                        ///< the varying entries
  void nu(std::span<double> out);                                 ///< size rows
  void gamma(std::span<const double> qd, std::span<double> out);  ///< size rows

  /// Generalized forces of gravity and all force elements; size coordinates(), the ground's last.
  void applied_forces(std::span<const double> qd, std::span<double> Q);
  /// Potential energy of gravity and the conservative force elements, J; zero at the ground's origin.
  double potential_energy() const;
  /// Power lost to damping, W.
  double dissipation(std::span<const double> qd) const;
  /// Power, W, of forces that have neither a potential nor damping: functions of time in force elements, follower
  /// forces, laws of state.
  double load_power(std::span<const double> qd);
  /// Whether every force element has a potential.
  bool conservative() const;

  /// Laws of state, as the model numbers them; see law_values.hpp.
  std::span<const CompiledLaw<double>> laws() const { return laws_; }
  /// The value of a law at this configuration and time; qd may be empty: at rest.
  double law_value(int law, std::span<const double> qd) const;
  /// Its derivatives by x, y, phi of a plan body and by their rates.
  std::array<double, 6> law_gradient(int law, int body, std::span<const double> qd) const;
  /// The first law whose value was not finite when forces were evaluated last, wherever that was; -1: none.
  int law_without_value() const;
  /// The first table that ends, and was left by what the law reads at this state, with the place `where`; else nullptr.
  const NamedTable<double>* left_table(int law, std::span<const double> qd, double& where) const;

  /// Calls f(body_i, body_j, matrix) with the 6 x 6 stiffness -dQ/dq of every force element, and then with what laws of
  /// state add to it: not symmetric, over any two bodies or one body given twice.
  template <class F>
  void visit_stiffness(std::span<const double> qd, F&& f);
  /// Calls f(body_i, body_j, matrix) with sum lambda d2Phi/dq2 of every constraint; lambda: solver's rows.
  template <class F>
  void visit_constraint_hessians(std::span<const double> lambda, F&& f) const;

  /// Adds sum lambda d2Phi/dq2 and the second derivatives of the potential to their slots; lambda: solver's rows.
  void add_hessians(std::span<const double> lambda, Curvature curvature, const HessianSlots& slots,
                    std::span<double> values);

  /// Measured quantity of a scalar constraint with time derivatives; qd, qdd may be empty (zero). The second derivative
  /// of one that is released lacks the accelerations' part.
  Measured measure(int element, std::span<const double> qd, std::span<const double> qdd) const;
  /// One scalar equation or gap along the motion, whether it has a row or not: what it measures (of a gap the distance
  /// that is reported; else the residual), its rate, the part of its second derivative that velocities make, and its
  /// gradient by the coordinates of its two plan bodies, and by those of elements that join it.
  struct ScalarMotion {
    double value = 0, rate = 0, bend = 0;
    int body_i = -1, body_j = -1;
    double gradient[6] = {};
    struct Part {
      int body_i = -1, body_j = -1;
      double gradient[6] = {};
    };
    std::vector<Part> parts = {};  ///< of elements that join this one
  };
  ScalarMotion scalar_motion(int element, std::span<const double> qd) const;
  /// Dense Phi_q of one element's published equations: rows x 6 (columns 3 ... 5 zero for absolute types), and its
  /// scale.
  struct ElementJacobian {
    int rows = 0, bodies = 0;
    int body_i = -1, body_j = -1;  ///< plan bodies; `bodies` of the plan stands for the ground
    double scale = 1;
    double entries[18] = {};
  };
  ElementJacobian element_jacobian(int element) const;
  /// nullptr, or why the equations of the element are undefined at this configuration, as a phrase ("its centres
  /// coincide").
  const char* trouble(int element) const;
  /// The place in use on a curve or table that has ends, with the nearer end in the ground frame; nothing for elements
  /// without one, or that do not use it at present.
  std::optional<CurveUse> curve_use(int element) const;
  /// Where the contacts on curves are at this configuration, or where their searches begin next if that was told since:
  /// of elements without equations as well, none for a mechanism without curves.
  const std::vector<CurvePlace>& curve_places() const { return starts_; }
  /// The next searches begin at these places: at those of the accepted state, after a trial that was rejected. Elements
  /// that the list lacks go on from where they are; one that the model lacks throws std::invalid_argument.
  void go_to_curve_places(std::span<const CurvePlace> places);
  /// The contact of curves of a constraint at this configuration; no_contact where it does not search for one.
  CurvePlace contact(int element) const;
  /// The next searches begin where contacts are in the given configuration.
  void go_to_given_curve_places();
  /// Value of the element's function of time now: c, c', c''.
  Taylor<double> element_value(int element) const;

  /// Per plan body: RMS distance of its attachment points from the centroid; where there is none the mean distance in
  /// its mechanism, else length_scale(). The mean over all attachment points goes to `mean` (Lc in
  /// apps/manual/dynamics.md#least-reactions).
  std::vector<double> attachment_radii(double* mean = nullptr) const;
  /// nullptr, or why a rope, elastic or not, means nothing at this configuration, as a phrase: it has no straight line
  /// between two of its circles, or it holds and no longer touches a pulley.
  const char* rope_trouble(int element) const;
  /// The length that residuals in metres are compared with: the mean attachment distance, else the extent of the given
  /// positions, else 1 m.
  double length_scale() const { return length_scale_; }
  Counters counters;
  const IterationTrace* trace = nullptr;  ///< told of iterations for a configuration; may be none

 private:
  void load_values();
  void spread_functions();
  /// Gives force elements the values of laws at this state.
  void read_laws(std::span<const double> qd);
  /// dQ/dF of a law's force on its bodies i and j.
  std::array<double, 6> law_effect(int law, std::span<const double> qd) const;
  void stretch_ropes();
  Measured measure_released(int element, std::span<const double> qd) const;
  Pose pose() const { return {frames_.data(), contacts_.data()}; }
  void find_contacts();
  void follow(std::span<CurvePlace> contacts) const;
  /// Place of an element in its block; without rows -1.
  template <class F>
  void with_element(int element, F&& f) const;
  int place(int element) const { return place_[static_cast<std::size_t>(element)]; }

  std::shared_ptr<const Plan> plan_;
  const Model* model_;
  ConstraintValues values_;
  ForceValues force_values_;
  std::vector<double> mass_;           // per plan body
  std::vector<Vec2<double>> origin_;   // per plan body, and the ground's (0, 0)
  std::vector<Frame<double>> frames_;  // relative; the last one is the ground's
  // Pose::contacts, and where the searches for them begin: at those of the configuration before, unless they are told.
  std::vector<CurvePlace> contacts_, starts_;
  std::vector<int> turns_;  // per moving body, as taken by take_turns(); empty: none
  std::vector<Taylor<double>> function_;
  std::vector<CompiledLaw<double>> laws_;
  std::vector<int> place_;
  std::vector<int> left_out_, left_out_slot_;  // rows and the places of their entries in Phi_q
  double time_ = 0, length_scale_ = 1;
  TimeRange run_;
};

class Evaluator::TimeLimit {
 public:
  TimeLimit(Evaluator& evaluator, const TimeRange& run) : evaluator_(evaluator), before_(evaluator.run_) {
    evaluator_.run_ = run;
  }
  ~TimeLimit() { evaluator_.run_ = before_; }
  TimeLimit(const TimeLimit&) = delete;
  TimeLimit& operator=(const TimeLimit&) = delete;

 private:
  Evaluator& evaluator_;
  TimeRange before_;
};

template <class F>
void Evaluator::visit_stiffness(std::span<const double> qd, F&& f) {
  if (!laws_.empty()) read_laws(qd);
  for_each_list(plan_->forces, [&](const auto& block, int) {
    using E = typename std::remove_cvref_t<decltype(block)>::Element;
    const auto& data = std::get<ForceData<E>>(force_values_);
    for (int e = 0; e < block.size(); ++e) {
      f(block.body_i[static_cast<std::size_t>(e)], block.body_j[static_cast<std::size_t>(e)],
        ForceOperations<E>::stiffness(block, data, frames_.data(), qd.empty() ? nullptr : qd.data(), e));
    }
  });
  for (std::size_t k = 0; k < laws_.size(); ++k) {
    const int law = static_cast<int>(k);
    const std::array<double, 6> effect = law_effect(law, qd);
    for (const int read : laws_[k].bodies) {
      const std::array<double, 6> gradient = law_gradient(law, read, qd);
      for (std::size_t end = 0; end < 2; ++end) {
        const int acted = end == 0 ? laws_[k].i : laws_[k].j;
        if (acted < 0 || acted >= plan_->moving) continue;
        ElementMatrix matrix{};
        const std::size_t first = acted == read ? 0 : 3;
        for (std::size_t row = 0; row < 3; ++row) {
          for (std::size_t c = 0; c < 3; ++c) matrix[6 * row + first + c] = -effect[3 * end + row] * gradient[c];
        }
        f(acted, read, matrix);
      }
    }
  }
}

template <class F>
void Evaluator::visit_constraint_hessians(std::span<const double> lambda, F&& f) const {
  for_each_list(plan_->blocks, [&](const auto& block, int) {
    using E = typename std::remove_cvref_t<decltype(block)>::Element;
    const auto& data = std::get<ConstraintData<E>>(values_);
    for (int e = 0; e < block.size(); ++e) {
      f(block.body_i[static_cast<std::size_t>(e)], block.body_j[static_cast<std::size_t>(e)],
        ConstraintOperations<E>::hessian(block, data, pose(), lambda.data(), e));
    }
  });
}

}  // namespace catena
