#include "catena/scene/running/analysis_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "catena/analysis/run/process_time.hpp"
#include "catena/base/si_unit.hpp"
#include "catena/scene/numbers/quantity.hpp"
#include "catena/scene/running/analysis_run.hpp"

namespace catena {
namespace {

// What is summed up over a part of a stretch that is shorter than this part of it, or of t, makes no difference: that
// of what grows like a power of time above 1 is 1e-6 of it, and rounding of instants is that of its limits.
constexpr double least_part = 1e-6, least_part_of_instant = 1e-10;

/// The unit of an integral over time of what has this unit; empty where that is not known.
std::string times_second(const std::string& unit) {
  if (unit.empty()) return {};
  // Of what torques and energies have in common, a power gives energies.
  if (unit == si_unit(UnitKind::power)) return std::string(si_unit(UnitKind::energy));
  const Parsed<Quantity> quantity = parse_quantity(unit == "1" ? "1 s" : "1 " + unit);
  if (!quantity) return {};
  return si_unit(unit == "1" ? quantity->dimension : quantity->dimension * dimension_of(UnitKind::time));
}

// The word of an event's action that stops the run; see event_entries.cpp.
constexpr int stop_action = 1;

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
      cables_(model),
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

void AnalysisRows::begin() {
  if (row_derivatives_) {
    const std::size_t plain = info_.size();
    for (std::size_t k = 0; k < plain; ++k) {
      if (info_[k].unit == UnitKind::time) continue;
      for (const std::string& parameter : context_.design->names)
        info_.push_back({.name = fmt::format("d({})/d({})", info_[k].name, parameter),
                         .unit = UnitKind::own,
                         .differentiated_unit = std::string(info_[k].unit_text())});
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
  if (derivatives_ && derivatives_->why().empty()) {
    if (std::string kink = cables_.passed(stretch); !kink.empty()) derivatives_->give_up(std::move(kink));
  }
  if (derivatives_) derivatives_->cover(stretch);
  if (derivatives_ && derivatives_->part_ends().size() > 1)
    cover_parts(stretch, derivatives_->part_ends());
  else
    measures_.cover(stretch);
  return true;
}

// A stretch in which derivatives are smooth part by part.
void AnalysisRows::cover_parts(const MotionStretch& stretch, std::span<const double> ends) {
  const double least = std::max(least_part * (stretch.to - stretch.from), least_part_of_instant * std::abs(stretch.to));
  MotionStretch part = stretch, last = stretch;
  part.ended_by = -1;
  part.ends_phase = false;
  for (const double end : ends) {
    if (!(end - part.from > least && stretch.to - end > least)) continue;
    part.to = end;
    measures_.cover(part);
    last.from = part.from = end;
  }
  measures_.cover(last);
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
  if (!missing_.measured_jump.empty()) return missing_.measured_jump;
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
    missing_.jump = fmt::format(
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
    if (!derivatives_->derive(columns_, snapshot, row_gradients_)) ++missing_.rows;
    if (missing_.jump.empty()) missing_.jump = derivatives_->jump();
    leave_out_at_instant(snapshot.t);
    std::copy(row_gradients_.begin() + static_cast<std::ptrdiff_t>(first * parameters), row_gradients_.end(),
              values_.begin() + static_cast<std::ptrdiff_t>(plain));
  }
  ++rows_;
  return context_.rows.row(values_) && proceed(snapshot.t);
}

void AnalysisRows::finish(AnalysisResult& result) {
  look_at_what_is_left();
  if (accuracy_) {
    result.digits = accuracy_->digits(result.report);
    if (std::string why = accuracy_->why_none(); !why.empty()) result.fields.push_back({"digits_note", std::move(why)});
    if (std::string doubt = accuracy_->doubt(); !doubt.empty()) result.report.warnings.push_back(std::move(doubt));
  }
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
    for (const std::string& why : {derivatives_->why(), derivatives_->lack(), missing_.jump}) {
      if (!why.empty()) result.report.warnings.push_back("derivatives: " + why);
    }
  }
  if (row_derivatives_ && columns_.needs().work) {
    result.report.warnings.push_back(
        "derivatives: work and dissipated energy, which are summed up over time, have none");
  }
  if (missing_.rows > 0) result.report.warnings.push_back(fmt::format("{} rows have no derivatives", missing_.rows));
}

}  // namespace catena
