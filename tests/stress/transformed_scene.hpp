// The same mechanism seen otherwise: in other units, mirrored in the x axis, turned and shifted in the plane. Works on
// the text of a RandomScene, field by field.
//
//   place p -> length (R(turn) F p + shift)      F: y -> -y if mirrored      angle -> (+-) angle + turn
//
// Lengths are multiplied by `length`, masses by `mass`, times by `time`, all else by what follows from these.
#pragma once

#include "stress/random_scene.hpp"

namespace catena::testing {

struct Transformation {
  double length = 1, mass = 1, time = 1;
  bool mirrored = false;
  double turn = 0;
  Place shift{};  ///< in lengths of before

  double sign() const { return mirrored ? -1 : 1; }
  Place vector(Place p) const { return turned({p.x, sign() * p.y}, turn); }
  Place place(Place p) const { return length * (vector(p) + shift); }
  double angle(double a) const { return sign() * a + turn; }
};

/// Whether some element means the ground's own axes, which a turn changes.
inline bool has_ground_axes(const Json& scene) {
  for (const Json& c : scene["constraints"]) {
    const std::string type = c["type"];
    if (type.ends_with("_x") || type.ends_with("_y")) return true;
  }
  for (const Json& d : scene["drivers"]) {
    const std::string type = d["type"];
    if (type.ends_with("_x") || type.ends_with("_y")) return true;
  }
  for (const Json& f : scene["forces"]) {
    if (f["type"] == "bushing" && f["i"][0] == "ground") return true;
  }
  return false;
}

class TransformedScene {
 public:
  TransformedScene(const Json& scene, const Transformation& t) : t_(t), scene_(scene) {
    const double v = t.length / t.time;
    scale_vector(scene_["gravity"], v / t.time);
    for (auto& [name, body] : scene_["bodies"].items()) {
      scale(body["mass"], t.mass);
      scale(body["inertia"], t.mass * t.length * t.length);
      body["position"] = pair(t.place(point(body["position"])));
      body["angle"] = t.angle(body["angle"]);
      if (body.contains("velocity")) scale_vector(body["velocity"], v);
      if (body.contains("angular_velocity")) scale(body["angular_velocity"], t.sign() / t.time);
    }
    for (Json& c : scene_["constraints"]) constraint(c);
    for (Json& f : scene_["forces"]) force(f);
    for (Json& d : scene_["drivers"]) driver(d);
    for (Json& a : scene_["analyses"]) {
      for (const char* key : {"until", "every"}) {
        if (a.contains(key)) scale(a[key], t.time);
      }
    }
  }
  const Json& scene() const { return scene_; }

 private:
  static Place point(const Json& p) { return {p[0], p[1]}; }
  static Json pair(Place p) { return {p.x, p.y}; }
  static void scale(Json& number, double factor) { number = number.get<double>() * factor; }
  void scale_vector(Json& vector, double factor) const { vector = pair(factor * t_.vector(point(vector))); }
  static bool on_ground(const Json& end) { return (end.is_array() ? end[0] : end) == "ground"; }

  /// A point of a body or of the ground.
  Json moved(const Json& p, bool ground) const {
    if (ground) return pair(t_.place(point(p)));
    return pair({t_.length * p[0].get<double>(), t_.sign() * t_.length * p[1].get<double>()});
  }
  void end(Json& e) const {
    if (e.is_array()) e[1] = moved(e[1], on_ground(e));
  }
  void axis(Json& a, bool ground) const {
    a = ground ? pair(t_.vector(point(a))) : Json{a[0], t_.sign() * a[1].get<double>()};
  }
  void curve(Json& c, bool ground) const {
    c["circle"]["centre"] = moved(c["circle"]["centre"], ground);
    scale(c["circle"]["radius"], t_.length);
  }

  void constraint(Json& c) const {
    const bool i_ground = on_ground(c["i"]), j_ground = c.contains("j") && on_ground(c["j"]);
    for (const char* key : {"i", "j"}) {
      if (c.contains(key)) end(c[key]);
    }
    if (c.contains("ground")) c["ground"] = moved(c["ground"], true);
    if (c.contains("axis_i")) axis(c["axis_i"], i_ground);
    if (c.contains("axis_j")) {
      axis(c["axis_j"], j_ground);
      // The side of the face that touches is that of its axis turned by a right angle.
      c["axis_j"] = {t_.sign() * c["axis_j"][0].get<double>(), t_.sign() * c["axis_j"][1].get<double>()};
    }
    for (const char* key : {"length", "radius", "radius_i", "radius_j"}) {
      if (c.contains(key)) scale(c[key], t_.length);
    }
    if (c.contains("side") && t_.mirrored) c["side"] = -c["side"].get<int>();
    if (c.contains("curve")) curve(c["curve"], i_ground);
    if (c.contains("curve_i")) curve(c["curve_i"], i_ground);
    if (c.contains("curve_j")) curve(c["curve_j"], j_ground);
  }

  void force(Json& f) const {
    const double force = t_.mass * t_.length / t_.time / t_.time, torque = force * t_.length;
    const std::string type = f["type"];
    const bool i_ground = on_ground(f["i"]), turns = type == "torsion_spring";
    for (const char* key : {"i", "j"}) {
      if (f.contains(key)) end(f[key]);
    }
    for (const char* key : {"k", "kx", "ky", "kt"}) {
      if (f.contains(key)) scale(f[key], turns || std::string(key) == "kt" ? torque : force / t_.length);
    }
    for (const char* key : {"c", "cx", "cy", "ct"}) {
      if (f.contains(key)) scale(f[key], (turns || std::string(key) == "ct" ? torque : force / t_.length) * t_.time);
    }
    if (f.contains("length")) scale(f["length"], t_.length);
    if (f.contains("angle")) f["angle"] = t_.sign() * f["angle"].get<double>() + (i_ground ? t_.turn : 0);
    if (f.contains("force")) scale_vector(f["force"], force);
    if (f.contains("torque")) {
      scale(f["torque"]["harmonic"]["amplitude"], t_.sign() * torque);
      scale(f["torque"]["harmonic"]["omega"], 1 / t_.time);
    }
  }

  /// Of an angle or a coordinate of the ground, which a turn does not leave one.
  void driver(Json& d) const {
    const std::string type = d["type"];
    const bool angle = type == "absolute_angle", x = type == "absolute_x";
    double factor = angle ? t_.sign() : x ? t_.length : t_.sign() * t_.length;
    Json& terms = d["value"]["polynomial"];
    for (Json& term : terms) {
      scale(term, factor);
      factor /= t_.time;
    }
    terms[0] = terms[0].get<double>() + (angle ? t_.turn : t_.length * (x ? t_.shift.x : t_.shift.y));
  }

  Transformation t_;
  Json scene_;
};

}  // namespace catena::testing
