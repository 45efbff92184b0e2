#include "suites/bench.hpp"

#include <fmt/format.h>
#include <malloc.h>

namespace bench {

std::vector<std::pair<std::string, double>> named_counts(const catena::Counters& c) {
  const std::pair<const char*, std::int64_t> all[] = {{"symbolic", c.symbolic},
                                                      {"factorizations", c.factorizations},
                                                      {"solves", c.solves},
                                                      {"iterations", c.iterations},
                                                      {"configurations", c.configurations},
                                                      {"jacobians", c.jacobians},
                                                      {"gammas", c.gammas},
                                                      {"forces", c.forces},
                                                      {"hessians", c.hessians},
                                                      {"fallbacks", c.fallbacks},
                                                      {"steps", c.steps},
                                                      {"rejected", c.rejected}};
  std::vector<std::pair<std::string, double>> counts;
  for (const auto& [name, value] : all) {
    if (value != 0) counts.emplace_back(name, static_cast<double>(value));
  }
  return counts;
}

double held_bytes() {
  const struct mallinfo2 info = mallinfo2();
  return static_cast<double>(info.uordblks) + static_cast<double>(info.hblkhd);
}

std::string tolerance_text(double tolerance) { return fmt::format("{:.0e}", tolerance); }

}  // namespace bench
