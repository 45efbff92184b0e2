// Random mechanisms with more equations than they need, whose motion is known by few coordinates (known_motion.hpp).
//
// Every kind comes in random sizes (1e-2 ... 1e2 m), masses and directions of gravity, with springs and dampers or
// without, turned and shifted in the plane. Bodies have centroids off their pins. Most kinds can pass flat positions,
// in which further equations become dependent; whoever draws them sees to it that they pass with a speed (well_posed).
#pragma once

#include <numbers>
#include <random>

#include "catena/elements/constraints/absolute_angle.hpp"
#include "catena/elements/constraints/absolute_distance.hpp"
#include "catena/elements/constraints/coupler.hpp"
#include "catena/elements/constraints/gear.hpp"
#include "catena/elements/constraints/relative_angle.hpp"
#include "catena/elements/constraints/relative_distance.hpp"
#include "catena/elements/constraints/revolute.hpp"
#include "catena/elements/constraints/slot.hpp"
#include "catena/elements/constraints/translational.hpp"
#include "catena/elements/constraints/weld.hpp"
#include "catena/elements/forces/spring_damper.hpp"
#include "catena/elements/forces/torsion_spring.hpp"
#include "catena/model/model_add.hpp"
#include "oracles/known_motion.hpp"

namespace catena::testing {

/// The kinds, in the order of RedundantMechanism::make().
inline constexpr const char* redundant_kinds[] = {
    "bar on cranks",   "bar on couplers",     "truss that swings", "truss in flight",  "welded pairs", "doubled joints",
    "doubled coupler", "block on two guides", "planetary, 1 dof",  "planetary, 2 dof", "scissor lift"};
inline constexpr int number_of_kinds = static_cast<int>(std::size(redundant_kinds));

class RedundantMechanism {
 public:
  RedundantMechanism(int kind, unsigned seed) : random_(seed * 131u + static_cast<unsigned>(kind)) {
    size_ = std::pow(10.0, uniform(-2, 2));
    mass_ = std::pow(10.0, uniform(-2, 2));
    axis_ = pick(3) == 0 ? uniform(-3, 3) : 0;
    motion_.kind = redundant_kinds[kind];
    motion_.length = size_;
    motion_.pace = std::sqrt(9.81 / size_);
    weightless_ = pick(6) == 0;
    if (!weightless_) motion_.model->gravity = rotated({0, -9.81}, axis_);
    motion_.until = uniform(1, 8) / motion_.pace;
    using Make = void (RedundantMechanism::*)();
    constexpr Make all[] = {&RedundantMechanism::bar_on_cranks,   &RedundantMechanism::bar_on_couplers,
                            &RedundantMechanism::swinging_truss,  &RedundantMechanism::flying_truss,
                            &RedundantMechanism::welded_pairs,    &RedundantMechanism::doubled_joints,
                            &RedundantMechanism::doubled_coupler, &RedundantMechanism::block_on_guides,
                            &RedundantMechanism::planetary_fixed, &RedundantMechanism::planetary_free,
                            &RedundantMechanism::scissor_lift};
    static_assert(std::size(all) == number_of_kinds);
    (this->*all[kind])();
  }

  const KnownMotion& motion() const { return motion_; }

 private:
  using Vec = Vec2<double>;

  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  int pick(int count) { return std::uniform_int_distribution<int>(0, count - 1)(random_); }
  double some_mass() { return mass_ * std::pow(10.0, uniform(-1, 1)); }
  static Vec unit(double angle) { return {std::cos(angle), std::sin(angle)}; }
  static Vec rotated(Vec s, double angle) {
    const double c = std::cos(angle), w = std::sin(angle);
    return {c * s.x - w * s.y, w * s.x + c * s.y};
  }
  double some_rate(double most) { return uniform(-most, most) * motion_.pace; }

  /// A new body of a mass and an inertia that fits; its pose is set by finish().
  int body(double reach) {
    const double mass = some_mass();
    return motion_.model->add_body("b" + std::to_string(motion_.model->bodies.size()),
                                   {.mass = mass, .inertia = mass * reach * reach * uniform(0.05, 0.4)});
  }

  /// Gives all bodies their places and velocities at the start. Joints are added after.
  void place_bodies() {
    const std::vector<JetPlace> places = motion_.places_of(motion_.z, motion_.rate);
    for (std::size_t b = 0; b < places.size(); ++b) {
      BasicBody<double>& body = motion_.model->bodies[b];
      const JetPlace& p = places[b];
      body.position = {static_cast<double>(p.r.x.f), static_cast<double>(p.r.y.f)};
      body.angle = static_cast<double>(p.phi.f);
      body.velocity = {static_cast<double>(p.r.x.d), static_cast<double>(p.r.y.d)};
      body.angular_velocity = static_cast<double>(p.phi.d);
      body.velocity_given = body.angular_velocity_given = true;
    }
  }
  Vec ground_place(int b, Vec s) const {
    const BasicBody<double>& body = motion_.model->bodies[static_cast<std::size_t>(b)];
    return body.position + rotated(s, body.angle);
  }
  Vec local_place(int b, Vec p) const {
    const BasicBody<double>& body = motion_.model->bodies[static_cast<std::size_t>(b)];
    return rotated(p - body.position, -body.angle);
  }
  void pin(int i, Vec s_i, int j, Vec s_j) { motion_.model->add("", Revolute<>{s_i, s_j}, i, j); }
  /// A pin between two bodies (i may be the ground) at a place in the ground frame.
  void pin_at(int i, int j, Vec at) { pin(i, i < 0 ? at : local_place(i, at), j, local_place(j, at)); }

  // Springs and dampers, now and then, as strong as weights; from the ground to some bodies.
  void add_springs() {
    const int bodies = static_cast<int>(motion_.model->bodies.size());
    double weight = 0;
    for (const BasicBody<double>& body : motion_.model->bodies) weight += body.mass * 9.81;
    for (int k = pick(3); k > 0; --k) {
      const int b = pick(bodies);
      KnownSpring known{-1,
                        b,
                        ground_place(b, {}) + uniform(1.5, 5) * size_ * unit(uniform(-3, 3)),
                        {uniform(-0.3, 0.3) * size_, uniform(-0.3, 0.3) * size_},
                        weight / size_ * uniform(0.1, 1),
                        pick(2) ? 0 : weight / size_ / motion_.pace * uniform(0, 0.3),
                        size_ * uniform(0.3, 2)};
      SpringDamper<> spring;
      spring.s_i = known.s_i;
      spring.s_j = known.s_j;
      spring.k = known.k;
      spring.c = known.c;
      spring.length = known.length;
      motion_.model->add_force("", spring, ground, b);
      motion_.springs.push_back(known);
    }
    if (pick(3) == 0) {
      const int b = pick(bodies);
      const double k = weight * size_ * uniform(0, 0.5);
      KnownTorsion known{b, k, pick(2) ? 0 : k / motion_.pace * uniform(0, 0.3), uniform(-2, 2),
                         pick(2) ? 0 : weight * size_ * uniform(-0.3, 0.3)};
      TorsionSpring<> spring;
      spring.k = known.k;
      spring.c = known.c;
      spring.angle = known.angle;
      // n = k (phi - angle) + c phid + N turns j by -n.
      motion_.model->add_force("", spring, ground, b, {TimeFunction<double>(-known.torque)});
      motion_.torsions.push_back(known);
    }
  }

  /// Anchors of cranks, relative to the first: on a line, or anywhere.
  std::vector<Vec> anchors(int count, bool on_line) {
    std::vector<Vec> at{{0, 0}};
    for (int k = 1; k < count; ++k) {
      at.push_back({at.back().x + size_ * uniform(0.5, 1.5), on_line ? 0 : size_ * uniform(-0.6, 0.6)});
    }
    for (Vec& a : at) a = rotated(a, axis_);
    return at;
  }

  // Cranks of one length on a bar, which translates.
  void bar_on_cranks() {
    const int cranks = 2 + pick(5);
    const bool on_line = pick(2) == 0, doubled = pick(4) == 0;
    const double length = size_ * uniform(0.5, 1.5), tilt = uniform(-1, 1);
    const Vec first{size_ * uniform(-2, 2), size_ * uniform(-2, 2)};
    const std::vector<Vec> anchor = anchors(cranks, on_line);
    std::vector<Vec> centre;   // of a crank, from its pin, along it and across
    std::vector<double> turn;  // of a crank's frame against it
    for (int k = 0; k < cranks; ++k) {
      body(length);
      const bool plain = pick(2) == 0;
      centre.push_back(plain ? Vec{length / 2, 0} : Vec{length * uniform(0, 1), length * uniform(-0.3, 0.3)});
      turn.push_back(plain ? 0 : uniform(-3, 3));
    }
    body(2 * size_);
    const Vec bar_centre = {size_ * uniform(-1, 2), size_ * uniform(-0.5, 0.5)};  // from the first crank's end
    motion_.places = [=](const JetCoordinates& z) {
      std::vector<JetPlace> places;
      for (std::size_t k = 0; k < centre.size(); ++k) {
        places.push_back({fixed_point(first + anchor[k]) + turned(z[0], centre[k]), z[0] + Jet{turn[k]}});
      }
      places.push_back({fixed_point(first + bar_centre) + turned(z[0], {length, 0}), {tilt}});
      return places;
    };
    const double axis = axis_;
    // Two cranks lie flat along the line through their anchors.
    const Vec line = anchor[1];
    if (on_line || cranks == 2) {
      const double along = std::atan2(line.y, line.x);
      motion_.flat = [along](const Coordinates& z) { return std::sin(z[0] - along); };
    }
    motion_.z[0] = axis + uniform(-3, 3);
    motion_.rate[0] = some_rate(3);
    place_bodies();
    for (int k = 0; k < cranks; ++k) {
      const Vec foot = first + anchor[static_cast<std::size_t>(k)];
      const Vec end = foot + length * unit(static_cast<double>(motion_.z[0]));
      for (int n = 0; n < (doubled && pick(2) ? 2 : 1); ++n) pin_at(ground, k, foot);
      for (int n = 0; n < (doubled && pick(2) ? 2 : 1); ++n) pin_at(k, cranks, end);
    }
    add_springs();
  }

  // A bar on massless couplers of one length.
  void bar_on_couplers() {
    const int couplers = 2 + pick(5);
    const bool on_line = pick(2) == 0;
    const double length = size_ * uniform(0.5, 1.5), tilt = uniform(-1, 1);
    const Vec first{size_ * uniform(-2, 2), size_ * uniform(-2, 2)};
    const std::vector<Vec> anchor = anchors(couplers, on_line);
    body(2 * size_);
    const Vec bar_centre = {size_ * uniform(-1, 2), size_ * uniform(-0.5, 0.5)};
    motion_.places = [=](const JetCoordinates& z) {
      return std::vector<JetPlace>{{fixed_point(first + bar_centre) + turned(z[0], {length, 0}), {tilt}}};
    };
    if (on_line || couplers == 2) {
      const double along = std::atan2(anchor[1].y, anchor[1].x);
      motion_.flat = [along](const Coordinates& z) { return std::sin(z[0] - along); };
    }
    motion_.z[0] = axis_ + uniform(-3, 3);
    motion_.rate[0] = some_rate(3);
    place_bodies();
    for (const Vec& a : anchor) {
      const Vec foot = first + a, end = foot + length * unit(static_cast<double>(motion_.z[0]));
      motion_.model->add("", Coupler<>{foot, local_place(0, end)}, ground, 0);
    }
    add_springs();
  }

  // Rods of a truss: pins at nodes, diagonals both ways.
  struct Rod {
    int from, to;
    double part;  // of the length, where the centroid lies
  };
  struct Truss {
    std::vector<Vec> node;  // from the truss's own origin
    std::vector<Rod> rods;
  };
  Truss truss() {
    Truss t;
    const int panels = 1 + pick(3);
    const double width = size_ * uniform(0.5, 1.2), height = size_ * uniform(0.5, 1.2);
    for (int k = 0; k <= panels; ++k) {
      for (int up = 0; up < 2; ++up) {
        t.node.push_back({k * width + 0.1 * size_ * uniform(-1, 1), up * height + 0.1 * size_ * uniform(-1, 1)});
      }
    }
    const auto rod = [&](int a, int b) {
      t.rods.push_back({a, b, pick(2) ? 0.5 : uniform(0.2, 0.8)});
      body(norm(t.node[static_cast<std::size_t>(b)] - t.node[static_cast<std::size_t>(a)]));
    };
    rod(0, 1);
    const int overbraced = pick(panels);
    for (int k = 0; k < panels; ++k) {
      const int a = 2 * k;
      rod(a, a + 2);
      rod(a + 1, a + 3);
      rod(a + 2, a + 3);
      const bool both = k == overbraced || pick(2) == 0, up = pick(2) == 0;
      if (both || up) rod(a, a + 3);
      if (both || !up) rod(a + 1, a + 2);
    }
    return t;
  }
  /// Places of the rods when the truss's origin is at `origin` and the truss turned by `angle`.
  static std::vector<JetPlace> places_of_rods(const Truss& t, JetPoint origin, Jet angle) {
    std::vector<JetPlace> places;
    for (const Rod& rod : t.rods) {
      const Vec a = t.node[static_cast<std::size_t>(rod.from)], b = t.node[static_cast<std::size_t>(rod.to)];
      const double along = std::atan2(b.y - a.y, b.x - a.x);
      places.push_back({origin + turned(angle, a + rod.part * (b - a)), angle + Jet{along}});
    }
    return places;
  }
  void pin_rods(const Truss& t, Vec origin, double angle) {
    for (int n = 0; n < static_cast<int>(t.node.size()); ++n) {
      const Vec at = origin + rotated(t.node[static_cast<std::size_t>(n)], angle);
      int first = -1;
      for (int r = 0; r < static_cast<int>(t.rods.size()); ++r) {
        const Rod& rod = t.rods[static_cast<std::size_t>(r)];
        if (rod.from != n && rod.to != n) continue;
        if (first >= 0) pin_at(first, r, at);
        if (first < 0) first = r;
      }
    }
  }
  void swinging_truss() {
    const Truss t = truss();
    const int held = pick(static_cast<int>(t.node.size()));
    const Vec foot{size_ * uniform(-2, 2), size_ * uniform(-2, 2)}, arm = t.node[static_cast<std::size_t>(held)];
    motion_.places = [=](const JetCoordinates& z) {
      return places_of_rods(t, fixed_point(foot) - turned(z[0], arm), z[0]);
    };
    motion_.z[0] = uniform(-3, 3);
    motion_.rate[0] = some_rate(2);
    place_bodies();
    const double angle = static_cast<double>(motion_.z[0]);
    pin_rods(t, foot - rotated(arm, angle), angle);
    const bool all = pick(2) == 0;
    bool pinned = false;
    for (int r = 0; r < static_cast<int>(t.rods.size()); ++r) {
      const Rod& rod = t.rods[static_cast<std::size_t>(r)];
      if ((rod.from != held && rod.to != held) || (pinned && !all)) continue;
      pin_at(ground, r, foot);
      pinned = true;
    }
    add_springs();
  }
  void flying_truss() {
    const Truss t = truss();
    const double size = size_;
    motion_.freedoms = 3;
    motion_.places = [=](const JetCoordinates& z) {
      return places_of_rods(t, {Real(size) * z[1], Real(size) * z[2]}, z[0]);
    };
    motion_.z = {uniform(-3, 3), uniform(-2, 2), uniform(-2, 2)};
    motion_.rate = {some_rate(2), some_rate(2), some_rate(2)};
    motion_.until = std::min(motion_.until, 4 / motion_.pace);
    place_bodies();
    pin_rods(t, {size * static_cast<double>(motion_.z[1]), size * static_cast<double>(motion_.z[2])},
             static_cast<double>(motion_.z[0]));
    if (pick(2)) add_springs();
  }

  // One or two links in series, each of `parts` bodies that move as one.
  struct Links {
    std::vector<int> link;             // of each body
    std::vector<Vec> centre;           // of each body, from its link's first pin
    std::vector<double> turn, length;  // of each body's frame; of each link
    Vec foot;
  };
  Links make_links(int parts) {
    Links l;
    l.foot = {size_ * uniform(-2, 2), size_ * uniform(-2, 2)};
    const int links = 1 + pick(2);
    for (int k = 0; k < links; ++k) {
      l.length.push_back(size_ * uniform(0.5, 1.5));
      for (int p = 0; p < parts; ++p) {
        body(size_);
        l.link.push_back(k);
        l.centre.push_back({size_ * uniform(0, 1.2), size_ * uniform(-0.5, 0.5)});
        l.turn.push_back(uniform(-3, 3));
      }
      motion_.z[static_cast<std::size_t>(k)] = uniform(-3, 3);
      motion_.rate[static_cast<std::size_t>(k)] = some_rate(2);
    }
    motion_.freedoms = links;
    motion_.until = std::min(motion_.until, (links == 1 ? 8 : 4) / motion_.pace);
    motion_.places = [l](const JetCoordinates& z) {
      std::vector<JetPlace> places;
      for (std::size_t b = 0; b < l.link.size(); ++b) {
        const std::size_t k = static_cast<std::size_t>(l.link[b]);
        JetPoint pin = fixed_point(l.foot);
        if (k > 0) pin = pin + turned(z[0], {l.length[0], 0});
        places.push_back({pin + turned(z[k], l.centre[b]), z[k] + Jet{l.turn[b]}});
      }
      return places;
    };
    place_bodies();
    return l;
  }
  Vec joint_of(const Links& l, int k) const {
    return k == 0 ? l.foot : l.foot + l.length[0] * unit(static_cast<double>(motion_.z[0]));
  }
  void welded_pairs() {
    const Links l = make_links(2);
    for (int k = 0; k < motion_.freedoms; ++k) {
      const int a = 2 * k, b = a + 1;
      const Vec joint = joint_of(l, k);
      pin_at(k == 0 ? ground : pick(2), a + pick(2), joint);
      const Vec place = joint + size_ * Vec{uniform(-1, 1), uniform(-1, 1)};
      motion_.model->add("", Weld<>{local_place(a, place), local_place(b, place)}, a, b);
      for (int n = 1 + pick(3); n > 0; --n) {
        const Vec s{size_ * uniform(-1, 1), size_ * uniform(-1, 1)};
        const Vec other = ground_place(a, s) + size_ * uniform(0.3, 1.5) * unit(uniform(-3, 3));
        const int what = pick(4);
        if (what == 0) {
          motion_.model->add("", RelativeAngle<>{}, a, b);
        } else if (what == 1) {
          motion_.model->add("", RelativeDistance<>{s, local_place(b, other)}, a, b);
        } else {
          motion_.model->add("", Coupler<>{s, local_place(b, other)}, a, b);
        }
      }
    }
    add_springs();
  }
  void doubled_joints() {
    const Links l = make_links(1);
    for (int k = 0; k < motion_.freedoms; ++k) {
      for (int n = k == 0 ? 2 : 1 + pick(3); n > 0; --n) pin_at(k == 0 ? ground : k - 1, k, joint_of(l, k));
    }
    add_springs();
  }
  // A body that hangs on a massless link, two or three times the same.
  void doubled_coupler() {
    const double length = size_ * uniform(0.5, 1.5);
    const Vec foot{size_ * uniform(-2, 2), size_ * uniform(-2, 2)},
        arm = size_ * uniform(0.2, 0.8) * unit(uniform(-3, 3));
    body(size_);
    motion_.freedoms = 2;
    motion_.places = [=](const JetCoordinates& z) {
      return std::vector<JetPlace>{{fixed_point(foot) + turned(z[0], {length, 0}) - turned(z[1], arm), z[1]}};
    };
    motion_.z = {uniform(-3, 3), uniform(-3, 3)};
    motion_.rate = {some_rate(2), some_rate(2)};
    motion_.until = std::min(motion_.until, 4 / motion_.pace);
    place_bodies();
    for (int n = 2 + pick(2); n > 0; --n) {
      if (pick(2)) {
        motion_.model->add("", Coupler<>{foot, arm}, ground, 0);
      } else {
        motion_.model->add("", AbsoluteDistance<>{arm, foot}, 0, ground);
      }
    }
    add_springs();
  }
  // A block on two rails side by side, or with its angle held besides.
  void block_on_guides() {
    const double slope = uniform(-3, 3), turn = uniform(-3, 3);
    const Vec start{size_ * uniform(-2, 2), size_ * uniform(-2, 2)}, along = unit(slope);
    const double size = size_;
    body(size_);
    motion_.places = [=](const JetCoordinates& z) {
      return std::vector<JetPlace>{
          {{Jet{start.x} + Real(size * along.x) * z[0], Jet{start.y} + Real(size * along.y) * z[0]}, {turn}}};
    };
    motion_.z[0] = uniform(-1, 1);
    motion_.rate[0] = some_rate(1);
    motion_.until = std::min(motion_.until, 4 / motion_.pace);
    place_bodies();
    for (int n = 2; n > 0; --n) {
      const Vec at = ground_place(0, {}) + size_ * Vec{uniform(-1, 1), uniform(-1, 1)};
      if (n == 2 || pick(2)) {
        motion_.model->add("", Translational<>{at, local_place(0, at), along, rotated(along, -turn)}, ground, 0);
      } else {
        motion_.model->add("", Slot<>{at, local_place(0, at), along}, ground, 0);
        motion_.model->add("", AbsoluteAngle<>{}, 0);
      }
    }
    add_springs();
  }

  // Sun, carrier, three or four planets and a ring, which stands still or turns.
  void planetary(bool free_ring) {
    const int planets = 3 + pick(2);
    const double sun = size_ * uniform(0.3, 1), planet = size_ * uniform(0.2, 0.6), ring = sun + 2 * planet;
    const Vec middle{size_ * uniform(-2, 2), size_ * uniform(-2, 2)};
    std::vector<Vec> off;  // centroids of sun, carrier, ring, planets, from their axles in their own frames
    std::vector<double> start;
    const int first = free_ring ? 3 : 2;
    for (int b = 0; b < first + planets; ++b) {
      body(b < first ? ring : planet);
      const double reach = b < first ? sun : planet;
      off.push_back(pick(2) ? Vec{} : Vec{reach * uniform(-0.5, 0.5), reach * uniform(-0.5, 0.5)});
      start.push_back(uniform(-3, 3));
    }
    std::vector<double> spoke;
    for (int p = 0; p < planets; ++p) spoke.push_back(2 * std::numbers::pi * p / planets + uniform(-0.3, 0.3));
    motion_.freedoms = free_ring ? 2 : 1;
    motion_.places = [=](const JetCoordinates& z) {
      // z: what the carrier, then the sun turned since the start.
      const Jet carrier = z[0];
      const Real s = sun, p = planet, r = ring;
      const Jet sun_turn = free_ring ? z[1] : ((s + r) / s) * carrier;
      const Jet planet_turn = ((s + p) / p) * carrier - (s / p) * sun_turn;
      const Jet ring_turn = (p / r) * planet_turn + ((r - p) / r) * carrier;
      std::vector<JetPlace> places;
      const auto wheel = [&](JetPoint axle, Jet turn) {
        const std::size_t b = places.size();
        const Jet angle = turn + Jet{start[b]};
        places.push_back({axle + turned(angle, off[b]), angle});
      };
      wheel(fixed_point(middle), sun_turn);
      wheel(fixed_point(middle), carrier);
      if (free_ring) wheel(fixed_point(middle), ring_turn);
      for (const double at : spoke) {
        wheel(fixed_point(middle) + turned(carrier + Jet{at}, {sun + planet, 0}), planet_turn);
      }
      return places;
    };
    motion_.rate = {some_rate(3), free_ring ? some_rate(3) : 0};
    place_bodies();
    for (int b = 0; b < first; ++b) pin(ground, middle, b, -1 * off[static_cast<std::size_t>(b)]);
    for (int p = 0; p < planets; ++p) {
      const int b = first + p;
      const Vec axle = middle + (sun + planet) * unit(spoke[static_cast<std::size_t>(p)]);
      pin(1, local_place(1, axle), b, -1 * off[static_cast<std::size_t>(b)]);
      Gear<> inner, outer;
      inner.s_i = -1 * off[0];
      inner.s_j = outer.s_j = -1 * off[static_cast<std::size_t>(b)];
      inner.radius_i = sun;
      inner.radius_j = outer.radius_j = planet;
      outer.radius_i = ring;
      outer.internal = true;
      outer.s_i = free_ring ? -1 * off[2] : middle;
      motion_.model->add("", inner, 0, b);
      motion_.model->add("", outer, free_ring ? 2 : ground, b);
    }
    add_springs();
  }
  void planetary_fixed() { planetary(false); }
  void planetary_free() { planetary(true); }

  // Stages of crossed bars, some of them twice, with more links across and a platform; a spring holds it up.
  void scissor_lift() {
    const int stages = 1 + pick(3);
    const double length = size_ * uniform(0.7, 1.4);
    struct Bar {
      int stage;
      bool rising;  // from left below to right above
      double part;  // of the length, where the centroid lies
    };
    std::vector<Bar> bars;
    for (int k = 0; k < stages; ++k) {
      for (int n = pick(2) ? 2 : 1; n > 0; --n) {
        bars.push_back({k, true, uniform(0.3, 0.7)});
        bars.push_back({k, false, uniform(0.3, 0.7)});
        body(length);
        body(length);
      }
    }
    std::vector<int> links;  // stages with a link from the middle of their falling bar to that of the next one
    std::vector<double> fraction;
    for (int k = 0; k + 1 < stages; ++k) {
      if (pick(3) == 0) continue;
      links.push_back(k);
      fraction.push_back(uniform(0.2, 0.8));
      body(length / 2);
    }
    body(length);  // the platform
    const double shift = length * uniform(0.2, 0.6), height = length * uniform(0.05, 0.3);
    const double axis = axis_;
    const Vec foot{size_ * uniform(-2, 2), size_ * uniform(-2, 2)};
    // Right end of stage k's lower joints is at (L cos z, k L sin z), left at (0, k L sin z), in axes turned by `axis`.
    motion_.places = [=](const JetCoordinates& z) {
      const Jet c = cos(z[0]), s = sin(z[0]);
      const Real L = length;
      std::vector<JetPlace> places;
      const auto put = [&](Jet x, Jet y, Jet angle) {
        const Real ca = std::cos(Real(axis)), sa = std::sin(Real(axis));
        places.push_back({fixed_point(foot) + JetPoint{ca * x - sa * y, sa * x + ca * y}, angle + Jet{axis}});
      };
      for (const Bar& bar : bars) {
        const Real part = bar.part;
        const Jet y = (L * (bar.stage + part)) * s;
        if (bar.rising) {
          put((L * part) * c, y, z[0]);
        } else {
          put((L * (1 - part)) * c, y, Jet{std::numbers::pi_v<Real>} - z[0]);
        }
      }
      for (std::size_t n = 0; n < links.size(); ++n) {
        // From (1 - f) middle + f left joint above, of stage k; along the rising bars, half as long: its middle.
        const Real f = fraction[n];
        put((L * (0.5L * (1 - f) + 0.25L)) * c, (L * (links[n] + 0.5L + 0.5L * f + 0.25L)) * s, z[0]);
      }
      put(Jet{shift}, (L * stages) * s + Jet{height}, {});
      return places;
    };
    motion_.z[0] = uniform(0.5, 1.1);
    motion_.rate[0] = some_rate(0.5);
    place_bodies();
    const double z = static_cast<double>(motion_.z[0]);
    const auto at = [&](double x, double y) {
      return foot + rotated({length * x * std::cos(z), length * y * std::sin(z)}, axis);
    };
    const int platform = static_cast<int>(motion_.model->bodies.size()) - 1;
    for (int b = 0; b < static_cast<int>(bars.size()); ++b) {
      const Bar& bar = bars[static_cast<std::size_t>(b)];
      const int k = bar.stage;
      // Its lower end, its middle and, at the top, its upper end: pinned to the first bar that has the place.
      const auto first_of = [&](int stage, bool rising) {
        int n = 0;
        while (bars[static_cast<std::size_t>(n)].stage != stage || bars[static_cast<std::size_t>(n)].rising != rising)
          ++n;
        return n;
      };
      const Vec low = at(bar.rising ? 0 : 1, k), high = at(bar.rising ? 1 : 0, k + 1), centre = at(0.5, k + 0.5);
      if (k == 0 && bar.rising) pin_at(ground, b, low);
      if (k == 0 && !bar.rising) {
        motion_.model->add("", Slot<>{low, local_place(b, low), unit(axis)}, ground, b);
      }
      if (k > 0) pin_at(first_of(k - 1, !bar.rising), b, low);
      const int mate = first_of(k, true);
      if (b != mate) pin_at(mate, b, centre);
      if (b != first_of(k, bar.rising)) pin_at(first_of(k, bar.rising), b, high);
      // A guide on the left that the lift does not need.
      if (!bar.rising && pick(3) == 0) {
        motion_.model->add("", Slot<>{foot, local_place(b, high), rotated({0, 1}, axis)}, ground, b);
      }
      if (k == stages - 1 && b == first_of(k, false)) pin_at(platform, b, high);
      if (k == stages - 1 && bar.rising) {
        motion_.model->add("", Slot<>{local_place(platform, high), local_place(b, high), {1, 0}}, platform, b);
      }
    }
    for (std::size_t n = 0; n < links.size(); ++n) {
      const int b = static_cast<int>(bars.size() + n), k = links[n];
      const double f = fraction[n];
      int lower = 0, upper = 0;
      while (bars[static_cast<std::size_t>(lower)].stage != k || bars[static_cast<std::size_t>(lower)].rising) ++lower;
      while (bars[static_cast<std::size_t>(upper)].stage != k + 1 || bars[static_cast<std::size_t>(upper)].rising)
        ++upper;
      pin_at(lower, b, at(0.5 * (1 - f), k + 0.5 + 0.5 * f));
      pin_at(upper, b, at(0.5 * (1 - f) + 0.5, k + 1 + 0.5 * f));
    }
    // From the foot to the platform: it carries about all there is.
    double weight = 0;
    for (const BasicBody<double>& one : motion_.model->bodies) weight += one.mass * 9.81;
    const Vec there = ground_place(platform, {});
    KnownSpring known{-1, platform, foot - rotated({0, size_}, axis), {}, 0, 0, 0};
    const double span = norm(there - known.s_i);
    known.k = weight / span * uniform(1, 4);
    known.length = span + (weightless_ ? 0 : 0.6 * weight / known.k);
    if (pick(2)) known.c = known.k / motion_.pace * uniform(0, 0.1);
    SpringDamper<> spring;
    spring.s_i = known.s_i;
    spring.k = known.k;
    spring.c = known.c;
    spring.length = known.length;
    motion_.model->add_force("", spring, ground, platform);
    motion_.springs.push_back(known);
    motion_.flat = [](const Coordinates& q) { return std::sin(2 * q[0]); };
    motion_.until = std::min(motion_.until, 4 / motion_.pace);
  }

  std::mt19937 random_;
  KnownMotion motion_;
  double size_ = 1, mass_ = 1, axis_ = 0;
  bool weightless_ = false;
};

}  // namespace catena::testing
