// Sizes of tests that dense algebra makes long: smaller ones in builds with sanitizers, in which it runs a hundred
// times slower. The whole sizes run in every other build.
#pragma once

namespace catena::testing {

#if defined(__SANITIZE_ADDRESS__)
inline constexpr bool is_sanitized = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
inline constexpr bool is_sanitized = true;
#else
inline constexpr bool is_sanitized = false;
#endif
#else
inline constexpr bool is_sanitized = false;
#endif

template <class N>
constexpr N size_of_test(N whole, N if_sanitized) {
  return is_sanitized ? if_sanitized : whole;
}

}  // namespace catena::testing
