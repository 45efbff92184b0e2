// Linkages and slides through scenes, against reference solutions (data/reference, each file with its own definition,
// method and cross-check): positions to 1e-11, velocities to 1e-10, accelerations and loads to 1e-9 of the largest.
#include "oracles/claimed_digits.hpp"
#include "oracles/kinematic_reference.hpp"

namespace catena::testing {
namespace {

using nlohmann::json;

using Pick = std::function<double(const json&)>;

Pick key(const std::string& name) {
  return [name](const json& v) { return v.at(name).get<double>(); };
}
Pick entry(const std::string& name, std::size_t k) {
  return [name, k](const json& v) { return v.at(name).at(k).get<double>(); };
}

/// Twelve crank positions of a run against a reference solution.
class Turn {
 public:
  Turn(const TextRun& run, const std::string& reference) : run_(run), values_(reference_values(reference)) {}
  ~Turn() {
    comparison_.expect(12);
    claims_.expect("reference");
    EXPECT_EQ(claims_.size(), claims_.asked()) << "columns without digits";
  }

  void add(std::size_t analysis, const std::string& column, double allowed, const Pick& pick) {
    const std::vector<double> computed = run_.column(column, analysis);
    ASSERT_EQ(computed.size(), 73u) << column;
    std::vector<long double> exact;
    std::vector<std::size_t> rows;
    for (int k = 0; k < 12; ++k) {
      exact.push_back(pick(values_.at(crank_key(k))));
      rows.push_back(crank_row(k));
      comparison_.add(column, allowed, computed[rows.back()], static_cast<double>(exact.back()));
    }
    claims_.add(run_, column, exact, column, analysis, rows);
  }
  /// Position, velocity and acceleration, in the kinematics: the second analysis.
  void motion(const std::array<std::string, 3>& columns, const std::array<Pick, 3>& picks) {
    for (std::size_t k = 0; k < 3; ++k) add(1, columns[k], allowed_[k], picks[k]);
  }
  void angle(const std::string& body, const std::array<Pick, 3>& picks) {
    motion({body + ".angle", body + ".omega", body + ".alpha"}, picks);
  }
  void place(const std::string& point, const char* axis, const std::array<Pick, 3>& picks) {
    motion({point + "." + axis, point + ".v" + axis, point + ".a" + axis}, picks);
  }
  /// Loads, in the inverse dynamics: the third analysis.
  void load(const std::string& column, const Pick& pick) { add(2, column, load_error, pick); }
  void force(const std::string& joint, const std::string& name) {
    load(joint + ".fx", entry(name, 0));
    load(joint + ".fy", entry(name, 1));
  }

 private:
  static constexpr std::array allowed_ = {position_error, velocity_error, acceleration_error};
  const TextRun& run_;
  json values_;
  Comparison comparison_;
  ClaimedDigits claims_;
};

/// A mechanism modelled in several ways: a scene, and the body or point that slides in it.
using Models = std::vector<std::pair<const char*, std::string>>;

/// Every model against the reference, by `compare`, and at every row with what the first one gives.
template <class Compare>
void compare_models(const Models& models, const char* reference, const Compare& compare) {
  const TextRun first = run_data_scene(models[0].first);
  for (const auto& [name, slide] : models) {
    SCOPED_TRACE(name);
    const TextRun run = run_data_scene(name);
    Turn turn(run, reference);
    compare(turn, slide);
    Comparison rows;
    for (const auto& [end, allowed] : {std::pair{".x", 1e-14}, {".vx", 1e-13}, {".ax", 1e-12}}) {
      const std::vector<double> a = run.column(slide + end, 1), b = first.column(models[0].second + end, 1);
      ASSERT_EQ(a.size(), b.size());
      for (std::size_t k = 0; k < a.size(); ++k) rows.add(end, allowed, a[k], b[k]);
    }
    rows.expect(73);
  }
}

TEST(KinematicReference, FourBarWithCouplerPointAndReactions) {
  json scene = data_scene("crank_rocker");
  // The reference's coupler point lies 0.12 m from A along the coupler, whose middle is at 0.125 m.
  scene["outputs"] = {"coupler.angle",  "rocker.angle",   "coupler.omega",  "rocker.omega",
                      "coupler.alpha",  "rocker.alpha",   "coupler.pen.x",  "coupler.pen.y",
                      "coupler.pen.vx", "coupler.pen.vy", "coupler.pen.ax", "coupler.pen.ay"};
  scene["analyses"][2]["outputs"] = {"drive.load", "O2.fx", "O2.fy", "A.fx", "A.fy", "B.fx", "B.fy", "O4.fx", "O4.fy"};
  const TextRun run = run_text(scene.dump());
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  Turn turn(run, "fourbar_crank_rocker");
  turn.angle("coupler", {key("theta3"), key("omega3"), key("alpha3")});
  turn.angle("rocker", {key("theta4"), key("omega4"), key("alpha4")});
  turn.place("coupler.pen", "x", {entry("P", 0), entry("P_vel", 0), entry("P_acc", 0)});
  turn.place("coupler.pen", "y", {entry("P", 1), entry("P_vel", 1), entry("P_acc", 1)});
  turn.force("O2", "R_ground_on_crank_O2");
  turn.force("A", "R_crank_on_coupler_A");
  turn.force("B", "R_coupler_on_rocker_B");
  turn.force("O4", "R_ground_on_rocker_O4");
  turn.load("drive.load", key("torque_crank"));
}

TEST(KinematicReference, SliderCrankWithTorqueAndReactions) {
  const TextRun run = run_data_scene("slider_crank_joints");
  Turn turn(run, "slider_crank_inverse_dynamics");
  turn.place("slider", "x", {key("slider_x"), key("slider_v"), key("slider_a")});
  turn.angle("rod", {key("phi_rod"), key("omega_rod"), key("alpha_rod")});
  turn.load("drive.load", key("torque_crank"));
  turn.load("guide.fy", key("guide_normal_on_slider_y"));
  turn.force("O", "R_ground_on_crank");
  turn.force("A", "R_crank_on_rod");
  turn.force("B", "R_rod_on_slider");
}

TEST(KinematicReference, SliderCrankInFourModels) {
  const Models models = {{"slider_crank_joints", "slider"},
                         {"slider_crank_slot", "rod.to"},
                         {"slider_crank_coupler", "slider"},
                         {"slider_crank_drivers", "rod.to"}};
  compare_models(models, "slider_crank_inverse_dynamics", [](Turn& turn, const std::string& slide) {
    turn.place(slide, "x", {key("slider_x"), key("slider_v"), key("slider_a")});
  });
}

TEST(KinematicReference, QuickReturnInFourModels) {
  const Models models = {{"quick_return_joints", "ram"},
                         {"quick_return_slot", "link.end"},
                         {"quick_return_coupler", "ram"},
                         {"quick_return_drivers", "link.end"}};
  compare_models(models, "crank_slotted_lever_quick_return", [](Turn& turn, const std::string&) {
    turn.angle("lever", {key("psi"), key("psi_d"), key("psi_dd")});
    turn.add(1, "slot.slide", position_error, key("s"));
    turn.add(1, "slot.slide_rate", velocity_error, key("s_d"));
  });
}

TEST(KinematicReference, ChebyshevLambda) {
  const TextRun run = run_data_scene("chebyshev");
  Turn turn(run, "chebyshev_lambda");
  turn.place("coupler.pen", "x", {key("Px"), key("Px_d"), key("Px_dd")});
  turn.place("coupler.pen", "y", {key("Py"), key("Py_d"), key("Py_dd")});
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
