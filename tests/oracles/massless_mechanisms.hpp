// Random mechanisms with massless bodies whose motion is known (known_motion.hpp): wheels, links, trolleys and idlers
// of any size beside what has mass, and the mechanisms of redundant_mechanisms.hpp with some of their bodies massless.
//
// Sizes 1e-6 ... 1e6 m; wheels a thousandth to a thousand times as large as the rest.
#pragma once

#include "catena/elements/constraints/belt.hpp"
#include "catena/elements/constraints/rack_pinion.hpp"
#include "oracles/redundant_mechanisms.hpp"

namespace catena::testing {

inline constexpr const char* massless_kinds[] = {"wheel between racks", "link of a slider-crank", "trolley",
                                                 "idler of a train"};
inline constexpr int number_of_massless_kinds = static_cast<int>(std::size(massless_kinds));

class MasslessMechanism {
 public:
  MasslessMechanism(int kind, unsigned seed) : random_(seed * 151u + static_cast<unsigned>(kind)) {
    size_ = std::pow(10.0, uniform(-6, 6));
    mass_ = std::pow(10.0, uniform(-3, 3));
    motion_.kind = massless_kinds[kind];
    motion_.length = size_;
    motion_.pace = std::sqrt(9.81 / size_);
    motion_.model->gravity = {0, -9.81};
    motion_.until = uniform(0.5, 2) / motion_.pace;
    using Make = void (MasslessMechanism::*)();
    constexpr Make all[] = {&MasslessMechanism::wheel_between_racks, &MasslessMechanism::slider_crank,
                            &MasslessMechanism::trolley, &MasslessMechanism::idler};
    static_assert(std::size(all) == number_of_massless_kinds);
    (this->*all[kind])();
  }
  const KnownMotion& motion() const { return motion_; }

 private:
  using Vec = Vec2<double>;

  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  int pick(int count) { return std::uniform_int_distribution<int>(0, count - 1)(random_); }
  int body(bool massless, double reach) {
    const double mass = massless ? 0 : mass_ * std::pow(10.0, uniform(-1, 1));
    return motion_.model->add_body("b" + std::to_string(motion_.model->bodies.size()),
                                   {.mass = mass, .inertia = mass * reach * reach * uniform(0.1, 0.4)});
  }
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
  double some_radius() { return size_ * std::pow(10.0, uniform(-3, 3)); }

  // A block on a table and a weight that hangs from it, by racks on a massless wheel; or the block alone, pushed.
  void wheel_between_racks() {
    const double radius = some_radius(), size = size_;
    const bool hangs = pick(2);
    body(true, 1);
    body(false, size_);
    if (hangs) body(false, size_);
    motion_.places = [=](const JetCoordinates& z) {
      // The block moves by size z to the left; the wheel turns with it counter-clockwise.
      const Jet way = Real(size) * z[0];
      std::vector<JetPlace> places = {{{Jet{}, Jet{}}, (1 / Real(radius)) * way}};
      places.push_back({{Jet{Real(size)} - way, Jet{Real(radius)}}, Jet{}});
      if (hangs) places.push_back({{Jet{-Real(radius)}, Jet{} - way}, Jet{}});
      return places;
    };
    motion_.rate[0] = uniform(-1, 1) * motion_.pace;
    place_bodies();
    Model& model = *motion_.model;
    model.add("", Revolute<>{}, ground, 0);
    model.add("", AbsoluteAngle<>{}, 1);
    RackPinion<> rack;
    rack.axis_i = {1, 0};
    rack.radius = radius;
    rack.side = -1;
    model.add("", rack, 1, 0);
    if (hangs) {
      model.add("", AbsoluteAngle<>{}, 2);
      rack.axis_i = {0, 1};
      model.add("", rack, 2, 0);
    } else {
      add_spring(1, {-3 * size_, radius + size_});
    }
  }
  void add_spring(int b, Vec foot) {
    const BasicBody<double>& at = motion_.model->bodies[static_cast<std::size_t>(b)];
    const double k = at.mass * 9.81 / size_ * uniform(0.1, 3);
    KnownSpring known{-1, b, foot, {}, k, pick(2) ? 0 : k / motion_.pace * uniform(0, 0.3), size_ * uniform(0.3, 2)};
    SpringDamper<> spring;
    spring.s_i = known.s_i;
    spring.k = known.k;
    spring.c = known.c;
    spring.length = known.length;
    motion_.model->add_force("", spring, ground, b);
    motion_.springs.push_back(known);
  }

  // Crank and slider of any masses, their connecting rod massless, longer than the crank.
  void slider_crank() {
    const double crank = size_ * uniform(0.3, 1), rod = crank * std::pow(10.0, uniform(0.1, 3)), part = uniform(0, 1);
    const double turn = uniform(-3, 3);
    body(false, crank);
    body(true, rod);
    body(false, crank);
    motion_.places = [=](const JetCoordinates& z) {
      const Real l = rod;
      const JetPoint pin = turned(z[0], {crank, 0});
      const Jet across = (1 / l) * pin.y, along = sqrt(Jet{1} - across * across);
      // The rod's direction is (along, -across); its frame is turned besides.
      const Jet angle{-std::asin(across.f), -across.d / along.f,
                      -(across.dd + across.d * across.d * across.f / (along.f * along.f)) / along.f};
      return std::vector<JetPlace>{
          {turned(z[0], {crank / 2, 0}), z[0]},
          {pin + JetPoint{Real(part) * l * along, Real(-part) * l * across}, angle + Jet{turn}},
          {{pin.x + l * along, Jet{}}, Jet{}}};
    };
    motion_.z[0] = uniform(-3, 3);
    motion_.rate[0] = uniform(1, 3) * motion_.pace;
    place_bodies();
    Model& model = *motion_.model;
    const auto local = [&](Vec s) {
      const double c = std::cos(turn), w = std::sin(turn);
      return Vec{c * s.x + w * s.y, -w * s.x + c * s.y};
    };
    model.add("", Revolute<>{{0, 0}, {-crank / 2, 0}}, ground, 0);
    model.add("", Revolute<>{{crank / 2, 0}, local({-part * rod, 0})}, 0, 1);
    model.add("", Revolute<>{local({(1 - part) * rod, 0}), {0, 0}}, 1, 2);
    model.add("", Translational<>{{0, 0}, {0, 0}, {1, 0}, {1, 0}}, ground, 2);
  }

  // A body that swings under a massless trolley on a rail.
  void trolley() {
    const double arm = size_ * uniform(0.3, 1.5), size = size_;
    body(true, 1);
    body(false, size_ * uniform(0.5, 2));
    motion_.freedoms = 2;
    motion_.places = [=](const JetCoordinates& z) {
      const JetPoint pin{Real(size) * z[1], Jet{}};
      return std::vector<JetPlace>{{pin, Jet{}}, {pin + turned(z[0], {arm, 0}), z[0]}};
    };
    motion_.z = {uniform(-3, 3), 0};
    motion_.rate = {uniform(-2, 2) * motion_.pace, uniform(-1, 1) * motion_.pace};
    place_bodies();
    motion_.model->add("", Translational<>{{0, 0}, {0, 0}, {1, 0}, {1, 0}}, ground, 0);
    motion_.model->add("", Revolute<>{{0, 0}, {-arm, 0}}, 0, 1);
  }

  // Two wheels with masses off their axles, and massless ones in between, in mesh or by belts.
  void idler() {
    const int idlers = 1 + pick(3), wheels = idlers + 2;
    std::vector<double> radius, start;
    std::vector<Vec> off;
    std::vector<Real> ratio{1};
    std::vector<bool> belt;
    double x = 0;
    std::vector<double> axle;
    for (int k = 0; k < wheels; ++k) {
      const bool massless = k > 0 && k < wheels - 1;
      radius.push_back(massless ? some_radius() : size_ * uniform(0.3, 1));
      body(massless, radius.back());
      start.push_back(uniform(-3, 3));
      off.push_back(massless ? Vec{} : Vec{radius.back() * uniform(-0.5, 0.5), radius.back() * uniform(-0.5, 0.5)});
      if (k > 0) {
        belt.push_back(pick(2));
        x += belt.back() ? 1.5 * (radius[static_cast<std::size_t>(k) - 1] + radius.back())
                         : radius[static_cast<std::size_t>(k) - 1] + radius.back();
        ratio.push_back((belt.back() ? 1 : -1) * ratio.back() * Real(radius[static_cast<std::size_t>(k) - 1]) /
                        Real(radius.back()));
      }
      axle.push_back(x);
    }
    motion_.places = [=](const JetCoordinates& z) {
      std::vector<JetPlace> places;
      for (std::size_t k = 0; k < axle.size(); ++k) {
        const Jet angle = ratio[k] * z[0] + Jet{start[k]};
        places.push_back({fixed_point({axle[k], 0}) + turned(angle, off[k]), angle});
      }
      return places;
    };
    motion_.rate[0] = uniform(-2, 2) * motion_.pace;
    place_bodies();
    Model& model = *motion_.model;
    for (int k = 0; k < wheels; ++k) {
      const std::size_t n = static_cast<std::size_t>(k);
      model.add("", Revolute<>{{axle[n], 0}, -1 * off[n]}, ground, k);
      if (k == 0) continue;
      if (belt[n - 1]) {
        Belt<> joint;
        joint.s_i = -1 * off[n - 1];
        joint.s_j = -1 * off[n];
        joint.radius_i = radius[n - 1];
        joint.radius_j = radius[n];
        model.add("", joint, k - 1, k);
      } else {
        Gear<> joint;
        joint.s_i = -1 * off[n - 1];
        joint.s_j = -1 * off[n];
        joint.radius_i = radius[n - 1];
        joint.radius_j = radius[n];
        model.add("", joint, k - 1, k);
      }
    }
  }

  std::mt19937 random_;
  KnownMotion motion_;
  double size_ = 1, mass_ = 1;
};

/// Kinds of redundant_mechanisms.hpp whose bodies may be massless: all but the body on one link, a point mass of which
/// flies freely until it is stretched.
inline constexpr int massless_variants[] = {0, 1, 2, 3, 4, 5, 7, 8, 9, 10};
inline constexpr int all_massless_kinds = number_of_massless_kinds + static_cast<int>(std::size(massless_variants));

/// The motion of the same mechanism with some bodies massless, or without inertia; false: too little mass would be left
/// there or in other positions.
inline bool make_some_massless(KnownMotion& motion, unsigned seed) {
  std::mt19937 random(seed);
  const KnownMotion before = motion;
  auto model = std::make_shared<Model>(*motion.model);
  int changed = 0;
  for (BasicBody<double>& body : model->bodies) {
    const unsigned what = random() % 6;
    if (what > 2) continue;
    ++changed;
    if (what != 2) body.inertia = 0;
    if (what != 1) body.mass = 0;
  }
  motion.model = model;
  constexpr int places = 100;
  for (int k = 0; k < places; ++k) {
    Coordinates z = motion.z;
    for (Real& value : z) value += Real(random() % 1000) / 1000 * 2 * std::numbers::pi_v<Real> * (k > 0);
    if (!(motion.constrained_mass(z) > 1e-3L * before.constrained_mass(z))) return false;
  }
  return changed > 0;
}

}  // namespace catena::testing
