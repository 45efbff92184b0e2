#include "peer_records.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "catena/analysis/dynamics/dynamics.hpp"
#include "catena/analysis/statics/equilibrium.hpp"
#include "catena/elements/constraints/revolute.hpp"
#include "catena/model/model_add.hpp"
#include "mechanisms.hpp"
#include "peer_records_motion.hpp"
#include "timing.hpp"

namespace bench {

using namespace catena;

namespace {

void acceleration() {
  for (int n : {10, 100, 1000, 10000, 100000, 1000000}) {
    const auto model = chain(n);
    EvaluationWork work;
    Evaluator evaluator(Plan::make(*model), *model, work);
    EquationsOfMotion equations(evaluator);
    if (!equations.use_masses().ok()) continue;
    const std::vector<double> q = evaluator.given_configuration();
    std::vector<double> qd(q.size()), qdd(q.size());
    Vec2<double> tip_speed{};
    for (int b = 0; b < n; ++b) {
      const double angle = q[3 * b + 2], rate = 0.1 * std::cos(b + 1.0);
      const Vec2<double> half{-0.5 * rate * std::sin(angle), 0.5 * rate * std::cos(angle)};
      const Vec2<double> v = tip_speed + half;
      qd[3 * b] = v.x, qd[3 * b + 1] = v.y, qd[3 * b + 2] = rate;
      tip_speed = v + half;
    }
    bool ok = equations.accelerations(0, Side::after, q, qd, qdd);
    const double seconds = least_time(std::max(7, 200000 / n), std::max(1, 20000 / n),
                                      [&] { ok = ok && equations.accelerations(0, Side::after, q, qd, qdd); });
    const std::size_t last = 3 * static_cast<std::size_t>(n - 1);
    const double c = 0.5 * std::cos(q[last + 2]), s = 0.5 * std::sin(q[last + 2]), w = qd[last + 2];
    const double ax = qdd[last] - s * qdd[last + 2] - c * w * w, ay = qdd[last + 1] + c * qdd[last + 2] - s * w * w;
    fmt::print("S1a\tcatena\t{}\t{}\t{:.1f}\t{:.3f}\t{:.12g}\t{:.12g}\n", ok ? "absolute coordinates" : "failed", n,
               1e9 * seconds / n, 1e6 * seconds, ax, ay);
    std::fflush(stdout);
  }
}

/// Angles of the rods of a chain of n rods of 1 m over 0.8 n: their tangents rise evenly, at a rate which a bisection
/// finds.
std::vector<double> hanging_angles(int n) {
  double low = 0, high = 1e3;
  const auto tangent = [n](double rate, int k) { return rate * (k - 0.5 * (n - 1)); };
  for (int step = 0; step < 200; ++step) {
    const double middle = 0.5 * (low + high);
    double reach = 0;
    for (int k = 0; k < n; ++k) reach += 1 / std::hypot(1, tangent(middle, k));
    (reach > 0.8 * n ? low : high) = middle;
  }
  std::vector<double> angles;
  for (int k = 0; k < n; ++k) angles.push_back(std::atan(tangent(low, k)));
  return angles;
}

void equilibrium() {
  for (int n : {10, 100, 1000, 10000, 100000}) {
    auto model = std::make_shared<Model>();
    model->gravity = {0, -9.81};
    const double slope = std::acos(0.8);
    Vec2<double> from{};
    for (int k = 0; k < n; ++k) {
      const double angle = k < n / 2 ? -slope : slope;
      const Vec2<double> to = from + Vec2<double>{std::cos(angle), std::sin(angle)};
      const int rod = add_rod(*model, "link" + std::to_string(k), from, to);
      model->add("", Revolute<>{{k == 0 ? 0 : 0.5, 0}, {-0.5, 0}}, k == 0 ? ground : rod - 1, rod);
      from = to;
    }
    model->add("", Revolute<>{{0.8 * n, 0}, {0.5, 0}}, ground, n - 1);

    EquilibriumReport report;
    std::vector<double> q;
    const double seconds = least_time(n > 10000 ? 2 : 7, 1, [&] {
      Equilibrium chain(model);
      report = chain.solve();
      q = chain.state().q;
    });
    const std::vector<double> exact = hanging_angles(n);
    double energy = 0, lowest = 0, worst = 0;
    Vec2<double> place{};
    for (int k = 0; k < n; ++k) {
      const Vec2<double> half{0.5 * std::cos(exact[k]), 0.5 * std::sin(exact[k])};
      energy += q[3 * k + 1], lowest += place.y + half.y;
      place += 2.0 * half;
      const Vec2<double> end{q[3 * k] + 0.5 * std::cos(q[3 * k + 2]), q[3 * k + 1] + 0.5 * std::sin(q[3 * k + 2])};
      worst = std::max(worst, norm(end - place));
    }
    fmt::print("S4{}\tcatena\t{}\ttol=1e-11\t{}\t{:.3f}\t{:.2e}\t{:.2e}\n", report.stable ? "" : "-failed",
               report.solver, n, 1e3 * seconds, (energy - lowest) / std::abs(lowest), worst);
    std::fflush(stdout);
  }
}

}  // namespace

bool print_peer_records(std::string_view scene) {
  if (scene == "acceleration") {
    acceleration();
  } else if (scene == "chain") {
    print_chain_records();
  } else if (scene == "fourbar") {
    print_fourbar_records();
  } else if (scene == "squeezer") {
    print_squeezer_records();
  } else if (scene == "equilibrium") {
    equilibrium();
  } else {
    return false;
  }
  return true;
}

}  // namespace bench
