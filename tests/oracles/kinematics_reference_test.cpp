// Linkages and slides through scenes, against reference solutions (data/reference, each file with its own definition,
// method and cross-check): positions to 1e-11, velocities to 1e-10, accelerations and loads to 1e-9 of the largest.
#include "oracles/kinematic_reference.hpp"

namespace catena::testing {
namespace {

using nlohmann::json;

// Adds twelve crank positions of a column in the analysis number `analysis`.
void add_turn(Comparison& comparison, const TextRun& run, std::size_t analysis, const std::string& column,
              double allowed, const json& values, const std::function<double(const json&)>& pick) {
  const std::vector<double> computed = run.column(column, analysis);
  ASSERT_EQ(computed.size(), 73u) << column;
  for (int k = 0; k < 12; ++k) comparison.add(column, allowed, computed[crank_row(k)], pick(values.at(crank_key(k))));
}

std::function<double(const json&)> key(const std::string& name) {
  return [name](const json& v) { return v.at(name).get<double>(); };
}
std::function<double(const json&)> entry(const std::string& name, std::size_t k) {
  return [name, k](const json& v) { return v.at(name).at(k).get<double>(); };
}

TEST(KinematicReference, FourBarWithCouplerPointAndReactions) {
  const json values = reference_values("fourbar_crank_rocker");
  json scene = data_scene("crank_rocker");
  // The reference's coupler point lies 0.12 m from A along the coupler, whose middle is at 0.125 m.
  scene["outputs"] = {"coupler.angle",  "rocker.angle",   "coupler.omega",  "rocker.omega",
                      "coupler.alpha",  "rocker.alpha",   "coupler.pen.x",  "coupler.pen.y",
                      "coupler.pen.vx", "coupler.pen.vy", "coupler.pen.ax", "coupler.pen.ay"};
  scene["analyses"][2]["outputs"] = {"drive.load", "O2.fx", "O2.fy", "A.fx", "A.fy", "B.fx", "B.fy", "O4.fx", "O4.fy"};
  const TextRun run = run_text(scene.dump());
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  Comparison comparison;
  add_turn(comparison, run, 1, "coupler.angle", position_error, values, key("theta3"));
  add_turn(comparison, run, 1, "rocker.angle", position_error, values, key("theta4"));
  add_turn(comparison, run, 1, "coupler.omega", velocity_error, values, key("omega3"));
  add_turn(comparison, run, 1, "rocker.omega", velocity_error, values, key("omega4"));
  add_turn(comparison, run, 1, "coupler.alpha", acceleration_error, values, key("alpha3"));
  add_turn(comparison, run, 1, "rocker.alpha", acceleration_error, values, key("alpha4"));
  const char* const axes[] = {"x", "y"};
  const std::pair<const char*, const char*> joints[] = {{"O2", "R_ground_on_crank_O2"},
                                                        {"A", "R_crank_on_coupler_A"},
                                                        {"B", "R_coupler_on_rocker_B"},
                                                        {"O4", "R_ground_on_rocker_O4"}};
  for (std::size_t k = 0; k < 2; ++k) {
    const std::string pen = "coupler.pen.", axis = axes[k];
    add_turn(comparison, run, 1, pen + axis, position_error, values, entry("P", k));
    add_turn(comparison, run, 1, pen + "v" + axis, velocity_error, values, entry("P_vel", k));
    add_turn(comparison, run, 1, pen + "a" + axis, acceleration_error, values, entry("P_acc", k));
    for (const auto& [joint, force] : joints)
      add_turn(comparison, run, 2, std::string(joint) + ".f" + axis, load_error, values, entry(force, k));
  }
  add_turn(comparison, run, 2, "drive.load", load_error, values, key("torque_crank"));
  comparison.expect(12);
}

TEST(KinematicReference, SliderCrankWithTorqueAndReactions) {
  const json values = reference_values("slider_crank_inverse_dynamics");
  const TextRun run = run_data_scene("slider_crank_joints");
  Comparison comparison;
  add_turn(comparison, run, 1, "slider.x", position_error, values, key("slider_x"));
  add_turn(comparison, run, 1, "slider.vx", velocity_error, values, key("slider_v"));
  add_turn(comparison, run, 1, "slider.ax", acceleration_error, values, key("slider_a"));
  add_turn(comparison, run, 1, "rod.angle", position_error, values, key("phi_rod"));
  add_turn(comparison, run, 1, "rod.omega", velocity_error, values, key("omega_rod"));
  add_turn(comparison, run, 1, "rod.alpha", acceleration_error, values, key("alpha_rod"));
  add_turn(comparison, run, 2, "drive.load", load_error, values, key("torque_crank"));
  add_turn(comparison, run, 2, "guide.fy", load_error, values, key("guide_normal_on_slider_y"));
  const std::pair<const char*, const char*> joints[] = {
      {"O", "R_ground_on_crank"}, {"A", "R_crank_on_rod"}, {"B", "R_rod_on_slider"}};
  for (const auto& [joint, force] : joints) {
    add_turn(comparison, run, 2, std::string(joint) + ".fx", load_error, values, entry(force, 0));
    add_turn(comparison, run, 2, std::string(joint) + ".fy", load_error, values, entry(force, 1));
  }
  comparison.expect(12);
}

TEST(KinematicReference, SliderCrankInFourModels) {
  const json values = reference_values("slider_crank_inverse_dynamics");
  const std::pair<const char*, const char*> models[] = {{"slider_crank_joints", "slider"},
                                                        {"slider_crank_slot", "rod.to"},
                                                        {"slider_crank_coupler", "slider"},
                                                        {"slider_crank_drivers", "rod.to"}};
  const TextRun first = run_data_scene("slider_crank_joints");
  for (const auto& [name, slide] : models) {
    SCOPED_TRACE(name);
    const TextRun run = run_data_scene(name);
    Comparison comparison;
    const std::string body = slide;
    add_turn(comparison, run, 1, body + ".x", position_error, values, key("slider_x"));
    add_turn(comparison, run, 1, body + ".vx", velocity_error, values, key("slider_v"));
    add_turn(comparison, run, 1, body + ".ax", acceleration_error, values, key("slider_a"));
    comparison.expect(12);
    // And at every row what the joints give.
    Comparison rows;
    for (const auto& [end, allowed] : {std::pair{".x", 1e-14}, {".vx", 1e-13}, {".ax", 1e-12}}) {
      const std::vector<double> a = run.column(body + end, 1), b = first.column(std::string("slider") + end, 1);
      ASSERT_EQ(a.size(), b.size());
      for (std::size_t k = 0; k < a.size(); ++k) rows.add(end, allowed, a[k], b[k]);
    }
    rows.expect(73);
  }
}

TEST(KinematicReference, QuickReturnInFourModels) {
  const json values = reference_values("crank_slotted_lever_quick_return");
  const std::pair<const char*, const char*> models[] = {{"quick_return_joints", "ram"},
                                                        {"quick_return_slot", "link.end"},
                                                        {"quick_return_coupler", "ram"},
                                                        {"quick_return_drivers", "link.end"}};
  const TextRun first = run_data_scene("quick_return_joints");
  for (const auto& [name, ram] : models) {
    SCOPED_TRACE(name);
    const TextRun run = run_data_scene(name);
    Comparison comparison;
    add_turn(comparison, run, 1, "lever.angle", position_error, values, key("psi"));
    add_turn(comparison, run, 1, "lever.omega", velocity_error, values, key("psi_d"));
    add_turn(comparison, run, 1, "lever.alpha", acceleration_error, values, key("psi_dd"));
    add_turn(comparison, run, 1, "slot.slide", position_error, values, key("s"));
    add_turn(comparison, run, 1, "slot.slide_rate", velocity_error, values, key("s_d"));
    comparison.expect(12);
    Comparison rows;
    for (const auto& [end, allowed] : {std::pair{".x", 1e-14}, {".vx", 1e-13}, {".ax", 1e-12}}) {
      const std::vector<double> a = run.column(std::string(ram) + end, 1),
                                b = first.column(std::string("ram") + end, 1);
      ASSERT_EQ(a.size(), b.size());
      for (std::size_t k = 0; k < a.size(); ++k) rows.add(end, allowed, a[k], b[k]);
    }
    rows.expect(73);
  }
}

TEST(KinematicReference, ChebyshevLambda) {
  const json values = reference_values("chebyshev_lambda");
  const TextRun run = run_data_scene("chebyshev");
  Comparison comparison;
  add_turn(comparison, run, 1, "coupler.pen.x", position_error, values, key("Px"));
  add_turn(comparison, run, 1, "coupler.pen.vx", velocity_error, values, key("Px_d"));
  add_turn(comparison, run, 1, "coupler.pen.ax", acceleration_error, values, key("Px_dd"));
  add_turn(comparison, run, 1, "coupler.pen.y", position_error, values, key("Py"));
  add_turn(comparison, run, 1, "coupler.pen.vy", velocity_error, values, key("Py_d"));
  add_turn(comparison, run, 1, "coupler.pen.ay", acceleration_error, values, key("Py_dd"));
  comparison.expect(12);
}

// The reference gives speed and acceleration of the crank at each angle: twelve starts.
TEST(KinematicReference, ScotchYoke) {
  const json values = reference_values("scotch_yoke");
  Comparison comparison;
  for (int k = 0; k < 12; ++k) {
    RunOptions options;
    options.set = {{"start", std::to_string(30 * k) + " deg"}};
    const TextRun run = run_data_scene("scotch_yoke", options);
    const json& at = values.at(crank_key(k));
    comparison.add("x", position_error, run.first("yoke.x", 1), at.at("x"));
    comparison.add("v", velocity_error, run.first("yoke.vx", 1), at.at("x_d"));
    comparison.add("a", acceleration_error, run.first("yoke.ax", 1), at.at("x_dd"));
  }
  comparison.expect(12);
}

// Counted from the crank's own centre the reference's wheel angle has the other sign.
TEST(KinematicReference, GenevaWheel) {
  const json values = reference_values("geneva_4slot");
  json scene = data_scene("geneva");
  const std::vector<int> angles = {-44, -30, -10, 0, 20, 40};
  json times = json::array();
  for (int angle : angles) times.push_back("=(" + std::to_string(angle) + "*pi/180 + engaged)/speed");
  scene["analyses"] = {{{"type", "kinematics"}, {"at", times}}};
  const TextRun run = run_text(scene.dump());
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  Comparison comparison;
  for (std::size_t k = 0; k < angles.size(); ++k) {
    const json& at = values.at("al_" + std::to_string(angles[k]) + "deg");
    comparison.add("angle", position_error, -run.column("wheel.angle").at(k), at.at("beta"));
    comparison.add("omega", velocity_error, -run.column("wheel.omega").at(k), at.at("omega"));
    comparison.add("alpha", acceleration_error, -run.column("wheel.alpha").at(k), at.at("alpha"));
  }
  comparison.expect(6);
}

}  // namespace
}  // namespace catena::testing
