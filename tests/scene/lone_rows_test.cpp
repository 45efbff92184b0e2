// Columns that are zero in all rows but one: what two runs differ by there may be small by chance.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

// A rod hangs on a spring with a curve, and one row of five lies in its touch of a stop with damping.
TextRun rod_at_stop(const std::string& method) {
  return run_text(
      R"_({"catena": 1, "gravity": [-0.9282283103890729, -9.199726014952166],
    "bodies": {"b": {"mass": 1.408257577841718, "inertia": 0.13528729554983263,
      "position": [0.07540150271394495, -0.3308671425183868],
      "points": {"C": [0, 0], "E": [0.09400270150367519, -0.21803549957373758]}}},
    "constraints": [{"name": "J0", "type": "revolute", "i": "ground",
                     "j": ["b", [-0.07540150271394495, 0.3308671425183868]]}],
    "forces": [{"name": "curve0", "type": "spring_damper", "i": ["ground", [-0.9744263575126093, 0.8361830570182207]],
        "j": ["b", [0.10926360204460174, -0.26748379199544614]], "length": 1.6870581195291388, "c": 0.1863428763709859,
        "curve": [[-2, -60], [-0.3, -10], [0, 0], [0.2, 15], [0.5, 25], [3, 100]]},
      {"name": "stop1", "type": "stop", "column": "J0.angle", "min": -0.5837666915971649, "max": 0.043229239134118067,
        "k": 56.177272836791545, "c": 0.23979704320031858, "exponent": 1.5},
      {"name": "contactr2", "curve": {"line": {"point": [0.05272539361264514, -0.8747370143977],
        "axis": [0.941458426286229, -0.3371291022363051]}}, "type": "contact", "i": "ground",
        "j": ["b", [0.09400270150367519, -0.21803549957373758]], "radius": 0.05, "side": 1, "restitution": 0.3},
      {"name": "law3", "type": "point_force", "i": "b.E", "force": ["=-0.42666463909602437*b.E.vx",
        "=-0.42666463909602437*b.E.vy"]}],
    "columns": {"press": "=abs(stop1.force)"}, "outputs": ["press", "stop1.force", "b.omega"],
    "analyses": [{"type": "dynamics", "until": 1, "every": 0.25, )_" +
      method + "}]}");
}

TEST(LoneRows, ClaimNoMoreDigitsThanAreRight) {
  const TextRun exact = rod_at_stop(R"("tolerance": 1e-12, "method": "rk8")");
  ASSERT_EQ(exact.outcome.exit_code, 0) << exact.outcome.error_text;
  for (const std::string method : {R"("tolerance": 1e-5, "method": "adams")", R"("tolerance": 1e-6, "method": "adams")",
                                   R"("tolerance": 1e-5, "method": "radau")"}) {
    const TextRun run = rod_at_stop(method);
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
    ASSERT_EQ(run.analysis().digits.size(), run.analysis().columns.size());
    for (std::size_t k = 0; k < run.analysis().columns.size(); ++k) {
      const std::string& name = run.analysis().columns[k].name;
      const std::vector<double> values = run.column(name), right = exact.column(name);
      double size = 0, error = 0;
      for (std::size_t row = 0; row < values.size(); ++row) {
        size = std::max(size, std::abs(right[row]));
        error = std::max(error, std::abs(values[row] - right[row]));
      }
      const double digits = run.analysis().digits[k];
      EXPECT_FALSE(std::pow(10, -digits) * size < error / 10) << method << " " << name << " claims " << digits;
      if (name == "b.omega") {
        EXPECT_GT(digits, 2);
      } else if (name == "stop1.force") {
        EXPECT_TRUE(std::isnan(digits)) << method << " claims " << digits;
      }
    }
  }
}

}  // namespace
}  // namespace catena::testing
