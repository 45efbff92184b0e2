#include "catena/analysis/run/rope_ways_at.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "catena/assembly/rope_ways.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// A tangent that has turned further, rad, is counted anew: what it turns until the next look is known within half a
// turn of it.
constexpr double turned_far = 0.5;

/// How far the straight lines of a route have turned at most since it lay so over the same pulleys.
double turned(const RopeRoute& route, const RopeTurns& laid) {
  double by = route.memory.theta - laid.theta, most = std::abs(by);
  for (std::size_t k = 0; k < route.nodes.size(); ++k) {
    const double change = route.memory.contact[k] - laid.contact[k];
    if (route.off[k] || std::isnan(change)) continue;  // not touched, or an end
    by += route.nodes[k].side * change;
    most = std::max(most, std::abs(by));
  }
  return most;
}

bool lies_as(const RopeRoute& route, const RopeRoute& other) {
  return route.off == other.off && turned(route, other.memory) < most_turned_between_places;
}

std::vector<Frame<double>> given_frames(const Model& model, const RopeRoute& route) {
  std::vector<Frame<double>> frames;
  for (const RopePulley<double>& node : route.nodes) frames.push_back(model.frame(node.body));
  return frames;
}

}  // namespace

std::vector<Frame<double>> frames_at(const RopeRoute& route, const SystemState& state) {
  std::vector<Frame<double>> frames;
  for (const RopePulley<double>& node : route.nodes) {
    const double* place = node.body < 0 ? nullptr : &state.q.at(3 * at(node.body));
    frames.push_back(place ? make_frame(place[0], place[1], place[2]) : Frame<double>{});
  }
  return frames;
}

void take_up(std::span<RopeRoute> routes, const SystemState& state) {
  if (state.ropes.size() != routes.size()) {
    throw std::invalid_argument(
        fmt::format("the state is of another model: it says of {} ropes how far they are "
                    "wound, and there are {}",
                    state.ropes.size(), routes.size()));
  }
  for (std::size_t r = 0; r < routes.size(); ++r) take_up(routes[r], state.ropes[r]);
}

RopeWaysAt::RopeWaysAt(std::shared_ptr<const Model> model)
    : model_(std::move(model)), routes_(rope_routes(*model_)), given_(routes_), laid_(routes_), last_(routes_.size()) {}

bool RopeWaysAt::lie_as(std::span<const RopeRoute> others) const {
  for (std::size_t r = 0; r < routes_.size(); ++r) {
    if (!lies_as(routes_[r], others[r])) return false;
  }
  return true;
}

bool RopeWaysAt::look(std::size_t r, std::vector<Frame<double>> frames, bool in_motion) {
  RopeRoute& route = routes_[r];
  const RopeRoute before = route;
  bool changed = false;
  if (last_[r].empty()) {
    changed = find_off(*model_, route, frames);
  } else {
    const RouteStep step = go_on(*model_, route, frames);
    changed = step.changed;
    if (step.turned > most_turned_between_places) {
      RopeRoute of_place = before;
      find_off(*model_, of_place, last_[r]);
      if (lies_as(before, of_place)) {
        route = before;
        changed = find_off(*model_, route, frames);
      } else if (in_motion) {
        throw ModelError(
            "it is wound further than its place tells, and from one row to the next it turns by nearly half a turn, "
            "either way: ask for rows that are nearer to each other");
      }
    }
  }
  last_[r] = std::move(frames);
  has_changed_ = has_changed_ || changed;
  return route.off != laid_[r].off || turned(route, laid_[r].memory) > turned_far;
}

bool RopeWaysAt::lay_ways(std::span<const char> changed) {
  if (std::find(changed.begin(), changed.end(), 1) == changed.end()) return false;
  const auto model = std::make_shared<Model>(*model_);
  for (std::size_t r = 0; r < routes_.size(); ++r) {
    if (!changed[r]) continue;
    lay(*model, routes_[r], last_[r]);
    laid_[r] = routes_[r];
  }
  model_ = model;
  return true;
}

bool RopeWaysAt::begin(const SystemState& state) {
  if (routes_.empty()) return false;
  const bool given = state.q.empty();
  if (!state.ropes.empty()) take_up(routes_, state);
  std::vector<char> changed(routes_.size(), 0);
  for (std::size_t r = 0; r < routes_.size(); ++r) {
    std::vector<Frame<double>> frames = given ? given_frames(*model_, routes_[r]) : frames_at(routes_[r], state);
    try {
      if (given || !state.ropes.empty()) last_[r] = frames;
      changed[r] = look(r, std::move(frames), false);
    } catch (const ModelError& error) {
      throw ModelError(
          fmt::format("rope \"{}\" has no way: {}", model_->element_name(routes_[r].element), error.what()));
    }
    has_changed_ = has_changed_ || routes_[r].off != given_[r].off;
  }
  return lay_ways(changed);
}

bool RopeWaysAt::find(const Evaluator& evaluator, bool elastic) {
  std::vector<char> changed(routes_.size(), 0);
  for (std::size_t r = 0; r < routes_.size(); ++r) {
    if (routes_[r].elastic && !elastic) continue;
    try {
      changed[r] = look(r, frames_of(evaluator, routes_[r]), !elastic);
    } catch (const ModelError& error) {
      throw ModelError(
          fmt::format("rope \"{}\" has no way: {}", model_->element_name(routes_[r].element), error.what()));
    }
  }
  return lay_ways(changed);
}

std::vector<RopeTurns> RopeWaysAt::turns(const SystemState& state) const {
  std::vector<RopeTurns> turns;
  for (const RopeRoute& route : routes_) {
    const std::vector<Frame<double>> frames = frames_at(route, state);
    turns.push_back(RouteWatch(*model_, route, frames).turns(frames));
  }
  return turns;
}

}  // namespace catena
