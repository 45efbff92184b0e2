#include "catena/model/rope_way.hpp"

#include <string>

#include "catena/base/at.hpp"
#include "catena/elements/all.hpp"
#include "catena/model/model_add.hpp"
#include "catena/model/rope_layout.hpp"
#include "catena/model/rope_pieces.hpp"

namespace catena {
namespace {

/// The length of the way from one node to another, with what lies on pulleys that roll between them.
template <class S>
S whole_way(const BasicModel<S>& model, const RopeLayout<S>& layout, const std::vector<Frame<S>>& frames, int from,
            int to) {
  std::vector<RopePulley<S>> nodes = layout.nodes();
  for (RopePulley<S>& node : nodes) node.rolls = false;
  RopeLayout<S> whole(model, std::move(nodes), frames);
  whole.off = layout.off;
  RopeMemory memory;
  return whole.between(from, to, memory).way;
}

/// The stretches of a whole rope in the given configuration, from pulley that rolls to pulley that rolls.
template <class S>
std::vector<RopeStretch<S>> follow(const BasicModel<S>& model, const RopeWay<S>& way) {
  std::vector<RopePulley<S>> nodes{way.i};
  nodes.insert(nodes.end(), way.over.begin(), way.over.end());
  nodes.push_back(way.j);
  nodes.front().radius = nodes.back().radius = S(0.0);
  nodes.front().rolls = nodes.back().rolls = false;
  const int last = static_cast<int>(nodes.size()) - 1;
  // About one place, so that rounding does not grow with the distance from the ground's origin.
  const Vec2<S> origin = model.frame(nodes.front().body).origin();
  std::vector<Frame<S>> frames;
  for (const RopePulley<S>& node : nodes) {
    Frame<S> frame = model.frame(node.body);
    frame.x = frame.x - origin.x;
    frame.y = frame.y - origin.y;
    frames.push_back(frame);
  }
  RopeLayout<S> layout(model, std::move(nodes), frames);
  layout.choose_sides();
  std::vector<RopeStretch<S>> all;
  const auto append_nodes = [&](RopeStretch<S>& stretch, int from, int to) {
    for (int k = from; k <= to; ++k) stretch.nodes.push_back(layout.nodes()[at(k)]);
  };
  int from = 0, to = last;
  for (int first = 0, end = 1; first < last; first = end++) {
    while (end < last && !layout.nodes()[at(end)].rolls) ++end;
    layout.choose_off(first, end);
    RopeMemory memory;
    RopeStretch<S> stretch = layout.between(first, end, memory);
    if (stretch.straight.empty()) {
      // Figures show what is no element with the stretch before it, or with the first one.
      if (!all.empty()) append_nodes(all.back(), first + 1, end);
      continue;
    }
    stretch.skeleton = layout.skeleton(first, end).straight;
    if (all.empty()) from = first;
    to = end;
    append_nodes(stretch, all.empty() ? 0 : first, end);
    all.push_back(std::move(stretch));
  }
  if (all.empty()) throw ModelError("it ties together what does not move relative to each other");
  if (all.size() > 1) {
    const S whole = whole_way(model, layout, frames, from, to);
    for (RopeStretch<S>& stretch : all) stretch.part = stretch.way / whole;
  }
  for (std::size_t k = 0; k + 1 < all.size(); ++k) {
    all[k].nodes.push_back(all[k + 1].nodes[1]);
    all[k].leads_on = true;
  }
  return all;
}

template <class S>
int add_inextensible(BasicModel<S>& model, std::string_view name, const RopeStretch<S>& stretch,
                     const RopeValues<S>& values) {
  const std::vector<RopePiece<S>> pieces = padded(model, stretch, false);
  Rope<S> head;
  static_cast<RopeSpan<S>&>(head) = pieces.front().span;
  head.length = value_of(values.length) < 0 ? stretch.way : values.length;
  head.restitution = values.restitution;
  head.rest_speed = values.rest_speed;
  head.first_part = static_cast<int>(std::get<std::vector<ElementEntry<RopePart<S>, S>>>(model.constraints).size());
  head.parts = static_cast<int>(pieces.size()) - 1;
  const int id =
      model.append(name, ElementEntry<Rope<S>, S>{head, pieces.front().i, pieces.front().j}, ElementKind::gap);
  for (std::size_t k = 1; k < pieces.size(); ++k) {
    RopePart<S> part;
    static_cast<RopeSpan<S>&>(part) = pieces[k].span;
    part.bridge = pieces[k].bridge;
    part.head = id;
    model.append({}, ElementEntry<RopePart<S>, S>{part, pieces[k].i, pieces[k].j}, ElementKind::constraint);
  }
  return id;
}

template <class S>
int add_elastic(BasicModel<S>& model, std::string_view name, const RopeStretch<S>& stretch,
                const RopeValues<S>& values) {
  const std::vector<RopePiece<S>> pieces = padded(model, stretch, true);
  int id = -1;
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    ElementEntry<ElasticRope<S>, S> entry{{}, pieces[p].i, pieces[p].j};
    pieces[p].give(entry.element);
    entry.element.k = values.k / stretch.part;
    entry.element.length = value_of(values.length) < 0 ? stretch.way : values.length * stretch.part;
    if (p == 0) entry.element.pieces = static_cast<int>(pieces.size());
    const int added = model.append(p == 0 ? name : std::string_view(), entry, ElementKind::force);
    if (p == 0) id = added;
  }
  return id;
}

template <class S>
RopePath path_of(const RopeStretch<S>& stretch, int element) {
  RopePath path{.element = element, .leads_on = stretch.leads_on};
  for (const RopePulley<S>& node : stretch.nodes) {
    path.nodes.push_back({.body = node.body,
                          .centre = {value_of(node.centre.x), value_of(node.centre.y)},
                          .radius = node.side * value_of(node.radius),
                          .rolls = node.rolls,
                          .mu = node.mu});
  }
  return path;
}

}  // namespace

template <class S>
std::vector<RopeStretch<S>> rope_stretches(const BasicModel<S>& model, const RopeWay<S>& way) {
  return follow(model, way);
}

template <class S>
int add_rope(BasicModel<S>& model, std::string_view name, const std::vector<RopeStretch<S>>& stretches,
             const RopeValues<S>& values) {
  int first = -1;
  for (std::size_t k = 0; k < stretches.size(); ++k) {
    const std::string own =
        name.empty() || k == 0 ? std::string(name) : std::string(name) + ":" + std::to_string(k + 1);
    const int id = value_of(values.k) > 0 ? add_elastic(model, own, stretches[k], values)
                                          : add_inextensible(model, own, stretches[k], values);
    model.rope_paths.push_back(path_of(stretches[k], id));
    if (k == 0) first = id;
  }
  return first;
}

template std::vector<RopeStretch<double>> rope_stretches(const BasicModel<double>&, const RopeWay<double>&);
template std::vector<RopeStretch<Dual<double, 4>>> rope_stretches(const BasicModel<Dual<double, 4>>&,
                                                                  const RopeWay<Dual<double, 4>>&);
template int add_rope(BasicModel<double>&, std::string_view, const std::vector<RopeStretch<double>>&,
                      const RopeValues<double>&);
template int add_rope(BasicModel<Dual<double, 4>>&, std::string_view, const std::vector<RopeStretch<Dual<double, 4>>>&,
                      const RopeValues<Dual<double, 4>>&);

}  // namespace catena
