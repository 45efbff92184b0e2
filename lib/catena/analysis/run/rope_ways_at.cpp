#include "catena/analysis/run/rope_ways_at.hpp"

#include <fmt/format.h>

#include "catena/analysis/run/state_conversion.hpp"
#include "catena/assembly/rope_ways.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// A tangent that has turned further, rad, is counted anew: what it turns until the next look is known within half a
// turn of it.
constexpr double turned_far = 0.5;

}  // namespace

RopeWaysAt::RopeWaysAt(std::shared_ptr<const Model> model) : model_(std::move(model)), routes_(rope_routes(*model_)) {
  for (const RopeRoute& route : routes_) {
    std::vector<Frame<double>> frames;
    for (const RopePulley<double>& node : route.nodes) frames.push_back(model_->frame(node.body));
    laid_.push_back(std::make_shared<RouteWatch>(*model_, route, frames));
  }
}

bool RopeWaysAt::find(const Evaluator& evaluator) {
  std::shared_ptr<Model> changed;
  for (std::size_t r = 0; r < routes_.size(); ++r) {
    RopeRoute& route = routes_[r];
    const std::vector<Frame<double>> frames = frames_of(evaluator, route);
    try {
      const bool meets_or_leaves = find_off(*model_, route, frames);
      has_changed_ = has_changed_ || meets_or_leaves;
      if (!meets_or_leaves && !(laid_[r]->turned(frames) > turned_far)) continue;
      if (!changed) changed = std::make_shared<Model>(*model_);
      lay(*changed, route, frames);
      laid_[r] = std::make_shared<RouteWatch>(*changed, route, frames);
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
