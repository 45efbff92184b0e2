// Gradients of a motion against the discrete solution itself: a double pendulum of rods in absolute coordinates, taken
// over the same steps by the same method in long double, differenced to fourth order; and against the solution of the
// equations, by steps a third as long. Only the coefficients of the method, which define the discrete solution, are
// the library's.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "analysis/sanitized.hpp"
#include "catena/analysis/dynamics/dynamics.hpp"
#include "catena/analysis/motion/stage_watcher.hpp"
#include "catena/analysis/motion/tableau.hpp"
#include "catena/analysis/sensitivity/motion_adjoint.hpp"
#include "catena/analysis/sensitivity/motion_derivatives.hpp"
#include "catena/scene/models/scene_models.hpp"
#include "catena/scene/reading/scene_reader.hpp"
#include "oracles/scene_text.hpp"

namespace catena::testing {
namespace {

using Long = long double;

/// What of the pendulum is a parameter, in the order of `names`; angles and the second turn are its own.
struct PendulumDesign {
  static constexpr std::array<const char*, 6> names = {"l", "n", "m", "o", "g", "w"};
  std::array<Long, 6> value{};  // lengths, masses, gravity, the first rod's turn
  Long angle_1 = 0, angle_2 = 0, omega_2 = 0;
};

/// q = [x y phi] of both rods at their middles; the equations
/// [M, Phi_q^T; Phi_q, 0] [qdd; lambda] = [Q; gamma] and the least change in the metric of M, by elimination.
class PendulumOracle {
 public:
  using State = std::array<Long, 12>;  // q, qd

  explicit PendulumOracle(const PendulumDesign& design) : design_(design) {
    const auto& [l, n, m, o, g, w] = design.value;
    mass_ = {m, m, m * l * l / 12, o, o, o * n * n / 12};
  }

  State start() const {
    const auto& [l, n, m, o, g, w] = design_.value;
    const Long a = design_.angle_1, b = design_.angle_2, v = design_.omega_2;
    const Long cx = std::cos(a), sx = std::sin(a), cy = std::cos(b), sy = std::sin(b);
    return {l / 2 * cx,      l / 2 * sx,     a, l * cx + n / 2 * cy,          l * sx + n / 2 * sy,         b,
            -l / 2 * sx * w, l / 2 * cx * w, w, -l * sx * w - n / 2 * sy * v, l * cx * w + n / 2 * cy * v, v};
  }

  void step(State& y, Long h) const {
    const Tableau& table = dormand_prince_8();
    std::vector<State> k;
    const auto at_stage = [&](const StageSum& sum) {
      State there = y;
      for (const StageTerm& term : sum) {
        for (std::size_t i = 0; i < 12; ++i) there[i] += h * term.weight * k[static_cast<std::size_t>(term.stage)][i];
      }
      return there;
    };
    for (std::size_t s = 0; s < static_cast<std::size_t>(table.stages); ++s) k.push_back(slope(at_stage(table.a[s])));
    y = at_stage(table.b);
    project(y);
  }

 private:
  using Rows = std::array<std::array<Long, 6>, 4>;

  Rows jacobian(const State& y) const {
    const Long l = design_.value[0], n = design_.value[1];
    const Long s = std::sin(y[2]), c = std::cos(y[2]), t = std::sin(y[5]), d = std::cos(y[5]);
    return {{{1, 0, l / 2 * s, 0, 0, 0},
             {0, 1, -l / 2 * c, 0, 0, 0},
             {-1, 0, l / 2 * s, 1, 0, n / 2 * t},
             {0, -1, -l / 2 * c, 0, 1, -n / 2 * d}}};
  }

  /// x and lambda of [M, Phi_q^T; Phi_q, 0] [x; lambda] = [f; b]: x alone.
  std::array<Long, 6> solve(const Rows& phi_q, const std::array<Long, 6>& f, const std::array<Long, 4>& b) const {
    Long a[10][11] = {};
    for (std::size_t i = 0; i < 6; ++i) {
      a[i][i] = mass_[i];
      a[i][10] = f[i];
      for (std::size_t r = 0; r < 4; ++r) a[i][6 + r] = a[6 + r][i] = phi_q[r][i];
    }
    for (std::size_t r = 0; r < 4; ++r) a[6 + r][10] = b[r];
    for (std::size_t p = 0; p < 10; ++p) {
      std::size_t best = p;
      for (std::size_t i = p + 1; i < 10; ++i) best = std::abs(a[i][p]) > std::abs(a[best][p]) ? i : best;
      std::swap(a[p], a[best]);
      for (std::size_t i = 0; i < 10; ++i) {
        if (i == p || a[i][p] == 0) continue;
        const Long factor = a[i][p] / a[p][p];
        for (std::size_t j = p; j < 11; ++j) a[i][j] -= factor * a[p][j];
      }
    }
    std::array<Long, 6> x{};
    for (std::size_t i = 0; i < 6; ++i) x[i] = a[i][10] / a[i][i];
    return x;
  }

  State slope(const State& y) const {
    const auto& [l, n, m, o, g, w] = design_.value;
    const Long one = y[8] * y[8], two = y[11] * y[11];
    const Long s = std::sin(y[2]), c = std::cos(y[2]), t = std::sin(y[5]), d = std::cos(y[5]);
    // gamma = -(Phi_q qd)_q qd
    const std::array<Long, 4> gamma = {-l / 2 * c * one, -l / 2 * s * one, -l / 2 * c * one - n / 2 * d * two,
                                       -l / 2 * s * one - n / 2 * t * two};
    const std::array<Long, 6> qdd = solve(jacobian(y), {0, -m * g, 0, 0, -o * g, 0}, gamma);
    State k{};
    for (std::size_t i = 0; i < 6; ++i) {
      k[i] = y[6 + i];
      k[6 + i] = qdd[i];
    }
    return k;
  }

  void project(State& y) const {
    const Long l = design_.value[0], n = design_.value[1];
    const Rows at_start = jacobian(y);
    for (int round = 0; round < 8; ++round) {
      const Long s = std::sin(y[2]), c = std::cos(y[2]), t = std::sin(y[5]), d = std::cos(y[5]);
      const std::array<Long, 4> miss = {-(y[0] - l / 2 * c), -(y[1] - l / 2 * s),
                                        -(y[3] - n / 2 * d - y[0] - l / 2 * c), -(y[4] - n / 2 * t - y[1] - l / 2 * s)};
      const std::array<Long, 6> change = solve(at_start, {}, miss);
      for (std::size_t i = 0; i < 6; ++i) y[i] += change[i];
    }
    const Rows phi_q = jacobian(y);
    std::array<Long, 4> rate{};
    for (std::size_t r = 0; r < 4; ++r) {
      for (std::size_t i = 0; i < 6; ++i) rate[r] -= phi_q[r][i] * y[6 + i];
    }
    const std::array<Long, 6> change = solve(phi_q, {}, rate);
    for (std::size_t i = 0; i < 6; ++i) y[6 + i] += change[i];
  }

  PendulumDesign design_;
  std::array<Long, 6> mass_{};
};

/// Where a run's steps end, each taken in `parts` equal ones.
PendulumOracle::State end_of(const PendulumDesign& design, const std::vector<double>& instants, int parts) {
  const PendulumOracle oracle(design);
  PendulumOracle::State y = oracle.start();
  for (std::size_t k = 0; k + 1 < instants.size(); ++k) {
    const Long h = (static_cast<Long>(instants[k + 1]) - static_cast<Long>(instants[k])) / parts;
    for (int part = 0; part < parts; ++part) oracle.step(y, h);
  }
  return y;
}

/// The two angles at the end by a parameter.
std::array<Long, 2> difference(const PendulumDesign& design, std::size_t p, const std::vector<double>& instants,
                               int parts) {
  const Long h = 2e-4L;
  const auto moved = [&](Long by) {
    PendulumDesign other = design;
    other.value[p] += by;
    return end_of(other, instants, parts);
  };
  const auto near = std::array{moved(-h), moved(h)}, far = std::array{moved(-2 * h), moved(2 * h)};
  std::array<Long, 2> result{};
  for (std::size_t body = 0; body < 2; ++body) {
    const std::size_t i = 3 * body + 2;
    result[body] = (8 * (near[1][i] - near[0][i]) - (far[1][i] - far[0][i])) / (12 * h);
  }
  return result;
}

/// The library's motion of the same pendulum, with the instants of its steps; `watches`: derivatives are carried along
/// with the stages of the run, else along recomputed ones.
class SteppedMotion final : public RowObserver {
 public:
  SteppedMotion(const PendulumDesign& design, double until, double tolerance, bool watches)
      : watches_(watches),
        scene_(read_scene(SourceText("motion", text_of_pendulum(design)), diagnostics_)),
        models_(*scene_, 1000) {
    model_ = models_.model(scene_->parameters, {});
    std::vector<int> parameters;
    for (std::size_t p = 0; p < PendulumDesign::names.size(); ++p) parameters.push_back(static_cast<int>(p));
    Dynamics motion(model_, {}, {.method = IntegrationMethod::rk8, .tolerance = tolerance});
    const DesignModels designs = models_.designs(scene_->parameters, {}, parameters);
    const auto count = static_cast<int>(parameters.size());
    forward.emplace(motion.evaluator(), designs, count, GivenByModel{});
    adjoint.emplace(motion.evaluator(), designs, count, GivenByModel{});
    report = motion.run(TimeGrid::instant(until), {.velocity = true}, *this);
  }
  bool wants_stretches() const override { return true; }
  StageWatcher* stage_watcher() override { return watches_ ? forward->stage_watcher() : nullptr; }
  bool cover(const MotionStretch& stretch) override {
    if (instants.empty()) instants.push_back(stretch.from);
    instants.push_back(stretch.to);
    forward->cover(stretch);
    adjoint->cover(stretch);
    return true;
  }
  bool observe(const Snapshot& snapshot) override {
    found = forward->find(snapshot);
    q.assign(snapshot.q.begin(), snapshot.q.end());
    return true;
  }

  std::optional<MotionDerivatives> forward;
  std::optional<MotionAdjoint> adjoint;
  AnalysisReport report;
  std::vector<double> instants, q;
  bool found = false;

 private:
  bool watches_;
  static std::string text_of_pendulum(const PendulumDesign& design) {
    std::string numbers;
    for (std::size_t p = 0; p < PendulumDesign::names.size(); ++p)
      numbers += (p > 0 ? ", \"" : "\"") + std::string(PendulumDesign::names[p]) +
                 "\": " + text_of(static_cast<double>(design.value[p]));
    const std::string a = text_of(static_cast<double>(design.angle_1)),
                      b = text_of(static_cast<double>(design.angle_2));
    const auto place = [](const std::string& x, const std::string& y) { return "[\"=" + x + "\", \"=" + y + "\"]"; };
    const std::string x = "l*cos(" + a + ")", y = "l*sin(" + a + ")", pin = place(x, y);
    const std::string end = place(x + " + n*cos(" + b + ")", y + " + n*sin(" + b + ")");
    return R"({"catena": 1, "gravity": [0, "=-g"], "parameters": {)" + numbers +
           R"(}, "bodies": {"one": {"rod": {"from": [0, 0], "to": )" + pin +
           R"(}, "mass": "m", "angular_velocity": "w"}, "two": {"rod": {"from": )" + pin + R"(, "to": )" + end +
           R"(}, "mass": "o", "angular_velocity": )" + text_of(static_cast<double>(design.omega_2)) +
           R"(}}, "constraints": [{"type": "revolute", "i": "ground", "j": "one.from"},
                                  {"type": "revolute", "i": "one.to", "j": "two.from"}], "analyses": []})";
  }

  Diagnostics diagnostics_{10};
  std::unique_ptr<SceneTemplate> scene_;
  SceneModels models_;
  std::shared_ptr<const Model> model_;
};

PendulumDesign random_pendulum(RandomNumbers& random) {
  PendulumDesign design;
  const std::array<std::array<double, 2>, 6> range = {{{0.4, 1.2}, {0.4, 1.2}, {0.5, 3}, {0.5, 3}, {8, 11}, {-3, 3}}};
  for (std::size_t p = 0; p < range.size(); ++p) design.value[p] = random(range[p][0], range[p][1]);
  design.angle_1 = random(-2, 1);
  design.angle_2 = random(-2, 1);
  design.omega_2 = random(-3, 3);
  return design;
}

TEST(DiscreteGradients, OfADoublePendulumAreThoseOfItsStepsAndOfItsEquations) {
  for (unsigned seed = 1; seed <= 7; seed += size_of_test(1u, 3u)) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    const PendulumDesign design = random_pendulum(random);
    const double tolerance = seed % 2 == 0 ? 1e-7 : 1e-10;
    const bool watches = seed > 4;
    SteppedMotion motion(design, 1.5, tolerance, watches);
    ASSERT_TRUE(motion.report.ok()) << motion.report.message;
    ASSERT_TRUE(motion.found) << motion.forward->why();
    ASSERT_GT(motion.instants.size(), 5u);
    const PendulumOracle::State end = end_of(design, motion.instants, 1);
    for (std::size_t body = 0; body < 2; ++body)
      EXPECT_NEAR(motion.q[3 * body + 2], static_cast<double>(end[3 * body + 2]), 1e-12);
    std::array<std::vector<double>, 2> back;
    for (std::size_t body = 0; body < 2; ++body) {
      MotionPulse pulse{motion.instants.back(), std::vector<double>(motion.q.size(), 0.0), {}};
      pulse.by_q[3 * body + 2] = 1;
      const auto gradient = motion.adjoint->gradient({pulse});
      ASSERT_TRUE(gradient) << motion.adjoint->why();
      back[body] = *gradient;
    }
    // Short steps that the way back takes as one make another discrete solution, within the tolerance.
    const double of_own = 1e-9, of_back = motion.adjoint->blocks() == motion.adjoint->steps() ? 1e-9 : 0.1 * tolerance;
    for (std::size_t p = 0; p < PendulumDesign::names.size(); ++p) {
      const std::array<Long, 2> discrete = difference(design, p, motion.instants, 1),
                                exact = difference(design, p, motion.instants, 3);
      for (std::size_t body = 0; body < 2; ++body) {
        const double own = motion.forward->configuration(p / 4)[3 * body + 2].d[p % 4];
        const double size = std::max(1.0, std::abs(own));
        EXPECT_NEAR(own, static_cast<double>(discrete[body]), of_own * size) << PendulumDesign::names[p] << body;
        // Where stages are watched the adjoint still goes back over recomputed ones, of steps that it may join.
        if (!watches) {
          EXPECT_NEAR(back[body][p], static_cast<double>(discrete[body]), of_back * size)
              << PendulumDesign::names[p] << body;
        }
        for (const double gradient : {own, back[body][p]})
          EXPECT_NEAR(gradient, static_cast<double>(exact[body]), 10 * tolerance * size)
              << PendulumDesign::names[p] << body;
      }
    }
  }
}

/// Counts the steps whose stages another one wants to see.
class CountedStages final : public StageWatcher {
 public:
  explicit CountedStages(StageWatcher* watcher) : watcher_(watcher) {}
  bool begin_stages(double from, double to, std::span<const double> y) override {
    const bool wanted = watcher_->begin_stages(from, to, y);
    steps += wanted;
    return wanted;
  }
  void watch_stage(int s, double t, Side side, std::span<const double> y, std::span<const double> slope,
                   EquationsOfMotion& equations) override {
    watcher_->watch_stage(s, t, side, y, slope, equations);
  }
  int steps = 0;

 private:
  StageWatcher* watcher_;
};

/// Rows between the ends of steps, by stages that were watched and by recomputed ones: derivatives of places and rates.
class BothWays final : public RowObserver {
 public:
  BothWays(MotionDerivatives& watching, MotionDerivatives& recomputing)
      : watching_(watching), recomputing_(recomputing), stages(watching.stage_watcher()) {}
  bool wants_stretches() const override { return true; }
  StageWatcher* stage_watcher() override { return &stages; }
  bool cover(const MotionStretch& stretch) override {
    watching_.cover(stretch);
    recomputing_.cover(stretch);
    return true;
  }
  bool observe(const Snapshot& snapshot) override {
    EXPECT_TRUE(watching_.find(snapshot)) << watching_.why();
    EXPECT_TRUE(recomputing_.find(snapshot)) << recomputing_.why();
    const auto one = watching_.configuration(0), other = recomputing_.configuration(0);
    for (std::size_t c = 0; c < one.size(); ++c) {
      for (std::size_t p = 0; p < one[c].d.size(); ++p)
        EXPECT_NEAR(one[c].d[p], other[c].d[p], 1e-9 * std::max(1.0, std::abs(other[c].d[p]))) << snapshot.t;
    }
    ++rows;
    return true;
  }
  int rows = 0;

 private:
  MotionDerivatives &watching_, &recomputing_;

 public:
  CountedStages stages;
};

// Between the ends of steps, and across instants at which a function of time has a kink and which a parameter moves.
TEST(DiscreteGradients, OfWatchedStagesAreThoseOfRecomputedOnes) {
  const auto text = [](const std::string& force) {
    return R"({"catena": 1, "gravity": [0, -9.81], "parameters": {"l": 0.7, "m": 1.5, "k": 20, "s": 0.4321}, "bodies": {
      "one": {"rod": {"from": [0, 0], "to": ["l", 0]}, "mass": "m"},
      "two": {"rod": {"from": ["l", 0], "to": ["=2*l", 0]}, "mass": 1}},
      "constraints": [{"type": "revolute", "i": "ground", "j": "one.from"},
                      {"type": "revolute", "i": "one.to", "j": "two.from"}],
      "forces": [{"type": "torsion_spring", "i": "one", "j": "two", "k": "k"})" +
           force + R"(], "analyses": []})";
  };
  const std::string kick = R"(, {"type": "torque", "i": "two",
    "torque": {"step": {"t0": "s", "t1": "=s+0.2", "from": 0, "to": 3, "order": 3}}})";
  for (const std::string& scene_text : {text(""), text(kick)}) {
    Diagnostics diagnostics(10);
    const auto scene = read_scene(SourceText("motion", scene_text), diagnostics);
    ASSERT_TRUE(scene) << diagnostics.text();
    SceneModels models(*scene, 1000);
    Dynamics motion(models.model(scene->parameters, {}), {}, {.method = IntegrationMethod::rk8, .tolerance = 1e-9});
    const std::vector<int> parameters{0, 1, 2, 3};
    const DesignModels designs = models.designs(scene->parameters, {}, parameters);
    MotionDerivatives watching(motion.evaluator(), designs, 4, GivenByModel{});
    MotionDerivatives recomputing(motion.evaluator(), designs, 4, GivenByModel{});
    BothWays observer(watching, recomputing);
    ASSERT_TRUE(motion.run(TimeGrid::range(0, 1.5, 0.03), {.velocity = true}, observer).ok());
    EXPECT_EQ(observer.rows, 51);
    EXPECT_GT(observer.stages.steps, 5) << "both were recomputed";
  }
}

}  // namespace
}  // namespace catena::testing
