#include "catena/analysis/events/engaged_turns.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <type_traits>

#include "catena/elements/all.hpp"

namespace catena {
namespace {

constexpr double turn = 2 * std::numbers::pi;

/// Calls f(entry, row, period) for a constraint whose row counts turns of one angle: the change of its residual per
/// turn.
template <class M, class F>
void with_turning_row(M& model, int element, F&& f) {
  const ElementRecord& record = model.elements[static_cast<std::size_t>(element)];
  if (record.kind == ElementKind::force) return;
  with_list(model.constraints, record.type, [&](auto& list) {
    using E = ElementOf<decltype(list)>;
    auto& entry = list[static_cast<std::size_t>(record.index)];
    if constexpr (std::is_same_v<E, AbsoluteAngle<double>> || std::is_same_v<E, RelativeAngle<double>>) {
      f(entry, 0, turn);
    } else if constexpr (std::is_same_v<E, Weld<double>>) {
      f(entry, 2, turn);
    } else if constexpr (std::is_same_v<E, RackPinion<double>>) {
      f(entry, 1, turn * entry.element.radius);
    }
  });
}

}  // namespace

int whole_turns_of(const Model& model, int element, std::span<const double> phi) {
  double turns = 0;
  with_turning_row(model, element, [&](const auto&, std::size_t row, double period) {
    turns = row < phi.size() ? std::round(phi[row] / period) : 0;
  });
  // With more turns than an int holds, a double no longer resolves the angle.
  return std::abs(turns) < std::numeric_limits<int>::max() ? static_cast<int>(turns) : 0;
}

void turn_value(Model& model, int element, int turns) {
  with_turning_row(model, element, [&](auto& entry, std::size_t, double period) {
    using E = typename std::remove_reference_t<decltype(entry)>::Element;
    const double change = turns * period;
    if constexpr (std::is_same_v<E, Weld<double>>) {
      entry.element.angle += change;
    } else if constexpr (std::is_same_v<E, RackPinion<double>>) {
      entry.element.constant += change;
    } else if (FunctionValue<double>& value = entry.values[0]; value.function < 0) {
      value.constant += change;
    } else {
      const TimeFunction<double> before = model.functions[static_cast<std::size_t>(value.function)];
      value.function = static_cast<int>(model.functions.size());
      model.functions.push_back(TimeFunction<double>::sum({before, TimeFunction<double>(change)}));
    }
  });
}

}  // namespace catena
