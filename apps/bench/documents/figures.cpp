#include "documents/figures.hpp"

#include <fmt/format.h>

#include <cmath>
#include <memory>

#include "catena/drawing/figures/plot.hpp"
#include "catena/drawing/figures/svg_canvas.hpp"

namespace bench {

using namespace catena;

namespace {

constexpr double width = 430, height = 230;  // points

/// Letters and digits, others as one low line.
std::string file_name(const std::string& text) {
  std::string name;
  for (const char c : text) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    if (plain) {
      name += static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
    } else if (!name.empty() && name.back() != '_') {
      name += '_';
    }
  }
  while (name.ends_with('_')) name.pop_back();
  return name;
}

class FigureMaker {
 public:
  FigureMaker(std::string name, std::string title, std::string x, std::string x_unit, std::string y, std::string y_unit)
      : name_(std::move(name)), y_name_(std::move(y)) {
    plot_.title = std::move(title);
    plot_.x_name = std::move(x);
    plot_.x_unit = std::move(x_unit);
    plot_.log_x = plot_.log_y = true;
    plot_.panels.push_back({.unit = std::move(y_unit), .lines = {}});
  }
  /// Only what a logarithmic axis can show; the line that has it now.
  PlotLine* add(const std::string& line, double x, double y) {
    if (!(x > 0) || !(y > 0)) return nullptr;
    std::vector<PlotLine>& lines = plot_.panels.front().lines;
    std::size_t k = 0;
    while (k < lines.size() && lines[k].name != line) ++k;
    if (k == lines.size()) lines.push_back({.name = line, .y = {}, .x = {}, .marks = true});
    lines[k].x.push_back(x);
    lines[k].y.push_back(y);
    return &lines[k];
  }
  /// A dot that no line leads to.
  void add_dot(const std::string& line, double x, double y) {
    PlotLine* const dots = add(line, x, y);
    if (!dots) return;
    dots->x.push_back(x);
    dots->y.push_back(not_measured);  // a gap
  }
  void rename(const std::string& line, const std::string& name) {
    for (PlotLine& l : plot_.panels.front().lines) {
      if (l.name == line) l.name = name;
    }
  }
  void append_to(std::vector<Figure>& figures) {
    if (plot_.panels.front().lines.empty()) return;
    plot_.panels.front().name = y_name_;
    const auto canvas = [this](double w, double h) -> std::unique_ptr<VectorCanvas> {
      return std::make_unique<SvgCanvas>(w, h, plot_.title);
    };
    figures.push_back({name_, plot_.title, draw_plot(plot_, width, height, canvas)});
  }

 private:
  std::string name_, y_name_;
  Plot plot_;
};

std::string line_name(const Row& row) { return row.engine == "catena" ? row.method : row.engine + " " + row.method; }

/// Right answers alone: a wrong one has no place on a curve of error over time.
bool shown(const Row& row) { return row.failure.empty(); }

void work_precision(const Document& document, std::vector<Figure>& figures) {
  std::vector<std::pair<std::string, std::string>> problems;  // with their suites
  for (const Row& row : document.rows) {
    const std::pair of(row.suite, row.problem);
    if ((row.suite == "dynamics" || row.suite == "contact") &&
        std::find(problems.begin(), problems.end(), of) == problems.end())
      problems.push_back(of);
  }
  for (const auto& [suite, problem] : problems) {
    const auto is_of = [&suite = suite, &problem = problem](const Row& row) {
      return row.suite == suite && row.problem == problem;
    };
    const auto first = std::find_if(document.rows.begin(), document.rows.end(),
                                    [&](const Row& r) { return is_of(r) && !r.error_of.empty(); });
    FigureMaker figure(suite + "_" + file_name(problem),
                       problem + ": " + (first == document.rows.end() ? "error" : first->error_of), "processor time",
                       "ms", "error", "");
    for (const Row& row : document.rows) {
      if (is_of(row) && shown(row)) figure.add(line_name(row), 1e3 * row.seconds, row.error);
    }
    figure.append_to(figures);
  }
  FigureMaker figure("kinematics", "Driven linkages over 1 s: worst error of positions", "processor time", "ms",
                     "error", "");
  for (const Row& row : document.rows) {
    if (row.suite == "kinematics" && row.method == "positions" && row.problem != "slider-crank" && shown(row))
      figure.add(row.problem, 1e3 * row.seconds, row.error);
  }
  figure.append_to(figures);
}

void growth(const Document& document, std::vector<Figure>& figures) {
  FigureMaker time("scaling_time", "Run time over the number of bodies", "bodies", "", "processor time", "s");
  FigureMaker cost("scaling_cost_a_body", "Cost a body over the number of bodies", "bodies", "", "time a body", "ns");
  FigureMaker memory("scaling_memory", "Memory a body over the number of bodies", "bodies", "", "memory a body",
                     "bytes");
  const auto name = [](const std::string& problem, const std::string& method) { return method + ", " + problem; };
  for (const Row& row : document.rows) {
    if (row.suite != "scaling" || !shown(row)) continue;
    const std::string line = name(row.problem, row.method);
    time.add(line, row.bodies, row.seconds);
    cost.add(line, row.bodies, 1e9 * row.seconds / row.bodies);
    memory.add(line, row.bodies, row.bytes_per_body);
  }
  for (const Growth& g : growth_of(document.rows)) {
    const std::string line = name(g.problem, g.method);
    time.rename(line, fmt::format("{}: {:.2f}", line, g.exponent));
  }
  time.append_to(figures);
  cost.append_to(figures);
  memory.append_to(figures);
}

double count_of(const Row& row, std::string_view name) {
  for (const auto& [of, value] : row.counts) {
    if (of == name) return value;
  }
  return not_measured;
}

void claims(const Document& document, std::vector<Figure>& figures) {
  FigureMaker scatter("digits_claimed", "Errors that columns claim over those that they have, relative", "true error",
                      "", "claimed error", "");
  FigureMaker sweep("digits_condition", "Error over the condition number: a slider-crank near its dead point",
                    "condition number", "", "error, relative", "");
  bool any = false;
  for (const Row& row : document.rows) {
    if (row.suite != "digits" || !shown(row)) continue;
    any = true;
    const double claimed = count_of(row, "claimed"), condition = count_of(row, "condition");
    scatter.add_dot(row.problem, row.error, claimed);
    sweep.add(row.method, condition, row.error);
    sweep.add(row.method + ", claimed", condition, claimed);
  }
  if (!any) return;
  for (const double error : {1e-16, 1e-3}) {
    scatter.add("claim = truth", error, error);
    scatter.add("ten times optimistic", error, error / 10);
  }
  scatter.append_to(figures);
  sweep.append_to(figures);
}

}  // namespace

std::vector<Figure> figures_of(const Document& document) {
  std::vector<Figure> figures;
  work_precision(document, figures);
  growth(document, figures);
  claims(document, figures);
  return figures;
}

}  // namespace bench
