// "did you mean": the known word nearest to a misspelt one, by the number of characters inserted, removed, changed or
// swapped with their neighbour (Damerau's distance, optimal string alignment; upper and lower case count as equal).
// Nothing is suggested beyond one edit in three characters: a far-fetched suggestion is worse than none.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace catena {

class NearMiss {
 public:
  explicit NearMiss(std::string_view word);

  /// Offers a known word; its text must live until the suggestion is taken. Among equals the first one stays.
  void consider(std::string_view candidate);
  template <class Range>
  NearMiss& consider_all(const Range& candidates) {
    for (const auto& candidate : candidates) consider(candidate);
    return *this;
  }

  /// The nearest word so far; empty if none is near enough.
  std::string_view best() const { return best_; }
  /// `; did you mean "length"?`, or nothing: to be appended to a message.
  std::string hint() const;

 private:
  std::vector<char32_t> word_;
  int best_distance_;
  std::string_view best_;
  std::vector<char32_t> other_;
  std::vector<int> rows_;  // three rows of the distance table
};

}  // namespace catena
