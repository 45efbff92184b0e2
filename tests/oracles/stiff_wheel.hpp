// A wheel on a shaft that swings, joined by a stiff torsion spring with a damper, in closed form:
//
//   J theta'' + c theta' + k theta = c a w cos(w t) + k a sin(w t)
//   theta = Im(a H e^(i w t)) + c1 e^(r1 t) + c2 e^(r2 t),   H = (k + i w c) / (k - J w^2 + i w c)
//
// r1, r2 the roots of J r^2 + c r + k: its vibration dies away within a few periods, 1e3 ... 1e10 times faster than the
// shaft swings, or creeps. Evaluated in long double.
#pragma once

#include <cmath>
#include <complex>
#include <nlohmann/json.hpp>
#include <random>
#include <string>

#include "scene/run_text.hpp"

namespace catena::testing {

class StiffWheel {
 public:
  explicit StiffWheel(unsigned seed) : random_(seed) {
    inertia_ = std::pow(10.0, uniform(-2, 2));
    stiffness_ = inertia_ * std::pow(10.0, uniform(3, 10));
    // Not near one, where both roots are the same.
    const double part = uniform(0.3, 0.9), of_critical = seed % 2 ? part : std::pow(30.0, part) / 2;
    damping_ = 2 * of_critical * std::sqrt(stiffness_ * inertia_);
    amplitude_ = uniform(0.2, 2);
    omega_ = uniform(0.5, 5);
    rate_ = seed % 3 ? uniform(-3, 3) : 0;
    until_ = uniform(1, 6);
  }
  double uniform(double a, double b) { return std::uniform_real_distribution<double>(a, b)(random_); }
  int pick(int n) { return std::uniform_int_distribution<int>(0, n - 1)(random_); }

  TextRun run(const std::string& method, double tolerance) const {
    const nlohmann::ordered_json scene = {
        {"catena", 1},
        {"bodies",
         {{"shaft", {{"mass", 1}, {"inertia", 1}}},
          {"wheel", {{"mass", 1}, {"inertia", inertia_}, {"angular_velocity", rate_}}}}},
        {"constraints",
         {{{"type", "revolute"}, {"i", "ground"}, {"j", "shaft"}},
          {{"type", "revolute"}, {"i", "ground"}, {"j", "wheel"}}}},
        {"drivers",
         {{{"type", "absolute_angle"},
           {"i", "shaft"},
           {"value", {{"harmonic", {{"amplitude", amplitude_}, {"omega", omega_}}}}}}}},
        {"forces",
         {{{"type", "torsion_spring"},
           {"i", "shaft"},
           {"j", "wheel"},
           {"k", stiffness_},
           {"c", damping_},
           {"angle", 0}}}},
        {"outputs", {"wheel.angle", "wheel.omega", "wheel.alpha"}},
        {"analyses",
         {{{"type", "dynamics"},
           {"until", until_},
           {"every", until_ / 5},
           {"method", method},
           {"tolerance", tolerance},
           {"max_steps", 300000}}}}};
    return run_text(scene.dump());
  }
  /// The angle of the wheel, or its first or second derivative, at t.
  long double exact(int derivative, long double t) const {
    using Complex = std::complex<long double>;
    const long double J = inertia_, c = damping_, k = stiffness_, w = omega_, a = amplitude_;
    const Complex i(0, 1), root = std::sqrt(Complex(c * c - 4 * J * k)), q = -(c + root) / 2.0L;
    const Complex r1 = q / J, r2 = k / q, H = (k + i * w * c) / (k - J * w * w + i * w * c);
    const auto forced = [&](int n, long double at) {
      return std::imag(a * std::pow(i * w, n) * H * std::exp(i * w * at));
    };
    const Complex place = -forced(0, 0), rate = static_cast<long double>(rate_) - forced(1, 0);
    const Complex c2 = (rate - r1 * place) / (r2 - r1), c1 = place - c2;
    return forced(derivative, t) + std::real(c1 * std::pow(r1, derivative) * std::exp(r1 * t) +
                                             c2 * std::pow(r2, derivative) * std::exp(r2 * t));
  }

 private:
  std::mt19937 random_;
  double inertia_, stiffness_, damping_, amplitude_, omega_, rate_, until_;
};

}  // namespace catena::testing
