// Random driven mechanisms: trees of links whose loops are closed by joints that fit, of every type, with dimensions
// over six orders of magnitude. Every group adds as many equations as coordinates.
#pragma once

#include <numbers>

#include "analysis/mechanism_recipe.hpp"

namespace catena::testing {

class RandomMechanism {
 public:
  RandomMechanism(unsigned seed, int groups) : random_(seed) {
    size_ = std::pow(10.0, uniform(-3, 3));
    add_crank();
    using Group = void (RandomMechanism::*)();
    constexpr Group all[] = {
        &RandomMechanism::add_crank,   &RandomMechanism::add_dyad,    &RandomMechanism::add_dyad,
        &RandomMechanism::add_slider,  &RandomMechanism::add_slotted, &RandomMechanism::add_coupled,
        &RandomMechanism::add_geared,  &RandomMechanism::add_belted,  &RandomMechanism::add_jack,
        &RandomMechanism::add_rack,    &RandomMechanism::add_tappet,  &RandomMechanism::add_roller,
        &RandomMechanism::add_tracked, &RandomMechanism::add_shifted, &RandomMechanism::add_placed};
    for (int g = 0; g < groups; ++g) {
      (this->*all[pick(static_cast<int>(std::size(all)))])();
      if (pick(5) == 0) add_welded();
    }
  }
  const Recipe& recipe() const { return recipe_; }

 private:
  using Kind = Joint::Kind;

  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  double any_angle() { return uniform(0, 2 * std::numbers::pi); }
  int pick(int count) { return std::uniform_int_distribution<int>(0, count - 1)(random_); }
  Vec somewhere() { return size_ * Vec{uniform(-1, 1), uniform(-1, 1)}; }
  double length() { return size_ * std::pow(10.0, uniform(-0.5, 0.5)); }
  int bodies() const { return static_cast<int>(recipe_.place.size()); }
  int any_body() { return pick(bodies() + 1) - 1; }
  Vec near(Vec place) { return place + length() * unit(any_angle()); }
  int add_body(Vec place) {
    recipe_.place.push_back(place);
    recipe_.angle.push_back(uniform(-3, 3));
    return bodies() - 1;
  }
  Vec place_of(int body) const { return recipe_.place[static_cast<std::size_t>(body)]; }
  Vec point_of(int body) { return body < 0 ? somewhere() : near(place_of(body)); }
  Vec local(int body, Vec p) const {
    return turned(p - place_of(body), -recipe_.angle[static_cast<std::size_t>(body)]);
  }
  Vec ground_place(int body, Vec p) const {
    return place_of(body) + turned(p, recipe_.angle[static_cast<std::size_t>(body)]);
  }
  void pin(int i, int j, Vec at) { recipe_.joints.push_back({Kind::revolute, i, j, at, at}); }
  void join(Joint joint) { recipe_.joints.push_back(std::move(joint)); }
  void drive(Joint joint, double amplitude) {
    joint.amplitude = amplitude;
    joint.omega = uniform(0.5, 2);
    join(std::move(joint));
  }

  /// A body pinned to i at a place and turned.
  int add_turned(int i, Vec at) {
    const int j = add_body(near(at));
    pin(i, j, at);
    drive({Kind::turning_driver, i, j, at, at}, uniform(-0.3, 0.3));
    return j;
  }
  void add_crank() {
    const int i = any_body();
    add_turned(i, point_of(i));
  }
  // Two bodies between two others, pinned.
  void add_dyad() {
    const int i = any_body(), j = any_body();
    const Vec a = point_of(i), b = point_of(j), middle = near(0.5 * (a + b));
    const int first = add_body(0.5 * (a + middle)), second = add_body(0.5 * (b + middle));
    pin(i, first, a);
    pin(first, second, middle);
    pin(j, second, b);
  }
  // A rod and a block that slides.
  void add_slider() {
    const int i = any_body(), j = any_body();
    const Vec a = point_of(i), b = point_of(j);
    const int rod = add_body(0.5 * (a + b)), block = add_body(b);
    pin(i, rod, a);
    pin(rod, block, b);
    join({Kind::translational, j, block, b, b, any_angle()});
  }
  // A body pinned to another, held by one more equation with a third: `hold` gets body, third and its point.
  template <class F>
  void add_held(F&& hold) {
    const int i = any_body(), j = any_body();
    const Vec a = point_of(i), b = point_of(j);
    const int body = add_body(near(a));
    pin(i, body, a);
    hold(body, j, a, b);
  }
  void add_slotted() {
    add_held([&](int body, int j, Vec, Vec b) { join({Kind::slot, body, j, b, b, any_angle()}); });
  }
  void add_coupled() {
    add_held([&](int body, int j, Vec a, Vec b) { join({Kind::coupler, body, j, near(a), b}); });
  }
  void add_jack() {
    add_held([&](int body, int j, Vec a, Vec b) {
      const Vec end = near(a);
      drive({Kind::length_driver, body, j, end, b}, 0.05 * norm(end - b));
    });
  }
  void add_shifted() {
    add_held([&](int body, int j, Vec a, Vec b) {
      const Vec end = near(a);
      drive({Kind::displacement_driver, body, j, end, b, any_angle()}, 0.05 * norm(end - b));
    });
  }
  // A curve of the pinned body through the point of the other: an arc, or a spline with the point between two knots.
  void add_tracked() {
    add_held([&](int body, int j, Vec, Vec b) {
      Joint track{Kind::point_on_curve, body, j, b, b};
      const double step = length(), direction = any_angle(), bend = uniform(-0.3, 0.3) / step;
      if (pick(2)) {
        track.radius_i = step;
        track.curve = {local(body, b + step * unit(direction))};
      } else {
        track.closed = false;
        for (double x : {-3.0, -1.0, 1.0, 3.0}) {
          const double along = x * step, across = bend * x * x * step * step;
          track.curve.push_back(local(body, b + along * unit(direction) + across * perpendicular(unit(direction))));
        }
        const Curve<double> curve = curve_of(track, 1);
        track.at_j = ground_place(body, curve.evaluate((curve.first() + curve.last()) / 2).p);
      }
      join(std::move(track));
    });
  }
  // A wheel on a carrier that already carries another body, pinned.
  void add_wheel(Kind kind, double part_i, double part_j, bool other) {
    std::vector<Joint> pins;
    for (const Joint& joint : recipe_.joints) {
      if (joint.kind == Kind::revolute) pins.push_back(joint);
    }
    const Joint first = pins[static_cast<std::size_t>(pick(static_cast<int>(pins.size())))];
    const Vec at = near(first.at_j);
    const int wheel = add_body(at);
    pin(first.i, wheel, at);
    Joint pair{kind, first.j, wheel, first.at_j, at};
    const double apart = norm(at - first.at_j);
    pair.radius_i = part_i * apart;
    pair.radius_j = part_j * apart;
    pair.other = other;
    join(std::move(pair));
  }
  void add_geared() {
    const double part = uniform(0.2, 0.8);
    add_wheel(Kind::gear, part, 1 - part, false);
  }
  void add_belted() {
    const bool crossed = pick(2) == 1;
    const double part_j = uniform(0.1, 0.45), part_i = uniform(0.1, 0.45);
    add_wheel(Kind::belt, part_i, part_j, crossed);
  }
  // A pinion that is turned, and a rack that does not turn against the pinion's carrier.
  void add_rack() {
    const int i = any_body();
    const Vec centre = point_of(i);
    const int pinion = add_turned(i, centre);
    Joint rack{Kind::rack, -1, pinion, {}, centre, any_angle()};
    rack.radius_j = 0.3 * length();
    rack.other = pick(2) == 1;
    const Vec along = unit(rack.direction);
    rack.at_i = centre - (rack.other ? -1 : 1) * rack.radius_j * perpendicular(along) + uniform(-1, 1) * size_ * along;
    rack.i = add_body(near(rack.at_i));
    join(rack);
    join({Kind::same_turn, i, rack.i, rack.at_i, rack.at_i});
  }
  // A cam that is turned: an eccentric circle, or a spline near to an ellipse.
  Joint add_cam(int i, Kind kind) {
    const Vec axle = point_of(i);
    Joint cam{kind, add_turned(i, axle), -1, axle, {}};
    cam.radius_i = 0.5 * length();
    const Vec centre = axle + 0.4 * cam.radius_i * unit(any_angle());
    if (pick(2)) {
      cam.curve = {local(cam.i, centre)};
    } else {
      const double tilt = any_angle(), flat = uniform(0.7, 1);
      for (int k = 0; k < 24; ++k) {
        const Vec e = cam.radius_i * unit(k * std::numbers::pi / 12);
        cam.curve.push_back(local(cam.i, centre + turned({e.x, flat * e.y}, tilt)));
      }
    }
    return cam;
  }
  // A tappet with a flat face that slides on the cam's carrier.
  void add_tappet() {
    const int i = any_body();
    Joint contact = add_cam(i, Kind::cam_flat);
    const double slide = any_angle();
    contact.direction = slide - std::numbers::pi / 2 + uniform(-0.4, 0.4);
    // The place of the cam farthest along the face's normal: among many, then by Newton's method.
    const Curve<double> curve = curve_of(contact, 1);
    const Vec out = local(contact.i, place_of(contact.i) + perpendicular(unit(contact.direction)));
    double s = curve.first();
    for (int k = 0; k < 500; ++k) {
      const double other = curve.first() + k * (curve.last() - curve.first()) / 500;
      if (dot(out, curve.evaluate(other).p) > dot(out, curve.evaluate(s).p)) s = other;
    }
    for (int k = 0; k < 6; ++k) s -= dot(out, curve.evaluate(s).d1) / dot(out, curve.evaluate(s).d2);
    const Vec top = ground_place(contact.i, curve.evaluate(s).p);
    contact.at_j = top + uniform(-1, 1) * size_ * unit(contact.direction);
    contact.j = add_body(near(top));
    join({Kind::translational, i, contact.j, top, top, slide});
    join(std::move(contact));
  }
  // A lever with a round end, pinned to the cam's carrier.
  void add_roller() {
    const int i = any_body();
    Joint contact = add_cam(i, Kind::cam_cam);
    const Vec end = contact.at_i + uniform(1.8, 3) * contact.radius_i * unit(any_angle()), pivot = near(end);
    contact.j = add_body(near(pivot));
    pin(i, contact.j, pivot);
    contact.at_j = end;
    contact.centre_j = local(contact.j, end);
    const Curve<double> curve = curve_of(contact, 1);
    const Vec centre = local(contact.i, end);
    contact.radius_j = norm(curve.evaluate(curve.nearest(centre)).p - centre);
    join(std::move(contact));
  }
  // A body held and moved along axes of the ground, or by its distance from a place there.
  void add_placed() {
    const Vec p = somewhere(), q = near(p);
    if (pick(2)) {
      const int body = add_body(near(p));
      const bool x = pick(2) == 1;
      join({Kind::held_along, -1, body, p, p, x ? 0 : std::numbers::pi / 2});
      drive({Kind::driver_along, -1, body, q, q, x ? std::numbers::pi / 2 : 0}, 0.1 * size_);
      drive({Kind::angle_driver, -1, body, p, p}, uniform(-0.3, 0.3));
    } else {
      const int i = any_body();
      const Vec a = point_of(i);
      const int body = add_body(near(a));
      pin(i, body, a);
      const Vec end = near(a);
      drive({Kind::distance_driver, -1, body, q, end}, 0.05 * norm(end - q));
    }
  }
  void add_welded() {
    const int i = any_body();
    const Vec at = point_of(i);
    const int body = add_body(near(at));
    join({Kind::weld, i, body, at, at});
  }

  std::mt19937 random_;
  double size_ = 1;
  Recipe recipe_;
};

}  // namespace catena::testing
