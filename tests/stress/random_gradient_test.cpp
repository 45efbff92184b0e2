// Derivatives of random mechanisms with respect to a number of their scene, against differences of runs: motions and
// equilibria, every number that a body, joint or force has.
//
//   D(h) = (O(p + h) - O(p - h)) / (2 h) = O_p + O_ppp h^2 / 6 ...      R = (4 D(h/2) - D(h)) / 3
//
// A derivative of an answer `ok` is a failure where it differs from R by more than D(h/2) and D(h) do, and by more than
// errors of the runs, divided by h, explain.
#include <gtest/gtest.h>

#include "oracles/random_seeds.hpp"
#include "scene/run_text.hpp"
#include "stress/cases.hpp"
#include "stress/random_scene.hpp"

namespace catena::testing {
namespace {

/// Places of numbers in a scene that may be chosen freely: all of elements and bodies that are not zero.
void find_numbers(const Json& at, const Json::json_pointer& here, std::vector<Json::json_pointer>& found) {
  if (at.is_number() && at.get<double>() != 0) found.push_back(here);
  if (at.is_object()) {
    for (const auto& [key, value] : at.items()) {
      if (key != "side" && key != "internal") find_numbers(value, here / key, found);
    }
  }
  for (std::size_t k = 0; at.is_array() && k < at.size(); ++k) find_numbers(at[k], here / k, found);
}

/// x, y and angle of every body at the end, in sizes and rad; empty where the run is not `ok`, or has other than `dof`
/// degrees of freedom: a parameter of a joint that is there twice may tie the mechanism where it has another value.
std::vector<double> places(const Json& scene, std::size_t bodies, double size, std::optional<int> dof) {
  const TextRun run = run_text(scene.dump());
  std::vector<double> all;
  if (run.outcome.exit_code > 0 || !run.analysis().report.ok() || run.analysis().report.dof != dof) return all;
  for (std::size_t b = 0; b < bodies; ++b) {
    const std::string name = "b" + std::to_string(b);
    all.push_back(run.last(name + ".x") / size);
    all.push_back(run.last(name + ".y") / size);
    all.push_back(run.last(name + ".angle"));
  }
  return all;
}

std::string gradient_fault(unsigned seed, std::map<std::string, int>& seen) {
  const bool moves = seed % 2;
  RandomScene random(seed, moves ? RandomScene::Forces::moving : RandomScene::Forces::still);
  Json inner = {{"type", "equilibrium"}};
  if (moves) {
    random.set_moving();
    const double until = random.uniform(0.1, 0.5) / random.pace;
    static const char* const methods[] = {"auto", "rk8", "rk5", "adams", "baumgarte", "partitioning"};
    inner = {{"type", "dynamics"}, {"until", until},     {"every", until}, {"method", methods[random.pick(6)]},
             {"tolerance", 1e-11}, {"max_steps", 100000}};
  }
  Json scene = random.scene;
  std::vector<Json::json_pointer> numbers;
  for (const char* key : {"gravity", "bodies", "constraints", "forces"})
    find_numbers(scene[key], Json::json_pointer() / key, numbers);
  if (numbers.empty()) return "";
  const Json::json_pointer where = numbers[static_cast<std::size_t>(random.pick(static_cast<int>(numbers.size())))];
  const double p = scene[where];
  scene[where] = "=p";
  scene["parameters"] = {{"p", p}};
  scene["analyses"] = {{{"type", "sensitivity"}, {"of", inner}, {"parameters", {"p"}}, {"mode", "forward"}}};
  keep_scene("gradient", seed, scene.dump(1));
  std::string which = where.to_string() + (moves ? " " + inner["method"].get<std::string>() : " equilibrium");
  for (const std::string& type : random.types) which += " " + type;
  const TextRun run = run_text(scene.dump());
  if (run.outcome.exit_code > 1) return "not valid: " + run.outcome.error_text + which;
  const AnalysisReport& report = run.analysis().report;
  ++seen[std::string(to_string(report.status))];
  if (!report.ok()) return show_refusal(seed, report.message + " " + which), "";

  if (!moves && !field<bool>(run, "stable")) return ++seen["(another place is as good)"], "";

  const std::size_t bodies = random.dense.bodies.size();
  scene["analyses"] = Json::array({inner});
  const double h = 2e-3;
  const auto at = [&](double part) {
    scene["parameters"]["p"] = p * (1 + part * h);
    return places(scene, bodies, random.size, report.dof);
  };
  const std::vector<double> row[] = {at(-1), at(-0.5), at(0.5), at(1)};
  for (const auto& r : row) {
    if (r.empty()) return ++seen["(not compared)"], "";
  }
  double most = 0;
  for (std::size_t k = 0; k < row[0].size(); ++k) most = std::max(most, std::abs(row[3][k] - row[0][k]) / (2 * h));
  if (most > 1e2) return ++seen["(too steep)"], "";
  for (std::size_t k = 0; k < row[0].size(); ++k) {
    static const char* const columns[] = {".x", ".y", ".angle"};
    const std::string column = "b" + std::to_string(k / 3) + columns[k % 3];
    const std::vector<double> given = run.column("d(" + column + ")/d(p)");
    if (given.empty()) return "no derivative of " + column + " " + which;
    if (!std::isfinite(given.back())) return ++seen["(none is given)"], "";
    const double d1 = (row[3][k] - row[0][k]) / (2 * h), d2 = (row[2][k] - row[1][k]) / h;
    const double known = (4 * d2 - d1) / 3, value = given.back() * p / (k % 3 == 2 ? 1 : random.size);
    // Another branch, or a motion that magnifies all.
    if (std::abs(d1 - d2) > 0.01 * (1 + most)) return ++seen["(differences do not agree)"], "";
    if (!(std::abs(value - known) <= 0.3 * std::abs(d1 - d2) + (moves ? 1e-6 : 1e-7) * (1 + most)))
      return "d(" + column + ") is " + std::to_string(value) + ", by differences " + std::to_string(known) + " +- " +
             std::to_string(std::abs(d1 - d2)) + " " + which;
  }
  return ++seen["(compared)"], "";
}

// Answers whose derivatives are not compared, of all that end `ok`: 17 % of 236.
constexpr double most_not_compared = 0.25;

TEST(RandomGradient, IsThatOfDifferences) {
  std::map<std::string, int> seen;
  expect_no_fault(first_case(), last_case(1000), [&](unsigned seed) { return gradient_fault(seed, seen); });
  print_shares("gradients of random mechanisms", seen);
  const auto count = [&](const char* what) { return seen.contains(what) ? seen.at(what) : 0; };
  EXPECT_LE(count("ok") - count("(compared)"), most_not_compared * count("ok"));
}

}  // namespace
}  // namespace catena::testing
