// "did you mean": what is suggested, and what is not.
#include "catena/scene/json/near_miss.hpp"

#include <gtest/gtest.h>

#include <array>

namespace catena {
namespace {

std::string_view nearest(std::string_view word) {
  constexpr std::array<std::string_view, 10> known{"length",
                                                   "mass",
                                                   "inertia",
                                                   "position",
                                                   "points",
                                                   "angle",
                                                   "velocity",
                                                   "i",
                                                   "j",
                                                   "gr\xc3\xb6\xc3\x9f"
                                                   "e"};
  return NearMiss(word).consider_all(known).best();
}

TEST(NearMiss, FindsUsualSlips) {
  EXPECT_EQ(nearest("lenght"), "length");    // swapped neighbours
  EXPECT_EQ(nearest("lengt"), "length");     // one missing
  EXPECT_EQ(nearest("masss"), "mass");       // one too many
  EXPECT_EQ(nearest("inartia"), "inertia");  // one changed
  EXPECT_EQ(nearest("postion"), "position");
  EXPECT_EQ(nearest("velocityy"), "velocity");
  EXPECT_EQ(nearest("Mass"), "mass");
  EXPECT_EQ(nearest("I"), "i");
  EXPECT_EQ(nearest("gr\xc3\xb6sse"),
            "gr\xc3\xb6\xc3\x9f"
            "e");  // characters count, not bytes
}

TEST(NearMiss, SuggestsNothingFarFetched) {
  EXPECT_EQ(nearest("colour"), "");
  EXPECT_EQ(nearest("x"), "");
  EXPECT_EQ(nearest(""), "");
  EXPECT_EQ(nearest("mess_of_things"), "");
  EXPECT_EQ(nearest(std::string(100000, 'a')), "");
}

TEST(NearMiss, PrefersTheNearestAndTheFirst) {
  constexpr std::array<std::string_view, 3> links{"link12", "link1", "link11"};
  EXPECT_EQ(NearMiss("link111").consider_all(links).best(), "link11");
  EXPECT_EQ(NearMiss("lin1").consider_all(links).best(), "link1");
  EXPECT_EQ(NearMiss("lenght").consider_all(std::array<std::string_view, 1>{"length"}).hint(),
            "; did you mean \"length\"?");
  EXPECT_EQ(NearMiss("abc").hint(), "");
}

}  // namespace
}  // namespace catena
