// Linkages of revolute joints: four-bars, six-bars, straight lines, and a row of a hundred thousand links.
#include "scene/data_facts.hpp"
#include "scene/dyad.hpp"

namespace catena::testing {
namespace {

// The crank-rocker that several scenes share: O2, O4, and pins A and B at a crank angle.
struct CrankRocker {
  Point o2{0, 0}, o4{0.3, 0}, a, b;
  explicit CrankRocker(double crank) : a(polar(0.1, crank)), b(meet(a, 0.25, o4, 0.2, 1)) {}
};

Point watt_pin(double crank) {
  const CrankRocker base(crank);
  const Point c = beside(base.a, base.b, 0.14, 0.13), d = beside(base.o4, base.b, 0.3, -0.05);
  return meet(c, 0.22, d, 0.18, 1);
}

double stephenson_swing(double crank) {
  const CrankRocker base(crank);
  const Point c = beside(base.a, base.b, 0.12, 0.08), o6{-0.2, 0.05};
  return direction(o6, meet(c, 0.3, o6, 0.2, -1));
}

}  // namespace

SceneFacts four_bar_facts() {
  return {
      {"crank_rocker.json",
       [](const TextRun& run) {
         EXPECT_EQ(run.sink.header.gravity[1], -9.81);
         // The crank turns fully: everything is where it began. Instant centres give the ratio of speeds at 0 degrees:
         // crank and base in line, omega_4 = -omega_2 a / (d - a).
         EXPECT_NEAR(run.last("rocker.angle", 1), run.first("rocker.angle", 1), 1e-11);
         EXPECT_NEAR(run.last("coupler.pen.x", 1), run.first("coupler.pen.x", 1), 1e-11);
         EXPECT_NEAR(run.first("rocker.omega", 1), -10 * 0.1 / (0.3 - 0.1), 1e-11);
         // Loop closure: the triangle A, B, O4 with sides 0.25, 0.2, 0.2 m.
         EXPECT_NEAR(run.first("rocker.angle", 1), std::numbers::pi - std::acos((0.04 + 0.04 - 0.0625) / 0.08), 1e-12);
         // Over a cycle without losses the drive does no work.
         const std::vector<double> load = run.column("drive.load", 2);
         double sum = 0;
         for (std::size_t k = 0; k + 1 < load.size(); ++k) sum += load[k];
         EXPECT_NEAR(sum / static_cast<double>(load.size() - 1), 0, 1e-9);
       }},
      {"six_bar.json",
       [](const TextRun& run) {
         EXPECT_EQ(run.analysis(0).report.mobility, 1);
         EXPECT_EQ(run.analysis(0).report.rows, 15);
         EXPECT_NEAR(run.last("swing.angle", 1), run.first("swing.angle", 1), 1e-11);
         const std::vector<double> swing = run.column("swing.angle", 1);
         const auto [least, most] = std::minmax_element(swing.begin(), swing.end());
         EXPECT_NEAR((*most - *least) * 180 / std::numbers::pi, 38, 0.5);
       }},
      {"linkage_100000.json",
       [](const TextRun& run) {
         EXPECT_EQ(run.sink.header.bodies, 100001);
         EXPECT_NEAR(run.last("crank50000.angle"), std::numbers::pi / 2 + 0.5, 1e-12);
         EXPECT_NEAR(run.last("crank50000.omega"), 1, 1e-9);
         EXPECT_NEAR(run.last("bar50000.angle"), 0, 1e-12);
         EXPECT_NEAR(run.last("bar25000.ay"), -std::cos(0.5), 1e-8);
       }},
      {"chebyshev.json",
       [](const TextRun& run) {
         expect_no_warnings(run);
         // From 90 to 270 degrees the pen is at y = 4, the ends and the middle exactly, the rest within 0.01.
         const std::vector<double> y = run.column("coupler.pen.y", kinematic),
                                   x = run.column("coupler.pen.x", kinematic);
         ASSERT_EQ(y.size(), 73u);
         for (std::size_t k : {18u, 36u, 54u}) EXPECT_NEAR(y[k], 4, 1e-12);
         for (std::size_t k = 18; k <= 54; ++k) EXPECT_NEAR(y[k], 4, 0.01);
         EXPECT_NEAR(x[18], 4, 1e-12);
         EXPECT_NEAR(x[54], 0, 1e-12);
         expect_column(
             run, "coupler.pen.x", "crank.angle",
             [](double crank) {
               const Point a = polar(1, crank);
               return beside(a, meet(a, 2.5, {2, 0}, 2.5, 1), 5, 0).x;
             },
             1e-12);
       }},
      {"peaucellier.json",
       [](const TextRun& run) {
         expect_no_warnings(run);
         // OP OQ = arm^2 - side^2 and OP = 2 crank cos(angle/2): the pen stays at (arm^2 - side^2)/(2 crank).
         const double product = 0.5 * 0.5 - 0.2 * 0.2;
         expect_column(
             run, "upper_outer.pen.x", "crank.angle", [&](double) { return product / 0.4; }, 1e-12);
         expect_column(
             run, "upper_outer.pen.y", "crank.angle", [&](double crank) { return product / 0.4 * std::tan(crank / 2); },
             1e-12);
       }},
      {"watt_six_bar.json",
       [](const TextRun& run) {
         expect_no_warnings(run);
         expect_column(
             run, "link.end.x", "crank.angle", [](double crank) { return watt_pin(crank).x; }, 1e-12);
         expect_column(
             run, "link.end.y", "crank.angle", [](double crank) { return watt_pin(crank).y; }, 1e-12);
         expect_closed(run, "swing.angle");
       }},
      {"stephenson_six_bar.json",
       [](const TextRun& run) {
         expect_no_warnings(run);
         expect_column(run, "swing.angle", "crank.angle", stephenson_swing, 1e-12);
         EXPECT_NEAR(degrees(range(run, "swing.angle")), 44.2, 0.1);
       }},
  };
}

}  // namespace catena::testing
