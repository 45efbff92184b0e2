#include "catena/scene/judging/idle_keys.hpp"

#include <fmt/format.h>

#include "catena/elements/all.hpp"

namespace catena {
namespace {

constexpr std::size_t most_idle_sentences = 5;

/// What is wrong with the keys of an element, empty where nothing is.
template <class E>
std::string idle_keys_of(const E& e) {
  if constexpr (Dry<E>) {
    if (e.vs > 0 && e.mu_static > e.mu) return "\"mu_static\" has no effect beside \"vs\": nothing sticks";
    if (e.turns && e.length > 0) return "\"length\" has no effect: it is of the guide of a translational joint";
    if (!e.turns && e.radius > 0) return "\"radius\" has no effect: it is of the pin of a revolute joint";
  } else if constexpr (requires { e.exponent; }) {
    const bool rigid = !(e.k > 0);
    if (rigid && e.c > 0) return "\"c\" has no effect without \"k\": it is rigid, with impacts";
    if (rigid && e.exponent != 1) return "\"exponent\" has no effect without \"k\": it is rigid, with impacts";
    if (!rigid && e.restitution > 0)
      return "\"restitution\" has no effect beside \"k\": what is elastic has no impacts";
    if constexpr (requires { e.vs; }) {
      if (e.vs > 0 && e.mu_static > e.mu) return "\"mu_static\" has no effect beside \"vs\": nothing sticks";
    }
  }
  return {};
}

}  // namespace

std::vector<std::string> keys_without_effect(const Model& model) {
  std::vector<std::string> doubts;
  const auto look = [&]<class E>(const std::vector<ElementEntry<E, double>>& list) {
    for (const auto& entry : list) {
      const std::string idle = idle_keys_of(entry.element);
      if (idle.empty() || doubts.size() == most_idle_sentences) continue;
      doubts.push_back(fmt::format("{} \"{}\": {}", E::type, model.element_name(entry.id), idle));
    }
  };
  look(std::get<std::vector<ElementEntry<Contact<double>, double>>>(model.constraints));
  look(std::get<std::vector<ElementEntry<Stop<double>, double>>>(model.constraints));
  look(std::get<std::vector<ElementEntry<Friction<double>, double>>>(model.constraints));
  return doubts;
}

}  // namespace catena
