// What elements see of a mechanism in motion with derivatives: frames shifted to a common origin, values of functions.
// For the source files of DesignMechanism.
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <type_traits>

#include "catena/assembly/design/design_mechanism.hpp"
#include "catena/elements/all.hpp"

namespace catena::detail {

using DesignSeries = Taylor<DesignScalar>;

/// Elements that MechanismTangents differentiates: those of which frames and functions say all.
template <class E>
constexpr bool is_differentiated =
    !std::is_same_v<E, CustomConstraint<double>> && !std::is_same_v<E, CustomForce<double>> && !Joining<E> &&
    !Sharing<E> && !SearchesCurve<E>;

/// What AdjointMechanism differentiates: elements that search along curves as well, from the contacts that it is given.
template <class E>
constexpr bool has_adjoint = is_differentiated<E> || HasCurve<E>;

/// Equations that show a few scalars alone: slides of contacts, and what only C++ can make.
template <class E>
constexpr bool is_slide = std::is_same_v<E, CustomConstraint<double>>;

/// Without derivatives by parameters.
inline DesignSeries lifted(const Taylor<double>& x) {
  return {DesignScalar(x.f), DesignScalar(x.d), DesignScalar(x.dd)};
}
inline Frame<DesignSeries> lifted(const Frame<Taylor<double>>& f) {
  return {lifted(f.x), lifted(f.y), lifted(f.phi), lifted(f.c), lifted(f.s)};
}

/// c(t) of an element's entry, a series of T; `functions`: those of the model.
template <class T, class Entry>
Taylor<T> value_of_entry([[maybe_unused]] const Entry& entry,
                         [[maybe_unused]] const std::vector<Taylor<T>>& functions) {
  if constexpr (Entry::Element::functions > 0) {
    const auto& value = entry.values[0];
    return value.function < 0 ? Taylor<T>(T(value.constant)) : functions[static_cast<std::size_t>(value.function)];
  } else {
    return {};
  }
}

/// Values of an element's functions of time and laws, one more than there are so that there is always one; law(number)
/// gives those of laws.
template <class T, class Entry, class Law>
std::array<T, Entry::Element::functions + 1> function_values(const Entry& entry,
                                                             std::span<const DesignSeries> functions, Law&& law) {
  std::array<T, Entry::Element::functions + 1> f;
  for (std::size_t k = 0; k < entry.values.size(); ++k) {
    const auto& value = entry.values[k];
    f[k] = value.law >= 0        ? T(law(value.law))
           : value.function >= 0 ? T(functions[static_cast<std::size_t>(value.function)].f)
                                 : T(value.constant);
  }
  return f;
}
/// Where laws do not count, or there are none.
inline double no_law(int) { return 0; }

/// f relative to another origin.
template <class T>
Frame<T> moved_by(Frame<T> f, const Vec2<double>& by) {
  f.x = f.x + T(by.x);
  f.y = f.y + T(by.y);
  return f;
}

/// Whether these rows, from `row` on, weigh anything: those that are released do not. Empty: none does.
inline bool rows_weigh(std::span<const double> weights, int row, int rows) {
  return !weights.empty() &&
         std::any_of(weights.begin() + row, weights.begin() + row + rows, [](double weight) { return weight != 0; });
}

/// Calls f(block, list) for all constraints. Where pins are all there is nothing else is looked through: of small
/// mechanisms that takes longer than the pins themselves.
template <class F>
void visit_constraints(const Plan& plan, const Model& model, F&& f) {
  const auto& pins = std::get<ConstraintBlock<Revolute<double>>>(plan.blocks);
  if (Revolute<double>::rows * pins.size() == plan.rows)
    f(pins, std::get<std::vector<ElementEntry<Revolute<double>, double>>>(model.constraints));
  else
    for_each_list(plan.blocks, model.constraints, [&](const auto& block, const auto& list, int) { f(block, list); });
}

/// The value of a series' frame at the instant itself.
inline Frame<DesignScalar> present(const Frame<DesignSeries>& f) { return {f.x.f, f.y.f, f.phi.f, f.c.f, f.s.f}; }

/// The frames of element e of a block as it wants them: relative to the origin of the body that moves, for one-body
/// elements with that origin's place in the ground.
template <class T>
struct DesignFrames {
  Frame<T> i, j;
  Vec2<double> ground{};
};

template <class T, class Block, class FrameOf>
DesignFrames<T> design_frames(const Block& block, int e, int moving, std::span<const Vec2<double>> origin,
                              FrameOf&& frame_of) {
  using E = typename Block::Element;
  const auto k = static_cast<std::size_t>(e);
  const int body_i = block.body_i[k];
  DesignFrames<T> f;
  f.i = frame_of(body_i);
  const Vec2<double> origin_i = origin[static_cast<std::size_t>(body_i)];
  if constexpr (E::bodies == 1) {
    f.ground = origin_i;
  } else {
    const int body_j = block.body_j[k];
    f.j = frame_of(body_j);
    const Vec2<double> apart = origin[static_cast<std::size_t>(body_j)] - origin_i;
    if (body_i >= moving) {
      f.i = moved_by(f.i, -apart);
    } else {
      f.j = moved_by(f.j, apart);
    }
  }
  return f;
}

}  // namespace catena::detail
