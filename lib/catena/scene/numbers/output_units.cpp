#include "catena/scene/numbers/output_units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "catena/scene/json/diagnostic.hpp"
#include "catena/scene/json/near_miss.hpp"
#include "catena/scene/numbers/quantity.hpp"

namespace catena {
namespace {

constexpr std::array si_names{"m", "s", "rad", "N", "kg"};
constexpr std::array dimensions{UnitKind::length, UnitKind::time, UnitKind::angle, UnitKind::force, UnitKind::mass};

std::size_t number_of(std::string_view kind) {
  return static_cast<std::size_t>(std::find(OutputUnits::kinds.begin(), OutputUnits::kinds.end(), kind) -
                                  OutputUnits::kinds.begin());
}

/// Exponents of length, time, angle, force and mass: a mass by itself, else forces.
std::array<int, 5> exponents(const Dimension& d) {
  if (d.length == 0 && d.time == 0) return {0, 0, d.angle, 0, d.mass};
  return {d.length - d.mass, d.time + 2 * d.mass, d.angle, d.mass, 0};
}

}  // namespace

std::optional<std::string> OutputUnits::problem(std::string_view kind, std::string_view unit) {
  const std::size_t k = number_of(kind);
  if (k == kinds.size()) {
    NearMiss near(kind);
    for (const std::string_view known : kinds) near.consider(known);
    const std::string hint = near.hint();
    return fmt::format("no unit can be asked for {}{}", in_quotes(kind),
                       hint.empty() ? "; known are length, time, angle, force, mass" : hint);
  }
  const Parsed<Quantity> quantity = parse_quantity("1 " + std::string(unit));
  if (!quantity) return quantity.error.message;
  if (!quantity->has_unit || !(quantity->dimension == dimension_of(dimensions[k])))
    return fmt::format("{} is not a unit of {}", in_quotes(unit), kind);
  return {};
}

void OutputUnits::ask(const Wishes& wishes) {
  for (const auto& [kind, unit] : wishes) {
    if (!problem(kind, unit)) units_[number_of(kind)] = Unit{unit, parse_quantity("1 " + unit)->value};
  }
}

bool OutputUnits::any() const {
  return std::any_of(units_.begin(), units_.end(), [](const auto& unit) { return unit.has_value(); });
}

OutputUnits::Conversion OutputUnits::of(std::string_view si_unit) const {
  Conversion result{1, std::string(si_unit)};
  const Parsed<Quantity> quantity = parse_quantity("1 " + std::string(si_unit));
  if (!quantity || !quantity->has_unit) return result;
  const std::array<int, 5> exponent = exponents(quantity->dimension);
  std::string above, below;
  bool changes = false;
  // A force goes before what it is multiplied by: kN mm.
  for (const std::size_t k : {std::size_t{3}, std::size_t{4}, std::size_t{0}, std::size_t{1}, std::size_t{2}}) {
    const int n = exponent[k];
    if (n == 0) continue;
    changes = changes || units_[k].has_value();
    const std::string name = units_[k] ? units_[k]->name : si_names[k];
    const std::string power = std::abs(n) == 1 ? name : fmt::format("{}^{}", name, std::abs(n));
    if (n > 0) {
      above += (above.empty() ? "" : " ") + power;
    } else {
      below += "/" + power;
    }
    if (units_[k]) result.factor /= std::pow(units_[k]->si, n);
  }
  if (!changes) return {1, std::string(si_unit)};
  result.unit = (above.empty() ? "1" : above) + below;
  return result;
}

}  // namespace catena
