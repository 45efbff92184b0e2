// Reference problems as a user meets them: the program's own output, read back and compared with data/reference.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "cli/program.hpp"
#include "oracles/static_reference.hpp"

namespace catena::testing {
namespace {

using nlohmann::json;

const std::string scenes = std::string(CATENA_DATA_DIR) + "/scenes/";

json run_json(std::vector<std::string> arguments) {
  arguments.push_back("--json");
  const ProgramResult result = run_catena(arguments);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return json::parse(result.out);
}

double value(const json& analysis, const std::string& column, std::size_t row) {
  const json& names = analysis.at("columns");
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (names[k] == column) return analysis.at("rows").at(row).at(k).get<double>();
  }
  ADD_FAILURE() << "no column " << column;
  return std::nan("");
}

TEST(Reference, SliderCrankAsPrinted) {
  const json values = reference_values("slider_crank_inverse_dynamics");
  const json analyses = run_json({"run", scenes + "slider_crank_joints.json"}).at("analyses");
  for (int k = 0; k < 12; ++k) {
    const json& at = values.at("crank_" + std::to_string(30 * k) + "deg");
    const auto row = static_cast<std::size_t>(6 * k);
    EXPECT_NEAR(value(analyses[1], "slider.x", row), at.at("slider_x").get<double>(), 1e-11 * 0.4) << k;
    EXPECT_NEAR(value(analyses[1], "slider.vx", row), at.at("slider_v").get<double>(), 1e-10 * 10) << k;
    EXPECT_NEAR(value(analyses[1], "slider.ax", row), at.at("slider_a").get<double>(), 1e-9 * 1333) << k;
    EXPECT_NEAR(value(analyses[2], "drive.load", row), at.at("torque_crank").get<double>(), 1e-9 * 196) << k;
    EXPECT_NEAR(value(analyses[2], "guide.fy", row), at.at("guide_normal_on_slider_y").get<double>(), 1e-9 * 629) << k;
  }
}

// Parameters, instants and columns from the command line.
TEST(Reference, ScotchYokeFromTheCommandLine) {
  const json values = reference_values("scotch_yoke");
  for (int k = 0; k < 12; k += 5) {
    const json analyses =
        run_json({"kinematics", scenes + "scotch_yoke.json", "--set", "start=" + std::to_string(30 * k) + " deg",
                  "--at", "0", "--outputs", "yoke.x,yoke.vx,yoke.ax"})
            .at("analyses");
    ASSERT_EQ(analyses.size(), 1u);
    const json& at = values.at("crank_" + std::to_string(30 * k) + "deg");
    EXPECT_NEAR(value(analyses[0], "yoke.x", 0), at.at("x").get<double>(), 1e-11 * 0.08) << k;
    EXPECT_NEAR(value(analyses[0], "yoke.vx", 0), at.at("x_d").get<double>(), 1e-10 * 1.6) << k;
    EXPECT_NEAR(value(analyses[0], "yoke.ax", 0), at.at("x_dd").get<double>(), 1e-9 * 32) << k;
  }
}

}  // namespace
}  // namespace catena::testing
