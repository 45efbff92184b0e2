// What the files of the Python module share: its errors, views of rows, a run that Ctrl-C ends.
//
// Rows stay where the run put them: columns are NumPy views of that memory, alive as long as anyone holds one. The
// interpreter is free while anything is computed.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "catena/analysis/run/analysis_report.hpp"
#include "catena/results/analysis_result.hpp"
#include "catena/results/result_storage.hpp"
#include "catena/scene/json/diagnostic.hpp"
#include "catena/scene/running/scene_runner.hpp"

namespace catena::python {

namespace py = pybind11;

/// Names and values in the syntax of scenes.
using Texts = std::vector<std::pair<std::string, std::string>>;

/// An error in the text of a scene, in parameters, or a file that cannot be read.
struct SceneError : std::runtime_error {
  SceneError(const std::string& text, std::vector<Diagnostic> places)
      : std::runtime_error(text), diagnostics(std::move(places)) {}
  std::vector<Diagnostic> diagnostics;  ///< those that have a place in the text
};

/// What is stepped cannot go where it should.
struct StepError : std::runtime_error {
  explicit StepError(const Report& report) : std::runtime_error(report.message), status(report.status) {}
  Status status;
};

/// Asks the interpreter for signals now and then; to people that is at once, and costs nothing beside a run.
class SignalWatch {
 public:
  static constexpr std::chrono::milliseconds between{50};

  /// False from the moment at which a signal wants the work to end.
  bool go_on() {
    const auto now = std::chrono::steady_clock::now();
    if (interrupted_ || now - asked_ < between) return !interrupted_;
    asked_ = now;
    return ask();
  }
  /// The same at once. The interpreter must not be held.
  bool ask() {
    const py::gil_scoped_acquire held;
    interrupted_ = interrupted_ || PyErr_CheckSignals() != 0;
    return !interrupted_;
  }
  bool interrupted() const { return interrupted_; }

 private:
  std::chrono::steady_clock::time_point asked_ = std::chrono::steady_clock::now();
  bool interrupted_ = false;
};

/// Runs a scene beside the thread that Python called from. Throws SceneError, or what Ctrl-C raises.
SceneOutcome run_watched(const std::string& path, RunOptions options, ResultSink& sink);

/// A read-only array of some of the owner's numbers, which keeps the owner alive.
template <class Owner>
py::array view_of(std::shared_ptr<Owner> owner, const double* start, const std::vector<std::size_t>& shape,
                  const std::vector<std::size_t>& strides) {
  auto held = std::make_unique<std::shared_ptr<Owner>>(std::move(owner));
  const py::capsule keep(held.get(), [](void* p) { delete static_cast<std::shared_ptr<Owner>*>(p); });
  static_cast<void>(held.release());
  py::array_t<double> made(shape, strides, start, keep);
  made.attr("setflags")(py::arg("write") = false);
  return made;
}

/// One analysis and its rows.
struct Analysis {
  AnalysisResult result;
  std::shared_ptr<const ResultStorage> rows;
};

// What each file adds to the module.
void bind_runs(py::module_& module);
void bind_machines(py::module_& module);
void bind_films(py::module_& module);

}  // namespace catena::python
