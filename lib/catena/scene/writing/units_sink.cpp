#include "catena/scene/writing/units_sink.hpp"

namespace catena {
namespace {

ColumnInfo converted(const ColumnInfo& column, const OutputUnits::Conversion& to) {
  if (to.unit == column.unit_text()) return column;
  return {column.name, UnitKind::own, to.unit, column.is_status};
}

/// A derivative is shown as what is differentiated, by a parameter in SI.
OutputUnits::Conversion conversion(const OutputUnits& units, std::string_view unit, const std::string& differentiated) {
  if (differentiated.empty()) return units.of(unit);
  return {.factor = units.of(differentiated).factor, .unit = std::string(unit)};
}

}  // namespace

void UnitsSink::begin_run(const RunHeader& header) {
  units_ = {};
  if (scene_ == Scene::counts) units_.ask(header.units);
  units_.ask(wishes_);
  target_.begin_run(header);
}

RowSink& UnitsSink::begin_analysis(std::string_view type) {
  rows_ = &target_.begin_analysis(type);
  if (!units_.any()) return *rows_;
  return *this;
}

void UnitsSink::begin(std::span<const ColumnInfo> columns) {
  std::vector<ColumnInfo> shown;
  factor_.clear();
  for (const ColumnInfo& column : columns) {
    const OutputUnits::Conversion to = conversion(units_, column.unit_text(), column.differentiated_unit);
    factor_.push_back(to.factor);
    shown.push_back(converted(column, to));
  }
  row_.resize(columns.size());
  rows_->begin(shown);
}

bool UnitsSink::row(std::span<const double> values) {
  for (std::size_t c = 0; c < row_.size(); ++c) row_[c] = factor_[c] * values[c];
  return rows_->row(row_);
}

void UnitsSink::end_analysis(const AnalysisResult& result) {
  if (!units_.any()) return target_.end_analysis(result);
  AnalysisResult shown = result;
  const double seconds = units_.of("s").factor;
  for (ColumnInfo& column : shown.columns) {
    column = converted(column, conversion(units_, column.unit_text(), column.differentiated_unit));
  }
  for (ColumnExtreme& extreme : shown.extremes) {
    const OutputUnits::Conversion to = conversion(units_, extreme.unit, extreme.differentiated_unit);
    extreme.unit = to.unit;
    extreme.least *= to.factor;
    extreme.largest *= to.factor;
    if (shown.extremes_have_time) extreme.least_t *= seconds, extreme.largest_t *= seconds;
  }
  for (MeasureResult& measure : shown.measures) {
    const OutputUnits::Conversion to = units_.of(measure.unit);
    measure.unit = to.unit;
    if (measure.value) *measure.value *= to.factor;
    if (measure.t) *measure.t *= seconds;
    // Derivatives are by parameters in SI.
    for (double& slope : measure.gradient) slope *= to.factor;
  }
  target_.end_analysis(shown);
}

}  // namespace catena
