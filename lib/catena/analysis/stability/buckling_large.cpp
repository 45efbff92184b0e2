// Buckling of mechanisms too large for dense algebra: by Lanczos' method, where the load does not enter linearly by the
// inertia of K(p).
//
//   K0^-1 (K0 - K(p1)) v = theta v,   p = p0 + (p1 - p0) / theta        exact where K is linear in p
//   negative eigenvalues of K(p) on the null space of Phi_q: their number changes where a load is passed
//
// A first step that changes K by a few percent gives estimates. A second one at the nearest of them shows whether K is
// linear in p: then it gives all loads. Else both sides are searched outwards together, in steps as those of dense
// algebra (load_search.hpp); a change of the number is bisected, and what is left solved for by the secant rule: a step
// p1 equal to a load gives theta = 1. Two loads between samples that undo
// each other are not seen.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "catena/analysis/run/thresholds.hpp"
#include "catena/analysis/spectrum/free_motions.hpp"
#include "catena/analysis/spectrum/modes_operator.hpp"
#include "catena/analysis/stability/buckling.hpp"
#include "catena/analysis/stability/load_search.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// Effects on K below this part of the largest are none.
constexpr double smallest_effect = 1e-12;
constexpr double linear_part = 1e-9;
// Part of its distance to which a load is bracketed by the inertia: that of regularised factors is wrong within some
// 1e-6 of it.
constexpr double bracketed = 1e-4;

// K0^-1 (K0 - K1) in the metric K0, K0 the factored K of the system's matrix.
class BucklingOperator final : public SpectralOperator {
 public:
  BucklingOperator(StaticSystem& system, const KktMatrix& loaded)
      : system_(system), loaded_(loaded), weight_(length_weights(system)) {
    for (double w : weight_) typical_.push_back(1 / std::sqrt(w));
    given_.resize(weight_.size() + at(system.plan().rows));
    solution_.resize(given_.size());
    correction_.resize(given_.size());
    product_.resize(weight_.size());
  }

  int columns() const override { return static_cast<int>(weight_.size()); }
  std::span<const double> typical() const override { return typical_; }
  void metric(std::span<const double> v, std::span<double> Gv) override { system_.matrix().multiply_stiffness(v, Gv); }
  void invert(std::span<double> v) override {
    std::fill(given_.begin(), given_.end(), 0.0);
    const std::span<double> top{given_.data(), v.size()};
    metric(v, top);
    loaded_.multiply_stiffness(v, product_);
    for (std::size_t c = 0; c < v.size(); ++c) top[c] -= product_[c];
    solve_to_rounding(system_, weight_, given_, solution_, correction_);
    std::copy_n(solution_.begin(), v.size(), v.begin());
  }
  void project(std::span<double> v) override { project_to_null_space(system_, v, solution_); }

 private:
  StaticSystem& system_;
  const KktMatrix& loaded_;
  std::vector<double> weight_, typical_, given_, solution_, correction_, product_;
};

// Positions of the `count` largest in size, or by value; none while there are fewer.
std::vector<int> largest_ones(std::span<const double> theta, int count, bool by_value) {
  if (static_cast<int>(theta.size()) < count) return {};
  std::vector<int> order(theta.size());
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = static_cast<int>(k);
  const auto rank = [&](int k) { return by_value ? theta[at(k)] : std::abs(theta[at(k)]); };
  std::sort(order.begin(), order.end(), [&](int a, int b) { return rank(a) > rank(b); });
  order.resize(at(count));
  return order;
}

}  // namespace

Report Buckling::find_with(double step, int count, bool by_value, std::vector<Load>& loads, double& effect,
                           const std::function<bool()>& go_on) {
  loads.clear();
  KktMatrix other(plan_, system_.radius());
  if (Report outcome = stiffness_at(options_.present + step, other); !outcome.ok()) return outcome;
  const StiffnessFloor floor = floor_under_load();
  if (!path_.factorize(point_)) return not_stable();
  if (const auto stability = path_.stability(); !stability || stability->negative > 0) return not_stable();
  const StiffnessFloor own(system_, point_.lambda, 0);
  BucklingOperator op(system_, other);
  Lanczos lanczos(op);
  const auto wanted = [&](std::span<const double> theta) { return largest_ones(theta, count, by_value); };
  const int most = std::min(plan_->columns, Lanczos::most_vectors(count));
  const bool settled = lanczos.run(wanted, most, go_on);
  if (go_on && !go_on()) return {Status::cancelled, "stopped while loads were looked for", {}};
  if (!settled && !lanczos.exhausted()) {
    return {Status::not_converged,
            fmt::format("{} loads did not settle within {} steps of Lanczos' method; ask for fewer", count, most),
            {}};
  }
  // The metric is K0: what it cannot tell from rounding in a shape is a part of one.
  std::vector<std::vector<double>> free;
  for (int k : largest_ones(lanczos.theta(), std::min(count, static_cast<int>(lanczos.theta().size())), by_value)) {
    if (own(lanczos.vector(k)) >= 1) free.push_back(lanczos.vector(k));
  }
  if (!free.empty()) return neutral(static_cast<int>(free.size()), names_of_moving(system_, point_.lambda, free));
  effect = 0;
  const int found = std::min(count, static_cast<int>(lanczos.theta().size()));
  for (int k : largest_ones(lanczos.theta(), found, by_value)) {
    const double theta = lanczos.theta()[at(k)];
    std::vector<double> shape = lanczos.vector(k);
    // The metric is K0: v^T (K0 - K1) v is theta itself.
    if (!(std::abs(theta) > std::max(smallest_effect * effect, floor(shape)))) continue;
    effect = std::max(effect, std::abs(theta));
    loads.push_back({step / theta, std::move(shape)});
  }
  return {};
}

// The loads by the first step that changes the stiffness visibly, to the side that the scene allows, and the length of
// that step; none where no step does. `within`: nor by more than the first load allows, which linear loads do not need.
Report Buckling::find_first_loads(bool within, std::vector<Load>& loads, double& step,
                                  const std::function<bool()>& go_on) {
  FirstLoadStep first(step > 0 ? 10 * step : options_.present);
  double side = 1, effect = 0;
  for (int k = 0; k < thresholds::most_bisections && std::isfinite(first.step()); ++k) {
    step = first.step();
    Report pass = find_with(side * step, options_.count, false, loads, effect, go_on);
    if (outside_ && side > 0) {
      pass = find_with(-step, options_.count, false, loads, effect, go_on);
      if (!outside_) side = -1;
    }
    if (outside_) {
      first.refuse();
    } else if (!pass.ok()) {
      return pass;
    }
    if (!first.is_refused() && (first.take(effect) || (!within && effect > FirstLoadStep::least_change))) return {};
    if (!first.move(effect)) return {};
  }
  return {};
}

Report Buckling::find_by_lanczos(std::vector<Load>& loads, const std::function<bool()>& go_on) {
  double effect = 0, step = 0;
  if (Report first = find_first_loads(false, loads, step, go_on); !first.ok()) return first;
  if (loads.empty()) return {};
  // With the load itself as the step rounding is least.
  std::vector<Load> again;
  Report pass = find_with(loads.front().distance, static_cast<int>(loads.size()), false, again, effect, go_on);
  if (!pass.ok() && !outside_) return pass;
  bool linear = pass.ok() && again.size() == loads.size();
  for (std::size_t k = 0; linear && k < loads.size(); ++k)
    linear = std::abs(again[k].distance - loads[k].distance) <= linear_part * std::abs(loads[k].distance);
  if (!linear) {
    if (Report first = find_first_loads(true, loads, step, go_on); !first.ok()) return first;
    return find_by_inertia(step, loads, go_on);
  }
  loads = std::move(again);
  return {};
}

class Buckling::InertiaSearch {
 public:
  InertiaSearch(Buckling& buckling, const std::function<bool()>& go_on) : buckling_(buckling), go_on_(go_on) {}

  /// The nearest loads, `wanted` or what there is, in the order of load_search.hpp.
  Report find(double step, std::size_t wanted) {
    Front sides[2] = {{1}, {-1}};
    for_each_distance(step, farthest_load, [&](double reach) {
      for (Front& s : sides) {
        if (s.open) go_to(s, reach);
      }
      return report_.ok() && places_.size() < wanted && (sides[0].open || sides[1].open);
    });
    std::sort(places_.begin(), places_.end(), [](const Place& a, const Place& b) { return comes_first(a, b); });
    places_.resize(std::min(places_.size(), wanted));
    return report_;
  }
  /// A load near a distance: there theta number `order`, by falling value, passes 1.
  struct Place {
    double distance = 0;
    int order = 0;
  };
  const std::vector<Place>& places() const { return places_; }

 private:
  // The last sample on one side.
  struct Front {
    double sign;
    bool open = true;
    double reach = 0;
    int negative = 0;
  };

  // At a distance from the present value; nothing where the scene does not allow it, or where it cannot be told.
  std::optional<int> negative(double distance) {
    if (go_on_ && !go_on_()) {
      report_ = {Status::cancelled, "stopped while loads were looked for", {}};
      return {};
    }
    if (Report placed = buckling_.place_load(buckling_.options_.present + distance); !placed.ok()) {
      if (!buckling_.outside_) report_ = std::move(placed);
      return {};
    }
    buckling_.system_.fill(buckling_.loaded_, Curvature::exact, 0);
    if (!buckling_.system_.factorize().ok()) return {};
    return buckling_.system_.matrix().negative_modes();
  }

  void go_to(Front& s, double reach) {
    const std::optional<int> now = negative(s.sign * reach);
    if (!report_.ok()) return;
    s.open = now.has_value();
    if (!now) return;
    look_between(s.sign * s.reach, s.negative, s.sign * reach, *now);
    s.reach = reach;
    s.negative = *now;
  }

  void look_between(double a, int negative_a, double b, int negative_b) {
    if (negative_a == negative_b || !report_.ok()) return;
    const double middle = 0.5 * (a + b);
    const bool end = std::abs(b - a) <= bracketed * std::abs(middle);
    const std::optional<int> now = end ? std::nullopt : negative(middle);
    if (!now) {
      // So it is where K is singular to rounding and has no factors.
      const auto [fewer, more] = std::minmax(negative_a, negative_b);
      for (int order = fewer; order < more; ++order) places_.push_back({middle, order});
      return;
    }
    look_between(a, negative_a, middle, *now);
    look_between(middle, *now, b, negative_b);
  }

  Buckling& buckling_;
  const std::function<bool()>& go_on_;
  std::vector<Place> places_;
  Report report_;
};

// The load that belongs to theta number `order`, by falling value, of a step. As many as K(p0 + step) has negative
// eigenvalues are above 1: so a load is told from its neighbours, however near these are.
Report Buckling::find_one(double step, int order, std::optional<Load>& load, const std::function<bool()>& go_on) {
  load.reset();
  std::vector<Load> loads;
  double effect = 0;
  if (Report pass = find_with(step, order + 1, true, loads, effect, go_on); !pass.ok()) return pass;
  if (order < static_cast<int>(loads.size())) load = std::move(loads[at(order)]);
  return {};
}

Report Buckling::find_by_inertia(double step, std::vector<Load>& loads, const std::function<bool()>& go_on) {
  loads.clear();
  InertiaSearch search(*this, go_on);
  if (Report found = search.find(step, at(options_.count)); !found.ok()) return found;
  for (const InertiaSearch::Place& place : search.places()) {
    std::optional<Load> load;
    double now = place.distance, before = 0, gap_before = 0;
    for (int round = 0; round < thresholds::most_bisections; ++round) {
      if (Report pass = find_one(now, place.order, load, go_on); !pass.ok()) return pass;
      if (!load) break;
      const double gap = load->distance - now;
      const double next = round == 0 ? load->distance : now - gap * (now - before) / (gap - gap_before);
      before = std::exchange(now, next);
      gap_before = gap;
      if (!(std::abs(now - before) > thresholds::solved * std::abs(now))) break;
    }
    if (load) loads.push_back({before, std::move(load->shape)});
  }
  std::sort(loads.begin(), loads.end(), comes_first<Load>);
  return {};
}

}  // namespace catena
