// Digits of random motions of ropes that meet and leave pulleys, or wind on them: what dynamics, kinematics and
// inverse_dynamics claim beside the same motions in long double.
//
//   pendulum   on a rope of length L from (0, 0) past a round peg of radius r at (0, -h): phi'' = -(g sin phi + l'
//   phi'^2) / l,
//              l = L off the peg, L - sqrt(h^2 - r^2) - r (phi - phi*) on it, from sin phi* = -r / h on; l phi' is
//              continuous
//   weight     on an elastic rope past the same peg: m r'' = m g - k max(way - L, 0) u, u the direction of its last
//   line arm        about a peg, driven: the rope from (0, 0) to its end is a straight line, or two tangents and an arc
//   hoist      a driven drum winds a rope: y = y_0 + r turned
//
// Ropes meet and leave the peg, become slack and taut, at instants that the oracle steps to.
#pragma once

#include "stress/motion_of_laws.hpp"
#include "stress/touching_digits.hpp"

namespace catena::testing {

/// Where the particle starts on its rope, and the peg.
struct PegScene {
  double size, h, r, x, y, vx, vy, mass, mirror;

  PegScene(RandomNumbers& random, double slowest) {
    size = std::pow(10.0, random(-2, 2));
    h = size * random(0.3, 0.5);
    r = h * random(0.05, 0.3);
    const double phi = -random(0.45, 0.65), rate = random(slowest, 0) * std::sqrt(gravity_of_touching / size);
    mirror = random(-1, 1) < 0 ? -1 : 1;
    mass = std::pow(10.0, random(-2, 2));
    x = size * std::sin(phi);
    y = -size * std::cos(phi);
    vx = rate * size * std::cos(phi);
    vy = rate * size * std::sin(phi);
  }
  Real pace() const { return 0.05L * std::sqrt(Real(size) / gravity_of_touching); }
  /// Of the tangent at which the straight rope touches the peg, from the vertical.
  Real meeting() const { return -std::asin(Real(r) / h); }
  Real to_peg() const { return std::sqrt(Real(h) * h - Real(r) * r); }
  TouchingCase scene(const Json& more, double until) const {
    TouchingCase c;
    c.scene["bodies"]["b"] = {
        {"particle", true}, {"mass", mass}, {"position", {mirror * x, y}}, {"velocity", {mirror * vx, vy}}};
    Json rope = {{"type", "rope"},
                 {"name", "rope"},
                 {"i", "ground"},
                 {"over", Json::array({{{"at", {"ground", {0, -h}}}, {"radius", r}, {"side", int(mirror)}}})},
                 {"j", "b"}};
    rope.update(more);
    c.scene["forces"] = Json::array({rope});
    c.until = until * std::sqrt(size / gravity_of_touching);
    return c;
  }
};

inline TouchingCase pendulum_on_peg(RandomNumbers& random) {
  const PegScene at(random, -0.15);
  TouchingCase c = at.scene(Json::object(), random(3, 12));
  c.columns = {"b.x", "b.y", "b.vx", "b.vy", "b.ax", "b.ay", "rope.force"};
  const Real fall = gravity_of_touching, length = std::hypot(Real(at.x), Real(at.y));
  const auto free = [=](int law, Real phi) {
    return law == 0 ? length : length - at.to_peg() - at.r * (phi - at.meeting());
  };
  const auto turning = [=](int law, const Vector& y) {
    return -(fall * std::sin(y[0]) - (law == 0 ? 0 : at.r) * y[1] * y[1]) / free(law, y[0]);
  };
  c.exact = [=](const std::vector<double>& instants) -> std::optional<std::vector<TouchingState>> {
    MotionOfLaws motion;
    motion.slope = [&](int law, const Vector& y) {
      Vector rate(2);
      rate << y[1], turning(law, y);
      return rate;
    };
    motion.margins = [&](int law, const Vector& y) {
      return std::vector<Real>{law == 0 ? at.meeting() - y[0] : y[0] - at.meeting()};
    };
    motion.next = [&](int law, std::size_t, Vector& y) {
      y[1] *= free(law, y[0]) / free(1 - law, y[0]);
      return 1 - law;
    };
    motion.scale = Vector(2);
    motion.scale << 1, std::sqrt(fall / at.size);
    motion.pace = at.pace();
    const Real start = std::atan2(Real(at.x), -Real(at.y));
    motion.y = Vector(2);
    motion.y << start, (at.vx * std::cos(start) + at.vy * std::sin(start)) / length;
    std::vector<TouchingState> states;
    for (const double t : instants) {
      if (!motion.go_to(t)) return std::nullopt;
      const Real phi = motion.y[0], w = motion.y[1], cosine = std::cos(phi), sine = std::sin(phi);
      const Real l = free(motion.law, phi), inward = l * w * w, along = -fall * sine, m = at.mirror;
      const Real r = motion.law == 0 ? 0 : at.r, h = motion.law == 0 ? 0 : at.h;
      states.push_back({m * (l * sine - r * cosine), -h - r * sine - l * cosine, m * l * w * cosine, l * w * sine,
                        m * (along * cosine - inward * sine), along * sine + inward * cosine,
                        at.mass * (inward + fall * cosine)});
    }
    return states;
  };
  return c;
}

inline TouchingCase weight_past_peg(RandomNumbers& random) {
  const PegScene at(random, -0.15);
  const double k = random(20, 80) * at.mass * gravity_of_touching / at.size;
  TouchingCase c = at.scene({{"k", k}}, random(2, 6));
  c.columns = {"b.x", "b.y", "b.vx", "b.vy", "b.ax", "b.ay", "rope.force"};
  const Real fall = gravity_of_touching, length = std::hypot(Real(at.x), Real(at.y));
  struct Way {
    Real length, ux, uy, contact;
  };
  // Laws: 1 on the peg, 2 slack.
  const auto way = [=](int law, const Vector& y) {
    const Real up = y[1] + at.h, d = std::hypot(y[0], up), straight = std::hypot(y[0], y[1]);
    const Real out = std::atan2(y[0], -up) + std::asin(at.r / d), contact = out - at.meeting();
    if ((law & 1) == 0) return Way{straight, y[0] / straight, y[1] / straight, contact};
    return Way{at.to_peg() + at.r * contact + std::sqrt(d * d - Real(at.r) * at.r), std::sin(out), -std::cos(out),
               contact};
  };
  const auto pull = [=](int law, const Way& w) { return (law & 2) != 0 ? 0 : k * (w.length - length); };
  c.exact = [=](const std::vector<double>& instants) -> std::optional<std::vector<TouchingState>> {
    MotionOfLaws motion;
    motion.slope = [&](int law, const Vector& y) {
      const Way w = way(law, y);
      Vector rate(4);
      rate << y[2], y[3], -pull(law, w) / at.mass * w.ux, -pull(law, w) / at.mass * w.uy - fall;
      return rate;
    };
    motion.margins = [&](int law, const Vector& y) {
      const Way w = way(law, y);
      const Real stretch = (w.length - length) / at.size;
      return std::vector<Real>{(law & 1) != 0 ? w.contact : -w.contact, (law & 2) != 0 ? -stretch : stretch};
    };
    motion.next = [](int law, std::size_t which, Vector&) { return law ^ (which == 0 ? 1 : 2); };
    motion.scale = Vector(4);
    const Real speed = std::sqrt(fall * at.size);
    motion.scale << at.size, at.size, speed, speed;
    motion.pace = 0.2L * at.pace();
    motion.y = Vector(4);
    motion.y << at.x, at.y, at.vx, at.vy;
    std::vector<TouchingState> states;
    for (const double t : instants) {
      if (!motion.go_to(t)) return std::nullopt;
      const Vector rate = motion.slope(motion.law, motion.y);
      const Real m = at.mirror;
      states.push_back({m * motion.y[0], motion.y[1], m * motion.y[2], motion.y[3], m * rate[2], rate[3],
                        pull(motion.law, way(motion.law, motion.y))});
    }
    return states;
  };
  return c;
}

/// Adds the columns of a driven motion; `exact`: them at an instant.
inline std::string add_driven_rope(const Json& scene, const std::string& what,
                                   const std::function<TouchingState(Real t)>& exact, ClaimedDigits& claims) {
  const TextRun run = run_text(scene.dump());
  if (run.outcome.exit_code > 1) return "not valid: " + run.outcome.error_text;
  if (!run.analysis().report.ok()) return std::string(to_string(run.analysis().report.status));
  if (run.analysis().digits.empty()) return "no claim";
  std::vector<TouchingState> states;
  for (const double t : run.column("t")) states.push_back(exact(t));
  for (std::size_t k = 0; k < scene["outputs"].size(); ++k) {
    std::vector<long double> column;
    for (const TouchingState& state : states) column.push_back(state[k]);
    claims.add(run, scene["outputs"][k].get<std::string>(), column, what);
  }
  return "compared";
}

inline std::string add_arm_about_peg(RandomNumbers& random, const std::string& what, ClaimedDigits& claims) {
  const double size = std::pow(10.0, random(-3, 3)), a = size * random(0.3, 0.8), l = size * random(1, 2);
  const double r = a * random(0.05, 0.6), amplitude = random(2, 14), omega = std::pow(10.0, random(-1, 2));
  const double until = random(0.5, 3) / omega;
  const Json scene = {
      {"catena", 1},
      {"bodies", {{"arm", {{"position", {a, 0}}, {"points", {{"p", {l, 0}}}}}}}},
      {"constraints", Json::array({{{"type", "revolute"}, {"i", {"ground", {a, 0}}}, {"j", "arm"}}})},
      {"drivers", Json::array({{{"type", "absolute_angle"},
                                {"i", "arm"},
                                {"value", {{"harmonic", {{"amplitude", amplitude}, {"omega", omega}}}}}}})},
      {"forces", Json::array({{{"type", "rope"},
                               {"name", "rope"},
                               {"i", "ground"},
                               {"over", Json::array({{{"at", {"ground", {a, 0}}}, {"radius", r}, {"side", 1}}})},
                               {"j", "arm.p"},
                               {"length", 30 * size}}})},
      {"outputs", {"rope.length", "arm.p.x", "arm.p.vy"}},
      {"analyses", Json::array({{{"type", "kinematics"}, {"until", until}, {"every", until / 300}}})}};
  const auto exact = [=](Real t) -> TouchingState {
    const Real angle = amplitude * std::sin(omega * t), cosine = std::cos(angle);
    const Real contact = angle + std::asin(Real(r) / l) + std::asin(Real(r) / a);
    const Real straight = std::hypot(a + l * cosine, l * std::sin(angle));
    const Real over = std::sqrt(Real(a) * a - Real(r) * r) + std::sqrt(Real(l) * l - Real(r) * r) + r * contact;
    return {contact > 0 ? over : straight, a + l * cosine, l * cosine * amplitude * omega * std::cos(omega * t)};
  };
  return add_driven_rope(scene, what, exact, claims);
}

inline std::string add_hoist(RandomNumbers& random, const std::string& what, ClaimedDigits& claims) {
  const double m = std::pow(10.0, random(-2, 2)), r = std::pow(10.0, random(-2, 0)), fall = gravity_of_touching;
  const double inertia = m * r * r * random(0.1, 5), w = random(-2, 4) / r, half = random(-0.4, 1) * fall / r;
  const double until = random(0.2, 1), below = random(10, 30) * r + 10, side = random(-1, 1) < 0 ? -1 : 1;
  const Json scene = {
      {"catena", 1},
      {"gravity", {0, -fall}},
      {"bodies",
       {{"load", {{"particle", true}, {"mass", m}, {"position", {side * r, -below}}}},
        {"drum", {{"mass", 2}, {"inertia", inertia}}}}},
      {"constraints", Json::array({{{"type", "revolute"}, {"i", "ground"}, {"j", "drum"}},
                                   {{"type", "absolute_x"}, {"i", "load"}, {"value", side * r}}})},
      {"drivers", Json::array({{{"type", "absolute_angle"},
                                {"name", "drive"},
                                {"i", "drum"},
                                {"value", {{"polynomial", {0, side * w, side * half}}}}}})},
      {"forces",
       Json::array({{{"type", "rope"},
                     {"name", "rope"},
                     {"i", "load"},
                     {"over", Json::array({{{"at", "drum"}, {"radius", r}, {"pulley", "rolls"}, {"side", int(side)}}})},
                     {"j", "drum"}}})},
      {"outputs", {"load.y", "load.vy", "load.ay", "rope.force", "drive.load"}},
      {"analyses", Json::array({{{"type", "inverse_dynamics"}, {"until", until}, {"every", until / 40}}})}};
  const auto exact = [=](Real t) -> TouchingState {
    const Real rate = w + 2 * half * t, change = 2 * Real(half), tension = m * (fall + r * change);
    return {-below + r * (w * t + half * t * t), r * rate, r * change, tension,
            side * (r * tension + inertia * change)};
  };
  return add_driven_rope(scene, what, exact, claims);
}

inline std::string add_rope_digits(unsigned seed, ClaimedDigits& claims) {
  RandomNumbers random(seed);
  const std::string number = std::to_string(seed);
  switch (seed % 4) {
    case 0:
      return add_arm_about_peg(random, "arm " + number, claims);
    case 1:
      return add_hoist(random, "hoist " + number, claims);
    default: {
      TouchingCase c = seed % 4 == 2 ? pendulum_on_peg(random) : weight_past_peg(random);
      return add_motion(std::move(c), random, "rope", seed, claims);
    }
  }
}

}  // namespace catena::testing
