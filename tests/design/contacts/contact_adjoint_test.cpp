// Gradients of motions with contacts, friction and events by the adjoint, against closed forms whose derivatives are
// formed by complex steps.
#include <gtest/gtest.h>

#include <complex>
#include <functional>

#include "design/measured.hpp"
#include "oracles/scene_text.hpp"

namespace catena::testing {
namespace {

using Complex = std::complex<double>;
using Formula = std::function<Complex(const std::vector<Complex>&)>;

// Derivatives of a motion are to be right to ten times its tolerance, by their own size or 1; of these motions they,
// and values, are to 1.7e-12 (bounces) and better.
constexpr double run_tolerance = 1e-12, allowed = 10 * run_tolerance;

/// A scene whose parameters are named by letters, and what its measures are.
struct Case {
  std::vector<std::pair<char, double>> parameters;
  std::string scene, run;  // between the parameters and the analyses; of the analysis
  struct Measure {
    std::string text;
    Formula formula;
  };
  std::vector<Measure> measures;
};

std::string name_of(std::size_t measure) { return "measure" + std::to_string(measure); }

std::string text_of_case(const Case& one) {
  std::string values, names, measures;
  for (const auto& [name, value] : one.parameters) {
    values += (values.empty() ? "\"" : ", \"") + std::string(1, name) + "\": " + text_of(value);
    names += (names.empty() ? "\"" : ", \"") + std::string(1, name) + "\"";
  }
  for (std::size_t m = 0; m < one.measures.size(); ++m)
    measures += (m == 0 ? "\"" : ", \"") + name_of(m) + "\": " + one.measures[m].text;
  return R"({"catena": 1, "parameters": {)" + values + "}, " + one.scene +
         R"(, "outputs": [], "analyses": [{"type": "sensitivity", "mode": "adjoint", "parameters": [)" + names +
         R"(], "of": {"type": "dynamics", "tolerance": )" + text_of(run_tolerance) + ", " + one.run +
         R"(, "measures": {)" + measures + "}}}]}";
}

/// Values and derivatives are those of the formulas, and were found by the adjoint.
void expect_case(const Case& one) {
  const TextRun run = run_text(text_of_case(one));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  EXPECT_TRUE(went_back(run)) << ::testing::PrintToString(run.analysis().report.warnings);
  std::vector<Complex> at;
  for (const auto& parameter : one.parameters) at.emplace_back(parameter.second);
  for (std::size_t m = 0; m < one.measures.size(); ++m) {
    SCOPED_TRACE(one.measures[m].text);
    const Formula& formula = one.measures[m].formula;
    const double expected = formula(at).real();
    EXPECT_NEAR(value(run, name_of(m)), expected, allowed * std::max(1.0, std::abs(expected)));
    for (std::size_t p = 0; p < at.size(); ++p) {
      std::vector<Complex> moved = at;
      moved[p] += Complex(0, 1e-30);
      const double slope = formula(moved).imag() / 1e-30;
      EXPECT_NEAR(gradient(run, name_of(m), p), slope, allowed * std::max(1.0, std::abs(slope)))
          << one.parameters[p].first;
    }
  }
}

const std::string floor_at_f = R"("curve": {"line": {"point": [0, "=f"], "axis": [1, 0]}})";

std::string ball_above(const std::string& floor) {
  return R"("gravity": [0, "=-g"],
    "bodies": {"ball": {"mass": "=m", "inertia": 0.01, "position": [0, "=h"], "velocity": ["=u", 0]}},
    "forces": [{"name": "floor", "type": "contact", "i": "ground", "j": "ball", )" +
         floor + ", " + floor_at_f + "}]";
}

// h - f = g t1^2 / 2, then up with e times the speed, twice.
TEST(ContactAdjoint, OfABallThatBounces) {
  Case one{{{'g', 9.81}, {'h', 0.6}, {'f', 0.1}, {'e', 0.7}, {'u', 0.5}, {'m', 2}},
           ball_above(R"("restitution": "=e")"),
           R"("until": 1)",
           {}};
  struct Flight {
    Complex first, second, speed;  // instants of impacts; upwards after the first one
    explicit Flight(const std::vector<Complex>& p) {
      first = std::sqrt(2.0 * (p[1] - p[2]) / p[0]);
      speed = p[3] * p[0] * first;
      second = first + 2.0 * speed / p[0];
    }
  };
  const auto height = [](const std::vector<Complex>& p, double t) {
    const Flight flight(p);
    const Complex since = t - flight.second;
    return p[2] + p[3] * flight.speed * since - p[0] * since * since / 2.0;
  };
  one.measures = {
      {R"({"final": "ball.y"})", [=](const auto& p) { return height(p, 1); }},
      {R"({"final": "ball.x"})", [](const auto& p) { return p[4]; }},
      {R"({"at": 0.9, "of": "ball.y"})", [=](const auto& p) { return height(p, 0.9); }},
      {R"({"integral": "ball.vy"})", [=](const auto& p) { return height(p, 1) - p[1]; }},
      {R"({"min": "ball.vy"})", [](const auto& p) { return -p[0] * Flight(p).first; }},
  };
  expect_case(one);
}

// y'' = -k y / m - g on the floor until y = 0 again: for (2 / w) (pi - atan(v w / g)), w^2 = k / m.
TEST(ContactAdjoint, OfABallOnASpring) {
  Case one{{{'g', 9.81}, {'h', 0.6}, {'f', 0.1}, {'k', 800}, {'u', 0.5}, {'m', 2}},
           ball_above(R"("k": "=k")"),
           R"("until": 0.7)",
           {}};
  const auto depth = [](const std::vector<Complex>& p) {  // at t = 0.36
    const Complex fall = std::sqrt(2.0 * (p[1] - p[2]) / p[0]), v = p[0] * fall, w = std::sqrt(p[3] / p[5]);
    const Complex rest = -p[0] / (w * w), s = 0.36 - fall;
    return rest * (1.0 - std::cos(w * s)) - v / w * std::sin(w * s);
  };
  one.measures = {
      {R"({"final": "ball.y"})",
       [](const auto& p) {
         const Complex fall = std::sqrt(2.0 * (p[1] - p[2]) / p[0]), v = p[0] * fall, w = std::sqrt(p[3] / p[5]);
         const Complex since = 0.7 - fall - 2.0 / w * (std::acos(-1.0) - std::atan(v * w / p[0]));
         return p[2] + v * since - p[0] * since * since / 2.0;
       }},
      {R"({"at": 0.36, "of": "ball.y"})", [=](const auto& p) { return p[2] + depth(p); }},
      {R"({"at": 0.36, "of": "floor.force"})", [=](const auto& p) { return -p[3] * depth(p); }},
  };
  expect_case(one);
}

// v^2 / (2 mu g), where it stays.
TEST(ContactAdjoint, OfABlockThatSlidesToRest) {
  Case one{{{'g', 9.81}, {'v', 1.2}, {'c', 0.3}, {'m', 2}, {'x', 0.4}},
           R"("gravity": [0, "=-g"], "bodies": {"block": {"mass": "=m", "particle": true, "position": ["=x", 0],
              "velocity": ["=v", 0]}}, "forces": [{"name": "floor", "type": "contact", "i": "ground", "j": "block",
              "mu": "=c", "curve": {"line": {"point": [0, 0], "axis": [1, 0]}}}])",
           R"("until": 1)",
           {}};
  one.measures = {
      {R"({"final": "block.x"})", [](const auto& p) { return p[4] + p[1] * p[1] / (2.0 * p[2] * p[0]); }},
      {R"({"at": 0.2, "of": "block.x"})", [](const auto& p) { return p[4] + 0.2 * p[1] - 0.02 * p[2] * p[0]; }},
      {R"({"at": 0.2, "of": "floor.friction"})", [](const auto& p) { return -p[3] * p[2] * p[0]; }},
      {R"({"at": 0.2, "of": "floor.force"})", [](const auto& p) { return p[3] * p[0]; }},
      {R"({"integral": "block.x"})",
       [](const auto& p) {
         const Complex t = p[1] / (p[2] * p[0]);
         return p[4] + p[1] * t * t / 3.0 + (1.0 - t) * p[1] * t / 2.0;
       }},
  };
  expect_case(one);
}

// A point that slides while it hits loses mu (1 + e) of the speed at which it comes.
TEST(ContactAdjoint, OfAnImpactThatRubs) {
  Case one{{{'g', 9.81}, {'h', 0.5}, {'e', 0.6}, {'c', 0.1}, {'u', 2}, {'m', 2}},
           R"("gravity": [0, "=-g"], "bodies": {"p": {"mass": "=m", "particle": true, "position": [0, "=h"],
              "velocity": ["=u", 0]}}, "forces": [{"name": "floor", "type": "contact", "i": "ground", "j": "p",
              "mu": "=c", "restitution": "=e", "curve": {"line": {"point": [0, 0], "axis": [1, 0]}}}])",
           R"("until": 0.6)",
           {}};
  one.measures = {{R"({"final": "p.x"})", [](const auto& p) {
                     const Complex fall = std::sqrt(2.0 * p[1] / p[0]);
                     return 0.6 * p[4] - p[3] * (1.0 + p[2]) * p[0] * fall * (0.6 - fall);
                   }}};
  expect_case(one);
}

// A flywheel on its pin: mu m g r of torque until it stops.
TEST(ContactAdjoint, OfAFlywheelThatRunsDown) {
  Case one{{{'g', 9.81}, {'w', 6}, {'c', 0.2}, {'r', 0.05}, {'m', 3}, {'i', 0.04}},
           R"("gravity": [0, "=-g"], "bodies": {"wheel": {"mass": "=m", "inertia": "=i", "angular_velocity": "=w"}},
              "constraints": [{"type": "revolute", "name": "pin", "i": "ground", "j": "wheel"}],
              "forces": [{"type": "friction", "name": "rub", "joint": "pin", "mu": "=c", "radius": "=r"}])",
           R"("until": 1.5)",
           {}};
  const auto slowing = [](const std::vector<Complex>& p) { return p[2] * p[4] * p[0] * p[3] / p[5]; };
  one.measures = {
      {R"({"final": "wheel.angle"})", [=](const auto& p) { return p[1] * p[1] / (2.0 * slowing(p)); }},
      {R"({"at": 0.3, "of": "wheel.omega"})", [=](const auto& p) { return p[1] - 0.3 * slowing(p); }},
  };
  expect_case(one);
}

// A carriage between two bounds, rigid or on springs (half a swing each time).
TEST(ContactAdjoint, OfACarriageBetweenBounds) {
  const std::string scene = R"("bodies": {"a": {"mass": "=m", "particle": true, "velocity": ["=v", 0]}},
      "constraints": [{"type": "absolute_y", "i": "a", "value": 0}],
      "forces": [{"type": "stop", "name": "bed", "column": "a.x", "min": "=-b", "max": "=d", )";
  Case rigid{{{'v', 2}, {'b', 0.3}, {'d', 0.5}, {'e', 0.7}, {'m', 1.5}},
             scene + R"("restitution": "=e"}])",
             R"("until": 1)",
             {}};
  rigid.measures = {{R"({"final": "a.x"})", [](const auto& p) {
                       const Complex second = p[2] / p[0] + (p[1] + p[2]) / (p[3] * p[0]);
                       return -p[1] + p[3] * p[3] * p[0] * (1.0 - second);
                     }}};
  expect_case(rigid);
  Case sprung{
      {{'v', 2}, {'b', 0.3}, {'d', 0.5}, {'k', 900}, {'m', 1.5}}, scene + R"("k": "=k"}])", R"("until": 1.1)", {}};
  sprung.measures = {{R"({"final": "a.x"})", [](const auto& p) {
                        const Complex swing = std::acos(-1.0) * std::sqrt(p[4] / p[3]);
                        const Complex second = p[2] / p[0] + swing + (p[1] + p[2]) / p[0];
                        return -p[1] + p[0] * (1.1 - second - swing);
                      }}};
  expect_case(sprung);
}

// A weight on a rail is let go where it has come so far, and flies.
TEST(ContactAdjoint, OfAWeightThatIsLetGo) {
  Case one{{{'g', 9.81}, {'d', 0.24}, {'v', 0.8}, {'m', 2}},
           R"("gravity": [0, "=-g"], "bodies": {"a": {"mass": "=m", "particle": true, "velocity": ["=v", 0]}},
              "constraints": [{"type": "absolute_y", "name": "rail", "i": "a", "value": 0}])",
           R"("until": 1, "events": [{"when": "a.x", "value": "=d", "action": "release", "element": "rail"}])",
           {}};
  one.measures = {
      {R"({"final": "a.y"})", [](const auto& p) { return -p[0] * (1.0 - p[1] / p[2]) * (1.0 - p[1] / p[2]) / 2.0; }},
      {R"({"integral": "=a.vy^2"})", [](const auto& p) { return p[0] * p[0] * std::pow(1.0 - p[1] / p[2], 3) / 3.0; }},
  };
  expect_case(one);
}

// What the way back does not lead through is carried forward, and a word says why.
TEST(ContactAdjoint, GoesForwardWhereContactsCloseAtOnce) {
  const auto floor = [](const std::string& end) {
    return R"({"type": "contact", "name": ")" + end + R"(", "i": "ground", "j": "plank.)" + end +
           R"(", "restitution": 0.5, "curve": {"line": {"point": [0, 0], "axis": [1, 0]}}})";
  };
  Case one{{{'g', 9.81}, {'h', 0.5}},
           R"("gravity": [0, "=-g"], "bodies": {"plank": {"mass": 2, "rod": {"from": [-0.5, "=h"], "to": [0.5, "=h"]}}},
              "forces": [)" +
               floor("from") + ", " + floor("to") + "]",
           R"("until": 0.5)",
           {{R"({"final": "plank.y"})", {}}}};
  const TextRun run = run_text(text_of_case(one));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  EXPECT_FALSE(went_back(run));
  EXPECT_TRUE(warns(run, "several contacts close at once"));
  const double fall = std::sqrt(2 * 0.5 / 9.81), since = 0.5 - fall;
  // y = e g t1 s - g s^2 / 2, s = t - t1, t1_h = 1 / (g t1).
  const double by_fall = 0.5 * 9.81 * (since - fall) + 9.81 * since;
  EXPECT_NEAR(gradient(run, name_of(0), 1), by_fall / (9.81 * fall), allowed);
}

}  // namespace
}  // namespace catena::testing
