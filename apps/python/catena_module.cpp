// The Python module _catena: scenes, their runs and results. The package apps/python/catena adds what Python says more
// easily.
//
// Rows stay where the run put them: columns are NumPy views of that memory, alive as long as anyone holds one. The
// interpreter is free while a scene runs; it is asked for signals now and then, so that Ctrl-C ends a run, with the
// rows so far.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <atomic>
#include <chrono>
#include <future>
#include <memory>
#include <stdexcept>

#include "catena/base/status.hpp"
#include "catena/results/measure_gradient.hpp"
#include "catena/results/result_storage.hpp"
#include "catena/results/status_word.hpp"
#include "catena/scene/running/scene_runner.hpp"

namespace py = pybind11;

namespace catena {
namespace {

// To people that is at once; asking costs nothing beside a run.
constexpr std::chrono::milliseconds between_signals{50};

/// An error in the text of a scene, or a file that cannot be read.
struct SceneError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Keeps the rows of every analysis.
class StoringSink final : public ResultSink {
 public:
  void begin_run(const RunHeader& header) override { parameters = header.parameters; }
  RowSink& begin_analysis(std::string_view) override { return *rows.emplace_back(std::make_shared<ResultStorage>()); }
  void end_analysis(const AnalysisResult&) override {}
  void end_run() override {}

  std::vector<std::pair<std::string, double>> parameters;
  std::vector<std::shared_ptr<ResultStorage>> rows;
};

/// One analysis and its rows.
struct Analysis {
  AnalysisResult result;
  std::shared_ptr<const ResultStorage> rows;

  /// A view of a column; the words of one that holds a status.
  py::object column(const std::string& name) const {
    const std::optional<std::size_t> found = rows->find(name);
    if (!found) throw py::key_error("there is no column \"" + name + "\" in " + result.type);
    if (rows->columns()[*found].is_status) return words(*found);
    return view({rows->rows()}, {rows->columns().size() * sizeof(double)}, *found);
  }
  /// All rows, a line each.
  py::array table() const {
    const std::size_t columns = rows->columns().size();
    return view({rows->rows(), columns}, {columns * sizeof(double), sizeof(double)}, 0);
  }
  /// Of the rows from their value number `first` on; it keeps them alive.
  py::array view(const std::vector<std::size_t>& shape, const std::vector<std::size_t>& strides,
                 std::size_t first) const {
    auto owner = std::make_unique<std::shared_ptr<const ResultStorage>>(rows);
    const py::capsule keep(owner.get(), [](void* p) { delete static_cast<std::shared_ptr<const ResultStorage>*>(p); });
    static_cast<void>(owner.release());
    const double* start = rows->rows() > 0 ? rows->values().data() + first : nullptr;
    py::array_t<double> made(shape, strides, start, keep);
    made.attr("setflags")(py::arg("write") = false);
    return made;
  }
  py::object words(std::size_t column) const {
    py::list list;
    for (std::size_t row = 0; row < rows->rows(); ++row) list.append(std::string(status_word(rows->at(row, column))));
    return py::module_::import("numpy").attr("array")(list);
  }
  std::vector<std::string> columns() const {
    std::vector<std::string> names;
    for (const ColumnInfo& column : rows->columns()) names.push_back(column.name);
    return names;
  }
  py::dict units() const {
    py::dict units;
    for (const ColumnInfo& column : rows->columns()) units[py::str(column.name)] = std::string(column.unit_text());
    return units;
  }
};

py::object to_python(const FieldScalar& value) {
  return std::visit([](const auto& v) { return py::cast(v); }, value);
}
py::dict to_python(const FieldRecord& record) {
  py::dict object;
  for (const auto& [name, value] : record) object[py::str(name)] = to_python(value);
  return object;
}
py::object to_python(const FieldValue& value) {
  return std::visit(
      [](const auto& v) -> py::object {
        using T = std::decay_t<decltype(v)>;
        if constexpr (std::is_same_v<T, FieldRecord>) {
          return to_python(v);
        } else if constexpr (std::is_same_v<T, std::vector<FieldRecord>>) {
          py::list list;
          for (const FieldRecord& record : v) list.append(to_python(record));
          return list;
        } else {
          return py::cast(v);
        }
      },
      value);
}

py::dict measures_of(const AnalysisResult& result) {
  py::dict measures;
  for (const MeasureResult& measure : result.measures) {
    py::dict one;
    one["value"] = measure.value ? py::cast(*measure.value) : py::none();
    one["unit"] = measure.unit;
    if (measure.t) one["t"] = *measure.t;
    if (!measure.trouble.empty()) one["trouble"] = measure.trouble;
    if (!result.gradient_parameters.empty()) {
      py::dict gradient;
      for (const auto& [parameter, derivative] : named_gradient(result, measure))
        gradient[py::str(parameter)] = derivative;
      one["gradient"] = gradient;
    }
    measures[py::str(measure.name)] = one;
  }
  return measures;
}

py::dict fields_of(const AnalysisResult& result) {
  py::dict fields;
  for (const NamedField& field : result.fields) fields[py::str(field.name)] = to_python(field.value);
  return fields;
}

/// What a run gave.
struct Outcome {
  std::vector<Analysis> analyses;
  std::vector<std::pair<std::string, double>> parameters;
};

Outcome run(const std::string& path, const std::optional<std::string>& text,
            const std::vector<std::pair<std::string, std::string>>& set, const std::vector<std::string>& outputs,
            const std::string& only, int threads) {
  StoringSink sink;
  SceneOutcome outcome;
  std::atomic<bool> cancel{false};
  bool interrupted = false;
  RunOptions options;
  options.text = text;
  options.set = set;
  options.outputs = outputs;
  options.only = only;
  options.threads = threads;
  options.cancel = &cancel;
  {
    const py::gil_scoped_release free;
    // Signals are for the thread that Python called from: the scene runs beside it.
    std::future<SceneOutcome> running = std::async(std::launch::async, [&] { return run_scene(path, options, sink); });
    while (running.wait_for(between_signals) == std::future_status::timeout) {
      const py::gil_scoped_acquire held;
      if (interrupted || PyErr_CheckSignals() == 0) continue;
      interrupted = true;
      cancel = true;
    }
    outcome = running.get();
  }
  if (interrupted) throw py::error_already_set();
  if (outcome.exit_code >= 2) throw SceneError(outcome.error_text);
  Outcome result;
  result.parameters = std::move(sink.parameters);
  for (std::size_t k = 0; k < outcome.analyses.size(); ++k)
    result.analyses.push_back({std::move(outcome.analyses[k]), sink.rows[k]});
  return result;
}

}  // namespace
}  // namespace catena

PYBIND11_MODULE(_catena, module) {
  using namespace catena;
  module.doc() = "Planar multibody systems: runs scenes. Use the package catena.";
  py::register_exception<SceneError>(module, "SceneError", PyExc_ValueError);

  py::class_<Analysis>(module, "Analysis", "The results of one analysis. Numbers are in SI and radians.")
      .def("__getitem__", &Analysis::column, py::arg("column"),
           "The values of a column, a read-only view without a copy. KeyError if there is none of this name.")
      .def("table", &Analysis::table, "All rows, an array of shape (rows, columns), without a copy.")
      .def("__len__", [](const Analysis& a) { return a.rows->rows(); })
      .def_property_readonly("columns", &Analysis::columns, "Names of the columns.")
      .def_property_readonly("units", &Analysis::units, "Units of the columns, by name.")
      .def_property_readonly("type", [](const Analysis& a) { return a.result.type; })
      .def_property_readonly(
          "status", [](const Analysis& a) { return std::string(to_string(a.result.report.status)); },
          "\"ok\", or why it is not.")
      .def_property_readonly("ok", [](const Analysis& a) { return a.result.report.ok(); })
      .def_property_readonly("message", [](const Analysis& a) { return a.result.report.message; })
      .def_property_readonly("warnings", [](const Analysis& a) { return a.result.report.warnings; })
      .def_property_readonly(
          "measures", [](const Analysis& a) { return measures_of(a.result); },
          "By name: value (None where there is none), unit, t, gradient.")
      .def_property_readonly(
          "fields", [](const Analysis& a) { return fields_of(a.result); }, "All other named results.")
      .def("__repr__", [](const Analysis& a) {
        return "<" + a.result.type + ": " + std::string(to_string(a.result.report.status)) + ", " +
               std::to_string(a.rows->rows()) + " rows>";
      });

  py::class_<Outcome>(module, "Outcome")
      .def_readonly("analyses", &Outcome::analyses)
      .def_readonly("parameters", &Outcome::parameters);

  module.def("run", &run, py::arg("path"), py::arg("text"), py::arg("set"), py::arg("outputs"), py::arg("only"),
             py::arg("threads"));
}
