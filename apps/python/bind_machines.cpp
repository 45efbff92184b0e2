// Kinematics, Dynamics and Equilibrium as objects that Python steps.
#include "dynamics_machine.hpp"
#include "equilibrium_machine.hpp"
#include "kinematics_machine.hpp"

namespace catena::python {
namespace {

using Text = std::optional<std::string>;
using Names = std::vector<std::string>;

template <class Word, std::size_t N>
Word word(const char* key, const std::string& given, const std::pair<const char*, Word> (&words)[N]) {
  std::string known;
  for (const auto& [name, value] : words) {
    if (given == name) return value;
    known += (known.empty() ? "\"" : ", \"") + std::string(name) + "\"";
  }
  throw std::invalid_argument(std::string(key) + " is one of " + known + ", not \"" + given + "\"");
}

/// One line of three numbers a body.
py::array by_body(const Machine::Numbers& numbers) {
  constexpr std::size_t size = sizeof(double);
  return view_of(numbers, numbers->data(), {numbers->size() / 3, 3}, {3 * size, size});
}

// After set() as well: the place is kept, what follows from it is not.
constexpr const char* no_row =
    "there is no row here yet: step first (move_to, advance_to or solve_at), after set() again";

py::array row_of(const Machine& machine) {
  if (!machine.row()) throw std::runtime_error(no_row);
  return view_of(machine.row(), machine.row()->data(), {machine.row()->size()}, {sizeof(double)});
}

double value_of_column(const Machine& machine, const std::string& name) {
  if (!machine.row()) throw std::runtime_error(no_row);
  for (std::size_t c = 0; c < machine.columns().size(); ++c) {
    if (machine.columns()[c].name == name) return (*machine.row())[c];
  }
  throw py::key_error("there is no column \"" + name + "\" here; `columns` names those there are");
}

py::tuple frame_at(const Machine& machine, int body) {
  const Frame<double> frame = machine.frame(body);
  return py::make_tuple(frame.x, frame.y, frame.phi);
}

py::dict report_of(const EquilibriumMachine& machine) {
  const AtWork work(machine.busy());
  const EquilibriumReport& report = machine.report();
  py::dict out;
  out["energy"] = report.energy;
  out["certified"] = report.certified;
  out["stable"] = report.stable;
  out["neutral"] = report.neutral;
  out["negative_modes"] = report.negative_modes;
  out["free_motions"] = report.free_motions;
  out["softest_stiffness"] = report.softest_stiffness;
  out["softest_mode"] = report.softest_mode;
  out["residual"] = report.residual;
  out["solver"] = report.solver;
  out["iterations"] = report.iterations;
  out["active"] = report.active;
  return out;
}

void bind_machine(py::module_& module) {
  py::class_<Machine>(module, "Machine", "What all analyses have that are stepped. Numbers are in SI and radians.")
      .def("follow", &Machine::follow, py::arg("times"), "Rows at these instants, one after the other, as an Analysis.")
      .def("set", &Machine::set, py::arg("values"),
           "Changes parameters, from the present state on. Where the scene allows no such values, or the mechanism "
           "cannot be assembled with them near where it is, nothing is changed.")
      .def_property_readonly("parameters", &Machine::parameters, "Names and present values of all parameters.")
      .def_property_readonly("time", &Machine::time, "The present instant, s.")
      .def_property_readonly(
          "q", [](const Machine& m) { return by_body(m.q()); },
          "[x, y, angle] of the centroid of every body, m and rad: an array without a copy, which follows the motion.")
      .def_property_readonly(
          "bodies",
          [](const Machine& m) {
            Names names;
            for (int b = 0; b < static_cast<int>(m.model().bodies.size()); ++b)
              names.emplace_back(m.model().body_name(b));
            return names;
          },
          "Names of the bodies, in the order of q.")
      .def("frame", &frame_at, py::arg("body"),
           "x, y and angle of the frame in which the points of a body are given, by its number in `bodies` (-1: the "
           "ground). IndexError for a number that no body has.")
      .def(
          "frame", [](const Machine& m, const std::string& name) { return frame_at(m, m.body(name)); }, py::arg("body"),
          "The same by the body's name. KeyError for a name that no body has.")
      .def_property_readonly("row", &row_of,
                             "Values of the columns after the last step: an array without a copy, which follows the "
                             "motion.")
      .def("__getitem__", &value_of_column, py::arg("column"), "The value of a column after the last step.")
      .def_property_readonly(
          "columns",
          [](const Machine& m) {
            Names names;
            for (const ColumnInfo& column : m.columns()) names.push_back(column.name);
            return names;
          },
          "Names of the columns; empty before the first step.")
      .def_property_readonly("notes", &Machine::notes, "Why columns that were asked for are left out.")
      .def_property_readonly("warnings", &Machine::warnings, "Of the last step.");
}

py::array velocities_of_machine(const Machine& machine) {
  if (!machine.qd()) throw std::runtime_error("velocities are not known yet: step first");
  return by_body(machine.qd());
}
constexpr const char* about_qd = "[vx, vy, omega] of the centroid of every body, m/s and rad/s; follows the motion.";

}  // namespace

void bind_machines(py::module_& module) {
  bind_machine(module);
  py::class_<KinematicsMachine, Machine>(module, "Kinematics", "A driven mechanism that is moved through time.")
      .def(py::init([](const std::string& path, const Text& text, const Texts& set, const Names& outputs,
                       double tolerance, bool inverse_dynamics, int branch) {
             return std::make_unique<KinematicsMachine>(
                 OpenScene(path, text, set, outputs),
                 KinematicsOptions{.tolerance = tolerance, .inverse_dynamics = inverse_dynamics, .branch = branch});
           }),
           py::arg("path"), py::arg("text"), py::arg("set"), py::arg("outputs"), py::arg("tolerance"),
           py::arg("inverse_dynamics"), py::arg("branch"))
      .def("move_to", &Machine::step_to, py::arg("t"), "Follows the motion to an instant, forwards or backwards.")
      .def("drive", &KinematicsMachine::drive, py::arg("driver"), py::arg("value"), py::arg("rate") = 0.0,
           "Takes a driver to a value while time stands still, along the branch that the mechanism is on; from then on "
           "its value changes at this rate.")
      .def_property_readonly("qd", &velocities_of_machine, about_qd)
      .def_property_readonly(
          "qdd", [](KinematicsMachine& m) { return by_body(m.accelerations()); },
          "[ax, ay, alpha] of the centroid of every body, m/s^2 and rad/s^2, computed when asked for.");
  py::class_<DynamicsMachine, Machine>(module, "Dynamics", "A motion that follows from forces.")
      .def(py::init([](const std::string& path, const Text& text, const Texts& set, const Names& outputs,
                       const std::string& method, double tolerance, double step) {
             DynamicsOptions options{.tolerance = tolerance, .step = step};
             std::pair<const char*, IntegrationMethod> words[integration_methods.size()];
             for (std::size_t k = 0; k < integration_methods.size(); ++k)
               words[k] = {integration_methods[k].data(), static_cast<IntegrationMethod>(k)};
             options.method = word("method", method, words);
             return std::make_unique<DynamicsMachine>(OpenScene(path, text, set, outputs), options);
           }),
           py::arg("path"), py::arg("text"), py::arg("set"), py::arg("outputs"), py::arg("method"),
           py::arg("tolerance"), py::arg("step"))
      .def("advance_to", &Machine::step_to, py::arg("t"), "Integrates to an instant, which is not before the present.")
      .def_property_readonly(
          "method",
          [](const DynamicsMachine& m) {
            const AtWork work(m.busy());
            return std::string(m.method());
          },
          "The method of integration.")
      .def_property_readonly("qd", &velocities_of_machine, about_qd);
  py::class_<EquilibriumMachine, Machine>(module, "Equilibrium", "A mechanism at rest under its forces.")
      .def(py::init([](const std::string& path, const Text& text, const Texts& set, const Names& outputs,
                       const std::string& solver, double tolerance, const std::string& accept) {
             constexpr std::pair<const char*, StaticSolver> solvers[] = {{"auto", StaticSolver::automatic},
                                                                         {"newton", StaticSolver::newton},
                                                                         {"ipopt", StaticSolver::ipopt},
                                                                         {"nlopt", StaticSolver::nlopt}};
             constexpr std::pair<const char*, Accept> accepts[] = {{"stable", Accept::stable},
                                                                   {"stationary", Accept::stationary}};
             return std::make_unique<EquilibriumMachine>(OpenScene(path, text, set, outputs),
                                                         EquilibriumOptions{.solver = word("solver", solver, solvers),
                                                                            .tolerance = tolerance,
                                                                            .accept = word("accept", accept, accepts)});
           }),
           py::arg("path"), py::arg("text"), py::arg("set"), py::arg("outputs"), py::arg("solver"),
           py::arg("tolerance"), py::arg("accept"))
      .def("solve_at", &Machine::step_to, py::arg("t"),
           "The equilibrium with functions of time as they are at this instant, from where it is now.")
      .def_property_readonly("report", &report_of, "Energy, stability and accuracy of the last equilibrium.");
}

}  // namespace catena::python
