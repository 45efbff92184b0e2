#include "catena/scene/designing/design_ranges.hpp"

#include <fmt/format.h>

#include <vector>

namespace catena {
namespace {

constexpr std::size_t most_ranges = 8;

}  // namespace

std::string design_ranges(const std::set<std::int64_t>& designs) {
  struct Range {
    std::int64_t first, last;
  };
  std::vector<Range> ranges;
  for (const std::int64_t k : designs) {
    if (ranges.empty() || k > ranges.back().last + 1)
      ranges.push_back({k, k});
    else
      ranges.back().last = k;
  }
  std::int64_t left_out = 0;
  for (; ranges.size() > most_ranges; ranges.pop_back()) left_out += ranges.back().last - ranges.back().first + 1;
  std::string text;
  for (std::size_t n = 0; n < ranges.size(); ++n) {
    const auto [first, last] = ranges[n];
    const bool is_end = n + 1 == ranges.size() && left_out == 0;
    if (n > 0) text += is_end ? " and " : ", ";
    text += first == last ? fmt::format("{}", first + 1) : fmt::format("{} to {}", first + 1, last + 1);
  }
  if (left_out > 0) text += fmt::format(" and {} more", left_out);
  return text;
}

}  // namespace catena
