#include "catena/analysis/batch/lane_program.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
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
/// a point or an axis; others may be missing.
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
            } else {
              f(member, false);
            }
          }
        };
        (visit(field), ...);
      },
      E::fields());
  if constexpr (requires { element.angle; }) f(element.angle, true);
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

}  // namespace

std::unique_ptr<const LaneProgram> LaneProgram::make(const Model& model, std::shared_ptr<const Plan> plan,
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
  if (!program->list_elements(model, why_not) || !program->list_steps(model, why_not)) return nullptr;
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
      LaneElement lane{
          block.row(e), block.body_i[at(e)], block.body_j[at(e)], fields_, -1, -1, static_cast<int>(slot_.size()),
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
