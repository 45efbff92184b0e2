#include "catena/analysis/run/rope_ways_at.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "catena/analysis/run/state_conversion.hpp"
#include "catena/assembly/rope_ways.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// A tangent that has turned further, rad, is counted anew: what it turns until the next look is known within half a
// turn of it.
constexpr double turned_far = 0.5;

/// How far the straight lines of a route have turned at most since it was laid, over the same pulleys.
double turned(const RopeRoute& route, const RopeMemory& laid) {
  double by = route.memory.theta - laid.theta, most = std::abs(by);
  for (std::size_t k = 0; k < route.nodes.size(); ++k) {
    const double change = route.memory.contact[k] - laid.contact[k];
    if (std::isnan(change)) continue;  // an end, or not touched
    by += route.nodes[k].side * change;
    most = std::max(most, std::abs(by));
  }
  return most;
}

}  // namespace

bool RopeWaysAt::find(const Evaluator& evaluator) {
  std::shared_ptr<Model> changed;
  for (std::size_t r = 0; r < routes_.size(); ++r) {
    RopeRoute& route = routes_[r];
    const std::vector<Frame<double>> frames = frames_of(evaluator, route);
    try {
      const bool meets_or_leaves = find_off(*model_, route, frames);
      has_changed_ = has_changed_ || meets_or_leaves;
      if (!meets_or_leaves && !(turned(route, laid_[r]) > turned_far)) continue;
      if (!changed) changed = std::make_shared<Model>(*model_);
      lay(*changed, route, frames);
      laid_[r] = route.memory;
    } catch (const ModelError& error) {
      throw ModelError(fmt::format("rope \"{}\" has no way: {}", model_->element_name(route.element), error.what()));
    }
  }
  if (changed) model_ = changed;
  return changed != nullptr;
}

bool RopeWaysAt::find(const SystemState& state) {
  if (routes_.empty() || state.q.empty()) return false;
  PlanOptions options;
  options.one_sided = true;
  Evaluator evaluator(Plan::make(*model_, options), *model_);
  evaluator.set_configuration(configuration_of(evaluator, state));
  return find(evaluator);
}

bool RopeWaysAt::follow(RopeRoute& route, std::shared_ptr<const RouteWatch>& watch, const Evaluator& evaluator,
                        std::shared_ptr<Model>& changed) {
  const std::vector<Frame<double>> frames = frames_of(evaluator, route);
  // The first look may be far from the given configuration.
  bool lays = !watch;
  if (!watch && find_off(*model_, route, frames)) has_changed_ = true;
  for (std::size_t pass = 0; pass <= route.nodes.size(); ++pass) {
    int flipped = -1;
    double most = 0;
    if (watch) {
      for (const int node : watch->pulleys()) {
        const double contact = route.memory.contact[at(node)] = watch->contact(node, frames);
        const double wrong = route.off[at(node)] ? contact : -contact;
        if (!(wrong > most)) continue;
        most = wrong;
        flipped = node;
      }
      if (flipped < 0 && !(watch->turned(frames) > turned_far)) return lays;
      if (flipped >= 0) {
        route.off[at(flipped)] = !route.off[at(flipped)];
        has_changed_ = true;
      }
      lays = true;
    }
    if (lays) {
      if (!changed) changed = std::make_shared<Model>(*model_);
      lay(*changed, route, frames);
    }
    watch = std::make_shared<RouteWatch>(*model_, route, frames);
    if (flipped < 0) break;
  }
  return lays;
}

bool RopeWaysAt::follow(const Evaluator& evaluator) {
  watches_.resize(routes_.size());
  std::shared_ptr<Model> changed;
  for (std::size_t r = 0; r < routes_.size(); ++r) {
    if (routes_[r].elastic) continue;
    try {
      follow(routes_[r], watches_[r], evaluator, changed);
    } catch (const ModelError& error) {
      throw ModelError(
          fmt::format("rope \"{}\" has no way: {}", model_->element_name(routes_[r].element), error.what()));
    }
  }
  if (changed) model_ = changed;
  return changed != nullptr;
}

}  // namespace catena
