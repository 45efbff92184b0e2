// A random mechanism and the same one seen otherwise: whether both answer the same. See random_invariance_test.cpp.
#pragma once

#include <map>

#include "scene/run_text.hpp"
#include "stress/cases.hpp"
#include "stress/dense_motion.hpp"
#include "stress/transformed_scene.hpp"

namespace catena::testing {

/// Places of the last row, x, y and angle of every body; empty where the run was not `ok`.
inline std::vector<double> last_places(const TextRun& run, std::size_t bodies) {
  std::vector<double> places;
  if (run.outcome.exit_code > 1 || !run.analysis().report.ok()) return places;
  for (std::size_t b = 0; b < bodies; ++b) {
    for (const char* column : {".x", ".y", ".angle"}) places.push_back(run.last("b" + std::to_string(b) + column));
  }
  return places;
}

/// The largest difference, in sizes and rad, once the first are seen by the transformation. Whole turns count.
inline double places_apart(const std::vector<double>& given, const std::vector<double>& seen, const Transformation& t,
                           double size) {
  double most = 0;
  for (std::size_t k = 0; k + 2 < given.size(); k += 3) {
    const Place p = t.place({given[k], given[k + 1]});
    const double apart[] = {(seen[k] - p.x) / t.length / size, (seen[k + 1] - p.y) / t.length / size,
                            seen[k + 2] - t.angle(given[k + 2])};
    for (const double part : apart) {
      if (!(std::abs(part) <= most)) most = std::isfinite(part) ? std::abs(part) : HUGE_VAL;
    }
  }
  return most;
}

struct InvarianceCase {
  RandomScene random;
  bool moves;
  double tolerance = 1e-9, until = 0;
  std::string which;

  explicit InvarianceCase(unsigned seed)
      : random(seed, seed % 2 ? RandomScene::Forces::moving : RandomScene::Forces::still) {
    moves = seed % 2;
    if (moves) {
      random.set_moving();
      static const char* const methods[] = {"auto", "rk8", "rk5", "adams", "baumgarte", "partitioning"};
      const std::string method = methods[random.pick(6)];
      until = random.uniform(0.2, 1) / random.pace;
      random.scene["analyses"] = {{{"type", "dynamics"},
                                   {"until", until},
                                   {"every", until},
                                   {"method", method},
                                   {"tolerance", tolerance},
                                   {"max_steps", 100000}}};
      which = method;
    } else {
      random.scene["analyses"] = {{{"type", "equilibrium"}}};
      which = "equilibrium";
    }
    for (const std::string& type : random.types) which += " " + type;
  }
  TextRun run() const { return run_text(random.scene.dump()); }
  /// What errors of the tolerance may become; equilibria are found to rounding by their condition.
  double allowed() const {
    if (!moves) return 1e-6;
    const std::vector<double> instants{until};
    const std::vector<Vector> known = dense_motion(random, random.v, instants);
    return known.empty() ? HUGE_VAL : 100 * tolerance * growth(random, instants, known[0]);
  }
};

inline std::string compare(unsigned seed, const InvarianceCase& c, const Json& other, const Transformation& t,
                           double least, const char* kind, std::map<std::string, int>& seen) {
  const TextRun first = c.run(), second = run_text(other.dump());
  keep_scene(kind, seed, other.dump(1));
  if (second.outcome.exit_code > 1) return "not valid: " + second.outcome.error_text + c.which;
  const AnalysisReport &a = first.analysis().report, &b = second.analysis().report;
  const std::string outcome = a.status == b.status
                                  ? std::string(to_string(a.status))
                                  : std::string(to_string(a.status)) + "|" + std::string(to_string(b.status));
  ++seen[outcome];
  if (a.status != b.status) {
    show_refusal(seed, outcome + " " + a.message + b.message + " " + c.which);
    // A refusal that comes and goes with units is a fault; otherwise rounding may decide.
    return least == 0 ? "status " + outcome + ": " + a.message + b.message + " " + c.which : "";
  }
  if (!a.ok()) return "";
  const std::size_t bodies = c.random.dense.bodies.size();
  const double apart = places_apart(last_places(first, bodies), last_places(second, bodies), t, c.random.size);
  if (apart <= (least > 0 ? least : 1e-9)) return "";
  if (least > 0 && apart <= c.allowed()) return ++seen["(within growth)"], "";
  // Another place of rest may be as good as the first.
  if (!c.moves && least > 0) return ++seen["(another place)"], "";
  return "places differ by " + std::to_string(std::log10(apart)) + " (log10) " + c.which;
}

/// In units that are powers of four: no digit of any number changes, nor of a square root.
inline std::string fault_in_other_units(unsigned seed, std::map<std::string, int>& seen) {
  InvarianceCase c(seed);
  Transformation t;
  t.length = std::pow(4.0, c.random.pick(21) - 10);
  t.mass = std::pow(4.0, c.random.pick(21) - 10);
  t.time = std::pow(4.0, c.random.pick(21) - 10);
  return compare(seed, c, TransformedScene(c.random.scene, t).scene(), t, 0, "units", seen);
}

/// A million sizes away a place is known to 1e-10 of the size, and so are the lengths that the scene means.
inline std::string fault_far_away(unsigned seed, std::map<std::string, int>& seen) {
  InvarianceCase c(seed);
  Transformation t;
  const double away = c.random.uniform(-3, 3);
  t.shift = turned({1e6 * c.random.size, 0}, away);
  return compare(seed, c, TransformedScene(c.random.scene, t).scene(), t, 1e-7, "far", seen);
}

/// With bodies, constraints and forces in another order. Which of equal ways is taken may depend on it; places may not.
inline std::string fault_in_other_order(unsigned seed, std::map<std::string, int>& seen) {
  InvarianceCase c(seed);
  std::mt19937 random(seed);
  Json other = c.random.scene, bodies = Json::object();
  for (const char* list : {"constraints", "forces"}) std::shuffle(other[list].begin(), other[list].end(), random);
  std::vector<std::string> names;
  for (const auto& [name, body] : other["bodies"].items()) names.push_back(name);
  std::shuffle(names.begin(), names.end(), random);
  for (const std::string& name : names) bodies[name] = other["bodies"][name];
  other["bodies"] = bodies;
  return compare(seed, c, other, {}, 1e-8, "order", seen);
}

/// Part of the cases that ended `ok` in which no places were compared, as another place of rest was found.
inline double part_not_compared(const std::map<std::string, int>& seen) {
  const auto count = [&](const char* what) { return seen.contains(what) ? seen.at(what) : 0; };
  return count("ok") > 0 ? double(count("(another place)")) / count("ok") : 0;
}

/// Part of the cases with an answer in one of both runs alone.
inline double part_answered_once(const std::map<std::string, int>& seen) {
  int all = 0, once = 0;
  for (const auto& [outcome, n] : seen) {
    if (outcome.starts_with('(')) continue;
    all += n;
    if (outcome.find('|') != std::string::npos) once += n;
  }
  return all > 0 ? static_cast<double>(once) / all : 1;
}

}  // namespace catena::testing
