#include "cases/resting_chains.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "cases/exact_chain.hpp"
#include "catena/elements/constraints/absolute_y.hpp"
#include "catena/elements/constraints/revolute.hpp"
#include "catena/elements/forces/spring_damper.hpp"
#include "catena/model/model_add.hpp"
#include "mechanisms.hpp"

namespace bench {

using namespace catena;

namespace {

constexpr double distance_per_rod = 0.8, mass = 1.5, stiffness = 200;

}  // namespace

const char* name_of(ChainStart start) {
  return start == ChainStart::bent ? "bent" : start == ChainStart::zigzag ? "zigzag" : "random";
}

std::shared_ptr<Model> chain_between_pins(int rods, ChainStart start) {
  auto model = std::make_shared<Model>();
  model->gravity = {0, -9.81};
  const double slope = std::acos(distance_per_rod);
  std::mt19937 generator(1);
  Vec2<double> from{};
  for (int k = 0; k < rods; ++k) {
    double angle = k < rods / 2 ? -slope : slope;
    if (start == ChainStart::zigzag) angle = k % 2 ? -slope : slope;
    if (start == ChainStart::random) angle = (generator() / 4294967296.0 * 2 - 1) * std::numbers::pi;
    const Vec2<double> to = from + Vec2<double>{std::cos(angle), std::sin(angle)};
    const int rod = add_rod(*model, "link" + std::to_string(k), from, to);
    model->add("", Revolute<>{{k == 0 ? 0 : 0.5, 0}, {-0.5, 0}}, k == 0 ? ground : rod - 1, rod);
    from = to;
  }
  model->add("", Revolute<>{{distance_per_rod * rods, 0}, {0.5, 0}}, ground, rods - 1);
  return model;
}

double error_at_rest(std::span<const double> q) {
  const auto exact = ends_at_rest(static_cast<int>(q.size() / 3), distance_per_rod);
  long double worst = 0;
  for (std::size_t k = 0; k < exact.size(); ++k) {
    const long double phi = q[3 * k + 2];
    worst = std::max(
        worst,
        norm(Vec2<long double>{q[3 * k] + 0.5L * std::cos(phi), q[3 * k + 1] + 0.5L * std::sin(phi)} - exact[k]));
  }
  return static_cast<double>(worst / static_cast<long double>(exact.size()));
}

std::shared_ptr<Model> masses_between_springs(int n) {
  auto model = std::make_shared<Model>();
  for (int k = 0; k <= n; ++k) {
    if (k < n) {
      const int body =
          model->add_body("m" + std::to_string(k), {.mass = mass, .position = {k + 1.0, 0}, .particle = true});
      model->add("", AbsoluteY<>{}, body, ground, 0.0);
    }
    SpringDamper<> spring;
    spring.k = stiffness;
    spring.length = 1;
    if (k == 0) {
      model->add_force("", spring, ground, 0);
    } else if (k < n) {
      model->add_force("", spring, k - 1, k);
    } else {
      spring.s_j = {n + 1.0, 0};
      model->add_force("", spring, n - 1, ground);
    }
  }
  return model;
}

double exact_frequency(int n, int j) {
  return 2 * std::sqrt(stiffness / mass) * std::sin(j * std::numbers::pi / (2.0 * n + 2));
}

}  // namespace bench
