#include "kinematics_machine.hpp"

#include <cmath>

#include "catena/elements/all.hpp"
#include "catena/model/model_add.hpp"
#include "catena/scene/json/near_miss.hpp"

namespace catena::python {
namespace {

/// The value of a driver's function of time, in the model's own list.
FunctionValue<double>* value_of_driver(Model& model, int element) {
  FunctionValue<double>* found = nullptr;
  const auto look = [&](auto& entries) {
    for (auto& entry : entries) {
      if constexpr (std::decay_t<decltype(entry.element)>::functions == 1) {
        if (entry.id == element) found = &entry.values[0];
      }
    }
  };
  std::apply([&](auto&... lists) { (look(lists), ...); }, model.constraints);
  return found;
}

TimeFunction<double> line_through(double t, double value, double rate) {
  const double coefficients[] = {value - rate * t, rate};
  return TimeFunction<double>::polynomial(coefficients);
}

}  // namespace

KinematicsMachine::KinematicsMachine(OpenScene scene, const KinematicsOptions& options)
    : Machine(std::move(scene), {.analysis = "kinematics",
                                 .timed = true,
                                 .velocity = true,
                                 .acceleration = true,
                                 .multipliers = options.inverse_dynamics}),
      options_(options) {
  use_model(scene_.model());
  show_state();
}

std::unique_ptr<Kinematics> KinematicsMachine::analysis_of(std::shared_ptr<const Model> model) const {
  PlanOptions options = plan(*model);
  options.released_elements = model->gaps();  // one-sided elements take no part
  return std::make_unique<Kinematics>(std::move(model), options, options_);
}

void KinematicsMachine::rebuild(std::shared_ptr<const Model> model, Driven driven,
                                const std::optional<SystemState>& start) {
  if (!driven.empty()) {
    Model changed = *model;
    for (const auto& [element, function] : driven) {
      FunctionValue<double>& value = *value_of_driver(changed, element);
      value.function = static_cast<int>(changed.functions.size());
      changed.functions.push_back(function);
    }
    model = std::make_shared<Model>(std::move(changed));
  }
  std::unique_ptr<Kinematics> next = analysis_of(model);
  if (start) {
    next->start_from(*start);
    if (const AssemblyOutcome assembled = next->assemble(); !assembled.ok()) throw StepError(assembled);
  }
  columns_ = resolve(*model, next->plan());
  model_ = std::move(model);
  analysis_ = std::move(next);
  driven_ = std::move(driven);
  forget_row();
}

void KinematicsMachine::use_model(std::shared_ptr<const Model> model) {
  rebuild(std::move(model), driven_, stepped_ ? std::optional(analysis_->state()) : std::nullopt);
  // The row of the present place; where it has none, as at a lock-up, there is no row until a step gives one.
  if (stepped_) static_cast<void>(go({analysis_->time()}, nullptr));
}

AnalysisReport KinematicsMachine::run(const TimeGrid& grid, RowObserver& observer) {
  Needs needs = columns_->needs();
  needs.velocity = true;
  AnalysisReport report = analysis_->run(grid, needs, observer);
  stepped_ = stepped_ || report.ok();
  return report;
}

void KinematicsMachine::drive(const std::string& driver, double value, double rate) {
  const AtWork work(busy_);
  if (!std::isfinite(value) || !std::isfinite(rate))
    throw std::invalid_argument("value and rate of driver " + in_quotes(driver) + " must be finite numbers");
  const int element = model_->find_element(driver);
  if (element < 0 || model_->elements[static_cast<std::size_t>(element)].kind != ElementKind::driver) {
    std::vector<std::string> known;
    for (int e = 0; e < static_cast<int>(model_->elements.size()); ++e) {
      if (model_->elements[static_cast<std::size_t>(e)].kind == ElementKind::driver)
        known.push_back(model_->element_name(e));
    }
    throw py::key_error("there is no driver " + in_quotes(driver) + NearMiss(driver).consider_all(known).hint());
  }
  // All functions of time stand still but the driver's, which runs from its present value to the wanted one within a
  // time of its own, 0 to 1.
  const double t = analysis_->time();
  Model frozen = *model_;
  for (TimeFunction<double>& function : frozen.functions) function = TimeFunction<double>(function.evaluate(t).f);
  FunctionValue<double>& moved = *value_of_driver(frozen, element);
  const double present =
      moved.function < 0 ? moved.constant : frozen.functions[static_cast<std::size_t>(moved.function)].evaluate(0).f;
  moved.function = static_cast<int>(frozen.functions.size());
  frozen.functions.push_back(line_through(0, present, value - present));
  const std::unique_ptr<Kinematics> way = analysis_of(std::make_shared<Model>(std::move(frozen)));
  SystemState start = analysis_->state();
  start.t = 0;
  way->start_from(start);
  Report arrived;
  {
    const py::gil_scoped_release free;
    arrived = way->move_to(1);
  }
  if (!arrived.ok()) {
    arrived.message = "while driver " + in_quotes(driver) + " goes from " + std::to_string(present) + " to " +
                      std::to_string(value) + ", counted as t = 0 to 1: " + arrived.message;
    throw StepError(arrived);
  }
  SystemState end = way->state();
  end.t = t;
  Driven driven = driven_;
  driven[element] = line_through(t, value, rate);
  rebuild(scene_.model(), std::move(driven), end);
  const AnalysisReport report = go({t}, nullptr);
  if (!report.ok()) throw StepError(report);
}

Machine::Numbers KinematicsMachine::accelerations() {
  const AtWork work(busy_);
  if (const Report report = analysis_->solve_rates({.velocity = true, .acceleration = true}); !report.ok())
    throw StepError(report);
  const SystemState rates = state_of(analysis_->evaluator(), time(), analysis_->q(), analysis_->qdd());
  return std::make_shared<std::vector<double>>(rates.qd);
}

}  // namespace catena::python
