// A random mechanism through every analysis, in its own units and in others: whether all that comes out is the same.
// See random_invariance_test.cpp.
//
//   value of a column in other units = value x length^a mass^b time^c        a, b, c: of the column's unit
#pragma once

#include <sstream>

#include "stress/random_invariance.hpp"

namespace catena::testing {

/// What a number of this unit is multiplied by: "kg m^2/s", "N m/rad", "1".
inline double unit_factor(const std::string& unit, const Transformation& t) {
  const std::map<std::string, double> factors = {{"1", 1},
                                                 {"", 1},  // of a parameter without a unit
                                                 {"rad", 1},
                                                 {"m", t.length},
                                                 {"kg", t.mass},
                                                 {"s", t.time},
                                                 {"N", t.mass * t.length / t.time / t.time},
                                                 {"J", t.mass * t.length * t.length / t.time / t.time},
                                                 {"W", t.mass * t.length * t.length / t.time / t.time / t.time}};
  double product = 1;
  bool below = false;
  std::string word;
  const auto multiply = [&] {
    const std::size_t hat = word.find('^');
    const int power = hat == std::string::npos ? 1 : std::stoi(word.substr(hat + 1));
    product *= std::pow(factors.at(word.substr(0, hat)), below ? -power : power);
    word.clear();
  };
  for (const char c : unit) {
    if (c != ' ' && c != '/') {
      word += c;
      continue;
    }
    multiply();
    below = c == '/';
  }
  multiply();
  return product;
}

/// A mechanism that drivers move, as far as they can, or that a load P presses; with all that can be done with it.
class ManyAnalyses {
 public:
  explicit ManyAnalyses(unsigned seed)
      : random_(seed, seed % 3 == 0 ? RandomScene::Forces::moving : RandomScene::Forces::still) {
    Json analyses = Json::array();
    for (const char* type : {"check", "assemble"}) analyses.push_back({{"type", type}, {"from", "initial"}});
    const double until = random_.uniform(0.1, 1) / random_.pace;
    if (seed % 3 == 0) {
      for (int k = 0; k < 12; ++k) add_driver_of_what_is_free();
      for (const char* type : {"kinematics", "inverse_dynamics", "dynamics"})
        analyses.push_back({{"type", type}, {"from", "initial"}, {"until", until}, {"every", until / 2}});
    } else if (seed % 3 == 1) {
      random_.set_moving();
      analyses.push_back({{"type", "modes"}, {"from", "initial"}, {"count", 30}});
      analyses.push_back({{"type", "dynamics"}, {"from", "initial"}, {"until", until}, {"every", until / 2}});
    } else {
      add_load();
      for (const char* type : {"equilibrium", "modes", "buckling", "path"}) analyses.push_back({{"type", type}});
      analyses[2]["from"] = "initial";
      analyses[3]["count"] = 30;
      analyses[4]["parameter"] = analyses[5]["parameter"] = "P";
      analyses[5]["to"] = 1;
      analyses[5]["max_steps"] = 200;
    }
    // Some bodies are driven out of sight, where a motion takes a million steps to its refusal.
    for (Json& analysis : analyses) {
      if (analysis["type"] == "dynamics") analysis["max_steps"] = 5000;
    }
    random_.scene["analyses"] = std::move(analyses);
    set_outputs();
  }

  const RandomScene& random() const { return random_; }
  /// In other units. The load's components are expressions of P, which has none.
  Json scene(const Transformation& t) const {
    Json scene = TransformedScene(random_.scene, t).scene();
    bool is_loaded = false;
    for (Json& force : scene["forces"]) {
      if (!force.contains("name")) continue;
      for (Json& part : force["force"]) part = "=P*(" + part.dump() + ")";
      is_loaded = true;
    }
    if (is_loaded) scene["parameters"] = {{"P", 0}};
    return scene;
  }
  std::string describe() const {
    std::string text;
    for (const std::string& type : random_.types) text += " " + type;
    return text;
  }

 private:
  void add_driver_of_what_is_free() {
    DenseMechanism& dense = random_.dense;
    const auto before = dense.independent_rows(0, random_.q).size();
    random_.add_driver();
    if (dense.independent_rows(0, random_.q).size() > before) {
      Json& drivers = random_.scene["drivers"];
      drivers[drivers.size() - 1]["name"] = "d" + std::to_string(drivers.size() - 1);
      return;
    }
    dense.rows.pop_back();
    random_.scene["drivers"].erase(random_.scene["drivers"].size() - 1);
  }
  void add_load() {
    const double bodies = static_cast<double>(random_.dense.bodies.size());
    const int body = random_.pick(static_cast<int>(bodies));
    const double weight = double(random_.dense.bodies[static_cast<std::size_t>(body)].mass) * 9.81;
    const double turn = random_.uniform(-3, 3), strength = weight * std::pow(10.0, random_.uniform(-1, 1));
    random_.scene["forces"].push_back({{"type", "point_force"},
                                       {"name", "load"},
                                       {"i", {"b" + std::to_string(body), {0.3 * random_.size, 0.1 * random_.size}}},
                                       {"force", {strength * std::cos(turn), strength * std::sin(turn)}}});
  }
  void set_outputs() {
    Json outputs = Json::array();
    for (std::size_t b = 0; b < random_.dense.bodies.size(); ++b) outputs.push_back("b" + std::to_string(b));
    for (std::size_t d = 0; d < random_.scene["drivers"].size(); ++d)
      outputs.push_back("d" + std::to_string(d) + ".load");
    outputs.push_back("energy.kinetic");
    outputs.push_back("energy.potential");
    random_.scene["outputs"] = std::move(outputs);
  }

  RandomScene random_;
};

/// What differs in the first columns of two tables once one is in the units of the other, beside the largest of the
/// kind of each column: places of all bodies together, angles together. Below `nothing` is the rounding of
/// zeros.
inline std::string rows_apart(const ResultStorage& given, const ResultStorage& seen, std::size_t columns,
                              const Transformation& t, double allowed) {
  if (given.rows() != seen.rows() || given.columns().size() != seen.columns().size())
    return "tables of " + std::to_string(given.rows()) + " and " + std::to_string(seen.rows()) + " rows";
  constexpr double nothing = 1e-20;
  std::map<std::string, double> largest;
  for (std::size_t c = 0; c < given.columns().size(); ++c) {
    double& most = largest[std::string(given.columns()[c].unit_text())];
    for (std::size_t r = 0; r < given.rows(); ++r) {
      if (std::isfinite(given.at(r, c))) most = std::max(most, std::abs(given.at(r, c)));
    }
  }
  for (std::size_t c = 0; c < std::min(columns, given.columns().size()); ++c) {
    const std::string unit(given.columns()[c].unit_text());
    const double factor = unit_factor(unit, t);
    for (std::size_t r = 0; r < given.rows(); ++r) {
      const double a = given.at(r, c), b = seen.at(r, c) / factor;
      if (std::isnan(a) && std::isnan(b)) continue;
      if (!(std::abs(a - b) <= allowed * largest[unit] + nothing)) {
        std::ostringstream text;
        text << given.columns()[c].name << " of row " << r << " is " << a << ", in other units " << b;
        return text.str();
      }
    }
  }
  return "";
}

/// Units that are powers of four change no digit of any number nor of a square root: what differs has a length, a time
/// or a force of its own.
inline std::string fault_of_units(unsigned seed, std::map<std::string, int>& seen) {
  const ManyAnalyses many(seed);
  std::mt19937 random(seed + 77);
  Transformation t;
  for (double* unit : {&t.length, &t.mass, &t.time}) *unit = std::pow(4.0, static_cast<int>(random() % 31) - 15);
  const std::string text = many.scene(t).dump();
  keep_scene("analyses", seed, text);
  const TextRun first = run_text(many.scene({}).dump()), second = run_text(text);
  for (const TextRun* run : {&first, &second}) {
    if (run->outcome.exit_code > 1) return "not valid: " + run->outcome.error_text + many.describe();
  }
  const auto &a = first.outcome.analyses, &b = second.outcome.analyses;
  for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k) {
    const std::string said(to_string(a[k].report.status)), other(to_string(b[k].report.status));
    ++seen[a[k].type + " " + said];
    if (!a[k].report.ok()) show_refusal(seed, a[k].type + " " + a[k].report.message + many.describe());
    if (said != other)
      return a[k].type + " is " + said + ", in other units " + other + ": " + a[k].report.message +
             b[k].report.message + many.describe();
    if (!a[k].has_rows) continue;
    // The largest entry of a buckling shape is 1 rad or 1 m, whatever the size: its loads alone are compared.
    const std::size_t columns = a[k].type == "buckling" ? 1 : a[k].columns.size();
    const std::string fault = rows_apart(first.sink.rows.at(k), second.sink.rows.at(k), columns, t, 1e-9);
    if (!fault.empty()) return a[k].type + ": " + fault + many.describe();
  }
  return a.size() == b.size() ? "" : "more analyses run in other units" + many.describe();
}

}  // namespace catena::testing
