// Machines: pantograph, excavator, windscreen wiper, scissor lift, steering.
#include "scene/data_facts.hpp"
#include "scene/dyad.hpp"

namespace catena::testing {
namespace {

constexpr double pi = std::numbers::pi;

// The angle of the boom about the ground's origin when its cylinder, from (0.5, -0.4) to (2, 0.1) on the boom, has this
// length: cosine law.
double boom_angle(double cylinder) {
  const double base = std::hypot(0.5, 0.4), lug = std::hypot(2.0, 0.1);
  return std::atan2(-0.4, 0.5) + std::acos((base * base + lug * lug - cylinder * cylinder) / (2 * base * lug)) -
         std::atan2(0.1, 2.0);
}

// The angle of a knuckle at (side 0.7, 0) when its arm is tied to the rack's end at this offset of the rack.
double knuckle_angle(double rack, int side) {
  const double lean = pi / 9;
  const Point straight{-side * 0.15 * std::sin(lean), -0.15 * std::cos(lean)}, pivot{side * 0.7, 0};
  const Point end{side * 0.3, -0.12};
  const double tie = norm(pivot + straight - end);
  const Point arm = meet(pivot, 0.15, end + Point{rack, 0}, tie, side);
  return direction(pivot, arm) - std::atan2(straight.y, straight.x);
}

// The generalized momentum of the redundant arm in the motion that nothing drives: links turn by n, their common end
// stays.
double idle_momentum(const TextRun& run, std::size_t row) {
  const auto value = [&](const std::string& column) { return run.column(column, kinematic)[row]; };
  const double length[] = {std::hypot(0.3, 0.52), 0.6, std::hypot(0.2, 0.42)}, mass[] = {4, 3, 1};
  const char* name[] = {"upper", "fore", "hand"};
  double angle[3];
  for (int k = 0; k < 3; ++k) angle[k] = value(name[k] + std::string(".angle"));
  double sum = 0;
  Point joint{0, 0};  // its velocity
  for (int k = 0; k < 3; ++k) {
    const double n = std::sin(angle[(k + 2) % 3] - angle[(k + 1) % 3]) / length[k];
    const Point half = n * length[k] / 2 * Point{-std::sin(angle[k]), std::cos(angle[k])};
    const Point centre = joint + half;
    const std::string body = name[k];
    sum += mass[k] * (centre.x * value(body + ".vx") + centre.y * value(body + ".vy") +
                      length[k] * length[k] / 12 * n * value(body + ".omega"));
    joint = centre + half;
  }
  EXPECT_NEAR(norm(joint), 0, 1e-12);
  return sum;
}

}  // namespace

SceneFacts machine_facts() {
  return {
      {"pantograph.json",
       [](const TextRun& run) {
         expect_mobility(run, 2);
         expect_no_warnings(run);
         for (const char* axis : {"x", "y"}) {
           expect_column(
               run, std::string("second.pencil.") + axis, std::string("third.tracer.") + axis,
               [](double tracer) { return 2.5 * tracer; }, 1e-13);
         }
       }},
      {"excavator_arm.json",
       [](const TextRun& run) {
         expect_mobility(run, 3);
         expect_no_warnings(run);
         EXPECT_NEAR(run.first("boom.angle", kinematic), boom_angle(1.85), 1e-12);
         EXPECT_NEAR(run.last("boom.angle", kinematic), boom_angle(2.1), 1e-12);
         // A cylinder's push at rest carries the arm, so the foot carries the weight of everything less its share.
         const double weight = (900 + 450 + 30 + 35 + 350) * 9.81;
         const double lean = std::atan2(2 * std::sin(boom_angle(2.1)) + 0.1 * std::cos(boom_angle(2.1)) + 0.4,
                                        2 * std::cos(boom_angle(2.1)) - 0.1 * std::sin(boom_angle(2.1)) - 0.5);
         const double push = run.last("boom_cylinder.load", 2);
         EXPECT_NEAR(run.last("foot.fy", 2) + push * std::sin(lean), weight, 1e-8 * weight);
         EXPECT_NEAR(run.last("foot.fx", 2) + push * std::cos(lean), 0, 1e-8 * weight);
       }},
      {"windscreen_wiper.json",
       [](const TextRun& run) {
         expect_no_warnings(run);
         // arm = crank/sin(45 deg) with equal times to and fro: both blades sweep 90 degrees, up to the grid of rows.
         EXPECT_NEAR(degrees(range(run, "left.angle")), 90, 0.01);
         const std::vector<double> left = run.column("left.angle", kinematic),
                                   right = run.column("right.angle", kinematic);
         for (std::size_t k = 0; k < left.size(); ++k) EXPECT_NEAR(left[k], right[k], 1e-12);
         const auto [least, most] = std::minmax_element(left.begin(), left.end());
         EXPECT_NEAR(static_cast<double>(std::abs(most - least)), 180, 1);
       }},
      {"scissor_lift.json",
       [](const TextRun& run) {
         EXPECT_EQ(run.analysis(0).report.rows, 72);
         expect_no_warnings(run);
         expect_column(
             run, "rising12.to.y", "falling1.to.x", [](double foot) { return 12 * std::sqrt(4 - foot * foot); }, 1e-12);
         EXPECT_EQ(run.column("t", kinematic).size(), 41u);
         EXPECT_NEAR(run.last("rising12.to.vy", kinematic), 0, 1e-12);
       }},
      {"rack_steering.json",
       [](const TextRun& run) {
         expect_mobility(run, 1);
         expect_no_warnings(run);
         expect_column(
             run, "rack.x", "pinion.angle", [](double angle) { return 0.008 * angle; }, 1e-14);
         expect_column(
             run, "left.angle", "rack.x", [](double rack) { return knuckle_angle(rack, -1); }, 1e-12);
         expect_column(
             run, "right.angle", "rack.x", [](double rack) { return knuckle_angle(rack, 1); }, 1e-12);
         // Left bends mirror right ones: half a period later the wheels have changed their parts.
         const std::vector<double> left = run.column("left.angle", kinematic),
                                   right = run.column("right.angle", kinematic);
         ASSERT_EQ(left.size(), 73u);
         for (std::size_t k = 0; k + 36 < left.size(); ++k) EXPECT_NEAR(left[k], -right[k + 36], 1e-12);
         EXPECT_GT(left[18], 1.1 * right[18]);
       }},
      {"redundant_arm.json",
       [](const TextRun& run) {
         EXPECT_EQ(run.analysis(0).report.dof, 1);
         EXPECT_EQ(run.analysis(0).report.mobility, 3);
         expect_column(
             run, "hand.to.x", "t", [](double t) { return 0.9 + 0.2 * std::cos(2 * pi * t); }, 1e-12);
         expect_column(
             run, "hand.to.y", "t", [](double t) { return 0.1 + 0.2 * std::sin(2 * pi * t); }, 1e-12);
         // Least kinetic energy: the momenta do no work in the one motion that leaves the hand's end where it is.
         for (std::size_t row = 0; row < 200; row += 7) EXPECT_NEAR(idle_momentum(run, row), 0, 1e-12);
         // The arm is not where it began after a round: C. Klein, C. Huang (1983).
         const std::vector<double> angle = run.column("upper.angle", kinematic);
         ASSERT_EQ(angle.size(), 201u);
         EXPECT_GT(std::abs(angle[50] - angle[0]), 1e-3);
       }},
  };
}

}  // namespace catena::testing
