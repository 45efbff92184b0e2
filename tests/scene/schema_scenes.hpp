// What must hold of the results of any scene that the JSON Schema allows, whatever it means: they are well formed, the
// same in a second run and for the same scene in other words, and counts do not depend on the order of the parts.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "scene/run_text.hpp"
#include "scene/schema_scene.hpp"

namespace catena::testing {

/// Outcomes by exit code and by status, with how often each came.
using Outcomes = std::map<std::string, int>;

/// The result document of a scene without what may differ between runs.
inline Json results_of(const std::string& text, SceneOutcome& outcome) {
  TemporaryFolder folder;
  const std::string out = folder / "out.json";
  TextOutput output = TextOutput::file(out);
  const std::unique_ptr<ResultSink> sink = json_result_sink(output);
  RunOptions options;
  options.text = text;
  options.max_elements = 500;
  outcome = run_scene("scene.json", options, *sink);
  output.commit();
  if (outcome.exit_code >= 2) return Json::parse(invalid_json(outcome));
  Json results = Json::parse(read_file(out));
  for (Json& analysis : results["analyses"]) analysis.erase("seconds");
  return results;
}

/// The same scene with its numbers as expressions, wherever any kind of number may stand.
inline void write_as_expressions(Json& value) {
  for (Json& entry : value) {
    if (entry.is_number())
      entry = "=" + entry.dump();
    else if (entry.is_array())
      write_as_expressions(entry);
  }
}

/// What is wrong with the results of a scene, in words; empty: nothing.
inline std::string schema_scene_fault(const Json& scene, Outcomes& seen) {
  static const std::set<std::string> statuses{"ok",          "not_assembled", "under_driven",  "lock_up",
                                              "bifurcation", "singular",      "inconsistent",  "infeasible",
                                              "unbounded",   "refused",       "not_converged", "step_too_small"};
  SceneOutcome outcome, again;
  const Json results = results_of(scene.dump(1), outcome);
  if (outcome.exit_code != 0 && outcome.exit_code != 1 && outcome.exit_code != 3)
    return "exit code " + std::to_string(outcome.exit_code) + " " + outcome.error_text;
  if (outcome.exit_code == 3) {
    ++seen["not valid"];
    if (outcome.errors.empty()) return "an error without words";
    for (const Diagnostic& error : outcome.errors) {
      if (error.message.find("unknown key") != std::string::npos)
        return "the schema allows what is no key: " + error.message;
    }
  } else {
    bool all_ok = true;
    for (const Json& analysis : results["analyses"]) {
      const std::string status = analysis["status"];
      ++seen[status];
      all_ok = all_ok && status == "ok";
      if (!statuses.contains(status)) return "status " + status;
      if ((status == "ok") != analysis["message"].get<std::string>().empty()) return status + " and its message";
      for (const char* internal : {"std::", "vector", "map::at", "basic_string", "Eigen"}) {
        if (analysis["message"].get<std::string>().find(internal) != std::string::npos) return analysis["message"];
      }
      if (!analysis.contains("columns")) continue;
      if (analysis["columns"].size() != analysis["units"].size()) return "columns and units";
      for (const Json& row : analysis["rows"]) {
        if (row.size() != analysis["columns"].size()) return "a row of another length";
      }
    }
    if (all_ok != (outcome.exit_code == 0)) return "exit code and statuses";
  }
  if (results_of(scene.dump(1), again) != results) return "another run, another result";
  Json written = scene;
  for (Json& body : written["bodies"]) {
    for (const char* key : {"position", "velocity"})
      if (body.contains(key)) write_as_expressions(body[key]);
  }
  Json other = results_of(written.dump(-1, ' ', true), again);
  if (again.exit_code == 3) return outcome.exit_code == 3 ? "" : "not valid with numbers as expressions";
  if (other != results) return "the same text in other words, another result";
  return "";
}

/// What numbers of bodies and equations there are does not depend on their order.
inline std::string order_fault(const Json& scene) {
  Json forwards = scene, backwards = scene;
  forwards["analyses"] = backwards["analyses"] = Json::array({{{"type", "check"}}});
  forwards.erase("outputs");
  backwards.erase("outputs");
  Json bodies = Json::object();
  std::vector<std::string> names;
  for (const auto& [name, body] : scene["bodies"].items()) names.push_back(name);
  for (auto name = names.rbegin(); name != names.rend(); ++name) bodies[*name] = scene["bodies"][*name];
  backwards["bodies"] = bodies;
  for (const char* list : {"constraints", "drivers", "forces"}) {
    Json& entries = backwards[list];
    std::reverse(entries.begin(), entries.end());
  }
  SceneOutcome one, two;
  const Json a = results_of(forwards.dump(), one), b = results_of(backwards.dump(), two);
  if (one.exit_code != two.exit_code) return "the order of the parts decides whether it is valid";
  if (one.exit_code == 3) return "";
  for (const char* key : {"status", "bodies", "rows", "rank", "dof", "mobility", "islands"}) {
    const Json &x = a["analyses"][0], &y = b["analyses"][0];
    if (x.contains(key) != y.contains(key) || (x.contains(key) && x[key] != y[key]))
      return std::string("the order of the parts decides about ") + key + ": " + x.value(key, Json()).dump() + " " +
             y.value(key, Json()).dump();
  }
  return "";
}

/// Scenes of the seeds from `first` on; each within `most_seconds`.
inline Outcomes run_schema_scenes(unsigned first, int count, double most_seconds) {
  const Json schema = Json::parse(schema_json());
  Outcomes seen;
  int wrong = 0;
  for (unsigned seed = first; seed < first + static_cast<unsigned>(count) && wrong < 20; ++seed) {
    const Json scene = SchemaScene(schema, seed).make();
    const auto start = std::chrono::steady_clock::now();
    std::string fault = schema_scene_fault(scene, seen);
    if (fault.empty()) fault = order_fault(scene);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (fault.empty() && seconds > most_seconds) fault = "took " + std::to_string(seconds) + " s";
    wrong += !fault.empty();
    if (!fault.empty()) ADD_FAILURE() << "seed " << seed << ": " << fault << "\n" << scene.dump();
  }
  return seen;
}

}  // namespace catena::testing
