#include "catena/analysis/batch/lane_program.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <tuple>

#include "catena/base/at.hpp"
#include "catena/elements/all.hpp"
#include "catena/model/rope_routes.hpp"

namespace catena {
namespace {

#define CATENA_LANE_IS(Type) || std::is_same_v<E, Type<double>>
template <class E>
inline constexpr bool in_lanes = false CATENA_LANE_ELEMENTS(CATENA_LANE_IS);
#undef CATENA_LANE_IS

/// Calls f(number, is_place) for every parameter of an element, in the order in which kernels read them. `is_place`: of
/// a point or an axis; others may be missing. Flags and sides are the element's choice(), curves are not in lanes.
template <class E, class F>
void visit_numbers(const E& element, F&& f) {
  std::apply(
      [&](const auto&... field) {
        const auto visit = [&](const auto& one) {
          if constexpr (requires { one.member; }) {
            const auto& member = element.*one.member;
            if constexpr (requires { member.x; }) {
              f(member.x, true);
              f(member.y, true);
            } else if constexpr (std::is_same_v<std::remove_cvref_t<decltype(member)>, double>) {
              f(member, false);
            }
          }
        };
        (visit(field), ...);
      },
      E::fields());
  if constexpr (requires { element.angle; }) f(element.angle, true);
  if constexpr (requires { element.constant; }) f(element.constant, true);
}

/// The flag or the side of an element, of which it has one at most; else 0.
template <class E>
int choice(const E& element) {
  int found = 0;
  std::apply(
      [&](const auto&... field) {
        const auto visit = [&](const auto& one) {
          if constexpr (requires { one.member; }) {
            const auto& member = element.*one.member;
            if constexpr (std::is_integral_v<std::remove_cvref_t<decltype(member)>>) found = static_cast<int>(member);
          }
        };
        (visit(field), ...);
      },
      E::fields());
  return found;
}

/// Calls f(block, list) for the types of lanes, in their order.
template <class F>
void for_each_lane_type(const Plan& plan, const Model& model, F&& f) {
#define CATENA_LANE_CALL(Type)                            \
  f(std::get<ConstraintBlock<Type<double>>>(plan.blocks), \
    std::get<std::vector<ElementEntry<Type<double>, double>>>(model.constraints));
  CATENA_LANE_ELEMENTS(CATENA_LANE_CALL)
#undef CATENA_LANE_CALL
}

/// The same for their forces.
template <class F>
void for_each_lane_force(const Plan& plan, const Model& model, F&& f) {
#define CATENA_LANE_CALL(Type)                       \
  f(std::get<ForceBlock<Type<double>>>(plan.forces), \
    std::get<std::vector<ElementEntry<Type<double>, double>>>(model.forces));
  CATENA_LANE_FORCES(CATENA_LANE_CALL)
#undef CATENA_LANE_CALL
}

#define CATENA_LANE_IS(Type) || std::is_same_v<E, Type<double>>
template <class E>
inline constexpr bool force_in_lanes = false CATENA_LANE_FORCES(CATENA_LANE_IS);
#undef CATENA_LANE_IS

void check_choice(int choice, int chosen, const Model& model, int element) {
  if (choice == chosen) return;
  throw std::invalid_argument(fmt::format("{} \"{}\" has another flag or side than in the model of the batch",
                                          model.element_type(element), model.element_name(element)));
}

}  // namespace

std::unique_ptr<const LaneProgram> LaneProgram::make(const Model& model, std::shared_ptr<const Plan> plan, bool loads,
                                                     std::string& why_not) {
  if (!rope_routes(model).empty()) {
    why_not = "it has a rope over a pulley, whose way may change along the motion";
    return nullptr;
  }
  if (!model.laws.empty()) {
    why_not = "it has forces by laws of state, which are checked along the motion";
    return nullptr;
  }
  std::unique_ptr<LaneProgram> program(new LaneProgram);
  program->plan_ = std::move(plan);
  program->has_loads_ = loads;
  const Plan& p = *program->plan_;
  if (p.rows != p.columns || p.columns == 0) {
    why_not = fmt::format(
        "it has {} equations for {} coordinates: only mechanisms whose drivers and constraints determine the motion, "
        "none of them redundant, are computed in lanes",
        p.rows, p.columns);
    return nullptr;
  }
  if (!p.contiguous) {
    why_not = "it has particles, which are not computed in lanes";
    return nullptr;
  }
  if (!program->list_elements(model, why_not) || (loads && !program->list_forces(model, why_not)) ||
      !program->list_steps(model, why_not))
    return nullptr;
  program->close();
  return program;
}

bool LaneProgram::list_elements(const Model& model, std::string& why_not) {
  const Plan& plan = *plan_;
  for_each_list(plan.blocks, [&](const auto& block, int) {
    using E = typename std::remove_cvref_t<decltype(block)>::Element;
    if (in_lanes<E> || block.size() == 0 || !why_not.empty()) return;
    const int row = Joining<E> ? block.row(0) : block.first_row;
    const int element = plan.row_element[at(row)];
    why_not = fmt::format("{} \"{}\" is of a type that is not computed in lanes", model.element_type(element),
                          model.element_name(element));
  });
  if (!why_not.empty()) return false;
  has_immobile_ = plan.moving < plan.bodies;
  int type = 0;
  for_each_lane_type(plan, model, [&](const auto& block, const auto& list) {
    using E = ElementOf<decltype(list)>;
    if (block.size() > 0) of_type_.push_back({static_cast<LaneType>(type), block.size()});
    ++type;
    constexpr int varying = varying_entries<E>();
    for (int e = 0; e < block.size(); ++e) {
      const auto& entry = list[at(block.entry[at(e)])];
      LaneElement lane{block.row(e),
                       block.body_i[at(e)],
                       block.body_j[at(e)],
                       fields_,
                       -1,
                       -1,
                       static_cast<int>(slot_.size()),
                       choice(entry.element),
                       false};
      visit_numbers(entry.element, [&](double, bool) { ++fields_; });
      if constexpr (HasSquaredValue<E>) lane.scale = fields_++;
      if constexpr (E::functions > 0) {
        lane.function = functions_;
        lane.timed = entry.values[0].function >= 0;
        if (lane.timed) timed_.push_back({functions_, entry.values[0].function});
        functions_ += 3;
      }
      slot_.insert(slot_.end(), block.slot.begin() + e * varying, block.slot.begin() + (e + 1) * varying);
      element_.push_back(lane);
    }
    constant_slot_.insert(constant_slot_.end(), block.constant_slot.begin(), block.constant_slot.end());
    constant_.insert(constant_.end(), block.constant.begin(), block.constant.end());
  });
  return true;
}

bool LaneProgram::list_forces(const Model& model, std::string& why_not) {
  const auto refuse = [&](int element, const char* why) {
    why_not = fmt::format("{} \"{}\" {}", model.element_type(element), model.element_name(element), why);
  };
  for_each_list(model.forces, [&](const auto& list, int) {
    using E = ElementOf<decltype(list)>;
    if (force_in_lanes<E> || list.empty() || !why_not.empty()) return;
    refuse(list.front().id, "is a force of a type that is not computed in lanes");
  });
  int type = 0;
  for_each_lane_force(*plan_, model, [&](const auto& block, const auto& list) {
    using E = ElementOf<decltype(list)>;
    if (block.size() > 0) of_force_type_.push_back({static_cast<LaneForceType>(type), block.size()});
    ++type;
    for (int e = 0; e < block.size(); ++e) {
      const auto& entry = list[at(block.entry[at(e)])];
      if constexpr (requires { entry.element.curve; }) {
        if (entry.element.curve) refuse(entry.id, "has a curve of its force, which is not computed in lanes");
      }
      force_.push_back({block.body_i[at(e)], block.body_j[at(e)], fields_, E::functions > 0 ? functions_ : -1,
                        choice(entry.element)});
      visit_numbers(entry.element, [&](double, bool) { ++fields_; });
      for (std::size_t k = 0; k < entry.values.size(); ++k, functions_ += 3) {
        if (entry.values[k].function >= 0) timed_.push_back({functions_, entry.values[k].function});
      }
    }
  });
  code_.masses = fields_;
  code_.gravity = fields_ + 2 * plan_->moving;
  fields_ = code_.gravity + 2;
  return why_not.empty();
}

bool LaneProgram::list_steps(const Model& model, std::string& why_not) {
  std::vector<double> constant(at(plan_->trash_slot()) + 1, 0.0);
  for (std::size_t k = 0; k < constant_.size(); ++k) constant[at(constant_slot_[k])] += constant_[k];
  return elimination_.choose(*plan_, model, slot_, std::move(constant), why_not);
}

void LaneProgram::close() {
  const LaneElimination& e = elimination_;
  code_.moving = plan_->moving;
  code_.frames = plan_->bodies + 1;
  code_.rows = plan_->rows;
  code_.slots = static_cast<int>(e.initial.size());
  code_.element = element_.data();
  code_.of_type = of_type_.data();
  code_.types = static_cast<int>(of_type_.size());
  for (const int slot : slot_) place_.push_back(lane_count * slot);
  code_.place = place_.data();
  code_.factor = e.factor.data();
  code_.factor_runs = static_cast<int>(e.factor.size());
  code_.solve = e.solve.data();
  code_.solve_runs = static_cast<int>(e.solve.size());
  code_.transposed = e.transposed.data();
  code_.transposed_runs = static_cast<int>(e.transposed.size());
  code_.force = force_.data();
  code_.of_force_type = of_force_type_.data();
  code_.force_types = static_cast<int>(of_force_type_.size());
  code_.step = e.step.data();
  code_.reset = e.reset.data();
  code_.resets = static_cast<int>(e.reset.size());
  code_.tail = e.tail.data();
  code_.tails = static_cast<int>(e.tail.size());
  code_.unknown = e.unknown.data();
  code_.lengths = e.lengths;
}

Frame<double> LaneProgram::given_pose(const Model& model, int plan_body) const {
  const auto& body = model.bodies[at(plan_->model_body[at(plan_body)])];
  Frame<double> pose;
  pose.x = body.position.x;
  pose.y = body.position.y;
  pose.phi = body.angle;
  return pose;
}

bool LaneProgram::put(const Model& model, double length_scale, int lane, LaneNumbers& field, LaneNumbers& function,
                      LaneNumbers& frame) const {
  const Plan& plan = *plan_;
  std::size_t next = 0;
  bool finite = true;
  for_each_lane_type(plan, model, [&](const auto& block, const auto& list) {
    using E = ElementOf<decltype(list)>;
    for (int e = 0; e < block.size(); ++e) {
      const auto& entry = list[at(block.entry[at(e)])];
      const LaneElement& code = element_[next++];
      int place = code.field;
      check_choice(choice(entry.element), code.choice, model, entry.id);
      visit_numbers(entry.element, [&](double number, bool is_place) {
        field[place++][lane] = number;
        finite = finite && (!is_place || std::isfinite(number));
      });
      if constexpr (E::functions > 0) {
        double c = entry.values[0].constant;
        if (code.timed) {
          const auto& law = model.functions[at(entry.values[0].function)];
          c = law.evaluate(std::clamp(0.0, law.domain().first, law.domain().last)).f;
        }
        if constexpr (HasSquaredValue<E>)
          field[code.scale][lane] = 0.5 / (std::abs(c) > 0 ? std::abs(c) : length_scale);
        function[code.function][lane] = c;
        finite = finite && std::isfinite(c);
      }
    }
  });
  if (has_loads_) finite = put_forces(model, lane, field, function) && finite;
  const auto put_frame = [&](int number, const Frame<double>& pose) {
    const double values[] = {pose.x, pose.y, pose.phi, pose.c, pose.s};
    for (int k = 0; k < 5; ++k) frame[5 * number + k][lane] = values[k];
  };
  put_frame(plan.bodies, {});
  if (!has_immobile_) return finite;
  std::vector<char> keep_weld;
  for (const auto& weld : std::get<std::vector<ElementEntry<Weld<double>, double>>>(model.constraints))
    keep_weld.push_back(plan.element_row[at(weld.id)] >= 0 || plan.is_released(weld.id));
  const Elimination elimination = eliminate_bodies(model, keep_weld);
  for (int p = plan.moving; p < plan.bodies; ++p) put_frame(p, elimination.pose[at(plan.model_body[at(p)])]);
  return finite;
}

bool LaneProgram::put_forces(const Model& model, int lane, LaneNumbers& field, LaneNumbers& function) const {
  bool finite = true;
  std::size_t next = 0;
  for_each_lane_force(*plan_, model, [&](const auto& block, const auto& list) {
    for (int e = 0; e < block.size(); ++e) {
      const auto& entry = list[at(block.entry[at(e)])];
      const LaneForce& code = force_[next++];
      check_choice(choice(entry.element), code.choice, model, entry.id);
      int place = code.field;
      visit_numbers(entry.element, [&](double number, bool) {
        field[place++][lane] = number;
        finite = finite && std::isfinite(number);
      });
      int value = code.function;
      for (std::size_t k = 0; k < entry.values.size(); ++k, value += 3) {
        if (entry.values[k].function < 0) function[value][lane] = entry.values[k].constant;
      }
    }
  });
  for (int b = 0; b < plan_->moving; ++b) {
    const auto& body = model.bodies[at(plan_->model_body[at(b)])];
    field[code_.masses + 2 * b][lane] = body.mass;
    field[code_.masses + 2 * b + 1][lane] = body.inertia;
  }
  field[code_.gravity][lane] = model.gravity.x;
  field[code_.gravity + 1][lane] = model.gravity.y;
  return finite;
}

LaneProgram::Constraint LaneProgram::constraint(const Model& model, int element, int lane,
                                                const LaneNumbers& field) const {
  Constraint found;
  const ElementRecord& record = model.elements[at(element)];
  const int row = plan_->element_row[at(element)];
  if (record.kind == ElementKind::force || row < 0) return found;
  const auto code = std::find_if(element_.begin(), element_.end(), [&](const LaneElement& e) { return e.row == row; });
  if (code == element_.end()) return found;
  found.row = row;
  found.squared = code->scale >= 0;
  if (found.squared) found.scale = field[code->scale][lane];
  with_list(model.constraints, record.type, [&](const auto& list) {
    using E = ElementOf<decltype(list)>;
    found.pin = std::is_same_v<E, Revolute<double>>;
    if constexpr (E::functions > 0) found.value = list[at(record.index)].values[0];
  });
  return found;
}

void LaneProgram::put_functions(const Model& model, double t, int lane, LaneNumbers& function) const {
  for (const Timed& timed : timed_) {
    const Taylor<double> value = model.functions[at(timed.function)].evaluate(t);
    function[timed.place][lane] = value.f;
    function[timed.place + 1][lane] = value.d;
    function[timed.place + 2][lane] = value.dd;
  }
}

void LaneProgram::spread_functions(LaneNumbers& function) const {
  for (const Timed& timed : timed_) {
    for (int k = timed.place; k < timed.place + 3; ++k)
      std::fill(function[k] + 1, function[k] + lane_count, *function[k]);
  }
}

}  // namespace catena
