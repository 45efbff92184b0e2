// Particles under linear laws of state, whose stiffness is not symmetric, beside walls: the place of rest is the
// solution of a linear complementarity problem, and the only one.
//
//   A x = b + G^T p,   G x >= c,   p >= 0,   p (G x - c) = 0        x^T A x > 0
//
// What is found is checked against these equations themselves, its motions by the eigenvalues of A on the walls.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <vector>

#include "analysis/sanitized.hpp"
#include "oracles/random_seeds.hpp"
#include "oracles/scene_text.hpp"
#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

struct Wall {
  int particle = 0;
  double angle = 0;
  Eigen::Vector2d point;
  Eigen::Vector2d normal() const { return {-std::sin(angle), std::cos(angle)}; }
};

class ParticlesBesideWalls {
 public:
  explicit ParticlesBesideWalls(unsigned seed) {
    RandomNumbers random(seed);
    const int particles = 1 + static_cast<int>(random(0, 3));
    const int n = 2 * particles;
    length_ = std::pow(10.0, random(-6, 6));
    force_ = std::pow(10.0, random(-6, 6));
    Eigen::MatrixXd square(n, n), turning(n, n);
    for (double& x : square.reshaped()) x = random(-1.5, 1.5);
    for (double& x : turning.reshaped()) x = random(-1, 1);
    stiffness_ =
        square * square.transpose() / n + 0.2 * Eigen::MatrixXd::Identity(n, n) + (turning - turning.transpose());
    load_ = Eigen::VectorXd(n);
    start_ = Eigen::VectorXd(n);
    for (double& x : load_) x = random(-4, 4);
    for (double& x : start_) x = random(-2, 2);
    for (int i = 0; i < particles; ++i) {
      const int walls = static_cast<int>(random(0, 3));
      for (int k = 0; k < walls; ++k) {
        Wall wall{i, random(0, 6.3), {}};
        wall.point = Eigen::Vector2d(random(-1, 1), 0);
        wall.point.y() = random(-1, 1);
        walls_.push_back(wall);
      }
    }
  }

  std::string text() const {
    std::string bodies, forces, outputs;
    const auto name = [](int i) { return "p" + std::to_string(i); };
    const auto n = static_cast<int>(load_.size());
    for (int i = 0; 2 * i < n; ++i) {
      const std::string comma = i > 0 ? "," : "";
      bodies += comma + '"' + name(i) + R"(": {"particle": true, "mass": 1, "position": )" +
                pair_of(length_ * start_[2 * i], length_ * start_[2 * i + 1]) + "}";
      std::string laws;
      for (int row = 2 * i; row < 2 * i + 2; ++row) {
        std::string law = '=' + text_of(force_ * load_[row]);
        for (int c = 0; c < n; ++c) {
          law += "-(" + text_of(force_ / length_ * stiffness_(row, c)) + ")*" + name(c / 2) + (c % 2 ? ".y" : ".x");
        }
        laws += (row % 2 ? ",\"" : "\"") + law + '"';
      }
      forces += comma + R"({"type": "point_force", "i": ")" + name(i) + R"(", "force": [)" + laws + "]}";
      outputs += comma + '"' + name(i) + ".x\", \"" + name(i) + ".y\"";
    }
    for (const Wall& wall : walls_) {
      forces += R"(, {"type": "contact", "i": "ground", "j": ")" + name(wall.particle) +
                R"(", "curve": {"line": {"point": )" + pair_of(length_ * wall.point.x(), length_ * wall.point.y()) +
                R"(, "axis": )" + pair_of(std::cos(wall.angle), std::sin(wall.angle)) + "}}}";
    }
    return R"({"catena": 1, "bodies": {)" + bodies + R"(}, "forces": [)" + forces + R"(], "outputs": [)" + outputs +
           R"(], "analyses": [{"type": "equilibrium", "accept": "stationary"}, {"type": "modes", "count": 100}]})";
  }

  std::string fault() const {
    const TextRun run = run_text(text());
    const Report& report = run.analysis().report;
    const Answer answer = solve();
    if (!answer.exists) return report.ok() ? "walls that exclude each other: ok" : "";
    if (!report.ok()) return std::string(to_string(report.status)) + ": " + report.message;
    for (Eigen::Index k = 0; k < load_.size(); ++k) {
      const double x =
          run.sink.rows[0].column(run.sink.rows[0].columns()[static_cast<std::size_t>(k)].name)[0] / length_;
      if (!(std::abs(x - answer.place[k]) <= 1e-8)) return "a place off by " + text_of(x - answer.place[k]);
    }
    return answer.is_strict ? fault_of_motions(run, answer) : "";
  }

 private:
  struct Answer {
    bool exists = false, is_strict = true;  // no wall touches without a force
    Eigen::VectorXd place;
    Eigen::MatrixXd reduced;  // A on the walls that hold
  };

  // Every set of walls.
  Answer solve() const {
    const auto n = load_.size();
    for (unsigned set = 0; set < 1U << walls_.size(); ++set) {
      std::vector<const Wall*> held;
      for (std::size_t k = 0; k < walls_.size(); ++k) {
        if (set >> k & 1U) held.push_back(&walls_[k]);
      }
      const auto m = static_cast<Eigen::Index>(held.size());
      Eigen::MatrixXd g = Eigen::MatrixXd::Zero(m, n), full = Eigen::MatrixXd::Zero(n + m, n + m);
      Eigen::VectorXd right(n + m);
      for (Eigen::Index k = 0; k < m; ++k) {
        const Wall& wall = *held[static_cast<std::size_t>(k)];
        g.block<1, 2>(k, 2 * wall.particle) = wall.normal().transpose();
        right[n + k] = wall.normal().dot(wall.point);
      }
      const Eigen::FullPivLU<Eigen::MatrixXd> rank(g);
      if (m > 0 && rank.rank() < m) continue;
      full.topLeftCorner(n, n) = stiffness_;
      full.topRightCorner(n, m) = -g.transpose();
      full.bottomLeftCorner(m, n) = g;
      right.head(n) = load_;
      const Eigen::VectorXd x = full.fullPivLu().solve(right);
      bool holds = (x.tail(m).array() >= -1e-9).all(), strict = (x.tail(m).array() > 1e-6).all();
      for (const Wall& wall : walls_) {
        const double gap = wall.normal().dot(x.segment<2>(2 * wall.particle) - wall.point);
        holds = holds && gap >= -1e-9;
        strict = strict && (gap > 1e-6 || std::find(held.begin(), held.end(), &wall) != held.end());
      }
      if (!holds) continue;
      const Eigen::MatrixXd z =
          m > 0 ? Eigen::MatrixXd(rank.kernel().householderQr().householderQ() * Eigen::MatrixXd::Identity(n, n - m))
                : Eigen::MatrixXd(Eigen::MatrixXd::Identity(n, n));
      return {true, strict, x.head(n), m < n ? Eigen::MatrixXd(z.transpose() * stiffness_ * z) : Eigen::MatrixXd()};
    }
    return {};
  }

  std::string fault_of_motions(const TextRun& run, const Answer& answer) const {
    if (answer.reduced.size() == 0) return "";
    const Report& report = run.analysis(1).report;
    if (!report.ok()) return "modes: " + std::string(to_string(report.status)) + ": " + report.message;
    const Eigen::VectorXcd values = answer.reduced.eigenvalues();
    std::vector<double> expected;
    for (const std::complex<double>& value : values) expected.push_back(value.real());
    std::sort(expected.begin(), expected.end());
    const std::vector<double> found = run.column("omega2", 1);
    if (found.size() != expected.size()) return "modes: " + std::to_string(found.size());
    for (std::size_t k = 0; k < found.size(); ++k) {
      if (!(std::abs(found[k] * length_ / force_ - expected[k]) <= 1e-7 * values.cwiseAbs().maxCoeff()))
        return "omega2 " + text_of(found[k] * length_ / force_) + " in place of " + text_of(expected[k]);
    }
    return "";
  }

  double length_ = 1, force_ = 1;
  Eigen::MatrixXd stiffness_;
  Eigen::VectorXd load_, start_;
  std::vector<Wall> walls_;
};

TEST(LawsBesideContacts, RestWhereTheComplementarityProblemSays) {
  expect_no_fault(1, size_of_test(150u, 20u), [](unsigned seed) { return ParticlesBesideWalls(seed).fault(); });
}

TEST(LawsBesideContacts, AFollowerForcePressesARodOnTheFloor) {
  // A rod on a torsion spring c, its tip on the floor y = -h: the tip's force turns with the rod, P across it.
  // c phi = (P - N cos(phi)) l with phi = -asin(h / l).
  const double c = 3, p = -40, length = 2, h = 0.5, phi = -std::asin(h / length);
  const double expected = (p - c * phi / length) / std::cos(phi);  // on the rod, upwards: -expected
  const TextRun run = run_text(R"({"catena": 1, "bodies": {"rod": {"rod": {"from": [0, 0], "to": [2, 0]}, "mass": 1}},
      "constraints": [{"type": "revolute", "i": "ground", "j": "rod.from"}],
      "forces": [{"type": "torsion_spring", "i": "ground", "j": "rod", "k": 3, "angle": 0},
        {"type": "point_force", "i": "rod.to", "force": [0, -40], "frame": "body"},
        {"type": "contact", "name": "floor", "i": "ground", "j": "rod.to", "curve": {"line": {"point": [0, -0.5], "axis": [1, 0]}}}],
      "outputs": ["rod.angle", "floor.force"], "analyses": [{"type": "equilibrium"}]})");
  ASSERT_TRUE(run.analysis().report.ok()) << run.analysis().report.message;
  EXPECT_NEAR(run.last("rod.angle"), phi, 1e-10);
  EXPECT_NEAR(run.last("floor.force"), -expected, 1e-9);
}

}  // namespace
}  // namespace catena::testing
