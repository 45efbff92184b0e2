// Cams with lobes under a knife edge that moves along a ray: its place is the cam's radius there, a spline of the angle
// that needs no search. A trial step that is rejected, or an analysis that ends far from the given configuration, must
// not leave the search on another lobe.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "results/temporary_folder.hpp"
#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

/// r over the angle, a periodic cubic spline through equally spaced values, by dense elimination.
class Radius {
 public:
  explicit Radius(std::vector<double> values) : value_(values.begin(), values.end()), bend_(values.size()) {
    // h (M_{k-1} + 4 M_k + M_{k+1}) / 6 = (r_{k-1} - 2 r_k + r_{k+1}) / h
    const std::size_t n = value_.size();
    std::vector<std::vector<long double>> rows(n, std::vector<long double>(n + 1, 0));
    for (std::size_t k = 0; k < n; ++k) {
      const std::size_t before = (k + n - 1) % n, after = (k + 1) % n;
      rows[k][before] += 1;
      rows[k][k] += 4;
      rows[k][after] += 1;
      rows[k][n] = 6 * (value_[before] - 2 * value_[k] + value_[after]) / (width() * width());
    }
    for (std::size_t k = 0; k < n; ++k) {
      for (std::size_t r = 0; r < n; ++r) {
        if (r == k) continue;
        const long double factor = rows[r][k] / rows[k][k];
        for (std::size_t c = k; c <= n; ++c) rows[r][c] -= factor * rows[k][c];
      }
    }
    for (std::size_t k = 0; k < n; ++k) bend_[k] = rows[k][n] / rows[k][k];
  }

  double operator()(double angle) const {
    const Place p = place(angle);
    return static_cast<double>(p.a * value_[p.k] + p.b * value_[p.next] +
                               ((p.a * p.a * p.a - p.a) * bend_[p.k] + (p.b * p.b * p.b - p.b) * bend_[p.next]) *
                                   width() * width() / 6);
  }
  double slope(double angle) const {
    const Place p = place(angle);
    return static_cast<double>((value_[p.next] - value_[p.k]) / width() +
                               ((1 - 3 * p.a * p.a) * bend_[p.k] + (3 * p.b * p.b - 1) * bend_[p.next]) * width() / 6);
  }

 private:
  struct Place {
    std::size_t k, next;
    long double a, b;
  };
  long double width() const { return 2 * std::numbers::pi_v<long double> / static_cast<long double>(value_.size()); }
  Place place(double angle) const {
    const long double turn = 2 * std::numbers::pi_v<long double>;
    const long double within = angle - turn * std::floor(angle / turn), part = within / width();
    const std::size_t k = std::min(static_cast<std::size_t>(part), value_.size() - 1);
    const long double b = part - static_cast<long double>(k);
    return {k, (k + 1) % value_.size(), 1 - b, b};
  }

  std::vector<long double> value_, bend_;
};

/// A cam that turns by one radian a second below a tappet that moves along y.
struct LobedCam {
  std::vector<double> values;
  Radius radius;

  static LobedCam random(std::mt19937& generator) {
    const int lobes = std::array{1, 2, 3, 5, 8}[generator() % 5];
    const double height = std::uniform_real_distribution(0.1, 0.6)(generator);
    const int count = std::max(4 * lobes, 8);
    std::vector<double> values;
    for (int k = 0; k < count; ++k)
      values.push_back(0.04 * (1 + height * std::sin(2 * std::numbers::pi * lobes * k / count + 0.3)));
    return {values, Radius(values)};
  }

  /// Its bodies, constraints and driver, with its number at the end of every name.
  std::array<std::string, 3> parts(std::size_t number) const {
    std::string angles, radii;
    for (std::size_t k = 0; k < values.size(); ++k) {
      angles += fmt::format("{}\"=2*pi*{}/{}\"", k > 0 ? ", " : "", k, values.size());
      radii += fmt::format("{}{:.17g}", k > 0 ? ", " : "", values[k]);
    }
    const double x = static_cast<double>(number);
    return {fmt::format(R"("cam{0}": {{"mass": 1, "inertia": 0.01, "position": [{1}, 0]}},
              "tappet{0}": {{"mass": 0.2, "inertia": 0.001, "position": [{1}, {2:.17g}]}})",
                        number, x, radius(std::numbers::pi / 2)),
            fmt::format(R"({{"type": "revolute", "name": "O{0}", "at": [{1}, 0], "i": "ground", "j": "cam{0}"}},
              {{"type": "translational", "name": "guide{0}", "i": ["ground", [{1}, 0]], "j": "tappet{0}",
                "axis_i": [0, 1], "axis_j": [0, 1]}},
              {{"type": "point_on_curve", "name": "edge{0}", "i": "cam{0}", "j": "tappet{0}",
                "curve": {{"polar": {{"angle": [{2}], "radius": [{3}]}}}}}})",
                        number, x, angles, radii),
            fmt::format(R"({{"type": "absolute_angle", "name": "turn{0}", "i": "cam{0}",
              "value": {{"polynomial": [0, 1]}}}})",
                        number)};
  }

  /// The rows of an analysis beside the spline: t, y, vy.
  void check(const TextRun& run, std::size_t analysis, double tolerance, std::size_t number = 0) const {
    const Report& report = run.analysis(analysis).report;
    ASSERT_EQ(report.status, Status::ok) << report.message;
    const std::string tappet = fmt::format("tappet{}", number);
    const std::vector<double> t = run.column("t", analysis), y = run.column(tappet + ".y", analysis),
                              rate = run.column(tappet + ".vy", analysis);
    ASSERT_FALSE(t.empty());
    for (std::size_t k = 0; k < t.size(); ++k) {
      const double angle = std::numbers::pi / 2 - t[k];
      EXPECT_NEAR(y[k], radius(angle), tolerance) << "t = " << t[k];
      EXPECT_NEAR(rate[k], -radius.slope(angle), 10 * tolerance) << "t = " << t[k];
    }
  }
};

std::string scene_of(const std::vector<LobedCam>& cams, const std::string& analyses) {
  std::array<std::string, 3> all;
  std::string outputs;
  for (std::size_t k = 0; k < cams.size(); ++k) {
    const std::array<std::string, 3> parts = cams[k].parts(k);
    for (std::size_t n = 0; n < all.size(); ++n) all[n] += (k > 0 ? ", " : "") + parts[n];
    outputs += fmt::format(R"({}"tappet{}.y", "tappet{}.vy")", k > 0 ? ", " : "", k, k);
  }
  return fmt::format(R"({{"catena": 1, "bodies": {{{}}}, "constraints": [{}], "drivers": [{}],
    "outputs": [{}], "analyses": [{}]}})",
                     all[0], all[1], all[2], outputs, analyses);
}

std::string at(std::vector<double> instants) {
  std::sort(instants.begin(), instants.end());
  std::string text;
  for (const double t : instants) text += fmt::format("{}{:.17g}", text.empty() ? "" : ", ", t);
  return "[" + text + "]";
}

constexpr int cams = 60;

TEST(LobedCams, AKnifeEdgeStaysOnItsLobeWhateverTheRows) {
  std::mt19937 generator(1);
  std::uniform_real_distribution instant(0.0, 7.0);
  for (int k = 0; k < cams; ++k) {
    SCOPED_TRACE(fmt::format("cam {}", k));
    const LobedCam cam = LobedCam::random(generator);
    std::vector<double> instants(std::array<std::size_t, 3>{1, 3, 20}[generator() % 3]);
    for (double& t : instants) t = instant(generator);
    cam.check(run_text(scene_of({cam}, fmt::format(R"({{"type": "kinematics", "at": {}}})", at(instants)))), 0, 1e-10);
  }
}

TEST(LobedCams, TheNextAnalysisGoesOnOnTheSameLobe) {
  std::mt19937 generator(2);
  std::uniform_real_distribution instant(0.3, 6.0), more(0.1, 3.0);
  for (int k = 0; k < cams; ++k) {
    SCOPED_TRACE(fmt::format("cam {}", k));
    const LobedCam cam = LobedCam::random(generator);
    const double first = instant(generator), second = first + more(generator);
    const std::string between = std::array{"", R"({"type": "assemble"},)", R"({"type": "check"},)"}[generator() % 3];
    const TextRun run = run_text(scene_of(
        {cam}, fmt::format(R"({{"type": "kinematics", "until": {:.17g}}}, {} {{"type": "kinematics", "at": {}}})",
                           first, between, at({first, second}))));
    cam.check(run, run.outcome.analyses.size() - 1, 1e-10);
  }
}

TEST(LobedCams, StepsOfDynamicsThatAreRejectedLeaveItThere) {
  std::mt19937 generator(3);
  std::uniform_real_distribution instant(0.5, 7.0);
  const char* methods[] = {"rk8", "rk5", "adams"};
  for (int k = 0; k < cams / 2; ++k) {
    const char* method = methods[k % 3];
    SCOPED_TRACE(fmt::format("cam {}, {}", k, method));
    const LobedCam cam = LobedCam::random(generator);
    const std::string analysis = fmt::format(R"({{"type": "dynamics", "method": "{}", "tolerance": 1e-9, "at": {}}})",
                                             method, at({instant(generator)}));
    cam.check(run_text(scene_of({cam}, analysis)), 0, 1e-7);
  }
}

// Three cams in one run, whose searches go on from the file: the same motion, bit for bit.
TEST(LobedCams, CheckpointsKnowWhereCurvesTouch) {
  std::mt19937 generator(4);
  std::vector<LobedCam> three;
  for (int k = 0; k < 3; ++k) three.push_back(LobedCam::random(generator));
  const std::string text = scene_of(three, R"({"type": "dynamics", "tolerance": 1e-9, "at": [3, 5.5]})");
  TemporaryFolder folder;
  const std::string file = folder / "cams", early = folder / "early";
  RunOptions options;
  options.checkpoint = file;
  options.checkpoint_every = 0.1;
  options.progress = [&](const Progress& progress) {
    if (progress.fraction > 0.3 && progress.fraction < 0.6)
      std::filesystem::copy_file(file, early, std::filesystem::copy_options::overwrite_existing);
  };
  const TextRun whole = run_text(text, options);
  RunOptions restart;
  restart.restart = early;
  const TextRun rest = run_text(text, restart);
  for (std::size_t k = 0; k < three.size(); ++k) {
    three[k].check(whole, 0, 1e-7, k);
    three[k].check(rest, 0, 1e-7, k);
    const std::string column = fmt::format("tappet{}.y", k);
    EXPECT_EQ(std::bit_cast<std::uint64_t>(rest.last(column)), std::bit_cast<std::uint64_t>(whole.last(column)));
  }
}

// Mechanisms side by side that differ in pace are integrated apart.
TEST(LobedCams, SideBySideKeepTheirLobes) {
  std::mt19937 generator(5);
  std::vector<LobedCam> two{LobedCam::random(generator), LobedCam::random(generator)};
  const TextRun run = run_text(scene_of(two, R"({"type": "dynamics", "tolerance": 1e-9, "at": [0.4, 2.5, 6]},
    {"type": "kinematics", "at": [6, 6.5]})"));
  for (std::size_t k = 0; k < two.size(); ++k) {
    two[k].check(run, 0, 1e-7, k);
    two[k].check(run, 1, 1e-10, k);
  }
}

}  // namespace
}  // namespace catena::testing
