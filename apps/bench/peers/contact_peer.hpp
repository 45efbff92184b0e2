// The problems of cases/contact_problems.hpp by an engine that steps a world of rigid bodies, for `catena bench
// --peers`: peer_contact_ENGINE contact prints
//
//   S6 <tab> engine <tab> method <tab> setting <tab> problem <tab> steps <tab> ms <tab> error, m
//
// for every step size. Times are processor times of the steps alone, the least of several runs.
//
// An engine's World is made from (Settings, restitution, friction), knows a floor y = 0, and has
//   add_ball(x, y, radius, mass), add_dumbbell(x, y, angle, spin, half_length, radius, mass, inertia),
//   add_block(x, half_size, mass), which does not turn;
//   add_link(x, y, speed, half_length, radius, mass, inertia), a dumbbell that moves along x, its left end pinned to
//   the right end of the link before, and touches the floor alone; left out where an engine takes no pins.
// Then ready(h) is called; push(body, force along x, for the next step), step(h), x(body), y(body), angle(body).
#pragma once

#include <cstdio>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

#include "cases/contact_problems.hpp"
#include "timing.hpp"

namespace contact_peer {

using bench::processor_time;

inline constexpr double step_sizes[] = {1e-2, 1e-3, 1e-4, 1e-5};
inline constexpr int most_repeats = 5;
inline constexpr double enough = 0.5;  // s of steps, after which a run is not repeated
inline constexpr double too_long = 2;  // s: a run that would take longer is left out

struct Outcome {
  double seconds = 0, error = 0;
};

/// s
template <class World>
double time_of_steps(World& world, double h, int steps) {
  world.ready(h);
  const double begin = processor_time();
  for (int s = 0; s < steps; ++s) world.step(h);
  return processor_time() - begin;
}

template <class World, class Settings>
Outcome balls(const Settings& settings, double h, int steps) {
  using Problem = bench::BouncingBalls;
  World world(settings, Problem::restitution, 0.0);
  for (int k = 0; k < Problem::count; ++k)
    world.add_ball(Problem::ball(k).x, Problem::ball(k).y, Problem::radius, Problem::mass);
  Outcome outcome;
  outcome.seconds = time_of_steps(world, h, steps);
  for (int k = 0; k < Problem::count; ++k)
    outcome.error = std::fmax(outcome.error, std::abs(world.y(k) - static_cast<double>(bench::exact_ball(k))));
  return outcome;
}

template <class World, class Settings>
Outcome dumbbells(const Settings& settings, double h, int steps) {
  using Problem = bench::BouncingDumbbells;
  World world(settings, Problem::restitution, 0.0);
  for (int k = 0; k < Problem::count; ++k) {
    const bench::Dumbbell start = Problem::dumbbell(k);
    world.add_dumbbell(start.x, start.y, start.angle, start.spin, Problem::half_length, Problem::radius, Problem::mass,
                       Problem::inertia);
  }
  Outcome outcome;
  outcome.seconds = time_of_steps(world, h, steps);
  for (int k = 0; k < Problem::count; ++k) {
    const auto exact = bench::exact_dumbbell(k);
    outcome.error = std::fmax(outcome.error, std::abs(world.y(k) - static_cast<double>(exact[0])));
    const double turned = std::remainder(world.angle(k) - static_cast<double>(exact[1]), 2 * 3.14159265358979323846);
    outcome.error = std::fmax(outcome.error, Problem::half_length * std::abs(turned));
  }
  return outcome;
}

template <class World, class Settings>
Outcome block(const Settings& settings, double h, int steps) {
  using Problem = bench::RubbingBlock;
  World world(settings, 0.0, Problem::friction);
  world.add_block(Problem::start, Problem::half_size, Problem::mass);
  world.ready(h);
  Outcome outcome;
  const double begin = processor_time();
  for (int s = 0; s < steps; ++s) {
    world.push(0, -Problem::stiffness * world.x(0));
    world.step(h);
  }
  outcome.seconds = processor_time() - begin;
  outcome.error = std::abs(world.x(0) - static_cast<double>(bench::exact_block()));
  return outcome;
}

/// Whether an engine knows pins. One of them needs C++17.
template <class World, class = void>
inline constexpr bool pins = false;
template <class World>
inline constexpr bool pins<World, std::void_t<decltype(&World::add_link)>> = true;

template <class World, class Settings>
Outcome chain(const Settings& settings, double h, int steps) {
  using Problem = bench::SlidingChain;
  World world(settings, 0.0, Problem::friction);
  for (int k = 0; k < Problem::count; ++k)
    world.add_link(Problem::x(k), Problem::radius + Problem::drop, Problem::speed, Problem::half_length,
                   Problem::radius, Problem::mass, Problem::inertia);
  Outcome outcome;
  outcome.seconds = time_of_steps(world, h, steps);
  for (int k = 0; k < Problem::count; ++k) {
    const double exact = Problem::x(k) + static_cast<double>(bench::exact_slide());
    outcome.error = std::fmax(outcome.error, std::abs(world.x(k) - exact));
  }
  return outcome;
}

/// Every problem at every step size with one way to set the engine up.
template <class World, class Settings>
void run(const char* engine, const std::string& method, const Settings& settings) {
  struct Problem {
    std::string_view name;
    double until;
    Outcome (*run)(const Settings&, double, int);
  };
  std::vector<Problem> problems = {
      {bench::BouncingBalls::name, bench::BouncingBalls::until, balls<World, Settings>},
      {bench::BouncingDumbbells::name, bench::BouncingDumbbells::until, dumbbells<World, Settings>},
      {bench::RubbingBlock::name, bench::RubbingBlock::until, block<World, Settings>}};
  if constexpr (pins<World>)
    problems.push_back({bench::SlidingChain::name, bench::SlidingChain::until, chain<World, Settings>});
  for (const Problem& problem : problems) {
    double expected = 0;
    for (const double h : step_sizes) {
      if (expected > too_long) break;
      const int steps = static_cast<int>(std::lround(problem.until / h));
      Outcome best{std::numeric_limits<double>::infinity(), 0};
      double spent = 0;
      for (int k = 0; k < most_repeats && spent < enough; ++k) {
        const Outcome outcome = problem.run(settings, h, steps);
        spent += outcome.seconds;
        if (outcome.seconds < best.seconds) best = outcome;
      }
      std::printf("S6\t%s\t%s\th=%g\t%.*s\t%d\t%.6g\t%.6g\n", engine, method.c_str(), h,
                  static_cast<int>(problem.name.size()), problem.name.data(), steps, 1e3 * best.seconds, best.error);
      std::fflush(stdout);
      expected = 10 * best.seconds;  // of the next step size
    }
  }
}

}  // namespace contact_peer
