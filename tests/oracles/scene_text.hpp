// Pieces of scenes that are written by programs: numbers to their last digit, random ones.
#pragma once

#include <random>
#include <sstream>
#include <string>
#include <vector>

namespace catena::testing {

inline std::string text_of(double x) {
  std::ostringstream out;
  out.precision(17);
  out << x;
  return out.str();
}
inline std::string pair_of(double x, double y) { return "[" + text_of(x) + "," + text_of(y) + "]"; }
/// With commas between them.
inline std::string list_of(const std::vector<std::string>& entries) {
  std::string text;
  for (const std::string& entry : entries) text += (text.empty() ? "" : ",") + entry;
  return text;
}

/// Uniform numbers between two bounds, the same for the same seed.
class RandomNumbers {
 public:
  explicit RandomNumbers(unsigned seed) : engine_(seed) {}
  double operator()(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }

 private:
  std::mt19937 engine_;
};

}  // namespace catena::testing
