// The templates of BasicModel that are instantiated per element type: adding elements by hand. Include the files of the
// elements that you add, or elements/all.hpp.
#pragma once

#include <algorithm>
#include <cmath>

#include "catena/elements/element.hpp"
#include "catena/elements/forces/joint_damper.hpp"
#include "catena/elements/gap_element.hpp"
#include "catena/model/given_frames.hpp"
#include "catena/model/model.hpp"

namespace catena {

namespace detail {

/// Position of the element type E in the list of constraint types, or -1.
template <class S, class E>
consteval int constraint_type() {
  int found = -1, k = 0;
#define CATENA_MATCH(Type)                   \
  if (std::is_same_v<E, Type<S>>) found = k; \
  ++k;
  CATENA_ALL_CONSTRAINTS(CATENA_MATCH)
  return found;
}

/// Position of the element type E in the list of force types, or -1.
template <class S, class E>
consteval int force_type() {
  int found = -1, k = 0;
  CATENA_ALL_FORCES(CATENA_MATCH)
#undef CATENA_MATCH
  return found;
}

/// Moves the local points of an element from the authors' frames to the centroidal ones.
template <class E, class S>
void shift_points(E& element, const Vec2<S>& origin_i, const Vec2<S>& origin_j) {
  std::apply(
      [&](const auto&... field) {
        (
            [&] {
              if constexpr (requires {
                              element.*field.member += origin_i;
                              field.body;
                            }) {
                if constexpr (requires { field.required; })
                  return;  // an axis: directions do not shift
                else
                  element.*field.member += field.body == 0 ? origin_i : origin_j;
              }
            }(),
            ...);
      },
      E::fields());
}

/// Whether a member of an element is a number, or a pair of numbers, that is not finite; bounds may be infinite.
template <class S>
bool is_unusable(const S& number) {
  if constexpr (requires { value_of(number); }) {
    return std::isnan(value_of(number));
  } else if constexpr (requires { value_of(number.x); }) {
    return !std::isfinite(value_of(number.x)) || !std::isfinite(value_of(number.y));
  } else {
    return false;
  }
}

/// Throws for a number that is not finite, naming its field.
template <class E>
void check_numbers(const E& element) {
  const E omitted{};  // an initial NaN stands for: not given
  const auto look = [&](const auto& field) {
    if constexpr (requires { element.*field.member; }) {
      if (is_unusable(element.*field.member) && !is_unusable(omitted.*field.member))
        throw ModelError(std::string(E::type) + ": " + std::string(field.key) + " is not finite");
    }
  };
  std::apply([&](const auto&... field) { (look(field), ...); }, E::fields());
  if constexpr (requires { E::keys(); }) {
    std::apply([&](const auto&... field) { (look(field), ...); }, E::keys());
  }
}

/// Throws for a value of a constraint that is not finite, or that makes its equation vanish.
template <class E, class S>
void check_value(const S& value) {
  if (!std::isfinite(value_of(value))) throw ModelError(std::string(E::type) + ": its value is not finite");
  if constexpr (HasSquaredValue<E>) {
    if (!(value > S(0))) {
      throw ModelError(std::string(E::type) +
                       " needs a distance above zero; for zero use a revolute joint or absolute_x and absolute_y");
    }
  }
}

}  // namespace detail

template <class S>
template <class E>
ElementEntry<E, S> BasicModel<S>::place(const E& element, int i, int j) const {
  require_body(i);
  require_body(j);
  detail::check_numbers(element);
  if (i == j) throw ModelError(std::string(E::type) + " ties body \"" + std::string(body_name(i)) + "\" to itself");
  if (E::bodies == 1 && i == ground) throw ModelError(std::string(E::type) + " needs a body, not the ground");
  ElementEntry<E, S> entry{element, i, j};
  const auto origin = [&](int body) { return body < 0 ? Vec2<S>{} : bodies[static_cast<std::size_t>(body)].origin; };
  detail::shift_points(entry.element, origin(i), origin(j));
  if constexpr (requires { entry.element.complete(Frame<S>{}, Frame<S>{}); }) {
    const auto [frame_i, frame_j] = given_frames<E>(*this, i, j);
    entry.element.complete(frame_i, frame_j);
  }
  if constexpr (requires { entry.element.check(); }) {
    if (const char* wrong = entry.element.check()) throw ModelError(std::string(E::type) + ": " + wrong);
  }
  return entry;
}

template <class S>
template <class E>
int BasicModel<S>::append(std::string_view name, const ElementEntry<E, S>& entry, ElementKind kind) {
  constexpr int constraint = detail::constraint_type<S, E>(), force = detail::force_type<S, E>();
  static_assert(constraint >= 0 || force >= 0, "the element type is not in elements/list.hpp");
  constexpr bool is_force = force >= 0;
  constexpr int type = is_force ? force : constraint;
  auto& list = [this]() -> auto& {
    if constexpr (is_force) {
      return std::get<static_cast<std::size_t>(type)>(forces);
    } else {
      return std::get<static_cast<std::size_t>(type)>(constraints);
    }
  }
  ();
  require_body(entry.i);
  require_body(entry.j);
  const int id = static_cast<int>(elements.size());
  const int number = claim_name(name, -2 - id);
  // Cables, and ropes, are counted as one type, elastic or not; of an elastic rope only its first element.
  constexpr bool rope = std::is_same_v<E, ElasticRope<S>>, elastic = rope || std::is_same_v<E, ElasticCable<S>>;
  constexpr int counted = rope      ? detail::constraint_type<S, Rope<S>>()
                          : elastic ? detail::constraint_type<S, Cable<S>>()
                                    : type;
  bool counts_as_one = true;
  if constexpr (rope) counts_as_one = entry.element.pieces > 0;
  std::vector<int>& counts = is_force && !elastic ? force_count_ : constraint_count_;
  counts.resize(std::max(counts.size(), static_cast<std::size_t>(counted) + 1));
  const ElementKind stored = is_force ? ElementKind::force : OneSided<E> ? ElementKind::gap : kind;
  elements.push_back({stored, static_cast<short>(type), static_cast<int>(list.size()), number,
                      counts_as_one ? ++counts[static_cast<std::size_t>(counted)] : 0});
  list.push_back(entry);
  list.back().id = id;
  return id;
}

/// Joints that may have viscous damping.
template <class E>
concept HasDamping = E::rows == 2 && requires(const E& joint) {
  joint.c;
};

/// Whether the joint has any: c = 0 is damping, with a derivative.
template <class E>
requires HasDamping<E>
bool is_damped(const E& joint) { return !std::isnan(value_of(joint.c)); }

/// Gives a joint with damping a force of its own, without a name.
template <class E, class S>
void add_damping(BasicModel<S>& model, const ElementEntry<E, S>& joint) {
  if (!is_damped(joint.element)) return;
  model.append({}, ElementEntry<JointDamper<S>, S>{damper_of<S>(joint.element), joint.i, joint.j}, ElementKind::force);
}

template <class S>
template <class E>
int BasicModel<S>::add(std::string_view name, const E& element, int i, int j) {
  ElementEntry<E, S> entry = place(element, i, j);
  if constexpr (E::functions == 1 && when_omitted<E>() == Omitted::given) {
    const auto [frame_i, frame_j] = given_frames<E>(*this, i, j);
    entry.values[0].constant = entry.element.measure(frame_i, frame_j);
    detail::check_value<E>(entry.values[0].constant);
  }
  const int id = append(name, entry, ElementKind::constraint);
  if constexpr (HasDamping<E>) add_damping(*this, entry);
  return id;
}

template <class S>
template <class E>
int BasicModel<S>::add(std::string_view name, const E& element, int i, int j, const S& value) {
  static_assert(E::functions == 1, "this constraint has no value");
  ElementEntry<E, S> entry = place(element, i, j);
  detail::check_value<E>(value);
  entry.values[0].constant = value;
  return append(name, entry, ElementKind::constraint);
}

template <class S>
template <class E>
int BasicModel<S>::add_driver(std::string_view name, const E& element, int i, int j, const TimeFunction<S>& value) {
  static_assert(E::functions == 1 && E::rows == 1, "only a scalar constraint with a value can be driven");
  ElementEntry<E, S> entry = place(element, i, j);
  entry.values[0].function = static_cast<int>(functions.size());
  functions.push_back(value);
  return append(name, entry, ElementKind::driver);
}

template <class S>
template <class E>
int BasicModel<S>::add_force(std::string_view name, const E& element, int i, int j,
                             std::initializer_list<TimeFunction<S>> values) {
  static_assert(detail::force_type<S, E>() >= 0, "not a force element");
  if (values.size() > static_cast<std::size_t>(E::functions)) {
    throw ModelError(std::string(E::type) + " reads fewer functions of time than were given");
  }
  ElementEntry<E, S> entry = place(element, i, j);
  std::size_t k = 0;
  for (const TimeFunction<S>& value : values) {
    if (value.is_constant()) {
      entry.values[k].constant = value.evaluate(0.0).f;
      if (!std::isfinite(value_of(entry.values[k].constant)))
        throw ModelError(std::string(E::type) + ": a value is not finite");
    } else {
      entry.values[k].function = static_cast<int>(functions.size());
      functions.push_back(value);
    }
    ++k;
  }
  return append(name, entry, ElementKind::force);
}

}  // namespace catena
