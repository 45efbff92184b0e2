#include "catena/scene/viewing/record_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "catena/drawing/figures/pdf_canvas.hpp"
#include "catena/drawing/figures/svg_canvas.hpp"
#include "catena/drawing/shapes/guide_travel.hpp"
#include "catena/drawing/shapes/pen.hpp"
#include "catena/scene/json/near_miss.hpp"

namespace catena {
namespace {

/// The analysis that is shown: the one asked for, or the last that `fits`; nullptr if none does.
template <class Fits>
const RecordedAnalysis* choose_analysis(const RunRecord& record, int asked, Fits&& fits) {
  const auto count = static_cast<int>(record.analyses.size());
  if (asked < 0 || asked > count) {
    throw FigureError(fmt::format("there is no analysis {}: the scene has {}, numbered from 1", asked, count));
  }
  if (asked > 0) return &record.analyses[static_cast<std::size_t>(asked - 1)];
  for (auto analysis = record.analyses.rbegin(); analysis != record.analyses.rend(); ++analysis) {
    if (fits(*analysis)) return &*analysis;
  }
  return nullptr;
}

bool is_motion(const RecordedAnalysis& analysis) {
  return !analysis.result.columns.empty() && analysis.result.columns.front().name == "t";
}

/// Local coordinates of "body.point" or "body".
std::pair<int, Vec2<double>> find_place(const Model& model, const std::string& name) {
  if (const int body = model.find_body(name); body >= 0)
    return {body, model.bodies[static_cast<std::size_t>(body)].origin};
  const std::size_t dot = name.rfind('.');
  const int body = dot == std::string::npos ? -2 : model.find_body(name.substr(0, dot));
  const Vec2<double>* local = body >= 0 ? model.find_point(body, name.substr(dot + 1)) : nullptr;
  if (local) return {body, *local};
  std::vector<std::string> known;
  for (int b = 0; b < static_cast<int>(std::min<std::size_t>(model.bodies.size(), 2000)); ++b) {
    const std::string body_name(model.body_name(b));
    known.push_back(body_name);
    for (int k = model.bodies[static_cast<std::size_t>(b)].first_point; k >= 0;
         k = model.points[static_cast<std::size_t>(k)].next) {
      known.push_back(body_name + "." + std::string(model.point_names[model.points[static_cast<std::size_t>(k)].name]));
    }
  }
  throw FigureError(fmt::format("no body and no point of a body is called \"{}\"{}", name,
                                NearMiss(name).consider_all(known).hint()));
}

FigurePose figure_pose(const RecordedAnalysis& analysis, std::size_t row) {
  const std::span<const double> pose = analysis.poses[row];
  FigurePose figure{.frames = frames_of(analysis.layout, pose)};
  for (std::size_t k = 0; k < analysis.layout.loads.size(); ++k) {
    const std::size_t at = analysis.layout.load_forces() + 2 * k;
    figure.loads.push_back({pose[at], pose[at + 1]});
  }
  return figure;
}

/// The row nearest to an instant; a note where there is none at it.
std::size_t nearest_row(const RecordedAnalysis& analysis, double t, std::vector<std::string>& notes) {
  if (!std::isfinite(t)) throw FigureError(fmt::format("{} is no instant: figures are drawn at a finite time", t));
  std::size_t best = 0;
  const auto time = [&](std::size_t k) { return analysis.poses[k][PoseLayout::time]; };
  for (std::size_t k = 1; k < analysis.poses.size(); ++k) {
    if (std::abs(time(k) - t) < std::abs(time(best) - t)) best = k;
  }
  constexpr double same = 1e-9;  // instants of rows are multiples, asked for as decimals
  if (std::abs(time(best) - t) > same * std::max(1.0, std::abs(t)))
    notes.push_back(fmt::format("no row at t = {:.6g} s: drawn is that at {:.6g} s", t, time(best)));
  return best;
}

std::vector<std::size_t> choose_rows(const RecordedAnalysis& analysis, const DrawRequest& request,
                                     std::vector<std::string>& notes) {
  std::vector<std::size_t> rows;
  for (const double t : request.at) rows.push_back(nearest_row(analysis, t, notes));
  if (!rows.empty()) return rows;
  const std::size_t count = analysis.poses.size();
  if (request.poses <= 1) return {is_motion(analysis) ? 0 : count - 1};
  const auto poses = std::min(static_cast<std::size_t>(request.poses), count);
  for (std::size_t k = 0; k < poses; ++k) rows.push_back(poses == 1 ? 0 : k * (count - 1) / (poses - 1));
  return rows;
}

/// The analysis whose poses are drawn: itself; of an optimisation the last one of the design that is kept last, its
/// best.
const RecordedAnalysis* posed_of(const RecordedAnalysis& analysis) {
  if (analysis.poses.size() > 0) return &analysis;
  if (analysis.result.type != "optimise" || analysis.designs.empty()) return nullptr;
  const std::vector<RecordedAnalysis>& best = analysis.designs.back().analyses;
  const auto posed = std::find_if(best.rbegin(), best.rend(), [](const auto& a) { return a.poses.size() > 0; });
  return posed == best.rend() ? nullptr : &*posed;
}

/// What is drawn of which model, and when.
struct ChosenFigure {
  Drawing drawing;
  MechanismFigure figure;
  std::vector<double> t{};  // of the poses
  std::vector<std::string> notes{};
};

ChosenFigure choose_figure(const RunRecord& record, const DrawRequest& request) {
  const RecordedAnalysis* asked =
      choose_analysis(record, request.analysis, [](const RecordedAnalysis& a) { return posed_of(a) != nullptr; });
  const RecordedAnalysis* analysis = asked ? posed_of(*asked) : nullptr;
  const Model& model = analysis ? *analysis->model : *record.model;
  ChosenFigure chosen{.drawing = draw_model(model), .figure = {.width = request.width}};
  if (analysis) {
    // Guides reach as far as the whole motion goes, so that figures of its instants fit each other and the page.
    for (std::size_t k = 0; k < analysis->poses.size() && !chosen.drawing.guides.empty(); ++k)
      observe_guides(chosen.drawing, frames_of(analysis->layout, analysis->poses[k]));
    if (analysis != asked)
      chosen.notes.push_back(
          fmt::format("drawn is the design \"{}\" of {}", asked->designs.back().label.name, asked->result.type));
    for (const std::size_t row : choose_rows(*analysis, request, chosen.notes)) {
      chosen.figure.poses.push_back(figure_pose(*analysis, row));
      chosen.t.push_back(analysis->poses[row][PoseLayout::time]);
    }
  } else {
    chosen.figure.poses.push_back({given_poses(model)});
    chosen.t.push_back(std::numeric_limits<double>::quiet_NaN());
    chosen.notes.push_back("no analysis gave a pose: drawn is the given configuration, not assembled");
  }
  for (const std::string& trace : request.traces) {
    const auto [body, local] = find_place(model, trace);
    std::vector<Vec2<double>>& path = chosen.figure.traces.emplace_back();
    for (std::size_t k = 0; analysis && k < analysis->poses.size(); ++k) {
      const auto q = analysis->poses[k].subspan(PoseLayout::frames + 3 * static_cast<std::size_t>(body), 3);
      path.push_back(make_frame(q[0], q[1], q[2]).point(local));
    }
  }
  return chosen;
}

}  // namespace

CanvasMaker canvas_maker(FigureFormat format, std::string title) {
  return [format, title = std::move(title)](double width, double height) -> std::unique_ptr<VectorCanvas> {
    if (format == FigureFormat::pdf) return std::make_unique<PdfCanvas>(width, height, title);
    return std::make_unique<SvgCanvas>(width, height, title);
  };
}

DrawnFigure draw_record(const RunRecord& record, const DrawRequest& request) {
  ChosenFigure chosen = choose_figure(record, request);
  return {draw_mechanism(std::move(chosen.drawing), chosen.figure, canvas_maker(request.format, record.header.scene)),
          std::move(chosen.notes)};
}

DrawnFilm film_record(const RunRecord& record, const DrawRequest& request, const CanvasMaker& canvas) {
  ChosenFigure chosen = choose_figure(record, request);
  return {draw_film(std::move(chosen.drawing), chosen.figure, canvas), std::move(chosen.t), std::move(chosen.notes)};
}

namespace {

std::optional<std::size_t> find_column(const RecordedAnalysis& analysis, const std::string& name) {
  for (std::size_t c = 0; c < analysis.columns_kept; ++c) {
    if (analysis.result.columns[c].name == name) return c;
  }
  return {};
}

/// Its values have a place along an axis.
bool has_numbers(const RecordedAnalysis& analysis, std::size_t column) {
  return !analysis.result.columns[column].is_status;
}

std::size_t required_column(const RecordedAnalysis& analysis, const std::string& name) {
  if (const auto column = find_column(analysis, name)) {
    if (has_numbers(analysis, *column)) return *column;
    throw FigureError(
        fmt::format("column \"{}\" of {} holds words, which have no place in a plot", name, analysis.result.type));
  }
  NearMiss near(name);
  for (std::size_t c = 0; c < analysis.columns_kept; ++c) {
    if (has_numbers(analysis, c)) near.consider(analysis.result.columns[c].name);
  }
  throw FigureError(fmt::format("{} has no column \"{}\"{}", analysis.result.type, name, near.hint()));
}

std::vector<double> values_of(const RecordedAnalysis& analysis, std::size_t column) {
  std::vector<double> values;
  for (std::size_t k = 0; k < analysis.rows.size(); ++k) values.push_back(analysis.rows[k][column]);
  return values;
}

}  // namespace

Plot plot_record(const RunRecord& record, const PlotRequest& request) {
  const RecordedAnalysis* analysis = choose_analysis(record, request.analysis, [&](const RecordedAnalysis& a) {
    const auto has = [&](const std::string& name) { return name.empty() || find_column(a, name); };
    return a.rows.size() > 0 && has(request.x) && std::all_of(request.y.begin(), request.y.end(), has);
  });
  // Where none has them all, the last with rows says what is missing.
  if (!analysis) analysis = choose_analysis(record, 0, [](const RecordedAnalysis& a) { return a.rows.size() > 0; });
  if (!analysis || analysis->rows.size() == 0) throw FigureError("no analysis of the scene has rows to plot");
  const std::size_t x = request.x.empty() ? 0 : required_column(*analysis, request.x);
  const auto unit = [&](std::size_t column) {
    const std::string_view name = analysis->result.columns[column].unit_text();
    return std::string(name == "1" ? "" : name);
  };
  Plot plot{.title = record.header.scene + ": " + analysis->result.type,
            .x_name = analysis->result.columns[x].name,
            .x_unit = unit(x),
            .x = values_of(*analysis, x),
            .panels = {},
            .log_x = request.log_x,
            .log_y = request.log_y};
  std::vector<std::size_t> columns;
  for (const std::string& name : request.y) columns.push_back(required_column(*analysis, name));
  for (std::size_t c = 0; request.y.empty() && c < analysis->columns_kept; ++c) {
    if (c != x && has_numbers(*analysis, c)) columns.push_back(c);
  }
  if (columns.empty()) throw FigureError(analysis->result.type + " has no column to plot over " + plot.x_name);
  for (const std::size_t column : columns) {
    const auto same = [&](const PlotPanel& panel) { return panel.unit == unit(column); };
    auto panel = std::find_if(plot.panels.begin(), plot.panels.end(), same);
    if (panel == plot.panels.end()) panel = plot.panels.insert(panel, {.unit = unit(column), .lines = {}});
    panel->lines.push_back({analysis->result.columns[column].name, values_of(*analysis, column)});
  }
  return plot;
}

}  // namespace catena
