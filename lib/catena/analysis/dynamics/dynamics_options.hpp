// How a motion is to be integrated.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace catena {

enum class IntegrationMethod {
  automatic,     ///< chooses, and says what it chose
  rk8,           ///< Dormand-Prince, order 8, with projection
  rk5,           ///< Dormand-Prince, order 5, with projection
  baumgarte,     ///< Dormand-Prince, order 8, with stabilised constraints in place of projection
  adams,         ///< Adams, orders 1 to 12, with projection
  partitioning,  ///< Dormand-Prince, order 8, of independent coordinates
  radau,         ///< Radau IIA, order 5, for stiff forces
  alpha,         ///< generalized-alpha, order 2, with damping of fast vibrations
  rattle,        ///< of order 2, steps of one length, energy bounded
};

/// The names used in scenes and results, in the order of the enumeration.
inline constexpr std::array<std::string_view, 9> integration_methods{
    "auto", "rk8", "rk5", "baumgarte", "adams", "partitioning", "radau", "alpha", "rattle"};

inline std::string_view to_string(IntegrationMethod method) {
  return integration_methods[static_cast<std::size_t>(method)];
}

/// Whether a tolerance makes a method as exact as it asks for, in steps that are not many times those of others: not of
/// order 2.
inline bool follows_tolerance(IntegrationMethod method) {
  return method != IntegrationMethod::alpha && method != IntegrationMethod::rattle;
}

/// Whether derivatives along a motion can follow the steps of a method.
inline bool is_explicit(IntegrationMethod method) {
  return follows_tolerance(method) && method != IntegrationMethod::radau;
}
/// All methods in use, each once, with commas between them.
std::string names_of(std::span<const IntegrationMethod> used);

struct DynamicsOptions {
  /// The least tolerance that double precision allows.
  static constexpr double least_tolerance = 1e-14;
  IntegrationMethod method = IntegrationMethod::automatic;
  /// Of the state: positions relative to the scene's length scale, angles to 1 rad, velocities to the fastest so far.
  double tolerance = 1e-8;
  /// Fixed step, s; 0: chosen by the integrator.
  double step = 0;
  /// Of `alpha`: what a step leaves of a vibration much faster than it, 0 ... 1.
  double rho = 0.8;
  /// Whether `automatic` may go over to implicit steps where stiffness asks for them, and back; not where derivatives
  /// follow the steps.
  bool may_turn_implicit = true;
  /// Largest number of steps of a run, rejected ones included; the run ends when they are used up, or as soon as ten
  /// times as many would be needed at its present pace. All phases and mechanisms of a motion count together.
  std::int64_t max_steps = 10'000'000;
};

}  // namespace catena
