// Two scenes that ended without an answer once: fixed steps of independent coordinates, and gears without a centre
// held.
#include "trials/trial.hpp"

namespace catena::testing {
namespace {

// Both cranks turn alike: (2/3 + 1) theta'' = -2 g cos(theta), through a flat position.
TEST(Trials, PartitioningWithAFixedStep) {
  const TextRun run = run_trial("partitioning_fixed_step");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.analysis().report.message;
  const auto slope = [](double angle) { return -1.2 * 9.81 * std::cos(angle); };
  const std::vector<double> t = run.column("t"), angle = run.column("b1.angle");
  ASSERT_EQ(t.size(), 16u);
  double theta = 2, omega = 0;
  for (std::size_t k = 0; k < t.size(); ++k) {
    EXPECT_NEAR(angle[k], theta, 1e-6) << t[k];
    // Symplectic Euler steps in pairs (Stoermer and Verlet): good to h^2 / 10.
    const double h = 1e-5;
    for (int n = 0; n < 10000; ++n) {
      theta += 0.5 * h * omega;
      omega += h * slope(theta);
      theta += 0.5 * h * omega;
    }
  }
}

// A search passes places where the centres of gears coincide. The spring of no length is slack in what it finds.
TEST(Trials, GearsWhoseCentresAreFree) {
  const TextRun run = run_trial("gear_internal_message");
  EXPECT_EQ(run.outcome.error_text.find("BlockFactorization"), std::string::npos) << run.outcome.error_text;
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  for (const double force : run.column("f0.force")) EXPECT_NEAR(force, 0, 1e-6);
  const std::vector<double> x = run.column("b0.x"), y = run.column("b0.y"), angle = run.column("b0.angle");
  for (std::size_t k = 0; k < x.size(); ++k) {
    EXPECT_NEAR(x[k] + std::sin(angle[k]), 0, 1e-8);
    EXPECT_NEAR(y[k] - std::cos(angle[k]), 2, 1e-8);
  }
}

}  // namespace
}  // namespace catena::testing
