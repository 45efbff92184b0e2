// The Python module _catena: what the package apps/python/catena is made on.
#include "bindings.hpp"

namespace catena::python {
namespace {

py::list to_python(const std::vector<Diagnostic>& diagnostics) {
  py::list list;
  for (const Diagnostic& diagnostic : diagnostics) {
    py::dict one;
    one["file"] = diagnostic.file;
    one["line"] = diagnostic.line;
    one["column"] = diagnostic.column;
    one["message"] = diagnostic.message;
    list.append(one);
  }
  return list;
}

/// The exceptions, with what they carry as attributes.
void bind_errors(py::module_& module) {
  const py::object scene_error = py::exception<SceneError>(module, "SceneError", PyExc_ValueError);
  scene_error.attr("__doc__") =
      "An error in a scene, in parameters, or a file that cannot be read; `diagnostics` has file, line, column and "
      "message of each.";
  const py::object step_error = py::exception<StepError>(module, "AnalysisError", PyExc_RuntimeError);
  step_error.attr("__doc__") = "What is stepped cannot go where it should; `status` says why in one word.";
  // They are kept by the module, which is never unloaded.
  static PyObject *const scene_type = scene_error.ptr(), *const step_type = step_error.ptr();
  py::register_exception_translator([](std::exception_ptr thrown) {
    const auto raise = [](PyObject* type, const char* text, const char* name, const py::object& value) {
      const py::object error = py::reinterpret_borrow<py::object>(type)(text);
      error.attr(name) = value;
      PyErr_SetObject(type, error.ptr());
    };
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const SceneError& error) {
      raise(scene_type, error.what(), "diagnostics", to_python(error.diagnostics));
    } catch (const StepError& error) {
      raise(step_type, error.what(), "status", py::str(std::string(to_string(error.status))));
    }
  });
}

}  // namespace
}  // namespace catena::python

PYBIND11_MODULE(_catena, module) {
  using namespace catena::python;
  module.doc() = "Planar multibody systems: runs scenes. Use the package catena.";
  bind_errors(module);
  bind_runs(module);
  bind_machines(module);
  bind_films(module);
  module.def("schema", &catena::schema_json, "The JSON Schema of scenes.");
  module.def("explain", &catena::explain, py::arg("name"), "What `catena explain NAME` prints; None if unknown.");
  module.def("explained_names", &catena::explained_names, "All names that explain() knows.");
}
