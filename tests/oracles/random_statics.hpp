// Random mechanisms at rest: trees of bodies on pins, slides and springs, some loops closed by couplers, dead loads and
// weight. Every body is held by something whose energy grows without end or by a pin, so that a minimum exists.
#pragma once

#include <cmath>
#include <memory>
#include <random>
#include <string>

#include "catena/elements/constraints/coupler.hpp"
#include "catena/elements/constraints/revolute.hpp"
#include "catena/elements/constraints/translational.hpp"
#include "catena/elements/forces/point_force.hpp"
#include "catena/model/model_add.hpp"
#include "oracles/static_scenes.hpp"

namespace catena::testing {

/// The same mechanism in other units and elsewhere.
struct StaticScale {
  double length = 1, force = 1;
  Vec2<double> origin{};
};

class RandomStatics {
 public:
  explicit RandomStatics(unsigned seed, const StaticScale& scale = {}) : random_(seed), scale_(scale) {}

  /// A network of springs alone: particles and bodies.
  std::shared_ptr<Model> network() {
    auto model = start();
    const int count = 1 + pick(8);
    for (int k = 0; k < count; ++k) add_body(*model, k);
    for (int k = 0; k < count; ++k) {
      // Three springs from every body: to an earlier one or the ground, off its centre.
      for (int s = 0; s < 3; ++s) add_spring(*model, pick(k + 1) - 1, k);
    }
    add_loads(*model, count);
    return model;
  }

  /// Bodies on pins and slides, each on an earlier one or the ground; springs; up to two couplers that close loops.
  std::shared_ptr<Model> linkage() {
    auto model = start();
    const int count = 1 + pick(8);
    for (int k = 0; k < count; ++k) add_body(*model, k);
    for (int k = 0; k < count; ++k) {
      const int carrier = pick(k + 1) - 1;
      const int kind = pick(10);
      if (kind < 7) {
        const Vec2<double> place = some_place();
        model->add("", Revolute<double>{.s_i = local(*model, carrier, place), .s_j = local(*model, k, place)}, carrier,
                   k);
        if (pick(2) == 0)
          model->add_force("", torsion_spring(scale_.force * scale_.length * stiffness(), 6 * number()), carrier, k);
      } else if (kind < 9) {
        // A slide through both bodies, its axis the same direction seen from either.
        const double direction = 3 * number();
        Translational<double> slide;
        slide.s_i = local(*model, carrier, some_place());
        const Vec2<double> through = global(*model, carrier, slide.s_i);
        slide.s_j = local(*model, k, through);
        slide.axis_i = turned(direction - angle(*model, carrier));
        slide.axis_j = turned(direction - angle(*model, k));
        model->add("", slide, carrier, k);
        add_spring(*model, carrier, k);
      } else {
        for (int s = 0; s < 3; ++s) add_spring(*model, carrier, k);
      }
      if (pick(3) == 0) add_spring(*model, pick(k + 1) - 1, k);
    }
    for (int loop = 0; loop < 2 && count > 3; ++loop) {
      const int i = pick(count) - 1, j = i + 1 + pick(count - i - 1);
      Coupler<double> rod;
      rod.s_i = local(*model, i, some_place());
      rod.s_j = local(*model, j, some_place());
      if (pick(2) == 0) model->add("", rod, i, j);
    }
    add_loads(*model, count);
    return model;
  }

 private:
  int pick(int below) { return static_cast<int>(random_() % static_cast<unsigned>(below)); }
  double number() { return static_cast<double>(random_()) / 2147483648.0 - 1; }
  double stiffness() { return std::pow(10, 2 + 2 * number()); }
  Vec2<double> some_place() {
    const double x = 2 * number(), y = 2 * number();
    return scale_.origin + scale_.length * Vec2<double>{x, y};
  }
  static Vec2<double> turned(double direction) { return {std::cos(direction), std::sin(direction)}; }
  static double angle(const Model& model, int body) {
    return body < 0 ? 0 : model.bodies[static_cast<std::size_t>(body)].angle;
  }
  static Vec2<double> global(const Model& model, int body, const Vec2<double>& local_point) {
    if (body < 0) return local_point;
    const auto& b = model.bodies[static_cast<std::size_t>(body)];
    const Vec2<double> x = turned(b.angle);
    return b.position + local_point.x * x + local_point.y * Vec2<double>{-x.y, x.x};
  }
  static Vec2<double> local(const Model& model, int body, const Vec2<double>& place) {
    if (body < 0) return place;
    const auto& b = model.bodies[static_cast<std::size_t>(body)];
    const Vec2<double> x = turned(b.angle), d = place - b.position;
    return {d.x * x.x + d.y * x.y, -d.x * x.y + d.y * x.x};
  }

  std::shared_ptr<Model> start() {
    auto model = std::make_shared<Model>();
    model->gravity = {number(), -earth};
    return model;
  }
  void add_body(Model& model, int k) {
    model.add_body("b" + std::to_string(k), {.mass = scale_.force * (1 + number()),
                                             .inertia = scale_.force * scale_.length * scale_.length,
                                             .position = some_place(),
                                             .angle = 3 * number()});
  }
  void add_spring(Model& model, int i, int j) {
    const Vec2<double> at_i = local(model, i, some_place()), at_j = local(model, j, some_place());
    const double k = scale_.force / scale_.length * stiffness(), length = scale_.length * (1 + number());
    model.add_force("", spring(at_i, at_j, k, length), i, j);
  }
  void add_loads(Model& model, int count) {
    for (int k = 0; k < count; ++k) {
      if (pick(3) > 0) continue;
      PointForce<double> load;
      load.s_i = scale_.length * Vec2<double>{number(), number()};
      model.add_force("", load, k, ground, {20 * scale_.force * number(), 20 * scale_.force * number()});
    }
  }

  std::mt19937 random_;
  StaticScale scale_;
};

}  // namespace catena::testing
