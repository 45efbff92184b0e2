// Cams, motion laws of drivers, and forces that kernels have no formulas for, in lanes: those of each design by itself,
// and closed forms of an eccentric disc.
#include "catena/analysis/batch/batch.hpp"
#include "catena/elements/all.hpp"
#include "catena/model/model_add.hpp"
#include "design/lane_families.hpp"

namespace catena::testing {
namespace {

const std::string harmonic_cam =
    R"json({"polar": {"angle": [0, 1, 2, 3, 4, 5, "=2*pi"], "radius": ["r", "=r + h", "=r + 1.5*h", "=r + h", "=r + 0.4*h",
      "=r - 0.1*h", "r"]}})json";

/// A cam on the ground and a follower that slides beside its centre; `contact`: between the two.
std::string cam_and_follower(const std::string& contact) {
  return R"json( "bodies": {"cam": {"mass": 1, "inertia": 0.1}, "follower": {"mass": 0.5, "inertia": 0.1, "position": ["off", "=r + 0.1"]}},
    "constraints": [{"type": "revolute", "name": "shaft", "i": "ground", "j": "cam"},
      {"type": "translational", "name": "guide", "i": ["ground", ["off", 0]], "j": "follower", "axis_i": [0, 1]},)json" +
         contact + R"json(],
    "drivers": [{"type": "absolute_angle", "name": "drive", "i": "cam", "value": {"polynomial": [0.2, "w"]}}],)json";
}
const std::vector<std::string> lifts{R"json({"range": "follower.y"})json", R"json({"max": "follower.vy"})json",
                                     R"json({"rms": "follower.vy"})json", R"json({"final": "follower.ay"})json"};

/// A knife edge on a cam; some stand beside it.
Family knife_edges() {
  return {cam_and_follower(R"json({"type": "point_on_curve", "name": "C", "i": "cam", "j": "follower", "curve": )json" +
                           harmonic_cam + "}"),
          {"r", "h", "off", "w"},
          lifts,
          {{0.2, 0.4}, {0.02, 0.15}, {-0.5, 0.5}, {1, 3}}};
}

/// A flat face on an oval, which is hollow in some designs: there the contact jumps, and the motion ends. Measures are
/// taken at instants: extremes of a motion whose third derivative jumps are as good as the samples that they are found
/// from.
Family flat_faces() {
  Family family{
      cam_and_follower(
          R"json({"type": "cam_flat", "name": "C", "i": "cam", "j": "follower", "axis_j": [1, 0], "curve": {"spline":
            {"points": [["r", 0], ["=0.7*r", "=0.7*h"], ["off", "=h"], ["=-0.7*r", "=0.7*h"], ["=-r", 0], ["=-0.7*r", "=-0.7*h"],
              [0, "=-n*h"], ["=0.7*r", "=-0.7*h"]], "end": "periodic"}}})json"),
      {"r", "h", "n", "off", "w"},
      {R"json({"at": "=1.37/w", "of": "follower.y"})json", R"json({"at": "=3.21/w", "of": "follower.vy"})json",
       R"json({"at": "=4.9/w", "of": "follower.y"})json", R"json({"final": "follower.ay"})json"},
      {{0.2, 0.3}, {0.2, 0.3}, {0.85, 1.05}, {-0.02, 0.02}, {1, 3}}};
  return family;
}

/// A roller on a cam, its columns of forces among what is measured.
Family rollers() {
  Family family{
      cam_and_follower(R"json({"type": "cam_cam", "name": "C", "i": "cam", "j": "follower", "curve_j": {"circle":
        {"centre": [0, 0], "radius": "q"}}, "curve_i": )json" +
                       harmonic_cam + "}"),
      {"r", "h", "off", "w", "q"},
      {R"json({"range": "follower.y"})json", R"json({"max": "drive.load"})json", R"json({"rms": "C.lambda1"})json",
       R"json({"final": "C.fx"})json", R"json({"mean": "drive.power"})json"},
      {{0.2, 0.4}, {0.02, 0.15}, {-0.6, 0.6}, {1, 3}, {0.02, 0.1}}};
  family.mechanism = R"json("gravity": [0, -9.81],)json" + family.mechanism;
  family.analysis = "inverse_dynamics";
  family.size = 100;
  return family;
}

Family four_bars_driven_by(const std::string& value) {
  return {four_bar + R"json(], "drivers": [{"type": "absolute_angle", "i": "crank", "value": )json" + value + "}],",
          {"a", "b", "c", "d", "w"},
          {R"json({"range": "rocker.angle"})json", R"json({"max": "coupler.pen.y"})json",
           R"json({"rms": "rocker.omega"})json", R"json({"final": "coupler.pen.ay"})json"},
          {{0.2, 0.6}, {0.8, 1.6}, {0.7, 1.3}, {1.0, 1.8}, {1, 3}}};
}
/// Rises and dwells: the accelerations of some jump where a rise ends.
Family motion_laws() {
  return four_bars_driven_by(R"json({"sum": [
    {"law": {"type": "cycloidal", "t0": "=0.5/w", "t1": "=2/w", "from": 0, "to": 1.5}},
    {"law": {"type": "poly345", "t0": "=2.2/w", "t1": "=3/w", "from": 0, "to": 0.8}},
    {"law": {"type": "modified_sine", "t0": "=3/w", "t1": "=4.5/w", "from": 0, "to": -1.2}},
    {"law": {"type": "modified_trapezoid", "t0": "=4.6/w", "t1": "=5.5/w", "from": 0, "to": "=a"}},
    {"law": {"type": "poly4567", "t0": "=5/w", "t1": "=5.9/w", "from": 0, "to": 1}}]})json");
}
/// A table of time, periodic, times a harmonic.
Family tables_of_time() {
  return four_bars_driven_by(R"json({"sum": [{"spline": {"t": [0, "=1/w", "=2.5/w", "=4/w"], "value": [0, 1, -0.5, 0],
      "end": "periodic"}}, {"product": [{"polynomial": [0, "w"]}, {"harmonic": {"amplitude": 0.3, "omega": "w",
      "offset": 0.5}}]}]})json");
}

/// Torques by laws of state, one with a table, and a spring with a curve, on a crank-rocker.
Family laws_of_state() {
  Family family{
      R"json("gravity": [0, -9.81], "tables": {"p": {"x": [-4, -1, 0, 2, 5], "y": [1, 0.5, 2, 3, 0], "beyond": "line"}},)json" +
          four_bar +
          R"json(], "drivers": [{"type": "absolute_angle", "name": "drive", "i": "crank", "value": {"polynomial": [0, "w"]}}],
    "forces": [{"type": "torque", "i": "rocker", "torque": "=-0.4*rocker.omega + sin(crank.angle)*p(rocker.angle)"},
      {"type": "point_force", "i": "coupler.pen", "force": ["=-k*coupler.pen.vx*abs(coupler.pen.vx)", 0.5]},
      {"type": "spring_damper", "i": ["ground", [0.3, 1.5]], "j": "rocker.to", "k": 0, "length": 0.5,
       "curve": {"points": [[-1, -3], [0, 0], [0.5, 2], [1, 6]], "beyond": "line"}}],)json",
      {"a", "b", "c", "d", "w", "k"},
      {R"json({"max": "drive.load"})json", R"json({"mean": "drive.power"})json", R"json({"final": "rocker.alpha"})json",
       R"json({"rms": "=drive.load + k"})json"},
      {{0.2, 0.6}, {0.8, 1.6}, {0.7, 1.3}, {1.0, 1.8}, {1, 3}, {0.1, 0.8}}};
  give_masses(family);
  family.analysis = "inverse_dynamics";
  family.size = 100;
  return family;
}

/// A law whose table ends: it is left by some rockers.
Family laws_that_end() {
  Family family = laws_of_state();
  const std::size_t place = family.mechanism.find(", \"beyond\": \"line\"}}");
  family.mechanism.erase(place, std::string(", \"beyond\": \"line\"").size());
  family.mechanism.replace(family.mechanism.find("-4, -1, 0, 2, 5"), 15, "-4, -1, 0, 2, 3.1");
  return family;
}

/// An elastic rope over a pulley, from the rocker to a weight on a guide.
Family ropes() {
  Family family{
      R"json("gravity": [0, -9.81],)json" + four_bar +
          R"json(], "drivers": [{"type": "absolute_angle", "name": "drive", "i": "crank", "value": {"polynomial": [0, "w"]}}],
    "forces": [{"type": "rope", "i": "rocker.to", "over": [{"at": ["ground", ["=d + 1.2", 1.6]], "radius": "q", "side": -1}],
      "j": ["ground", ["=d + 1.5", 0]], "k": 30, "length": "=2.4 + a"}],)json",
      {"a", "b", "c", "d", "w", "q"},
      {R"json({"max": "drive.load"})json", R"json({"mean": "drive.power"})json",
       R"json({"range": "rocker.angle"})json"},
      {{0.2, 0.6}, {0.8, 1.6}, {0.7, 1.3}, {1.0, 1.8}, {1, 3}, {0.1, 0.2}}};
  give_masses(family);
  family.analysis = "inverse_dynamics";
  family.size = 100;
  return family;
}

class RandomContacts : public ::testing::TestWithParam<Family (*)()> {};

TEST_P(RandomContacts, AreWhatEachIsByItself) { expect_same_as_alone(GetParam()()); }

INSTANTIATE_TEST_SUITE_P(Lanes, RandomContacts,
                         ::testing::Values(knife_edges, flat_faces, rollers, motion_laws, tables_of_time, laws_of_state,
                                           laws_that_end, ropes));

// A disc of radius R about a point at e from the shaft lifts a flat face to R + e sin(theta).
TEST(Batch, EccentricDiscsInClosedForm) {
  const auto radius_of = [](std::int64_t k) { return 0.3 + 0.01 * static_cast<double>(k % 11); };
  const auto offset_of = [](std::int64_t k) { return 0.05 + 0.004 * static_cast<double>(k % 13); };
  auto model = std::make_shared<Model>();
  const int cam = model->add_body("cam", {});
  BodyValues above;
  above.position = {0, 0.3};
  const int follower = model->add_body("follower", above);
  model->add("shaft", Revolute<double>{}, ground, cam);
  model->add("guide", Translational<double>{.axis_i = {0, 1}, .axis_j = {0, 1}}, ground, follower);
  CamFlat<double> contact;
  contact.curve = Curve<double>::circle({0.1, 0}, 0.3);
  contact.axis_j = {1, 0};
  model->add("contact", contact, cam, follower);
  const std::vector<double> turning{0, 2};
  model->add_driver("drive", AbsoluteAngle<double>{}, cam, ground, TimeFunction<double>::polynomial(turning));
  const auto design = [&](std::int64_t k, Model& written) {
    auto& entry = std::get<std::vector<ElementEntry<CamFlat<double>, double>>>(written.constraints).front();
    entry.element.curve = Curve<double>::circle({offset_of(k), 0}, radius_of(k));
    entry.element.complete(written.frame(cam), written.frame(follower));
  };
  const TimeGrid grid = TimeGrid::range(0, 3, 0.05);
  int taken = 0;
  const BatchReport report = Batch(model).run(40, grid, design, [&](const BatchRows& rows) {
    for (int lane = 0; lane < rows.designs; ++lane, ++taken) {
      ASSERT_EQ(rows.status(lane), Status::ok) << rows.message(lane);
      const std::int64_t k = rows.first + lane;
      for (int row = 0; row < rows.rows; ++row) {
        const double theta = 2 * grid[row], e = offset_of(k);
        EXPECT_NEAR(rows.position(row, follower, lane).y, radius_of(k) + e * std::sin(theta), 1e-12);
        EXPECT_NEAR(rows.velocity(row, follower, lane).vy, 2 * e * std::cos(theta), 1e-12);
        EXPECT_NEAR(rows.acceleration(row, follower, lane).vy, -4 * e * std::sin(theta), 1e-12);
      }
    }
  });
  EXPECT_EQ(taken, 40);
  EXPECT_EQ(report.in_lanes, 40);
}

}  // namespace
}  // namespace catena::testing
