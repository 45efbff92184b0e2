// Runs of scenes and their results.
#include <cmath>
#include <future>
#include <optional>

#include "bindings.hpp"
#include "catena/results/measure_gradient.hpp"
#include "catena/results/status_word.hpp"
#include "catena/results/stored_results.hpp"
#include "open_scene.hpp"

namespace catena::python {

// Signals are for the thread that Python called from: the scene runs beside it.
SceneOutcome run_watched(const std::string& path, RunOptions options, ResultSink& sink) {
  std::atomic<bool> cancel{false};
  options.cancel = &cancel;
  SceneOutcome outcome;
  SignalWatch signals;
  {
    const py::gil_scoped_release free;
    std::future<SceneOutcome> running = std::async(std::launch::async, [&] { return run_scene(path, options, sink); });
    while (running.wait_for(SignalWatch::between) == std::future_status::timeout) {
      if (!signals.ask()) cancel = true;
    }
    outcome = running.get();
  }
  if (signals.interrupted()) throw py::error_already_set();
  if (outcome.exit_code >= 2)
    throw SceneError(in_python_words(std::move(outcome.error_text)), std::move(outcome.errors));
  return outcome;
}

namespace {

const double* first_value(const Analysis& analysis) {
  return analysis.rows->rows() > 0 ? analysis.rows->values().data() : nullptr;
}

py::object words(const ResultStorage& rows, std::size_t column) {
  py::list list;
  for (std::size_t row = 0; row < rows.rows(); ++row) list.append(std::string(status_word(rows.at(row, column))));
  return py::module_::import("numpy").attr("array")(list, py::arg("dtype") = "str");
}

/// A view of a column; the words of one that holds a status.
py::object column_of(const Analysis& analysis, const std::string& name) {
  const ResultStorage& rows = *analysis.rows;
  const std::optional<std::size_t> found = rows.find(name);
  if (!found) throw py::key_error("there is no column \"" + name + "\" in " + analysis.result.type);
  if (rows.columns()[*found].is_status) return words(rows, *found);
  const double* const start = first_value(analysis);
  return view_of(analysis.rows, start ? start + *found : nullptr, {rows.rows()},
                 {rows.columns().size() * sizeof(double)});
}

/// All rows, a line each.
py::array table_of(const Analysis& analysis) {
  const std::size_t columns = analysis.rows->columns().size();
  return view_of(analysis.rows, first_value(analysis), {analysis.rows->rows(), columns},
                 {columns * sizeof(double), sizeof(double)});
}

std::vector<std::string> columns_of(const Analysis& analysis) {
  std::vector<std::string> names;
  for (const ColumnInfo& column : analysis.rows->columns()) names.push_back(column.name);
  return names;
}

py::dict units_of(const Analysis& analysis) {
  py::dict units;
  for (const ColumnInfo& column : analysis.rows->columns())
    units[py::str(column.name)] = std::string(column.unit_text());
  return units;
}

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
        } else if constexpr (std::is_same_v<T, std::shared_ptr<const LongList>>) {
          py::list list;
          v->for_each([&](const FieldRecord& record) {
            list.append(to_python(record));
            return true;
          });
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

py::dict digits_of(const AnalysisResult& result) {
  py::dict digits;
  for (std::size_t k = 0; k < result.digits.size(); ++k) {
    if (std::isfinite(result.digits[k])) digits[py::str(result.columns[k].name)] = result.digits[k];
  }
  return digits;
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

/// Numbers row after row.
using Table = py::array_t<double, py::array::c_style | py::array::forcecast>;

Outcome run(const std::string& path, const std::optional<std::string>& text, const Texts& set,
            const std::vector<std::string>& outputs, const std::string& only, int threads,
            const std::vector<std::string>& names, const std::optional<Table>& designs) {
  StoredResults sink;
  RunOptions options;
  if (designs) options.designs = {names, {designs->data(), static_cast<std::size_t>(designs->size())}};
  options.text = text;
  options.set = set;
  options.outputs = outputs;
  options.only = only;
  options.threads = threads;
  SceneOutcome outcome = run_watched(path, std::move(options), sink);
  Outcome result;
  result.parameters = std::move(sink.parameters);
  for (std::size_t k = 0; k < outcome.analyses.size(); ++k)
    result.analyses.push_back({std::move(outcome.analyses[k]), sink.rows[k]});
  return result;
}

}  // namespace

void bind_runs(py::module_& module) {
  py::class_<Analysis>(module, "Analysis", "The results of one analysis. Numbers are in SI and radians.")
      .def("__getitem__", &column_of, py::arg("column"),
           "The values of a column, a read-only view without a copy. KeyError if there is none of this name.")
      .def("table", &table_of, "All rows, an array of shape (rows, columns), without a copy.")
      .def("__len__", [](const Analysis& a) { return a.rows->rows(); })
      .def_property_readonly("columns", &columns_of, "Names of the columns.")
      .def_property_readonly("units", &units_of, "Units of the columns, by name.")
      .def_property_readonly("type", [](const Analysis& a) { return a.result.type; })
      .def_property_readonly(
          "status", [](const Analysis& a) { return std::string(to_string(a.result.report.status)); },
          "\"ok\", or why it is not.")
      .def_property_readonly("ok", [](const Analysis& a) { return a.result.report.ok(); })
      .def_property_readonly("message", [](const Analysis& a) { return a.result.report.message; })
      .def_property_readonly("warnings", [](const Analysis& a) { return a.result.report.warnings; })
      .def_property_readonly(
          "digits", [](const Analysis& a) { return digits_of(a.result); },
          "How many digits of each column are right, by name; without those of which it is not known.")
      .def_property_readonly(
          "measures", [](const Analysis& a) { return measures_of(a.result); },
          "By name: value (None where there is none), unit, t, gradient.")
      .def_property_readonly(
          "fields", [](const Analysis& a) { return fields_of(a.result); }, "All other named results.");

  py::class_<Outcome>(module, "Outcome", "What a run gave.")
      .def_readonly("analyses", &Outcome::analyses)
      .def_readonly("parameters", &Outcome::parameters);

  module.def("run", &run, py::arg("path"), py::arg("text"), py::arg("set"), py::arg("outputs"), py::arg("only"),
             py::arg("threads"), py::arg("names") = std::vector<std::string>(), py::arg("designs") = py::none());
  module.def("check_names", &check_names, py::arg("path"), py::arg("text"), py::arg("names"));
}

}  // namespace catena::python
