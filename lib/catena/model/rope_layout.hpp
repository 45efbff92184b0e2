// How a rope lies: from its ends and pulleys, and where these are, to straight stretches.
//
//   theta_out = theta_in + b c        b: side of the pulley (1: left), c >= 0: its angle of contact
//
// A pulley with c < 0 has the rope beside it: the rope runs straight from the one before to the next one. In a given
// place only c modulo a whole turn is known. A rope that is beside its pulley would have to cross itself to touch it:
// with psi = 2 pi - c < pi both stretches are longer than R tan(psi / 2). So would one whose ends lean across each
// other behind half a turn; c counts as -psi where they would lean by more than 60 degrees, psi < 2 pi / 3. In motion c
// goes on from what it was. Points (R = 0) are eyes, which the rope passes through, and pulleys that roll hold what
// winds on them: neither is ever left. Units: m, rad. Errors: ModelError, as a phrase about the rope.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "catena/model/rope_path.hpp"
#include "catena/model/rope_turns.hpp"
#include "catena/model/rope_way.hpp"

namespace catena {

/// What goes on from one laying of a stretch to the next; NaN: nothing is known.
struct RopeMemory : RopeTurns {
  double wound_i = 0, wound_j = 0;  ///< R (phi - theta), R (theta - phi) of ends that wind, as first given
};

template <class S>
class RopeLayout {
 public:
  /// `frames`: of the bodies of the nodes, about a common origin near them. `off`: by node.
  RopeLayout(const BasicModel<S>& model, std::vector<RopePulley<S>> nodes, std::vector<Frame<S>> frames)
      : model_(model), nodes_(std::move(nodes)), frames_(std::move(frames)), off(nodes_.size(), 0) {
    last_ = static_cast<int>(nodes_.size()) - 1;
  }

  const std::vector<RopePulley<S>>& nodes() const { return nodes_; }
  int last() const { return last_; }
  /// Whether two nodes do not move relative to each other.
  bool together(int a, int b) const { return nodes_[at(a)].body == nodes_[at(b)].body || (stands(a) && stands(b)); }
  bool can_leave(int k) const {
    return k > 0 && k < last_ && !nodes_[at(k)].rolls && value_of(nodes_[at(k)].radius) > 0;
  }

  void choose_sides();
  /// Finds which pulleys between two nodes the rope lies beside, from the place alone.
  void choose_off(int first, int end);
  /// The stretch between two nodes that are ends of it; no straight line in it: they all move together. `memory`: taken
  /// over where it is known, and brought up to date.
  RopeStretch<S> between(int first, int end, RopeMemory& memory) const;
  /// The bodies of its straight lines if every pulley were touched.
  RopeStretch<S> skeleton(int first, int end) const;
  /// The straight line between two nodes, with no direction yet; throws where there is none.
  RopeSpan<S> line(int a, int b) const;
  /// The nearest node before and after k that is touched.
  int before(int k) const;
  int after(int k) const;

 private:
  static std::size_t at(int k) { return static_cast<std::size_t>(k); }
  static constexpr double turn = 2 * std::numbers::pi;
  // An angle of contact this little short of a whole turn is none: rounding of one that is zero.
  static constexpr double no_contact = 1e-9;
  // Of the distances of centres: a way that bends less than this does not bend.
  static constexpr double no_bend = 1e-12;

  Vec2<S> place(int k) const { return frames_[at(k)].point(nodes_[at(k)].centre); }
  S signed_radius(int k) const { return S(static_cast<double>(nodes_[at(k)].side)) * nodes_[at(k)].radius; }
  bool stands(int k) const {
    const int body = nodes_[at(k)].body;
    return body < 0 || model_.bodies[at(body)].fixed;
  }
  std::string name(int k) const {
    return k == 0 ? "its end i" : k == last_ ? "its end j" : "pulley " + std::to_string(k) + " of \"over\"";
  }
  /// Direction and length of the straight line between two nodes; not a number where there is none.
  struct Straight {
    double theta, length;
  };
  Straight straight(int a, int b) const;
  /// The angle of contact of node k in (-pi, 2 pi): below zero the rope would cross itself to touch it.
  double contact_between(int a, int k, int b) const;
  double contact_at(int k, double theta, double out, double known) const;
  /// A line between nodes a and b, and which of them winds the rope as an end of the stretch.
  struct Winding {
    int a, b;
    bool on_a, on_b;
  };
  void wind(RopeSpan<S>& span, const Winding& at_ends, bool going_on, RopeMemory& memory) const;
  /// Rope that a body winds, m/rad.
  struct Wound {
    int body;
    S by_turn;
  };
  static void share_out(const std::vector<Wound>& wound, const S& constant, RopeStretch<S>& stretch);

  const BasicModel<S>& model_;
  std::vector<RopePulley<S>> nodes_;
  std::vector<Frame<S>> frames_;
  int last_ = 0;

 public:
  std::vector<char> off;
};

template <class S>
int RopeLayout<S>::before(int k) const {
  do --k;
  while (off[at(k)]);
  return k;
}

template <class S>
int RopeLayout<S>::after(int k) const {
  do ++k;
  while (off[at(k)]);
  return k;
}

template <class S>
void RopeLayout<S>::choose_sides() {
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

template <class S>
typename RopeLayout<S>::Straight RopeLayout<S>::straight(int a, int b) const {
  RopeSpan<S> span;
  span.radius_i = signed_radius(a);
  span.radius_j = signed_radius(b);
  const Vec2<S> h = separation(frames_[at(a)], frames_[at(b)], nodes_[at(a)].centre, nodes_[at(b)].centre);
  if (!span.exists(h)) return {std::nan(""), std::nan("")};
  const auto line = span.line(h);
  return {std::atan2(value_of(line.along.y), value_of(line.along.x)), value_of(line.length)};
}

template <class S>
double RopeLayout<S>::contact_between(int a, int k, int b) const {
  const Straight in = straight(a, k), out = straight(k, b);
  double contact = nodes_[at(k)].side * (out.theta - in.theta);
  contact -= turn * std::floor(contact / turn);
  if (contact > turn - no_contact) return contact - turn;
  const double needed = value_of(nodes_[at(k)].radius) * std::tan((turn - contact) / 2);
  return contact > most_contact_of_ropes && in.length > needed && out.length > needed ? contact - turn : contact;
}

template <class S>
void RopeLayout<S>::choose_off(int first, int end) {
  std::fill(off.begin() + first, off.begin() + end, 0);
  // Each pass changes one pulley; a rope that no way is found for in so many keeps what the last one found.
  for (int pass = 0; pass < 2 * (end - first); ++pass) {
    int changed = -1;
    double worst = 0;
    for (int k = first + 1; k < end; ++k) {
      if (!can_leave(k)) continue;
      const double contact = contact_between(before(k), k, after(k));
      const double wrong = off[at(k)] ? (contact < turn / 2 ? contact : 0) : -contact;
      if (!(wrong > worst + no_contact)) continue;
      worst = wrong;
      changed = k;
    }
    if (changed < 0) return;
    off[at(changed)] = !off[at(changed)];
  }
}

template <class S>
RopeSpan<S> RopeLayout<S>::line(int a, int b) const {
  RopeSpan<S> span;
  span.s_i = nodes_[at(a)].centre;
  span.s_j = nodes_[at(b)].centre;
  span.radius_i = signed_radius(a);
  span.radius_j = signed_radius(b);
  const Vec2<S> h = separation(frames_[at(a)], frames_[at(b)], span.s_i, span.s_j);
  if (!span.exists(h)) {
    throw ModelError("there is no straight line between " + name(a) + " and " + name(b) +
                     ": one is inside the circle of the other, their centres being " +
                     std::to_string(value_of(norm(h))) + " m apart");
  }
  const Vec2<S> along = span.line(h).along;
  const double size = value_of(norm(along));
  span.angle = std::atan2(value_of(along.y), value_of(along.x));
  span.direction = {value_of(along.x) / size, value_of(along.y) / size};
  return span;
}

template <class S>
RopeStretch<S> RopeLayout<S>::skeleton(int first, int end) const {
  RopeStretch<S> result;
  for (int k = first; k < end; ++k) {
    if (!together(k, k + 1)) result.straight.push_back({nodes_[at(k)].body, nodes_[at(k + 1)].body, {}});
  }
  return result;
}

// The angle of contact of node k, where the line before has the direction theta and the one behind `out`; `known`: what
// it was, or not a number.
template <class S>
double RopeLayout<S>::contact_at(int k, double theta, double out, double known) const {
  const double now = nodes_[at(k)].side * (out - theta);
  if (!std::isnan(known)) return known + std::remainder(now - known, turn);
  const double contact = now - turn * std::floor(now / turn);
  const bool none = contact > turn - no_contact;
  // Round a point the rope turns either way.
  const bool point = value_of(nodes_[at(k)].radius) == 0;
  return none || (point && contact > turn / 2) ? contact - turn : contact;
}

// Rope that is wound on the ends a and b of a stretch counts from where it lies in the given configuration.
template <class S>
void RopeLayout<S>::wind(RopeSpan<S>& span, const Winding& at_ends, bool going_on, RopeMemory& memory) const {
  const Frame<S>&i = frames_[at(at_ends.a)], &j = frames_[at(at_ends.b)];
  const S heading = span.heading(span.line(separation(i, j, span.s_i, span.s_j)).along);
  const auto count = [&](const S& given, double& first) {
    if (!going_on) first = value_of(given);
    span.constant += going_on ? S(first) : given;
  };
  if (at_ends.on_a) {
    span.turn_i = -span.radius_i;
    count(span.radius_i * (i.phi - heading), memory.wound_i);
  }
  if (at_ends.on_b) {
    span.turn_j = span.radius_j;
    count(span.radius_j * (heading - j.phi), memory.wound_j);
  }
}

// Adds what winds on bodies to the first straight part that each of them is an end of, and a constant length.
template <class S>
void RopeLayout<S>::share_out(const std::vector<Wound>& wound, const S& constant, RopeStretch<S>& stretch) {
  if (stretch.straight.empty())
    throw ModelError("without the pulleys that it lies beside it ties together what does not move");
  for (const Wound& w : wound) {
    for (auto& part : stretch.straight) {
      if (part.i != w.body && part.j != w.body) continue;
      (part.i == w.body ? part.span.turn_i : part.span.turn_j) += w.by_turn;
      break;
    }
  }
  stretch.straight.front().span.constant += constant;
}

template <class S>
RopeStretch<S> RopeLayout<S>::between(int first, int end, RopeMemory& memory) const {
  RopeStretch<S> result;
  bool all_together = true;
  for (int k = first; k < end; ++k) all_together = all_together && together(k, k + 1);
  if (all_together) return result;
  const bool going_on = memory.known();
  memory.contact.resize(nodes_.size(), std::nan(""));
  std::vector<Wound> wound;
  S constant(0.0);
  double fixed_before = std::nan(""), theta = 0;
  for (int a = first, b = 0; a < end; a = b) {
    b = after(a);
    RopeSpan<S> span = line(a, b);
    if (a == first) {
      theta = going_on ? memory.theta + std::remainder(span.angle - memory.theta, turn) : span.angle;
      memory.theta = theta;
    } else {
      double& contact = memory.contact[at(a)];
      contact = contact_at(a, theta, span.angle, going_on ? contact : std::nan(""));
      theta += nodes_[at(a)].side * contact;
    }
    span.angle = theta;
    const Frame<S>&i = frames_[at(a)], &j = frames_[at(b)];
    wind(span, {a, b, a == first && nodes_[at(a)].rolls, b == end && nodes_[at(end)].rolls}, going_on, memory);
    const S extent = span.extent(i, j);
    result.way += extent;
    if (together(a, b)) {
      // Its direction turns with the body.
      const S by_turn = span.radius_i - span.radius_j + span.turn_i + span.turn_j;
      const bool moves = !stands(a);
      constant += moves ? extent - by_turn * i.phi : extent;
      if (moves) wound.push_back({nodes_[at(a)].body, by_turn});
      const bool follows_straight = std::isnan(fixed_before) && !result.straight.empty();
      if (follows_straight) result.straight.back().span.next_to.after = span.angle - value_of(i.phi);
      fixed_before = span.angle - value_of(j.phi);
      continue;
    }
    if (a > first) {
      if (std::isnan(fixed_before)) {
        span.next_to.follows = true;
      } else {
        span.next_to.before = fixed_before;
      }
    }
    fixed_before = std::nan("");
    result.straight.push_back({nodes_[at(a)].body, nodes_[at(b)].body, span});
  }
  share_out(wound, constant, result);
  return result;
}

}  // namespace catena
