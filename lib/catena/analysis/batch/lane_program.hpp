// The plan of a mechanism as the kernels of a batch read it (lane_code.hpp), and the numbers of designs put into it.
//
// Not every mechanism can be computed in lanes: make() says why not. It must be driven by as many independent equations
// as it has coordinates, all of types that lanes know, without particles and without curves that end, which are watched
// between rows; and no loop of it may hang together with so many others that a block's tail exceeds largest_tail.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "catena/analysis/batch/kernels/lane_code.hpp"
#include "catena/analysis/batch/lane_elimination.hpp"
#include "catena/analysis/batch/lane_numbers.hpp"
#include "catena/analysis/batch/lane_searches.hpp"
#include "catena/assembly/plan.hpp"
#include "catena/base/taylor.hpp"

namespace catena {

class LaneProgram {
 public:
  /// Nothing, with the reason, where the mechanism cannot be computed in lanes.
  static std::unique_ptr<const LaneProgram> make(const Model& model, std::shared_ptr<const Plan> plan, bool loads,
                                                 std::string& why_not);

  /// For equilibria (lane_equilibrium.hpp): drivers need not determine the coordinates, but forces must have a
  /// potential that kernels know.
  static std::unique_ptr<const LaneProgram> make_static(const Model& model, std::shared_ptr<const Plan> plan,
                                                        std::string& why_not);

  const Plan& plan() const { return *plan_; }
  const LaneCode& code() const { return code_; }
  /// Whether multipliers are computed.
  bool has_loads() const { return has_loads_; }
  int fields() const { return fields_; }        ///< numbers of a group's parameters
  int functions() const { return functions_; }  ///< numbers of its values c, c', c''
  int slots() const { return code_.slots; }
  /// Of every slot: the constants of Phi_q, else zero.
  const std::vector<double>& initial() const { return elimination_.initial; }
  /// Constraints that are evaluated lane by lane.
  const LaneSearchedTypes& searched() const { return searched_; }
  const std::shared_ptr<const Plan>& shared_plan() const { return plan_; }
  /// Whether designs are looked at by evaluators (lane_evaluators.hpp), and whether these give the applied forces.
  bool is_watched() const { return is_watched_; }
  bool takes_forces() const { return takes_forces_; }

  /// Puts the parameters of a design into a lane: of a model of the same structure. `length_scale` in m. False where a
  /// point, an axis or a constant is not finite.
  bool put(const Model& model, double length_scale, int lane, LaneNumbers& field, LaneNumbers& function,
           LaneNumbers& frame) const;
  /// The given pose of a moving body.
  Frame<double> given_pose(const Model& model, int plan_body) const;
  /// Puts c, c', c'' at t into a lane.
  void put_functions(const Model& model, double t, int lane, LaneNumbers& function) const;
  /// A constraint of the model: its multipliers as published are `scale` x those of the rows from `row` on.
  struct Constraint {
    int row = -1;  ///< -1: it has none in lanes
    double scale = 1;
    bool squared = false, pin = false;
    FunctionValue<double> value{};
  };
  /// With the numbers of the design in a lane, whose model is given.
  Constraint constraint(const Model& model, int element, int lane, const LaneNumbers& field) const;
  /// Copies those of lane 0 to all others.
  void spread_functions(LaneNumbers& function) const;

 private:
  struct Timed {
    int place, function;  ///< in the numbers of functions; of the model
  };
  LaneProgram() = default;
  bool list_elements(const Model& model, std::string& why_not);
  void list_searched(const Model& model);
  std::vector<double> constant_entries() const;
  void list_forces(const Model& model);
  void list_masses();
  bool list_steps(const Model& model, std::string& why_not);
  void close();
  bool put_forces(const Model& model, int lane, LaneNumbers& field, LaneNumbers& function) const;
  void put_masses(const Model& model, int lane, LaneNumbers& field) const;

  std::shared_ptr<const Plan> plan_;
  LaneCode code_{};
  int fields_ = 0, functions_ = 0;
  bool has_immobile_ = false, has_loads_ = false, is_watched_ = false, takes_forces_ = false;
  std::vector<LaneElement> element_;
  std::vector<LaneElements> of_type_;
  std::vector<LaneForce> force_;
  std::vector<LaneForces> of_force_type_;
  LaneSearchedTypes searched_;
  std::vector<int> slot_, constant_slot_, place_, searched_row_;
  std::vector<double> constant_;
  LaneElimination elimination_;
  std::vector<Timed> timed_;
};

}  // namespace catena
