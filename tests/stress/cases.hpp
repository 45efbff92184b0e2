// How many random cases the stress tests make, and what they print of them.
//
// CATENA_STRESS_CASES sets the number for every test that asks here.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>

namespace catena::testing {

inline int stress_cases(int usual) {
  const char* asked = std::getenv("CATENA_STRESS_CASES");
  return asked ? std::atoi(asked) : usual;
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
