#include "mechanisms.hpp"

#include <array>
#include <cmath>
#include <string>

#include "catena/elements/constraints/absolute_angle.hpp"
#include "catena/elements/constraints/absolute_y.hpp"
#include "catena/elements/constraints/revolute.hpp"
#include "catena/model/model_add.hpp"

namespace bench {

using namespace catena;

namespace {

std::string name(const char* kind, int k) { return kind + std::to_string(k); }

Vec2<double> along(double length) { return {length, 0}; }

}  // namespace

int add_rod(Model& model, const std::string& label, Vec2<double> from, Vec2<double> to) {
  const Vec2<double> direction = to - from;
  const double length = norm(direction);
  return model.add_body(label, {.mass = 1,
                                .inertia = length * length / 12,
                                .position = 0.5 * (from + to),
                                .angle = std::atan2(direction.y, direction.x)});
}

std::shared_ptr<Model> chain(int links) {
  auto model = std::make_shared<Model>();
  model->gravity = {0, -9.81};
  Vec2<double> tip{};
  for (int k = 1; k <= links; ++k) {
    const double angle = 0.3 * std::sin(k);
    const Vec2<double> next = tip + Vec2<double>{std::cos(angle), std::sin(angle)};
    const int body = add_rod(*model, name("link", k), tip, next);
    const Vec2<double> pin = k == 1 ? tip : along(0.5);
    model->add(name("pin", k), Revolute<>{pin, along(-0.5)}, k == 1 ? ground : body - 1, body);
    tip = next;
  }
  return model;
}

std::shared_ptr<Model> dyad_ladder(int dyads) {
  auto model = std::make_shared<Model>();
  Vec2<double> tip{0.1, 0};
  int previous = add_rod(*model, "crank", {0, 0}, tip);
  model->add("O", Revolute<>{{0, 0}, along(-0.05)}, ground, previous);
  Vec2<double> tip_local = along(0.05);
  const double coupler = 0.25, rocker = 0.2;
  for (int k = 1; k <= dyads; ++k) {
    const Vec2<double> pivot{tip.x + 0.2, tip.y - 0.15 + (k % 2 ? 0.02 : 0)};
    const Vec2<double> d = pivot - tip;
    const double distance = norm(d);
    const double turn =
        std::acos((coupler * coupler + distance * distance - rocker * rocker) / (2 * coupler * distance));
    const double angle = std::atan2(d.y, d.x) + turn;
    const Vec2<double> joint = tip + coupler * Vec2<double>{std::cos(angle), std::sin(angle)};
    const int bar = add_rod(*model, name("coupler", k), tip, joint);
    const int arm = add_rod(*model, name("rocker", k), pivot, joint);
    model->add(name("A", k), Revolute<>{tip_local, along(-coupler / 2)}, previous, bar);
    model->add(name("B", k), Revolute<>{along(coupler / 2), along(rocker / 2)}, bar, arm);
    model->add(name("O", k), Revolute<>{pivot, along(-rocker / 2)}, ground, arm);
    previous = arm;
    tip_local = {0, 0};
    tip = 0.5 * (pivot + joint);
  }
  model->add_driver("drive", AbsoluteAngle<>{}, 0, ground,
                    TimeFunction<double>::harmonic(dyads > 100 ? 0.3 / std::sqrt(dyads) : 0.1, 1.5));
  return model;
}

std::shared_ptr<Model> scissor_lift(int stages) {
  auto model = std::make_shared<Model>();
  const double tilt = 0.4, c = std::cos(tilt), s = std::sin(tilt);
  for (int k = 0; k < stages; ++k) {
    add_rod(*model, name("up", k), {0, k * s}, {c, (k + 1) * s});
    add_rod(*model, name("down", k), {0, (k + 1) * s}, {c, k * s});
  }
  model->add("foot", Revolute<>{{0, 0}, along(-0.5)}, ground, 0);
  model->add("slide", AbsoluteY<>{along(0.5)}, 1, ground, 0.0);
  for (int k = 0; k < stages; ++k) {
    const int up = 2 * k, down = 2 * k + 1;
    model->add(name("middle", k), Revolute<>{{0, 0}, {0, 0}}, up, down);
    if (k + 1 == stages) break;
    model->add(name("right", k), Revolute<>{along(0.5), along(0.5)}, up, down + 2);
    model->add(name("left", k), Revolute<>{along(-0.5), along(-0.5)}, down, up + 2);
  }
  const std::array<TimeFunction<double>, 2> terms = {TimeFunction<double>(tilt),
                                                     TimeFunction<double>::harmonic(0.3, 1.5)};
  model->add_driver("drive", AbsoluteAngle<>{}, 0, ground, TimeFunction<double>::sum({terms.begin(), terms.end()}));
  return model;
}

}  // namespace bench
