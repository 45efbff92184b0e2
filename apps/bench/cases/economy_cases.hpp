// What a scene does not need is not computed: pairs of runs, one that leaves work out and one that does all of it,
// whose answers must be the same.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace bench {

struct EconomyOutcome {
  std::vector<double> answer;
  std::vector<std::pair<std::string, double>> counts;
  std::string failure{};
};

/// Made ready outside of what is measured; each call does the work anew.
using EconomyWork = std::function<EconomyOutcome()>;

struct EconomyVariant {
  const char* name;
  EconomyWork (*prepare)();
};

struct EconomyCase {
  const char* feature;
  EconomyVariant lean, full;
  const char* answer;  ///< what is compared: "end of the rocker, m"
  double allowed;      ///< largest difference of the answers, with its reason in economy_cases.cpp
};

const std::vector<EconomyCase>& economy_cases();

/// Does the work of "feature / variant" once, within a function that callgrind can be told to look at alone. False
/// where there is no such variant.
bool run_economy_variant(const std::string& name);

/// The name of that function.
inline constexpr const char* measured_function = "catena_bench_measured_work";

}  // namespace bench
