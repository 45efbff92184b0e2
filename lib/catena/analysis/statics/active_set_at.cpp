#include "catena/analysis/statics/active_set_at.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "catena/analysis/pose/assemble.hpp"
#include "catena/analysis/run/name_list.hpp"
#include "catena/analysis/run/state_conversion.hpp"
#include "catena/analysis/run/thresholds.hpp"
#include "catena/analysis/statics/solvers/static_active_set.hpp"
#include "catena/base/at.hpp"
#include "catena/elements/all.hpp"

namespace catena {
namespace {

// Of the largest pull: gaps that pull as much are opened at once.
constexpr double with_the_worst = 0.5;

/// The names of the gaps that are marked and meet a condition, the first few.
template <class F>
std::string first_names(const Evaluator& evaluator, std::span<const char> marked, F&& meets) {
  NameList names;
  for (std::size_t k = 0; k < marked.size(); ++k) {
    const int element = evaluator.plan().row_element[at(evaluator.plan().gap_rows[k])];
    if (marked[k] && meets(element)) names.add(evaluator.model().element_name(element));
  }
  return names.text();
}

/// Assembles with a plan that has no gaps, if the place does not meet the constraints already.
Report assemble_without_gaps(StaticSystem& system, std::vector<double>& q) {
  system.move_to(q);
  if (system.phi_norm() <= std::max(thresholds::assembled, 10 * system.rounding_change())) return {};
  Evaluator& evaluator = system.evaluator();
  PlanOptions options;
  options.released_elements = evaluator.model().gaps();
  EvaluationWork work;
  Evaluator free(Plan::make(evaluator.model(), options), evaluator.model(), work);
  free.set_time(evaluator.time());
  std::vector<double> place = configuration_of(free, state_of(evaluator, evaluator.time(), q));
  const Report report = Assembler(free).assemble(place);
  take_over_places(evaluator, state_of(free, evaluator.time(), place), q);
  system.move_to(q);
  return report;
}

}  // namespace

Report close_gaps_at(StaticSystem& system, std::vector<double>& q, std::span<double> lambda, ActiveSet& set,
                     Imbalance& left) {
  const Plan& plan = system.plan();
  const std::size_t gaps = plan.gap_rows.size();
  set = {std::vector<char>(gaps, 0), std::vector<char>(gaps, 0)};
  system.close_gaps(set.closed);
  if (Report assembly = assemble_without_gaps(system, q); !assembly.ok()) return assembly;
  const std::vector<double> gap = gap_values(system);
  for (std::size_t k = 0; k < gaps; ++k) {
    const double unit = units_of(system, plan.gap_rows[k], {system.length(), 1}).gap;
    const int element = plan.row_element[at(plan.gap_rows[k])];
    if (gap[k] < -thresholds::given_depth * unit) {
      const Model& model = system.evaluator().model();
      return {Status::inconsistent,
              fmt::format("{} \"{}\" is violated at this place by {:.4g} {}: an equilibrium analysis before this one "
                          "finds a place that allows it",
                          model.element_type(element), model.element_name(element), -gap[k],
                          plan.row_is_angle[at(plan.gap_rows[k])] ? "rad" : "m"),
              {}};
    }
    set.closed[k] = gap[k] <= thresholds::closed_gap * unit;
  }
  std::vector<double> force(gaps);
  for (const std::vector<char> touches = set.closed;; ++set.changes) {
    system.close_gaps(set.closed);
    system.move_to(q);
    left = balance_loads(system, lambda);
    const double scale = std::max(system.force_scale(lambda), typical_force(system));
    double pull = thresholds::no_force;
    for (std::size_t k = 0; k < gaps; ++k) {
      const int row = plan.gap_rows[k];
      force[k] = set.closed[k] ? -lambda[at(row)] / units_of(system, row, {system.length(), scale}).force : 0;
      pull = std::max(pull, -force[k]);
    }
    bool opened = false;
    for (std::size_t k = 0; k < gaps; ++k) {
      // Without pulls the weak ones are left.
      const bool opens =
          set.closed[k] && (pull > thresholds::no_force ? -force[k] >= with_the_worst * pull : force[k] <= pull);
      if (!opens) continue;
      set.closed[k] = 0;
      opened = true;
    }
    if (!opened) {
      for (std::size_t k = 0; k < gaps; ++k) set.weak[k] = touches[k] && !set.closed[k];
      return {};
    }
  }
}

Compliance compliance_of(const Model& model, int element) {
  Compliance law;
  const ElementRecord& record = model.elements[at(element)];
  with_list(model.constraints, record.type, [&](const auto& list) {
    if constexpr (requires { list.front().element.exponent; }) {
      const auto& own = list[at(record.index)].element;
      law = {own.k, own.exponent};
      if constexpr (requires { own.quantity; }) {  // a stop
        const double apart = own.max - own.min;
        if (std::isfinite(apart)) law.bend = -2 / apart;
      }
    }
  });
  return law;
}

std::string taken_as_open(const std::string& names) {
  return fmt::format(
      "touching without a force that could be told from rounding: {}; the results are those without them, as if open",
      names);
}

std::string taken_as_rigid(const Evaluator& evaluator, const ActiveSet& set) {
  const std::string names = first_names(
      evaluator, set.closed, [&](int element) { return compliance_of(evaluator.model(), element).compliant(); });
  if (names.empty()) return {};
  return fmt::format("the stiffness k of {} counts in motion alone: at rest, and in these results, it is rigid", names);
}

std::vector<std::string> remarks_on(const Evaluator& evaluator, const ActiveSet& set) {
  std::vector<std::string> remarks;
  if (const std::string names = names_of_weak(evaluator, set); !names.empty()) remarks.push_back(taken_as_open(names));
  if (std::string rigid = taken_as_rigid(evaluator, set); !rigid.empty()) remarks.push_back(std::move(rigid));
  return remarks;
}

std::vector<std::string> names_of_closed(const Evaluator& evaluator, const ActiveSet& set) {
  std::vector<std::string> names;
  for (std::size_t k = 0; k < set.closed.size(); ++k) {
    const int element = evaluator.plan().row_element[at(evaluator.plan().gap_rows[k])];
    if (set.closed[k]) names.push_back(evaluator.model().element_name(element));
  }
  return names;
}

std::string names_of_weak(const Evaluator& evaluator, const ActiveSet& set) {
  return first_names(evaluator, set.weak, [](int) { return true; });
}

}  // namespace catena
