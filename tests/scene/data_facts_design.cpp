// Facts about scenes that look for designs, or for derivatives.
#include <algorithm>
#include <array>
#include <cmath>

#include "scene/data_facts.hpp"

namespace catena::testing {
namespace {

double number_of(const FieldRecord& record, const std::string& name) {
  for (const auto& [key, value] : record) {
    if (key == name) return std::get<double>(value);
  }
  return std::nan("");
}

const FieldValue& field_of(const AnalysisResult& result, const std::string& name) {
  static const FieldValue missing = 0.0;
  for (const NamedField& field : result.fields) {
    if (field.name == name) return field.value;
  }
  ADD_FAILURE() << "no field " << name;
  return missing;
}

double variable(const TextRun& run, const std::string& name) {
  return number_of(std::get<FieldRecord>(field_of(run.analysis(), "variables")), name);
}

/// The four-bar that drew the points and the poses of the three generations.
void expect_the_drawn_four_bar(const TextRun& run, double within = 1e-5) {
  EXPECT_NEAR(variable(run, "crank"), 0.4, within);
  EXPECT_NEAR(variable(run, "coupler"), 1.1, within);
  EXPECT_NEAR(variable(run, "rocker"), 0.9, within);
  EXPECT_NEAR(variable(run, "ground"), 1.2, within);
}

const MeasureResult& measure_of(const AnalysisResult& result, const std::string& name) {
  for (const MeasureResult& measure : result.measures) {
    if (measure.name == name) return measure;
  }
  static const MeasureResult missing;
  ADD_FAILURE() << "no measure " << name;
  return missing;
}

/// d(angle)/d(side) of a triangle with the sides x, y beside the angle and z opposite to it.
double by_opposite(double x, double y, double z) {
  const double cosine = (x * x + y * y - z * z) / (2 * x * y);
  return z / (x * y * std::sqrt(1 - cosine * cosine));
}

/// Mean, mean square deviation and largest deviation of the pen's height on a four-bar with crank 1, ground 2 and equal
/// arms, over the half turn in which the crank points away from the rocker. The rocker's pin is the middle of the
/// coupler, as far from its ends as from the rocker's pivot: the pen is seen from there at right angles to the crank's
/// end.
std::array<double, 3> height_and_spread(double arm) {
  constexpr int parts = 2000;
  double sum = 0, squares = 0, low = HUGE_VAL, high = 0;
  for (int k = 0; k <= parts; ++k) {
    const double cosine = std::sin(std::numbers::pi * k / parts), distance2 = 5 + 4 * cosine;
    const double y = std::sqrt((4 * arm * arm - distance2) / distance2) * (2 + cosine);
    const double weight = k % parts == 0 ? 1.0 / 3 : k % 2 == 0 ? 2.0 / 3 : 4.0 / 3;  // Simpson
    sum += weight * y / parts;
    squares += weight * y * y / parts;
    low = std::min(low, y);
    high = std::max(high, y);
  }
  return {sum, squares - sum * sum, std::max(high - sum, sum - low)};
}

/// Where a function of one variable is least, to the root of its rounding.
template <class F>
double least(double low, double high, F&& f) {
  while (high - low > 1e-7) {
    const double third = (high - low) / 3;
    if (f(low + third) < f(high - third))
      high -= third;
    else
      low += third;
  }
  return (low + high) / 2;
}

}  // namespace

SceneFacts design_facts() {
  return {
      {"balanced_lamp.json",
       [](const TextRun& run) {
         EXPECT_NEAR(variable(run, "k"), 1.8 * 9.81 * 0.45 / (2 * 0.15 * 0.2), 1e-5);
         EXPECT_NEAR(*measure_of(run.analysis(1), "worst").value, 0, 1e-6);
       }},
      {"two_bar_truss.json",
       [](const TextRun& run) {
         // mass ~ l^(5/2) h^(-1/2), l^2 = w^2 + h^2: least at h = w/2.
         const double height = 0.4;
         EXPECT_NEAR(variable(run, "height"), height, 1e-5);
         // At the optimum the bars are at their buckling load.
         const double l2 = 0.64 + height * height, push = 2500 * std::sqrt(l2) / height;
         const double section = std::sqrt(4 * l2 * push / (std::numbers::pi * 70e9)) * 1e4;
         EXPECT_NEAR(variable(run, "section"), section, 1e-5 * section);
         EXPECT_EQ(std::get<std::vector<std::string>>(field_of(run.analysis(), "active")).size(), 1u);
         EXPECT_LT(std::get<double>(field_of(run.analysis(), "optimality")), 1e-5);
       }},
      {"path_generation.json", [](const TextRun& run) { expect_the_drawn_four_bar(run); }},
      {"untimed_path_generation.json", [](const TextRun& run) { expect_the_drawn_four_bar(run); }},
      {"hoecken_search.json",
       [](const TextRun& run) {
         const double arm = least(2.3, 2.7, [](double a) { return height_and_spread(a)[1]; });
         const auto [height, spread, farthest] = height_and_spread(arm);
         EXPECT_NEAR(variable(run, "arm"), 0.1 * arm, 1e-6);
         EXPECT_NEAR(variable(run, "height"), 0.1 * height, 1e-6);
         EXPECT_NEAR(std::get<double>(field_of(run.analysis(), "objective")), spread, 1e-6 * spread);
         // Hoecken took arms of 2.5 cranks.
         EXPECT_NEAR(arm, 2.5, 0.002);
         const std::vector<double> heights = run.column("coupler.pen.y", 1);
         EXPECT_EQ(heights.size(), 21u);
         for (const double y : heights) EXPECT_NEAR(y, 0.1 * height, 0.1 * farthest + 1e-6);
       }},
      {"rigid_body_generation.json", [](const TextRun& run) { expect_the_drawn_four_bar(run, 1e-6); }},
      {"function_generation.json",
       [](const TextRun& run) {
         // Freudenstein: cos(psi)/a - cos(phi)/c + k = cos(phi - psi) of three pairs, (a^2 - b^2 + c^2 + 1) = 2 a c k.
         const auto rad = [](double angle) { return angle * std::numbers::pi / 180; };
         const double phi[] = {rad(60), rad(90), rad(120)}, psi[] = {rad(67.5), rad(85.8), rad(104.8)};
         double m[2][3];  // less the first pair: without k
         for (int n = 0; n < 2; ++n) {
           m[n][0] = std::cos(psi[n + 1]) - std::cos(psi[0]);
           m[n][1] = -std::cos(phi[n + 1]) + std::cos(phi[0]);
           m[n][2] = std::cos(phi[n + 1] - psi[n + 1]) - std::cos(phi[0] - psi[0]);
         }
         const double determinant = m[0][0] * m[1][1] - m[0][1] * m[1][0];
         const double a = determinant / (m[0][2] * m[1][1] - m[0][1] * m[1][2]),
                      c = determinant / (m[0][0] * m[1][2] - m[0][2] * m[1][0]);
         const double k = std::cos(phi[0] - psi[0]) - std::cos(psi[0]) / a + std::cos(phi[0]) / c;
         EXPECT_NEAR(variable(run, "crank"), a, 1e-6);
         EXPECT_NEAR(variable(run, "rocker"), c, 1e-6);
         EXPECT_NEAR(variable(run, "coupler"), std::sqrt(a * a + c * c + 1 - 2 * a * c * k), 1e-6);
       }},
      {"straight_line_search.json",
       [](const TextRun& run) {
         EXPECT_NEAR(variable(run, "coupler"), 0.3, 1e-6);
         EXPECT_NEAR(variable(run, "beyond"), 0.3, 1e-6);
         const std::vector<double> off = run.column("coupler.pen.x", 1);
         EXPECT_EQ(off.size(), 11u);
         for (const double x : off) EXPECT_NEAR(x, 0, 1e-6);
       }},
      {"spring_balanced_arm.json",
       [](const TextRun& run) {
         // W cos(theta) less the straight line that is nearest to it from 0 to pi/2: its slope is that of the chord.
         const double weight = 3 * 9.81 * 0.5, slope = 2 / std::numbers::pi, touches = std::asin(slope);
         const double off = (std::cos(touches) + slope * touches - 1) / 2;
         EXPECT_NEAR(variable(run, "peak"), weight * off, 1e-6 * weight * off);
         EXPECT_NEAR(variable(run, "rate"), weight * slope, 1e-6 * weight);
         EXPECT_NEAR(variable(run, "rest"), (1 + off) / slope, 1e-6);
       }},
      {"suspension.json",
       [](const TextRun& run) {
         const double omega = 2 * std::numbers::pi * 1.3, rate = 350 * std::pow(0.4 * omega / 0.25, 2);
         EXPECT_NEAR(variable(run, "rate"), rate, 1e-6 * rate);
       }},
      {"four_bar_gradients.json",
       [](const TextRun& run) {
         // The rocker's angle there is pi less that of the triangle (rocker, ground, coupler -+ crank) at its pivot.
         const MeasureResult &nearest = measure_of(run.analysis(), "nearest"),
                             &furthest = measure_of(run.analysis(), "furthest");
         const double folded = by_opposite(0.2, 0.3, 0.15), stretched = by_opposite(0.2, 0.3, 0.35);
         EXPECT_NEAR(nearest.gradient[0], folded, 1e-8 * folded);
         EXPECT_NEAR(nearest.gradient[1], -folded, 1e-8 * folded);
         EXPECT_NEAR(furthest.gradient[0], -stretched, 1e-8 * stretched);
         EXPECT_NEAR(furthest.gradient[1], -stretched, 1e-8 * stretched);
         EXPECT_LT(std::get<double>(field_of(run.analysis(), "deviation")), 1e-5);
       }},
  };
}

}  // namespace catena::testing
