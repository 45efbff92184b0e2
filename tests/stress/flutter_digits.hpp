// Digits of paths that pass flutter: what `path` claims beside the loads at which two omega2 of a straight chain meet,
// by dense algebra in 80 bits.
//
//   D(P) = ((omega2_a - omega2_b) / 2)^2 = 0,    M^-1 (K_0 + P (K_1 - K_0)) v = omega2 v
//
// Forces follow the links along their axis, so that the chain stays straight and K is linear in P: every row but those
// at flutter is exact as it is. D is smooth through the load, which the secant rule finds.
#pragma once

#include <optional>

#include "oracles/claimed_digits.hpp"
#include "oracles/unsymmetric_chain.hpp"
#include "references/dense.hpp"

namespace catena::testing {

/// A straight chain under forces that follow it, and the loads at which it flutters.
struct FlutteringChain {
  UnsymmetricChain chain;
  WideMatrix k_0, k_1, m;

  explicit FlutteringChain(RandomNumbers& random) {
    const int n = 2 + static_cast<int>(random(0, 3.999));
    const double size = std::pow(10.0, random(-2, 2)), stiff = std::pow(10.0, random(-2, 4));
    const double mass = std::pow(10.0, random(-2, 2)), angle = random(-3, 3);
    for (int k = 0; k < n; ++k) {
      ChainLink link;
      link.length = size * random(0.3, 1.5);
      link.centre = link.length * random(0.2, 0.8);
      link.mass = mass * std::exp(random(-1.5, 1.5));
      link.inertia = link.mass * link.length * link.length * random(0.05, 0.2);
      link.spring = stiff * std::exp(random(0, 2));
      link.angle = angle;
      chain.links.push_back(link);
    }
    const double whole = chain.links.back().length * random(0.5, 1);
    chain.forces.push_back({n - 1, whole, -stiff / size, 0});
    m = chain.masses();
    k_1 = chain.stiffness();
    UnsymmetricChain unloaded = chain;
    unloaded.forces.clear();
    k_0 = unloaded.stiffness();
  }

  std::vector<WideValue> omega2(Wide load) const {
    return eigenvalues<Wide>(ReferenceFactors<Wide>(m).solve_all(k_0 + load * (k_1 - k_0)));
  }
  /// Mean and D of the two values for which `measure` of both is least.
  template <class Measure>
  std::pair<WideValue, Wide> two_of(Wide load, Measure measure) const {
    const std::vector<WideValue> values = omega2(load);
    Wide least = INFINITY;
    std::pair<WideValue, Wide> best{0, INFINITY};
    for (std::size_t i = 0; i < values.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const WideValue mean = (values[i] + values[j]) / Wide(2), half = (values[i] - values[j]) / Wide(2);
        const Wide measured = measure(mean, half);
        if (measured < least) best = {mean, (half * half).real()};
        least = std::min(least, measured);
      }
    }
    return best;
  }
  /// The load near this one; nothing where the secant rule does not settle.
  std::optional<Wide> flutter_near(Wide load) const {
    const WideValue met = two_of(load, [](WideValue, WideValue half) { return std::abs(half); }).first;
    const auto d = [&](Wide at) {
      return two_of(at, [&](WideValue mean, WideValue half) { return std::abs(mean - met) + std::abs(half); }).second;
    };
    Wide a = load * (1 - 1e-4L), b = load * (1 + 1e-4L), da = d(a), db = d(b);
    for (int k = 0; k < 30 && std::abs(b - a) > 1e-18L * std::abs(load) && da != db; ++k) {
      const Wide next = b - db * (b - a) / (db - da);
      a = b;
      da = db;
      b = next;
      db = d(b);
    }
    if (!(std::abs(b - load) < 1e-6L * std::abs(load))) return std::nullopt;
    return b;
  }
};

/// Adds the parameter and an angle of a path that flutters; how it went, in words.
inline std::string add_flutter_digits(unsigned seed, ClaimedDigits& claims) {
  RandomNumbers random(seed);
  const FlutteringChain chain(random);
  const double to = random(3, 40);
  const TextRun run = run_text("{\"catena\": 1, \"parameters\": {\"P\": 0}, " + chain.chain.scene("P") +
                               R"(, "outputs": ["l1.angle"], "analyses": [{"type": "path", "parameter": "P", "to": )" +
                               text_of(to) + "}]}");
  if (run.outcome.exit_code > 1) return "not valid: " + run.outcome.error_text;
  const AnalysisResult& path = run.analysis();
  if (!path.report.ok()) return std::string(to_string(path.report.status));
  std::vector<long double> loads, angles;
  for (const double load : run.column("P")) loads.push_back(load);
  angles.assign(loads.size(), chain.chain.links[1].angle);
  int flutters = 0;
  for (const NamedField& f : path.fields) {
    if (f.name != "critical") continue;
    for (const FieldRecord& record : std::get<std::vector<FieldRecord>>(f.value)) {
      if (std::get<std::string>(record[0].second) != "flutter") continue;
      const auto row = static_cast<std::size_t>(std::get<std::int64_t>(record[2].second));
      const auto load = chain.flutter_near(loads.at(row));
      if (!load) return "not compared";
      loads[row] = *load;
      ++flutters;
    }
  }
  if (flutters == 0) return "no flutter";
  if (path.digits.empty()) return "no claim";
  claims.add(run, "P", loads, "flutter " + std::to_string(seed));
  claims.add(run, "l1.angle", angles, "flutter " + std::to_string(seed));
  return "compared";
}

}  // namespace catena::testing
