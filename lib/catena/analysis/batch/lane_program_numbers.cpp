// Numbers of designs, put into the lanes of a program.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "catena/analysis/batch/lane_lists.hpp"
#include "catena/analysis/batch/lane_program.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

void check_choice(int choice, int chosen, const Model& model, int element) {
  if (choice == chosen) return;
  throw std::invalid_argument(fmt::format("{} \"{}\" has another flag or side than in the model of the batch",
                                          model.element_type(element), model.element_name(element)));
}

}  // namespace

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
  if (has_loads_ && !takes_forces_) finite = put_forces(model, lane, field, function) && finite;
  if (has_loads_) put_masses(model, lane, field);
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
  return finite;
}

void LaneProgram::put_masses(const Model& model, int lane, LaneNumbers& field) const {
  for (int b = 0; b < plan_->moving; ++b) {
    const auto& body = model.bodies[at(plan_->model_body[at(b)])];
    field[code_.loads.masses + 2 * b][lane] = body.mass;
    field[code_.loads.masses + 2 * b + 1][lane] = body.inertia;
  }
  // Forces that evaluators give have the weight in them.
  field[code_.loads.gravity][lane] = takes_forces_ ? 0 : model.gravity.x;
  field[code_.loads.gravity + 1][lane] = takes_forces_ ? 0 : model.gravity.y;
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
