// Forces without a potential in modes, equilibrium, buckling and path, against dense algebra in minimal coordinates and
// closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <random>

#include "analysis/sanitized.hpp"
#include "catena/base/at.hpp"
#include "oracles/random_seeds.hpp"
#include "oracles/unsymmetric_chain.hpp"
#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

UnsymmetricChain random_chain(unsigned seed, bool bent = true) {
  RandomNumbers random(seed);
  UnsymmetricChain chain;
  const int n = 2 + static_cast<int>(random(0, 5));
  for (int k = 0; k < n; ++k) {
    ChainLink link;
    link.length = random(0.3, 1.5);
    link.centre = link.length * random(0.2, 0.8);
    link.mass = std::exp(random(-1.5, 1.5));
    link.inertia = link.mass * link.length * link.length * random(0.05, 0.2);
    link.spring = std::exp(random(0, 3));
    link.angle = bent ? random(-3, 3) : 0.5 * std::numbers::pi;
    chain.links.push_back(link);
  }
  const int forces = 1 + static_cast<int>(random(0, 2));
  for (int k = 0; k < forces; ++k) {
    const int link = k == 0 ? n - 1 : static_cast<int>(random(0, n));
    const double size = std::exp(random(-1, 3));
    chain.forces.push_back({link, chain.links[at(link)].length * random(0.3, 1), -size, random(-0.3, 0.3) * size});
  }
  chain.gx = random(-2, 2);
  chain.gy = random(-3, 3);
  if (random(0, 1) < 0.5) return chain;
  chain.law = WideMatrix::Zero(n, n);
  for (int k = 0; k < n; ++k) chain.law(static_cast<int>(random(0, n)), static_cast<int>(random(0, n))) = random(-4, 4);
  return chain;
}

/// A field of one of the analyses; an empty list where there is none.
std::vector<double> numbers(const TextRun& run, const std::string& name, std::size_t k = 0) {
  for (const NamedField& f : run.analysis(k).fields) {
    if (f.name == name) return std::get<std::vector<double>>(f.value);
  }
  return {};
}

/// Farthest of the found values from the ones that should be: each takes the nearest that is left.
double farthest_apart(std::vector<WideValue> wanted, const std::vector<WideValue>& found) {
  double most = 0;
  for (const WideValue& value : found) {
    const auto nearest = std::min_element(wanted.begin(), wanted.end(), [&](const WideValue& a, const WideValue& b) {
      return std::abs(a - value) < std::abs(b - value);
    });
    most = std::max(most, static_cast<double>(std::abs(*nearest - value)));
    wanted.erase(nearest);
  }
  return most;
}

/// Distance of the two values that are nearest to each other: their rounding grows with its inverse.
double closest(const std::vector<WideValue>& values) {
  double least = INFINITY;
  for (std::size_t i = 0; i < values.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) least = std::min(least, static_cast<double>(std::abs(values[i] - values[j])));
  }
  return least;
}

// Values, and vectors by what is left of (K - omega2 M) v with the matrices of the minimal coordinates.
std::string fault_of_modes(unsigned seed) {
  const UnsymmetricChain chain = random_chain(seed);
  const int n = chain.size();
  const TextRun run = run_text("{\"catena\": 1, " + chain.scene() +
                               ", \"analyses\": [{\"type\": \"modes\", \"count\": 20, \"shapes\": true}, "
                               "{\"type\": \"equilibrium\", \"accept\": \"stationary\"}]}");
  if (run.outcome.exit_code != 0) return run.analysis().report.message + run.outcome.error_text;
  const std::vector<double> omega2 = run.column("omega2"), omega = run.column("omega");
  std::vector<double> imaginary = run.column("omega2_imaginary"), growth = run.column("growth");
  if (static_cast<int>(omega2.size()) != n) return "the number of modes";
  const bool complex = !imaginary.empty();
  if (!complex) imaginary.assign(omega2.size(), 0.0);
  const std::vector<WideValue> wanted = chain.omega2();
  std::vector<WideValue> found;
  for (std::size_t k = 0; k < omega2.size(); ++k) found.emplace_back(omega2[k], imaginary[k]);
  const double size = static_cast<double>(std::abs(wanted.back()));
  const double off = farthest_apart(wanted, found);
  if (off > 1e-8 * size * std::max(1.0, 1e-3 * size / closest(wanted))) return "omega2 off by " + text_of(off / size);
  const WideMatrix k_matrix = chain.stiffness(), mass = chain.masses();
  for (std::size_t k = 0; k < omega2.size(); ++k) {
    Eigen::Matrix<WideValue, Eigen::Dynamic, 1> v(n);
    const bool first = imaginary[k] < 0;
    for (int i = 0; i < n; ++i) {
      const std::vector<double> column = run.column("l" + std::to_string(i) + ".angle");
      v[i] = {column[k], first ? column[k + 1] : 0.0};
    }
    const WideValue value(omega2[k], imaginary[k]);
    if (imaginary[k] > 0) {
      if (omega2[k] != omega2[k - 1] || growth[k] != -growth[k - 1]) return "the second of a pair";
      continue;
    }
    const double left = static_cast<double>(((k_matrix - value * mass.cast<WideValue>()) * v).norm() /
                                            ((k_matrix.norm() + std::abs(value) * mass.norm()) * v.norm()));
    if (left > 1e-9) return "a shape leaves " + text_of(left);
    if (!complex) continue;
    const std::complex<double> rate(growth[k], imaginary[k] < 0 ? omega[k] : 0);
    if (imaginary[k] < 0 && std::abs(rate * rate + std::complex<double>(omega2[k], imaginary[k])) > 1e-12 * size)
      return "the growth of a pair";
  }
  // The verdict on the place of rest, which is the given one.
  bool stable = true;
  for (const WideValue& value : wanted) stable = stable && value.real() > 0 && std::abs(value.imag()) < 1e-9L * size;
  for (const NamedField& f : run.analysis(1).fields) {
    if (f.name == "stable") return std::get<bool>(f.value) == stable ? "" : "stable";
  }
  return "no verdict";
}

TEST(UnsymmetricChains, HaveTheModesOfMinimalCoordinates) { expect_no_fault(1, 60, fault_of_modes); }

/// Two links of `l` on springs of `c`, masses m1 at the joint and m2 at the tip, P along the second link.
std::string ziegler(double l, double c, double m1, double m2, double load, const std::string& analyses) {
  return "{\"catena\": 1, \"parameters\": {\"P\": " + text_of(load) + R"(}, "bodies": {
    "a": {"inertia": 0, "mass": )" +
         text_of(m1) + ", \"position\": " + pair_of(0, l) + R"(}, "b": {"inertia": 0, "mass": )" + text_of(m2) +
         ", \"position\": " + pair_of(0, 2 * l) + R"(}},
    "constraints": [{"type": "revolute", "i": "ground", "j": ["a", )" +
         pair_of(0, -l) + R"(]}, {"type": "revolute", "i": "a", "j": ["b", )" + pair_of(0, -l) + R"(]}],
    "forces": [{"type": "torsion_spring", "i": "ground", "j": "a", "k": )" +
         text_of(c) + R"(, "angle": 0}, {"type": "torsion_spring", "i": "a", "j": "b", "k": )" + text_of(c) +
         R"(, "angle": 0}, {"type": "point_force", "i": "b", "force": [0, "=-P"], "frame": "body"}],
    "outputs": ["a.angle", "b.angle"], "analyses": [)" +
         analyses + "]}";
}

// H. Ziegler 1952: m1 m2 l^4 w^2 - l^2 ((m1 + 5 m2) c - 2 m2 P l) w + c^2 = 0 has a double root w = omega2 at
// P l = c (m1 + 5 m2 -+ 2 sqrt(m1 m2)) / (2 m2), of which w = +- c / (l^2 sqrt(m1 m2)).
TEST(ZieglersColumn, FluttersAtTheLoadOfTheClosedForm) {
  struct Column {
    double l, c, m1, m2;
  };
  for (const Column& x :
       {Column{1, 1, 2, 1}, {1, 1, 1, 1}, {0.3, 7, 0.4, 2.5}, {2, 1e4, 30, 3}, {0.01, 1e-3, 1e-3, 1e-3}}) {
    const double first = x.c * (x.m1 + 5 * x.m2 - 2 * std::sqrt(x.m1 * x.m2)) / (2 * x.m2 * x.l);
    const double second = x.c * (x.m1 + 5 * x.m2 + 2 * std::sqrt(x.m1 * x.m2)) / (2 * x.m2 * x.l);
    const TextRun run = run_text(ziegler(x.l, x.c, x.m1, x.m2, 0,
                                         R"({"type": "buckling", "parameter": "P", "count": 1},
        {"type": "path", "parameter": "P", "to": )" +
                                             text_of(1.3 * second) + "}"));
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
    EXPECT_TRUE(numbers(run, "loads").empty()) << "the determinant of K is c^2 at any load";
    ASSERT_EQ(numbers(run, "flutter").size(), 1u);
    EXPECT_NEAR(numbers(run, "flutter")[0], first, 1e-9 * first);
    EXPECT_NEAR(numbers(run, "flutter_omega")[0], std::sqrt(x.c / (x.l * x.l * std::sqrt(x.m1 * x.m2))),
                1e-4 * std::sqrt(x.c) / x.l);
    // On the path the pair ends again, where both motions diverge.
    const AnalysisResult& path = run.analysis(1);
    ASSERT_TRUE(path.report.ok()) << path.report.message;
    for (const NamedField& f : path.fields) {
      if (f.name != "critical") continue;
      const auto& critical = std::get<std::vector<FieldRecord>>(f.value);
      ASSERT_EQ(critical.size(), 2u);
      for (std::size_t k = 0; k < 2; ++k) {
        EXPECT_EQ(std::get<std::string>(critical[k][0].second), "flutter");
        EXPECT_NEAR(std::get<double>(critical[k][1].second), k == 0 ? first : second, 1e-9 * second);
      }
    }
    const std::vector<double> pairs = numbers(run, "flutter", 1), negative = numbers(run, "negative_modes", 1);
    const std::vector<double> load = run.column("P", 1);
    ASSERT_EQ(pairs.size(), load.size());
    for (std::size_t k = 0; k < load.size(); ++k) {
      if (std::abs(load[k] - first) < 1e-6 * first || std::abs(load[k] - second) < 1e-6 * second) continue;
      EXPECT_EQ(pairs[k], load[k] > first && load[k] < second ? 1 : 0) << load[k];
      EXPECT_EQ(negative[k], load[k] > second ? 2 : 0) << load[k];
    }
  }
}

/// Where the first pair of a straight chain appears between two loads, by bisection in 80 bits.
double flutter_load(const std::function<UnsymmetricChain(double)>& chain, double low, double high) {
  const auto flutters = [&](double load) {
    const std::vector<WideValue> values = chain(load).omega2();
    // The imaginary part grows like the root of the load's distance; rounding of 80 bits is far below.
    return std::any_of(values.begin(), values.end(),
                       [](const WideValue& value) { return std::abs(value.imag()) > 1e-6L * std::abs(value); });
  };
  for (int k = 0; k < 60; ++k) (flutters(0.5 * (low + high)) ? high : low) = 0.5 * (low + high);
  return high;
}

// M. Beck 1952: a cantilever under a tangential load at its tip flutters at 20.051 E I / l^2. A chain of n links on
// springs of n E I / l, the first of twice that, tends to it.
TEST(BecksColumn, AsAChainFluttersWhereDenseAlgebraSays) {
  double before = INFINITY;
  for (const int n : {2, 5, 10, 20}) {
    const auto chain_at = [n](double load) {
      UnsymmetricChain chain;
      for (int k = 0; k < n; ++k) {
        const double length = 1.0 / n, mass = 1.0 / n;
        chain.links.push_back(
            {length, length / 2, mass, mass * length * length / 12, (k == 0 ? 2.0 : 1.0) * n, 0.5 * std::numbers::pi});
      }
      chain.forces.push_back({n - 1, 1.0 / n, -load, 0});
      return chain;
    };
    const double wanted = flutter_load(chain_at, 5, 30);
    const TextRun run = run_text("{\"catena\": 1, \"parameters\": {\"P\": 1}, " + chain_at(1).scene("P") +
                                 R"(, "analyses": [{"type": "buckling", "parameter": "P"}]})");
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
    ASSERT_EQ(numbers(run, "flutter").size(), 1u) << n;
    EXPECT_NEAR(numbers(run, "flutter")[0], wanted, 1e-8 * wanted) << n;
    const double off = std::abs(wanted - 20.051);
    EXPECT_LT(off, before) << "they come nearer to the continuous column";
    before = off;
  }
  EXPECT_LT(before, 0.2);
}

// Random straight chains: every load, of either kind, is one at which dense algebra sees the change.
std::string fault_of_loads(unsigned seed) {
  UnsymmetricChain chain = random_chain(seed, false);
  chain.gx = chain.gy = 0;
  for (ChainForce& force : chain.forces) force.y = 0;
  const auto scaled = [&](double load) {
    UnsymmetricChain result = chain;
    for (ChainForce& force : result.forces) force.x *= load;
    return result;
  };
  const auto kinds = [&](double load) {
    std::pair<int, int> found{0, 0};
    Wide size = 0;
    const std::vector<WideValue> values = scaled(load).omega2();
    for (const WideValue& value : values) size = std::max(size, std::abs(value));
    for (const WideValue& value : values) {
      const bool complex = std::abs(value.imag()) > 1e-9L * size;
      found.first += !complex && value.real() < 0;
      found.second += complex;
    }
    return found;
  };
  if (kinds(0) != std::pair(0, 0)) return "";  // a law makes it unstable without a load
  const TextRun run = run_text("{\"catena\": 1, \"parameters\": {\"P\": 0}, " + chain.scene("P") +
                               R"(, "analyses": [{"type": "buckling", "parameter": "P", "count": 2}]})");
  if (run.outcome.exit_code != 0) return run.analysis().report.message + run.outcome.error_text;
  double nearest = INFINITY;
  for (const double load : numbers(run, "loads")) {
    nearest = std::min(nearest, std::abs(load));
    if (kinds(load * (1 - 1e-6)).first == kinds(load * (1 + 1e-6)).first) return "no divergence at " + text_of(load);
  }
  for (const double load : numbers(run, "flutter")) {
    nearest = std::min(nearest, std::abs(load));
    if (kinds(load * (1 - 1e-6)).second >= kinds(load * (1 + 1e-6)).second) return "no flutter at " + text_of(load);
  }
  if (nearest == INFINITY) nearest = 1;
  for (int k = 1; k < 60; ++k) {
    for (const double load : {k * nearest / 60, -k * nearest / 60}) {
      if (kinds(load) != std::pair(0, 0)) return "unstable already at " + text_of(load) + ", not " + text_of(nearest);
    }
  }
  return "";
}

TEST(UnsymmetricChains, LoseTheirStabilityAtTheLoadsThatAreFound) {
  expect_no_fault(1, size_of_test(30u, 8u), fault_of_loads);
}

// Chains that the load bends: every row is in balance, and has as many negative values and pairs as dense algebra
// finds.
std::string fault_of_path(unsigned seed) {
  const UnsymmetricChain chain = random_chain(seed + 500);
  const TextRun run = run_text("{\"catena\": 1, \"parameters\": {\"P\": 1}, " + chain.scene("P") +
                               R"(, "analyses": [{"type": "path", "parameter": "P", "to": 4, "max_steps": 60}]})");
  const Status status = run.analysis().report.status;
  if (status != Status::ok && status != Status::not_converged) return run.analysis().report.message;
  const std::vector<double> load = run.column("P"), pairs = numbers(run, "flutter");
  const std::vector<double> negative = numbers(run, "negative_modes"), rest = chain.rest();
  std::vector<std::vector<double>> angles;
  for (int k = 0; k < chain.size(); ++k) angles.push_back(run.column("l" + std::to_string(k) + ".angle"));
  for (std::size_t row = 0; row < load.size(); ++row) {
    UnsymmetricChain there = chain;
    for (int k = 0; k < chain.size(); ++k) there.links[at(k)].angle = angles[at(k)][row];
    for (ChainForce& force : there.forces) {
      force.x *= load[row];
      force.y *= load[row];
    }
    for (int i = 0; i < static_cast<int>(chain.law.rows()); ++i) {
      // What the laws give where they are no longer zero, as torques of dead forces would.
      there.torques.push_back(0);
      for (int j = 0; j < chain.size(); ++j)
        there.torques.back() += static_cast<double>(chain.law(i, j)) * (angles[at(j)][row] - chain.links[at(j)].angle);
    }
    if (const double left = there.imbalance(rest); left > 1e-8) return "out of balance by " + text_of(left);
    const std::vector<WideValue> values = there.omega2();
    int below = 0, complex = 0;
    bool doubtful = false;
    for (const WideValue& value : values) {
      complex += value.imag() > 0;
      below += value.imag() == 0 && value.real() < 0;
      doubtful = doubtful || std::abs(value) < 1e-7L * std::abs(values.back());
    }
    doubtful = doubtful || closest(values) < 1e-4 * static_cast<double>(std::abs(values.back()));
    if (!doubtful && (below != negative[row] || complex != pairs[row])) return "kinds at row " + std::to_string(row);
  }
  return load.size() > 5 ? "" : "too few rows";
}

TEST(PathsWithoutEnergy, StayInBalanceAndCountWhatGrows) { expect_no_fault(1, size_of_test(25u, 8u), fault_of_path); }

TEST(EquilibriaWithoutEnergy, AreNotJudgedWithoutTheMassesThatDecide) {
  const std::string scene = ziegler(1, 1, 2, 1, 1, R"({"type": "equilibrium"}, {"type": "modes"})");
  std::string massless = scene;
  massless.replace(massless.find("\"mass\": 2,"), 10, "");
  const TextRun run = run_text(massless);
  EXPECT_TRUE(run.analysis().report.ok()) << run.analysis().report.message << run.outcome.error_text;
  for (const NamedField& f : run.analysis().fields) EXPECT_NE(f.name, "stable");
  ASSERT_FALSE(run.analysis().report.warnings.empty());
  EXPECT_NE(run.analysis().report.warnings.front().find("masses"), std::string::npos);
  EXPECT_EQ(run.analysis(1).report.status, Status::refused);
}

TEST(AnalysesWithoutEnergy, RefuseWhatTheyDoNotTreatByNameAndNumber) {
  const std::string all = R"({"type": "equilibrium"}, {"type": "modes", "from": "initial"},
      {"type": "buckling", "parameter": "P", "from": "initial"},
      {"type": "path", "parameter": "P", "to": 2, "from": "initial"})";
  std::string scene = ziegler(1, 1, 2, 1, 1, all);
  scene.replace(scene.find("\"forces\": ["), 11,
                R"("forces": [{"type": "stop", "name": "buffer", "column": "A.angle", "max": 1}, )");
  scene.replace(scene.find("\"type\": \"revolute\""), 18, R"("name": "A", "type": "revolute")");
  const TextRun run = run_text(scene);
  ASSERT_EQ(run.outcome.analyses.size(), 4u) << run.outcome.error_text;
  // Equilibrium and modes have the stop beside the follower force; buckling and path have not.
  for (std::size_t k = 0; k < 2; ++k) EXPECT_TRUE(run.analysis(k).report.ok()) << run.analysis(k).report.message;
  for (std::size_t k = 2; k < 4; ++k) {
    EXPECT_EQ(run.analysis(k).report.status, Status::refused) << k;
    EXPECT_NE(run.analysis(k).report.message.find("buffer"), std::string::npos) << run.analysis(k).report.message;
  }
  UnsymmetricChain chain;
  for (int k = 0; k < 520; ++k) chain.links.push_back({1, 0.5, 1, 0.1, 1e7, 0});
  chain.forces.push_back({519, 1, -1, 0});
  const TextRun large = run_text("{\"catena\": 1, \"parameters\": {\"P\": 1}, " + chain.scene("P") + R"(, "analyses": [
      {"type": "modes", "from": "initial"}, {"type": "buckling", "parameter": "P", "from": "initial"},
      {"type": "path", "parameter": "P", "to": 2, "from": "initial"}, {"type": "equilibrium", "from": "initial"}]})");
  ASSERT_EQ(large.outcome.analyses.size(), 4u) << large.outcome.error_text;
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(large.analysis(k).report.status, Status::refused) << k;
    EXPECT_NE(large.analysis(k).report.message.find("520"), std::string::npos) << large.analysis(k).report.message;
  }
  ASSERT_TRUE(large.analysis(3).report.ok()) << large.analysis(3).report.message;
  EXPECT_NE(large.analysis(3).report.warnings.front().find("520"), std::string::npos);
}

}  // namespace
}  // namespace catena::testing
