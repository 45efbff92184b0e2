#include "catena/analysis/kinematics/course/contact_jumps.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "catena/base/at.hpp"
#include "catena/elements/all.hpp"

namespace catena {
namespace {

// Of a curve: what a way may be longer or shorter than foretold, and the second half of a way than the first. Where a
// place ceases, distances to the curve at the old and the new one differ by the fourth power of the jump, in sizes of
// the curve: what is passed moves nothing by more than 1e-12.
constexpr double unforeseen = 1e-3;

/// From one place to another by the shorter way round; zero where a curve is not known, or a place is not.
double way(double from, double to, double range) {
  const double d = to - from;
  return range > 0 && std::isfinite(d) ? d - range * std::round(d / range) : 0;
}

bool is_uneven(double first, double second, double range) { return std::abs(second - first) > unforeseen * range; }

}  // namespace

ContactJumps::ContactJumps(const Model& model) {
  for_each_list(model.constraints, [&](const auto& list, int) {
    using E = ElementOf<decltype(list)>;
    if constexpr (SearchesCurve<E>) {
      for (const auto& entry : list) {
        ranges_.resize(std::max(ranges_.size(), at(entry.id) + 1));
        if constexpr (HasCurve<E>) {
          const auto take = [&](const auto& field) {
            if constexpr (std::is_same_v<std::remove_cvref_t<decltype(entry.element.*field.member)>,
                                         BodyCurve<double>>) {
              const BodyCurve<double>& curve = entry.element.*field.member;
              if (curve && !curve.is_line())
                (field.body == 0 ? ranges_[at(entry.id)].i : ranges_[at(entry.id)].j) = curve.range();
            }
          };
          std::apply([&](const auto&... field) { (take(field), ...); }, E::fields());
        }
      }
    }
  });
}

bool ContactJumps::may_jump(std::span<const CurvePlace> begin, std::span<const CurvePlace> end, double h) const {
  const auto is_new = [&](double d, double range, const std::vector<double>& speed, std::size_t k) {
    return std::abs(d - (k < speed.size() ? h * speed[k] : 0)) > unforeseen * range;
  };
  for (std::size_t k = 0; k < std::min(begin.size(), end.size()); ++k) {
    const Ranges& range = ranges_[at(begin[k].element)];
    if (is_new(way(begin[k].s_i, end[k].s_i, range.i), range.i, speed_i_, k) ||
        is_new(way(begin[k].s_j, end[k].s_j, range.j), range.j, speed_j_, k))
      return true;
  }
  return false;
}

int ContactJumps::jumping(std::span<const CurvePlace> begin, std::span<const CurvePlace> middle,
                          std::span<const CurvePlace> end) const {
  for (std::size_t k = 0; k < begin.size(); ++k) {
    const Ranges& range = ranges_[at(begin[k].element)];
    if (is_uneven(way(begin[k].s_i, middle[k].s_i, range.i), way(middle[k].s_i, end[k].s_i, range.i), range.i) ||
        is_uneven(way(begin[k].s_j, middle[k].s_j, range.j), way(middle[k].s_j, end[k].s_j, range.j), range.j))
      return begin[k].element;
  }
  return -1;
}

void ContactJumps::accept(std::span<const CurvePlace> begin, std::span<const CurvePlace> end, double h) {
  speed_i_.assign(begin.size(), 0.0);
  speed_j_.assign(begin.size(), 0.0);
  for (std::size_t k = 0; k < begin.size() && h != 0; ++k) {
    const Ranges& range = ranges_[at(begin[k].element)];
    speed_i_[k] = way(begin[k].s_i, end[k].s_i, range.i) / h;
    speed_j_[k] = way(begin[k].s_j, end[k].s_j, range.j) / h;
  }
}

}  // namespace catena
