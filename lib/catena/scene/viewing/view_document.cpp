#include "catena/scene/viewing/view_document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <unordered_map>

#include "catena/drawing/shapes/guide_travel.hpp"
#include "catena/drawing/shapes/pen.hpp"
#include "catena/results/measure_gradient.hpp"
#include "catena/results/status_word.hpp"
#include "catena/scene/viewing/packed_numbers.hpp"
#include "catena/scene/viewing/view_json.hpp"
#include "catena/scene/writing/field_json.hpp"

namespace catena {
namespace {

/// Calls f for every analysis, those of designs among them.
template <class F>
void for_each_analysis(const std::vector<RecordedAnalysis>& analyses, F&& f) {
  for (const RecordedAnalysis& analysis : analyses) {
    f(analysis);
    for (const RecordedDesign& design : analysis.designs) for_each_analysis(design.analyses, f);
  }
}

/// Drawings by model: analyses with parameters of their own have one of their own.
class Drawings {
 public:
  explicit Drawings(const RunRecord& record) {
    add(record.model);
    for_each_analysis(record.analyses, [this](const RecordedAnalysis& analysis) {
      add(analysis.model);
      Drawing& drawing = drawings_[number(analysis.model)];
      for (std::size_t k = 0; k < analysis.poses.size() && !drawing.guides.empty(); ++k)
        observe_guides(drawing, frames_of(analysis.layout, analysis.poses[k]));
    });
    for (Drawing& drawing : drawings_) fit_guides(drawing, 0.2 * drawing.typical_length);
  }

  std::size_t number(const std::shared_ptr<const Model>& model) const { return numbers_.at(model.get()); }
  void append_to(ViewJson& json) const {
    json.key("drawings").open('[');
    for (std::size_t k = 0; k < models_.size(); ++k) {
      json.open('{');
      append_drawing(json, *models_[k], drawings_[k]);
      if (k > 0 && !same_names(*models_[k], *models_.front())) append_names(json, *models_[k]);
      json.close('}');
    }
    json.close(']');
  }

 private:
  void add(const std::shared_ptr<const Model>& model) {
    if (!numbers_.emplace(model.get(), models_.size()).second) return;
    models_.push_back(model);
    drawings_.push_back(draw_model(*model));
    observe_guides(drawings_.back(), given_poses(*model));
  }

  std::vector<std::shared_ptr<const Model>> models_;
  std::vector<Drawing> drawings_;
  std::unordered_map<const Model*, std::size_t> numbers_;
};

/// The values of a column that number a status, each with its name.
void append_words(ViewJson& json, const RecordedAnalysis& analysis, std::size_t column) {
  std::set<double> found;
  for (std::size_t k = 0; k < analysis.rows.size(); ++k) {
    if (std::isfinite(analysis.rows[k][column])) found.insert(analysis.rows[k][column]);
  }
  json.key("words").open('{');
  for (const double value : found) json.key(fmt::format("{}", static_cast<int>(value))).text(status_word(value));
  json.close('}');
}

void append_columns(ViewJson& json, const RecordedAnalysis& analysis) {
  json.key("rows").open('{').key("count").count(analysis.rows.size()).key("total").value(analysis.rows.seen());
  json.key("stride").value(analysis.rows.stride()).close('}');
  json.key("columns").open('[');
  for (std::size_t c = 0; c < analysis.columns_kept && c < analysis.result.columns.size(); ++c) {
    const ColumnInfo& column = analysis.result.columns[c];
    json.open('{').key("name").text(column.name).key("unit").text(column.unit_text());
    if (column.is_status) append_words(json, analysis, c);
    json.key("values");
    PackedNumbers packed;
    for (std::size_t k = 0; k < analysis.rows.size(); ++k) packed.add_double(analysis.rows[k][c]);
    json.packed("float64", packed).close('}');
  }
  json.close(']');
}

void append_measures(ViewJson& json, const AnalysisResult& result) {
  json.key("measures").open('[');
  for (const MeasureResult& measure : result.measures) {
    json.open('{').key("name").text(measure.name).key("unit").text(measure.unit).key("value");
    json.value(measure.value.value_or(std::numeric_limits<double>::quiet_NaN()));  // written as null
    if (measure.t) json.key("t").value(*measure.t);
    if (!result.gradient_parameters.empty()) {
      json.key("gradient").open('{');
      for (const auto& [parameter, derivative] : named_gradient(result, measure)) json.key(parameter).value(derivative);
      json.close('}');
    }
    json.close('}');
  }
  json.close(']');
}

void append_analysis(ViewJson& json, const RecordedAnalysis& analysis, const Drawings& drawings);

/// What an optimisation or a sweep made of some of its designs; nothing for other analyses.
void append_designs(ViewJson& json, const std::vector<RecordedDesign>& designs, const Drawings& drawings) {
  if (designs.empty()) return;
  json.key("designs").open('[');
  for (const RecordedDesign& design : designs) {
    json.open('{').key("name").text(design.label.name);
    if (design.label.row >= 0) json.key("row").value(design.label.row);
    json.key("values").open('{');
    for (const auto& [name, value] : design.label.values) json.key(name).value(value);
    json.close('}').key("analyses").open('[');
    for (const RecordedAnalysis& analysis : design.analyses) append_analysis(json, analysis, drawings);
    json.close(']').close('}');
  }
  json.close(']');
}

void append_analysis(ViewJson& json, const RecordedAnalysis& analysis, const Drawings& drawings) {
  const AnalysisReport& report = analysis.result.report;
  json.open('{').key("type").text(analysis.result.type).key("status").text(to_string(report.status));
  json.key("message").text(report.message).key("warnings").open('[');
  for (const std::string& warning : report.warnings) json.text(warning);
  json.close(']').key("seconds").value(report.seconds);
  if (report.dof) json.key("dof").value(std::int64_t{*report.dof});
  if (report.mobility) json.key("mobility").value(std::int64_t{*report.mobility});
  json.key("redundant").open('[');
  for (const std::string& name : report.redundant) json.text(name);
  json.close(']').key("set").open('{');
  for (const auto& [name, value] : analysis.result.set) json.key(name).value(value);
  json.close('}').key("fields").open('{');
  for (const NamedField& field : analysis.result.fields) {
    // A page has no room for lists of any length; the rows of a sweep have the statuses.
    if (!std::holds_alternative<std::shared_ptr<const LongList>>(field.value))
      append_field(json.key(field.name).text_of_value(), field.value);
  }
  json.close('}').key("drawing").count(drawings.number(analysis.model));
  append_measures(json, analysis.result);
  append_columns(json, analysis);
  append_poses(json.key("poses"), analysis);
  json.key("shapes").open('[');
  for (const std::vector<double>& shape : analysis.shapes) {
    PackedNumbers packed;
    for (const double value : shape) packed.add_float(value);
    json.packed("float32", packed);
  }
  json.close(']');
  append_designs(json, analysis.designs, drawings);
  json.close('}');
}

/// The SI units of this run's numbers that are to be shown in another, with the factor.
void append_units(ViewJson& json, const RunRecord& record, const OutputUnits::Wishes& wishes) {
  OutputUnits units;
  units.ask(record.header.units);
  units.ask(wishes);
  json.key("units").open('{');
  if (units.any()) {
    std::set<std::string, std::less<>> shown{"m", "s", "rad", "N", "m/s"};  // what the page says of its own accord
    for_each_analysis(record.analyses, [&](const RecordedAnalysis& analysis) {
      for (const ColumnInfo& column : analysis.result.columns) shown.emplace(column.unit_text());
      for (const MeasureResult& measure : analysis.result.measures) shown.emplace(measure.unit);
    });
    for (const std::string& si : shown) {
      const OutputUnits::Conversion to = units.of(si);
      if (to.unit != si) json.key(si).open('{').key("unit").text(to.unit).key("factor").value(to.factor).close('}');
    }
  }
  json.close('}');
}

/// What is left out of designs and arrows.
void note_parts(const RecordedAnalysis& analysis, const std::string& which, std::vector<std::string>& notes) {
  const std::size_t designs = analysis.designs.size();
  const bool swept = analysis.result.type == "sweep";
  if (swept && static_cast<std::int64_t>(designs) < analysis.rows.seen())
    notes.push_back(
        fmt::format("{}: the mechanism can be seen in {} of {} designs", which, designs, analysis.rows.seen()));
  if (analysis.poses.size() > 0 && !analysis.layout.arrows)
    notes.push_back(
        fmt::format("{}: no arrows of velocities and forces are in this page, as there are {} bodies and "
                    "elements",
                    which, analysis.layout.bodies + analysis.model->elements.size()));
}

}  // namespace

std::vector<std::string> view_notes(const RunRecord& record) {
  std::vector<std::string> notes;
  for (std::size_t k = 0; k < record.analyses.size(); ++k) {
    const RecordedAnalysis& a = record.analyses[k];
    const std::string which = fmt::format("analysis {} ({})", k + 1, a.result.type);
    if (a.poses.stride() > 1)
      notes.push_back(fmt::format("{}: {} of {} poses are in this page, every {}th", which, a.poses.size(),
                                  a.poses.seen(), a.poses.stride()));
    if (a.rows.stride() > 1)
      notes.push_back(fmt::format("{}: {} of {} rows are in this page, every {}th", which, a.rows.size(), a.rows.seen(),
                                  a.rows.stride()));
    if (a.columns_kept < a.result.columns.size())
      notes.push_back(fmt::format("{}: the first {} of {} columns are in this page", which, a.columns_kept,
                                  a.result.columns.size()));
    note_parts(a, which, notes);
  }
  if (static_cast<std::size_t>(record.header.analyses) > record.analyses.size()) {
    const bool stopped = !record.analyses.empty() && record.analyses.back().result.report.status == Status::cancelled;
    notes.push_back(
        fmt::format("{} of {} analyses were run: {}", record.analyses.size(), record.header.analyses,
                    stopped ? "the run was stopped" : "the last of them did not leave a state to go on from"));
  }
  return notes;
}

std::string view_document(const RunRecord& record, const OutputUnits::Wishes& wishes) {
  const Drawings drawings(record);
  std::string out;
  ViewJson json(out);
  json.open('{').key("catena_view").value(std::int64_t{view_version}).key("version").text(record.header.version);
  json.key("scene").text(record.header.scene).key("description").text(record.header.description);
  json.key("gravity").open('[').value(record.header.gravity[0]).value(record.header.gravity[1]).close(']');
  json.key("parameters").open('{');
  for (const auto& [name, value] : record.header.parameters) json.key(name).value(value);
  json.close('}');
  append_units(json, record, wishes);
  append_names(json, *record.model);
  drawings.append_to(json);
  json.key("analyses").open('[');
  for (const RecordedAnalysis& analysis : record.analyses) append_analysis(json, analysis, drawings);
  json.close(']').key("notes").open('[');
  for (const std::string& note : view_notes(record)) json.text(note);
  json.close(']').close('}');
  return out;
}

}  // namespace catena
