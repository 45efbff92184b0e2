// Samples of watched columns in a stretch of time, and whether they show how a column goes on between them.
//
//   t_n = a + (b - a) s_n,  n = 0 ... 8        g_1, g_3, g_5, g_7 as the polynomial through g_0, g_2, g_4, g_6, g_8
//                                              foretells them, to 1 % of the range of all
//
// A sine is missed by 1 % where its samples are half a radian apart: it shows every passage then. Of two million sines
// of 2 to 500 periods in the stretch, at random phases, one looked smooth. Steps may be much longer than what a column
// does in them, where it depends on time or on a place that moves evenly, which no integrator's error sees. The s_n are
// not equally spaced: an oscillation could look at rest, or slow, at equal distances.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

namespace catena {

class EventSamples {
 public:
  /// The polynomial goes through every other sample and is tested by those between.
  static constexpr int parts = 8;

  /// Begins a step.
  void begin(std::size_t columns) {
    for (std::vector<double>& g : g_) g.resize(columns);
    kinks_.assign(columns, 0);
  }
  /// The instant of sample n in [a, b].
  static double instant(double a, double b, int n) {
    return n == parts ? b : a + (b - a) * places[static_cast<std::size_t>(n)];
  }
  /// All columns at sample n.
  std::span<double> at(int n) { return g_[static_cast<std::size_t>(n)]; }

  /// Column k has a kink or noise here: halves show no more of it.
  void note_kink(std::size_t k) { ++kinks_[k]; }

  /// Whether column k may pass zero without being seen. `tiny`: what counts as zero. Of a column with many kinks in
  /// this step, which is noise, nothing more can be said.
  bool may_hide(std::size_t k, double tiny) const {
    if (kinks_[k] >= most_kinks) return false;
    double least = g_[0][k], most = least, nearest = std::abs(least);
    for (const std::vector<double>& g : g_) {
      least = std::min(least, g[k]);
      most = std::max(most, g[k]);
      nearest = std::min(nearest, std::abs(g[k]));
    }
    if (!(most - least > above_rounding * tiny)) return false;
    const double miss = this->miss(k);
    return miss > foreseen * (most - least) && miss > out_of_reach * nearest;
  }
  /// By how much the polynomial misses what it is to foretell.
  double miss(std::size_t k) const {
    double miss = 0;
    for (std::size_t n = 0; n < weights.size(); ++n) {
      double foretold = 0;
      for (std::size_t i = 0; i < weights[n].size(); ++i) foretold += weights[n][i] * g_[2 * i][k];
      miss = std::max(miss, std::abs(g_[2 * n + 1][k] - foretold));
    }
    return miss;
  }

 private:
  static constexpr std::array<double, parts + 1> places{0, 0.113, 0.271, 0.383, 0.497, 0.641, 0.743, 0.887, 1};
  // Of the range of all samples: see the head of this file.
  static constexpr double foreseen = 0.01;
  // A column stays on its side where the polynomial is missed by less than this part of its distance from zero: between
  // samples it is missed by not much more than at them.
  static constexpr double out_of_reach = 0.3;
  static constexpr double above_rounding = 1e3;
  // Each takes some two hundred samples to be found.
  static constexpr int most_kinks = 8;

  /// Lagrange's polynomial through every second sample, at those between: weight of sample 2 i at sample 2 n + 1.
  using Weights = std::array<std::array<double, parts / 2 + 1>, parts / 2>;
  static constexpr Weights weights = [] {
    Weights of{};
    for (std::size_t n = 0; n < of.size(); ++n) {
      for (std::size_t i = 0; i < of[n].size(); ++i) {
        of[n][i] = 1;
        for (std::size_t j = 0; j < of[n].size(); ++j)
          if (j != i) of[n][i] *= (places[2 * n + 1] - places[2 * j]) / (places[2 * i] - places[2 * j]);
      }
    }
    return of;
  }();

  std::array<std::vector<double>, parts + 1> g_;
  std::vector<int> kinks_;  // by column
};

}  // namespace catena
