#include "catena/model/rope_way.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "catena/base/at.hpp"
#include "catena/elements/all.hpp"
#include "catena/model/model_add.hpp"

namespace catena {
namespace {

constexpr double turn = 2 * std::numbers::pi;
// An angle of contact this little short of a whole turn is none: rounding of one that is zero.
constexpr double no_contact = 1e-9;
// Of the distances of centres: a way that bends less than this does not bend.
constexpr double no_bend = 1e-12;

/// Follows the way of one rope in the given configuration.
template <class S>
class Way {
 public:
  Way(const BasicModel<S>& model, const RopeWay<S>& way) : model_(model) {
    nodes_.push_back(way.i);
    nodes_.insert(nodes_.end(), way.over.begin(), way.over.end());
    nodes_.push_back(way.j);
    nodes_.front().radius = nodes_.back().radius = S(0.0);
    nodes_.front().rolls = nodes_.back().rolls = false;
    last_ = static_cast<int>(nodes_.size()) - 1;
    // About one place, so that rounding does not grow with the distance from the ground's origin.
    const Vec2<S> origin = model.frame(nodes_.front().body).origin();
    for (const RopePulley<S>& node : nodes_) {
      Frame<S> frame = model.frame(node.body);
      frame.x = frame.x - origin.x;
      frame.y = frame.y - origin.y;
      frames_.push_back(frame);
    }
    choose_sides();
  }

  std::vector<RopeStretch<S>> stretches() {
    std::vector<RopeStretch<S>> all;
    for (int first = 0, end = 1; first < last_; first = end++) {
      while (end < last_ && !nodes_[at(end)].rolls) ++end;
      RopeStretch<S> stretch = between(first, end);
      if (stretch.straight.empty()) {
        // Figures show what is no element with the stretch before it, or with the first one.
        if (!all.empty()) append_nodes(all.back(), first + 1, end);
        continue;
      }
      append_nodes(stretch, all.empty() ? 0 : first, end);
      all.push_back(std::move(stretch));
    }
    if (all.empty()) throw ModelError("it ties together what does not move relative to each other");
    for (std::size_t k = 0; k + 1 < all.size(); ++k) {
      all[k].nodes.push_back(all[k + 1].nodes[1]);
      all[k].leads_on = true;
    }
    return all;
  }

 private:
  Vec2<S> place(int k) const { return frames_[at(k)].point(nodes_[at(k)].centre); }
  S signed_radius(int k) const { return S(static_cast<double>(nodes_[at(k)].side)) * nodes_[at(k)].radius; }
  bool stands(int k) const {
    const int body = nodes_[at(k)].body;
    return body < 0 || model_.bodies[at(body)].fixed;
  }
  /// Whether two neighbours do not move relative to each other.
  bool together(int k) const { return nodes_[at(k)].body == nodes_[at(k + 1)].body || (stands(k) && stands(k + 1)); }
  std::string name(int k) const {
    return k == 0 ? "its end i" : k == last_ ? "its end j" : "pulley " + std::to_string(k) + " of \"over\"";
  }

  void append_nodes(RopeStretch<S>& stretch, int first, int last) const {
    for (int k = first; k <= last; ++k) stretch.nodes.push_back(nodes_[at(k)]);
  }

  void choose_sides() {
    nodes_.front().side = nodes_.back().side = 1;
    for (int k = 1; k < last_; ++k) {
      RopePulley<S>& node = nodes_[at(k)];
      if (node.side == 0 && value_of(node.radius) > 0) {
        const Vec2<S> in = place(k) - place(k - 1), out = place(k + 1) - place(k);
        const double bend = value_of(cross(in, out));
        if (!(std::abs(bend) > no_bend * std::abs(value_of(norm(in)) * value_of(norm(out))))) {
          throw ModelError("its way does not bend at " + name(k) +
                           ": say with \"side\" on which side of the rope that is, 1 on the left from i to j, or -1");
        }
        node.side = bend > 0 ? 1 : -1;
      }
      if (node.side == 0) node.side = 1;
    }
  }

  RopeStretch<S> between(int first, int end) {
    RopeStretch<S> result;
    bool all_together = true;
    for (int k = first; k < end; ++k) all_together = all_together && together(k);
    if (all_together) return result;
    struct Wound {
      int body;
      S by_turn;
    };
    std::vector<Wound> wound;
    S constant(0.0);
    double fixed_before = std::nan("");
    double theta = 0;
    for (int k = first; k < end; ++k) {
      RopeSpan<S> span = straight_from(k, k == first, theta);
      const bool starts = k == first && nodes_[at(k)].rolls, ends = k + 1 == end && nodes_[at(end)].rolls;
      const Frame<S>&i = frames_[at(k)], &j = frames_[at(k + 1)];
      const S heading = span.heading(span.line(separation(i, j, span.s_i, span.s_j)).along);
      // Wound rope counts from where it lies in the given configuration.
      if (starts) {
        span.turn_i = -span.radius_i;
        span.constant += span.radius_i * (i.phi - heading);
      }
      if (ends) {
        span.turn_j = span.radius_j;
        span.constant += span.radius_j * (heading - j.phi);
      }
      const S extent = span.extent(i, j);
      result.way += extent;
      if (together(k)) {
        // Its direction turns with the body.
        const S by_turn = span.radius_i - span.radius_j + span.turn_i + span.turn_j;
        const bool moves = !stands(k);
        constant += moves ? extent - by_turn * i.phi : extent;
        if (moves) wound.push_back({nodes_[at(k)].body, by_turn});
        const bool follows_straight = std::isnan(fixed_before) && !result.straight.empty();
        if (follows_straight) result.straight.back().span.next_to.after = span.angle - value_of(i.phi);
        fixed_before = span.angle - value_of(j.phi);
        continue;
      }
      if (k > first) {
        if (std::isnan(fixed_before)) {
          span.next_to.follows = true;
        } else {
          span.next_to.before = fixed_before;
        }
      }
      fixed_before = std::nan("");
      result.straight.push_back({nodes_[at(k)].body, nodes_[at(k + 1)].body, span});
    }
    for (const Wound& w : wound) {
      for (auto& part : result.straight) {
        if (part.i != w.body && part.j != w.body) continue;
        (part.i == w.body ? part.span.turn_i : part.span.turn_j) += w.by_turn;
        break;
      }
    }
    result.straight.front().span.constant += constant;
    return result;
  }

  /// The straight line from node k on; theta: its direction, continued from that of the one before.
  RopeSpan<S> straight_from(int k, bool first, double& theta) {
    RopeSpan<S> span;
    span.s_i = nodes_[at(k)].centre;
    span.s_j = nodes_[at(k + 1)].centre;
    span.radius_i = signed_radius(k);
    span.radius_j = signed_radius(k + 1);
    const Vec2<S> h = separation(frames_[at(k)], frames_[at(k + 1)], span.s_i, span.s_j);
    if (!span.exists(h)) {
      throw ModelError("there is no straight line between " + name(k) + " and " + name(k + 1) +
                       ": one is inside the circle of the other, their centres being " +
                       std::to_string(value_of(norm(h))) + " m apart");
    }
    const Vec2<S> along = span.line(h).along;
    const double size = value_of(norm(along)), angle = std::atan2(value_of(along.y), value_of(along.x));
    span.direction = {value_of(along.x) / size, value_of(along.y) / size};
    if (first) {
      theta = angle;
    } else {
      const double sense = nodes_[at(k)].side;
      double contact = sense * (angle - theta);
      contact -= turn * std::floor(contact / turn);
      const bool none = contact > turn - no_contact;
      // Round a point the rope turns either way.
      const bool point = value_of(nodes_[at(k)].radius) == 0;
      if (none || (point && contact > turn / 2)) contact -= turn;
      theta += sense * contact;
    }
    span.angle = theta;
    return span;
  }

  const BasicModel<S>& model_;
  std::vector<RopePulley<S>> nodes_;
  std::vector<Frame<S>> frames_;
  int last_ = 0;
};

/// Two bodies that a rope ties across others that stand still.
struct Tie {
  int i, j;
};

/// Calls f(body) for both bodies of a stretch that move.
template <class Model, class Straight, class F>
void for_moving(const Model& model, const Straight& straight, F&& f) {
  for (const int body : {straight.i, straight.j}) {
    if (body >= 0 && !model.bodies[at(body)].fixed) f(body);
  }
}

template <class S>
int add_inextensible(BasicModel<S>& model, std::string_view name, const RopeStretch<S>& stretch,
                     const RopeValues<S>& values) {
  const auto& parts = std::get<std::vector<ElementEntry<RopePart<S>, S>>>(model.constraints);
  // Bodies that no stretch joins to those before.
  std::vector<Tie> bridges;
  int known = -1;
  for (const auto& straight : stretch.straight) {
    bool joined = known < 0;
    int moving = -1;
    for_moving(model, straight, [&](int body) {
      joined = joined || body == known;
      moving = body;
    });
    if (!joined) bridges.push_back({known, moving});
    if (moving >= 0) known = moving;
  }
  Rope<S> head;
  static_cast<RopeSpan<S>&>(head) = stretch.straight.front().span;
  head.length = value_of(values.length) < 0 ? stretch.way : values.length;
  head.restitution = values.restitution;
  head.rest_speed = values.rest_speed;
  head.first_part = static_cast<int>(parts.size());
  head.parts = static_cast<int>(stretch.straight.size() + bridges.size()) - 1;
  const int id = model.append(
      name, ElementEntry<Rope<S>, S>{head, stretch.straight.front().i, stretch.straight.front().j}, ElementKind::gap);
  const auto add = [&](const RopeSpan<S>& span, int i, int j, bool bridge) {
    RopePart<S> part;
    static_cast<RopeSpan<S>&>(part) = span;
    part.bridge = bridge;
    part.head = id;
    model.append({}, ElementEntry<RopePart<S>, S>{part, i, j}, ElementKind::constraint);
  };
  for (std::size_t k = 1; k < stretch.straight.size(); ++k)
    add(stretch.straight[k].span, stretch.straight[k].i, stretch.straight[k].j, false);
  for (const Tie& tie : bridges) add({}, tie.i, tie.j, true);
  return id;
}

template <class S>
int add_elastic(BasicModel<S>& model, std::string_view name, const RopeStretch<S>& stretch,
                const RopeValues<S>& values) {
  std::vector<ElementEntry<ElasticRope<S>, S>> pieces;
  std::vector<int> bodies;
  for (const auto& straight : stretch.straight) {
    ElementEntry<ElasticRope<S>, S> piece{{}, straight.i, straight.j};
    static_cast<RopeSpan<S>&>(piece.element) = straight.span;
    pieces.push_back(piece);
    for_moving(model, straight, [&](int body) {
      if (std::find(bodies.begin(), bodies.end(), body) == bodies.end()) bodies.push_back(body);
    });
  }
  const auto joins = [](const auto& piece, int a, int b) {
    return (piece.i == a && piece.j == b) || (piece.i == b && piece.j == a);
  };
  for (std::size_t a = 0; a < bodies.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      if (std::any_of(pieces.begin(), pieces.end(), [&](const auto& p) { return joins(p, bodies[a], bodies[b]); }))
        continue;
      ElementEntry<ElasticRope<S>, S> piece{{}, bodies[b], bodies[a]};
      piece.element.bridge = true;
      pieces.push_back(piece);
    }
  }
  // Every block of g g^T belongs to the first element that has it.
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    auto& piece = pieces[p];
    const auto earlier = pieces.begin() + static_cast<std::ptrdiff_t>(p);
    const auto is_first = [&](int body) {
      return std::none_of(pieces.begin(), earlier, [&](const auto& e) { return e.i == body || e.j == body; });
    };
    piece.element.owns_i = is_first(piece.i);
    piece.element.owns_j = is_first(piece.j);
    piece.element.owns_pair =
        std::none_of(pieces.begin(), earlier, [&](const auto& e) { return joins(e, piece.i, piece.j); });
  }
  int id = -1;
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    ElasticRope<S>& element = pieces[p].element;
    element.k = values.k;
    element.length = value_of(values.length) < 0 ? stretch.way : values.length;
    if (p == 0) element.pieces = static_cast<int>(pieces.size());
    const int added = model.append(p == 0 ? name : std::string_view(), pieces[p], ElementKind::force);
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
                          .rolls = node.rolls});
  }
  return path;
}

}  // namespace

template <class S>
std::vector<RopeStretch<S>> rope_stretches(const BasicModel<S>& model, const RopeWay<S>& way) {
  return Way<S>(model, way).stretches();
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
