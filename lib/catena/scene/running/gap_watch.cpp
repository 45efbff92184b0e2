#include "catena/scene/running/gap_watch.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace catena {
namespace {

// Of the length scale, or rad: positions meet constraints to less.
constexpr double overlap = 1e-9;
constexpr std::size_t most = 10;

}  // namespace

GapWatch::GapWatch(const Model& model) : model_(model) {
  for (const int element : model.gaps()) worst_.push_back({element});
}

void GapWatch::observe(const Snapshot& row) {
  for (Worst& worst : worst_) {
    const double depth = -row.evaluator.measure(worst.element, {}, {}).value;
    if (depth <= overlap * row.evaluator.length_scale()) continue;
    if (worst.depth == 0) worst.first = row.t;
    if (depth > worst.depth) worst.depth = depth, worst.t = row.t;
  }
}

std::vector<std::string> GapWatch::warnings() const {
  std::vector<std::string> sentences;
  const auto violated = std::count_if(worst_.begin(), worst_.end(), [](const Worst& w) { return w.depth > 0; });
  for (const Worst& worst : worst_) {
    if (!(worst.depth > 0) || sentences.size() == most) continue;
    sentences.push_back(fmt::format(
        "{} \"{}\" is violated from t = {:.6g} s, by up to {:.4g} (at t = {:.6g} s): the drivers move on "
        "regardless",
        model_.element_type(worst.element), model_.element_name(worst.element), worst.first, worst.depth, worst.t));
  }
  if (violated > static_cast<std::ptrdiff_t>(most))
    sentences.push_back(
        fmt::format("{} more one-sided elements are violated", violated - static_cast<std::ptrdiff_t>(most)));
  return sentences;
}

}  // namespace catena
