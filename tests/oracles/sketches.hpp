// Random linkages whose sketches say nothing of the side on which they close: every link in one line, all of them on
// top of each other, or a straight chain longer than its span. They can be assembled, since lengths are taken so that
// triangles close; what is found is checked by the places of the pins alone.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "scene/run_text.hpp"

namespace catena::testing {

/// A pin between a place on one link and one on another, or on the ground.
struct Pin {
  std::string i, j;               ///< empty: ground
  double xi = 0, yi = 0, sj = 0;  ///< on i (yi: of the ground only) and along j, in units of the sketch
};

class Sketch {
 public:
  enum class Kind { four_bar, slider_crank, six_bar, chain };

  explicit Sketch(unsigned seed) : random_(seed) {
    if (pick(2)) unit_ = std::pow(10.0, uniform(-9, 9));
    far_ = pick(3) == 0;
    if (far_) x_ = uniform(-1, 1) * 1e6 * unit_, y_ = uniform(-1, 1) * 1e6 * unit_;
    kind_ = static_cast<Kind>(pick(4));
    switch (kind_) {
      case Kind::four_bar:
        add_four_bar();
        break;
      case Kind::slider_crank:
        add_slider_crank();
        break;
      case Kind::six_bar:
        add_six_bar();
        break;
      case Kind::chain:
        add_chain();
    }
  }

  Kind kind() const { return kind_; }
  bool driven() const { return !drivers_.empty(); }
  /// The scene with these analyses.
  std::string scene(const std::string& analyses) const {
    std::string columns;
    for (const std::string& name : names_) columns += (columns.empty() ? "\"" : ", \"") + name + "\"";
    return fmt::format(
        R"({{"catena": 1, "gravity": [0, {:.17g}], "bodies": {{{}}}, "constraints": [{}], "drivers": [{}],
      "outputs": [{}], "analyses": [{}]}})",
        -unit_, bodies_, constraints_, drivers_, columns, analyses);
  }
  /// Largest distance between the two places of a pin in the last row of an analysis, in units of the sketch.
  double gap(const TextRun& run, std::size_t analysis) const {
    double largest = 0;
    for (const Pin& pin : pins_) {
      const auto at = [&](const std::string& body, double s) {
        const double angle = run.last(body + ".angle", analysis);
        return std::array{run.last(body + ".x", analysis) + s * unit_ * std::cos(angle),
                          run.last(body + ".y", analysis) + s * unit_ * std::sin(angle)};
      };
      const auto i = pin.i.empty() ? std::array{x_ + pin.xi * unit_, y_ + pin.yi * unit_} : at(pin.i, pin.xi);
      const auto j = at(pin.j, pin.sj);
      const double gap = std::hypot(i[0] - j[0], i[1] - j[1]) / unit_;
      if (!(gap <= largest)) largest = gap;
    }
    return largest;
  }
  /// What gap() may be: rounding, and that of places far from the origin.
  double allowed() const { return far_ ? 4e-9 : 1e-10; }
  double unit() const { return unit_; }

 private:
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  int pick(int count) { return std::uniform_int_distribution<int>(0, count - 1)(random_); }
  double length() { return std::pow(10.0, uniform(-0.5, 0.4)); }

  void add_link(const std::string& name, double length, double x, double y, bool turned) {
    names_.push_back(name);
    bodies_ += fmt::format(
        R"({}"{}": {{"position": [{:.17g}, {:.17g}], "angle": {:.17g}, "mass": 1, "inertia": {:.17g}, "points": {{"b": [{:.17g}, 0]}}}})",
        bodies_.empty() ? "" : ", ", name, x_ + x * unit_, y_ + y * unit_, turned ? std::numbers::pi : 0.0,
        unit_ * unit_ * length * length / 3, length * unit_);
  }
  void add_constraint(const std::string& text) { constraints_ += (constraints_.empty() ? "" : ", ") + text; }
  void pin_to_ground(double x, double y, const std::string& j, double s) {
    pins_.push_back({"", j, x, y, s});
    add_constraint(
        fmt::format(R"({{"type": "revolute", "i": ["ground", [{:.17g}, {:.17g}]], "j": ["{}", [{:.17g}, 0]]}})",
                    x_ + x * unit_, y_ + y * unit_, j, s * unit_));
  }
  void pin(const std::string& i, double si, const std::string& j, double sj) {
    pins_.push_back({i, j, si, 0, sj});
    add_constraint(fmt::format(R"({{"type": "revolute", "i": ["{}", [{:.17g}, 0]], "j": ["{}", [{:.17g}, 0]]}})", i,
                               si * unit_, j, sj * unit_));
  }

  void add_four_bar() {
    double a = 0, b = 0, c = 0, d = 0, angle = 0, e = 0;
    do {
      a = length(), b = length(), c = length(), d = length(), angle = uniform(-3.1, 3.1);
      e = std::hypot(d - a * std::cos(angle), a * std::sin(angle));  // what coupler and rocker have to span
    } while (!(1.02 * std::abs(b - c) < e && e < 0.98 * (b + c)));
    const bool on_top = pick(2);
    add_link("crank", a, 0, 0, pick(3) == 0);
    add_link("coupler", b, on_top ? 0 : a, 0, pick(3) == 0);
    add_link("rocker", c, d, 0, pick(3) == 0);
    pin_to_ground(0, 0, "crank", 0);
    pin("crank", a, "coupler", 0);
    pin("coupler", b, "rocker", c);
    pin_to_ground(d, 0, "rocker", 0);
    if (pick(2)) drivers_ = fmt::format(R"({{"type": "absolute_angle", "i": "crank", "value": {:.17g}}})", angle);
  }
  void add_slider_crank() {
    const double a = length(), b = a * std::pow(10.0, uniform(-0.3, 0.5));
    add_link("crank", a, 0, 0, pick(3) == 0);
    add_link("rod", b, 0, 0, pick(3) == 0);
    pin_to_ground(0, 0, "crank", 0);
    pin("crank", a, "rod", 0);
    add_constraint(fmt::format(R"({{"type": "absolute_y", "i": "rod.b", "value": {:.17g}}})", y_));
    const double stroke = uniform(1.05 * std::abs(a - b) + 0.01 * a, 0.97 * (a + b));
    drivers_ = fmt::format(R"({{"type": "absolute_x", "i": "rod.b", "value": {:.17g}}})", x_ + stroke * unit_);
  }
  // A crank and two dyads, with the lengths that they have in one random position.
  void add_six_bar() {
    const auto place = [&] { return std::array{uniform(-2, 2), uniform(-2, 2)}; };
    const auto apart = [](const auto& p, const auto& q) { return std::hypot(p[0] - q[0], p[1] - q[1]); };
    const std::array<double, 2> o{0, 0};
    const auto A = place(), M = place(), N = place(), G = place(), H = place();
    const double crank = apart(o, A), c1 = apart(A, M), r1 = apart(G, M), c2 = apart(M, N), r2 = apart(H, N);
    add_link("crank", crank, 0, 0, pick(3) == 0);
    add_link("c1", c1, 0, 0, pick(3) == 0);
    add_link("r1", r1, G[0], G[1], pick(3) == 0);
    add_link("c2", c2, 0, 0, pick(3) == 0);
    add_link("r2", r2, H[0], H[1], pick(3) == 0);
    pin_to_ground(0, 0, "crank", 0);
    pin("crank", crank, "c1", 0);
    pin("c1", c1, "r1", r1);
    pin_to_ground(G[0], G[1], "r1", 0);
    pin("r1", r1, "c2", 0);
    pin("c2", c2, "r2", r2);
    pin_to_ground(H[0], H[1], "r2", 0);
  }
  void add_chain() {
    const int count = 2 + pick(60);
    std::vector<double> lengths;
    double all = 0, longest = 0;
    for (int k = 0; k < count; ++k) {
      lengths.push_back(std::pow(10.0, uniform(-0.3, 0.3)));
      all += lengths.back();
      longest = std::max(longest, lengths.back());
    }
    const double span = uniform(std::max(0.05 * all, 1.02 * (2 * longest - all)), 0.98 * all);
    double x = 0;
    for (int k = 0; k < count; ++k) {
      const double l = lengths[static_cast<std::size_t>(k)];
      add_link(fmt::format("l{}", k), l, x, 0, false);
      x += l;
      if (k == 0) pin_to_ground(0, 0, "l0", 0);
      if (k > 0) pin(fmt::format("l{}", k - 1), lengths[static_cast<std::size_t>(k - 1)], fmt::format("l{}", k), 0);
    }
    pin_to_ground(span, 0, fmt::format("l{}", count - 1), lengths.back());
  }

  std::mt19937 random_;
  Kind kind_ = Kind::four_bar;
  bool far_ = false;
  double unit_ = 1, x_ = 0, y_ = 0;
  std::vector<std::string> names_;
  std::string bodies_, constraints_, drivers_;
  std::vector<Pin> pins_;
};

/// Slider-cranks in a line through the crank's pin, driven by the piston: into a dead centre, or from one.
class DeadCentre {
 public:
  enum class Case { start, from_rest, on_the_way };

  explicit DeadCentre(unsigned seed) : random_(seed) {
    const auto uniform = [&](double low, double high) {
      return std::uniform_real_distribution<double>(low, high)(random_);
    };
    const auto pick = [&](int count) { return std::uniform_int_distribution<int>(0, count - 1)(random_); };
    const double unit = pick(2) ? std::pow(10.0, uniform(-9, 9)) : 1;
    kind = static_cast<Case>(pick(3));
    outer = pick(2);
    time = std::pow(10.0, uniform(-2, 2));
    line = pick(2) ? uniform(-3, 3) : 0;
    a = unit * std::pow(10.0, uniform(-0.5, 0.3));
    b = a * std::pow(10.0, uniform(0.05, 0.8));
    dead = line + (outer ? 0 : std::numbers::pi);
    const double end = outer ? a + b : b - a;
    speed = (pick(2) ? 0.1 : -0.1) * a / time;
    double angle = dead;
    start = end;
    if (kind == Case::on_the_way) {
      angle += (pick(2) ? 1 : -1) * uniform(0.1, 0.8);
      start = piston(angle);
      speed = std::copysign(speed, end - start);
      lock = (end - start) / speed;
      until = lock * uniform(1.05, 2);
    } else {
      until = 0.5 * time;
    }
    const double rod =
        std::atan2(start * std::sin(line) - a * std::sin(angle), start * std::cos(line) - a * std::cos(angle));
    const double law[2] = {kind == Case::from_rest ? 0 : speed, kind == Case::from_rest ? speed / time : 0};
    every = until / (3 + pick(30));
    const double c = std::cos(line), s = std::sin(line);
    scene_ = fmt::format(R"({{"catena": 1, "bodies": {{
      "crank": {{"mass": 1, "inertia": {:.17g}, "angle": {:.17g}, "points": {{"b": [{:.17g}, 0]}}}},
      "rod": {{"mass": 1, "inertia": {:.17g}, "position": [{:.17g}, {:.17g}], "angle": {:.17g}, "points": {{"b": [{:.17g}, 0]}}}},
      "piston": {{"mass": 1, "inertia": {:.17g}, "position": [{:.17g}, {:.17g}], "angle": {:.17g}}}}},
      "constraints": [{{"type": "revolute", "i": "ground", "j": "crank"}}, {{"type": "revolute", "i": "crank.b", "j": "rod"}},
        {{"type": "revolute", "i": "rod.b", "j": "piston"}}, {{"type": "absolute_angle", "i": "piston", "value": {:.17g}}},
        {{"type": "slot", "i": "ground", "j": "piston", "axis_i": [{:.17g}, {:.17g}]}}],
      "drivers": [{{"type": "displacement", "name": "drive", "i": "ground", "j": "piston", "axis_i": [{:.17g}, {:.17g}],
        "value": {{"polynomial": [{:.17g}, {:.17g}, {:.17g}]}}}}],
      "outputs": ["crank.angle", "crank.omega"],)",
                         a * a, angle, a, b * b, a * std::cos(angle), a * std::sin(angle), rod, b, a * a, start * c,
                         start * s, line, line, c, s, c, s, start, law[0], law[1]);
  }
  std::string scene(const std::string& analysis, int branch = 0) const {
    return scene_ + fmt::format(R"("analyses": [{{"type": "{}", "until": {:.17g}, "every": {:.17g}{}}}]}})", analysis,
                                until, every, branch > 0 ? fmt::format(R"(, "branch": {})", branch) : "");
  }
  /// Place of the piston along its line with the crank at an angle.
  double piston(double angle) const {
    const double across = a * std::sin(angle - line);
    return a * std::cos(angle - line) + std::sqrt(b * b - across * across);
  }
  double piston_at(double t) const { return start + speed / time * t * t; }
  /// The square of the crank's speed with which it leaves a dead centre as the piston is accelerated from rest there.
  double leaving() const {
    const double bend = outer ? -(a + a * a / b) : a - a * a / b;  // second derivative of piston() by the angle
    return 2 * speed / time / bend;
  }

  Case kind = Case::start;
  bool outer = true;
  double time = 1, line = 0, a = 1, b = 1, dead = 0, speed = 0, start = 0, lock = 0, until = 0, every = 0;

 private:
  std::mt19937 random_;
  std::string scene_;
};

/// A field of the first entry under "singular" of the first analysis.
template <class T>
T of_singular(const TextRun& run, const std::string& name) {
  for (const NamedField& field : run.analysis().fields) {
    if (field.name != "singular") continue;
    for (const auto& [key, value] : std::get<std::vector<FieldRecord>>(field.value).at(0)) {
      if (key == name) return std::get<T>(value);
    }
  }
  ADD_FAILURE() << "no singular entry with " << name << "; " << run.analysis().report.message;
  return {};
}

inline void expect_assembled(unsigned seed) {
  const Sketch sketch(seed);
  std::string analyses =
      R"({"type": "check"}, {"type": "assemble", "from": "initial"}, {"type": "dynamics", "from": "initial"})";
  if (sketch.driven()) analyses += R"(, {"type": "kinematics", "from": "initial"})";
  const TextRun run = run_text(sketch.scene(analyses));
  ASSERT_EQ(run.outcome.analyses.size(), sketch.driven() ? 4u : 3u) << seed << run.outcome.error_text;
  for (std::size_t k = 0; k < run.outcome.analyses.size(); ++k) {
    EXPECT_EQ(run.analysis(k).report.status, Status::ok)
        << seed << " " << run.analysis(k).type << ": " << run.analysis(k).report.message;
    if (k > 0 && run.analysis(k).report.ok()) {
      EXPECT_LE(sketch.gap(run, k), sketch.allowed()) << seed << " " << run.analysis(k).type;
    }
  }
}

/// Both of `kinematics`, which alone takes a branch, and of `dynamics`.
inline void expect_dead_centre(unsigned seed, const std::string& analysis) {
  const DeadCentre mechanism(seed);
  const TextRun run = run_text(mechanism.scene(analysis));
  ASSERT_EQ(run.outcome.analyses.size(), 1u) << seed << run.outcome.error_text;
  const Status status = run.analysis().report.status;
  const std::string& message = run.analysis().report.message;
  using Case = DeadCentre::Case;
  if (mechanism.kind == Case::from_rest) {
    const double square = mechanism.leaving();
    ASSERT_EQ(status, square > 0 ? Status::bifurcation : Status::lock_up) << seed << " " << message;
    EXPECT_FALSE(of_singular<std::vector<std::string>>(run, "bodies").empty()) << seed;
    if (square < 0) return;
    EXPECT_EQ(of_singular<std::vector<std::string>>(run, "branches").size(), 2u) << seed;
    if (analysis == "dynamics") return;
    double sum = 0;
    for (const int branch : {1, 2}) {
      const TextRun along = run_text(mechanism.scene(analysis, branch));
      ASSERT_EQ(along.analysis().report.status, Status::ok) << seed << " " << along.analysis().report.message;
      const std::vector<double> t = along.column("t"), angle = along.column("crank.angle");
      EXPECT_NEAR(std::abs(along.first("crank.omega")), std::sqrt(square), 1e-8 * std::sqrt(square)) << seed;
      sum += along.first("crank.omega") / std::sqrt(square);
      for (std::size_t k = 0; k < t.size(); ++k) {
        EXPECT_NEAR(mechanism.piston(angle[k]), mechanism.piston_at(t[k]), 1e-10 * mechanism.b) << seed;
      }
    }
    EXPECT_NEAR(sum, 0, 1e-7) << seed;  // the two are each other's mirror image
    return;
  }
  ASSERT_EQ(status, Status::lock_up) << seed << " " << message;
  const double t = of_singular<double>(run, "t");
  EXPECT_FALSE(of_singular<std::vector<std::string>>(run, "bodies").empty()) << seed;
  EXPECT_FALSE(of_singular<std::vector<std::string>>(run, "branches").empty()) << seed;
  EXPECT_EQ(of_singular<std::string>(run, "driver"), "drive") << seed;
  // The last row is the place where it locks, without rates.
  EXPECT_EQ(run.last("t"), t) << seed;
  EXPECT_TRUE(std::isnan(run.last("crank.omega"))) << seed;
  const double end = mechanism.start + mechanism.speed * mechanism.lock;
  EXPECT_NEAR(of_singular<double>(run, "value"), end, 1e-9 * mechanism.b) << seed;
  EXPECT_NEAR(t, mechanism.lock, mechanism.kind == Case::start ? 1e-12 * mechanism.time : 1e-9 * mechanism.lock)
      << seed;
  // At a start the crank is as sharp as assembly: its tolerance of 1e-12 is the square of an angle there.
  EXPECT_NEAR(run.last("crank.angle"), mechanism.dead, mechanism.kind == Case::start ? 1e-5 : 1e-8) << seed;
}

}  // namespace catena::testing
