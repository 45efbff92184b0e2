// Walking legs, followed pin by pin with circles.
#include "scene/data_facts.hpp"
#include "scene/dyad.hpp"

namespace catena::testing {
namespace {

// Jansen's leg; his numbers in mm.
Point jansen_toe(double crank) {
  const Point shoulder{-0.038, -0.0078}, pin = polar(0.015, crank);
  const Point top = meet(shoulder, 0.0415, pin, 0.05, 1);
  const Point back = meet(shoulder, 0.0401, top, 0.0558, 1);
  const Point knee = meet(shoulder, 0.0393, pin, 0.0619, -1);
  const Point ankle = meet(back, 0.0394, knee, 0.0367, -1);
  return meet(knee, 0.049, ankle, 0.0657, 1);
}

Point klann_foot(double crank) {
  const Point pin = polar(0.0175, crank), lower{-0.0388, -0.0125}, upper{-0.0146, 0.0419};
  const Point middle = meet(pin, 0.0388, lower, 0.0237, -1);
  // The arm is bent at the middle pin: pin, middle and knee are a triangle.
  const Point knee = meet(pin, 0.0734, middle, 0.0352, -1);
  const Point hip = meet(upper, 0.0341, knee, 0.0577, -1);
  return meet(hip, 0.1117, knee, 0.059, 1);
}

// How much of the crank's turn the foot spends within a tenth of its lift above its lowest point.
double share_on_ground(const TextRun& run, const std::string& height) {
  const std::vector<double> y = run.column(height, kinematic);
  const auto [least, most] = std::minmax_element(y.begin(), y.end());
  const double limit = *least + 0.1 * (*most - *least);
  return static_cast<double>(std::count_if(y.begin(), y.end(), [&](double v) { return v < limit; })) /
         static_cast<double>(y.size());
}

}  // namespace

SceneFacts leg_facts() {
  return {
      {"jansen_leg.json",
       [](const TextRun& run) {
         expect_no_warnings(run);
         expect_column(
             run, "foot.toe.x", "crank.angle", [](double crank) { return jansen_toe(crank).x; }, 1e-13);
         expect_column(
             run, "foot.toe.y", "crank.angle", [](double crank) { return jansen_toe(crank).y; }, 1e-13);
         expect_closed(run, "foot.toe.y");
         EXPECT_GT(share_on_ground(run, "foot.toe.y"), 0.45);
       }},
      {"klann_leg.json",
       [](const TextRun& run) {
         expect_no_warnings(run);
         expect_column(
             run, "leg.foot.x", "crank.angle", [](double crank) { return klann_foot(crank).x; }, 1e-13);
         expect_column(
             run, "leg.foot.y", "crank.angle", [](double crank) { return klann_foot(crank).y; }, 1e-13);
         expect_closed(run, "leg.foot.y");
         EXPECT_GT(share_on_ground(run, "leg.foot.y"), 0.4);
       }},
  };
}

}  // namespace catena::testing
