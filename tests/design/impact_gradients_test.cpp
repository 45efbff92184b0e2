// Gradients of motions with contacts, impacts, friction and events against closed forms, whose derivatives are formed
// by complex steps; and what has none.
#include <gtest/gtest.h>

#include <array>
#include <complex>
#include <functional>

#include "design/measured.hpp"
#include "oracles/scene_text.hpp"

namespace catena::testing {
namespace {

using Complex = std::complex<double>;
using Formula = std::function<Complex(const std::vector<Complex>&)>;

/// df/dp of a formula that is analytic in its parameters.
double slope(const Formula& f, const std::vector<double>& at, std::size_t p) {
  std::vector<Complex> x(at.begin(), at.end());
  x[p] += Complex(0, 1e-30);
  return f(x).imag() / 1e-30;
}

/// Values of a measure and of all its derivatives.
void expect_measure(const TextRun& run, const std::string& name, const Formula& f, const std::vector<double>& at,
                    double tolerance) {
  SCOPED_TRACE(name);
  const std::vector<Complex> x(at.begin(), at.end());
  const double expected = f(x).real();
  EXPECT_NEAR(value(run, name), expected, tolerance * std::max(1.0, std::abs(expected)));
  for (std::size_t p = 0; p < at.size(); ++p) {
    const double d = slope(f, at, p);
    EXPECT_NEAR(gradient(run, name, p), d, tolerance * std::max(1.0, std::abs(d))) << "parameter " << p;
  }
}

std::string sensitivity(const std::string& parameters, const std::string& run, const std::string& measures) {
  return R"({"type": "sensitivity", "parameters": [)" + parameters + R"(], "of": {"type": "dynamics", )" + run +
         R"(, "tolerance": 1e-12, "measures": {)" + measures + "}}}";
}

/// A ball of radius r that falls from h with velocity u along a floor at height f.
std::string ball(const std::string& floor, const std::string& analysis, const std::string& more = "") {
  return R"({"catena": 1, "gravity": [0, "=-g"],
  "parameters": {"g": 9.81, "h": 0.6, "e": 0.7, "f": 0.1, "u": 0.5)" +
         more + R"(},
  "bodies": {"ball": {"mass": 2, "inertia": 0.01, "position": [0, "=h"], "velocity": ["=u", 0]}},
  "forces": [{"name": "floor", "type": "contact", "i": "ground", "j": "ball",
              "curve": {"line": {"point": [0, "=f"], "axis": [1, 0]}}, )" +
         floor + R"(}], "outputs": ["ball.y", "ball.vy"], "analyses": [)" + analysis + "]}";
}

/// Of that ball, after n impacts: the instant of number n, and height and speed at t after it.
struct Flight {
  Complex began, speed;
  Flight(const std::vector<Complex>& p, int n) {
    const Complex fall = std::sqrt(2.0 * (p[1] - p[3]) / p[0]);
    began = fall;
    speed = p[2] * p[0] * fall;
    for (int k = 1; k < n; ++k) {
      began += 2.0 * speed / p[0];
      speed *= p[2];
    }
  }
  Complex height(const std::vector<Complex>& p, double t) const {
    const Complex since = t - began;
    return p[3] + speed * since - p[0] * since * since / 2.0;
  }
};

TEST(ImpactGradients, OfABallThatBounces) {
  const std::vector<double> at = {9.81, 0.6, 0.7, 0.1, 0.5};
  const TextRun run = run_text(
      ball(R"("restitution": "=e")",
           sensitivity(R"("g", "h", "e", "f", "u")", R"("until": 1.25, "every": 0.1)",
                       R"("end": {"final": "ball.y"}, "way": {"final": "ball.x"}, "speed": {"final": "ball.vy"},
        "then": {"at": 0.6, "of": "ball.y"}, "area": {"integral": "ball.vy"}, "swing": {"integral": "=ball.vy^2"},
        "first": {"field": "events[1].t"}, "third": {"field": "events[3].t"}, "fastest": {"min": "ball.vy"})")));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  const auto after = [](int n, double t) {
    return [=](const std::vector<Complex>& p) { return Flight(p, n).height(p, t); };
  };
  expect_measure(run, "end", after(3, 1.25), at, 1e-9);
  expect_measure(run, "then", after(1, 0.6), at, 1e-9);
  expect_measure(
      run, "way", [](const auto& p) { return 1.25 * p[4]; }, at, 1e-9);
  expect_measure(
      run, "speed",
      [](const auto& p) {
        const Flight flight(p, 3);
        return flight.speed - p[0] * (1.25 - flight.began);
      },
      at, 1e-8);
  expect_measure(
      run, "area", [&](const auto& p) { return after(3, 1.25)(p) - p[1]; }, at, 1e-8);
  expect_measure(
      run, "swing",
      [](const auto& p) {
        const auto third = [&](const Complex& v) { return v * v * v / (3.0 * p[0]); };
        const Flight one(p, 1), two(p, 2), three(p, 3);
        const Complex last = three.speed - p[0] * (1.25 - three.began);
        return third(one.speed / p[2]) + 2.0 * third(one.speed) + 2.0 * third(two.speed) + third(three.speed) -
               third(last);
      },
      at, 1e-7);
  expect_measure(
      run, "first", [](const auto& p) { return Flight(p, 1).began; }, at, 1e-9);
  expect_measure(
      run, "third", [](const auto& p) { return Flight(p, 3).began; }, at, 1e-9);
  expect_measure(
      run, "fastest", [](const auto& p) { return -Flight(p, 1).speed / p[2]; }, at, 1e-7);
}

// Rows are at fixed instants, before and after impacts.
TEST(ImpactGradients, OfRowsBetweenBounces) {
  const std::vector<double> at = {9.81, 0.6, 0.7, 0.1, 0.5};
  const TextRun run = run_text(
      ball(R"("restitution": "=e")", sensitivity(R"("g", "h", "e", "f", "u")", R"("at": [0.2, 0.5, 1.0, 1.2])", "")));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  const double instants[] = {0.2, 0.5, 1.0, 1.2};
  const int bounces[] = {0, 1, 2, 3};
  const char* names[] = {"g", "h", "e", "f", "u"};
  for (std::size_t r = 0; r < 4; ++r) {
    const Formula height = [&](const std::vector<Complex>& p) {
      if (bounces[r] > 0) return Flight(p, bounces[r]).height(p, instants[r]);
      return p[1] - p[0] * instants[r] * instants[r] / 2.0;
    };
    for (std::size_t p = 0; p < 5; ++p) {
      const double d = slope(height, at, p);
      EXPECT_NEAR(run.column(std::string("d(ball.y)/d(") + names[p] + ")").at(r), d, 1e-9 * std::max(1.0, std::abs(d)))
          << r << names[p];
    }
  }
}

/// m y'' = -k y - c y' - m g from y = 0 with speed -v, until the force would pull; then free flight. Height at t.
Complex height_on_spring(const Complex& g, const Complex& h, const Complex& f, const Complex& k, const Complex& c,
                         double m, double t) {
  const Complex fall = std::sqrt(2.0 * (h - f) / g), v = g * fall, damping = c / (2.0 * m);
  const Complex omega = std::sqrt(k / m - damping * damping), rest = -m * g / k;
  const Complex b = (-v + damping * -rest) / omega;
  const auto y = [&](const Complex& s) {
    return rest + std::exp(-damping * s) * (-rest * std::cos(omega * s) + b * std::sin(omega * s));
  };
  const auto rate = [&](const Complex& s) {
    return std::exp(-damping * s) *
           ((b * omega + damping * rest) * std::cos(omega * s) + (rest * omega - damping * b) * std::sin(omega * s));
  };
  // The force k y + c y' vanishes: Newton from near half a swing.
  const auto force = [&](const Complex& s) { return k * y(s) + c * rate(s); };
  Complex s = 3.0 / omega.real();
  for (int n = 0; n < 50; ++n) {
    const Complex bend = -(k * y(s) + c * rate(s)) / m - g;
    s -= force(s) / (k * rate(s) + c * bend);
  }
  const Complex since = t - fall - s;
  if (since.real() < 0) return f + y(t - fall);
  return f + y(s) + rate(s) * since - g * since * since / 2.0;
}

TEST(ImpactGradients, OfASpringWithADamperThatIsHitAndLeft) {
  for (const double c : {0.0, 12.0}) {
    SCOPED_TRACE(c);
    const std::vector<double> at = {9.81, 0.6, 0.1, 800, c};
    const TextRun run = run_text(ball(R"("k": "=k", "c": "=c")",
                                      sensitivity(R"("g", "h", "f", "k", "c")", R"("until": 0.6, "every": 0.1)",
                                                  R"("on": {"at": 0.36, "of": "ball.y"}, "off": {"final": "ball.y"},
                            "press": {"at": 0.36, "of": "floor.force"}, "deepest": {"min": "ball.y"})"),
                                      R"(, "k": 800, "c": )" + text_of(c)));
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
    const auto height = [](double t) {
      return [t](const std::vector<Complex>& p) { return height_on_spring(p[0], p[1], p[2], p[3], p[4], 2, t); };
    };
    expect_measure(run, "on", height(0.36), at, 1e-8);
    expect_measure(run, "off", height(0.6), at, 1e-8);
  }
}

// v0^2 / (2 mu g) after v0 / (mu g), where it stays.
TEST(ImpactGradients, OfABlockThatSlidesToRest) {
  const std::string scene = R"({"catena": 1, "gravity": [0, "=-g"], "parameters": {"g": 9.81, "v": 1.2, "mu": 0.3},
    "bodies": {"block": {"mass": 2, "particle": true, "velocity": ["=v", 0]}},
    "forces": [{"name": "floor", "type": "contact", "i": "ground", "j": "block", "mu": "=mu",
                "curve": {"line": {"point": [0, 0], "axis": [1, 0]}}}], "outputs": ["block.x", "floor.friction"],
    "analyses": [)" +
                            sensitivity(R"("g", "v", "mu")", R"("until": 1, "every": 0.1)",
                                        R"("end": {"final": "block.x"}, "mid": {"at": 0.2, "of": "block.x"},
         "rub": {"at": 0.2, "of": "floor.friction"}, "press": {"at": 0.2, "of": "floor.force"},
         "stuck": {"field": "events[1].t"}, "area": {"integral": "block.x"})") +
                            "]}";
  const TextRun run = run_text(scene);
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  const std::vector<double> at = {9.81, 1.2, 0.3};
  expect_measure(
      run, "end", [](const auto& p) { return p[1] * p[1] / (2.0 * p[2] * p[0]); }, at, 1e-9);
  expect_measure(
      run, "mid", [](const auto& p) { return 0.2 * p[1] - 0.02 * p[2] * p[0]; }, at, 1e-9);
  expect_measure(
      run, "rub", [](const auto& p) { return -2.0 * p[2] * p[0]; }, at, 1e-9);
  expect_measure(
      run, "press", [](const auto& p) { return 2.0 * p[0]; }, at, 1e-9);
  expect_measure(
      run, "stuck", [](const auto& p) { return p[1] / (p[2] * p[0]); }, at, 1e-9);
  expect_measure(
      run, "area",
      [](const auto& p) {
        const Complex t = p[1] / (p[2] * p[0]);
        return p[1] * t * t / 3.0 + (1.0 - t) * p[1] * t / 2.0;
      },
      at, 1e-8);
}

// A carriage runs into another one and they go on together: d + m1 v (T - d / v) / (m1 + m2).
TEST(ImpactGradients, OfCarriagesThatCoupleAtAnEvent) {
  const std::string scene =
      R"({"catena": 1, "parameters": {"m": 2, "n": 3, "v": 1.5, "d": 0.6, "j": 0.4},
    "bodies": {"a": {"mass": "=m", "particle": true, "velocity": ["=v", 0]},
               "b": {"mass": "=n", "particle": true, "position": ["=d", 0]}},
    "constraints": [{"type": "absolute_y", "i": "a", "value": 0}, {"type": "absolute_y", "i": "b", "value": 0},
                    {"type": "relative_x", "name": "hook", "i": "a", "j": "b", "value": 0}],
    "outputs": ["a.x", "b.x"], "analyses": [)" +
      sensitivity(
          R"("m", "n", "v", "d", "j")",
          R"("until": 1.2, "every": 0.1, "events": [
        {"name": "meet", "when": "=b.x - a.x", "action": "engage", "element": "hook"},
        {"name": "push", "when": "a.x", "value": "=d + 0.1", "impulse": {"i": "a", "value": ["=j", 0]}}])",
          R"("end": {"final": "a.x"}, "meeting": {"field": "events[1].t"}, "pushed": {"field": "events[2].t"})") +
      "]}";
  const TextRun run = run_text(scene);
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  const std::vector<double> at = {2, 3, 1.5, 0.6, 0.4};
  const auto speed = [](const auto& p) { return p[0] * p[2] / (p[0] + p[1]); };
  const auto pushed = [=](const auto& p) { return p[3] / p[2] + 0.1 / speed(p); };
  expect_measure(
      run, "end", [=](const auto& p) { return p[3] + 0.1 + (speed(p) + p[4] / (p[0] + p[1])) * (1.2 - pushed(p)); }, at,
      1e-9);
  expect_measure(
      run, "meeting", [](const auto& p) { return p[3] / p[2]; }, at, 1e-9);
  expect_measure(run, "pushed", pushed, at, 1e-9);
}

// A weight that hangs is let go when time has come, or at an angle, and flies.
TEST(ImpactGradients, OfAWeightThatIsLetGo) {
  const std::string scene = R"({"catena": 1, "gravity": [0, "=-g"], "parameters": {"g": 9.81, "T": 0.3, "v": 0.8},
    "bodies": {"a": {"mass": 2, "particle": true, "velocity": ["=v", 0]}},
    "constraints": [{"type": "absolute_y", "name": "rail", "i": "a", "value": 0}],
    "outputs": ["a.y"], "analyses": [)" +
                            sensitivity(R"("g", "T", "v")",
                                        R"("until": 1, "every": 0.1, "events": [
        {"name": "let go", "when": "a.x", "value": "=v*T", "action": "release", "element": "rail"}])",
                                        R"("end": {"final": "a.y"}, "area": {"integral": "=a.vy^2"})") +
                            "]}";
  const TextRun run = run_text(scene);
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  const std::vector<double> at = {9.81, 0.3, 0.8};
  expect_measure(
      run, "end", [](const auto& p) { return -p[0] * (1.0 - p[1]) * (1.0 - p[1]) / 2.0; }, at, 1e-9);
  expect_measure(
      run, "area", [](const auto& p) { return p[0] * p[0] * std::pow(1.0 - p[1], 3) / 3.0; }, at, 1e-8);
}

/// phi'' = -w2 sin(phi) from phi0 at rest until t, by Runge and Kutta's method, thrown back at phi = stop by the part
/// e. All numbers are complex, steps and instants too: what follows from them has exact derivatives.
Complex angle_of_pendulum(const Complex& w2, const Complex& start, const Complex& stop, const Complex& e, double t) {
  using State = std::array<Complex, 2>;
  const auto slope_at = [&](const State& y) { return State{y[1], -w2 * std::sin(y[0])}; };
  const auto moved = [](const State& y, const State& k, const Complex& h) {
    return State{y[0] + h * k[0], y[1] + h * k[1]};
  };
  const auto step = [&](const State& y, const Complex& h) {
    const State a = slope_at(y), b = slope_at(moved(y, a, h / 2.0)), c = slope_at(moved(y, b, h / 2.0)),
                d = slope_at(moved(y, c, h));
    State sum = y;
    for (std::size_t k = 0; k < 2; ++k) sum[k] += h / 6.0 * (a[k] + 2.0 * b[k] + 2.0 * c[k] + d[k]);
    return sum;
  };
  State y{start, 0};
  Complex now = 0;
  const double h = 2e-4;
  while (now.real() < t) {
    const Complex length = now.real() + h < t ? Complex(h) : t - now;
    const State next = step(y, length);
    if (next[0].real() > stop.real()) {
      y = next;
      now += length;
      continue;
    }
    Complex part = length / 2.0;
    for (int n = 0; n < 30; ++n) {
      const State there = step(y, part);
      part -= (there[0] - stop) / there[1];
    }
    y = step(y, part);
    y[1] *= -e;
    now += part;
  }
  return y[0];
}

// A rod falls from the right and comes back from a stop on the left, twice.
TEST(ImpactGradients, OfAPendulumThatHitsAStop) {
  const std::string scene =
      R"--({"catena": 1, "gravity": [0, "=-g"], "parameters": {"g": 9.81, "l": 0.8, "a": 0.9, "s": -0.2,
    "e": 0.6}, "bodies": {"rod": {"mass": 2, "rod": {"from": [0, 0], "to": ["=l*sin(a)", "=-l*cos(a)"]}}},
    "constraints": [{"type": "revolute", "name": "pin", "i": ["ground", [0, 0]], "j": "rod.from"}],
    "forces": [{"type": "stop", "name": "bed", "column": "pin.angle", "min": "=s - pi/2", "restitution": "=e"}],
    "outputs": ["rod.angle"], "analyses": [)--" +
      sensitivity(R"("g", "l", "a", "s", "e")", R"("until": 2, "every": 0.1)",
                  R"("end": {"final": "pin.angle"}, "then": {"at": 1, "of": "pin.angle"})") +
      "]}";
  const TextRun run = run_text(scene);
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  const std::vector<double> at = {9.81, 0.8, 0.9, -0.2, 0.6};
  const auto angle = [](double t) {
    return [t](const std::vector<Complex>& p) {
      return angle_of_pendulum(1.5 * p[0] / p[1], p[2], p[3], p[4], t) - std::acos(-1.0) / 2;
    };
  };
  expect_measure(run, "then", angle(1), at, 1e-8);
  expect_measure(run, "end", angle(2), at, 1e-8);
}

// Both ends of a plank reach the floor at once: higher or lower they still do, turned they do not.
TEST(ImpactGradients, OfPlacesThatCloseAtOnce) {
  const auto floor = [](const std::string& end) {
    return R"({"type": "contact", "name": ")" + end + R"(", "i": "ground", "j": "plank.)" + end +
           R"(", "restitution": 0.5, "curve": {"line": {"point": [0, 0], "axis": [1, 0]}}})";
  };
  const TextRun run = run_text(
      R"--({"catena": 1, "gravity": [0, -9.81], "parameters": {"h": 0.3, "a": 0}, "bodies": {"plank": {"mass": 2,
      "rod": {"from": ["=-0.4*cos(a)", "=h - 0.4*sin(a)"], "to": ["=0.4*cos(a)", "=h + 0.4*sin(a)"]}}}, "forces": [)--" +
      floor("from") + ", " + floor("to") + R"(], "outputs": ["plank.y"], "analyses": [)" +
      sensitivity(R"("h", "a")", R"("until": 0.4, "every": 0.1)", R"("end": {"final": "plank.from.y"})") + "]}");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  const double t = std::sqrt(2 * 0.3 / 9.81), by_h = 1 / (9.81 * t), v = 0.5 * 9.81 * t;
  // y = v (T - t) - g (T - t)^2 / 2
  EXPECT_NEAR(gradient(run, "end", 0), 0.5 * 9.81 * by_h * (0.4 - t) - v * by_h + 9.81 * (0.4 - t) * by_h, 1e-9);
  EXPECT_TRUE(std::isnan(gradient(run, "end", 1)));
  EXPECT_TRUE(warns(run, "close at once"));
}

TEST(ImpactGradients, ThatDoNotExistAreNull) {
  // The row at which a weight is let go.
  const TextRun row = run_text(
      R"({"catena": 1, "gravity": [0, -9.81], "parameters": {"T": 0.5, "m": 2}, "bodies": {"a": {"mass": "=m",
      "particle": true}}, "constraints": [{"type": "absolute_y", "name": "rail", "i": "a", "value": 0}],
      "outputs": ["a.vy"], "analyses": [)" +
      sensitivity(R"("T", "m")",
                  R"("until": 1, "every": 0.25, "events": [{"name": "let go", "when": "t", "value": "=T",
      "action": "release", "element": "rail"}])",
                  "") +
      "]}");
  ASSERT_EQ(row.outcome.exit_code, 0) << row.outcome.error_text;
  const std::vector<double> by_T = row.column("d(a.vy)/d(T)"), by_m = row.column("d(a.vy)/d(m)");
  ASSERT_EQ(by_T.size(), 5U);
  EXPECT_TRUE(std::isnan(by_T[2]));
  EXPECT_NEAR(by_T[3], 9.81, 1e-9);
  EXPECT_NEAR(by_m[2], 0, 1e-9);
  EXPECT_TRUE(warns(row, "the row at it has no derivatives"));
  // Opened or not at the start.
  const TextRun rests = run_text(
      R"({"catena": 1, "gravity": [0, -9.81], "parameters": {"h": 0}, "bodies": {"b": {"mass": 1, "particle": true,
      "position": [0, "=h"]}}, "forces": [{"type": "contact", "name": "floor", "i": "ground", "j": "b",
      "curve": {"line": {"point": [0, 0], "axis": [1, 0]}}}], "outputs": ["b.y"], "analyses": [)" +
      sensitivity(R"("h")", R"("until": 0.2, "every": 0.1)", R"("end": {"final": "b.y"})") + "]}");
  ASSERT_EQ(rests.outcome.exit_code, 0) << rests.outcome.error_text;
  EXPECT_TRUE(std::isnan(gradient(rests, "end", 0)));
  EXPECT_TRUE(warns(rests, "begins to hold"));
  // A rebound that begins with any restitution.
  const TextRun stays = run_text(
      ball(R"("restitution": "=q")",
           sensitivity(R"("q")", R"("until": 0.6, "every": 0.1)", R"("end": {"final": "ball.y"})"), R"(, "q": 0)"));
  ASSERT_EQ(stays.outcome.exit_code, 0) << stays.outcome.error_text;
  EXPECT_TRUE(std::isnan(gradient(stays, "end", 0)));
  EXPECT_TRUE(warns(stays, "restitution of \"floor\" is 0"));
}

}  // namespace
}  // namespace catena::testing
