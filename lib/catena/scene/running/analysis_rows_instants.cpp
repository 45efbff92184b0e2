// AnalysisRows: derivatives of what is measured, and how the instants of a run and its measures move with the
// parameters.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "catena/analysis/dynamics/dynamics_options.hpp"
#include "catena/analysis/sensitivity/moving_instants.hpp"
#include "catena/scene/running/analysis_run.hpp"

namespace catena {
namespace {

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

// An event's column is at its value where it was found, to rounding of the instant: within this part of its size.
constexpr double at_its_value = 1e-9;

/// Whether a number of the task is its last instant: "until", or the latest of a list, if no other is as late.
bool is_last_instant(const AnalysisTask& task, const TaskNumber& number) {
  if (number.place == TaskNumber::Place::key) return number.key->name == "until";
  if (number.place != TaskNumber::Place::instant || !task.at || number.item >= task.at->size()) return false;
  const double own = (*task.at)[number.item];
  return std::count_if(task.at->begin(), task.at->end(), [&](double t) { return t >= own; }) == 1;
}

}  // namespace

void AnalysisRows::differentiate(std::unique_ptr<StateDerivatives> derivatives) {
  derivatives_ = std::move(derivatives);
  row_derivatives_ = context_.design->rows;
  if (measures_.empty()) return;
  DifferentiateColumns columns;
  columns.at = [this](const Snapshot& snapshot, std::span<double> out, std::span<double> change) {
    if (back_) return back_->keep(snapshot);
    derivatives_->derive(measures_.columns(), snapshot, out, change);
    if (missing_.measured_jump.empty()) missing_.measured_jump = derivatives_->jump();
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
      missing_.measured_jump = fmt::format(
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
  // Motions are good to ten times their tolerance: which of two extremes is larger is not known better.
  if (context_.task.type() == "dynamics")
    measures_.know_accuracy(10 * context_.task.number("tolerance", DynamicsOptions{}.tolerance));
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

std::optional<MeasureAdjoint::MeasureGradients> AnalysisRows::gradients_back() const {
  std::optional<MeasureAdjoint::MeasureGradients> gradients;
  std::string why;
  const auto pulses = measures_.pulses(why);
  if (pulses) gradients = back_->find_gradients(measures_.columns(), *pulses);
  if (!gradients) context_.no_adjoint = pulses ? derivatives_->why() : why;
  return gradients;
}

std::vector<MeasureResult> AnalysisRows::measured() const {
  const bool back = back_ && !measures_.empty();
  const std::optional<MeasureAdjoint::MeasureGradients> found = back ? gradients_back() : std::nullopt;
  const MeasureAdjoint::MeasureGradients* given = found ? &*found : nullptr;
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

}  // namespace catena
