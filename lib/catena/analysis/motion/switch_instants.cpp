#include "catena/analysis/motion/switch_instants.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string_view>
#include <utility>

#include "catena/analysis/motion/tableau.hpp"
#include "catena/analysis/run/thresholds.hpp"
#include "catena/base/at.hpp"
#include "catena/columns/design_state.hpp"
#include "catena/columns/state_laws.hpp"
#include "catena/columns/switches.hpp"

namespace catena {
namespace {

/// The number of the law that has a switch of this name, "law K switch N"; -1: a spring has it.
int law_of_switch(const std::string& name) { return name.starts_with("law ") ? std::stoi(name.substr(4)) : -1; }

/// Of accelerations, the largest of all coordinates, in parts of their size.
double change_of_slopes(const SwitchInstants::Vector& before, const SwitchInstants::Vector& behind) {
  double change = 0, size = 0;
  for (std::size_t i = before.size() / 2; i < before.size(); ++i) {
    change = std::max(change, std::abs(behind[i].v - before[i].v));
    size = std::max({size, std::abs(before[i].v), std::abs(behind[i].v)});
  }
  return change > 0 ? change / size : 0;
}

}  // namespace

SwitchInstants::SwitchInstants(const Model& model, const Plan& plan) : model_(model) {
  std::vector<std::string> names = switches_of_loads(model, {}, true);
  // Cables and ropes are places that press (cable_kinks.hpp).
  std::erase_if(names, [](const std::string& name) { return name.find(" switch ") == std::string::npos; });
  if (names.empty()) return;
  columns_ = ColumnSet::resolve(model, plan, names, {.analysis = "dynamics", .velocity = true});
  for (const ColumnInfo& info : columns_->info()) laws_.push_back(law_of_switch(info.name));
}

std::vector<SwitchInstants::Switch> SwitchInstants::find(const MotionStretch& stretch) const {
  std::vector<Switch> found;
  const std::size_t count = columns_->size();
  std::vector<double> last(count), now(count), g(count);
  const auto look = [&](double t, std::vector<double>& values) {
    const std::optional<Snapshot> there = stretch.at(t);
    if (!there) return false;
    columns_->evaluate(*there, values);
    return true;
  };
  const auto sign_at = [&](double t, std::size_t c) { return look(t, g) ? (g[c] > 0) - (g[c] < 0) : 0; };
  const double length = stretch.to - stretch.from;
  const auto narrow = [&](double a, double b, std::size_t c, int before) {
    for (int n = 0; n < thresholds::most_bisections; ++n) {
      if (b - a <= thresholds::few_roundings * std::max(std::abs(a), std::abs(b))) break;
      const double middle = a + (b - a) / 2;
      (sign_at(middle, c) == before ? a : b) = middle;
    }
    // As far to both sides as tells g from zero: there laws have values.
    double away = std::max(thresholds::carried_rounding * std::abs(b), thresholds::same_instant * length);
    Switch one{a, b, {c}};
    for (int n = 0; n < thresholds::most_bisections; ++n, away *= 2) {
      one.before = std::max(a - away, stretch.from);
      one.behind = std::min(b + away, stretch.to);
      const bool told = sign_at(one.before, c) == before && sign_at(one.behind, c) == -before;
      if (told || (one.before == stretch.from && one.behind == stretch.to)) break;
    }
    found.push_back(one);
  };
  // A step is at most some radians of the fastest swing long: in a quarter of it no g comes back.
  std::vector<double> since(count, stretch.from);
  if (!look(stretch.from, last)) return {};
  for (const double part : {0.25, 0.5, 0.75, 1.0}) {
    const double t = part == 1 ? stretch.to : stretch.from + length * part;
    if (!look(t, now)) return {};
    for (std::size_t c = 0; c < count; ++c) {
      if (now[c] == 0 || !std::isfinite(now[c])) continue;
      if (last[c] != 0 && std::isfinite(last[c]) && (now[c] > 0) != (last[c] > 0))
        narrow(since[c], t, c, last[c] > 0 ? 1 : -1);
      last[c] = now[c];
      since[c] = t;
    }
  }
  std::sort(found.begin(), found.end(), [](const Switch& a, const Switch& b) { return a.before < b.before; });
  std::vector<Switch> joined;
  for (Switch& one : found) {
    if (joined.empty() || one.before > joined.back().behind) {
      joined.push_back(std::move(one));
      continue;
    }
    joined.back().behind = std::max(joined.back().behind, one.behind);
    joined.back().columns.push_back(one.columns.front());
  }
  return joined;
}

std::vector<double> SwitchInstants::part_ends(const std::vector<Switch>& switches, double to) {
  std::vector<double> ends;
  for (const Switch& one : switches) ends.push_back(one.behind);
  ends.push_back(to);
  return ends;
}

std::vector<DesignScalar> SwitchInstants::values(DesignMechanism& mechanism, const Snapshot& there,
                                                 const Vector& y) const {
  const std::size_t n = y.size() / 2;
  std::vector<DesignScalar> values(columns_->size());
  mechanism.set_state(std::span(y).first(n), std::span(y).subspan(n));
  columns_->differentiate(DesignState(mechanism, there, {}, {}), values);
  return values;
}

SwitchInstants::Rates SwitchInstants::look(const Switch& one, double t, double length, Carrier& carrier) const {
  DesignMechanism& mechanism = carrier.groups.front().mechanism;
  const Vector &y = carrier.groups.front().y, &slope = carrier.groups.front().slope;
  Vector still(y), along(y);
  for (std::size_t i = 0; i < y.size(); ++i) {
    still[i].d.fill(0);
    along[i].d.fill(0);
    along[i].d[0] = slope[i].v;
    along[i].d[1] = std::abs(y[i].v);
  }
  const Snapshot there{.evaluator = carrier.evaluator, .t = t};
  const std::vector<DesignScalar> moved = values(mechanism, there, along), rest = values(mechanism, there, still);
  // What laws read of time is smooth: differences of what they compare at this state.
  const double earlier = t - std::max(length, thresholds::same_value * std::max(std::abs(t), 1.0));
  Rates rates;
  for (const std::size_t c : one.columns) {
    const auto at_instant = [&](double instant) -> std::optional<double> {
      mechanism.set_time(instant, Side::before);
      return values(mechanism, {.evaluator = carrier.evaluator, .t = instant}, still)[c].v - rest[c].v;
    };
    const std::optional<double> by_time = carrier.rate({.from = earlier, .to = t, .at = {}}, at_instant);
    const double unknown = std::numeric_limits<double>::quiet_NaN();
    rates.value.push_back(rest[c].v);
    rates.by_time.push_back(by_time ? moved[c].d[0] - rest[c].d[0] + *by_time : unknown);
    rates.size.push_back(std::abs(moved[c].d[1] - rest[c].d[1]));
  }
  mechanism.set_time(t, Side::after);
  rates.by_parameter.resize(one.columns.size());
  for (Carrier::Group& group : carrier.groups) {
    const std::vector<DesignScalar> of_group = values(group.mechanism, there, group.y);
    for (std::size_t k = 0; k < one.columns.size(); ++k) {
      const auto& d = of_group[one.columns[k]].d;
      rates.by_parameter[k].insert(rates.by_parameter[k].end(), d.begin(),
                                   d.begin() + static_cast<std::ptrdiff_t>(group.count));
    }
  }
  return rates;
}

std::optional<double> SwitchInstants::pass(const Switch& one, const MotionStretch& stretch, double from,
                                           Carrier& carrier, std::string& trouble) const {
  const double length = stretch.to - stretch.from;
  double bound = one.behind - from, distance = 0, least = 0;
  bool reaches = false;
  Rates before;
  for (int n = 0; n < thresholds::most_bisections; ++n) {
    if (!carrier.find_slopes(from)) return {};
    before = look(one, from, length, carrier);
    const double rate = before.by_time.front(), way = -before.value.front() / rate;
    const double rounding = before.size.front() / std::abs(rate);
    least = std::max(std::abs(from), std::isfinite(rounding) ? rounding : 0) * thresholds::carried_rounding;
    least = std::max(least, thresholds::same_instant * length);
    // The first time it may change its rate much on the way, and the motion tells more.
    distance = std::min(std::isfinite(way) ? way : one.before - from, std::min(bound, stretch.to - from));
    bound = length;
    reaches = way <= stretch.to - from;
    if (!(distance > 2 * least)) break;
    from += distance * 7 / 8;
    if (!carrier.take(from)) return {};
  }
  carrier.leave();
  const double behind = std::min(from + std::max(distance, 0.0) + least, stretch.to);
  std::vector<Vector> slopes_before;
  for (const Carrier::Group& group : carrier.groups) slopes_before.push_back(group.slope);
  const Vector& slope_before = slopes_before.front();
  // Where these equations alone come to zero a little after the step of the motion has, which its tolerance allows, the
  // motion's own state is behind.
  const std::optional<Snapshot> shown = reaches ? std::nullopt : stretch.at(one.behind);
  if (!reaches && !shown) {
    trouble =
        fmt::format("the motion could not be looked at at t = {:.9g} s, where a law of state switches", one.behind);
    return {};
  }
  for (Carrier::Group& group : carrier.groups) {
    for (std::size_t i = 0, n = group.y.size() / 2; i < 2 * n; ++i)
      group.y[i].v =
          shown ? (i < n ? shown->q[i] : shown->qd[i - n]) : group.y[i].v + (behind - from) * group.slope[i].v;
  }
  if (!carrier.find_slopes(behind)) return {};
  const Vector& slope = carrier.groups.front().slope;
  const Rates after = look(one, behind, length, carrier);
  const auto moves = instant(one, from, before, after, change_of_slopes(slope_before, slope), trouble);
  if (!moves) return {};
  std::size_t first = 0;
  for (std::size_t k = 0; k < carrier.groups.size(); ++k) {
    Carrier::Group& group = carrier.groups[k];
    // What jumps, or is steep, makes all that derivatives change by between both sides.
    for (std::size_t i = 0; i < group.y.size() && moves->empty(); ++i) {
      for (std::size_t p = 0; p < group.count; ++p) group.y[i].d[p] += (behind - from) * slopes_before[k][i].d[p];
    }
    for (std::size_t p = 0; p < group.count && !moves->empty(); ++p) {
      for (std::size_t i = slope.size() / 2; i < slope.size(); ++i)
        group.y[i].d[p] += (slope_before[i].v - slope[i].v) * (*moves)[first + p];
    }
    first += group.count;
  }
  return behind;
}

std::optional<std::vector<double>> SwitchInstants::instant(const Switch& one, double t, const Rates& before,
                                                           const Rates& behind, double change,
                                                           std::string& trouble) const {
  if (change <= thresholds::no_force) return std::vector<double>{};
  std::vector<double> instant;
  std::string_view what;
  for (std::size_t k = 0; k < one.columns.size(); ++k) {
    const double rate = before.by_time[k];
    if (!std::isfinite(rate) || rate == 0) what = "at a rate that is not known";
    if (rate * behind.by_time[k] <= 0) what = "and is driven back from there";
    for (std::size_t p = 0; p < before.by_parameter[k].size(); ++p) {
      const double moves = before.by_parameter[k][p] == 0 ? 0 : -before.by_parameter[k][p] / rate;
      if (k == 0) {
        instant.push_back(moves);
      } else if (!(std::abs(moves - instant[p]) <=
                   thresholds::same_rate * std::max(std::abs(moves), std::abs(instant[p])))) {
        what = "where it switches twice, at instants that move apart with the parameters";
      }
    }
  }
  if (what.empty()) return instant;
  // A law that bends changes accelerations by what they change by in the time between both sides.
  if (change <= thresholds::same_value) return std::vector<double>{};
  trouble = fmt::format("at t = {:.9g} s the expression of {} jumps, {}: derivatives are not carried over that", t,
                        name(one), what);
  return {};
}

// Where the motion's tolerance allows a step over a jump all else changes in it by less than a hundredth of that. Less
// than a thousandth of all accelerations may as well be what begins to move in a long chain, like a high power of time.
std::string SwitchInstants::trouble_in(double from, double to, const std::vector<Vector>& stages) const {
  if (model_.laws.empty()) return {};
  const Tableau& table = dormand_prince_8();
  std::vector<std::size_t> order(at(table.stages));
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return table.c[a] < table.c[b]; });
  const std::size_t n = stages.front().size() / 2;
  double size = 0;
  for (std::size_t i = n; i < 2 * n; ++i)
    size = std::max({size, std::abs(stages[0][i].v), std::abs(stages[order.back()][i].v)});
  for (std::size_t i = n; i < 2 * n; ++i) {
    double whole = 0, largest = 0;
    for (std::size_t k = 1; k < order.size(); ++k) {
      const double a = stages[order[k - 1]][i].v, b = stages[order[k]][i].v;
      largest = std::max(largest, std::abs(b - a));
      whole += std::abs(b - a);
    }
    if (!(largest > 1e-3 * size && largest > 0.99 * whole)) continue;
    return fmt::format(
        "between t = {:.9g} s and {:.9g} s forces of laws of state jump, or bend as if they did, where no abs, min, "
        "max "
        "or end of a table tells the instant: derivatives are not carried over that",
        from, to);
  }
  return {};
}

std::string SwitchInstants::name(const Switch& one) const {
  for (const std::size_t column : one.columns) {
    if (laws_[column] >= 0) return describe_law(model_, laws_[column]);
  }
  return "a law of state";
}

}  // namespace catena
