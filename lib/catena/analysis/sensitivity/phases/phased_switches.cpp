// PhasedDerivatives: across instants at which laws of state switch.
#include "catena/analysis/sensitivity/phases/phased_derivatives.hpp"
#include "catena/base/at.hpp"

namespace catena {

bool PhasedDerivatives::cover_between(const MotionStretch& stretch, std::span<const double> ends,
                                      const Switches& switches) {
  const auto rate = [](const MotionStretch& some, const auto& f) { return rate_at_end(some, f); };
  SwitchInstants::Carrier carrier{evaluator(), {}, {}, {}, [this] { keep_part(); }, rate};
  for (std::size_t k = 0; k < tracks_.size(); ++k)
    carrier.groups.push_back({groups()[k].mechanism, tracks_[k].end, DesignVector(2 * n_), at(groups()[k].count)});
  carrier.find_slopes = [&](double t) {
    const Side side = t == stretch.to ? Side::before : Side::after;
    if (!factorize(t, side, tracks_.front().end)) return singular(t);
    for (std::size_t k = 0; k < tracks_.size(); ++k) {
      if (!slope(k, t, side, tracks_[k].end, carrier.groups[k].slope)) return singular(t);
    }
    return true;
  };
  carrier.take = [&](double to) { return step_on(to) && project(to_, Side::before, &Track::end); };
  auto next = switches.begin();
  std::vector<double> all;
  for (const double end : ends) {
    for (; next != switches.end() && next->before < end; ++next) {
      std::string trouble;
      const std::optional<double> behind = switches_.pass(*next, stretch, to_, carrier, trouble);
      if (!behind) return fail(std::move(trouble));
      from_ = to_ = *behind;
      has_.step = has_.interpolant = false;
      all.push_back(*behind);
    }
    if (to_ < end && !cover_in_parts(stretch, end)) return false;
    if (all.empty() || all.back() < end) all.push_back(end);
  }
  take_parts(std::move(all));
  return true;
}

}  // namespace catena
