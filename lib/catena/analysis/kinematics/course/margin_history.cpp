#include "catena/analysis/kinematics/course/margin_history.hpp"

#include <algorithm>
#include <cmath>

#include "catena/analysis/kinematics/course/step_rules.hpp"

namespace catena {
namespace {

// Where a block has no determinant its pivot is used, and must also fall below this part of its largest value so far.
constexpr double small_part = 0.3;

}  // namespace

void MarginHistory::forget() {
  last_.clear();
  largest_.clear();
}

void MarginHistory::take(std::span<const BlockMargin> margins, double t) {
  const bool continued = last_.size() == margins.size() && t != t_;
  const double per_time = continued ? 1 / std::abs(t - t_) : 0;
  rates_.assign(margins.size(), 0.0);
  for (std::size_t k = 0; k < margins.size() && continued; ++k) {
    rates_[k] = (std::abs(margins[k].determinant) - std::abs(last_[k].determinant)) * per_time;
  }
  last_.assign(margins.begin(), margins.end());
  t_ = t;
  if (largest_.size() != last_.size()) largest_.assign(last_.size(), 0.0);
  for (std::size_t k = 0; k < last_.size(); ++k) largest_[k] = std::max(largest_[k], std::abs(last_[k].pivot));
}

// A determinant of its own counts at any size; a pivot in its place may be small elsewhere too.
bool MarginHistory::is_small(std::span<const BlockMargin> margins, std::size_t block) const {
  const BlockMargin& margin = margins[block];
  return margin.pivot != margin.determinant || std::abs(margin.pivot) < small_part * largest_[block];
}

bool MarginHistory::heads_for_singularity(double h) const {
  bool heads = false;
  for (std::size_t k = 0; k < last_.size(); ++k) {
    const double determinant = std::abs(last_[k].determinant);
    heads |= is_small(last_, k) && determinant + h * rates_[k] < step_rules::remaining_part * determinant;
  }
  return heads;
}

MarginHistory::Change MarginHistory::change_to(std::span<const BlockMargin> margins) const {
  Change change;
  if (margins.size() != last_.size()) return change;
  for (std::size_t k = 0; k < margins.size(); ++k) {
    change.crossed |= (margins[k].pivot < 0) != (last_[k].pivot < 0);
    change.dipped |= is_small(margins, k) &&
                     std::abs(margins[k].determinant) < step_rules::sudden_part * std::abs(last_[k].determinant);
  }
  return change;
}

bool MarginHistory::has_fallen(std::span<const BlockMargin> margins, double part) const {
  for (std::size_t k = 0; k < margins.size() && k < largest_.size(); ++k) {
    if (std::abs(margins[k].pivot) < part * largest_[k]) return true;
  }
  return false;
}

}  // namespace catena
