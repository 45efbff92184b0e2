// How many digits of stiff motions are right, by their own claim and in closed form: by implicit methods, and by
// `auto`, which turns to them on the way.
#include "analysis/sanitized.hpp"
#include "oracles/claimed_digits.hpp"
#include "oracles/stiff_wheel.hpp"

namespace catena::testing {
namespace {

void add_wheel(unsigned seed, const std::string& method, ClaimedDigits& claims, int& turned) {
  StiffWheel wheel(seed);
  const double tolerance = std::pow(10.0, -3 - wheel.pick(method == "alpha" ? 4 : 8));
  const TextRun run = wheel.run(method, tolerance);
  const std::string what = method + " of wheel " + std::to_string(seed) + " at " + std::to_string(tolerance);
  ASSERT_TRUE(run.analysis().report.ok()) << what << ": " << run.analysis().report.message;
  ASSERT_EQ(run.analysis().digits.size(), 4u) << what << " claims nothing";
  for (const NamedField& field : run.analysis().fields)
    turned += field.name == "method" && std::get<std::string>(field.value).find("radau") != std::string::npos;
  static const char* const columns[] = {"wheel.angle", "wheel.omega", "wheel.alpha"};
  for (int derivative = 0; derivative < 3; ++derivative) {
    std::vector<long double> exact;
    for (const double t : run.column("t")) exact.push_back(wheel.exact(derivative, t));
    claims.add(run, columns[derivative], exact, what);
  }
}

// Of those by `auto` none was claimed once implicit steps took over, nor where stiffness bounded explicit ones.
TEST(ClaimedDigits, HoldOfStiffMotions) {
  for (const char* method : {"auto", "radau", "alpha"}) {
    ClaimedDigits claims;
    int turned = 0;
    const unsigned wheels = size_of_test(12u, 3u);
    for (unsigned seed = 1; seed <= wheels; ++seed) add_wheel(seed, method, claims, turned);
    EXPECT_EQ(claims.size(), 3 * wheels);
    if (std::string(method) == "auto") {
      EXPECT_GE(turned, static_cast<int>(wheels / 4));
    }
    claims.expect(std::string("stiff, ") + method);
  }
}

}  // namespace
}  // namespace catena::testing
