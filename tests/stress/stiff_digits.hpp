// Digits of random stiff mechanisms in motion by radau, alpha and `auto`, beside a dense formulation in long double.
#pragma once

#include "oracles/claimed_digits.hpp"
#include "stress/cases.hpp"
#include "stress/stiff_scene.hpp"

namespace catena::testing {

/// Adds the columns of one mechanism; how it went, in words.
inline std::string add_stiff_digits(unsigned seed, ClaimedDigits& claims) {
  RandomScene random(seed, RandomScene::Forces::moving);
  make_stiff(random);
  static const char* const methods[] = {"auto", "auto", "radau", "alpha"};
  const std::string method = methods[random.pick(4)];
  const int exponent = random.pick(method == "alpha" ? 3 : 8) + 3;
  const double until = random.uniform(0.3, 1) / random.pace;
  random.scene["analyses"] = {{{"type", "dynamics"},
                               {"until", until},
                               {"every", until / 4},
                               {"method", method},
                               {"tolerance", std::pow(10.0, -exponent)},
                               {"max_steps", 200000}}};
  random.scene["outputs"] = Json::array();
  static const char* const columns[] = {".x", ".y", ".angle", ".vx", ".vy", ".omega", ".ax", ".ay", ".alpha"};
  const Eigen::Index n = random.dense.size();
  for (Eigen::Index b = 0; b < n / 3; ++b) {
    for (const char* column : columns) random.scene["outputs"].push_back("b" + std::to_string(b) + column);
  }
  keep_scene("stiff_digits", seed, random.scene.dump(1));
  const TextRun run = run_text(random.scene.dump());
  if (run.outcome.exit_code > 1) return "not valid: " + run.outcome.error_text;
  const AnalysisResult& result = run.analysis();
  if (!result.report.ok()) return method + ": " + std::string(to_string(result.report.status));
  const auto word = [&](std::string_view name) {
    const auto field = std::ranges::find(result.fields, name, &NamedField::name);
    return field == result.fields.end() ? std::string() : std::get<std::string>(field->value);
  };
  const std::string used = word("method");
  if (result.digits.empty()) {
    show_refusal(seed, used + ": " + word("digits_note"));
    return used + ": no claim";
  }
  std::map<std::string, std::vector<long double>> exact;
  const auto keep = [&](std::size_t, const Vector& q, const Vector& v, const Vector& a) {
    for (Eigen::Index k = 0; k < n; ++k) {
      const std::string body = "b" + std::to_string(k / 3);
      exact[body + columns[k % 3]].push_back(q[k]);
      exact[body + columns[3 + k % 3]].push_back(v[k]);
      exact[body + columns[6 + k % 3]].push_back(a[k]);
    }
  };
  if (!follow_stiff_motion(random, random.v, run.column("t"), 1e-13L, keep)) return used + ": not compared";
  const std::string what = "seed " + std::to_string(seed) + " 1e-" + std::to_string(exponent) + " " + used;
  for (const auto& [column, values] : exact) {
    const auto place = std::find(std::begin(columns), std::end(columns), column.substr(column.find('.')));
    const double noise = 1e-13 * random.size * std::pow(random.pace, (place - std::begin(columns)) / 3);
    claims.add(run, column, values, what, 0, {}, noise);
  }
  return used + ": compared";
}

}  // namespace catena::testing
