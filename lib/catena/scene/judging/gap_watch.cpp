#include "catena/scene/judging/gap_watch.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace catena {
namespace {

// Of the length scale, or rad: positions meet constraints to less.
constexpr double overlap = 1e-9;
constexpr std::size_t most = 10;

/// How far the element is violated at the evaluator's configuration; 0 where it is not.
double depth_of(const Evaluator& evaluator, int element) {
  const double depth = -evaluator.measure(element, {}, {}).value;
  return depth > overlap * evaluator.length_scale() ? depth : 0;
}

void tell_of_others(std::size_t violated, std::vector<std::string>& sentences) {
  if (violated > most) sentences.push_back(fmt::format("{} more one-sided elements are violated", violated - most));
}

}  // namespace

GapWatch::GapWatch(const Model& model) : model_(model) {
  for (const int element : model.gaps()) worst_.push_back({element});
}

void GapWatch::observe(const Snapshot& row) {
  for (Worst& worst : worst_) {
    const double depth = depth_of(row.evaluator, worst.element);
    if (!(depth > 0)) continue;
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
  tell_of_others(static_cast<std::size_t>(violated), sentences);
  return sentences;
}

std::vector<std::string> violated_gaps(const Evaluator& evaluator) {
  const Model& model = evaluator.model();
  std::vector<std::string> sentences;
  std::size_t violated = 0;
  for (const int element : model.gaps()) {
    const double depth = depth_of(evaluator, element);
    if (!(depth > 0) || ++violated > most) continue;
    sentences.push_back(fmt::format("{} \"{}\" is violated by {:.3g} here: assembly leaves one-sided elements out",
                                    model.element_type(element), model.element_name(element), depth));
  }
  tell_of_others(violated, sentences);
  return sentences;
}

}  // namespace catena
