// A mechanism as bodies and joints at places of the ground frame, and how it becomes a model: in any axes, units and
// order, with joints doubled, with its sketch disturbed. Local points, axes and constants follow from the places.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "catena/elements/all.hpp"
#include "catena/model/model_add.hpp"

namespace catena::testing {

using Vec = Vec2<double>;

inline Vec unit(double angle) { return {std::cos(angle), std::sin(angle)}; }
inline Vec turned(Vec v, double angle) { return v.x * unit(angle) + v.y * perpendicular(unit(angle)); }

/// A joint between two bodies (-1: ground) at places and with a direction in the given configuration.
struct Joint {
  enum class Kind {
    revolute,
    translational,
    slot,
    coupler,
    gear,
    belt,
    rack,
    same_turn,
    weld,
    point_on_curve,
    cam_flat,
    cam_cam,
    held_along,  ///< body j along a direction of the ground: absolute_x, absolute_y in the axes of the recipe
    turning_driver,
    length_driver,
    displacement_driver,
    driver_along,
    angle_driver,
    distance_driver,  ///< of body j from a place of the ground
  };
  static constexpr std::size_t kinds = static_cast<std::size_t>(Kind::distance_driver) + 1;
  Kind kind;
  int i, j;
  Vec at_i, at_j;
  double direction = 0, radius_i = 0, radius_j = 0;
  double amplitude = 0, omega = 0;
  bool other = false;           ///< a crossed belt, a pinion on the right of its rack
  std::vector<Vec> curve = {};  ///< of body i, in its frame: a circle's centre, or points of a spline
  bool closed = true;           ///< the spline
  Vec centre_j = {};            ///< of the circle on body j, in its frame

  bool drives() const { return kind >= Kind::turning_driver; }
};

struct Recipe {
  std::vector<Vec> place;
  std::vector<double> angle;
  std::vector<Joint> joints;

  double extent() const {
    double largest = 0;
    for (const Vec& p : place) largest = std::max({largest, std::abs(p.x), std::abs(p.y)});
    return largest;
  }
};

/// How a recipe is built: turned, moved and scaled, its bodies and joints in another order.
struct Setting {
  double turn = 0, scale = 1;
  Vec shift{};
  unsigned order = 0;    // 0: as it is
  bool doubled = false;  // every joint that is no driver twice
  bool driven = true;    // without drivers if false
  double sketch = 0;     // poses are off by up to this, rad and parts of `extent`, and by whole turns
  unsigned seed = 0;     // of the disturbance
};

inline Curve<double> curve_of(const Joint& joint, double scale) {
  std::vector<Vec> points = joint.curve;
  for (Vec& p : points) p = scale * p;
  if (points.size() == 1) return Curve<double>::circle(points[0], scale * joint.radius_i);
  return Curve<double>::spline(points, joint.closed ? SplineEnd::periodic : SplineEnd::natural);
}

/// The places of a recipe in a model's setting.
class RecipeBuilder {
 public:
  RecipeBuilder(const Recipe& recipe, const Setting& setting) : recipe_(recipe), setting_(setting) {}

  std::shared_ptr<Model> build() {
    std::mt19937 random(setting_.order);
    const auto order = [&](std::size_t count) {
      std::vector<std::size_t> places(count);
      std::iota(places.begin(), places.end(), std::size_t{0});
      if (setting_.order != 0) std::shuffle(places.begin(), places.end(), random);
      return places;
    };
    number_.resize(recipe_.place.size());
    // Elements take their constants from the true poses; the disturbed ones are put in place of them afterwards.
    for (std::size_t k : order(recipe_.place.size())) {
      number_[k] = model_->add_body(
          "b" + std::to_string(k),
          {.mass = 1, .inertia = 1, .position = map(recipe_.place[k]), .angle = recipe_.angle[k] + setting_.turn});
    }
    for (std::size_t k : order(recipe_.joints.size())) {
      const Joint& joint = recipe_.joints[k];
      if (joint.drives() && setting_.driven) add_driver("j" + std::to_string(k), joint);
      for (int copy = 0; copy < (setting_.doubled ? 2 : 1) && !joint.drives(); ++copy) {
        add_joint("j" + std::to_string(k) + (copy ? "again" : ""), joint);
      }
    }
    if (setting_.sketch > 0) disturb();
    return model_;
  }

 private:
  Vec map(Vec v) const { return setting_.scale * turned(v, setting_.turn) + setting_.shift; }
  int body(int b) const { return b < 0 ? ground : number_[static_cast<std::size_t>(b)]; }
  static Vec local(const Frame<double>& f, Vec p) { return f.to_local(p - f.origin()); }

  void add_joint(const std::string& name, const Joint& joint) {
    const int i = body(joint.i), j = body(joint.j);
    const Frame<double> frame_i = model_->frame(i), frame_j = model_->frame(j);
    const Vec si = local(frame_i, map(joint.at_i)), sj = local(frame_j, map(joint.at_j));
    const Vec along = unit(joint.direction + setting_.turn), axis = frame_i.to_local(along);
    const double s = setting_.scale, r_i = s * joint.radius_i, r_j = s * joint.radius_j;
    switch (joint.kind) {
      case Joint::Kind::revolute:
        model_->add(name, Revolute<>{si, sj}, i, j);
        break;
      case Joint::Kind::translational:
        model_->add(name, Translational<>{si, sj, axis, {}}, i, j);
        break;
      case Joint::Kind::slot:
        model_->add(name, Slot<>{si, sj, axis}, i, j, 0.0);
        break;
      case Joint::Kind::coupler:
        model_->add(name, Coupler<>{si, sj}, i, j);
        break;
      case Joint::Kind::gear:
        model_->add(name, Gear<>{si, sj, r_i, r_j, false, 0}, i, j);
        break;
      case Joint::Kind::belt:
        model_->add(name, Belt<>{si, sj, r_i, r_j, joint.other, 0}, i, j);
        break;
      case Joint::Kind::rack:
        model_->add(name, RackPinion<>{si, sj, axis, r_j, joint.other ? -1 : 1, 0}, i, j);
        break;
      case Joint::Kind::same_turn:
        model_->add(name, RelativeAngle<>{}, i, j, frame_j.phi - frame_i.phi);
        break;
      case Joint::Kind::weld:
        model_->add(name, Weld<>{si, sj, 0}, i, j);
        break;
      case Joint::Kind::point_on_curve:
        model_->add(name, PointOnCurve<>{.s_i = si, .s_j = sj, .curve = curve_of(joint, s)}, i, j);
        break;
      case Joint::Kind::cam_flat:
        model_->add(name,
                    CamFlat<>{.s_i = si, .s_j = sj, .axis_j = frame_j.to_local(along), .curve = curve_of(joint, s)}, i,
                    j);
        break;
      case Joint::Kind::cam_cam:
        model_->add(name,
                    CamCam<>{.s_i = si,
                             .s_j = sj,
                             .curve_i = curve_of(joint, s),
                             .curve_j = Curve<double>::circle(s * joint.centre_j, r_j)},
                    i, j);
        break;
      default:
        place_along(joint, [&](const auto& element, int first, int second, double value) {
          model_->add(name, element, first, second, value);
        });
        break;
    }
  }

  void add_driver(const std::string& name, const Joint& joint) {
    const int i = body(joint.i), j = body(joint.j);
    const Frame<double> frame_i = model_->frame(i), frame_j = model_->frame(j);
    const Vec si = local(frame_i, map(joint.at_i)), sj = local(frame_j, map(joint.at_j));
    const Vec h = map(joint.at_j) - map(joint.at_i), along = unit(joint.direction + setting_.turn);
    const double s = setting_.scale;
    const auto about = [&](double start, double size) {
      const std::array<TimeFunction<double>, 2> terms = {
          TimeFunction<double>(start), TimeFunction<double>::harmonic(joint.amplitude * size, joint.omega)};
      return TimeFunction<double>::sum({terms.begin(), terms.end()});
    };
    switch (joint.kind) {
      case Joint::Kind::turning_driver:
        model_->add_driver(name, RelativeAngle<>{}, i, j, about(frame_j.phi - frame_i.phi, 1));
        break;
      case Joint::Kind::length_driver:
        model_->add_driver(name, RelativeDistance<>{si, sj}, i, j, about(norm(h), s));
        break;
      case Joint::Kind::displacement_driver:
        model_->add_driver(name, Displacement<>{si, sj, frame_i.to_local(along)}, i, j, about(dot(along, h), s));
        break;
      case Joint::Kind::angle_driver:
        model_->add_driver(name, AbsoluteAngle<>{}, j, ground, about(frame_j.phi, 1));
        break;
      case Joint::Kind::distance_driver:
        model_->add_driver(name, AbsoluteDistance<>{sj, map(joint.at_i)}, j, ground, about(norm(h), s));
        break;
      default:
        place_along(joint, [&](const auto& element, int first, int second, double value) {
          model_->add_driver(name, element, first, second, about(value, s));
        });
        break;
    }
  }

  /// Along an axis of the ground as it is: absolute_x, absolute_y; in a turned scene the same is a displacement.
  template <class F>
  void place_along(const Joint& joint, F&& add) {
    const int j = body(joint.j);
    const Vec p = map(joint.at_j), s = local(model_->frame(j), p);
    if (setting_.turn != 0) {
      const Vec axis = unit(joint.direction + setting_.turn);
      add(Displacement<>{{0, 0}, s, axis}, ground, j, dot(axis, p));
    } else if (joint.direction == 0) {
      add(AbsoluteX<>{s}, j, ground, p.x);
    } else {
      add(AbsoluteY<>{s}, j, ground, p.y);
    }
  }

  void disturb() {
    std::mt19937 random(setting_.seed);
    std::uniform_real_distribution<double> any(-1, 1);
    const double size = setting_.sketch * recipe_.extent() * setting_.scale;
    for (auto& b : model_->bodies) {
      b.position += size * Vec{any(random), any(random)};
      b.angle += setting_.sketch * any(random);
    }
  }

  const Recipe& recipe_;
  Setting setting_;
  std::shared_ptr<Model> model_ = std::make_shared<Model>();
  std::vector<int> number_;
};

inline std::shared_ptr<Model> build(const Recipe& recipe, const Setting& setting) {
  return RecipeBuilder(recipe, setting).build();
}

}  // namespace catena::testing
