#include "catena/scene/judging/rope_check.hpp"

#include <fmt/format.h>

#include <numbers>

#include "catena/assembly/rope_ways.hpp"
#include "catena/elements/all.hpp"

namespace catena {
namespace {

constexpr std::size_t most_rope_sentences = 5;
// A rope round a pulley turns by up to half a turn and what its ends lean; a loop crosses itself.
constexpr double loop = 1.5 * std::numbers::pi;

}  // namespace

std::vector<std::string> ropes_in_loops(const Model& model) {
  std::vector<std::string> doubts;
  const auto look = [&](int element) {
    const double contact = widest_contact(model, element);
    if (!(contact > loop) || doubts.size() == most_rope_sentences) return;
    doubts.push_back(
        fmt::format("rope \"{}\" winds {:.4g} rad round a pulley as given: if it is to lie beside it, give the other "
                    "\"side\", or leave the pulley out",
                    model.element_name(element), contact));
  };
  for (const auto& entry : std::get<std::vector<ElementEntry<Rope<double>, double>>>(model.constraints)) look(entry.id);
  for (const auto& entry : std::get<std::vector<ElementEntry<ElasticRope<double>, double>>>(model.forces)) {
    if (entry.element.pieces > 0) look(entry.id);
  }
  return doubts;
}

}  // namespace catena
