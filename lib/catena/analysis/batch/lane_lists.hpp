// The lists of a model that lanes compute, type after type, and the numbers of one element in the order in which
// kernels read them. Private to lane_program.
#pragma once

#include <tuple>
#include <type_traits>
#include <vector>

#include "catena/analysis/batch/kernels/lane_code.hpp"
#include "catena/assembly/plan.hpp"
#include "catena/elements/all.hpp"
#include "catena/model/model.hpp"

namespace catena {

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

}  // namespace catena
