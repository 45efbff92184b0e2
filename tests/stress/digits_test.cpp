// How many digits of a column are right, by its own claim and by a solution in long double.
#include <gtest/gtest.h>

#include "stress/cases.hpp"
#include "stress/driven_digits.hpp"
#include "stress/flutter_digits.hpp"
#include "stress/moving_digits.hpp"
#include "stress/path_digits.hpp"
#include "stress/resting_digits.hpp"
#include "stress/rope_digits.hpp"
#include "stress/stiff_digits.hpp"
#include "stress/touching_digits.hpp"

namespace catena::testing {
namespace {

TEST(Digits, OfDrivenMechanismsAreThoseClaimed) {
  ClaimedDigits claims;
  std::map<std::string, int> seen;
  for (unsigned seed = first_case(); seed <= last_case(10000); ++seed) ++seen[add_driven_digits(seed, claims)];
  print_shares("digits of random driven mechanisms", seen);
  claims.expect("driven");
}

TEST(Digits, OfMechanismsAtRestAreThoseClaimed) {
  ClaimedDigits claims;
  std::map<std::string, int> seen;
  for (unsigned seed = first_case(); seed <= last_case(10000); ++seed) ++seen[add_resting_digits(seed, claims)];
  print_shares("digits of random mechanisms at rest", seen);
  claims.expect("at rest");
}

TEST(Digits, OfMechanismsInMotionAreThoseClaimed) {
  ClaimedDigits claims;
  std::map<std::string, int> seen;
  for (unsigned seed = first_case(); seed <= last_case(2000); ++seed) ++seen[add_moving_digits(seed, claims)];
  print_shares("digits of random mechanisms in motion", seen);
  claims.expect("in motion");
}

TEST(Digits, OfOneRunAreThoseClaimed) {
  ClaimedDigits claims;
  std::map<std::string, int> seen;
  for (unsigned seed = first_case(); seed <= last_case(10000); ++seed)
    ++seen[add_moving_digits(seed, claims, Runs::one)];
  print_shares("digits of one run of random mechanisms", seen);
  claims.expect("in motion, one run");
}

TEST(Digits, OfMethodsThatRunTwiceAreThoseClaimed) {
  std::map<std::string, int> seen;
  for (const auto& [method, title] : {std::pair(Runs::adams, "adams"), std::pair(Runs::baumgarte, "baumgarte"),
                                      std::pair(Runs::partitioning, "partitioning")}) {
    ClaimedDigits claims;
    for (unsigned seed = first_case(); seed <= last_case(700); ++seed) ++seen[add_moving_digits(seed, claims, method)];
    claims.expect(std::string("in motion, ") + title);
  }
  print_shares("digits of adams, baumgarte and partitioning", seen);
}

TEST(Digits, OfStiffMotionsAreThoseClaimed) {
  ClaimedDigits claims;
  std::map<std::string, int> seen;
  for (unsigned seed = first_case(); seed <= last_case(100); ++seed) ++seen[add_stiff_digits(seed, claims)];
  print_shares("digits of stiff motions", seen);
  claims.expect("stiff");
}

TEST(Digits, OfMotionsWithContactsAreThoseClaimed) {
  ClaimedDigits claims;
  std::map<std::string, int> seen;
  for (unsigned seed = first_case(); seed <= last_case(10000); ++seed) ++seen[add_touching_digits(seed, claims)];
  print_shares("digits of motions with contacts", seen);
  claims.expect("with contacts");
}

TEST(Digits, OfPathsAreThoseClaimed) {
  ClaimedDigits claims;
  std::map<std::string, int> seen;
  for (unsigned seed = first_case(); seed <= last_case(4000); ++seed) ++seen[add_path_digits(seed, claims)];
  print_shares("digits of paths", seen);
  claims.expect("paths");
}

TEST(Digits, OfPathsThatFlutterAreThoseClaimed) {
  ClaimedDigits claims;
  std::map<std::string, int> seen;
  for (unsigned seed = first_case(); seed <= last_case(4000); ++seed) ++seen[add_flutter_digits(seed, claims)];
  print_shares("digits of paths that flutter", seen);
  claims.expect("flutter");
}

TEST(Digits, OfRopesOnPulleysAreThoseClaimed) {
  ClaimedDigits claims;
  std::map<std::string, int> seen;
  for (unsigned seed = first_case(); seed <= last_case(4000); ++seed) ++seen[add_rope_digits(seed, claims)];
  print_shares("digits of ropes on pulleys", seen);
  claims.expect("ropes");
}

}  // namespace
}  // namespace catena::testing
