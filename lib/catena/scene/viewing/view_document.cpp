#include "catena/scene/viewing/view_document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "catena/base/si_unit.hpp"
#include "catena/drawing/shapes/guide_travel.hpp"
#include "catena/drawing/shapes/pen.hpp"
#include "catena/scene/running/field_json.hpp"
#include "catena/scene/viewing/packed_numbers.hpp"
#include "catena/scene/viewing/view_json.hpp"

namespace catena {
namespace {

/// Drawings by model: analyses with parameters of their own have one of their own.
class Drawings {
 public:
  explicit Drawings(const RunRecord& record) {
    add(record.model);
    for (const RecordedAnalysis& analysis : record.analyses) {
      add(analysis.model);
      Drawing& drawing = drawings_[number(analysis.model)];
      for (std::size_t k = 0; k < analysis.poses.size() && !drawing.guides.empty(); ++k)
        observe_guides(drawing, frames_of(analysis.layout, analysis.poses[k]));
    }
    for (Drawing& drawing : drawings_) fit_guides(drawing, 0.2 * drawing.typical_length);
  }

  std::size_t number(const std::shared_ptr<const Model>& model) const {
    return static_cast<std::size_t>(std::find(models_.begin(), models_.end(), model) - models_.begin());
  }
  void append_to(ViewJson& json) const {
    json.key("drawings").open('[');
    for (std::size_t k = 0; k < models_.size(); ++k) append_drawing(json, *models_[k], drawings_[k]);
    json.close(']');
  }

 private:
  void add(const std::shared_ptr<const Model>& model) {
    if (number(model) < models_.size()) return;
    models_.push_back(model);
    drawings_.push_back(draw_model(*model));
    observe_guides(drawings_.back(), given_poses(*model));
  }

  std::vector<std::shared_ptr<const Model>> models_;
  std::vector<Drawing> drawings_;
};

void append_names(ViewJson& json, const Model& model) {
  json.key("bodies").open('[');
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) json.text(model.body_name(b));
  json.close(']');
  std::vector<std::string> types;
  std::map<std::string, std::int64_t, std::less<>> number;
  json.key("elements").open('{').key("type").open('[');
  const auto elements = static_cast<int>(model.elements.size());
  for (int e = 0; e < elements; ++e) {
    const auto [place, is_new] =
        number.try_emplace(std::string(model.element_type(e)), static_cast<std::int64_t>(types.size()));
    if (is_new) types.push_back(place->first);
    json.value(place->second);
  }
  json.close(']').key("types").open('[');
  for (const std::string& type : types) json.text(type);
  json.close(']').key("name").open('[');
  for (int e = 0; e < elements; ++e) json.text(model.element_name(e));
  json.close(']').close('}');
}

/// Points with a name, at most so many: the page lists them.
void append_points(ViewJson& json, const Model& model) {
  constexpr std::size_t most = 2000;
  std::vector<std::pair<int, int>> points;  // body, number
  for (int b = 0; b < static_cast<int>(model.bodies.size()) && points.size() < most; ++b) {
    for (int k = model.bodies[static_cast<std::size_t>(b)].first_point; k >= 0;
         k = model.points[static_cast<std::size_t>(k)].next)
      points.emplace_back(b, k);
  }
  json.key("points").open('{').key("body").open('[');
  for (const auto& [body, k] : points) json.value(std::int64_t{body});
  json.close(']').key("name").open('[');
  for (const auto& [body, k] : points) json.text(model.point_names[model.points[static_cast<std::size_t>(k)].name]);
  json.close(']').key("at").open('[');
  for (const auto& [body, k] : points) {
    const Vec2<double>& local = model.points[static_cast<std::size_t>(k)].local;
    json.rounded(local.x).rounded(local.y);
  }
  json.close(']').close('}');
}

void append_columns(ViewJson& json, const RecordedAnalysis& analysis) {
  json.key("rows").open('{').key("count").count(analysis.rows.size()).key("total").value(analysis.rows.seen());
  json.key("stride").value(analysis.rows.stride()).close('}');
  json.key("columns").open('[');
  for (std::size_t c = 0; c < analysis.columns_kept && c < analysis.result.columns.size(); ++c) {
    const ColumnInfo& column = analysis.result.columns[c];
    json.open('{').key("name").text(column.name).key("unit").text(si_unit(column.unit)).key("values");
    PackedNumbers packed;
    for (std::size_t k = 0; k < analysis.rows.size(); ++k) packed.add_double(analysis.rows[k][c]);
    json.packed("float64", packed).close('}');
  }
  json.close(']');
}

void append_analysis(ViewJson& json, const RecordedAnalysis& analysis, std::size_t drawing) {
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
  for (const NamedField& field : analysis.result.fields)
    append_field(json.key(field.name).text_of_value(), field.value);
  json.close('}').key("drawing").count(drawing);
  append_columns(json, analysis);
  append_poses(json.key("poses"), analysis);
  json.key("shapes").open('[');
  for (const std::vector<double>& shape : analysis.shapes) {
    PackedNumbers packed;
    for (const double value : shape) packed.add_float(value);
    json.packed("float32", packed);
  }
  json.close(']').close('}');
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
  }
  if (static_cast<std::size_t>(record.header.analyses) > record.analyses.size())
    notes.push_back(fmt::format("{} of {} analyses were run: the one before did not leave a state to go on from",
                                record.analyses.size(), record.header.analyses));
  return notes;
}

std::string view_document(const RunRecord& record) {
  const Drawings drawings(record);
  std::string out;
  ViewJson json(out);
  json.open('{').key("catena_view").value(std::int64_t{view_version}).key("version").text(record.header.version);
  json.key("scene").text(record.header.scene).key("description").text(record.header.description);
  json.key("gravity").open('[').value(record.header.gravity[0]).value(record.header.gravity[1]).close(']');
  json.key("parameters").open('{');
  for (const auto& [name, value] : record.header.parameters) json.key(name).value(value);
  json.close('}');
  append_names(json, *record.model);
  append_points(json, *record.model);
  drawings.append_to(json);
  json.key("analyses").open('[');
  for (const RecordedAnalysis& analysis : record.analyses)
    append_analysis(json, analysis, drawings.number(analysis.model));
  json.close(']').key("notes").open('[');
  for (const std::string& note : view_notes(record)) json.text(note);
  json.close(']').close('}');
  return out;
}

}  // namespace catena
