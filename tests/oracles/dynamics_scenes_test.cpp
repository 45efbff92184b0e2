// Dynamics, inverse dynamics and reactions as a user meets them: scenes as text against independent solutions.
#include <gtest/gtest.h>

#include <numbers>

#include "oracles/static_reference.hpp"
#include "scene/run_text.hpp"

namespace catena {
namespace {

using nlohmann::json;
using testing::reference_values;
using testing::run_text;
using testing::TextRun;

/// The rows of one analysis, looked up by time.
class Rows {
 public:
  explicit Rows(const std::string& text) : run_(run_text(text)) {
    EXPECT_EQ(run_.outcome.exit_code, 0) << run_.outcome.error_text;
    for (const AnalysisResult& result : run_.outcome.analyses) EXPECT_TRUE(result.report.ok()) << result.report.message;
  }
  double at(double t, const std::string& column) const {
    const std::vector<double> times = run_.column("t"), values = run_.column(column);
    for (std::size_t k = 0; k < times.size() && k < values.size(); ++k) {
      if (std::abs(times[k] - t) < 1e-12) return values[k];
    }
    ADD_FAILURE() << "no " << column << " at " << t;
    return std::nan("");
  }
  /// Expects `want` up to 1e-9 of its own size or of `size`, whichever is larger.
  void near(double t, const std::string& column, const json& want, double size = 1) const {
    const double value = want.get<double>();
    EXPECT_NEAR(at(t, column), value, 1e-9 * std::max(size, std::abs(value))) << column << " at " << t;
  }
  void vector_near(double t, const std::string& joint, const json& want, double size) const {
    near(t, joint + ".fx", want[0], size);
    near(t, joint + ".fy", want[1], size);
  }

 private:
  TextRun run_;
};

TEST(DynamicsScenes, RodPendulum) {
  const json values = reference_values("rod_pendulum");
  const Rows rows(R"({"catena": 1, "gravity": [0, -9.81],
    "bodies": {"rod": {"rod": {"from": [0, 0], "to": [1.5, 0]}, "mass": 2}},
    "constraints": [{"type": "revolute", "name": "pin", "i": "ground", "j": "rod.from"}],
    "analyses": [{"type": "dynamics", "until": 2, "every": 0.25, "tolerance": 1e-12}],
    "outputs": ["rod.angle", "rod.omega", "rod.alpha", "rod.x", "rod.y", "pin.fx", "pin.fy", "energy.balance"]})");
  for (const auto& [name, t] : {std::pair{"t=0.25", 0.25}, {"t=0.5", 0.5}, {"t=1.0", 1.0}, {"t=2.0", 2.0}}) {
    const json& want = values.at(name);
    rows.near(t, "rod.angle", want.at("theta").get<double>() - std::numbers::pi / 2);
    rows.near(t, "rod.omega", want.at("omega"));
    rows.near(t, "rod.alpha", want.at("alpha"));
    rows.near(t, "rod.x", want.at("xG"));
    rows.near(t, "rod.y", want.at("yG"));
    rows.vector_near(t, "pin", {want.at("reaction_on_rod_x"), want.at("reaction_on_rod_y")}, 2 * 9.81);
    rows.near(t, "energy.balance", 0, 2 * 9.81 * 0.75);
  }
}

TEST(DynamicsScenes, SpringPendulums) {
  struct Problem {
    const char *reference, *body, *spring;
    std::vector<std::pair<const char*, double>> times;
  };
  const Problem problems[] = {{"spring_pendulum",
                               R"("mass": 1, "position": [1, 0])",
                               R"("k": 50, "length": 1)",
                               {{"t=0.5", 0.5}, {"t=1.0", 1.0}, {"t=2.0", 2.0}, {"t=5.0", 5.0}}},
                              {"spring_damper_pendulum",
                               R"("mass": 0.6, "position": [0.5, -0.9], "velocity": [1, 2])",
                               R"("k": 180, "c": 1.3, "length": 0.8)",
                               {{"t=0.3", 0.3}, {"t=1.0", 1.0}, {"t=4.0", 4.0}}}};
  for (const Problem& problem : problems) {
    const json values = reference_values(problem.reference);
    const Rows rows(R"({"catena": 1, "gravity": [0, -9.81], "bodies": {"ball": {"particle": true, )" +
                    std::string(problem.body) +
                    R"(}}, "forces": [{"type": "spring_damper", "name": "spring", "i": "ground", "j": "ball", )" +
                    problem.spring + R"(}],
      "analyses": [{"type": "dynamics", "until": 5, "every": 0.1, "tolerance": 1e-12}],
      "outputs": ["ball.x", "ball.y", "ball.vx", "ball.vy", "energy.balance"]})");
    for (const auto& [name, t] : problem.times) {
      const json& want = values.at(name);
      rows.near(t, "ball.x", want.at("x"));
      rows.near(t, "ball.y", want.at("y"));
      rows.near(t, "ball.vx", want.at("vx"));
      rows.near(t, "ball.vy", want.at("vy"));
      rows.near(t, "energy.balance", 0, 10);
    }
  }
}

TEST(DynamicsScenes, FreeFlightWithSpin) {
  const json values = reference_values("free_flight_spin");
  const Rows rows(R"({"catena": 1, "gravity": [0, -9.81],
    "bodies": {"body": {"mass": 2, "inertia": 0.3, "position": [0, 1], "velocity": [3, 5], "angular_velocity": 7}},
    "analyses": [{"type": "dynamics", "until": 2, "every": 0.5}],
    "outputs": ["body.x", "body.y", "body.angle", "body.vy"]})");
  for (const auto& [name, t] : {std::pair{"t=0.5", 0.5}, {"t=1", 1.0}, {"t=2", 2.0}}) {
    const json& want = values.at(name);
    rows.near(t, "body.x", want.at("x"));
    rows.near(t, "body.y", want.at("y"));
    rows.near(t, "body.angle", want.at("phi"));
    rows.near(t, "body.vy", want.at("vy"));
  }
}

TEST(DynamicsScenes, RackThatFallsTurnsItsPinion) {
  const json want = reference_values("rack_pinion_drop");
  const Rows rows(R"({"catena": 1, "gravity": [0, -9.81],
    "bodies": {"rack": {"mass": 3, "inertia": 1, "position": [-0.05, 0]}, "pinion": {"mass": 1, "inertia": 0.004}},
    "constraints": [{"type": "translational", "i": "ground", "j": "rack", "at": [-0.05, 0], "axis_i": [0, 1]},
                    {"type": "revolute", "i": "ground", "j": "pinion"},
                    {"type": "rack_pinion", "name": "teeth", "i": "rack", "j": "pinion", "axis_i": [0, 1],
                     "radius": 0.05, "side": -1}],
    "analyses": [{"type": "dynamics", "until": 0.7, "every": 0.7, "tolerance": 1e-12}],
    "outputs": ["rack.y", "rack.vy", "rack.ay", "pinion.angle", "teeth.i.fy"]})");
  rows.near(0.7, "rack.y", -want.at("drop").get<double>());
  rows.near(0.7, "rack.vy", -want.at("v").get<double>());
  rows.near(0.7, "rack.ay", -want.at("a").get<double>());
  rows.near(0.7, "teeth.i.fy", want.at("F_tooth"));
  EXPECT_NEAR(std::abs(rows.at(0.7, "pinion.angle")), want.at("pinion_angle").get<double>(), 1e-9 * 31);
}

/// A driven mechanism: the reference gives loads and reactions at crank angles, so many degrees apart.
struct Driven {
  const char* reference;
  std::string model;
  double speed;
  std::vector<std::pair<std::string, std::string>> joints;  ///< column, reference; forces on body j
  std::vector<std::pair<std::string, std::string>> values;
  double force, torque;  ///< sizes
};

// What inverse dynamics says and what dynamics finds where the driver is a constraint like the others.
void check_driven(const Driven& problem) {
  const json values = reference_values(problem.reference);
  std::string outputs = R"("drive.load")";
  for (const auto& joint : problem.joints) outputs += ", \"" + joint.first + ".fx\", \"" + joint.first + ".fy\"";
  for (const auto& value : problem.values) outputs += ", \"" + value.first + "\"";
  const double degree = std::numbers::pi / 180;
  for (const std::string type : {"inverse_dynamics", "dynamics"}) {
    SCOPED_TRACE(type);
    const std::string tolerance = type == "dynamics" ? R"(, "tolerance": 1e-12)" : "";
    const Rows rows(problem.model + R"("analyses": [{"type": ")" + type +
                    R"(", "until": "=2*pi/speed", "every": "=pi/36/speed")" + tolerance + R"(}], "outputs": [)" +
                    outputs + "]}");
    for (const auto& item : values.items()) {
      if (item.key().rfind("crank_", 0) != 0 && item.key().rfind("th_", 0) != 0) continue;
      const double angle = std::stod(item.key().substr(item.key().find('_') + 1));
      const double t = angle * degree / problem.speed;
      const json& want = item.value();
      const char* torque = want.contains("torque_crank") ? "torque_crank" : "torque";
      rows.near(t, "drive.load", want.at(torque), problem.torque);
      for (const auto& [column, name] : problem.joints) rows.vector_near(t, column, want.at(name), problem.force);
      for (const auto& [column, name] : problem.values) rows.near(t, column, want.at(name), problem.force);
    }
  }
}

TEST(DynamicsScenes, RodSpunByADriver) {
  check_driven({"spinning_rod",
                R"({"catena": 1, "gravity": [0, -9.81], "parameters": {"speed": 12},
    "bodies": {"rod": {"rod": {"from": [0, 0], "to": [2, 0]}, "mass": 3}},
    "constraints": [{"type": "revolute", "name": "pin", "i": "ground", "j": "rod.from"}],
    "drivers": [{"type": "absolute_angle", "name": "drive", "i": "rod", "value": {"polynomial": [0, "speed"]}}], )",
                12,
                {{"pin", "R"}},
                {},
                432,
                29.43});
}

TEST(DynamicsScenes, SliderCrank) {
  check_driven({"slider_crank_inverse_dynamics",
                R"({"catena": 1, "gravity": [0, -9.81], "parameters": {"speed": 100},
    "bodies": {"crank": {"rod": {"from": [0, 0], "to": [0.1, 0]}, "mass": 1},
               "rod": {"rod": {"from": [0.1, 0], "to": [0.4, 0]}, "mass": 1.5},
               "slider": {"mass": 2, "inertia": 0.01, "position": [0.4, 0]}},
    "constraints": [{"type": "revolute", "name": "O", "i": "ground", "j": "crank.from"},
                    {"type": "revolute", "name": "A", "i": "crank.to", "j": "rod.from"},
                    {"type": "revolute", "name": "B", "i": "rod.to", "j": "slider"},
                    {"type": "translational", "name": "guide", "i": "ground", "j": "slider", "axis_i": [1, 0]}],
    "drivers": [{"type": "absolute_angle", "name": "drive", "i": "crank", "value": {"polynomial": [0, "speed"]}}], )",
                100,
                {{"O", "R_ground_on_crank"}, {"A", "R_crank_on_rod"}, {"B", "R_rod_on_slider"}},
                {{"guide.fy", "guide_normal_on_slider_y"}, {"slider.ax", "slider_a"}, {"rod.alpha", "alpha_rod"}},
                5000,
                200});
}

TEST(DynamicsScenes, CrankRocker) {
  check_driven({"fourbar_crank_rocker",
                R"({"catena": 1, "gravity": [0, -9.81], "parameters": {"speed": 10},
    "bodies": {"crank": {"rod": {"from": [0, 0], "to": [0.1, 0]}, "mass": 0.5},
               "coupler": {"rod": {"from": [0.1, 0], "to": [0.2562, 0.1952]}, "mass": 1.2, "inertia": 0.00625},
               "rocker": {"rod": {"from": [0.3, 0], "to": [0.2562, 0.1952]}, "mass": 0.9, "inertia": 0.003}},
    "constraints": [{"type": "revolute", "name": "O2", "i": "ground", "j": "crank.from"},
                    {"type": "revolute", "name": "A", "i": "crank.to", "j": ["coupler", [-0.125, 0]]},
                    {"type": "revolute", "name": "B", "i": ["coupler", [0.125, 0]], "j": ["rocker", [0.1, 0]]},
                    {"type": "revolute", "name": "O4", "i": ["ground", [0.3, 0]], "j": ["rocker", [-0.1, 0]]}],
    "drivers": [{"type": "absolute_angle", "name": "drive", "i": "crank", "value": {"polynomial": [0, "speed"]}}], )",
                10,
                {{"O2", "R_ground_on_crank_O2"},
                 {"A", "R_crank_on_coupler_A"},
                 {"B", "R_coupler_on_rocker_B"},
                 {"O4", "R_ground_on_rocker_O4"}},
                {{"coupler.alpha", "alpha3"}, {"rocker.alpha", "alpha4"}},
                25,
                1});
}

// IFToMM A01 over 2000 s, some thousand swings.
TEST(DynamicsScenes, SimplePendulumForTwoThousandSeconds) {
  const json values = reference_values("A01_udc_2000s");
  const Rows rows(R"({"catena": 1, "gravity": [0, -9.81],
    "bodies": {"ball": {"mass": 1, "particle": true, "position": [1, 0]}},
    "constraints": [{"type": "absolute_distance", "i": "ball", "ground": [0, 0], "value": 1}],
    "analyses": [{"type": "dynamics", "until": 2000, "every": 10, "tolerance": 1e-12}],
    "outputs": ["ball.x", "ball.y", "energy.total"]})");
  for (const auto& item : values.items()) {
    if (item.key().rfind("t=", 0) != 0) continue;
    const double t = std::stod(item.key().substr(2));
    EXPECT_NEAR(rows.at(t, "ball.x"), item.value().at("x").get<double>(), 1e-6) << t;
    EXPECT_NEAR(rows.at(t, "ball.y"), item.value().at("y").get<double>(), 1e-6) << t;
    EXPECT_NEAR(rows.at(t, "energy.total"), 0, 1e-9 * 9.81) << t;
  }
}

}  // namespace
}  // namespace catena
