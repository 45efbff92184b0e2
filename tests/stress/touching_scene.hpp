// Random motions of contacts, stops, ropes and events, each in units that are asked for: the same motion, whatever its
// size, its masses and its pace. Where bodies are particles that touch lines no dimension of the scene is a length but
// the gap at the start, or the way in which weight stops what moves.
//
//   numbers x length^a mass^b time^c        a, b, c: of what they are
#pragma once

#include <random>

#include "scene/event_entries.hpp"
#include "stress/random_analyses.hpp"

namespace catena::testing {

class TouchingScene {
 public:
  static constexpr unsigned kinds = 12;

  TouchingScene(unsigned seed, const Transformation& units) : random_(seed), u_(units) {
    scene_["catena"] = 1;
    scene_["gravity"] = pair(0, -9.81 * u_.length / u_.time / u_.time);
    scene_["bodies"] = Json::object();
    for (const char* list : {"constraints", "forces", "outputs"}) scene_[list] = Json::array();
    until_ = uniform(1, 2);
    place_bodies(seed % kinds);
    finish();
  }
  std::string text() const { return scene_.dump(1); }

 private:
  double uniform(double low, double high) {
    return low + (high - low) * std::ldexp(static_cast<double>(random_() >> 1), -31);
  }
  static Json pair(double x, double y) {
    Json p = Json::array();
    p.push_back(x);
    p.push_back(y);
    return p;
  }
  Json place(double x, double y) const { return pair(u_.length * x, u_.length * y); }
  Json velocity(double x, double y) const { return pair(u_.length / u_.time * x, u_.length / u_.time * y); }
  Json end(const char* body, Json where) const {
    Json e = Json::array();
    e.push_back(body);
    e.push_back(std::move(where));
    return e;
  }
  Json line(double height, double slope) const {
    Json l;
    l["line"]["point"] = place(0, height);
    l["line"]["axis"] = pair(1, slope);
    return l;
  }
  Json circle(double x, double y, double radius) const {
    Json c;
    c["circle"]["centre"] = place(x, y);
    c["circle"]["radius"] = u_.length * radius;
    return c;
  }
  /// A particle where `inertia` is zero.
  Json& body(const char* name, double mass, double inertia, Json where, Json moves = Json()) {
    Json& b = scene_["bodies"][name];
    b["mass"] = u_.mass * mass;
    if (inertia > 0) b["inertia"] = u_.mass * u_.length * u_.length * inertia;
    if (inertia == 0) b["particle"] = true;
    b["position"] = std::move(where);
    if (!moves.is_null()) b["velocity"] = std::move(moves);
    for (const char* column : {".x", ".y", ".vx", ".vy"}) scene_["outputs"].push_back(std::string(name) + column);
    if (inertia > 0) scene_["outputs"].push_back(std::string(name) + ".angle");
    return b;
  }
  Json& force(const char* type, Json i, Json j) {
    Json f;
    f["type"] = type;
    f["name"] = "K" + std::to_string(scene_["forces"].size());
    f["i"] = std::move(i);
    f["j"] = std::move(j);
    scene_["outputs"].push_back(f["name"].get<std::string>() + ".force");
    scene_["forces"].push_back(std::move(f));
    return scene_["forces"].back();
  }
  void add_pin(const char* name, double x, double y, Json on_body) {
    Json c;
    c["type"] = "revolute";
    c["name"] = name;
    c["i"] = end("ground", place(x, y));
    c["j"] = std::move(on_body);
    scene_["constraints"].push_back(std::move(c));
  }

  void place_bodies(unsigned kind) {
    if (kind < 3) return particle_on_line(kind == 0 ? 0 : kind == 1 ? 1 : 1.5);
    if (kind < 5) return particle_on_cable(kind == 4);
    if (kind == 5) return off_a_drum();
    if (kind == 6) return disc_in_a_bowl();
    if (kind < 9) return pendulum(kind == 7);
    if (kind == 9) return block_on_feet();
    return kind == 10 ? two_discs() : events_at_zero();
  }
  /// Rigid where the exponent is zero.
  void particle_on_line(double exponent) {
    const double mass = uniform(0.5, 2), height = uniform(0, 1), slope = uniform(-0.3, 0.3), gap = uniform(0, 1);
    const double vx = uniform(-2, 2), vy = uniform(-1, 1), mu = uniform(0, 0.4), e = uniform(0, 0.7);
    body("b", mass, 0, place(0, height + (gap < 0.3 ? 0 : gap)), velocity(vx, gap < 0.3 ? 2 + vy : vy));
    Json& k = force("contact", "ground", "b");
    k["curve"] = line(height, slope);
    k["mu"] = mu;
    if (exponent == 0) {
      k["restitution"] = e;
    } else {
      const double stiffness = uniform(100, 1000), damping = uniform(0, 3);
      k["k"] = stiffness * u_.mass / u_.time / u_.time * std::pow(u_.length, 1 - exponent);
      k["exponent"] = exponent;
      k["c"] = damping * u_.mass / u_.time;
    }
  }
  void particle_on_cable(bool elastic) {
    const double x = uniform(-0.6, 0.6), y = uniform(-0.3, 0.3), vx = uniform(-1, 1), vy = uniform(-1, 1);
    body("b", uniform(0.5, 2), 0, place(x, y), velocity(vx, vy));
    Json& k = force("cable", end("ground", place(0, 0)), "b");
    k["length"] = u_.length;
    if (elastic) k["k"] = uniform(200, 1000) * u_.mass / u_.time / u_.time;
  }
  void off_a_drum() {
    const double angle = uniform(0.1, 0.5), radius = uniform(0.5, 2);
    body("b", uniform(0.5, 2), 0, place(radius * std::sin(angle), radius * std::cos(angle)));
    force("contact", "ground", "b")["curve"] = circle(0, 0, radius);
  }
  void disc_in_a_bowl() {
    const double bowl = uniform(1, 2), r = uniform(0.1, 0.3), angle = uniform(0.3, 1), mass = uniform(0.5, 2);
    body("b", mass, mass * r * r / 2, place((bowl - r) * std::sin(angle), -(bowl - r) * std::cos(angle)));
    Json& k = force("contact", "ground", "b");
    k["curve"] = circle(0, 0, bowl);
    k["radius"] = r * u_.length;
    k["side"] = -1;
    k["mu"] = uniform(0.05, 0.8);
  }
  /// Against a stop of its joint, or a floor under its end.
  void pendulum(bool stop) {
    const double mass = uniform(0.5, 2), half = uniform(0.3, 0.6), low = uniform(0.3, 0.8), e = uniform(0, 0.7);
    body("b", mass, mass * half * half / 3, place(half, 0));
    add_pin("R", 0, 0, end("b", place(-half, 0)));
    if (stop) {
      Json s;
      s["type"] = "stop";
      s["name"] = "K0";
      s["column"] = "R.angle";
      s["min"] = -low;
      s["restitution"] = e;
      scene_["outputs"].push_back("K0.force");
      scene_["forces"].push_back(std::move(s));
      return;
    }
    Json& k = force("contact", "ground", end("b", place(half, 0)));
    k["curve"] = line(-2 * half * std::sin(low), 0);
    k["restitution"] = e;
    k["mu"] = uniform(0, 0.3);
  }
  void block_on_feet() {
    const double width = uniform(0.3, 0.6), height = uniform(0.3, 0.6), tilt = uniform(0.05, 0.3);
    const double mass = uniform(0.5, 2), above = uniform(0.01, 0.2), e = uniform(0, 0.4), mu = uniform(0.2, 0.6);
    const double up = width * std::sin(tilt) + height * std::cos(tilt) + above;
    body("b", mass, mass * (width * width + height * height) / 3, place(0, up))["angle"] = tilt;
    for (const double side : {-1.0, 1.0}) {
      Json& k = force("contact", "ground", end("b", place(side * width, -height)));
      k["curve"] = line(0, 0);
      k["restitution"] = e;
      k["mu"] = mu;
    }
  }
  void two_discs() {
    const double mass = uniform(0.5, 2), v = uniform(1, 2), beside = uniform(-0.2, 0.2);
    scene_["gravity"] = pair(0, 0);
    body("a", mass, mass * 0.02, place(0, 0), velocity(v, 0));
    body("b", 1, 0.02, place(1, beside));
    Json& k = force("contact", "a", "b");
    k["curve"] = circle(0, 0, 0.2);
    k["radius"] = 0.2 * u_.length;
    k["restitution"] = uniform(0, 1);
    k["mu"] = uniform(0, 0.3);
  }
  /// A throw through x = 0 and the top of its way, which ends on a floor.
  void events_at_zero() {
    const double vx = uniform(1, 3), vy = uniform(1, 3);
    body("b", uniform(0.5, 2), 0, place(-0.5, 0.3), velocity(vx, vy));
    Json& k = force("contact", "ground", "b");
    k["curve"] = line(0, 0);
    k["restitution"] = 0.5;
    events_ = Json::array();
    for (const char* column : {"b.x", "b.vy"}) {
      Json e;
      e["name"] = column;
      e["when"] = column;
      e["value"] = 0;
      events_.push_back(std::move(e));
    }
  }
  void finish() {
    Json a;
    a["type"] = "dynamics";
    a["until"] = until_ * u_.time;
    a["every"] = until_ * u_.time / 8;
    if (!events_.is_null()) a["events"] = events_;
    scene_["analyses"] = Json::array();
    scene_["analyses"].push_back(std::move(a));
  }

  std::mt19937 random_;
  Transformation u_;
  Json scene_, events_;
  double until_ = 1;
};

/// Units that are powers of four, 4^-15 ... 4^15 (1e-9 ... 1e9), change no digit: what differs has a size of its own.
inline std::string fault_of_units_where_bodies_touch(unsigned seed, std::map<std::string, int>& seen) {
  std::mt19937 random(seed + 77);
  Transformation t;
  for (double* unit : {&t.length, &t.mass, &t.time}) *unit = std::pow(4.0, static_cast<int>(random() % 31) - 15);
  const std::string text = TouchingScene(seed, t).text();
  keep_scene("touching", seed, text);
  const TextRun first = run_text(TouchingScene(seed, {}).text()), second = run_text(text);
  for (const TextRun* run : {&first, &second}) {
    if (run->outcome.exit_code > 1) return "not valid: " + run->outcome.error_text;
  }
  const AnalysisReport &a = first.analysis().report, &b = second.analysis().report;
  ++seen[std::string(to_string(a.status))];
  if (a.status != b.status)
    return std::string(to_string(a.status)) + ", in other units " + std::string(to_string(b.status)) + ": " +
           a.message + b.message;
  const std::vector<EventEntry> events = events_of(first), others = events_of(second);
  if (events.size() != others.size())
    return std::to_string(events.size()) + " events, in other units " + std::to_string(others.size());
  for (std::size_t k = 0; k < events.size(); ++k) {
    if (events[k].kind != others[k].kind || !(std::abs(others[k].t / t.time - events[k].t) <= 1e-9))
      return "event " + std::to_string(k) + ", " + events[k].kind + " at " + std::to_string(events[k].t) +
             " s, is another one in other units";
  }
  return rows_apart(first.sink.rows.at(0), second.sink.rows.at(0), first.analysis().columns.size(), t, 1e-9);
}

}  // namespace catena::testing
