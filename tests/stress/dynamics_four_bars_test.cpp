// IFToMM A02 (n four-bars side by side, every rod with all its joints) at all tolerances from many starts: the bars
// pass the flat position some twenty times in 20 s, where the constraints depend on each other and another branch
// begins.
#include "oracles/dynamics_mechanisms.hpp"

namespace catena {
namespace {

using testing::four_bars;
using testing::frame_of;

/// All cranks turn alike while it stays a parallelogram: theta'' = -k cos(theta), by a symplectic composition of order
/// 6 in small steps.
class Parallelogram {
 public:
  Parallelogram(int n, double speed)
      : k_(9.81L * ((n + 1) / 2.0L + n) / ((n + 1) / 3.0L + n)), rate_(-static_cast<long double>(speed)) {}

  Vec2<double> crank_end(double t) {
    constexpr long double w[] = {0.784513610477560L, 0.235573213359357L, -1.17767998417887L};
    constexpr long double middle = 1 - 2 * (w[0] + w[1] + w[2]);
    const int steps = static_cast<int>(std::ceil((t - t_) / 2e-4));
    const long double h = steps > 0 ? (static_cast<long double>(t) - t_) / steps : 0;
    for (int k = 0; k < steps; ++k) {
      for (const long double weight : {w[0], w[1], w[2], middle, w[2], w[1], w[0]}) {
        angle_ += weight * h / 2 * rate_;
        rate_ -= weight * h * k_ * std::cos(angle_);
        angle_ += weight * h / 2 * rate_;
      }
    }
    t_ = t;
    return {static_cast<double>(std::cos(angle_)), static_cast<double>(std::sin(angle_))};
  }

 private:
  long double k_, angle_ = std::numbers::pi_v<long double> / 2, rate_, t_ = 0;
};

/// What the error may come to, in tolerances: ten, as calibrated, but `most` where less than `below` is asked for.
struct Limit {
  double below = 0, most = 10;
};

/// Tolerances from 1e-3 on, four to a power of ten.
constexpr int down_to_1e8 = 21, down_to_1e10 = 29;

void check_all(int n, IntegrationMethod method = IntegrationMethod::automatic, Limit limit = {}, int starts = 20,
               int tolerances = down_to_1e10) {
  int passages = 0;
  for (int start = 0; start < starts; ++start) {
    const double speed = 0.8 + 0.05 * start;
    const auto model = four_bars(n);
    for (BasicBody<double>& body : model->bodies) {
      body.velocity = speed * body.velocity;
      body.angular_velocity *= speed;
    }
    Parallelogram exact(n, speed);
    std::vector<Vec2<double>> want;
    for (int k = 0; k <= 40; ++k) {
      want.push_back(exact.crank_end(0.5 * k));
      if (k > 0 && want[want.size() - 2].y * want.back().y < 0) ++passages;
    }
    for (int k = 0; k < tolerances; ++k) {
      const double tolerance = std::pow(10, -3 - k / 4.0);
      double error = 0;
      std::size_t row = 0;
      Dynamics dynamics(model, {}, {.method = method, .tolerance = tolerance});
      RowFunction compare([&](const Snapshot& s) {
        error = std::max(error, norm(frame_of(s, 0).point(Vec2<double>{0.5, 0}) - want[row++]));
        return true;
      });
      const AnalysisReport report = dynamics.run(TimeGrid::range(0, 20, 0.5), {}, compare);
      EXPECT_TRUE(report.ok()) << report.message << " at tolerance " << tolerance << ", speed " << speed;
      EXPECT_LE(error, (tolerance < limit.below ? limit.most : 10) * tolerance)
          << "tolerance " << tolerance << ", speed " << speed;
    }
  }
  EXPECT_GT(passages, starts * 10) << "the starts were not what this test is about";
}

TEST(DynamicsFourBars, TwoAtAllTolerancesFromTwentyStarts) { check_all(2); }
TEST(DynamicsFourBars, TwoByOrderEight) { check_all(2, IntegrationMethod::rk8); }
TEST(DynamicsFourBars, TwoByOrderFive) { check_all(2, IntegrationMethod::rk5); }
TEST(DynamicsFourBars, TwoByAdams) { check_all(2, IntegrationMethod::adams); }
// Neither projects its stages: where hardly a digit is to spare, more of the constraints' near dependence shows.
TEST(DynamicsFourBars, TwoWithStabilisedConstraints) { check_all(2, IntegrationMethod::baumgarte, {0.9e-9, 20}); }
TEST(DynamicsFourBars, TwoByPartitioning) { check_all(2, IntegrationMethod::partitioning, {1.5e-10, 15}); }
TEST(DynamicsFourBars, FortyAtAllTolerancesFromTwentyStarts) { check_all(40); }
TEST(DynamicsFourBars, FortyByAdams) { check_all(40, IntegrationMethod::adams, {}, 5); }
TEST(DynamicsFourBars, FortyWithStabilisedConstraints) { check_all(40, IntegrationMethod::baumgarte, {2e-9, 30}, 5); }
TEST(DynamicsFourBars, FortyByPartitioning) {
  check_all(40, IntegrationMethod::partitioning, {1.5e-8, 15}, 2, down_to_1e8);
}

}  // namespace
}  // namespace catena
