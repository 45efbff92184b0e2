// Thousands of random tables and curves that begin, end or are left within a run; tests/trials has some of each kind.
// What is right are closed forms, and a scalar equation of motion integrated here.
#include <cmath>
#include <numbers>
#include <random>
#include <regex>
#include <sstream>

#include "stress/cases.hpp"
#include "trials/trial.hpp"

namespace catena::testing {
namespace {

constexpr double pi = std::numbers::pi;

std::string text(double value) {
  std::ostringstream out;
  out.precision(17);
  out << value;
  return out.str();
}

double instant_in(const std::string& message) {
  std::smatch found;
  return std::regex_search(message, found, std::regex("t = ([-+0-9.e]+)")) ? std::stod(found[1]) : std::nan("");
}

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double operator()(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
  int pick(int n) { return std::uniform_int_distribution<int>(0, n - 1)(engine_); }

 private:
  std::mt19937 engine_;
};

// A runner at offset + amplitude sin(omega t + phase) on a rail along x from 0 to `length`, of any scale: it leaves the
// rail at the first instant at which it is beyond an end, whatever rows are asked for.
TEST(OutsideTheRunLong, RunnersLeaveRailsWhereTheyEnd) {
  int left = 0, stayed = 0;
  for (unsigned seed = first_case(); seed <= last_case(3000); ++seed) {
    Random random(seed);
    const double length = std::pow(10, random(-6, 6)), amplitude = length * random(0.2, 0.7);
    const double offset = length * random(0.3, 0.7), omega = random(0.5, 8), phase = random(-1, 1);
    const double until = random(0.5, 3), every = until / (1 + random.pick(12));
    const auto x = [&](double t) { return offset + amplitude * std::sin(omega * t + phase); };
    if (!(x(0) > 0.01 * length && x(0) < 0.99 * length)) continue;
    double exit = std::numeric_limits<double>::infinity();
    for (const double end : {0.0, length}) {
      const double sine = (end - offset) / amplitude;
      if (std::abs(sine) >= 1) continue;
      for (const double angle : {std::asin(sine), pi - std::asin(sine)}) {
        for (int k = -1; k < 8; ++k) {
          const double t = (angle + 2 * pi * k - phase) / omega;
          if (t > 0) exit = std::min(exit, t);
        }
      }
    }
    // A runner that only just touches an end is neither case.
    const double top = std::max(offset + amplitude - length, amplitude - offset) / length;
    if (std::abs(top) < 1e-3 || std::abs(exit - until) < 1e-3) continue;
    const TextRun run =
        run_text(R"({"catena": 1, "bodies": {"r": {"position": [)" + text(x(0)) +
                 R"(, 0]}}, "constraints": [{"type": "absolute_angle", "i": "r", "value": 0}, {"type": "point_on_curve",
        "i": "ground", "j": "r", "curve": {"spline": {"points": [[0, 0], [)" +
                 text(length / 3) + ", 0], [" + text(length) + R"(, 0]]}}}], "outputs": ["r.x"], "drivers": [{"type":
        "absolute_x", "i": "r", "value": {"harmonic": {"amplitude": )" +
                 text(amplitude) + ", \"omega\": " + text(omega) + ", \"phase\": " + text(phase) +
                 ", \"offset\": " + text(offset) + R"(}}}], "analyses": [{"type": "kinematics", "until": )" +
                 text(until) + ", \"every\": " + text(every) + "}]}");
    const Report& report = run.analysis().report;
    for (double place : run.column("r.x")) ASSERT_TRUE(place > -1e-8 * length && place < (1 + 1e-8) * length) << seed;
    if (exit < until) {
      ++left;
      EXPECT_EQ(report.status, Status::singular) << seed;
      EXPECT_NEAR(instant_in(report.message), exit, 1e-6) << seed << report.message;
    } else {
      ++stayed;
      EXPECT_TRUE(report.ok()) << seed << report.message;
    }
  }
  EXPECT_GT(left, stress_cases(3000) / 10);
  EXPECT_GT(stayed, stress_cases(3000) / 10);
}

// A mass on a spring whose table is straight swings with sqrt(k/m): it passes the end of the table at a quarter of its
// swing, or goes on along the line.
TEST(OutsideTheRunLong, SpringsPassTheEndsOfTheirTables) {
  for (unsigned seed = first_case(); seed <= last_case(1500); ++seed) {
    Random random(seed);
    const double k = std::pow(10, random(-2, 4)), m = std::pow(10, random(-2, 2)), omega = std::sqrt(k / m);
    const double reach = std::pow(10, random(-3, 1)), swing = reach * random(0.3, 2), speed = swing * omega;
    if (std::abs(swing - reach) < 0.01 * reach) continue;
    const double until = random(0.6, 2) * 2 * pi / omega;
    const bool line = random.pick(3) == 0;
    const std::string method =
        std::vector<std::string>{"auto", "rk8", "rk5", "adams"}[static_cast<std::size_t>(random.pick(4))];
    const TextRun run = run_text(
        R"({"catena": 1, "bodies": {"a": {"mass": )" + text(m) + R"(, "inertia": 1, "position": [)" + text(2 * reach) +
        R"(, 0], "velocity": [)" + text(speed) + R"(, 0]}}, "constraints": [{"type": "absolute_angle", "i": "a"},
        {"type": "absolute_y", "i": "a"}], "forces": [{"type": "spring_damper", "i": "ground", "j": "a", "length": )" +
        text(2 * reach) + R"(, "curve": {"points": [[)" + text(-3 * reach) + ", " + text(-3 * reach * k) + "], [" +
        text(reach) + ", " + text(reach * k) + R"(]], "beyond": ")" + (line ? "line" : "error") +
        R"("}}], "outputs": ["a.x"], "analyses": [{"type": "dynamics", "method": ")" + method + R"(", "until": )" +
        text(until) + ", \"every\": " + text(until / (1 + random.pick(9))) + "}]}");
    ASSERT_FALSE(run.outcome.analyses.empty()) << run.outcome.error_text;
    const Report& report = run.analysis().report;
    if (line || swing < reach) {
      ASSERT_TRUE(report.ok()) << seed << report.message;
      EXPECT_NEAR(run.last("a.x"), 2 * reach + swing * std::sin(omega * until), 1e-6 * swing * (1 + omega * until))
          << seed;
    } else {
      EXPECT_EQ(report.status, Status::singular) << seed;
      EXPECT_NEAR(instant_in(report.message) * omega, std::asin(reach / swing), 1e-5) << seed << report.message;
    }
  }
}

// A pendulum of two or three parallel cranks with a bar, under a torque that is a table from the start of the run to
// its end: the table is given by its values, and evaluated here by the piecewise cubic that its second derivatives
// make.
TEST(OutsideTheRunLong, TablesDriveFromTheFirstInstantToTheLast) {
  for (unsigned seed = first_case(); seed <= last_case(600); ++seed) {
    Random random(seed);
    const double until = random(0.3, 1.5), h = until / 4;
    double f[5], bend[5] = {};
    for (double& value : f) value = random(-8, 8);
    // Natural ends: three equations for the bends between.
    double right[3];
    for (int k = 0; k < 3; ++k) right[k] = 6 * (f[k + 2] - 2 * f[k + 1] + f[k]) / (h * h);
    bend[2] = (right[1] - (right[0] + right[2]) / 4) / (4 - 0.5);
    bend[1] = (right[0] - bend[2]) / 4;
    bend[3] = (right[2] - bend[2]) / 4;
    const auto torque = [&](double t) {
      const int k = std::clamp(static_cast<int>(t / h), 0, 3);
      const double b = t / h - k, a = 1 - b;
      return a * f[k] + b * f[k + 1] + (a * (a * a - 1) * bend[k] + b * (b * b - 1) * bend[k + 1]) * h * h / 6;
    };
    const int cranks = 2 + static_cast<int>(seed % 2);
    const double start = random(0.4, 2.6), inertia = cranks / 3.0 + 1, weight = (cranks / 2.0 + 1) * 9.81;
    const auto acceleration = [&](double t, double angle) { return (torque(t) - weight * std::cos(angle)) / inertia; };
    double angle = start, rate = 0;
    const int steps = 4000;
    const double s = until / steps;
    for (int k = 0; k < steps; ++k) {
      const double t = k * s, k1 = acceleration(t, angle), k2 = acceleration(t + s / 2, angle + s / 2 * rate);
      const double k3 = acceleration(t + s / 2, angle + s / 2 * rate + s * s / 4 * k1);
      const double k4 = acceleration(t + s, angle + s * rate + s * s / 2 * k2);
      angle += s * rate + s * s / 6 * (k1 + k2 + k3);
      rate += s / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    }
    std::string bodies = R"("bar": {"mass": 1, "inertia": 0.1, "position": [)" + text(std::cos(start)) + ", " +
                         text(std::sin(start)) + "]}",
                constraints;
    for (int k = 0; k < cranks; ++k) {
      const std::string name = "\"c" + std::to_string(k) + "\"", place = text(0.7 * k);
      bodies += ", " + name + R"(: {"mass": 1, "rod": {"from": [)" + place + R"(, 0], "to": [)" +
                text(0.7 * k + std::cos(start)) + ", " + text(std::sin(start)) + "]}}";
      constraints += std::string(k ? ", " : "") + R"({"type": "revolute", "i": ["ground", [)" + place +
                     R"(, 0]], "j": "c)" + std::to_string(k) + R"(.from"}, {"type": "revolute", "i": "c)" +
                     std::to_string(k) + R"(.to", "j": ["bar", [)" + place + ", 0]]}";
    }
    std::string times, values;
    for (int k = 0; k < 5; ++k) {
      times += std::string(k ? ", " : "") + text(k == 4 ? until : k * h);
      values += std::string(k ? ", " : "") + text(f[k]);
    }
    const TextRun run =
        run_text(R"({"catena": 1, "gravity": [0, -9.81], "bodies": {)" + bodies + R"(}, "constraints": [)" +
                 constraints + R"(], "forces": [{"type": "torque", "i": "c0", "torque": {"spline": {"t": [)" + times +
                 "], \"value\": [" + values + R"(]}}}], "outputs": ["c0.angle"], "analyses": [{"type":
                                 "dynamics", "tolerance": 1e-9, "until": )" +
                 text(until) + ", \"every\": " + text(until / 3) + "}]}");
    ASSERT_FALSE(run.outcome.analyses.empty()) << run.outcome.error_text;
    const Report& report = run.analysis().report;
    ASSERT_TRUE(report.ok()) << seed << report.message;
    EXPECT_NEAR(run.last("c0.angle"), angle, 1e-6) << seed << " " << cranks;
  }
}

}  // namespace
}  // namespace catena::testing
