#include "catena/model/rope_routes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "catena/base/at.hpp"
#include "catena/elements/all.hpp"
#include "catena/model/model_add.hpp"
#include "catena/model/rope_pieces.hpp"

namespace catena {
namespace {

RopePulley<double> pulley_of(const RopeNode& node) {
  return {.body = node.body,
          .centre = node.centre,
          .radius = std::abs(node.radius),
          .side = node.radius < 0 ? -1 : 1,
          .rolls = node.rolls,
          .mu = node.mu};
}

/// Writes the lines of a rope over its elements.
void write_rope(Model& model, int element, const std::vector<RopePiece<double>>& pieces) {
  const std::size_t index = at(model.elements[at(element)].index);
  auto& head = std::get<std::vector<ElementEntry<Rope<double>, double>>>(model.constraints)[index];
  auto& parts = std::get<std::vector<ElementEntry<RopePart<double>, double>>>(model.constraints);
  head.i = pieces.front().i;
  head.j = pieces.front().j;
  static_cast<RopeSpan<double>&>(head.element) = pieces.front().span;
  for (std::size_t k = 1; k < pieces.size(); ++k) {
    auto& part = parts[at(head.element.first_part) + k - 1];
    part.i = pieces[k].i;
    part.j = pieces[k].j;
    static_cast<RopeSpan<double>&>(part.element) = pieces[k].span;
    part.element.bridge = pieces[k].bridge;
  }
}

RopeLayout<double> layout_of(const Model& model, const RopeRoute& route, const std::vector<Frame<double>>& frames) {
  RopeLayout<double> layout(model, route.nodes, frames);
  layout.off = route.off;
  return layout;
}

/// As RopeLayout::can_leave().
bool can_leave(const RopeRoute& route, int k) {
  const RopePulley<double>& node = route.nodes[at(k)];
  return k > 0 && k + 1 < static_cast<int>(route.nodes.size()) && !node.rolls && node.radius > 0;
}

std::vector<Frame<double>> given(const Model& model, const RopeRoute& route) {
  std::vector<Frame<double>> frames;
  for (const RopePulley<double>& node : route.nodes) frames.push_back(model.frame(node.body));
  return frames;
}

/// Of a path, the part between pulleys that roll in which bodies move.
std::vector<RopePulley<double>> stretch_of(const Model& model, const RopePath& path) {
  const std::size_t count = path.nodes.size() - (path.leads_on ? 1 : 0);
  for (std::size_t first = 0, end = 1; end < count; first = end++) {
    while (end + 1 < count && !path.nodes[end].rolls) ++end;
    bool all_together = true;
    for (std::size_t k = first; k < end; ++k) {
      const int a = path.nodes[k].body, b = path.nodes[k + 1].body;
      all_together = all_together && (a == b || (!moves(model, a) && !moves(model, b)));
    }
    if (all_together) continue;
    std::vector<RopePulley<double>> nodes;
    for (std::size_t k = first; k <= end; ++k) nodes.push_back(pulley_of(path.nodes[k]));
    return nodes;
  }
  return {};
}

}  // namespace

std::vector<RopeRoute> rope_routes(const Model& model) {
  std::vector<RopeRoute> routes;
  for (const RopePath& path : model.rope_paths) {
    if (model.element_type(path.element) != Rope<double>::type) continue;
    RopeRoute route{.element = path.element,
                    .elastic = model.elements[at(path.element)].kind == ElementKind::force,
                    .nodes = stretch_of(model, path)};
    const auto is_circle = [](const RopePulley<double>& node) { return node.radius > 0; };
    if (std::none_of(route.nodes.begin(), route.nodes.end(), is_circle)) continue;
    route.off.assign(route.nodes.size(), 0);
    find_off(model, route, given(model, route));
    routes.push_back(std::move(route));
  }
  return routes;
}

bool find_off(const Model& model, RopeRoute& route, const std::vector<Frame<double>>& frames) {
  RopeLayout<double> layout = layout_of(model, route, frames);
  layout.choose_off(0, layout.last());
  const bool changed = layout.off != route.off;
  route.off = layout.off;
  // What winds on ends that roll counts from the given configuration.
  const RopeMemory before = route.memory;
  route.memory = {};
  static_cast<void>(layout.between(0, layout.last(), route.memory));
  if (before.known()) {
    route.memory.theta = before.theta + std::remainder(route.memory.theta - before.theta, 2 * std::numbers::pi);
    route.memory.wound_i = before.wound_i;
    route.memory.wound_j = before.wound_j;
  }
  return changed;
}

void take_up(RopeRoute& route, const RopeTurns& turns) {
  if (turns.contact.size() != route.nodes.size() || !turns.known())
    throw std::invalid_argument("how far ropes are wound is of another model: a rope has other pulleys");
  static_cast<RopeTurns&>(route.memory) = turns;
  for (std::size_t k = 0; k < route.nodes.size(); ++k)
    route.off[k] = can_leave(route, static_cast<int>(k)) && turns.contact[k] < 0;
}

RouteStep go_on(const Model& model, RopeRoute& route, const std::vector<Frame<double>>& frames) {
  RouteStep step;
  // Each pass changes one pulley.
  for (std::size_t pass = 0; pass <= route.nodes.size(); ++pass) {
    const RouteWatch watch(model, route, frames);
    if (pass == 0) step.turned = watch.moved();
    static_cast<RopeTurns&>(route.memory) = watch.turns(frames);
    int flipped = -1;
    double most = 0;
    for (const int node : watch.pulleys()) {
      const double contact = route.memory.contact[at(node)];
      const double wrong = route.off[at(node)] ? contact : -contact;
      if (!(wrong > most)) continue;
      most = wrong;
      flipped = node;
    }
    if (flipped < 0) break;
    route.off[at(flipped)] = !route.off[at(flipped)];
    step.changed = true;
  }
  return step;
}

void lay(Model& model, RopeRoute& route, const std::vector<Frame<double>>& frames) {
  const RopeLayout<double> layout = layout_of(model, route, frames);
  RopeStretch<double> stretch = layout.between(0, layout.last(), route.memory);
  stretch.skeleton = layout.skeleton(0, layout.last()).straight;
  const std::vector<RopePiece<double>> pieces = padded(model, stretch, route.elastic);
  if (!route.elastic) return write_rope(model, route.element, pieces);
  const std::size_t first = at(model.elements[at(route.element)].index);
  auto& list = std::get<std::vector<ElementEntry<ElasticRope<double>, double>>>(model.forces);
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    auto& entry = list[first + k];
    entry.i = pieces[k].i;
    entry.j = pieces[k].j;
    pieces[k].give(entry.element);
  }
}

namespace {

/// The part of a route behind a node, which holds what winds on it; the whole route, as it is laid, behind node 0.
RopeStretch<double> part_behind(const Model& model, const RopeRoute& route, int node, int first_line,
                                const std::vector<Frame<double>>& frames) {
  std::vector<RopePulley<double>> nodes = route.nodes;
  if (node > 0) nodes[at(node)].rolls = true;
  RopeLayout<double> layout(model, std::move(nodes), frames);
  layout.off = route.off;
  RopeMemory memory;
  if (node == 0) memory = route.memory;
  RopeStretch<double> stretch = layout.between(node, layout.last(), memory);
  stretch.skeleton = layout.skeleton(first_line, layout.last()).straight;
  return stretch;
}

}  // namespace

double length_behind(const Model& model, const RopeRoute& route, int node, const std::vector<Frame<double>>& frames) {
  const RopeLayout<double> layout = layout_of(model, route, frames);
  double length = 0;
  for (int a = node; a < layout.last(); a = layout.after(a)) {
    const RopeSpan<double> span = layout.line(a, layout.after(a));
    const Vec2<double> h = separation(frames[at(a)], frames[at(layout.after(a))], span.s_i, span.s_j);
    length += span.line(h).length;
    if (a > node) length += route.nodes[at(a)].radius * route.memory.contact[at(a)];
  }
  return length;
}

int append_behind(Model& model, const RopeRoute& route, int node, const std::vector<Frame<double>>& frames) {
  const std::vector<RopePiece<double>> pieces = padded(model, part_behind(model, route, node, node, frames), false);
  Rope<double> head;
  head.length = 0;
  head.first_part =
      static_cast<int>(std::get<std::vector<ElementEntry<RopePart<double>, double>>>(model.constraints).size());
  head.parts = static_cast<int>(pieces.size()) - 1;
  const int id =
      model.append({}, ElementEntry<Rope<double>, double>{head, pieces.front().i, pieces.front().j}, ElementKind::gap);
  for (std::size_t k = 1; k < pieces.size(); ++k) {
    RopePart<double> part;
    part.head = id;
    model.append({}, ElementEntry<RopePart<double>, double>{part, pieces[k].i, pieces[k].j}, ElementKind::constraint);
  }
  write_rope(model, id, pieces);
  return id;
}

void lay_behind(Model& model, const RopeRoute& route, int element, int node, int last_of_run,
                const std::vector<Frame<double>>& frames) {
  write_rope(model, element, padded(model, part_behind(model, route, node, last_of_run, frames), false));
}

RouteWatch::RouteWatch(const Model& model, const RopeRoute& route, const std::vector<Frame<double>>& frames) {
  const RopeLayout<double> layout = layout_of(model, route, frames);
  std::vector<double> out(route.nodes.size(), 0.0);  // theta behind each node that is touched
  std::vector<int> behind(route.nodes.size(), -1);
  for (const RopePulley<double>& node : route.nodes) side_.push_back(node.side);
  const auto add = [&](int a, int b, double near) {
    Tangent tangent{a, b, layout.line(a, b)};
    const double by = std::remainder(tangent.span.angle - near, 2 * std::numbers::pi);
    tangent.span.angle = near + by;
    moved_ = std::max(moved_, std::abs(by));
    tangents_.push_back(tangent);
    return static_cast<int>(tangents_.size()) - 1;
  };
  double theta = route.memory.theta;
  for (int a = 0; a < layout.last(); a = layout.after(a)) {
    const double contact = route.memory.contact[at(a)];
    if (a > 0) theta += side_[at(a)] * contact;
    out[at(a)] = theta;
    behind[at(a)] = add(a, layout.after(a), theta);
    if (a == 0 || !layout.can_leave(a)) continue;
    pulleys_.push_back(a);
    in_.push_back(behind[at(layout.before(a))]);
    out_.push_back(behind[at(a)]);
  }
  ways_ = tangents_.size();
  for (int k = 1; k < layout.last(); ++k) {
    if (!route.off[at(k)]) continue;
    // Throws where an end lies within the pulley.
    const int a = layout.before(k), b = layout.after(k);
    const double moved = moved_;
    const int in = add(a, k, out[at(a)]);
    moved_ = moved;  // it is compared with that of the way, another line
    const double contact = route.memory.contact[at(k)];
    const double near =
        std::isnan(contact) ? tangents_[at(in)].span.angle : tangents_[at(in)].span.angle + side_[at(k)] * contact;
    pulleys_.push_back(k);
    in_.push_back(in);
    out_.push_back(add(k, b, near));
  }
}

double RouteWatch::theta(const Tangent& tangent, const std::vector<Frame<double>>& frames) const {
  const Vec2<double> h = separation(frames[at(tangent.a)], frames[at(tangent.b)], tangent.span.s_i, tangent.span.s_j);
  return tangent.span.heading(tangent.span.line(h).along);
}

RopeTurns RouteWatch::turns(const std::vector<Frame<double>>& frames) const {
  RopeTurns turns;
  turns.contact.assign(frames.size(), std::nan(""));
  turns.theta = theta(tangents_.front(), frames);
  double in = turns.theta;
  for (std::size_t k = 1; k < ways_; ++k) {
    const double out = theta(tangents_[k], frames);
    turns.contact[at(tangents_[k].a)] = side_[at(tangents_[k].a)] * (out - in);
    in = out;
  }
  for (const int node : pulleys_) turns.contact[at(node)] = contact(node, frames);
  return turns;
}

double RouteWatch::contact(int node, const std::vector<Frame<double>>& frames) const {
  const auto found = std::find(pulleys_.begin(), pulleys_.end(), node) - pulleys_.begin();
  const auto k = static_cast<std::size_t>(found);
  return side_[at(node)] * (theta(tangents_[at(out_[k])], frames) - theta(tangents_[at(in_[k])], frames));
}

double RouteWatch::room(const std::vector<Frame<double>>& frames) const {
  double least = std::numeric_limits<double>::infinity();
  for (const Tangent& t : tangents_) {
    const double offset = t.span.radius_j - t.span.radius_i;
    const Vec2<double> h = separation(frames[at(t.a)], frames[at(t.b)], t.span.s_i, t.span.s_j);
    least = std::min(least, squared_norm(h) - offset * offset);
  }
  return least;
}

double RouteWatch::turned(const std::vector<Frame<double>>& frames) const {
  double most = 0;
  for (const Tangent& tangent : tangents_) most = std::max(most, std::abs(theta(tangent, frames) - tangent.span.angle));
  return most;
}

}  // namespace catena
