#include "catena/analysis/statics/static_search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "catena/analysis/balance/static_turns.hpp"
#include "catena/analysis/pose/assemble.hpp"
#include "catena/analysis/pose/whole_turns.hpp"
#include "catena/analysis/run/energyless_forces.hpp"
#include "catena/analysis/spectrum/free_motions.hpp"
#include "catena/analysis/statics/active_set_at.hpp"
#include "catena/analysis/statics/static_descent.hpp"
#include "catena/analysis/statics/static_ipopt.hpp"
#include "catena/analysis/statics/static_nlopt.hpp"
#include "catena/analysis/statics/static_settling.hpp"
#include "catena/assembly/rope_ways.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// Degrees of freedom up to which the energy is followed downhill from the start: the work grows with them, that of
// Newton's method does not.
constexpr int few_freedoms = 30;
// Coordinates up to which it is followed, whatever the degrees of freedom, after other methods have failed.
constexpr int most_downhill_columns = 3000;
constexpr int most_trials = 14;
// Steps downhill from where Newton's full steps do not settle: more where there is more to move, until that takes some
// ten seconds.
constexpr int least_downhill = 200, most_downhill_work = 20'000'000;
// Starts of Newton's method that fail before Ipopt is used.
constexpr unsigned starts_before_ipopt = 4;
// Newton's method may move the result of another solver by this much, length scales or rad: more is another
// equilibrium.
constexpr double largest_polish = 0.05;
constexpr double rounding_tolerance = 1e-15;
// Largest remaining change where forces are known only to rounding of stiff springs, length scales or rad.
constexpr double rounded_change = 1e-9;
// Below this interior-point iterations only accumulate rounding: Newton's method does the rest.
constexpr double finest_barrier = 1e-10;
// Tolerance of gaps and their forces, whatever the option: the last steps are cheap.
constexpr double gap_tolerance = 1e-12;
constexpr int few_first_steps = 40, most_first_steps = 80;
// A residual above this part of the forces is reported.
constexpr double unsaid_rounding = 1e-9;
// The square of this is the largest number.
constexpr double largest_number = 1e154;
constexpr double first_push = 0.05, largest_push = 0.8;
// Overlaps below this many length scales count as absent.
constexpr double absent_overlap = 1e-6;

// A reproducible number in [-1, 1).
double random_number(unsigned& seed) {
  seed = seed * 1664525u + 1013904223u;
  return static_cast<double>(seed >> 8) / (1 << 23) - 1;
}

std::string body_of(const Evaluator& evaluator, int column) {
  const Plan& plan = evaluator.plan();
  const int body = plan.model_body[at(plan.coordinate[at(column)] / 3)];
  return std::string(evaluator.model().body_name(body));
}

// Names the gaps of which rounding decides whether they are closed.
void name_weak_gaps(const Evaluator& evaluator, StaticResult& result) {
  const std::string names = names_of_weak(evaluator, result.gaps);
  if (names.empty()) return;
  result.report.warnings.push_back(
      fmt::format("closed gaps whose force cannot be distinguished from rounding: {}", names));
}

// Where forces balance as well as rounding allows, but not to the tolerance.
void warn_of_rounding(const StaticAccuracy& a, Report& report) {
  if (a.balanced || a.residual <= unsaid_rounding * a.forces) return;
  report.warnings.push_back(
      fmt::format("forces of {1:.3g} N balance to {0:.2g} N only: rounding of places changes the force of the stiffest "
                  "springs by up to {2:.2g} N, whatever the tolerance",
                  a.residual, a.forces, a.rounding));
}

}  // namespace

// Refines the result of an optimiser to rounding; keeps it where Newton's method would move to another equilibrium.
StaticOutcome StaticSearch::polish_by_newton(std::vector<double>& q, std::vector<double>& lambda,
                                             StaticOutcome outcome) {
  const std::vector<double> found = q, multipliers = lambda;
  // To rounding, whatever the tolerance: the steps cost little beside those before.
  const StaticOutcome polished = solve_by_newton(
      system_, q, lambda, {.max_iterations = 20, .tolerance = rounding_tolerance, .warm = true, .stationary = true});
  std::vector<double> change(at(system_.plan().columns));
  for (std::size_t c = 0; c < change.size(); ++c) {
    const std::size_t k = at(system_.plan().coordinate[c]);
    change[c] = q[k] - found[k];
  }
  const bool better = polished.converged() || polished.residual < outcome.residual;
  if (better && system_.change_norm(change) <= largest_polish) {
    outcome.residual = polished.residual;
    outcome.step = polished.step;
    return outcome;
  }
  q = found;
  lambda = multipliers;
  system_.move_to(q);
  return outcome;
}

StaticOutcome StaticSearch::minimise_with_gaps(std::vector<double>& q, std::vector<double>& lambda, bool warm, Way way,
                                               StaticResult& result) {
  StaticOutcome outcome;
  // Steps that do not converge soon rarely do: more are allowed only after other methods have failed.
  const StaticGapOptions exact{.first_steps = result.iterations == 0 ? few_first_steps : most_first_steps,
                               .tolerance = std::min(options_.tolerance, gap_tolerance)};
  result.solver = way == Way::ipopt ? "ipopt" : way == Way::nlopt ? "nlopt" : "newton";
  if (way == Way::ipopt || way == Way::nlopt) {
    system_.use_gaps();
    system_.move_to(q);
    outcome = way == Way::ipopt ? solve_by_ipopt(system_, q, lambda,
                                                 {.tolerance = std::max(options_.tolerance, finest_barrier),
                                                  .warm = warm,
                                                  .verbose = options_.verbose})
                                : solve_by_nlopt(system_, q, lambda, {.tolerance = options_.tolerance});
    result.iterations += outcome.iterations;
    if (outcome.converged()) outcome = finish_with_gaps(system_, q, lambda, result.gaps, exact);
    return outcome;
  }
  if (warm) {
    // Where the closed gaps stay closed this suffices for a small change of parameters.
    const std::vector<double> before = q, multipliers = lambda;
    outcome = finish_with_gaps(system_, q, lambda, result.gaps, exact);
    result.iterations += outcome.iterations;
    if (outcome.converged()) return outcome;
    q = before;
    lambda = multipliers;
  }
  outcome = solve_with_gaps(system_, q, lambda, result.gaps, exact);
  result.iterations += outcome.iterations;
  return outcome;
}

// Gaps that are closed without force may open: the point is certified as if they were. The system is left with all
// that are closed.
Certificate StaticSearch::certify_with_gaps(const std::vector<double>& q, std::span<const double> lambda,
                                            const ActiveSet& gaps) {
  if (!system_.has_gaps()) return certify(system_, lambda);
  std::vector<char> strong = gaps.closed;
  for (std::size_t k = 0; k < strong.size(); ++k) strong[k] = strong[k] && !gaps.weak[k];
  system_.close_gaps(strong);
  system_.move_to(q);
  const Certificate certificate = certify(system_, lambda);
  system_.close_gaps(gaps.closed);
  system_.move_to(q);
  return certificate;
}

// One solver from one start.
StaticOutcome StaticSearch::minimise(std::vector<double>& q, std::vector<double>& lambda, bool warm, Way way,
                                     StaticResult& result) {
  if (system_.has_gaps()) return minimise_with_gaps(q, lambda, warm, way, result);
  StaticOutcome outcome;
  system_.move_to(q);
  if (way == Way::ipopt || way == Way::nlopt) {
    result.solver = way == Way::ipopt ? "ipopt" : "nlopt";
    outcome = way == Way::ipopt ? solve_by_ipopt(system_, q, lambda,
                                                 {.tolerance = std::max(options_.tolerance, finest_barrier),
                                                  .warm = warm,
                                                  .verbose = options_.verbose})
                                : solve_by_nlopt(system_, q, lambda, {.tolerance = options_.tolerance});
    result.iterations += outcome.iterations;
    return outcome.converged() ? polish_by_newton(q, lambda, outcome) : outcome;
  }
  if (way == Way::settling) {
    result.solver = "settling";
    outcome = solve_by_settling(system_, q, lambda, {.tolerance = options_.tolerance});
    result.iterations += outcome.iterations;
    return outcome.converged() ? polish_by_newton(q, lambda, outcome) : outcome;
  }
  result.solver = "newton";
  if (way == Way::valley) {
    Assembler assembler(system_.evaluator());
    std::vector<double> assembled = q;
    if (system_.phi_norm() <= 1e-12 || assembler.assemble(assembled).ok()) {
      q = assembled;
      outcome = solve_by_descent(system_, q, lambda, {.tolerance = options_.tolerance});
      result.iterations += outcome.iterations;
      return outcome;
    }
  }
  outcome = solve_by_newton(system_, q, lambda,
                            {.tolerance = options_.tolerance, .warm = warm, .stationary = options_.stationary});
  result.iterations += outcome.iterations;
  if (outcome.end != StaticEnd::slow) return outcome;
  // Full steps that alternate have lowered the energy all the same: descent continues from their end.
  const int columns = std::max(system_.plan().columns, 1);
  const int most = std::max(least_downhill, std::min(least_downhill + 2 * columns, most_downhill_work / columns));
  outcome = solve_by_descent(system_, q, lambda, {.max_iterations = most, .tolerance = options_.tolerance});
  result.iterations += outcome.iterations;
  return outcome;
}

// Whether forces balance and constraints hold to the tolerance. A residual that may be rounding of the stiffest spring
// is accepted only if a Newton step with the factors of the certificate would move nothing: it may be the whole force
// of a soft spring. Along a neutral motion a step carries no information.
bool StaticSearch::is_accurate(std::span<const double> lambda, const Certificate& certificate) {
  accuracy_ = judge_balance(system_, lambda, options_.tolerance);
  if (!(system_.phi_norm() <= std::max(options_.tolerance, 10 * system_.rounding_change()))) return false;
  if (accuracy_.balanced || !accuracy_.rounded) return accuracy_.balanced;
  std::vector<double> force(at(system_.plan().columns)), gap(at(system_.plan().rows), 0.0);
  system_.residual(lambda, force);
  for (double& f : force) f = -f;
  const StaticStep step = system_.solve(force, gap, rounding_tolerance);
  std::vector<double> change(step.change.begin(), step.change.end());
  if (certificate.neutral && !certificate.mode.empty()) {
    // Modes are of length 1 in the metric (1, 1, radius^2).
    const std::span<const double> inverse_arms = system_.matrix().inverse_arms();
    double along = 0;
    for (std::size_t c = 0; c < change.size(); ++c) {
      along += change[c] * certificate.mode[c] / (inverse_arms[c] * inverse_arms[c]);
    }
    for (std::size_t c = 0; c < change.size(); ++c) change[c] -= along * certificate.mode[c];
  }
  return system_.change_norm(change) <= rounded_change;
}

// A push along the mode, its largest component `size` rad or length scales, to the side where the energy is lower.
void StaticSearch::leave(const Certificate& certificate, std::vector<double>& q, double size) {
  const double largest = system_.change_norm(certificate.mode);
  std::vector<double> best;
  double lowest = 0;
  for (const double side : {1.0, -1.0}) {
    std::vector<double> trial = q;
    system_.advance(trial, certificate.mode, side * size / largest, 10);
    const bool restored = restore_constraints(system_, trial);
    const double energy = restored ? system_.energy() : 0;
    if (best.empty() || (restored && energy < lowest)) {
      best = trial;
      lowest = energy;
    }
  }
  q = best;
}

void StaticSearch::shake(std::vector<double>& q, unsigned seed, double angle, double place) const {
  const Plan& plan = system_.plan();
  for (int c = 0; c < plan.columns; ++c) {
    const int coordinate = plan.coordinate[at(c)];
    const double size = coordinate % 3 == 2 ? angle : place * angle * system_.length();
    q[at(coordinate)] += size * random_number(seed);
  }
}

// Refuses forces and stiffnesses whose products overflow.
std::optional<Report> StaticSearch::find_overflow(std::span<double> lambda) {
  system_.fill(lambda, Curvature::exact, 0);
  const Plan& plan = system_.plan();
  const std::span<const int> diagonal = system_.matrix().structure().diagonal;
  for (int c = 0; c < plan.columns; ++c) {
    const double stiffness = system_.matrix().values()[at(diagonal[at(c)])], force = system_.gradient()[at(c)];
    if (std::abs(stiffness) <= largest_number && std::abs(force) <= largest_number) continue;
    const bool turning = plan.coordinate[at(c)] % 3 == 2, forced = !(std::abs(force) <= largest_number);
    Report report;
    report.status = Status::refused;
    report.message = fmt::format(
        "{1} on body \"{0}\" is too large to compute with: products of numbers beyond {2:.0e} {3} cannot be "
        "represented; likely cause: a mistyped unit or exponent",
        body_of(system_.evaluator(), c), forced ? (turning ? "a torque" : "a force") : "a stiffness", largest_number,
        forced ? (turning ? "N m" : "N") : (turning ? "N m/rad" : "N/m"));
    return report;
  }
  return {};
}

Report StaticSearch::explain(const StaticOutcome& outcome, const std::vector<double>& start,
                             const StaticResult& result) {
  Report report;
  const Evaluator& evaluator = system_.evaluator();
  const Plan& plan = system_.plan();
  const int rope = rope_at_circle(evaluator);  // where the search ended
  if (outcome.end == StaticEnd::cancelled) {
    report.status = Status::cancelled;
    report.message = fmt::format("stopped after {} iterations, before an equilibrium was found", result.iterations);
    return report;
  }
  if (outcome.end == StaticEnd::unbounded) {
    int farthest = 0;
    double most = -1;
    const std::span<const Frame<double>> frames = evaluator.frames();
    for (int c = 0; c < plan.columns; ++c) {
      const int coordinate = plan.coordinate[at(c)];
      const Frame<double>& f = frames[at(coordinate / 3)];
      const double now = coordinate % 3 == 0 ? f.x : coordinate % 3 == 1 ? f.y : f.phi;
      const double gone = std::abs(now - start[at(coordinate)]) / (coordinate % 3 == 2 ? 1 : system_.length());
      if (gone > most) {
        most = gone;
        farthest = c;
      }
    }
    report.status = Status::unbounded;
    report.message =
        fmt::format("the energy has no minimum: body \"{}\" {} without end; likely cause: nothing holds it",
                    body_of(evaluator, farthest), plan.coordinate[at(farthest)] % 3 == 2 ? "turns" : "moves");
    return report;
  }
  const std::vector<double> gap = gap_values(system_);
  system_.close_gaps(std::vector<char>(gap.size(), 0));
  Assembler assembler(system_.evaluator());
  std::vector<double> assembled = start;
  const AssemblyOutcome assembly = assembler.assemble(assembled);
  if (!assembly.ok()) {
    static_cast<Report&>(report) = assembly;
    return report;
  }
  report.status = Status::not_converged;
  describe_point(result, report);
  if (rope >= 0) {
    report.message +=
        fmt::format("; an end or a pulley of rope \"{}\" came to the circle of the next pulley, where it has no way",
                    evaluator.model().element_name(rope));
  }
  const auto worst = std::min_element(gap.begin(), gap.end());
  if (worst != gap.end() && *worst < -absent_overlap * system_.length()) {
    const int element = plan.row_element[at(plan.gap_rows[static_cast<std::size_t>(worst - gap.begin())])];
    report.message +=
        fmt::format("; {} \"{}\" is violated by {:.3g}: not all of the one-sided elements may be compatible",
                    evaluator.model().element_type(element), evaluator.model().element_name(element), -*worst);
  }
  return report;
}

// Describes why the last point is no equilibrium, from its accuracy and certificate.
void StaticSearch::describe_point(const StaticResult& result, Report& report) {
  const Certificate& c = result.certificate;
  const StaticAccuracy& a = accuracy_;
  if (c.valid && c.negative_modes > 0 && a.holds()) {
    report.message = fmt::format(
        "every equilibrium that was found is unstable, the last one in {} mode{}, the lowest: {}; ask for it with "
        "\"accept\": \"stationary\", or start nearer to a stable one",
        c.negative_modes, c.negative_modes > 1 ? "s" : "",
        c.mode.empty() ? "unknown" : describe_mode(system_.evaluator(), c.mode, system_.radius()));
    return;
  }
  const std::string where = a.column >= 0 ? fmt::format(" at body \"{}\"", body_of(system_.evaluator(), a.column)) : "";
  report.message = fmt::format("no equilibrium found: the forces{} are out of balance by {:.3g} N, of {:.3g} N", where,
                               a.residual, a.forces);
  if (a.loads < a.forces) report.message += fmt::format(" and loads of {:.3g} N", a.loads);
  if (system_.plan().rows > static_cast<int>(system_.plan().gap_rows.size())) {
    report.message += fmt::format("; the constraints miss by {:.3g} m or rad", system_.phi_norm() * system_.length());
  }
  const bool stiff = a.rounding > options_.tolerance * a.forces;
  report.message +=
      stiff ? fmt::format(
                  "; likely cause: stiffnesses too large for the loads, {:.3g} N/m: rounding of places alone "
                  "makes {:.3g} N of them; take a joint or a coupler instead, or a softer spring",
                  system_.matrix().largest_stiffness(), a.rounding)
            : "; likely cause: a start far off, or an energy without a minimum nearby";
}

// Forces that follow their body, laws of state: only the residual is solved, and the result cannot be certified.
StaticResult StaticSearch::find_without_energy(std::vector<double>& q, std::vector<double>& lambda) {
  StaticResult result;
  result.has_energy = false;
  result.solver = "settling";
  const std::vector<double> start = q;
  StaticOutcome outcome;
  for (unsigned trial = 0; trial < starts_before_ipopt; ++trial) {
    if (trial > 0) {
      q = start;
      shake(q, trial, trial == 1 ? 0.1 : 1.0);
    }
    outcome = solve_by_settling(system_, q, lambda, {.tolerance = options_.tolerance});
    result.iterations += outcome.iterations;
    if (outcome.end == StaticEnd::unbounded || outcome.end == StaticEnd::cancelled) break;
    accuracy_ = judge_balance(system_, lambda, options_.tolerance);
    if (outcome.converged() && accuracy_.holds()) break;
    if (outcome.converged()) outcome.end = StaticEnd::slow;
  }
  result.residual = outcome.residual;
  if (!outcome.converged()) {
    result.report = explain(outcome, start, result);
    return result;
  }
  warn_of_rounding(accuracy_, result.report);
  drop_whole_turns(system_, start, q);
  result.report.warnings.push_back(forces_without_energy(system_.evaluator().model()) +
                                   ": the forces balance here, but nothing certifies that this equilibrium is stable");
  return result;
}

StaticResult StaticSearch::find(std::vector<double>& q, std::vector<double>& lambda) {
  StaticResult result;
  const Plan& plan = system_.plan();
  Evaluator& evaluator = system_.evaluator();
  if (!options_.warm) move_whole_turns(evaluator, q);
  if (!evaluator.conservative()) {
    if (!system_.has_gaps()) return find_without_energy(q, lambda);
    const int element = plan.row_element[at(plan.gap_rows.front())];
    result.report.status = Status::refused;
    result.report.message =
        fmt::format("{}, and one-sided elements such as {} \"{}\" are treated by minimising one",
                    forces_without_energy(evaluator.model()), evaluator.model().element_type(element),
                    evaluator.model().element_name(element));
    return result;
  }
  const std::vector<double> start = q;
  system_.move_to(q);
  if (std::optional<Report> overflow = find_overflow(lambda)) {
    result.report = *overflow;
    return result;
  }
  const bool own = options_.solver == StaticSolver::automatic || options_.solver == StaticSolver::newton;
  const bool few =
      !options_.warm && !options_.stationary && !system_.has_gaps() && plan.columns - plan.rows <= few_freedoms;
  Way way = options_.solver == StaticSolver::ipopt   ? Way::ipopt
            : options_.solver == StaticSolver::nlopt ? Way::nlopt
            : few                                    ? Way::valley
                                                     : Way::newton;
  double push = first_push;
  StaticOutcome outcome;
  bool accepted = false, pushed = false, ask_ipopt = options_.solver == StaticSolver::automatic && ipopt_is_built_in();
  bool ask_downhill = own && !few && !system_.has_gaps() && plan.columns <= most_downhill_columns;
  unsigned shaken = 0;
  for (int trial = 0; trial < most_trials && !accepted; ++trial) {
    outcome = minimise(q, lambda, options_.warm && trial == 0, way, result);
    if (outcome.end == StaticEnd::unbounded || outcome.end == StaticEnd::cancelled) break;
    if (outcome.converged()) {
      result.certificate = certify_with_gaps(q, lambda, result.gaps);
      const bool wanted = options_.stationary || result.certificate.negative_modes == 0;
      const bool accurate = is_accurate(lambda, result.certificate);
      accepted = result.certificate.valid && wanted && accurate;
      if (accepted || !result.certificate.valid) break;
      if (!wanted) {
        if (result.certificate.mode.empty()) break;
        leave(result.certificate, q, push);
        push = std::min(2 * push, largest_push);
        pushed = true;
        continue;
      }
    }
    if (!own) break;
    // If descent fails Newton's method is tried, and then another start or Ipopt.
    q = start;
    if (trial + 2 == most_trials && !system_.has_gaps() && options_.solver == StaticSolver::automatic) {
      way = Way::settling;
    } else if (way != Way::newton) {
      way = Way::newton;
    } else if (ask_downhill && shaken > 0) {
      ask_downhill = false;
      way = Way::valley;
    } else if (ask_ipopt && shaken >= starts_before_ipopt) {
      ask_ipopt = false;
      way = Way::ipopt;
    } else {
      ++shaken;
      shake(q, shaken, shaken == 1 ? 0.1 : 1.0);
    }
  }
  if (!outcome.converged()) accuracy_ = judge_balance(system_, lambda, options_.tolerance);
  result.residual = accuracy_.residual;
  if (!accepted) {
    result.report = explain(outcome, start, result);
    return result;
  }
  warn_of_rounding(accuracy_, result.report);
  drop_whole_turns(system_, start, q);
  result.dependent_rows = system_.matrix().dependent_rows();
  name_weak_gaps(evaluator, result);
  if (way == Way::valley && !few) {
    result.report.warnings.emplace_back(
        "found by following the energy downhill from the start, after other methods had failed");
  }
  const Certificate& c = result.certificate;
  const std::string motion = c.mode.empty() ? "" : describe_mode(evaluator, c.mode, system_.radius());
  if (c.neutral) {
    result.report.warnings.push_back(
        fmt::format("neutral to second order: {} change{} the energy by less than rounding; the softest: {}",
                    describe_free_motions(c.neutral_modes, c.free_bodies), c.neutral_modes > 1 ? "" : "s", motion));
  }
  if (c.negative_modes > 0) {
    result.report.warnings.push_back(fmt::format("unstable: {} negative mode{}, the lowest: {}", c.negative_modes,
                                                 c.negative_modes > 1 ? "s" : "", motion));
  }
  if (pushed && result.report.ok()) {
    result.report.warnings.emplace_back("a stationary point that is no minimum was left towards lower energy");
  }
  return result;
}

}  // namespace catena
