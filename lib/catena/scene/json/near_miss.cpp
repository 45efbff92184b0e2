#include "catena/scene/json/near_miss.hpp"

#include <algorithm>
#include <cstdlib>

#include "catena/scene/json/diagnostic.hpp"
#include "catena/scene/json/utf8.hpp"

namespace catena {
namespace {

constexpr std::size_t longest = 64;  // longer words are not compared: the table grows with the square

void to_characters(std::string_view text, std::vector<char32_t>& out) {
  out.clear();
  for (std::size_t at = 0; at < text.size();) {
    const CodePoint c = next_code_point(text, at);
    out.push_back(c.value >= 'A' && c.value <= 'Z' ? c.value + ('a' - 'A') : c.value);
    at += static_cast<std::size_t>(c.bytes);
  }
}

}  // namespace

NearMiss::NearMiss(std::string_view word) {
  if (word.size() <= longest) to_characters(word, word_);
  // One more than the accepted distance.
  best_distance_ = std::max(1, static_cast<int>(word_.size()) / 3) + 1;
}

void NearMiss::consider(std::string_view candidate) {
  if (word_.empty() || candidate.empty() || candidate.size() > longest) return;
  to_characters(candidate, other_);
  const int n = static_cast<int>(word_.size()), m = static_cast<int>(other_.size());
  if (std::abs(n - m) >= best_distance_) return;

  rows_.assign(3 * static_cast<std::size_t>(m + 1), 0);
  int* before = rows_.data();         // row i - 2
  int* previous = before + (m + 1);   // row i - 1
  int* current = previous + (m + 1);  // row i: distance of the first i characters to the first j of the other
  for (int j = 0; j <= m; ++j) previous[j] = j;
  for (int i = 1; i <= n; ++i) {
    current[0] = i;
    int least = i;
    for (int j = 1; j <= m; ++j) {
      const char32_t a = word_[static_cast<std::size_t>(i - 1)], b = other_[static_cast<std::size_t>(j - 1)];
      int d = std::min({previous[j] + 1, current[j - 1] + 1, previous[j - 1] + (a == b ? 0 : 1)});
      if (i > 1 && j > 1 && a == other_[static_cast<std::size_t>(j - 2)] &&
          word_[static_cast<std::size_t>(i - 2)] == b) {
        d = std::min(d, before[j - 2] + 1);
      }
      current[j] = d;
      least = std::min(least, d);
    }
    // Both of the last rows bound what follows: a swap reaches two rows back.
    if (least > best_distance_) return;
    int* const oldest = before;
    before = previous;
    previous = current;
    current = oldest;
  }
  // A single character replaced by another is a different word, not a misspelling, unless case alone differs.
  const int distance = previous[m];
  if (distance < best_distance_ && (distance == 0 || n > 1)) {
    best_distance_ = distance;
    best_ = candidate;
  }
}

std::string NearMiss::hint() const {
  return best_.empty() ? std::string() : "; did you mean " + in_quotes(best_) + "?";
}

}  // namespace catena
