// The dead points of a crank-rocker driven at its rocker, through scenes, against the cosine law (data/reference).
//
// The motion ends there: the instant is reported, and with it the rocker's angle. The crank's angle goes on like the
// square root of the time left; but as a function of s = 1/omega, which is smooth and zero at the dead point, it can be
// extrapolated from rows before it.
#include <numbers>
#include <span>

#include "oracles/kinematic_reference.hpp"

namespace catena::testing {
namespace {

using nlohmann::json;

constexpr double start = 1.8;  // rad, between the two dead points

TextRun rocker_driven(double rate, const json& analysis) {
  json scene = data_scene("crank_rocker");
  scene["drivers"][0]["i"] = "rocker";
  scene["drivers"][0]["value"]["polynomial"] = {start, rate};
  scene["analyses"] = json::array({analysis});
  scene["outputs"] = {"crank.angle", "crank.omega", "rocker.angle"};
  return run_text(scene.dump());
}

double instant_of_lock_up(const TextRun& run) {
  for (const NamedField& field : run.analysis().fields) {
    if (field.name != "singular") continue;
    const FieldRecord& record = std::get<std::vector<FieldRecord>>(field.value).at(0);
    for (const auto& [key, value] : record)
      if (key == "t") return std::get<double>(value);
  }
  ADD_FAILURE() << "no singular instant reported";
  return std::nan("");
}

// Neville's scheme: the value at s = 0 of the polynomial through (s[k], y[k]).
double extrapolate(std::span<const double> s, std::vector<double> y) {
  for (std::size_t order = 1; order < y.size(); ++order) {
    for (std::size_t k = 0; k + order < y.size(); ++k)
      y[k] = (s[k + order] * y[k] - s[k] * y[k + 1]) / (s[k + order] - s[k]);
  }
  return y[0];
}

void expect_dead_point(double rate, double rocker, double crank) {
  const TextRun run = rocker_driven(rate, {{"type", "kinematics"}, {"until", 2}, {"every", 0.05}});
  EXPECT_EQ(run.outcome.exit_code, 1);
  EXPECT_EQ(run.analysis().report.status, Status::lock_up);
  // Rows before it are kept, one gives the dead point itself, none beyond it is made up.
  const double end = instant_of_lock_up(run);
  const std::vector<double> rows = run.column("t");
  ASSERT_GE(rows.size(), 2u);
  EXPECT_EQ(rows.back(), end);
  EXPECT_LT(rows[rows.size() - 2], end);
  EXPECT_GT(rows[rows.size() - 2], end - 0.05);
  EXPECT_NEAR(run.last("rocker.angle"), rocker, position_error * rocker);
  EXPECT_NEAR(std::remainder(run.last("crank.angle") - crank, 2 * std::numbers::pi), 0, 1e-7);
  EXPECT_TRUE(std::isnan(run.last("crank.omega")));
  EXPECT_NEAR(start + rate * end, rocker, position_error * rocker);

  json instants = json::array();
  for (int k = 8; k >= 1; --k) instants.push_back(end - 1e-5 * k * k);
  const TextRun near = rocker_driven(rate, {{"type", "kinematics"}, {"at", instants}});
  ASSERT_EQ(near.outcome.exit_code, 0);
  std::vector<double> s;
  for (double omega : near.column("crank.omega")) s.push_back(1 / omega);
  const double angle = extrapolate(s, near.column("crank.angle"));
  EXPECT_NEAR(std::remainder(angle - crank, 2 * std::numbers::pi), 0, position_error * crank);
}

TEST(KinematicReference, FourBarDeadPoints) {
  const json values = reference_values("fourbar_dead_points");
  expect_dead_point(-1, values.at("rocker_outer"), values.at("crank_angle_outer_dead_point"));
  expect_dead_point(1, values.at("rocker_inner"), values.at("crank_angle_inner_dead_point"));
}

}  // namespace
}  // namespace catena::testing
