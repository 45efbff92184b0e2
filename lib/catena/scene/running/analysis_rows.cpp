#include "catena/scene/running/analysis_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "catena/analysis/run/process_time.hpp"
#include "catena/analysis/sensitivity/joint_jumps.hpp"
#include "catena/scene/numbers/quantity.hpp"
#include "catena/scene/running/analysis_run.hpp"

namespace catena {
namespace {

/// The unit of an integral over time of what has this unit; empty where that is not known.
std::string times_second(const std::string& unit) {
  if (unit.empty()) return {};
  const Parsed<Quantity> quantity = parse_quantity(unit == "1" ? "1 s" : "1 " + unit);
  if (!quantity) return {};
  return si_unit(unit == "1" ? quantity->dimension : quantity->dimension * dimension_of(UnitKind::time));
}

/// The number that a measure of the kind `field` names, if the result has it.
std::optional<double> reported(const AnalysisResult& result, const MeasureRequest& request) {
  for (const NamedField& field : result.fields) {
    if (field.name != request.field) continue;
    const auto place = static_cast<std::size_t>(request.number) - 1;
    if (const auto* number = std::get_if<double>(&field.value); number && request.number == 0) return *number;
    if (const auto* count = std::get_if<std::int64_t>(&field.value); count && request.number == 0)
      return static_cast<double>(*count);
    if (const auto* list = std::get_if<std::vector<double>>(&field.value); list && place < list->size())
      return (*list)[place];
    if (const auto* records = std::get_if<std::vector<FieldRecord>>(&field.value); records && place < records->size()) {
      for (const auto& [name, value] : (*records)[place]) {
        if (name != request.part) continue;
        if (const auto* number = std::get_if<double>(&value)) return *number;
        if (const auto* count = std::get_if<std::int64_t>(&value)) return static_cast<double>(*count);
      }
    }
  }
  return {};
}

// The word of an event's action that stops the run; see event_entries.cpp.
constexpr int stop_action = 1;
// An event's column is at its value where it was found, to rounding of the instant: within this part of its size.
constexpr double at_its_value = 1e-9;

// How far an instant is moved to see what goes with it: of it, or of 1 s. Rounding of instants is 1e-13.
constexpr double short_way = 1e-6;

/// Whether parameter p of the design request moves all that jumps at t with the same rate.
bool moves_as_one(const AnalysisContext& context, std::size_t p, double t, double rate) {
  const double way = short_way * std::max(std::abs(t), 1.0);
  const std::vector<double> values = context.models->values(*context.task.table, context.seeds);
  const auto index = static_cast<std::size_t>(context.design->parameters[p]);
  for (const double by : {way, -way}) {
    const auto model = model_at(context, context.design->parameters[p], values[index] + by / rate);
    // A parameter at its limit moves one way only.
    if (model) return jumps_together(model->functions, t, by);
  }
  return false;
}

/// Whether a number of the task is its last instant: "until", or the latest of a list, if no other is as late.
bool is_last_instant(const AnalysisTask& task, const TaskNumber& number) {
  if (number.place == TaskNumber::Place::key) return number.key->name == "until";
  if (number.place != TaskNumber::Place::instant || !task.at || number.item >= task.at->size()) return false;
  const double own = (*task.at)[number.item];
  return std::count_if(task.at->begin(), task.at->end(), [&](double t) { return t >= own; }) == 1;
}

bool stops(const EventRequest& event) { return event.action == stop_action && !event.impulse; }

/// What is measured: what is asked for, and, where derivatives are wanted, the columns of events that stop.
std::vector<MeasureRequest> requests_of(const AnalysisContext& context) {
  std::vector<MeasureRequest> requests = context.task.measure_requests();
  if (!context.design || requests.empty()) return requests;
  for (const EventRequest& event : context.task.events) {
    MeasureRequest request;
    request.kind = MeasureKind::final;
    request.columns = {event.column};
    if (stops(event)) requests.push_back(std::move(request));
  }
  return requests;
}

}  // namespace

AnalysisRows::~AnalysisRows() = default;

AnalysisRows::AnalysisRows(const ColumnSet& columns, AnalysisContext& context, const Model& model, const Plan& plan,
                           const ColumnSources& sources, const TimeRange& run)
    : columns_(columns),
      context_(context),
      measures_(requests_of(context), model, plan, sources, run),
      sources_(sources),
      info_(columns.info().begin(), columns.info().end()),
      timed_(sources.timed),
      first_(run.first),
      last_(run.last),
      covered_to_(run.first),
      reached_(run.first) {
  if (!context.design || measures_.empty()) return;
  for (std::size_t e = 0; e < context.task.events.size(); ++e) {
    if (stops(context.task.events[e])) stops_.push_back(e);
  }
}

void AnalysisRows::differentiate(std::unique_ptr<StateDerivatives> derivatives) {
  derivatives_ = std::move(derivatives);
  row_derivatives_ = context_.design->rows;
  if (measures_.empty()) return;
  DifferentiateColumns columns;
  columns.at = [this](const Snapshot& snapshot, std::span<double> out, std::span<double> change) {
    if (back_) return back_->keep(snapshot);
    derivatives_->derive(measures_.columns(), snapshot, out, change);
    if (measured_jump_.empty()) measured_jump_ = derivatives_->jump();
  };
  columns.moving = [this, known = std::map<double, std::vector<double>>()](double t) mutable {
    if (const std::vector<double>* rates = derivatives_->phase_instant(t)) return *rates;
    const auto found = known.find(t);
    if (found != known.end()) return found->second;
    const MovingInstant& instant = derivatives_->instant_at(t);
    std::vector<double> rates = instant.moves() ? instant.rate : std::vector<double>{};
    for (std::size_t p = 0; p < rates.size(); ++p) {
      // Where columns bend alone, integrals have no part of it.
      if (rates[p] == 0 || instant.order > 2 || moves_as_one(context_, p, t, rates[p])) continue;
      rates[p] = std::numeric_limits<double>::quiet_NaN();
      measured_jump_ = fmt::format(
          "at t = {:.9g} s functions of time jump together, at instants that move apart with the parameters", t);
    }
    known.emplace(t, rates);
    return rates;
  };
  bool end_moves = !stops_.empty(), instants_move = false;
  for (const auto& moving :
       context_.models->moving_numbers(context_.task, context_.seeds, context_.design->parameters)) {
    for (const SceneModels::MovingNumber& one : moving) {
      const bool until = is_last_instant(context_.task, one.number);
      end_moves = end_moves || until;
      // Those of a timed path are spread over the run.
      instants_move = instants_move || until || one.number.place == TaskNumber::Place::measured_instant;
    }
  }
  measures_.differentiate(derivatives_->parameters(), std::move(columns), end_moves, instants_move);
}

void AnalysisRows::differentiate_back(std::unique_ptr<MotionMeasures> derivatives) {
  back_ = derivatives.get();
  differentiate(std::move(derivatives));
  measures_.give_pulses();
}

void AnalysisRows::begin() {
  if (row_derivatives_) {
    const std::size_t plain = info_.size();
    for (std::size_t k = 0; k < plain; ++k) {
      if (info_[k].unit == UnitKind::time) continue;
      for (const std::string& parameter : context_.design->names)
        info_.push_back({fmt::format("d({})/d({})", info_[k].name, parameter), UnitKind::own});
    }
  }
  values_.resize(info_.size());
  context_.rows.begin(info_);
}

Needs AnalysisRows::asked_needs() const {
  Needs needs = columns_.needs();
  return needs |= measured_needs();
}

Needs AnalysisRows::needs() const {
  Needs needs = asked_needs();
  if (!drawn_) needs |= drawn_needs();
  return needs;
}

Needs AnalysisRows::drawn_needs() const {
  if (!context_.poses) return {};
  Needs needs = context_.poses->needs();
  needs.velocity = needs.velocity && sources_.velocity;
  needs.acceleration = needs.acceleration && sources_.acceleration;
  needs.multipliers = needs.multipliers && sources_.multipliers;
  needs.work = needs.work && sources_.work;
  return needs;
}

void AnalysisRows::draw(const Snapshot& snapshot) const {
  if (!context_.poses) return;
  const std::optional<Snapshot> seen = drawn_ ? drawn_(snapshot) : std::nullopt;
  context_.poses->pose(seen ? *seen : snapshot);
}

void AnalysisRows::tell(double t) const {
  if (context_.progress) context_.progress(last_ == first_ ? 1 : std::clamp((t - first_) / (last_ - first_), 0.0, 1.0));
}

bool AnalysisRows::proceed(double t) {
  tell(t);
  return !(context_.cancel && context_.cancel->load(std::memory_order_relaxed));
}

bool AnalysisRows::cover(const MotionStretch& stretch) {
  if (derivatives_) derivatives_->cover(stretch);
  measures_.cover(stretch);
  return true;
}

void AnalysisRows::look_since_last_row(const Snapshot& snapshot) {
  if (!make_look_ || measures_.empty()) return;
  if (!look_) look_ = make_look_(snapshot);
  // Rows may be listed in any order of their instants: every part of the motion counts once.
  if (!(snapshot.t > covered_to_)) return;
  reached_ = std::max(reached_, snapshot.t);
  if (snapshot.t - covered_to_ >= measures_.pace() || snapshot.t == last_) look_at_what_is_left();
}

void AnalysisRows::look_at_what_is_left() {
  if (!(reached_ > covered_to_)) return;
  measures_.cover({covered_to_, reached_, look_});
  covered_to_ = reached_;
}

std::string AnalysisRows::why_no_derivative() const {
  if (!derivatives_->why().empty()) return derivatives_->why();
  if (!derivatives_->lack().empty()) return derivatives_->lack();
  if (!measured_jump_.empty()) return measured_jump_;
  if (measured_needs().work) return "work and dissipated energy, which are summed up over time, have no derivative";
  return "the derivative of its column is not a number there";
}

// A row at which the motion goes on in another way lies before or behind that instant where the parameters move it.
void AnalysisRows::leave_out_at_instant(double t) {
  const std::vector<double>* rates = derivatives_->phase_instant(t);
  if (!rates) return;
  for (std::size_t k = 0; k < row_gradients_.size(); ++k) {
    if ((*rates)[k % rates->size()] == 0) continue;
    row_gradients_[k] = std::numeric_limits<double>::quiet_NaN();
    jump_ = fmt::format(
        "at t = {:.9g} s the motion goes on in another way, at an instant that moves with the parameters: the row at "
        "it "
        "has no derivatives",
        t);
  }
}

bool AnalysisRows::observe(const Snapshot& snapshot) {
  tell(snapshot.t);
  if (gaps_) gaps_->observe(snapshot);
  draw(snapshot);
  look_since_last_row(snapshot);
  measures_.take_row(snapshot, !timed_ || rows_alone_);
  columns_.evaluate(snapshot, values_);
  if (accuracy_) accuracy_->take(snapshot, values_);
  if (row_derivatives_) {
    const std::size_t plain = columns_.size(), first = plain > 0 && info_[0].unit == UnitKind::time ? 1 : 0;
    const auto parameters = static_cast<std::size_t>(derivatives_->parameters());
    row_gradients_.assign(plain * parameters, std::numeric_limits<double>::quiet_NaN());
    if (!derivatives_->derive(columns_, snapshot, row_gradients_)) ++missing_;
    if (jump_.empty()) jump_ = derivatives_->jump();
    leave_out_at_instant(snapshot.t);
    std::copy(row_gradients_.begin() + static_cast<std::ptrdiff_t>(first * parameters), row_gradients_.end(),
              values_.begin() + static_cast<std::ptrdiff_t>(plain));
  }
  ++rows_;
  return context_.rows.row(values_) && proceed(snapshot.t);
}

// The run ends where h(t, p) = value: dT/dp = -(h_p - value_p) / h'.
std::vector<double> AnalysisRows::end_by_event(const std::vector<MeasureResult>& results, std::string& why) const {
  std::vector<double> rate(static_cast<std::size_t>(derivatives_->parameters()),
                           std::numeric_limits<double>::quiet_NaN());
  why = "the run ended early, at an instant whose derivative is not known";
  const std::size_t first = results.size() - stops_.size();
  const MeasureResult* stopped = nullptr;
  std::size_t event = 0;
  for (std::size_t k = 0; k < stops_.size(); ++k) {
    const MeasureResult& column = results[first + k];
    const double value = context_.task.events[stops_[k]].value;
    if (!column.value || !column.t) continue;
    const double size = std::max(std::abs(value), std::abs(column.by_last_instant) * (*column.t - first_));
    if (std::abs(*column.value - value) > at_its_value * size) continue;
    if (stopped) {
      why = "the run ended where two events came together, at an instant that has no derivative";
      return rate;
    }
    stopped = &column;
    event = stops_[k];
  }
  if (!stopped) return rate;
  const auto moving = context_.models->moving_numbers(context_.task, context_.seeds, context_.design->parameters);
  for (std::size_t p = 0; p < rate.size(); ++p) {
    double by_value = 0;
    for (const SceneModels::MovingNumber& one : moving[p]) {
      if (one.number.place == TaskNumber::Place::event && one.number.item == event) by_value += one.rate;
    }
    const double rest = stopped->gradient[p] - by_value;
    rate[p] = rest == 0 ? 0 : -rest / stopped->by_last_instant;
    if (!std::isfinite(rate[p])) rate[p] = std::numeric_limits<double>::quiet_NaN();
  }
  return rate;
}

MovingInstants AnalysisRows::moving_instants(const std::vector<MeasureResult>& results) const {
  MovingInstants instants;
  const auto moving = context_.models->moving_numbers(context_.task, context_.seeds, context_.design->parameters);
  const std::size_t parameters = moving.size();
  const auto& all = context_.task.measures;
  std::vector<std::size_t> place(all.size());  // of a measure among those that are not fields
  for (std::size_t m = 0, next = 0; m < all.size(); ++m) {
    place[m] = next;
    next += all[m].request.kind != MeasureKind::field;
  }
  instants.last.assign(parameters, 0.0);
  instants.taken.resize(results.size());
  instants.points.resize(results.size());
  for (std::size_t p = 0; p < parameters; ++p) {
    for (const SceneModels::MovingNumber& one : moving[p]) {
      const TaskNumber& number = one.number;
      if (is_last_instant(context_.task, number)) instants.last[p] += one.rate;
      if (number.place == TaskNumber::Place::path_point)
        instants.points[place[number.item]].push_back({number.part / 2, number.part % 2, p, one.rate});
      if (number.place == TaskNumber::Place::measured_instant) {
        std::vector<double>& rates = instants.taken[place[number.item]];
        rates.resize(parameters, 0.0);
        rates[p] += one.rate;
      }
    }
  }
  if (measures_.ended_early()) instants.last = end_by_event(results, instants.why_unknown);
  return instants;
}

std::optional<MotionAdjoint::Gradients> AnalysisRows::gradients_back() const {
  std::optional<MotionAdjoint::Gradients> gradients;
  std::string why;
  const auto pulses = measures_.pulses(why);
  if (pulses) gradients = back_->find_gradients(measures_.columns(), *pulses);
  if (!gradients) context_.no_adjoint = pulses ? back_->why() : why;
  return gradients;
}

std::vector<MeasureResult> AnalysisRows::measured() const {
  const bool back = back_ && !measures_.empty();
  const std::optional<MotionAdjoint::Gradients> found = back ? gradients_back() : std::nullopt;
  const MotionAdjoint::Gradients* given = found ? &*found : nullptr;
  std::vector<MeasureResult> results = measures_.results(nullptr, given);
  if (!derivatives_ || !timed_ || rows_alone_ || results.empty()) {
    results.resize(results.size() - stops_.size());
    return results;
  }
  const MovingInstants still;
  const MovingInstants instants = moving_instants(measures_.results(&still, given));
  results = measures_.results(&instants, given);
  results.resize(results.size() - stops_.size());
  // What the last instant adds is in the gradients.
  for (MeasureResult& result : results) result.by_last_instant = 0;
  return results;
}

void AnalysisRows::finish(AnalysisResult& result) {
  look_at_what_is_left();
  if (accuracy_) result.digits = accuracy_->digits(result.report);
  take_rows(result, std::move(info_), rows_);
  for (const std::string& note : columns_.notes()) result.report.warnings.push_back(note);
  const ProcessTimer timer;
  std::vector<MeasureResult> measures = measured();
  if (back_) result.report.seconds += timer.seconds();  // the way back comes after the run
  for (MeasureResult& measure : measures) {
    if (timed_ && rows_alone_ && measure.trouble.empty())
      measure.trouble = "taken from the rows alone: this motion is not looked at between them";
    if (measure.times_second) measure.unit = times_second(measure.unit);
    const auto is_missing = [](double derivative) { return !std::isfinite(derivative); };
    if (derivatives_ && measure.trouble.empty() &&
        std::any_of(measure.gradient.begin(), measure.gradient.end(), is_missing))
      measure.trouble = why_no_derivative();
    if (!measure.trouble.empty())
      result.report.warnings.push_back(fmt::format("measure \"{}\": {}", measure.name, measure.trouble));
    result.measures.push_back(std::move(measure));
  }
  if (gaps_) {
    for (std::string& doubt : gaps_->warnings()) result.report.warnings.push_back(std::move(doubt));
  }
  if (context_.design) result.gradient_parameters = context_.design->names;
  if (derivatives_ && derivatives_->goes_back() && context_.no_adjoint.empty())
    context_.no_adjoint = derivatives_->why();
  if (derivatives_) {
    for (const std::string& why : {derivatives_->why(), derivatives_->lack(), jump_}) {
      if (!why.empty()) result.report.warnings.push_back("derivatives: " + why);
    }
  }
  if (row_derivatives_ && columns_.needs().work) {
    result.report.warnings.push_back(
        "derivatives: work and dissipated energy, which are summed up over time, have none");
  }
  if (missing_ > 0) result.report.warnings.push_back(fmt::format("{} rows have no derivatives", missing_));
}

void add_field_measures(const AnalysisContext& context, AnalysisResult& result) {
  for (const PlacedMeasure& placed : context.task.measures) {
    const MeasureRequest& request = placed.request;
    if (request.kind != MeasureKind::field) continue;
    MeasureResult measure;
    measure.name = request.name;
    measure.value = reported(result, request);
    if (measure.value && !std::isfinite(*measure.value)) measure.value.reset();
    if (context.design) {
      measure.gradient.assign(context.design->names.size(), std::numeric_limits<double>::quiet_NaN());
      result.gradient_parameters = context.design->names;
    }
    if (!measure.value) {
      std::string names;
      for (const NamedField& field : result.fields) names += (names.empty() ? "" : ", ") + field.name;
      measure.trouble = fmt::format("{} reports no number {}{}{} (it has {})", context.task.type(), request.field,
                                    request.number > 0 ? fmt::format("[{}]", request.number) : "",
                                    request.part.empty() ? "" : "." + request.part, names.empty() ? "none" : names);
      result.report.warnings.push_back(fmt::format("measure \"{}\": {}", request.name, measure.trouble));
    }
    measure.unit = request.field == "energy"   ? "J"
                   : request.field == "omega"  ? "rad/s"
                   : request.field == "omega2" ? "rad^2/s^2"
                                               : "";
    result.measures.push_back(std::move(measure));
  }
}

void set_field_gradient(const AnalysisContext& context, AnalysisResult& result, std::string_view field, int number,
                        const std::vector<double>& gradient, const std::string& trouble, std::string_view part) {
  for (const PlacedMeasure& placed : context.task.measures) {
    const MeasureRequest& request = placed.request;
    const bool meant = request.kind == MeasureKind::field && request.field == field && request.number == number;
    if (!meant || (number > 0 && !request.part.empty() && request.part != part)) continue;
    for (MeasureResult& measure : result.measures) {
      if (measure.name != request.name || !measure.value) continue;
      measure.gradient = gradient;
      measure.trouble = trouble;
      if (!trouble.empty()) result.report.warnings.push_back(fmt::format("measure \"{}\": {}", measure.name, trouble));
    }
  }
}

}  // namespace catena
