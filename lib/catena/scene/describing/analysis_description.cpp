#include "catena/scene/describing/analysis_description.hpp"

#include "catena/analysis/dynamics/dynamics_options.hpp"

namespace catena {
namespace {

using Keys = std::vector<AnalysisKey>;

const AnalysisKey type{"type", KeyKind::word, "which analysis"};
const AnalysisKey outputs{"outputs", KeyKind::columns, "columns of its rows (default: the scene's outputs)"};
const AnalysisKey set{"set", KeyKind::set, "parameters and their values, for this analysis"};
const AnalysisKey from{"from",
                       KeyKind::word,
                       "\"initial\": starts at t = 0 from the given configuration, not where the one before ended",
                       {},
                       {},
                       {"previous", "initial"}};
const AnalysisKey until{"until", KeyKind::number, "last instant, s", UnitKind::time, Domain::positive};
const AnalysisKey every{"every", KeyKind::number, "a row at every multiple of it, s (default: a hundredth of until)",
                        UnitKind::time, Domain::positive};
const AnalysisKey at_times{"at", KeyKind::times, "an instant or a list of instants, in place of until and every, s",
                           UnitKind::time, Domain::any};
const AnalysisKey at_time{"at", KeyKind::time, "instant at which functions of time are frozen (default: the current)",
                          UnitKind::time, Domain::any};
const AnalysisKey free_motions{"free",
                               KeyKind::word,
                               "what to do where motions are not driven: refuse, or take the smallest velocities",
                               {},
                               {},
                               {"refuse", "minimum_norm"}};
const AnalysisKey branch{"branch", KeyKind::whole, "which of the branches listed where several meet, from 1"};
const AnalysisKey tolerance{"tolerance", KeyKind::number, "relative error allowed", UnitKind::none, Domain::positive};
const AnalysisKey events{"events", KeyKind::events, "what to watch for, and what to do then"};
const AnalysisKey replicated{"replicate", KeyKind::event_blocks,
                             "blocks of events that are repeated, as those of the scene: {\"count\", \"first\", "
                             "\"variable\", \"events\", \"replicate\"}"};
const AnalysisKey measures{"measures", KeyKind::measures, "names and what is measured: {\"peak\": {\"max\": column}}"};
const AnalysisKey digits{"digits", KeyKind::flag,
                         "whether to tell how many digits of each column are right (default true), which costs a "
                         "second run of some motions"};
const AnalysisKey parameter{
    "parameter", KeyKind::parameter, "the parameter that changes", UnitKind::none, Domain::any, {}, true};

AnalysisDescription make(std::string_view name, std::string_view summary, std::string_view results, bool timed,
                         Keys keys) {
  AnalysisDescription d{name, summary, std::string(results), timed, {type, set, from}};
  d.keys.insert(d.keys.end(), keys.begin(), keys.end());
  if (d.find("digits")) d.results += ", digits_note (why digits are not claimed, or not of all columns)";
  return d;
}

std::vector<AnalysisDescription> describe_all() {
  return {
      make("check", "Bodies, equations, degrees of freedom by count and by rank, redundant constraints, islands.",
           "bodies, rows, rank, dof, mobility, redundant, islands, free_bodies, free_motions and moving_freely (what "
           "nothing resists), misfits (equations that are not met)",
           false, {at_time, measures}),
      make("assemble", "The configuration nearest to the given one that meets all constraints.",
           "residual, moved, iterations, misfits (equations that are not met)", false, {outputs, at_time, measures}),
      make("kinematics", "Positions, velocities and accelerations of a driven mechanism over time.",
           "dof, mobility, singular, events", true,
           {outputs, until, every, at_times, free_motions, branch, events, replicated, digits, measures}),
      make("inverse_dynamics", "Loads of drivers and reactions in a driven mechanism over time.",
           "dof, mobility, singular, events", true,
           {outputs, until, every, at_times, free_motions, branch, events, replicated, digits, measures}),
      make(
          "dynamics", "Motion under forces over time.",
          "method, events, impulses (of constraints where velocities jump), estimated_error, singular (dead points), "
          "integrated_apart (how many groups of mechanisms "
          "had steps of their own)",
          true,
          {outputs,
           until,
           every,
           at_times,
           tolerance,
           {"method",
            KeyKind::word,
            "integrator: rk8, rk5 (Runge-Kutta) and adams (multistep, fewest evaluations in smooth motions) project "
            "onto "
            "the constraints after every step, baumgarte stabilises them and shows how they drift, partitioning "
            "integrates independent coordinates, radau is implicit, for stiff springs and dampers, alpha too, of order "
            "2, rattle keeps the energy of long motions with a fixed step; auto takes adams for open chains of ten "
            "bodies and more, else rk8, and goes over to radau where stiffness asks for it",
            {},
            {},
            {integration_methods.begin(), integration_methods.end()}},
           {"step", KeyKind::number, "fixed step, s (default: chosen by the tolerance)", UnitKind::time},
           {"rho", KeyKind::number,
            "of alpha: what a step leaves of a vibration much faster than it, 0 ... 1 (default 0.8)", UnitKind::none,
            Domain::not_negative},
           {"max_steps", KeyKind::whole,
            "largest number of steps, rejected ones included: the analysis ends when they do not suffice (default "
            "10^7)"},
           {"estimate_error", KeyKind::flag,
            "whether to run it a second time, at a tenth of the tolerance or half the step: estimated_error is the "
            "largest difference of the two at its rows, which are those of the finer run"},
           events,
           replicated,
           digits,
           measures}),
      make("equilibrium", "A configuration at rest, and whether it is stable.",
           "energy, stable, neutral, negative_modes, flutter (pairs of complex omega2, of forces without a potential), "
           "free_motions and moving_freely (what nothing resists to second order), residual, solver, iterations, "
           "active (the closed gaps), equilibria; with friction "
           "held and utilisation",
           false,
           {outputs,
            at_time,
            tolerance,
            {"solver", KeyKind::word, "numerical method", {}, {}, {"auto", "newton", "ipopt", "nlopt"}},
            {"accept", KeyKind::word, "which equilibria count", {}, {}, {"stable", "stationary"}},
            {"find", KeyKind::whole, "how many equilibria to look for (default 1)"},
            {"friction",
             KeyKind::word,
             "leave_out: as if there were none, with a warning; hold: whether friction can hold the given position "
             "(held), and what part of it is needed (utilisation)",
             {},
             {},
             {"leave_out", "hold"}},
            digits,
            measures}),
      make("path", "Equilibria as a parameter changes, one row a step and one a critical point.",
           "critical (limit and branch points, of forces without a potential flutter too), negative_modes, steps; "
           "flutter (pairs of complex omega2 of every row); active and changes (one-sided elements that hold, that "
           "open and close)",
           false,
           {outputs,
            at_time,
            parameter,
            {"to", KeyKind::number, "last value of the parameter, in its unit", UnitKind::own, Domain::any, {}, true},
            {"max_steps", KeyKind::whole, "largest number of steps (default 500)"},
            {"arc", KeyKind::number,
             "longest step: travel of the bodies in parts of the extent and change of the parameter in parts of its "
             "range "
             "(default 0.05)",
             UnitKind::none, Domain::positive},
            {"branch", KeyKind::whole,
             "at the first branch point: 1 goes straight on (default), 2 and 3 leave to either side"},
            digits,
            measures}),
      make("buckling",
           "Values of a load parameter at which the current equilibrium, kept in place, loses its stability.",
           "loads; flutter and flutter_omega (of forces without a potential: where two frequencies meet and one motion "
           "begins to grow; loads are those of divergence then); active (one-sided elements that hold)",
           false,
           {outputs, at_time, parameter, {"count", KeyKind::whole, "how many loads (default 1)"}, digits, measures}),
      make("modes", "Small undamped oscillations about the current configuration at rest: omega^2 ascending.",
           "omega2, omega, unstable, free_motions and moving_freely (those with omega2 = 0), active (one-sided "
           "elements that hold); of forces without a potential flutter (pairs of complex omega2), omega2_imaginary and "
           "growth (1/s), the motion that grows first",
           false,
           {outputs,
            at_time,
            {"count", KeyKind::whole, "how many modes (default: all, at most ten)"},
            {"shapes", KeyKind::flag,
             "whether to add columns with the shapes: what each output moves by, for a modal mass of 1 kg m^2"},
            digits,
            measures}),
      make("sensitivity", "Total derivatives of rows and measures of an analysis with respect to parameters.",
           "what the analysis has; gradients; mode; deviation", false,
           {{"outputs", KeyKind::columns, "columns of the analysis inside (default: the scene's outputs)"},
            {"of", KeyKind::analysis, "the analysis", UnitKind::none, Domain::any, {}, true},
            {"parameters", KeyKind::names, "which derivatives", UnitKind::none, Domain::any, {}, true},
            {"mode",
             KeyKind::word,
             "forward, which auto is: a column d(O)/d(p) for every output and parameter, and gradients of measures; "
             "adjoint: gradients alone, at a cost that does not grow with the number of parameters",
             {},
             {},
             {"auto", "forward", "adjoint"}},
            {"verify", KeyKind::flag,
             "whether to compare with differences of second order: deviation is the largest one, relative"}}),
      make(
          "optimise", "Parameters that make an objective least under constraints.",
          "variables, objective, constraints, active, optimality, evaluations, failed, solver", false,
          {{"of", KeyKind::analysis, "the analysis, or a list of them in order", UnitKind::none, Domain::any, {}, true},
           {"variables",
            KeyKind::variables,
            "parameters, each with \"min\", \"max\" and \"start\"",
            UnitKind::none,
            Domain::any,
            {},
            true},
           {"minimise", KeyKind::objective, "a measure, or an expression over measures and parameters"},
           {"maximise", KeyKind::objective, "the same, to be as large as can be"},
           {"subject_to", KeyKind::relations, "expressions with <=, >= or == between them"},
           {"solver",
            KeyKind::word,
            "auto is slsqp; slsqp, mma and ipopt use gradients, bobyqa and cobyla none, crs2, isres and direct search "
            "everywhere",
            {},
            {},
            {"auto", "slsqp", "mma", "ipopt", "bobyqa", "cobyla", "crs2", "isres", "direct"}},
           {"starts", KeyKind::whole,
            "how many starts: the given one, then random ones, as many at once as there are threads (default 1)"},
           {"seed", KeyKind::whole, "of random starts (default 1)"},
           tolerance,
           {"max_evaluations", KeyKind::whole, "most designs that are analysed (default 1000)"}}),
      make(
          "sweep",
          "An analysis repeated over values of parameters; one row a design, with its measures and its status.",
          "designs, failed (how many, by status), failures (each with its parameters and the reason), in_lanes "
          "(designs of kinematics, inverse_dynamics or equilibrium that were computed in SIMD lanes), scatter (of "
          "measures, where parameters "
          "are distributed)",
          false,
          {{"of", KeyKind::analysis, "the analysis, or a list of them in order", UnitKind::none, Domain::any, {}, true},
           {"over",
            KeyKind::over,
            "parameters, each with a list of values, with \"from\", \"to\" and \"count\", or in a sampled design with "
            "\"normal\": [mean, deviation] or \"uniform\": [least, greatest]",
            UnitKind::none,
            Domain::any,
            {},
            true},
           {"design",
            KeyKind::word,
            "grid: every combination; together: the k-th value of each; sobol, latin, random: sampled",
            {},
            {},
            {"grid", "together", "sobol", "latin", "random"}},
           {"samples", KeyKind::whole, "how many sampled designs (default 1000)"},
           {"seed", KeyKind::whole, "of latin and random designs (default 1)"}}),
  };
}

}  // namespace

const AnalysisKey* AnalysisDescription::find(std::string_view key) const {
  for (const AnalysisKey& known : keys) {
    if (known.name == key) return &known;
  }
  return nullptr;
}

std::span<const AnalysisKey> event_keys() {
  static const Keys keys{
      {"name", KeyKind::word, "its name in the results"},
      {"when", KeyKind::columns, "the column, or the expression of columns, that is watched", {}, {}, {}, true},
      {"value", KeyKind::number, "the value at which the event happens, in the unit of the column (default 0)",
       UnitKind::own, Domain::any},
      {"direction", KeyKind::word, "rising, falling or both", {}, {}, {"any", "up", "down"}},
      {"action", KeyKind::word, "what happens then", {}, {}, {"record", "stop", "release", "engage", "impulse"}},
      {"element", KeyKind::word, "the element that is released or engaged"},
      {"impulse", KeyKind::impulse, "a blow: {\"i\": point, \"value\": [px, py]} in ground axes, N s"}};
  return keys;
}

std::span<const AnalysisKey> event_block_keys() {
  static const Keys keys{
      {"count", KeyKind::number, "how often the block is repeated", UnitKind::none, Domain::any, {}, true},
      {"first", KeyKind::number, "first value of k (default 1)", UnitKind::none, Domain::any},
      {"variable", KeyKind::word, "a name to use in place of k"},
      events,
      replicated};
  return keys;
}

std::span<const AnalysisDescription> analysis_descriptions() {
  static const std::vector<AnalysisDescription> all = describe_all();
  return all;
}

const AnalysisDescription* find_analysis_type(std::string_view type_name) {
  for (const AnalysisDescription& description : analysis_descriptions()) {
    if (description.type == type_name) return &description;
  }
  return nullptr;
}

}  // namespace catena
