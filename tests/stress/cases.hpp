// How many random cases the stress tests make, and what they print of them.
//
// CATENA_STRESS_CASES sets the number for every test that asks here, CATENA_STRESS_FIRST the first seed (1), and
// CATENA_STRESS_KEEP a folder in which scenes are left, each by the name of its kind and its seed; with
// CATENA_STRESS_SHOW set it is said of each case that was refused why.
//
// The usual numbers make some 155,000 cases, and 30,000 runs of known motions beside them, in about an hour of one core
// and half of that on two. A kind has as many cases as some four minutes allow, ten thousand at most, by
// its time a case, measured, ms: columns, networks of springs, paths' digits, statics 1 ... 8; kinematics, at rest,
// schema 3 ... 20; mutated scenes 9; contacts, equilibria, gradients, invariance 6 ... 25; paths of particles 26;
// motions against dense formulations 35 ... 65, by implicit methods 60; digits of motions 53, of methods that run twice
// 150, of stiff ones 1400; stiff motions 2200.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <string>

namespace catena::testing {

inline int stress_cases(int usual) {
  const char* asked = std::getenv("CATENA_STRESS_CASES");
  return asked ? std::atoi(asked) : usual;
}

/// Seeds from the first to the last.
inline unsigned first_case(unsigned usual = 1) {
  const char* asked = std::getenv("CATENA_STRESS_FIRST");
  return asked ? static_cast<unsigned>(std::atoi(asked)) : usual;
}
inline unsigned last_case(int usual, unsigned usual_first = 1) {
  return first_case(usual_first) + static_cast<unsigned>(stress_cases(usual)) - 1;
}

/// Leaves a scene where it is asked for.
inline void keep_scene(const std::string& kind, unsigned seed, const std::string& text) {
  if (const char* folder = std::getenv("CATENA_STRESS_KEEP"))
    std::ofstream(std::string(folder) + "/" + kind + "_" + std::to_string(seed) + ".json") << text;
}

/// Prints why a case was refused where CATENA_STRESS_SHOW is set.
inline void show_refusal(unsigned seed, const std::string& message) {
  if (std::getenv("CATENA_STRESS_SHOW")) std::printf("  seed %u: %s\n", seed, message.c_str());
}

/// Every outcome with its share.
inline void print_shares(const std::string& what, const std::map<std::string, int>& counts) {
  int all = 0;
  for (const auto& [outcome, count] : counts) all += count;
  std::printf("%s: %d outcomes\n", what.c_str(), all);
  for (const auto& [outcome, count] : counts)
    std::printf("  %-16s %8d  %6.2f %%\n", outcome.c_str(), count, 100.0 * count / all);
}

}  // namespace catena::testing
