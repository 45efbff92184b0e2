// Where a spectrum of small motions under forces without a potential changes its kind as a quantity s goes on.
//
//   divergence   a real omega2 passes zero           located as the zero of that value
//   flutter      two real omega2 meet and become a complex pair, or the other way round
//                                                    located as the zero of ((omega2_a - omega2_b) / 2)^2, -b^2 of a
//                                                    pair: smooth through the point, unlike the values themselves
//
// Between two places with different numbers of negative values and pairs: bracketed by these numbers, by the secant
// rule with every third step a bisection. Not seen: changes within one interval that cancel.
// Source: A. Seyranian, A. Mailybaev, Multiparameter Stability Theory with Mechanical Applications, 2003, chapter 2.
#pragma once

#include <functional>
#include <vector>

#include "catena/analysis/spectrum/circulatory_modes.hpp"

namespace catena {

struct SpectrumSample {
  double s = 0;
  CirculatoryModes found;

  bool is_like(const SpectrumSample& other) const {
    return found.negative == other.found.negative && found.pairs == other.found.pairs;
  }
};

struct SpectrumCrossing {
  bool flutter = false;  ///< else divergence
  double s = 0;
  int values = 0, pairs = 0;  ///< by how many negative values and pairs change, with the sign of s
  double omega2 = 0;          ///< where values meet
  std::vector<double> mode;   ///< over columns, of length 1 in the metric of the spectrum
};

/// The spectrum at s; false where there is none.
using SpectrumAt = std::function<bool(double s, CirculatoryModes& found)>;

/// All changes between two samples, in order; `complete`: whether they account for the difference.
std::vector<SpectrumCrossing> find_crossings(const SpectrumAt& at, const SpectrumSample& low,
                                             const SpectrumSample& high, bool& complete);

/// Between three samples of one kind: a place of another kind, which there is if the lowest positive value, or the
/// distance of two neighbouring values, has a minimum in between and that is below zero. False: there is none.
bool find_hidden_change(const SpectrumAt& at, const SpectrumSample& a, const SpectrumSample& b, const SpectrumSample& c,
                        SpectrumSample& hidden);

}  // namespace catena
