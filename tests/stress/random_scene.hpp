// A random mechanism as a scene's text and, line by line beside it, as a DenseMechanism: every joint and force whose
// equation is short (curves are circles), any scale of length and mass, loops, joints given twice.
//
// Bodies are placed at random; joints hold there, between places that fit to rounding. A tree of joints comes first,
// then what closes loops, then copies. Velocities are a random motion that the joints allow.
#pragma once

#include <nlohmann/json.hpp>
#include <random>

#include "references/dense.hpp"
#include "stress/dense_mechanism.hpp"

namespace catena::testing {

using Json = nlohmann::ordered_json;
using Place = Vec2<double>;

inline Place turned(Place s, double angle) {
  const double c = std::cos(angle), w = std::sin(angle);
  return {c * s.x - w * s.y, w * s.x + c * s.y};
}
inline Jet cross(JetPoint a, JetPoint b) { return a.x * b.y - a.y * b.x; }
inline Jet dot(JetPoint a, JetPoint b) { return a.x * b.x + a.y * b.y; }
inline Jet norm(JetPoint a) { return sqrt(dot(a, a)); }

class RandomScene {
 public:
  enum class Forces { none, still, moving };  ///< moving: with dampers and functions of time

  RandomScene(unsigned seed, Forces forces) : random_(seed), forces_(forces) {
    size = std::pow(10.0, uniform(-2, 2));
    mass_ = std::pow(10.0, uniform(-2, 2));
    dense.length = size;
    pace = std::sqrt(9.81 / size);
    const bool weights = forces != Forces::none && pick(4);
    dense.gravity = weights ? turned({0, -9.81}, pick(2) ? 0 : uniform(-3, 3)) : Place{};
    scene = {{"catena", 1},
             {"gravity", {dense.gravity.x, dense.gravity.y}},
             {"bodies", Json::object()},
             {"constraints", Json::array()},
             {"drivers", Json::array()},
             {"forces", Json::array()}};
    const int bodies = 1 + pick(4);
    for (int b = 0; b < bodies; ++b) {
      add_body();
      if (pick(12)) add_joint(pick(b + 1) - 1, b);
    }
    for (int k = pick(3); k > 0 && bodies > 1; --k) {
      const int j = pick(bodies), i = pick(bodies) - 1;  // one after the other: compilers order arguments as they like
      add_joint(i, j);
    }
    if (pick(3) == 0 && bodies > 2) add_gears();
    if (pick(3) == 0) double_a_joint();
    if (forces != Forces::none) {
      for (int k = pick(4); k > 0; --k) {
        const int j = pick(bodies), i = pick(bodies + 1) - 1;
        add_force(i, j);
      }
    }
    q = Vector(dense.size());
    for (std::size_t b = 0; b < poses_.size(); ++b)
      q.segment<3>(3 * static_cast<Eigen::Index>(b)) << poses_[b].r.x, poses_[b].r.y, poses_[b].angle;
    v = Vector::Zero(dense.size());
  }

  Json scene;
  DenseMechanism dense;
  Vector q, v;
  double size = 1, pace = 1;
  std::vector<std::string> types;  ///< of joints and forces, in order
  double uniform(double a, double b) { return std::uniform_real_distribution<double>(a, b)(random_); }
  int pick(int n) { return std::uniform_int_distribution<int>(0, n - 1)(random_); }

  /// Basis of the motions that the joints allow, in places and length times angles.
  Matrix motions() const {
    Matrix jacobian = dense.jacobian(0, q);
    for (Eigen::Index k = 2; k < jacobian.cols(); k += 3) jacobian.col(k) /= dense.length;
    for (Eigen::Index k = 0; k < jacobian.rows(); ++k) jacobian.row(k).normalize();
    if (jacobian.rows() == 0) return Matrix::Identity(dense.size(), dense.size());
    Matrix basis = DenseRows<Real>(jacobian, 1e-9L).null_space();
    for (Eigen::Index k = 2; k < basis.rows(); k += 3) basis.row(k) /= dense.length;
    return basis;
  }
  /// Random velocities that the joints allow, as sizes and weights have them.
  void set_moving() {
    const Matrix basis = motions();
    Vector rates(basis.cols());
    for (Real& rate : rates) rate = uniform(-1, 1) * size * pace;
    v = basis * rates;
    for (std::size_t b = 0; b < poses_.size(); ++b) {
      const Eigen::Index k = 3 * static_cast<Eigen::Index>(b);
      Json& body = scene["bodies"][name(static_cast<int>(b))];
      body["velocity"] = {double(v[k]), double(v[k + 1])};
      body["angular_velocity"] = double(v[k + 2]);
    }
  }
  /// A driver of an angle or a coordinate that starts where the mechanism is; its row in `dense`.
  void add_driver() {
    const int b = pick(static_cast<int>(poses_.size()));
    const Pose& pose = poses_[static_cast<std::size_t>(b)];
    const int kind = pick(4);
    const double scale = kind < 2 ? 1 : size, start = kind < 2 ? pose.angle : kind == 2 ? pose.r.x : pose.r.y;
    const double c1 = uniform(-1, 1) * scale * pace, c2 = uniform(-1, 1) * scale * pace * pace;
    scene["drivers"].push_back({{"type", kind < 2    ? "absolute_angle"
                                         : kind == 2 ? "absolute_x"
                                                     : "absolute_y"},
                                {"name", "d" + std::to_string(scene["drivers"].size())},
                                {"i", name(b)},
                                {"value", {{"polynomial", {start, c1, c2}}}}});
    dense.rows.push_back({-1, b, [=](const JetPlace&, const JetPlace& j, Jet t) {
                            const Jet at = kind < 2 ? j.phi : kind == 2 ? j.r.x : j.r.y;
                            return at - Jet{start} - Real(c1) * t - Real(c2) * (t * t);
                          }});
  }
  /// A bushing, or a spring between two points, relaxed as given, of stiffness k, N/m, and damping c, N s/m.
  void add_relaxed(int i, int j, double k, double c, bool bushing) {
    if (i == j) i = -1;
    const Place at = somewhere(), other = somewhere();
    if (bushing) {
      const Pose here = i < 0 ? Pose{{}, 0} : poses_[static_cast<std::size_t>(i)];
      const double turns = pick(2) ? size * size * uniform(0.01, 1) : 0;
      push_bushing(
          i, j, local(i, at), local(j, at),
          {k, k * uniform(0.1, 1), k * turns, c, c, c * turns, poses_[static_cast<std::size_t>(j)].angle - here.angle});
    } else {
      push_spring(i, j, local(i, at), local(j, other), k, c, distance(at, other));
    }
  }

 private:
  struct Pose {
    Place r;
    double angle;
  };

  static std::string name(int body) { return body < 0 ? "ground" : "b" + std::to_string(body); }
  Place local(int body, Place p) const {
    if (body < 0) return p;
    const Pose& pose = poses_[static_cast<std::size_t>(body)];
    return turned(p - pose.r, -pose.angle);
  }
  Place local_axis(int body, Place axis) const {
    return body < 0 ? axis : turned(axis, -poses_[static_cast<std::size_t>(body)].angle);
  }
  Place somewhere() { return {uniform(-2, 2) * size, uniform(-2, 2) * size}; }
  static Json pair(Place p) { return {p.x, p.y}; }
  Json end(int body, Place s) const { return {name(body), pair(s)}; }

  void add_body() {
    const double m = mass_ * std::pow(10.0, uniform(-1, 1)), inertia = m * std::pow(size * uniform(0.1, 0.8), 2);
    const Pose pose{somewhere(), uniform(-4, 4)};
    scene["bodies"]["b" + std::to_string(poses_.size())] = {
        {"mass", m}, {"inertia", inertia}, {"position", pair(pose.r)}, {"angle", pose.angle}};
    poses_.push_back(pose);
    dense.bodies.push_back({m, inertia});
  }
  void add(Json entry, int i, int j, std::vector<DenseMechanism::Function> rows) {
    types.push_back(entry["type"]);
    entry["name"] = "c" + std::to_string(scene["constraints"].size());
    scene["constraints"].push_back(std::move(entry));
    joint_rows_.push_back({dense.rows.size(), rows.size()});
    for (auto& row : rows) dense.rows.push_back({i, j, std::move(row)});
    // The last row of these says that an angle stays.
    const std::string& type = types.back();
    if (type == "translational") dense.rows.back().period = DenseMechanism::turn / 2;
    if (type == "weld" || type == "relative_angle" || type == "absolute_angle")
      dense.rows.back().period = DenseMechanism::turn;
  }
  void add_joint(int i, int j) {
    if (i == j) i = -1;
    // Pins and guides more often than the others.
    static const char* const kinds[] = {"revolute",          "revolute",          "revolute",   "revolute",
                                        "translational",     "translational",     "weld",       "slot",
                                        "coupler",           "relative_x",        "relative_y", "relative_angle",
                                        "displacement",      "relative_distance", "absolute_x", "absolute_y",
                                        "absolute_distance", "point_on_curve",    "cam_flat",   "cam_cam",
                                        "rack_pinion",       "absolute_angle"};
    const std::string type = kinds[pick(static_cast<int>(std::size(kinds)))];
    const Place at = somewhere(), other = somewhere(), u = turned({1, 0}, uniform(-3, 3)), n{-u.y, u.x};
    const Place si = local(i, at), wi = local_axis(i, u);
    const auto axis = [wi](const JetPlace& p) { return catena::testing::turned(p.phi, wi); };
    const auto span = [si](Place sj) {
      return [si, sj](const JetPlace& a, const JetPlace& b) { return b.point(sj) - a.point(si); };
    };
    using P = const JetPlace&;
    const auto h_at = span(local(j, at));
    const auto turn = [](P a, P b, Jet) { return b.phi - a.phi; };
    Json entry = {{"type", type}, {"i", end(i, si)}, {"j", end(j, local(j, at))}};
    if (type == "revolute") {
      add(entry, i, j,
          {[h_at](P a, P b, Jet) { return h_at(a, b).x; }, [h_at](P a, P b, Jet) { return h_at(a, b).y; }});
    } else if (type == "weld") {
      add(entry, i, j,
          {[h_at](P a, P b, Jet) { return h_at(a, b).x; }, [h_at](P a, P b, Jet) { return h_at(a, b).y; }, turn});
    } else if (type == "slot" || type == "translational") {
      const Place sj = local(j, at + uniform(-1, 1) * size * u);
      const auto h = span(sj);
      entry["j"] = end(j, sj);
      entry["axis_i"] = pair(wi);
      std::vector<DenseMechanism::Function> rows{[=](P a, P b, Jet) { return cross(axis(a), h(a, b)); }};
      if (type == "translational") rows.push_back(turn);
      add(entry, i, j, rows);
    } else if (type == "coupler" || type == "relative_distance") {
      const auto h = span(local(j, other));
      entry["j"] = end(j, local(j, other));
      if (type == "coupler") entry["length"] = distance(at, other);
      add(entry, i, j, {[h](P a, P b, Jet) { return norm(h(a, b)); }});
    } else if (type == "relative_x" || type == "relative_y") {
      const auto h = span(local(j, other));
      entry["j"] = end(j, local(j, other));
      const bool x = type == "relative_x";
      add(entry, i, j, {[h, x](P a, P b, Jet) { return x ? h(a, b).x : h(a, b).y; }});
    } else if (type == "relative_angle") {
      add({{"type", type}, {"i", name(i)}, {"j", name(j)}}, i, j, {turn});
    } else if (type == "displacement") {
      const auto h = span(local(j, other));
      entry["j"] = end(j, local(j, other));
      entry["axis_i"] = pair(wi);
      add(entry, i, j, {[=](P a, P b, Jet) { return dot(axis(a), h(a, b)); }});
    } else if (type == "absolute_x" || type == "absolute_y" || type == "absolute_angle") {
      const Place sj = local(j, other);
      const char what = type.back();
      add({{"type", type}, {"i", end(j, sj)}}, -1, j, {[=](P, P b, Jet) {
            return what == 'e' ? b.phi : what == 'x' ? b.point(sj).x : b.point(sj).y;
          }});
    } else if (type == "absolute_distance") {
      const Place sj = local(j, other);
      add({{"type", type}, {"i", end(j, sj)}, {"ground", pair(at)}}, -1, j,
          {[=](P, P b, Jet) { return norm(b.point(sj) - fixed_point(at)); }});
    } else if (type == "point_on_curve") {
      const auto h = span(local(j, other));
      add({{"type", type}, {"i", name(i)}, {"j", end(j, local(j, other))}, {"curve", circle(si, distance(at, other))}},
          i, j, {[h](P a, P b, Jet) { return norm(h(a, b)); }});
    } else if (type == "cam_flat") {
      const double radius = uniform(0.2, 1) * size;
      const Place sj = local(j, at + radius * n + uniform(-1, 1) * size * u), wj = local_axis(j, u);
      const auto h = span(sj);
      add({{"type", type}, {"i", name(i)}, {"j", end(j, sj)}, {"axis_j", pair(wj)}, {"curve", circle(si, radius)}}, i,
          j, {[=](P a, P b, Jet) { return cross(catena::testing::turned(b.phi, wj), h(a, b)); }});
    } else if (type == "cam_cam") {
      const double whole = distance(at, other), part = uniform(0.2, 0.8);
      const auto h = span(local(j, other));
      add({{"type", type},
           {"i", name(i)},
           {"j", name(j)},
           {"curve_i", circle(si, part * whole)},
           {"curve_j", circle(local(j, other), whole - part * whole)}},
          i, j, {[h](P a, P b, Jet) { return norm(h(a, b)); }});
    } else {
      const double radius = uniform(0.2, 1) * size;
      const int side = pick(2) ? 1 : -1;
      const Place sj = local(j, at + side * radius * n + uniform(-1, 1) * size * u);
      const auto h = span(sj);
      const Real r = side * radius;
      add({{"type", type},
           {"i", end(i, si)},
           {"j", end(j, sj)},
           {"axis_i", pair(wi)},
           {"radius", radius},
           {"side", side}},
          i, j,
          {[=](P a, P b, Jet) { return cross(axis(a), h(a, b)); },
           [=](P a, P b, Jet) { return dot(axis(a), h(a, b)) + r * (b.phi - a.phi); }});
    }
  }
  static double distance(Place a, Place b) { return std::hypot(b.x - a.x, b.y - a.y); }
  static Json circle(Place centre, double radius) {
    return {{"circle", {{"centre", pair(centre)}, {"radius", radius}}}};
  }

  /// Two more bodies on pins of the ground or of a carrier, in mesh or with a belt between them.
  void add_gears() {
    const int carrier = pick(2) ? -1 : 0, i = static_cast<int>(poses_.size()), j = i + 1;
    const Place centres[] = {somewhere(), somewhere()};
    using P = const JetPlace&;
    for (const Place c : centres) {
      add_body();
      const int b = static_cast<int>(poses_.size()) - 1;
      const Place si = local(carrier, c), sj = local(b, c);
      add({{"type", "revolute"}, {"i", end(carrier, si)}, {"j", end(b, sj)}}, carrier, b,
          {[=](P a, P o, Jet) { return o.point(sj).x - a.point(si).x; },
           [=](P a, P o, Jet) { return o.point(sj).y - a.point(si).y; }});
    }
    const double whole = distance(centres[0], centres[1]);
    const int kind = pick(4);  // gears outside, inside; belts open, crossed
    const double ri = kind == 1 ? 1.5 * whole : whole * uniform(0.2, 0.8);
    const double rj = kind == 1 ? ri - whole : kind == 0 ? whole - ri : (whole - ri) * uniform(0.2, 0.9);
    const Real a = ri, b = (kind == 0 || kind == 3) ? rj : -rj;
    Json entry = {{"type", kind < 2 ? "gear" : "belt"},
                  {"i", end(i, local(i, centres[0]))},
                  {"j", end(j, local(j, centres[1]))},
                  {"radius_i", ri},
                  {"radius_j", rj}};
    if (kind == 1) entry["internal"] = true;
    if (kind == 3) entry["crossed"] = true;
    const Place si = local(i, centres[0]), sj = local(j, centres[1]);
    add(entry, i, j, {[=](P x, P y, Jet) {
          const JetPoint h = y.point(sj) - x.point(si);
          return a * x.phi + b * y.phi - (a + b) * atan2(h.y, h.x);
        }});
    dense.rows.back().period = std::abs(a + b) * DenseMechanism::turn;
  }
  void double_a_joint() {
    if (joint_rows_.empty()) return;
    const std::size_t k = static_cast<std::size_t>(pick(static_cast<int>(joint_rows_.size())));
    const auto [first, count] = joint_rows_[k];
    std::vector<DenseMechanism::Function> rows;
    for (std::size_t r = first; r < first + count; ++r) rows.push_back(dense.rows[r].phi);
    add(Json(scene["constraints"][k]), dense.rows[first].i, dense.rows[first].j, rows);
    dense.rows.back().period = dense.rows[first + count - 1].period;
  }

  using BodyPlace = const JetPlace&;
  void push(Json entry, DenseMechanism::Load load) {
    types.push_back(entry["type"]);
    if (entry != last_force_) scene["forces"].push_back(entry);
    last_force_ = entry;
    dense.loads.push_back(std::move(load));
  }
  static auto spring(Real stiffness, Real damping, Real rest) {
    return std::pair([=](Jet s, Real, BodyPlace) { return -stiffness * (s.f - rest) - damping * s.d; },
                     [=](Jet s) { return stiffness / 2 * ((s - Jet{rest}) * (s - Jet{rest})); });
  }
  void push_spring(int i, int j, Place si, Place sj, double k, double c, double rest) {
    const auto [force, energy] = spring(k, c, rest);
    push({{"type", "spring_damper"}, {"i", end(i, si)}, {"j", end(j, sj)}, {"k", k}, {"c", c}, {"length", rest}},
         {i, j, [=](BodyPlace a, BodyPlace b, Jet) { return norm(b.point(sj) - a.point(si)); }, force, energy});
  }
  struct BushingNumbers {
    double kx, ky, kt, cx, cy, ct, angle;
  };
  void push_bushing(int i, int j, Place si, Place sj, const BushingNumbers& n) {
    const Json entry = {{"type", "bushing"}, {"i", end(i, si)}, {"j", end(j, sj)}, {"kx", n.kx}, {"ky", n.ky},
                        {"kt", n.kt},        {"cx", n.cx},      {"cy", n.cy},      {"ct", n.ct}, {"angle", n.angle}};
    const auto along = [=](double x, double y) {
      return [=](BodyPlace a, BodyPlace b, Jet) {
        return dot(catena::testing::turned(a.phi, {x, y}), b.point(sj) - a.point(si));
      };
    };
    const auto [fx, vx] = spring(n.kx, n.cx, 0);
    const auto [fy, vy] = spring(n.ky, n.cy, 0);
    const auto [ft, vt] = spring(n.kt, n.ct, n.angle);
    push(entry, {i, j, along(1, 0), fx, vx});
    push(entry, {i, j, along(0, 1), fy, vy});
    push(entry, {i, j, [](BodyPlace a, BodyPlace b, Jet) { return b.phi - a.phi; }, ft, vt});
  }

  void add_force(int i, int j) {
    if (i == j) i = -1;
    const double weight = mass_ * 9.81, k = weight / size * std::pow(10.0, uniform(-1, 1));
    const double c = forces_ == Forces::moving && pick(2) ? k / pace * uniform(0, 0.5) : 0;
    const Place at = somewhere(), other = somewhere(), si = local(i, at), sj = local(j, other);
    using P = BodyPlace;
    const int kind = pick(4);
    if (kind == 0) {
      push_spring(i, j, si, sj, k, c, distance(at, other) * uniform(0.5, 1.5));
    } else if (kind == 1) {
      const double kt = k * size * size, ct = c * size * size, rest = uniform(-3, 3);
      const auto [force, energy] = spring(kt, ct, rest);
      push({{"type", "torsion_spring"}, {"i", name(i)}, {"j", name(j)}, {"k", kt}, {"c", ct}, {"angle", rest}},
           {i, j, [](P a, P b, Jet) { return b.phi - a.phi; }, force, energy});
    } else if (kind == 2) {
      const double ky = k * uniform(0.1, 1), kt = k * size * size * uniform(0.1, 1), rest = uniform(-3, 3);
      push_bushing(i, j, si, sj, {k, ky, kt, c, c, c * size * size, rest});
    } else if (forces_ == Forces::moving) {
      const double torque = weight * size * uniform(-1, 1), omega = pace * uniform(0.2, 3), phase = uniform(-3, 3);
      const Json wave = {{"harmonic", {{"amplitude", torque}, {"omega", omega}, {"phase", phase}}}};
      push({{"type", "torque"}, {"i", name(j)}, {"torque", wave}},
           {-1,
            j,
            [](P, P b, Jet) { return b.phi; },
            [=](Jet, Real t, P) { return torque * std::sin(Real(omega) * t + Real(phase)); },
            {}});
    } else {
      const Place f{weight * uniform(-1, 1), weight * uniform(-1, 1)};
      const Json entry = {{"type", "point_force"}, {"i", end(j, sj)}, {"force", pair(f)}};
      push(entry, {-1, j, [sj](P, P b, Jet) { return b.point(sj).x; }, [=](Jet, Real, P) { return Real(f.x); },
                   [=](Jet s) { return Real(-f.x) * s; }});
      push(entry, {-1, j, [sj](P, P b, Jet) { return b.point(sj).y; }, [=](Jet, Real, P) { return Real(f.y); },
                   [=](Jet s) { return Real(-f.y) * s; }});
    }
  }

  std::mt19937 random_;
  Forces forces_;
  double mass_ = 1;
  std::vector<Pose> poses_;
  std::vector<std::pair<std::size_t, std::size_t>> joint_rows_;  // first row and number of rows of each constraint
  Json last_force_;
};

}  // namespace catena::testing
