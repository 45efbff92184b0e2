#include "catena/analysis/sensitivity/phases/smooth_parts.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "catena/base/at.hpp"

namespace catena {
namespace {

// A depth that doubles within a part is zero as far from it as the part is long: polynomials follow its powers there.
constexpr double most_ratio = 2;
// (1/2)^30 = 1e-9.
constexpr double halvings_by_exponent = 30;

using Depths = std::vector<double>;

/// Halves what is not smooth, earlier parts first.
class Halving {
 public:
  Halving(const MotionStretch& stretch, const std::vector<PowerPlace>& places) : stretch_(stretch), places_(places) {}

  std::vector<double> ends() {
    const auto from = depths(stretch_.from), to = depths(stretch_.to);
    if (!from || !to || !divide({stretch_.from, *from}, {stretch_.to, *to}, 0)) return {};
    return std::move(ends_);
  }

 private:
  struct Look {
    double t;
    Depths depth;
  };

  std::optional<Depths> depths(double t) const {
    const std::optional<Snapshot> there = stretch_.at(t);
    if (!there) return {};
    Depths depth;
    for (const PowerPlace& place : places_)
      depth.push_back(std::max(-there->evaluator.measure(place.element, {}, {}).value, 0.0));
    return depth;
  }

  bool is_smooth(const Look& a, const Look& middle, const Look& b, int halvings) const {
    for (std::size_t k = 0; k < places_.size(); ++k) {
      const auto [least, most] = std::minmax({a.depth[k], middle.depth[k], b.depth[k]});
      if (most > most_ratio * least && halvings * places_[k].exponent < halvings_by_exponent) return false;
    }
    return true;
  }

  bool divide(const Look& a, const Look& b, int halvings) {
    Look middle{a.t + (b.t - a.t) / 2, {}};
    auto there = depths(middle.t);
    if (!there) return false;
    middle.depth = std::move(*there);
    if (is_smooth(a, middle, b, halvings) || !(middle.t > a.t && middle.t < b.t)) {
      ends_.push_back(b.t);
      return true;
    }
    return divide(a, middle, halvings + 1) && divide(middle, b, halvings + 1);
  }

  const MotionStretch& stretch_;
  const std::vector<PowerPlace>& places_;
  std::vector<double> ends_;
};

bool is_whole(const DesignScalar& exponent) {
  return exponent.v == std::round(exponent.v) &&
         std::all_of(exponent.d.begin(), exponent.d.end(), [](double d) { return d == 0; });
}

}  // namespace

std::vector<PowerPlace> power_places(const ContactModel& contacts, const std::vector<ContactState>& states,
                                     const std::vector<std::vector<DesignPlace>>& places) {
  std::vector<PowerPlace> found;
  for (std::size_t k = 0; k < states.size(); ++k) {
    const ContactPoint& point = contacts.points[k];
    if (point.kind != ContactKind::compliant || !states[k].closed) continue;
    const bool whole = std::all_of(places.begin(), places.end(), [k](const std::vector<DesignPlace>& of_group) {
      return is_whole(of_group[k].exponent);
    });
    if (!whole) found.push_back({point.element, point.exponent});
  }
  return found;
}

std::vector<double> smooth_parts(const MotionStretch& stretch, const std::vector<PowerPlace>& places) {
  if (places.empty()) return {stretch.to};
  return Halving(stretch, places).ends();
}

}  // namespace catena
