#include "catena/analysis/events/law_stretches.hpp"

#include <algorithm>
#include <iterator>
#include <limits>

namespace catena {
namespace {

// All stretches are looked at this far down, whatever longer ones look like: 32 of nine samples each.
constexpr int least_law_halvings = 5;
// A jump of a law is enclosed to a thousandth of the run; the error of the step that meets it does the rest.
constexpr int most_law_halvings = 10;
constexpr double foreseen = 1e-3;
constexpr double stretches_in_a_step = 4;

bool reads_time(const CompiledLaw<double>& law) {
  return std::any_of(law.inputs.begin(), law.inputs.end(),
                     [](const LawInput<double>& input) { return input.kind == ColumnKind::time; });
}

}  // namespace

bool LawStretches::any(const Evaluator& evaluator) {
  return std::any_of(evaluator.laws().begin(), evaluator.laws().end(), reads_time);
}

LawStretches::LawStretches(Evaluator& evaluator, std::span<const double> qd, double from, double to)
    : from_(from), to_(to) {
  for (std::size_t k = 0; k < evaluator.laws().size(); ++k) {
    if (reads_time(evaluator.laws()[k])) laws_.push_back(static_cast<int>(k));
  }
  if (laws_.empty() || !(from < to)) return;
  taken_.begin(laws_.size());
  constexpr int instants = EventSamples::parts << least_law_halvings;
  std::vector<double> values(laws_.size()), least(laws_.size(), std::numeric_limits<double>::max());
  std::vector<double> most(laws_.size(), std::numeric_limits<double>::lowest());
  for (int n = 0; n <= instants; ++n) {
    sample(evaluator, qd, n == instants ? to : from + (to - from) * n / instants, values);
    for (std::size_t k = 0; k < values.size(); ++k) {
      least[k] = std::min(least[k], values[k]);
      most[k] = std::max(most[k], values[k]);
    }
  }
  for (std::size_t k = 0; k < laws_.size(); ++k) ranges_.push_back(most[k] - least[k]);
  divide(evaluator, qd, from, to, 0);
  double reach = std::numeric_limits<double>::infinity();
  for (auto stretch = stretches_.rbegin(); stretch != stretches_.rend(); ++stretch) {
    reach = std::min(reach, stretch->begin + stretches_in_a_step * stretch->length);
    stretch->reach = reach;
  }
}

void LawStretches::sample(Evaluator& evaluator, std::span<const double> qd, double t, std::span<double> values) const {
  evaluator.set_time(t);
  for (std::size_t k = 0; k < laws_.size(); ++k) values[k] = evaluator.law_value(laws_[k], qd);
}

bool LawStretches::is_foretold(Evaluator& evaluator, std::span<const double> qd, double from, double to) {
  for (int n = 0; n <= EventSamples::parts; ++n)
    sample(evaluator, qd, EventSamples::instant(from, to, n), taken_.at(n));
  for (std::size_t k = 0; k < laws_.size(); ++k) {
    if (taken_.miss(k) > foreseen * ranges_[k]) return false;
  }
  return true;
}

// Appends the longest stretches that show what laws do.
void LawStretches::divide(Evaluator& evaluator, std::span<const double> qd, double from, double to, int halvings) {
  const double middle = from + (to - from) / 2;
  const std::size_t before = stretches_.size();
  const bool small = halvings >= least_law_halvings;
  if (halvings == most_law_halvings || (small && is_foretold(evaluator, qd, from, to))) {
    stretches_.push_back({from, to - from, 0});
    return;
  }
  divide(evaluator, qd, from, middle, halvings + 1);
  divide(evaluator, qd, middle, to, halvings + 1);
  if (small || stretches_.size() != before + 2 || !is_foretold(evaluator, qd, from, to)) return;
  stretches_.resize(before);
  stretches_.push_back({from, to - from, 0});
}

double LawStretches::limit(double t) const {
  const auto next = std::upper_bound(stretches_.begin(), stretches_.end(), t,
                                     [](double instant, const Stretch& stretch) { return instant < stretch.begin; });
  double limit = next == stretches_.end() ? std::numeric_limits<double>::infinity() : next->reach;
  if (next != stretches_.begin()) limit = std::min(limit, t + stretches_in_a_step * std::prev(next)->length);
  return limit;
}

}  // namespace catena
