#include "catena/analysis/run/time_coverage.hpp"

#include <fmt/format.h>

#include <cmath>

#include "catena/elements/all.hpp"

namespace catena {
namespace {

// Times are multiples of a step and carry its rounding.
constexpr double rounding = 1e-12;

/// The element that reads the model's function of time number `function`.
std::string reader_of(const Model& model, int function) {
  std::string name;
  const auto look = [&](const auto& list, int) {
    for (const auto& entry : list) {
      for (const auto& value : entry.values) {
        if (value.function == function) name = model.element_name(entry.id);
      }
    }
  };
  for_each_list(model.constraints, look);
  for_each_list(model.forces, look);
  return name;
}

}  // namespace

Report check_time_functions(const Model& model, const TimeRange& run) {
  Report report;
  for (std::size_t k = 0; k < model.functions.size(); ++k) {
    const TimeRange domain = model.functions[k].domain();
    if (run.first >= domain.first - rounding * std::abs(domain.first) &&
        run.last <= domain.last + rounding * std::abs(domain.last)) {
      continue;
    }
    report.status = Status::refused;
    report.message = fmt::format(
        "the table of \"{}\" reaches from {:.12g} to {:.12g} s, but the analysis goes from {:.12g} to {:.12g} s; "
        "shorten "
        "the analysis, make the table longer or periodic, or say with \"beyond\" what lies there",
        reader_of(model, static_cast<int>(k)), domain.first, domain.last, run.first, run.last);
    break;
  }
  return report;
}

}  // namespace catena
