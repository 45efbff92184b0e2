// The frame of tests by the thousand: a scene for every seed, and what is wrong with its answer in words.
#pragma once

#include <gtest/gtest.h>

#include <string>

namespace catena::testing {

/// `fault(seed)`, for seed = first ... last, says what is wrong; empty: nothing. All count, the first twenty are shown.
template <class Fault>
void expect_no_fault(unsigned first, unsigned last, Fault&& fault) {
  constexpr int shown = 20;
  int wrong = 0;
  for (unsigned seed = first; seed <= last; ++seed) {
    const std::string said = fault(seed);
    wrong += !said.empty();
    if (!said.empty() && wrong <= shown) ADD_FAILURE() << "seed " << seed << ": " << said;
  }
  EXPECT_EQ(wrong, 0) << "of " << last - first + 1;
}

}  // namespace catena::testing
