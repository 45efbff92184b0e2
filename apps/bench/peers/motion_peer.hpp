// Chains of rods that fall, and IFToMM's A02, by an engine with joint coordinates, for `catena bench --peers`: what its
// program prints, in the tables of peer_records.hpp.
//
//   acceleration   S1a <tab> engine <tab> method <tab> rods <tab> ns a rod <tab> us a call <tab> tip's acceleration, x,
//   y chain          S1b <tab> engine <tab> method <tab> setting <tab> steps <tab> ms <tab> - <tab> - <tab> error, m
//   fourbar        S2  <tab> engine <tab> method <tab> setting <tab> four-bars <tab> ms <tab> - <tab> error, m
//   squeezer       S3  <tab> engine <tab> method <tab> setting <tab> steps <tab> ms <tab> error, rad
//
// A program ends with `unknown_scene` where it is asked for one that it does not have. Rods are of 1 m and 1 kg; angles
// are counter-clockwise from +x. Times are processor times of the steps alone, catena's are of whole runs.
#pragma once

#include <cmath>
#include <cstdio>
#include <initializer_list>
#include <string>
#include <vector>

#include "peers/motion_references.hpp"
#include "timing.hpp"

namespace motion_peer {

using bench::processor_time;
using Angles = std::vector<double>;

inline constexpr int unknown_scene = 2;
inline constexpr double gravity = 9.81, inertia = 1.0 / 12;
inline constexpr int links = 40;
inline constexpr double chain_duration = 1;  // s
inline constexpr double enough = 0.5;        // s of runs, after which one is not repeated
inline constexpr int most_repeats = 5;
inline constexpr double too_long = 2;  // s: a run of A02 that takes longer is given up, if no other time is told

/// Of rods one after the other: from joint to absolute angles, and back.
inline Angles absolute(Angles relative) {
  for (std::size_t k = 1; k < relative.size(); ++k) relative[k] += relative[k - 1];
  return relative;
}
inline Angles relative(Angles absolute) {
  for (std::size_t k = absolute.size(); k-- > 1;) absolute[k] -= absolute[k - 1];
  return absolute;
}

inline void print(const std::string& line) {
  std::puts(line.c_str());
  std::fflush(stdout);
}
inline std::string text(const char* format, double value) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, format, value);
  return buffer;
}
inline std::string joined(std::initializer_list<std::string> fields) {
  std::string line;
  for (const std::string& field : fields) line += (line.empty() ? "" : "\t") + field;
  return line;
}

/// Angles 0.3 sin k and rates 0.1 cos k of the rods k = 1 ... n. `evaluate(angles, rates)`, relative ones, gives the
/// angular accelerations of the joints.
template <class Evaluate>
void print_acceleration(const char* engine, const char* method, int n, Evaluate&& evaluate) {
  Angles angle, rate;
  for (int k = 1; k <= n; ++k) angle.push_back(0.3 * std::sin(k)), rate.push_back(0.1 * std::cos(k));
  const Angles q = relative(angle), u = relative(rate);
  const double first = bench::least_time(1, 1, [&] { evaluate(q, u); });
  const int calls = std::max(1, static_cast<int>(2e-3 / std::max(first, 1e-9)));
  const int repeats = std::max(3, static_cast<int>(enough / (calls * std::max(first, 1e-9))));
  const double seconds = bench::least_time(std::min(repeats, 100), calls, [&] { evaluate(q, u); });
  const Angles a = absolute(evaluate(q, u));
  double x = 0, y = 0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    const double c = std::cos(angle[k]), s = std::sin(angle[k]), w2 = rate[k] * rate[k];
    x -= s * a[k] + c * w2, y += c * a[k] - s * w2;
  }
  print(joined({"S1a", engine, method, std::to_string(n), text("%.1f", seconds / n * 1e9), text("%.4f", seconds * 1e6),
                text("%.12g", x), text("%.12g", y)}));
}

struct Run {
  double seconds = 0;
  long steps = 0;
  Angles angles = {};  ///< absolute, at the end
};

/// The least time of several runs of `simulate`, which gives a Run.
template <class Simulate>
Run fastest(Simulate&& simulate) {
  Run best = simulate();
  double spent = best.seconds;
  for (int k = 1; k < most_repeats && spent < enough; ++k) {
    const Run run = simulate();
    spent += run.seconds;
    best.seconds = std::min(best.seconds, run.seconds);
  }
  return best;
}

inline void print_chain(const char* engine, const std::string& method, const std::string& setting, const Run& run) {
  static const std::vector<Place> exact = ends_of_falling_chain(links, chain_duration);
  double x = 0, y = 0, error = 0;
  for (std::size_t k = 0; k < run.angles.size(); ++k) {
    x += std::cos(run.angles[k]), y += std::sin(run.angles[k]);
    const double off = std::hypot(x - exact[k][0], y - exact[k][1]);
    if (!(off <= error)) error = off;
  }
  print(joined({"S1b", engine, method, setting, std::to_string(run.steps), text("%.3f", run.seconds * 1e3), "", "",
                text("%.2e", error)}));
}

/// A02 with n four-bars. `advance(t)` goes on to t and gives the angle of the first crank.
template <class Advance>
void print_four_bars(const char* engine, const std::string& method, const std::string& setting, int n,
                     Advance&& advance, double longest = too_long) {
  const std::vector<Place> exact = crank_ends_of_a02(n);
  double error = 0, seconds = 0;
  for (std::size_t k = 0; k < exact.size(); ++k) {
    const double t = duration_of_a02 * static_cast<double>(k) / samples_of_a02, begin = processor_time();
    const double angle = advance(t);
    seconds += processor_time() - begin;
    if (seconds > longest) return;
    const double off = std::hypot(std::cos(angle) - exact[k][0], std::sin(angle) - exact[k][1]);
    if (!(off <= error)) error = off;
  }
  print(
      joined({"S2", engine, method, setting, std::to_string(n), text("%.3f", seconds * 1e3), "", text("%.2e", error)}));
}

}  // namespace motion_peer
