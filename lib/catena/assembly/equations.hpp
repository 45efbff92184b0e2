// The equations of one model, over its plan: everything that analyses evaluate, as functions of a pose.
//
//   pose = given_pose();   set_time(pose, t)   set_configuration(pose, q)         what changes a pose
//   phi, jacobian, nu, gamma                                                      constraints:  Phi, Phi_q, nu, gamma
//   applied_forces, potential_energy, load_power, ...                             forces:       Q, V, power
//
// Nothing is remembered between calls: what is evaluated follows from the plan, the numbers of the model and the pose,
// to the last bit. One object may be used by several threads at once, each with poses of its own. Evaluator
// (evaluate.hpp) is these equations with a pose of its own.
//
// q, qd, qdd hold three coordinates a body in plan order and three zeros for the ground (plan.coordinates() in all);
// positions are relative to the body's origin (see plan.hpp). The sizes of spans are not checked. Evaluation does not
// allocate. Units: m, rad, s, N, J. Singular where elements are: trouble(). Sources: apps/manual/constraints.md.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "catena/assembly/hessian_slots.hpp"
#include "catena/assembly/plan.hpp"
#include "catena/assembly/state_laws.hpp"

namespace catena {

class Equations {
 public:
  /// The plan must be that of the model, and a model that is taken over must have the same bodies and elements:
  /// std::invalid_argument names the difference.
  Equations(std::shared_ptr<const Plan> plan, const Model& model);
  // Defined where the element types are complete; here they are only declared.
  Equations(const Equations&);
  Equations(Equations&&) noexcept;
  Equations& operator=(const Equations&);
  Equations& operator=(Equations&&) noexcept;
  ~Equations();

  const Plan& plan() const { return *plan_; }
  const std::shared_ptr<const Plan>& shared_plan() const { return plan_; }
  const Model& model() const { return *model_; }

  /// Takes over changed parameter values of a model with the same structure; the plan stays. Squared forms are scaled
  /// by their values at `time`. Poses made before are to be renewed.
  void set_model(const Model& model, double time);

  /// The given configuration: poses relative to the origins; immobile bodies where they belong. Size coordinates().
  std::vector<double> given_configuration() const;
  /// Place of the body's relative origin in the ground frame.
  Vec2<double> origin(int plan_body) const { return origin_[static_cast<std::size_t>(plan_body)]; }
  /// Whether every force element has a potential.
  bool conservative() const;
  /// Laws of state, as the model numbers them; see law_values.hpp.
  std::span<const CompiledLaw<double>> laws() const { return laws_; }
  /// Per plan body: RMS distance of its attachment points from the centroid; where there is none the mean distance in
  /// its mechanism, else length_scale(). The mean over all attachment points goes to `mean` (Lc in
  /// apps/manual/dynamics.md#least-reactions).
  std::vector<double> attachment_radii(double* mean = nullptr) const;
  /// The length that residuals in metres are compared with: the mean attachment distance, else the extent of the given
  /// positions, else 1 m.
  double length_scale() const { return length_scale_; }

  // What changes a pose.
  /// At t = 0, bodies and contacts on curves where they were given.
  Pose given_pose() const;
  /// Brings a pose to the numbers of this model, bodies where they were given: contacts on curves are searched for from
  /// where they are; time, turns and what is left out stay.
  void renew(Pose& pose) const;
  /// `side`: which derivatives are meant where a function jumps at t. Throws OutsideTable (time_function.hpp) when a
  /// table does not reach t. Beyond pose.run the pieces that hold at its ends are continued.
  void set_time(Pose& pose, double t, Side side = Side::after) const;
  /// The same by the pieces of the functions that hold at the instant `from`: for differences next to it.
  void set_time_along(Pose& pose, double t, double from) const;
  void set_configuration(Pose& pose, std::span<const double> q) const;
  /// Takes whole turns out of the angles in q and puts them into the pose: frames keep the full angle, while cosine and
  /// sine no longer lose digits to an angle of many turns.
  void take_turns(Pose& pose, std::span<double> q) const;
  /// phi() and jacobian() give zeros at these equations, which do not hold for the time being; ascending.
  void leave_out(Pose& pose, std::span<const int> rows) const;
  /// The next searches begin at these places: at those of the accepted state, after a trial that was rejected. Elements
  /// that the list lacks go on from where they are; one that the model lacks throws std::invalid_argument.
  void go_to_curve_places(Pose& pose, std::span<const CurvePlace> places) const;
  /// The next searches begin where contacts are in the given configuration.
  void go_to_given_curve_places(Pose& pose) const;

  // Constraints. Sizes: rows; of Phi_q entries + 1, the last is scratch.
  void phi(const Pose& pose, std::span<double> out) const;
  /// Zeroes the values and writes the entries +1 and -1, once before jacobian().
  void start_jacobian(std::span<double> values) const;
  /// The varying entries.
  void jacobian(const Pose& pose, std::span<double> values) const;
  void nu(const Pose& pose, std::span<double> out) const;
  void gamma(const Pose& pose, std::span<const double> qd, std::span<double> out) const;

  // Forces. What laws of state give is a value as well: law_values() fills it, one a law, before forces are asked for.
  /// The values of all laws at this pose and its velocities.
  void law_values(const Pose& pose, std::span<const double> qd, std::span<double> out) const;
  /// Generalized forces of gravity and all force elements; size coordinates(), the ground's last.
  void applied_forces(const MovingPose& at, std::span<double> Q) const;
  /// Potential energy of gravity and the conservative force elements, J; zero at the ground's origin.
  double potential_energy(const Pose& pose) const;
  /// Power lost to damping, W.
  double dissipation(const MovingPose& at) const;
  /// Power, W, of forces that have neither a potential nor damping: functions of time in force elements, follower
  /// forces, laws of state.
  double load_power(const MovingPose& at) const;

  /// The value of a law; qd may be empty: at rest.
  double law_value(const Pose& pose, int law, std::span<const double> qd) const;
  /// Its derivatives by x, y, phi of a plan body and by their rates.
  std::array<double, 6> law_gradient(const Pose& pose, int law, int body, std::span<const double> qd) const;
  /// The first law that a force reads whose value is not finite; -1: none.
  int law_without_value(std::span<const double> laws) const;
  /// The first table that ends, and was left by what the law reads at this state, with the place `where`; else nullptr.
  const NamedTable<double>* left_table(const Pose& pose, int law, std::span<const double> qd, double& where) const;

  /// Calls f(body_i, body_j, matrix) with the 6 x 6 stiffness -dQ/dq of every force element, and then with what laws of
  /// state add to it: not symmetric, over any two bodies or one body given twice.
  template <class F>
  void visit_stiffness(const MovingPose& at, F&& f) const;
  /// Calls f(body_i, body_j, matrix) with sum lambda d2Phi/dq2 of every constraint; lambda: solver's rows.
  template <class F>
  void visit_constraint_hessians(const Pose& pose, std::span<const double> lambda, F&& f) const;
  /// Adds sum lambda d2Phi/dq2 and the second derivatives of the potential to their slots; lambda: solver's rows.
  void add_hessians(const MovingPose& at, std::span<const double> lambda, Curvature curvature,
                    const HessianSlots& slots, std::span<double> values) const;

  // Single elements.
  /// Measured quantity of a scalar constraint with time derivatives; qd, qdd may be empty (zero). The second derivative
  /// of one that is released lacks the accelerations' part.
  Measured measure(const Pose& pose, int element, std::span<const double> qd, std::span<const double> qdd) const;
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
  ScalarMotion scalar_motion(const Pose& pose, int element, std::span<const double> qd) const;
  /// Dense Phi_q of one element's published equations: rows x 6 (columns 3 ... 5 zero for absolute types), and its
  /// scale.
  struct ElementJacobian {
    int rows = 0, bodies = 0;
    int body_i = -1, body_j = -1;  ///< plan bodies; `bodies` of the plan stands for the ground
    double scale = 1;
    double entries[18] = {};
  };
  ElementJacobian element_jacobian(const Pose& pose, int element) const;
  /// nullptr, or why the equations of the element are undefined at this configuration, as a phrase ("its centres
  /// coincide").
  const char* trouble(const Pose& pose, int element) const;
  /// nullptr, or why a rope, elastic or not, means nothing at this configuration, as a phrase: it has no straight line
  /// between two of its circles, or it holds and no longer touches a pulley.
  const char* rope_trouble(const Pose& pose, int element) const;
  /// The place in use on a curve or table that has ends, with the nearer end in the ground frame; nothing for elements
  /// without one, or that do not use it at present.
  std::optional<CurveUse> curve_use(const Pose& pose, int element) const;
  /// The contact of curves of a constraint; no_contact where it does not search for one.
  CurvePlace contact(const Pose& pose, int element) const;
  /// c, c', c'' of the element's function of time.
  Taylor<double> element_value(const Pose& pose, int element) const;
  /// The frame of a plan body in the ground frame.
  Frame<double> ground_frame(const Pose& pose, int plan_body) const {
    Frame<double> f = pose.frames[static_cast<std::size_t>(plan_body)];
    f.x += origin_[static_cast<std::size_t>(plan_body)].x;
    f.y += origin_[static_cast<std::size_t>(plan_body)].y;
    return f;
  }

 private:
  void load_numbers(double time);
  /// Scales squared forms, once, by their values at `time`, to rows that measure a length.
  void scale_squared_forms(double time);
  void place_bodies(Pose& pose) const;
  void spread_constants(Pose& pose) const;
  void spread_functions(Pose& pose) const;
  /// s and g of every elastic rope.
  void stretch_ropes(Pose& pose) const;
  void find_contacts(Pose& pose) const;
  void follow(const Pose& pose, std::span<CurvePlace> contacts) const;
  /// dQ/dF of a law's force on its bodies i and j.
  std::array<double, 6> law_effect(const MovingPose& at, int law) const;
  std::span<const double> rates(const MovingPose& at) const;
  Measured measure_released(const Pose& pose, int element, std::span<const double> qd) const;
  template <class F>
  void with_element(int element, F&& f) const;
  /// Place of an element in its block; without rows -1.
  int place(int element) const { return place_[static_cast<std::size_t>(element)]; }

  std::shared_ptr<const Plan> plan_;
  const Model* model_;
  ConstraintValues constraints_;
  ForceValues forces_;
  std::vector<double> mass_;          // per plan body
  std::vector<Vec2<double>> origin_;  // per plan body, and the ground's (0, 0)
  std::vector<Frame<double>> fixed_;  // of immobile bodies, relative; the last one is the ground's
  std::vector<CompiledLaw<double>> laws_;
  std::vector<int> place_;
  double length_scale_ = 1;
};

template <class F>
void Equations::visit_stiffness(const MovingPose& at, F&& f) const {
  for_each_list(plan_->forces, [&](const auto& block, int) {
    using E = typename std::remove_cvref_t<decltype(block)>::Element;
    const auto& data = std::get<ForceData<E>>(forces_);
    for (int e = 0; e < block.size(); ++e) {
      f(block.body_i[static_cast<std::size_t>(e)], block.body_j[static_cast<std::size_t>(e)],
        ForceOperations<E>::stiffness(block, data, at, e));
    }
  });
  for (std::size_t k = 0; k < laws_.size(); ++k) {
    const int law = static_cast<int>(k);
    const std::array<double, 6> effect = law_effect(at, law);
    for (const int read : laws_[k].bodies) {
      const std::array<double, 6> gradient = law_gradient(at.pose, law, read, rates(at));
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
void Equations::visit_constraint_hessians(const Pose& pose, std::span<const double> lambda, F&& f) const {
  for_each_list(plan_->blocks, [&](const auto& block, int) {
    using E = typename std::remove_cvref_t<decltype(block)>::Element;
    const auto& data = std::get<ConstraintData<E>>(constraints_);
    for (int e = 0; e < block.size(); ++e) {
      f(block.body_i[static_cast<std::size_t>(e)], block.body_j[static_cast<std::size_t>(e)],
        ConstraintOperations<E>::hessian(block, data, pose, lambda.data(), e));
    }
  });
}

}  // namespace catena
