// Random scenes that the JSON Schema allows.
//
// The schema says which keys there are and what stands under them; here is only what it does not say: names that exist,
// sizes that keep a run short, lists that increase. About a third of the scenes are without errors.
#pragma once

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <set>
#include <string>
#include <vector>

namespace catena::testing {

using Json = nlohmann::ordered_json;

class SchemaScene {
 public:
  SchemaScene(const Json& schema, unsigned seed) : schema_(schema), random_(seed) {}

  Json make() {
    bodies_ = 1 + pick(4);
    Json scene = {{"catena", 1}, {"gravity", {0, -9.81}}};
    scene["parameters"] = {{"p", positive()}, {"q", {{"value", number()}}}};
    for (int b = 0; b < bodies_; ++b) scene["bodies"][body(b)] = any_body();
    for (const char* list : {"constraints", "drivers", "forces"}) {
      const std::string entry = std::string(list).substr(0, std::string(list).size() - 1);
      scene[list] = Json::array();
      const int some = list[0] == 'd' ? pick(2) : pick(3);
      for (int k = some; k > 0; --k) scene[list].push_back(any_element(entry));
    }
    for (const char* key : {"replicate", "columns", "tables", "outputs"}) {
      if (pick(6) == 0) scene[key] = value(schema_["properties"][key], key, 1);
    }
    scene["analyses"] = Json::array();
    for (int k = 1 + pick(2); k > 0; --k) scene["analyses"].push_back(value(def("analysis"), "analysis", 1));
    return scene;
  }

 private:
  int pick(int n) { return std::uniform_int_distribution<int>(0, n - 1)(random_); }
  double uniform(double a, double b) { return std::uniform_real_distribution<double>(a, b)(random_); }
  /// Few digits: lists are read by people when something is wrong with them.
  double rounded(double x) { return std::round(x * 1000) / 1000; }
  double number() { return pick(6) ? rounded(uniform(-2, 2)) : pick(3) - 1; }
  double positive() { return rounded(uniform(0.1, 2)); }
  const Json& def(const std::string& name) const { return schema_["$defs"][name]; }
  std::string body(int b) const { return "b" + std::to_string(b); }
  std::string some_body() { return body(pick(bodies_)); }
  std::string column() {
    static const std::vector<std::string> of{".x", ".y", ".angle", ".vx", ".omega", ".ay"};
    if (!elements_.empty() && pick(4) == 0) {
      const std::string& name = elements_[static_cast<std::size_t>(pick(static_cast<int>(elements_.size())))];
      static const std::vector<std::string> values{".length", ".force", ".angle", ".fx", ".value", ".gap", ".slide"};
      return name + values[static_cast<std::size_t>(pick(static_cast<int>(values.size())))];
    }
    return pick(8) ? some_body() + of[static_cast<std::size_t>(pick(static_cast<int>(of.size())))] : "energy.total";
  }
  Json element_name() {
    return elements_.empty() ? Json("none")
                             : Json(elements_[static_cast<std::size_t>(pick(static_cast<int>(elements_.size())))]);
  }

  Json attachment() {
    if (pick(4) == 0) return some_body();
    if (pick(8) == 0) return "ground";
    return {pick(4) ? some_body() : "ground", {number(), number()}};
  }
  Json any_body() {
    Json made = value(def("body"), "body", 0);
    if (!made.contains("parts") && !made.contains("rod")) {
      made["mass"] = positive();
      made["inertia"] = positive();
    }
    if (made.contains("parts")) made.erase("mass"), made.erase("inertia"), made.erase("centroid");
    if (made.contains("rod")) made.erase("position"), made.erase("angle"), made.erase("parts");
    return made;
  }
  Json any_element(const std::string& entry) {
    Json made = value(def(entry), entry, 0);
    made["name"] = "e" + std::to_string(elements_.size());
    elements_.push_back(made["name"]);
    // A place for both bodies, or their own; bodies that differ.
    if (made.contains("at")) {
      for (const char* end : {"i", "j"})
        if (made.contains(end)) made[end] = some_body();
    }
    if (made.contains("i") && made.contains("j") && name_of(made["i"]) == name_of(made["j"])) {
      if (name_of(made["i"]) == "ground")
        made["j"] = some_body();
      else
        made["i"] = made.contains("at") ? Json("ground") : Json({"ground", {number(), number()}});
    }
    return made;
  }
  static std::string name_of(const Json& attached) { return attached.is_array() ? attached[0] : attached; }

  /// One that design analyses can take.
  Json inner_analysis() {
    static const std::vector<std::string> types{"kinematics", "inverse_dynamics", "dynamics", "equilibrium", "modes"};
    const std::string type = types[static_cast<std::size_t>(pick(5))];
    for (const Json& one : def("analysis")["anyOf"])
      if (one["properties"]["type"]["const"] == type) return value(one, "analysis", 3);
    return {};
  }
  /// Increasing numbers, or pairs whose first ones increase.
  Json rising(bool pairs) {
    Json list = Json::array();
    double x = number();
    for (int k = 2 + pick(4); k > 0; --k, x = rounded(x + positive()))
      list.push_back(pairs ? Json({x, positive()}) : Json(x));
    return list;
  }

  /// What the schema does not say, by the key under which it stands.
  Json known(const std::string& key) {
    if (key == "until") return rounded(uniform(0.05, 0.5));
    if (key == "every" || key == "step") return rounded(uniform(0.005, 0.1));
    if (key == "max_steps") return 300 + pick(1000);
    if (key == "max_evaluations" || key == "samples") return 1 + pick(12);
    if (key == "count" || key == "starts" || key == "branch" || key == "find" || key == "seed") return 1 + pick(3);
    if (key == "tolerance") return std::pow(10.0, -4 - pick(6));
    if (key == "arc") return rounded(uniform(0.02, 0.3));
    if (key == "exponent") return 1 + 0.5 * pick(3);
    if (key == "restitution") return 0.25 * pick(5);
    if (key == "parameter" || key == "parameters") return pick(2) ? "p" : "q";
    if (key == "element" || key == "joint") return element_name();
    if (key == "minimise" || key == "maximise") return pick(2) ? "m" : "=m^2 + p";
    if (key == "subject_to") return "=m <= 3";
    if (key == "unit") return "m/s";
    if (key == "variable") return "n";
    if (key == "value of column") return "=" + column() + " - p*" + column();
    return pick(5) ? Json(column()) : Json("=" + column() + "^2 + " + column());
  }

  Json object(const Json& schema, const std::string& key, int depth) {
    Json made = Json::object();
    // Of several ways to give an object the first: the others are files, which are not there.
    const Json& demands = schema.contains("anyOf") ? schema["anyOf"][0] : schema;
    const std::set<std::string> required = demands.value("required", std::set<std::string>{});
    const Json none = Json::object();
    const Json& properties = schema.contains("properties") ? schema["properties"] : none;
    const int most = schema.value("maxProperties", 99);
    for (const auto& [name, entry] : properties.items()) {
      if (name == "name" || name == "description" || name == "file") continue;
      const bool of_file = name == "columns" || name == "unit" || name == "smooth";
      if ((of_file && properties.contains("file")) || (name == "points" && required.contains("angle"))) continue;
      const bool effort = name == "until" || name == "max_steps" || name == "max_evaluations" || name == "samples";
      if (required.contains(name) || effort || (most > 1 && pick(4) == 0)) made[name] = value(entry, name, depth + 1);
    }
    if (most == 1 && !properties.empty()) {
      auto one = properties.begin();
      std::advance(one, pick(static_cast<int>(properties.size())));
      made[one.key()] = value(one.value(), one.key(), depth + 1);
    }
    if (schema.contains("additionalProperties") && schema["additionalProperties"].is_object()) {
      const std::string name = own_name(key);
      const bool parameter = name == "p" || name == "q";
      made[name] = value(schema["additionalProperties"], parameter ? "plain" : "own", depth + 1);
    }
    mend(made);
    return made;
  }
  /// What may be called by a name of its own under a key: what the rest of the scene refers to.
  std::string own_name(const std::string& key) {
    static const std::map<std::string, std::string> names{
        {"points", "tip"}, {"columns", "u"}, {"tables", "w"}, {"measures", "m"}, {"bodies", "r{k}"}};
    const auto known_name = names.find(key);
    return known_name != names.end() ? known_name->second : pick(2) ? "p" : "q";
  }

  /// Keys that exclude or need each other.
  void mend(Json& made) {
    const auto keep_one = [&](std::vector<const char*> keys) {
      bool found = false;
      for (const char* key : keys) {
        if (!made.contains(key)) continue;
        if (found) made.erase(key);
        found = true;
      }
      return found;
    };
    const std::string type = made.contains("type") && made["type"].is_string() ? made["type"].get<std::string>() : "";
    if (made.contains("until")) made.erase("at");
    if (made.contains("beyond") && !made.contains("x") && !made.contains("t")) made["points"] = rising(true);
    if (made.contains("points")) made.erase("x"), made.erase("y"), made.erase("t"), made.erase("value");
    for (const auto& [x, y] : {std::pair("x", "y"), std::pair("t", "value"), std::pair("angle", "radius")}) {
      if (made.contains(x) && made[x].is_array()) made[y] = made[x];
    }
    if (made.contains("periodic") || made.value("end", Json()) == "periodic") made["end"] = "natural";
    if (made.contains("width") || made.contains("height")) made["width"] = made["height"] = positive();
    if (made.contains("impulse")) made.erase("action"), made.erase("element");
    if (made.contains("action")) {
      made.erase("element");
      if (made["action"] == "release" || made["action"] == "engage") made["element"] = element_name();
    }
    if (made.contains("element") && !made.contains("action")) made.erase("element");
    if (made.contains("mu") && made.contains("at")) made["mu"] = 0;
    if (made.contains("pulley")) made["radius"] = positive();
    if (type == "spring_damper" || type == "bushing") made[type[0] == 's' ? "k" : "kx"] = positive();
    if (type == "coupler") made.erase("length");
    if ((type == "coupler" || type.ends_with("_distance")) && made.contains("value")) made["value"] = positive();
    if (type == "torque") made["i"] = some_body();
    if (type == "stop") made["column"] = some_body() + ".x", made["min"] = -positive();
    if (made.contains("first")) made["first"] = pick(3);
    if (type == "cam_flat") made["curve"] = {{"circle", {{"centre", {number(), 0}}, {"radius", positive()}}}};
    for (const char* alone : {"absolute_", "point_force"}) {
      if (type.starts_with(alone)) made["i"] = {some_body(), {number(), number()}};
    }
    if (type == "optimise") {
      made.erase("maximise");
      made["minimise"] = "m";
      made["variables"] = {{"p", {{"min", 0.1}, {"max", 2}}}};
    }
    if (type == "sensitivity") made["parameters"] = {"p"};
    if (made.contains("of") && made["of"].is_object() && type != "") {
      const std::string inner = made["of"]["type"];
      if (inner == "modes")
        made["of"]["measures"] = {{"m", {{"field", "omega2[1]"}}}};
      else
        made["of"]["measures"] = {{"m", {{inner == "equilibrium" ? "final" : "max", column()}}}};
    } else if (type == "equilibrium" || type == "path" || type == "buckling" || type == "modes") {
      made.erase("measures");
    }
    keep_one({"rectangle", "disc", "polygon", "line"});
  }
  Json shape() {
    Json made = part();
    made.erase("mass"), made.erase("inertia"), made.erase("centroid");
    if (made.empty()) made["line"] = {{0, 0}, {number(), 1}};
    return made;
  }
  /// A part of a body: a mass at a place, or a shape with a mass.
  Json part() {
    Json made = {{"mass", positive()}};
    switch (pick(4)) {
      case 0:
        made["centroid"] = {number(), number()};
        made["inertia"] = positive();
        break;
      case 1:
        made["rectangle"] = {{"centre", {number(), number()}}, {"width", positive()}, {"height", positive()}};
        break;
      case 2:
        made["disc"] = {{"centre", {number(), number()}}, {"radius", positive()}};
        break;
      default:
        made["polygon"] = {{0, 0}, {positive(), 0}, {0, positive()}};
    }
    return made;
  }

  Json value(const Json& schema, const std::string& key, int depth) {
    static const std::set<std::string> effort{"until",   "every",     "step", "max_steps", "max_evaluations",
                                              "samples", "count",     "seed", "starts",    "branch",
                                              "find",    "tolerance", "arc",  "exponent",  "restitution"};
    if (effort.contains(key)) return known(key);
    if (key == "of" && schema.contains("anyOf")) return inner_analysis();
    if (key == "x" || key == "t") return rising(false);
    if (key == "draw" && schema.value("type", "") == "object") return shape();
    if (schema.contains("pattern")) return key == "subject_to" ? known(key) : Json("=" + column() + " + p");
    if (schema.contains("$ref")) {
      const std::string name = schema["$ref"].get<std::string>().substr(8);
      if (name == "attachment") return attachment();
      if (key == "plain" && name == "number") return positive();
      if (name == "number") return pick(8) ? Json(number()) : Json(pick(2) ? "=2*p - q" : "p");
      if (name == "positive" || name == "notNegative") return pick(8) ? Json(positive()) : Json("p");
      if (name == "numbersOrFile") return rising(false);
      if (name == "pairsOrFile") return rising(true);
      if (name == "function" && (depth > 4 || pick(2))) return number();
      if (name == "analysis") return inner_analysis();
      if (name == "block" && depth > 5) return {{"count", 1}};
      if (name == "eventBlock") return {{"count", 2}, {"events", {{{"when", some_body() + ".x"}, {"value", "=k"}}}}};
      return value(def(name), key, depth);
    }
    if (schema.contains("const")) return schema["const"];
    if (schema.contains("enum"))
      return schema["enum"][static_cast<std::size_t>(pick(static_cast<int>(schema["enum"].size())))];
    for (const char* several : {"anyOf", "allOf"}) {
      if (!schema.contains(several) || schema.contains("properties")) continue;
      const int count = several[1] == 'n' ? static_cast<int>(schema[several].size()) : 1;
      return value(schema[several][static_cast<std::size_t>(pick(count))], key, depth);
    }
    const std::string type = schema["type"].is_array() ? schema["type"][0] : schema["type"];
    if (type == "object") return key == "parts" ? part() : object(schema, key, depth);
    if (type == "array") {
      Json list = Json::array();
      const int least = std::max(1, schema.value("minItems", 0)), most = schema.value("maxItems", least + 2);
      for (int k = least + pick(most - least + 1); k > 0; --k) list.push_back(value(schema["items"], key, depth + 1));
      return list;
    }
    if (type == "boolean") return pick(2) == 1;
    if (type == "number" || type == "integer") return schema.contains("minimum") ? Json(1 + pick(3)) : Json(positive());
    return known(key);
  }

  const Json& schema_;
  std::mt19937 random_;
  int bodies_ = 1;
  std::vector<std::string> elements_;
};

}  // namespace catena::testing
