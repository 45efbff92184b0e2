// Storage for elements: one vector per type, reached by type, never through a base class.
#pragma once

#include <array>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "catena/elements/list.hpp"
#include "catena/model/body.hpp"

namespace catena {

/// A value that may be a function of time or, of a force, a law of state: the constant, or the number of a function or
/// law in the model.
template <class S>
struct FunctionValue {
  S constant{};
  int function = -1;  ///< -1: constant, or a law
  int law = -1;
};

/// An element where it stands: which bodies it ties (ground = -1) and the values of its functions of time.
template <class E, class S>
struct ElementEntry {
  using Element = E;
  using Scalar = S;
  E element{};
  int i = ground, j = ground;
  int id = -1;  ///< number in the model's list of elements, file order
  [[no_unique_address]] std::array<FunctionValue<S>, static_cast<std::size_t>(E::functions)> values{};
};

namespace detail {

template <class... Lists>
struct DropFirst;
template <class First, class... Lists>
struct DropFirst<First, Lists...> {
  using type = std::tuple<Lists...>;
};

// The macro lists begin every type with a comma, hence the `void` that is dropped again.
#define CATENA_LIST_OF(Type) , std::vector<ElementEntry<Type<S>, S>>
template <class S>
struct ConstraintLists {
  using type = typename DropFirst<void CATENA_ALL_CONSTRAINTS(CATENA_LIST_OF)>::type;
};
template <class S>
struct ForceLists {
  using type = typename DropFirst<void CATENA_ALL_FORCES(CATENA_LIST_OF)>::type;
};
#undef CATENA_LIST_OF

}  // namespace detail

/// std::tuple of the vectors of all constraint types over the parameter scalar S.
template <class S>
using ConstraintLists = typename detail::ConstraintLists<S>::type;
/// std::tuple of the vectors of all force types.
template <class S>
using ForceLists = typename detail::ForceLists<S>::type;

/// Calls f(list, type_index) for the vector of every type.
template <class Lists, class F>
void for_each_list(Lists& lists, F&& f) {
  [&]<std::size_t... K>(std::index_sequence<K...>) { (f(std::get<K>(lists), static_cast<int>(K)), ...); }
  (std::make_index_sequence<std::tuple_size_v<std::remove_const_t<Lists>>>{});
}

/// Calls f(list) for the vector of type number `type`.
template <class Lists, class F>
void with_list(Lists& lists, int type, F&& f) {
  for_each_list(lists, [&](auto& list, int k) {
    if (k == type) f(list);
  });
}

/// Calls f(first_list, second_list, type_index) for every type, of two tuples over the same types. To reach the second
/// by with_list() instead would compile f for every pair of types.
template <class First, class Second, class F>
void for_each_list(First& first, Second& second, F&& f) {
  [&]<std::size_t... K>(std::index_sequence<K...>) {
    (f(std::get<K>(first), std::get<K>(second), static_cast<int>(K)), ...);
  }
  (std::make_index_sequence<std::tuple_size_v<std::remove_const_t<First>>>{});
}

/// The element type stored in a list.
template <class List>
using ElementOf = typename std::remove_cvref_t<List>::value_type::Element;

}  // namespace catena
