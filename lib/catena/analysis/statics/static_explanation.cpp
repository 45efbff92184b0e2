#include "catena/analysis/statics/static_explanation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "catena/analysis/pose/assemble.hpp"
#include "catena/analysis/run/energyless_forces.hpp"
#include "catena/analysis/run/thresholds.hpp"
#include "catena/analysis/run/watched_elements.hpp"
#include "catena/analysis/spectrum/free_motions.hpp"
#include "catena/analysis/statics/active_set_at.hpp"
#include "catena/analysis/statics/endless_line.hpp"
#include "catena/analysis/statics/solvers/static_descent.hpp"
#include "catena/assembly/rope_ways.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// The square of this is the largest number.
constexpr double largest_number = 1e154;

std::string body_of(const Evaluator& evaluator, int column) {
  const Plan& plan = evaluator.plan();
  const int body = plan.model_body[at(plan.coordinate[at(column)] / 3)];
  return std::string(evaluator.model().body_name(body));
}

// Describes why the last point is no equilibrium, from its accuracy and certificate.
void describe_point(StaticSystem& system, const StaticAccuracy& a, double tolerance, const Certificate& c,
                    Report& report) {
  if (c.valid && c.negative_modes > 0 && a.holds()) {
    report.message = fmt::format(
        "every equilibrium that was found is unstable, the last one in {} mode{}, the lowest: {}; ask for it with "
        "\"accept\": \"stationary\", or start nearer to a stable one",
        c.negative_modes, c.negative_modes > 1 ? "s" : "",
        c.mode.empty() ? "unknown" : describe_mode(system.evaluator(), c.mode, system.radius()));
    return;
  }
  const std::string where = a.column >= 0 ? fmt::format(" at body \"{}\"", body_of(system.evaluator(), a.column)) : "";
  report.message = fmt::format("no equilibrium found: the forces{} are out of balance by {:.3g} N, of {:.3g} N", where,
                               a.residual, a.forces);
  if (a.loads < a.forces) report.message += fmt::format(" and loads of {:.3g} N", a.loads);
  if (system.plan().rows > static_cast<int>(system.plan().gap_rows.size())) {
    report.message += fmt::format("; the constraints miss by {:.3g} m or rad", system.phi_norm() * system.length());
  }
  const bool stiff = a.rounding > tolerance * a.forces;
  report.message +=
      stiff ? fmt::format(
                  "; likely cause: stiffnesses too large for the loads, {:.3g} N/m: rounding of places alone "
                  "makes {:.3g} N of them; take a joint or a coupler instead, or a softer spring",
                  system.matrix().largest_stiffness(), a.rounding)
            : "; likely cause: a start far off, or an energy without a minimum nearby";
}

// A search that creeps along a line on which the energy falls without end: names the body that moves most on it. The
// system has all gaps open.
std::optional<Report> explain_creeping(StaticSystem& system, const std::vector<double>& start) {
  if (!system.evaluator().conservative()) return {};
  // At the start, where rounding is least: far away it passes for a stiffness.
  std::vector<double> q = start;
  if (!restore_constraints(system, q)) return {};
  const std::optional<EndlessLine> line = find_endless_line(system, q);
  if (!line) return {};
  const auto largest = std::max_element(line->direction.begin(), line->direction.end(),
                                        [](double a, double b) { return std::abs(a) < std::abs(b); });
  const auto column = static_cast<int>(largest - line->direction.begin());
  const bool turns = system.plan().coordinate[at(column)] % 3 == 2;
  return Report{Status::unbounded,
                fmt::format("the energy has no minimum: nothing holds body \"{}\", {:.4g} {} it without end{}",
                            body_of(system.evaluator(), column), line->force, turns ? "N m turn" : "N move",
                            turns ? "" : " along a straight line"),
                {}};
}

// A curve or a table that ends holds nothing beyond: `singular`, with the one that was left on the way from the start,
// as a motion says. Some lengths of the curve beyond its end the foot on it is no longer followed, and is the end: the
// element is then found nearer to the start.
Report find_left_end(StaticSystem& system, const std::vector<double>& start) {
  Evaluator& evaluator = system.evaluator();
  const WatchedElements watched(evaluator);
  Report left = watched.check_ends();
  std::vector<double> places;
  watched.find_places(places);
  const auto is_at_end = [](double place) { return place <= 0 || place >= 1; };
  if (!left.ok() || std::none_of(places.begin(), places.end(), is_at_end)) return left;
  std::vector<double> there(start);
  for (std::size_t b = 0; 3 * b + 2 < there.size() && b < evaluator.frames().size(); ++b) {
    const Frame<double>& f = evaluator.frames()[b];
    there[3 * b] = f.x, there[3 * b + 1] = f.y, there[3 * b + 2] = f.phi;
  }
  const std::vector<double> last = there;
  const std::vector<CurvePlace> feet = evaluator.curve_places();
  for (double part = 0.5; left.ok() && part > std::numeric_limits<double>::epsilon(); part /= 2) {
    for (std::size_t k = 0; k < there.size(); ++k) there[k] = start[k] + part * (last[k] - start[k]);
    evaluator.set_configuration(there);
    left = watched.check_ends();
  }
  evaluator.go_to_curve_places(feet);
  evaluator.set_configuration(last);
  return left;
}

}  // namespace

std::optional<Report> find_overflow(StaticSystem& system, std::span<double> lambda) {
  system.fill(lambda, Curvature::exact, 0);
  const Plan& plan = system.plan();
  const std::span<const int> diagonal = system.matrix().structure().diagonal;
  for (int c = 0; c < plan.columns; ++c) {
    const double stiffness = system.matrix().values()[at(diagonal[at(c)])], force = system.gradient()[at(c)];
    if (std::abs(stiffness) <= largest_number && std::abs(force) <= largest_number) continue;
    const bool turning = plan.coordinate[at(c)] % 3 == 2, forced = !(std::abs(force) <= largest_number);
    Report report;
    report.status = Status::refused;
    report.message = fmt::format(
        "{1} on body \"{0}\" is too large to compute with: products of numbers beyond {2:.0e} {3} cannot be "
        "represented; likely cause: a mistyped unit or exponent",
        body_of(system.evaluator(), c), forced ? (turning ? "a torque" : "a force") : "a stiffness", largest_number,
        forced ? (turning ? "N m" : "N") : (turning ? "N m/rad" : "N/m"));
    return report;
  }
  return {};
}

Report explain_unbounded(StaticSystem& system, const std::vector<double>& start) {
  if (Report left = find_left_end(system, start); !left.ok()) return left;
  const Plan& plan = system.plan();
  const std::span<const Frame<double>> frames = system.evaluator().frames();
  int farthest = 0;
  double most = -1;
  for (int c = 0; c < plan.columns; ++c) {
    const int coordinate = plan.coordinate[at(c)];
    const Frame<double>& f = frames[at(coordinate / 3)];
    const double now = coordinate % 3 == 0 ? f.x : coordinate % 3 == 1 ? f.y : f.phi;
    const double gone = std::abs(now - start[at(coordinate)]) / (coordinate % 3 == 2 ? 1 : system.length());
    if (gone > most) {
      most = gone;
      farthest = c;
    }
  }
  return {
      Status::unbounded,
      fmt::format("the energy has no minimum: body \"{}\" {} without end; likely cause: nothing holds it",
                  body_of(system.evaluator(), farthest), plan.coordinate[at(farthest)] % 3 == 2 ? "turns" : "moves"),
      {}};
}

Report refuse_gaps_without_energy(StaticSystem& system) {
  const Evaluator& evaluator = system.evaluator();
  const int element = system.plan().row_element[at(system.plan().gap_rows.front())];
  return {Status::refused,
          fmt::format("{}, and this analysis follows one-sided elements such as {} \"{}\" only where all have one",
                      forces_without_energy(evaluator.model()), evaluator.model().element_type(element),
                      evaluator.model().element_name(element)),
          {}};
}

Report explain_failure(StaticSystem& system, const StaticOutcome& outcome, const StaticAccuracy& accuracy,
                       double tolerance, const std::vector<double>& start, const StaticResult& result) {
  const Evaluator& evaluator = system.evaluator();
  const Plan& plan = system.plan();
  const int rope = rope_at_circle(evaluator);  // where the search ended
  if (outcome.end == StaticEnd::cancelled) {
    return {Status::cancelled,
            fmt::format("stopped after {} iterations, before an equilibrium was found", result.iterations),
            {}};
  }
  if (outcome.end == StaticEnd::unbounded) return explain_unbounded(system, start);
  Report report;
  report.status = Status::not_converged;
  describe_point(system, accuracy, tolerance, result.certificate, report);
  const std::vector<double> gap = gap_values(system);
  system.close_gaps(std::vector<char>(gap.size(), 0));
  if (const std::optional<Report> creeping = explain_creeping(system, start)) return *creeping;
  Assembler assembler(system.evaluator());
  std::vector<double> assembled = start;
  if (const AssemblyOutcome assembly = assembler.assemble(assembled); !assembly.ok()) return assembly;
  if (rope >= 0) {
    report.message +=
        fmt::format("; an end or a pulley of rope \"{}\" came to the circle of the next pulley, where it has no way",
                    evaluator.model().element_name(rope));
  }
  const auto worst = std::min_element(gap.begin(), gap.end());
  if (worst != gap.end() && *worst < -thresholds::given_depth * system.length()) {
    const int element = plan.row_element[at(plan.gap_rows[static_cast<std::size_t>(worst - gap.begin())])];
    report.message +=
        fmt::format("; {} \"{}\" is violated by {:.3g}: not all of the one-sided elements may be compatible",
                    evaluator.model().element_type(element), evaluator.model().element_name(element), -*worst);
  }
  return report;
}

void name_weak_gaps(const Evaluator& evaluator, StaticResult& result) {
  const std::string names = names_of_weak(evaluator, result.gaps);
  if (names.empty()) return;
  result.report.warnings.push_back(
      fmt::format("closed gaps whose force cannot be distinguished from rounding: {}", names));
}

void warn_of_rounding(const StaticAccuracy& a, Report& report) {
  if (a.balanced || a.residual <= thresholds::no_force * a.forces) return;
  report.warnings.push_back(
      fmt::format("forces of {1:.3g} N balance to {0:.2g} N only: rounding of places changes the force of the stiffest "
                  "springs by up to {2:.2g} N, whatever the tolerance",
                  a.residual, a.forces, a.rounding));
}

void add_warnings(StaticSystem& system, const StaticAccuracy& accuracy, StaticResult& result) {
  const Evaluator& evaluator = system.evaluator();
  std::vector<std::string>& warnings = result.report.warnings;
  warn_of_rounding(accuracy, result.report);
  name_weak_gaps(evaluator, result);
  const Certificate& c = result.certificate;
  const std::string motion = c.mode.empty() ? "" : describe_mode(evaluator, c.mode, system.radius());
  if (c.neutral) {
    warnings.push_back(
        fmt::format("neutral to second order: {} change{} the energy by less than rounding; the softest: {}",
                    describe_free_motions(c.neutral_modes, c.free_bodies), c.neutral_modes > 1 ? "" : "s", motion));
  }
  if (c.negative_modes > 0) {
    warnings.push_back(fmt::format("unstable: {} negative mode{}, the lowest: {}", c.negative_modes,
                                   c.negative_modes > 1 ? "s" : "", motion));
  }
}

}  // namespace catena
