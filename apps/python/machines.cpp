#include "machines.hpp"

#include <algorithm>
#include <cmath>

#include "catena/elements/all.hpp"
#include "catena/model/model_add.hpp"
#include "catena/scene/json/near_miss.hpp"
#include "catena/scene/judging/distance_check.hpp"
#include "catena/scene/running/analysis_run.hpp"

namespace catena::python {
namespace {

/// Keeps rows, and ends the work when Ctrl-C is pressed.
class StepRows final : public RowObserver {
 public:
  StepRows(const ColumnSet& columns, ResultStorage* kept, SignalWatch& signals)
      : columns_(columns), kept_(kept), signals_(signals), values_(columns.size()) {
    if (kept_) kept_->begin(columns_.info());
  }

  bool observe(const Snapshot& snapshot) override {
    columns_.evaluate(snapshot, values_);
    seen_ = true;
    return (!kept_ || kept_->row(values_)) && signals_.go_on();
  }
  bool proceed(double) override { return signals_.go_on(); }

  /// The last row, if there was any.
  std::span<const double> row() const { return seen_ ? std::span<const double>(values_) : std::span<const double>{}; }

 private:
  const ColumnSet& columns_;
  ResultStorage* kept_;
  SignalWatch& signals_;
  std::vector<double> values_;
  bool seen_ = false;
};

Report refused(std::string message) {
  Report report;
  report.status = Status::refused;
  report.message = std::move(message);
  return report;
}

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

PlanOptions plan_without_gaps(const Model& model, std::span<const std::string> outputs) {
  PlanOptions options = plan_options(model, {outputs.begin(), outputs.end()});
  options.released_elements = model.gaps();
  return options;
}

PlanOptions plan_with(const Model& model, std::span<const std::string> outputs) {
  return plan_options(model, {outputs.begin(), outputs.end()});
}

}  // namespace

Machine::Machine(OpenScene scene, const ColumnSources& sources) : scene_(std::move(scene)), sources_(sources) {}

int Machine::body(const std::string& name) const {
  const int body = model_->find_body(name);
  if (body >= ground) return body;
  std::vector<std::string> known;
  for (int b = 0; b < static_cast<int>(std::min<std::size_t>(model_->bodies.size(), 2000)); ++b)
    known.emplace_back(model_->body_name(b));
  throw py::key_error("there is no body " + in_quotes(name) + NearMiss(name).consider_all(known).hint());
}

ColumnSet Machine::resolve(const Model& model, const Plan& plan) const {
  return ColumnSet::resolve(model, plan, scene_.outputs(), sources_);
}

// The memory stays where it is unless the number of values changes: arrays see the new ones.
void Machine::put(Numbers& numbers, std::span<const double> values) {
  if (!numbers || numbers->size() != values.size()) numbers = std::make_shared<std::vector<double>>(values.size());
  std::copy(values.begin(), values.end(), numbers->begin());
}

void Machine::show_state() {
  const SystemState now = state();
  if (now.q.empty()) {
    std::vector<double> given;
    for (int b = 0; b < static_cast<int>(model_->bodies.size()); ++b) {
      const Frame<double> frame = model_->frame(b);
      given.insert(given.end(), {frame.x, frame.y, frame.phi});
    }
    put(q_, given);
  } else {
    put(q_, now.q);
  }
  if (now.qd.empty()) {
    qd_.reset();
  } else {
    put(qd_, now.qd);
  }
}

AnalysisReport Machine::go(const std::vector<double>& times, ResultStorage* kept) {
  SignalWatch signals;
  AnalysisReport report;
  {
    const py::gil_scoped_release free;
    const TimeGrid grid = TimeGrid::list(times);
    if (const auto problem = vanishing_distance(*model_, time(), grid)) {
      static_cast<Report&>(report) = refused(*problem);
      return report;
    }
    const ColumnSet& columns = resolved();
    info_.assign(columns.info().begin(), columns.info().end());
    notes_.assign(columns.notes().begin(), columns.notes().end());
    StepRows rows(columns, kept, signals);
    report = run(grid, rows);
    if (!rows.row().empty()) put(row_, rows.row());
    show_state();
  }
  warnings_ = report.warnings;
  if (signals.interrupted()) throw py::error_already_set();
  return report;
}

void Machine::step_to(double t) {
  const AtWork work(busy_);
  const AnalysisReport report = go({t}, nullptr);
  if (!report.ok()) throw StepError(report);
}

Analysis Machine::follow(const std::vector<double>& times) {
  const AtWork work(busy_);
  if (times.empty()) throw std::invalid_argument("there are no instants to go to");
  auto rows = std::make_shared<ResultStorage>();
  AnalysisResult result;
  result.type = std::string(sources_.analysis);
  result.report = go(times, rows.get());
  return {std::move(result), std::move(rows)};
}

void Machine::set(const std::map<std::string, double>& values) {
  const AtWork work(busy_);
  const ParameterSeeds before = scene_.changes();
  scene_.set(values);
  try {
    use_model(scene_.model());
  } catch (...) {
    scene_.put_back(before);
    throw;
  }
  show_state();
}

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
  const PlanOptions plan = plan_without_gaps(*model, scene_.outputs());
  return std::make_unique<Kinematics>(std::move(model), plan, options_);
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

// Each step of a motion with contacts is an analysis of its own, which knows nothing of the work done before.
DynamicsMachine::DynamicsMachine(OpenScene scene, const DynamicsOptions& options)
    : Machine(std::move(scene),
              {.analysis = "dynamics", .timed = true, .velocity = true, .acceleration = true, .multipliers = true}),
      options_(options) {
  std::shared_ptr<const Model> model = scene_.model();
  touches_ = !model->gaps().empty() || !model->frictions().empty();
  sources_.work = !touches_;
  use_model(std::move(model));
  show_state();
}

void DynamicsMachine::use_model(std::shared_ptr<const Model> model) {
  const PlanOptions plan = plan_with(*model, scene_.outputs());
  std::unique_ptr<Dynamics> free;
  std::unique_ptr<DynamicsWithEvents> touching;
  if (touches_) {
    touching = std::make_unique<DynamicsWithEvents>(model, plan, options_, std::vector<Event>{}, sources_);
    touching->start_from(state_);
  } else {
    free = std::make_unique<Dynamics>(model, plan, options_);
    free->start_from(state_);
  }
  model_ = std::move(model);
  free_ = std::move(free);
  touching_ = std::move(touching);
  columns_.reset();
}

// With friction the model that is analysed has more equations than that of the scene.
const ColumnSet& DynamicsMachine::resolved() {
  if (!columns_) {
    columns_ = touches_ ? resolve(touching_->evaluator().model(), touching_->plan())
                        : resolve(free_->evaluator().model(), free_->plan());
  }
  return *columns_;
}

AnalysisReport DynamicsMachine::run(const TimeGrid& grid, RowObserver& observer) {
  double last = state_.t;
  for (std::int64_t k = 0; k < grid.size(); ++k) {
    if (grid[k] < last) {
      AnalysisReport report;
      static_cast<Report&>(report) = refused("dynamics goes forwards in time: " + std::to_string(grid[k]) +
                                             " s is before " + std::to_string(last) + " s");
      return report;
    }
    last = grid[k];
  }
  AnalysisReport report;
  if (touches_) {
    touching_ = std::make_unique<DynamicsWithEvents>(model_, plan_with(*model_, scene_.outputs()), options_,
                                                     std::vector<Event>{}, sources_);
    touching_->start_from(state_);
    report = touching_->run(grid, columns_->needs(), observer);
    state_ = touching_->state();
  } else {
    report = free_->run(grid, columns_->needs(), observer);
    if (columns_->needs().work && report.ok()) free_->carry_on(free_->work_so_far());
    state_ = free_->state();
  }
  return report;
}

Frame<double> DynamicsMachine::frame(int body) const {
  if (free_) return free_->frame(body);
  if (state_.q.empty()) return model_->frame(body);
  static_cast<void>(model_->body_name(body));  // throws for an invalid number
  if (body < 0) return {};
  const std::size_t first = 3 * static_cast<std::size_t>(body);
  Frame<double> frame = make_frame(state_.q[first], state_.q[first + 1], state_.q[first + 2]);
  const Vec2<double> origin = frame.point(model_->bodies[static_cast<std::size_t>(body)].origin);
  frame.x = origin.x;
  frame.y = origin.y;
  return frame;
}

std::string_view DynamicsMachine::method() const { return to_string(free_ ? free_->method() : touching_->method()); }

EquilibriumMachine::EquilibriumMachine(OpenScene scene, const EquilibriumOptions& options)
    : Machine(std::move(scene), {.analysis = "equilibrium", .multipliers = true}), options_(options) {
  use_model(scene_.model());
  show_state();
}

// The plan stays where the structure does: the last solution is then the next start.
void EquilibriumMachine::use_model(std::shared_ptr<const Model> model) {
  bool fits = analysis_ && model->bodies.size() == model_->bodies.size();
  if (fits) {
    try {
      analysis_->set_model(model);
    } catch (const std::invalid_argument&) {
      fits = false;
    }
  }
  if (!fits) {
    auto next = std::make_unique<Equilibrium>(model, plan_with(*model, scene_.outputs()), options_);
    if (analysis_ && model->bodies.size() == model_->bodies.size()) next->start_from(analysis_->state());
    analysis_ = std::move(next);
    columns_ = resolve(*model, analysis_->plan());
  }
  model_ = std::move(model);
}

AnalysisReport EquilibriumMachine::run(const TimeGrid& grid, RowObserver& observer) {
  report_ = analysis_->run(grid, columns_->needs(), observer);
  return report_;
}

}  // namespace catena::python
