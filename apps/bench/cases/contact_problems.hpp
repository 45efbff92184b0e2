// Bodies that meet a level floor, with their exact motions: what contact is held against, in catena and in the engines
// beside it (peers/contact_peer.hpp).
//
//   balls      fall from rest and bounce: heights between impacts are parabolas, the speed e times as large after each
//   dumbbells  fly and spin between impacts of either end ball: y(t) -+ a sin(phi(t)) = r by bisection, then
//              J = -(1 + e) u / (1/m + a^2 cos^2(phi) / I)    with u the speed of the ball's centre, no friction
//   chain      of links end to end falls flat and slides to rest: t = sqrt(2 h/g), v+ = v - mu g t (its friction takes
//              part in the impact), then v+^2 / (2 mu g); pins carry nothing that would bend it
//   block      on a spring and a rough floor: half waves about +- mu m g / k, then at rest where |k x| < mu m g
//
// SI, gravity 9.81 along -y, the floor is y = 0. Each problem ends while no body is about to touch. Source: closed
// forms; no code in common with the library.
#pragma once

#include <array>
#include <cmath>
#include <string_view>
#include <vector>

namespace bench {

inline constexpr double contact_gravity = 9.81;

struct Ball {
  double x, y;  ///< of the centre at the start, m
};
struct BouncingBalls {
  static constexpr std::string_view name = "20 balls bounce";
  static constexpr int count = 20;
  static constexpr double radius = 0.1, mass = 1, restitution = 0.8, until = 2;
  static Ball ball(int k) { return {0.5 * k, radius + 0.5 + 0.05 * k}; }
};

struct Dumbbell {
  double x, y, angle, spin;
};
struct BouncingDumbbells {
  static constexpr std::string_view name = "10 dumbbells bounce";
  static constexpr int count = 10;
  static constexpr double half_length = 0.4, radius = 0.1, mass = 1, inertia = 0.1, restitution = 0.5, until = 1;
  static Dumbbell dumbbell(int k) { return {1.5 * k, 1 + 0.03 * k, 0.3 + 0.05 * k, 1 + 0.1 * k}; }
};

struct RubbingBlock {
  static constexpr std::string_view name = "a block rubs and sticks";
  static constexpr double mass = 1, stiffness = 100, friction = 0.25, start = 0.3, half_size = 0.1, until = 2.5;
};

struct SlidingChain {
  static constexpr std::string_view name = "a chain of 20 falls and slides";
  static constexpr int count = 20;
  static constexpr double half_length = 0.1, radius = 0.02, mass = 0.2, inertia = 1e-3, friction = 0.3, drop = 0.05;
  static constexpr double speed = 1.2, until = 0.6;
  static double x(int k) { return 2 * half_length * k; }
};

/// How far the chain comes, m: at rest after 0.41 s.
inline long double exact_slide() {
  using Problem = SlidingChain;
  const long double g = contact_gravity, mu = Problem::friction, fall = std::sqrt(2 * Problem::drop / g);
  const long double speed = Problem::speed - mu * g * fall;
  return Problem::speed * fall + speed * speed / (2 * mu * g);
}

/// Height of ball k's centre at the end, m.
inline long double exact_ball(int k) {
  using Problem = BouncingBalls;
  const long double g = contact_gravity, drop = Problem::ball(k).y - Problem::radius;
  long double t = std::sqrt(2 * drop / g), speed = g * t;
  if (t > Problem::until) return Problem::ball(k).y - g * Problem::until * Problem::until / 2;
  speed *= Problem::restitution;
  while (t + 2 * speed / g < Problem::until) {
    t += 2 * speed / g;
    speed *= Problem::restitution;
  }
  const long double since = Problem::until - t;
  return Problem::radius + speed * since - g * since * since / 2;
}

/// Height of the centre and angle of a dumbbell at the end.
inline std::array<long double, 2> exact_dumbbell(int k) {
  using Problem = BouncingDumbbells;
  const Dumbbell start = Problem::dumbbell(k);
  const long double g = contact_gravity, a = Problem::half_length;
  long double t = 0, y = start.y, v = 0, phi = start.angle, spin = start.spin;
  // The end at angle phi (+1) and the one opposite (-1): how far its ball is from the floor after `since`, and how fast
  // it leaves it.
  const auto gap = [&](int end, long double since) {
    return y + v * since - g * since * since / 2 + end * a * std::sin(phi + spin * since) - Problem::radius;
  };
  const auto rate = [&](int end, long double since) {
    return v - g * since + end * a * spin * std::cos(phi + spin * since);
  };
  constexpr long double scan = 1e-4L;  // s: no ball touches and leaves in less
  while (true) {
    long double first = Problem::until - t;
    int touching = 0;
    for (const int end : {1, -1}) {
      for (long double since = 0; since < first; since += scan) {
        if (gap(end, since + scan) >= 0 || rate(end, since + scan) >= 0) continue;
        long double low = since, high = since + scan;
        for (int halving = 0; halving < 80; ++halving) {
          const long double middle = (low + high) / 2;
          (gap(end, middle) > 0 ? low : high) = middle;
        }
        if (low < first) first = low, touching = end;
        break;
      }
    }
    const long double approach = touching ? rate(touching, first) : 0;
    y += v * first - g * first * first / 2;
    v -= g * first;
    phi += spin * first;
    t += first;
    if (!touching) return {y, phi};
    const long double arm = touching * a * std::cos(phi);
    const long double impulse = -(1 + static_cast<long double>(Problem::restitution)) * approach /
                                (1 / Problem::mass + arm * arm / Problem::inertia);
    v += impulse / Problem::mass;
    spin += impulse * arm / Problem::inertia;
  }
}

/// Position of the block at the end, at rest since its last half wave.
inline long double exact_block() {
  using Problem = RubbingBlock;
  const long double dead =
      static_cast<long double>(Problem::friction) * Problem::mass * contact_gravity / Problem::stiffness;
  long double x = Problem::start;
  while (std::abs(x) > dead) x = x > 0 ? -(x - 2 * dead) : -(x + 2 * dead);
  return x;
}

}  // namespace bench
