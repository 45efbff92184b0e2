#include "catena/analysis/dynamics/rope_phases.hpp"

#include <fmt/format.h>

#include "catena/analysis/run/rope_ways_at.hpp"
#include "catena/assembly/rope_ways.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// A tangent's angle is known within half a turn of the one from which it is counted; from this one on, rad, it is
// counted anew. Between two samples of a step it turns by less than what is left.
constexpr double most_turned = 2;

Report undefined(const Model& model, const RopeRoute& route, double t, const char* why) {
  Report report;
  report.status = Status::singular;
  report.message =
      fmt::format("rope \"{}\" is undefined at t = {:.12g} s: {}", model.element_name(route.element), t, why);
  return report;
}

}  // namespace

Report RopePhases::lay_out(std::size_t route, const Evaluator& evaluator, Model& model) {
  const std::vector<Frame<double>> frames = frames_of(evaluator, routes_[route]);
  try {
    lay(model, routes_[route], frames);
    watches_[route] = std::make_shared<RouteWatch>(model, routes_[route], frames);
  } catch (const ModelError& error) {
    return undefined(model, routes_[route], evaluator.time(), error.what());
  }
  return {};
}

Report RopePhases::start(const SystemState& state, const Evaluator& evaluator, std::shared_ptr<const Model>& model) {
  if (!any()) return {};
  const bool known = !state.ropes.empty();
  if (known) take_up(routes_, state);
  const auto changed = std::make_shared<Model>(*model);
  watches_.assign(routes_.size(), nullptr);
  events_.clear();
  for (std::size_t r = 0; r < routes_.size(); ++r) {
    try {
      const std::vector<Frame<double>> frames = frames_of(evaluator, routes_[r]);
      if (!known) {
        find_off(*changed, routes_[r], frames);
      } else if (go_on(*changed, routes_[r], frames).turned > most_turned_between_places) {
        return undefined(*changed, routes_[r], evaluator.time(),
                         "how far it is wound is known of a place from which it turns by nearly half a turn, either "
                         "way, as the bodies are assembled");
      }
    } catch (const ModelError& error) {
      return undefined(*changed, routes_[r], evaluator.time(), error.what());
    }
    if (Report laid = lay_out(r, evaluator, *changed); !laid.ok()) return laid;
  }
  model = changed;
  return {};
}

std::vector<RopeTurns> RopePhases::turns(const SystemState& state) const {
  std::vector<RopeTurns> turns;
  for (std::size_t r = 0; r < routes_.size() && !state.q.empty(); ++r) {
    if (!watches_.empty() && watches_[r]) turns.push_back(watches_[r]->turns(frames_at(routes_[r], state)));
  }
  return turns;
}

void RopePhases::add_transitions(std::vector<Transition>& transitions, double length) {
  watched_.clear();
  for (std::size_t r = 0; r < routes_.size(); ++r) {
    const std::shared_ptr<const RouteWatch> tangents = watches_[r];
    const RopeRoute* route = &routes_[r];
    const auto watch = [&](int node, End ends, auto value) {
      // Angles, and the square of a length.
      const double size = ends == End::circle ? length * length : 1;
      transitions.push_back({[route, value](const Snapshot& s) { return value(frames_of(s.evaluator, *route)); }, 1,
                             MotionSizes::least_part * size});
      watched_.push_back({r, node, ends});
    };
    for (const int node : tangents->pulleys()) {
      const double sign = route->off[at(node)] ? -1 : 1;
      watch(node, End::contact,
            [tangents, node, sign](const std::vector<Frame<double>>& f) { return sign * tangents->contact(node, f); });
    }
    watch(-1, End::circle, [tangents](const std::vector<Frame<double>>& f) { return tangents->room(f); });
    watch(-1, End::turned,
          [tangents](const std::vector<Frame<double>>& f) { return most_turned - tangents->turned(f); });
  }
}

Report RopePhases::change(std::size_t k, const Evaluator& evaluator, std::shared_ptr<const Model>& model) {
  const Watched ended = watched_[k];
  RopeRoute& route = routes_[ended.route];
  const auto changed = std::make_shared<Model>(*model);
  if (ended.ends == End::circle) {
    return undefined(*model, route, evaluator.time(),
                     "an end or a pulley of it comes into the circle of the next pulley");
  }
  const std::vector<Frame<double>> frames = frames_of(evaluator, route);
  static_cast<RopeTurns&>(route.memory) = watches_[ended.route]->turns(frames);
  if (ended.ends == End::contact) {
    char& off = route.off[at(ended.node)];
    off = !off;
    events_.push_back({route.element, off ? left_pulley : met_pulley, evaluator.time()});
  }
  if (Report laid = lay_out(ended.route, evaluator, *changed); !laid.ok()) return laid;
  model = changed;
  return {};
}

}  // namespace catena
