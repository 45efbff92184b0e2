#include "catena/analysis/run/watched_elements.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "catena/columns/state_laws.hpp"
#include "catena/elements/all.hpp"

namespace catena {

WatchedElements::WatchedElements(const Evaluator& evaluator) : evaluator_(evaluator) {
  for_each_list(evaluator.model().constraints, [&](const auto& list, int) {
    if constexpr (HasTrouble<ElementOf<decltype(list)>>) {
      for (const auto& entry : list) {
        if (evaluator.plan().element_row[static_cast<std::size_t>(entry.id)] >= 0) elements_.push_back(entry.id);
      }
    }
  });
  const auto look = [&](const auto& list, int) {
    if constexpr (HasCurveUse<ElementOf<decltype(list)>>) {
      for (const auto& entry : list) {
        if (entry.element.can_leave_curve()) ending_.push_back(entry.id);
      }
    }
  };
  // Equations of grips measure along ropes as well, but are no ropes: these have paths, if any has.
  const std::vector<RopePath>& paths = evaluator.model().rope_paths;
  for (const int element : evaluator.model().gaps()) {
    const bool has_path =
        std::any_of(paths.begin(), paths.end(), [&](const RopePath& p) { return p.element == element; });
    const bool is_rope = evaluator.model().element_type(element) == Rope<double>::type;
    if (is_rope && (has_path || paths.empty())) ropes_.push_back(element);
  }
  for (const auto& entry : std::get<std::vector<ElementEntry<ElasticRope<double>, double>>>(evaluator.model().forces)) {
    if (entry.element.pieces > 0) ropes_.push_back(entry.id);
  }
  for_each_list(evaluator.model().constraints, look);
  for_each_list(evaluator.model().forces, look);
  for (const CompiledLaw<double>& law : evaluator.laws()) has_law_ends_ = has_law_ends_ || law.formula.has_ends();
}

Report WatchedElements::check_laws(std::span<const double> qd) const {
  Report report;
  for (int law = 0; law < static_cast<int>(evaluator_.laws().size()); ++law) {
    double place = 0;
    std::string why;
    if (const NamedTable<double>* table = evaluator_.left_table(law, qd, place)) {
      const Spline<double>& curve = table->curve;
      why = fmt::format(
          "its table \"{}\" reaches from {:.9g} to {:.9g}, and {:.9g} is asked for; end the analysis before, make the "
          "table longer, or say with \"beyond\" what lies there",
          table->name, curve.first(), curve.last(), place);
    } else if (!std::isfinite(evaluator_.law_value(law, qd))) {
      why = "its expression has no finite value there";
    } else {
      continue;
    }
    report.status = Status::singular;
    report.message = fmt::format("{} is undefined at t = {:.9g} s: {}", describe_law(evaluator_.model(), law),
                                 evaluator_.time(), why);
    break;
  }
  return report;
}

Report WatchedElements::check() const {
  if (Report ends = check_ends(); !ends.ok()) return ends;
  for (int element : elements_) {
    if (const char* trouble = evaluator_.trouble(element)) return undefined(element, trouble);
  }
  return check_ropes();
}

Report WatchedElements::check_ropes() const {
  for (int element : ropes_) {
    if (const char* trouble = evaluator_.rope_trouble(element)) return undefined(element, trouble);
  }
  return {};
}

Report WatchedElements::undefined(int element, const char* why) const {
  const Model& model = evaluator_.model();
  Report report;
  report.status = Status::singular;
  report.message = fmt::format("{} \"{}\" is undefined at t = {:.12g} s: {}", model.element_type(element),
                               model.element_name(element), evaluator_.time(), why);
  return report;
}

void WatchedElements::find_places(std::vector<double>& out) const {
  out.clear();
  for (int element : ending_) {
    const std::optional<CurveUse> use = evaluator_.curve_use(element);
    out.push_back(use ? (use->parameter - use->first) / (use->last - use->first)
                      : std::numeric_limits<double>::quiet_NaN());
  }
}

Report WatchedElements::check_ends() const {
  Report report;
  const Model& model = evaluator_.model();
  for (int element : ending_) {
    const std::optional<CurveUse> use = evaluator_.curve_use(element);
    if (!use || !(use->excess() > allowed_excess)) continue;
    const bool low = use->parameter < (use->first + use->last) / 2;
    const std::string why =
        use->end
            ? fmt::format("its curve is left at its end at ({:.9g}, {:.9g}) m", use->end->x, use->end->y)
            : fmt::format("its table ends at an elongation of {:.9g} m, which is passed", low ? use->first : use->last);
    report.status = Status::singular;
    report.message = fmt::format(
        "{} \"{}\" is undefined at t = {:.9g} s: {}; end the analysis before, make the {} longer, or say with "
        "\"beyond\" what lies there",
        model.element_type(element), model.element_name(element), evaluator_.time(), why, use->end ? "curve" : "table");
    break;
  }
  return report;
}

}  // namespace catena
