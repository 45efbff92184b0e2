#include "moving_mechanisms.hpp"

#include <cmath>
#include <numbers>

#include "catena/elements/constraints/absolute_y.hpp"
#include "catena/elements/constraints/relative_distance.hpp"
#include "catena/elements/constraints/revolute.hpp"
#include "catena/elements/constraints/slot.hpp"
#include "catena/elements/forces/spring_damper.hpp"
#include "catena/elements/forces/torque.hpp"
#include "catena/model/model_add.hpp"

namespace bench {

using namespace catena;

std::shared_ptr<Model> straight_chain(int n) {
  auto model = std::make_shared<Model>();
  model->gravity = {0, -9.81};
  for (int k = 0; k < n; ++k) {
    const int rod =
        model->add_body("rod" + std::to_string(k), {.mass = 1, .inertia = 1.0 / 12, .position = {k + 0.5, 0}});
    model->add("", Revolute<>{{k == 0 ? 0 : 0.5, 0}, {-0.5, 0}}, k == 0 ? ground : rod - 1, rod);
  }
  return model;
}

std::shared_ptr<Model> four_bars(int n) {
  auto model = std::make_shared<Model>();
  model->gravity = {0, -9.81};
  const auto rod = [&](const std::string& name, Vec2<double> middle, double angle, double speed, double omega) {
    const int body = model->add_body(name, {.mass = 1, .inertia = 1.0 / 12, .position = middle, .angle = angle});
    BasicBody<double>& values = model->bodies[static_cast<std::size_t>(body)];
    values.velocity = {speed, 0};
    values.angular_velocity = omega;
    values.velocity_given = values.angular_velocity_given = true;
    return body;
  };
  int before = -1;
  for (int k = 0; k <= n; ++k) {
    const int crank = rod("crank" + std::to_string(k), {k + 0.0, 0.5}, std::numbers::pi / 2, 0.5, -1);
    model->add("", Revolute<>{{k + 0.0, 0}, {-0.5, 0}}, ground, crank);
    if (k > 0) {
      const int bar = rod("bar" + std::to_string(k), {k - 0.5, 1}, 0, 1, 0);
      model->add("", Revolute<>{{0.5, 0}, {-0.5, 0}}, before, bar);
      model->add("", Revolute<>{{0.5, 0}, {0.5, 0}}, crank, bar);
    }
    before = crank;
  }
  return model;
}

std::shared_ptr<Model> squeezer() {
  struct Part {
    double mass, inertia, x, y, angle;
  };
  constexpr Part parts[] = {{0.04325, 2.194e-6, 0.0009182485980307614, -5.674074562905483e-05, -0.06171389001427645},
                            {0.00365, 4.41e-7, -0.0044914333599330725, 0.0002775362557942899, -0.06171389001427645},
                            {0.02373, 5.255e-6, -0.018742186670315457, 0.020485106789073934, 0.45527981916307037},
                            {0.00706, 5.667e-7, -0.030222939830158887, 0.012071182356663938, 0.7100333697097284},
                            {0.0705, 1.169e-5, -0.05323682815570414, 0.016631847966616306, 0.48736497954384256},
                            {0.00706, 5.667e-7, -0.028543268536783597, -0.010722254707252287, 1.0078790543839353},
                            {0.05498, 1.912e-5, -0.059262402801791715, -0.010600698332712844, 1.2305474445498212}};
  auto model = std::make_shared<Model>();
  for (const Part& p : parts) {
    model->add_body("K" + std::to_string(model->bodies.size() + 1),
                    {.mass = p.mass, .inertia = p.inertia, .position = {p.x, p.y}, .angle = p.angle});
  }
  const auto pin = [&](int i, Vec2<double> s_i, int j, Vec2<double> s_j) {
    model->add("", Revolute<>{s_i, s_j}, i, j);
  };
  pin(ground, {0, 0}, 0, {-0.00092, 0});
  pin(0, {0.00608, 0}, 1, {0.0115, 0});
  pin(1, {-0.0165, 0}, 2, {-0.01043, -0.01626});
  pin(2, {-0.01043, -0.01626}, 3, {0, -0.01421});
  pin(3, {0, -0.01421}, 5, {0.01421, 0});
  pin(ground, {-0.03635, 0.03273}, 2, {-0.01043, 0.01874});
  pin(3, {0, 0.00579}, 4, {0.01692, -0.00916});
  pin(ground, {-0.06934, -0.00227}, 4, {-0.02308, -0.00916});
  pin(ground, {-0.06934, -0.00227}, 6, {0.00449, 0.01228});
  pin(5, {-0.00579, 0}, 6, {0.00449, -0.02772});
  model->add_force("motor", Torque<>{}, 0, ground, {TimeFunction<double>(0.033)});
  SpringDamper<> spring;
  spring.s_i = {0.014, 0.072};
  spring.s_j = {0.00957, 0.00074};
  spring.k = 4530;
  spring.length = 0.07785;
  model->add_force("spring", spring, ground, 2);
  return model;
}

std::shared_ptr<Model> car_axis() {
  auto model = std::make_shared<Model>();
  model->gravity = {0, -1};
  const int axle = model->add_body("axle", {.mass = 1, .inertia = 1});
  const int left = model->add_body("left", {.mass = 5e-4, .position = {0, 0.5}, .particle = true});
  const int right = model->add_body("right", {.mass = 5e-4, .position = {1, 0.5}, .particle = true});
  for (const int wheel : {left, right}) {
    BasicBody<double>& values = model->bodies[static_cast<std::size_t>(wheel)];
    values.velocity = {-0.5, 0};
    values.velocity_given = true;
  }
  model->add("pivot", Revolute<>{}, ground, axle);
  model->add_driver("road", AbsoluteY<>{{1, 0}}, axle, ground, TimeFunction<double>::harmonic(0.1, 10));
  model->add("guide", Slot<>{{0, 0}, {0, 0}, {0, 1}}, axle, left, 0.0);
  model->add("bar", RelativeDistance<>{}, left, right, 1.0);
  SpringDamper<> spring;
  spring.k = 1;
  spring.length = 0.5;
  model->add_force("left spring", spring, ground, left);
  spring.s_i = {1, 0};
  model->add_force("right spring", spring, axle, right);
  return model;
}

}  // namespace bench
