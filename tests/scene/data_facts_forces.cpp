// Springs that are not linear, bushings, events.
#include <cmath>
#include <complex>

#include "scene/data_facts.hpp"

namespace catena::testing {
namespace {

const NamedField* field(const AnalysisResult& result, const std::string& name) {
  for (const NamedField& f : result.fields) {
    if (f.name == name) return &f;
  }
  return nullptr;
}

// xdd = -(x + x^3) / 2 from rest at 1: x = cn(t | 1/4), period 4 K. Halfway of a period it is at -1, at a quarter and
// at three quarters it passes 0.
void check_duffing(const TextRun& run) {
  const double period = 4 * std::comp_ellint_1(0.5);
  const std::vector<double> t = run.column("t", 1), e = run.column("carriage.x", 1), v = run.column("carriage.vx", 1);
  ASSERT_EQ(t.size(), 201u);
  // The first integral everywhere, and the period from where it passes the middle: v there is 0.75^(1/2).
  int passages = 0;
  for (std::size_t k = 0; k < t.size(); ++k) {
    const double x = e[k] - 4;
    EXPECT_NEAR(v[k] * v[k] / 2 + x * x / 4 + x * x * x * x / 8, 0.375, 1e-9) << t[k];
    EXPECT_NEAR(run.column("spring.force", 1)[k], (x + x * x * x) / 2, 1e-9);
    if (std::abs(x) > 0.05) continue;
    // Near the middle xdd = -x/2 - ..., hence t = t0 + x / v to third order in x.
    const double middle = t[k] - x / v[k] * (1 - x * x / (6 * v[k] * v[k]));
    EXPECT_NEAR(std::remainder(middle - period / 4, period / 2), 0, 2e-6) << t[k];
    ++passages;
  }
  EXPECT_GT(passages, 3);
}

void check_ladder(const TextRun& run) {
  const NamedField* events = field(run.analysis(1), "events");
  ASSERT_NE(events, nullptr);
  const auto& records = std::get<std::vector<FieldRecord>>(events->value);
  ASSERT_EQ(records.size(), 2u);
  const auto number = [](const FieldRecord& record, std::size_t k) { return record[k].second; };
  EXPECT_EQ(std::get<std::string>(number(records[0], 0)), "leaves the wall");
  const auto row = static_cast<std::size_t>(std::get<std::int64_t>(number(records[0], 2)));
  const double t = std::get<double>(number(records[0], 1));
  EXPECT_EQ(run.column("t", 1)[row], t);
  // Energy: (2/3) l^2 w^2 = g l (sin a0 - sin a) with half the length l; the wall's force vanishes at sin a = 2/3 sin
  // a0.
  const double sine = std::sin(70 * std::numbers::pi / 180);
  EXPECT_NEAR(run.column("ladder.to.y", 1)[row], 4 * 2.0 / 3 * sine, 1e-8);
  EXPECT_NEAR(run.column("wall.fx", 1)[row], 0, 1e-7);
  // From then on nothing pushes along the floor.
  const double speed = run.column("ladder.vx", 1)[row];
  const double omega = std::sqrt(1.5 * 9.81 / 2 * sine / 3);
  EXPECT_NEAR(speed, 2 * omega * 2.0 / 3 * sine, 1e-7);
  EXPECT_NEAR(run.last("ladder.vx", 1), speed, 1e-7);
  EXPECT_EQ(run.last("wall.fx", 1), 0);
  EXPECT_GT(run.last("ladder.to.x", 1), 0.1);
  EXPECT_NEAR(run.last("ladder.to.y", 1), 0, 1e-12);
  EXPECT_LT(run.last("t", 1), 2);
  for (const double balance : run.column("energy.balance", 1)) EXPECT_NEAR(balance, 0, 1e-6);
}

// At rest the weight is on the mount: it sags by m g / ky. Shaken, it obeys m yd + c yd + k y = F sin wt alone in y.
void check_mount(const TextRun& run) {
  constexpr double m = 80, k = 4e5, c = 1200, force = 300, w = 20 * std::numbers::pi;
  EXPECT_NEAR(run.last("block.y", 1), 0.2 - m * 9.81 / k, 1e-10);
  EXPECT_NEAR(run.last("block.angle", 1), 0, 1e-10);
  const std::vector<double> t = run.column("t", 2), y = run.column("block.y", 2);
  const double decay = c / (2 * m), own = std::sqrt(k / m - decay * decay);
  const std::complex<double> steady = force / std::complex<double>(k - m * w * w, c * w);  // times e^{i w t}, imaginary
  const double y0 = -steady.imag(), v0 = -w * steady.real();
  for (std::size_t n = 0; n < t.size(); ++n) {
    const double forced = (steady * std::polar(1.0, w * t[n])).imag();
    const double free =
        std::exp(-decay * t[n]) * (y0 * std::cos(own * t[n]) + (v0 + decay * y0) / own * std::sin(own * t[n]));
    EXPECT_NEAR(y[n], 0.2 - m * 9.81 / k + forced + free, 1e-10) << t[n];
  }
}

// The brake's torque is a law of the crank's speed alone; what gas and brake do, summed up over the rows, is what the
// parts gain in speed.
void check_engine(const TextRun& run) {
  const std::vector<double> t = run.column("t", 1), omega = run.column("crank.omega", 1),
                            gas = run.column("pressure.power", 1), load = run.column("load.power", 1),
                            kinetic = run.column("energy.kinetic", 1), force = run.column("pressure.fx", 1),
                            speed = run.column("piston.vx", 1), balance = run.column("energy.balance", 1);
  ASSERT_EQ(t.size(), 1001u);
  EXPECT_NEAR(force[0], -std::numbers::pi * 0.0016 * 0.55 * 2.4e6, 1e-8);
  double work = 0;
  for (std::size_t k = 0; k < t.size(); ++k) {
    EXPECT_NEAR(load[k], -0.12 * omega[k] * omega[k], 1e-9);
    EXPECT_NEAR(gas[k], force[k] * speed[k], 1e-7);
    EXPECT_NEAR(balance[k], 0, 1e-5);
    if (k > 0) work += (gas[k - 1] + load[k - 1] + gas[k] + load[k]) / 2 * (t[k] - t[k - 1]);
  }
  EXPECT_GT(omega.back(), 60);
  EXPECT_NEAR(work, kinetic.back() - kinetic.front(), 2);
}

}  // namespace

SceneFacts force_facts() {
  return {{"hardening_spring.json", check_duffing},
          {"engine_mount.json", check_mount},
          {"leaving_ladder.json", check_ladder},
          {"engine_torque.json", check_engine}};
}

}  // namespace catena::testing
