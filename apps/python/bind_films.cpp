// Pictures of mechanisms for notebooks and matplotlib: what `catena draw` draws, as SVG or as lines in metres.
#include <cmath>
#include <numbers>
#include <optional>

#include "bindings.hpp"
#include "catena/scene/viewing/record_figure.hpp"

namespace catena::python {
namespace {

struct FilmLine {
  std::vector<Vec2<double>> points;  // on the page; a closed line ends where it began
  Paint paint;
};

/// Keeps what is drawn.
class FilmCanvas final : public VectorCanvas {
 public:
  explicit FilmCanvas(std::vector<FilmLine>& picture) : picture_(picture) {}

  void path(std::span<const Vec2<double>> points, bool closed, const Paint& paint) override {
    FilmLine& line = picture_.emplace_back(FilmLine{{points.begin(), points.end()}, paint});
    if (closed && !points.empty()) line.points.push_back(points.front());
  }
  // As many corners as make the line deviate by less than a thousandth of the radius.
  void circle(const Vec2<double>& centre, double radius, const Paint& paint) override {
    constexpr int corners = 72;
    FilmLine& line = picture_.emplace_back(FilmLine{{}, paint});
    for (int k = 0; k <= corners; ++k) {
      const double angle = 2 * std::numbers::pi * (k % corners) / corners;
      line.points.push_back(centre + radius * Vec2<double>{std::cos(angle), std::sin(angle)});
    }
  }
  void text(const Vec2<double>&, std::string_view, const TextStyle&) override {}  // mechanisms have none
  void clip(const Vec2<double>&, const Vec2<double>&) override {}
  void unclip() override {}
  std::string finish() override { return {}; }

 private:
  std::vector<FilmLine>& picture_;
};

struct Film {
  DrawnFilm drawn;
  std::vector<std::vector<FilmLine>> pictures;
};

py::tuple to_python(const std::optional<Colour>& colour) {
  if (!colour) return py::make_tuple(0.0, 0.0, 0.0, 0.0);
  return py::make_tuple(colour->red / 255.0, colour->green / 255.0, colour->blue / 255.0, 1.0);
}

/// Corners in metres, colours of edges and areas, widths in points, and whether dashed: a list each.
py::tuple picture_of(const Film& film, std::size_t number) {
  if (number >= film.pictures.size())
    throw py::index_error("there is no picture number " + std::to_string(number) + " among " +
                          std::to_string(film.pictures.size()));
  const FilmScale& page = film.drawn.scale;
  py::list corners, edges, faces, widths, dashed;
  for (const FilmLine& line : film.pictures[number]) {
    py::array_t<double> points({line.points.size(), std::size_t{2}});
    auto p = points.mutable_unchecked<2>();
    for (std::size_t k = 0; k < line.points.size(); ++k) {
      const auto row = static_cast<py::ssize_t>(k);
      p(row, 0) = page.corner.x + line.points[k].x / page.scale;
      p(row, 1) = page.corner.y + (page.height - line.points[k].y) / page.scale;
    }
    corners.append(points);
    edges.append(to_python(line.paint.stroke));
    faces.append(to_python(line.paint.fill));
    widths.append(line.paint.stroke ? line.paint.width : 0.0);
    dashed.append(line.paint.dashed);
  }
  return py::make_tuple(corners, edges, faces, widths, dashed);
}

/// Left, right, lower and upper end of the pages, m.
py::tuple extent_of(const Film& film) {
  const FilmScale& page = film.drawn.scale;
  return py::make_tuple(page.corner.x, page.corner.x + page.width / page.scale, page.corner.y,
                        page.corner.y + page.height / page.scale);
}

/// The run of a scene with the poses of its bodies.
void record(const std::string& path, const std::optional<std::string>& text, const Texts& set, const std::string& only,
            const std::string& verb, RunRecorder& recorder) {
  RunOptions options;
  options.text = text;
  options.set = set;
  options.only = only;
  options.verb = verb;
  options.poses = &recorder;
  run_watched(path, std::move(options), recorder);
}

std::unique_ptr<Film> film_of(const std::string& path, const std::optional<std::string>& text, const Texts& set,
                              const std::string& only, int analysis, int pictures,
                              const std::vector<std::string>& traces, double width) {
  RunRecorder recorder;
  record(path, text, set, only, "", recorder);
  DrawRequest request{.analysis = analysis, .poses = pictures, .traces = traces, .width = width};
  auto film = std::make_unique<Film>();
  const py::gil_scoped_release free;
  // An outer vector that grows would move what canvases hold.
  std::vector<std::unique_ptr<std::vector<FilmLine>>> drawn;
  film->drawn = film_record(recorder.record(), request, [&](double, double) {
    return std::make_unique<FilmCanvas>(*drawn.emplace_back(std::make_unique<std::vector<FilmLine>>()));
  });
  for (const auto& picture : drawn) film->pictures.push_back(std::move(*picture));
  return film;
}

/// A scene with more bodies and elements than this is not drawn for a notebook: the file would be larger than the rest.
constexpr int most_in_sketch = 5000;

/// The assembled mechanism as SVG, empty if it is large, and what the scene is about.
py::dict sketch_of(const std::string& path, const std::optional<std::string>& text, const Texts& set, double width) {
  RunRecorder recorder;
  record(path, text, set, "", "assemble", recorder);
  const RunRecord& run = recorder.record();
  py::dict sketch;
  const bool small = run.header.bodies + run.header.elements <= most_in_sketch;
  sketch["svg"] = small ? draw_record(run, {.width = width}).file : std::string();
  sketch["name"] = run.header.scene;
  sketch["description"] = run.header.description;
  sketch["bodies"] = run.header.bodies;
  sketch["elements"] = run.header.elements;
  sketch["parameters"] = run.header.parameters;
  return sketch;
}

}  // namespace

void bind_films(py::module_& module) {
  py::register_exception<FigureError>(module, "FigureError", PyExc_ValueError).attr("__doc__") =
      "What cannot be drawn, and what there is.";
  py::class_<Film>(module, "Film", "Pictures of a motion, all in one scale.")
      .def("__len__", [](const Film& film) { return film.pictures.size(); })
      .def("picture", &picture_of, py::arg("number"),
           "Corners of its lines (m), colours of edges and of areas, widths (points), and whether dashed.")
      .def_property_readonly("extent", &extent_of, "Left, right, lower and upper end of all pictures, m.")
      .def_property_readonly(
          "times", [](const Film& film) { return film.drawn.t; }, "The instants of the pictures, s.")
      .def_property_readonly("notes", [](const Film& film) { return film.drawn.notes; });
  module.def("film", &film_of, py::arg("path"), py::arg("text"), py::arg("set"), py::arg("only"), py::arg("analysis"),
             py::arg("pictures"), py::arg("traces"), py::arg("width"));
  module.def("sketch", &sketch_of, py::arg("path"), py::arg("text"), py::arg("set"), py::arg("width"));
}

}  // namespace catena::python
