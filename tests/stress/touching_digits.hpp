// Digits of random motions with impacts, contact and dry friction: what dynamics claims of them beside the same laws in
// long double.
//
//   ball       flies in parabolas over a slope, g_n t^2 / 2 + v_n t + n = r at the next impact, v_n+ = -e v_n-; a
//              rebound slower than 1e-4 of the largest speed so far is none, and it slides on
//   block      on a spring and a belt of speed V: x = c + (x_0 - c) cos w t + v_0 / w sin w t, c = +- mu m g / k, until
//              x' = V; then with the belt until k |x| = mu_static m g
//   pendulum   phi'' = -(m g c / (J + m c^2)) cos phi by extrapolation, against a wall: phi'+ = -e phi'-
#pragma once

#include <array>
#include <optional>

#include "oracles/claimed_digits.hpp"
#include "oracles/scene_text.hpp"
#include "stress/cases.hpp"
#include "stress/dense_mechanism.hpp"
#include "stress/random_scene.hpp"

namespace catena::testing {

constexpr double gravity_of_touching = 9.81;

/// Places and velocities at an instant: [x, vx, y, vy], [x, vx] or [phi, omega].
using TouchingState = std::vector<Real>;

/// A random scene and its columns at ascending instants; nothing where the oracle gives up.
struct TouchingCase {
  Json scene;
  std::vector<std::string> columns;
  std::function<std::optional<std::vector<TouchingState>>(const std::vector<double>& t)> exact;
  double until = 0;
};

inline TouchingCase bouncing_ball(RandomNumbers& random) {
  const double slope = random(-0.6, 0.6), e = random(0.2, 0.95), radius = random(0.01, 0.1);
  const double height = radius + random(0.1, 1), along = random(-1, 1), up = random(-1, 1);
  const double dx = std::cos(slope), dy = -std::sin(slope);
  const double x = -dy * height, y = dx * height, vx = along * dx - up * dy, vy = along * dy + up * dx;
  TouchingCase c;
  c.scene["bodies"]["ball"] = {
      {"particle", true}, {"mass", random(0.1, 5)}, {"position", {x, y}}, {"velocity", {vx, vy}}};
  c.scene["forces"] = Json::array({{{"type", "contact"},
                                    {"i", "ground"},
                                    {"j", "ball"},
                                    {"radius", radius},
                                    {"restitution", e},
                                    {"curve", {{"line", {{"point", {0, 0}}, {"axis", {dx, dy}}}}}}}});
  c.columns = {"ball.x", "ball.vx", "ball.y", "ball.vy"};
  c.until = random(0.3, 4);
  c.exact = [=](const std::vector<double>& instants) -> std::optional<std::vector<TouchingState>> {
    const Real norm = std::hypot(Real(dx), Real(dy)), tx = dx / norm, ty = dy / norm, nx = -ty, ny = tx;
    const Real an = -gravity_of_touching * ny, at = -gravity_of_touching * ty;
    // Along and across the slope.
    Real t = 0, w = x * tx + y * ty, n = x * nx + y * ny - radius, vw = vx * tx + vy * ty, vn = vx * nx + vy * ny;
    Real fastest = std::hypot(vw, vn);
    bool rests = false;
    std::vector<TouchingState> states;
    for (const double end : instants) {
      while (true) {
        const Real flight = rests ? 1e300L : (-vn - std::sqrt(vn * vn - 2 * an * n)) / an;
        const Real h = std::min(flight, end - t);
        w += vw * h + at * h * h / 2;
        vw += at * h;
        if (!rests) n += vn * h + an * h * h / 2;
        if (!rests) vn += an * h;
        if (h != flight) {
          t = end;
          break;
        }
        t += h;
        n = 0;
        fastest = std::max(fastest, std::hypot(vw, vn));
        vn *= -e;
        const Real part = vn / (1e-4L * fastest);
        if (part > 0.3L && part < 3) return std::nullopt;  // the law hangs on how exactly the speed is known
        rests = part < 1;
        if (rests) vn = 0;
      }
      states.push_back({w * tx + (n + radius) * nx, vw * tx + vn * nx, w * ty + (n + radius) * ny, vw * ty + vn * ny});
    }
    return states;
  };
  return c;
}

inline TouchingCase rubbing_block(RandomNumbers& random) {
  const double mass = random(0.5, 2), k = random(50, 200), mu = random(0.05, 0.3), more = random(1, 1.5);
  const double x_0 = random(-0.4, 0.4), v_0 = random(-1, 1), belt = random(-1, 1) > 0 ? random(0.05, 0.5) : 0;
  TouchingCase c;
  c.scene["bodies"]["belt"] = {{"mass", 1}, {"inertia", 1}, {"velocity", {belt, 0}}};
  c.scene["bodies"]["block"] = {{"particle", true}, {"mass", mass}, {"position", {x_0, 0}}, {"velocity", {v_0, 0}}};
  c.scene["constraints"] = Json::array({{{"type", "absolute_y"}, {"i", "belt"}, {"value", 0}},
                                        {{"type", "absolute_angle"}, {"i", "belt"}, {"value", 0}}});
  c.scene["drivers"] = Json::array({{{"type", "absolute_x"}, {"i", "belt"}, {"value", {{"polynomial", {0, belt}}}}}});
  c.scene["forces"] =
      Json::array({{{"type", "contact"},
                    {"i", "belt"},
                    {"j", "block"},
                    {"mu", mu},
                    {"mu_static", more * mu},
                    {"curve", {{"line", {{"point", {0, 0}}, {"axis", {1, 0}}}}}}},
                   {{"type", "spring_damper"}, {"i", {"ground", {-1, 0}}}, {"j", "block"}, {"length", 1}, {"k", k}}});
  c.columns = {"block.x", "block.vx"};
  c.until = random(0.2, 4);
  c.exact = [=](const std::vector<double>& instants) -> std::optional<std::vector<TouchingState>> {
    const Real w = std::sqrt(Real(k) / mass), grip = Real(more * mu) * mass * gravity_of_touching / k;
    const Real shift = Real(mu) * mass * gravity_of_touching / k;
    Real t = 0, x = x_0, v = v_0;
    int slides = v_0 > belt ? 1 : -1;  // its sign; 0: it sticks
    std::vector<TouchingState> states;
    for (const double end : instants) {
      while (true) {
        const Real left = end - t;
        if (slides == 0) {
          const Real stuck = belt > 0 ? (grip - x) / belt : 1e300L;
          const Real h = std::min(stuck, left);
          x += belt * h;
          if (h == left) break;
          t += h;
          slides = -1;
          continue;
        }
        const Real centre = -slides * shift, a = (x - centre) * w, reach = std::hypot(a, v), start = std::atan2(a, v);
        // v(h) = reach cos(start + w h)
        Real h = left + 1;
        for (int root = -3; root <= 3 && reach > std::abs(belt); ++root) {
          for (const int side : {1, -1}) {
            const Real angle = side * std::acos(belt / reach) + root * 2 * std::acos(Real(-1)) - start;
            if (angle > 1e-9L) h = std::min(h, angle / w);
          }
        }
        const bool ends = h <= left;
        if (!ends) h = left;
        x = centre + reach / w * std::sin(start + w * h);
        v = ends ? Real(belt) : reach * std::cos(start + w * h);
        if (!ends) break;
        t += h;
        if (std::abs(std::abs(x) - grip) < 1e-3L * grip) return std::nullopt;
        slides = std::abs(x) < grip ? 0 : x > 0 ? -1 : 1;
      }
      t = end;
      states.push_back({x, slides == 0 ? Real(belt) : v});
    }
    return states;
  };
  return c;
}

inline TouchingCase pendulum_at_wall(RandomNumbers& random) {
  const double mass = random(0.5, 3), arm = random(0.2, 1), inertia = mass * arm * arm * random(0.1, 0.5);
  const double tip = arm * random(1, 2), radius = random(0.01, 0.05), e = random(0.3, 0.95);
  const double wall = tip * random(0.1, 0.6), start = -1.5707963267948966 - random(0.5, 2.5);
  TouchingCase c;
  c.scene["bodies"]["rod"] = {{"mass", mass},
                              {"inertia", inertia},
                              {"position", {arm * std::cos(start), arm * std::sin(start)}},
                              {"angle", start},
                              {"points", {{"tip", {tip - arm, 0}}}}};
  c.scene["constraints"] = Json::array({{{"type", "revolute"}, {"i", {"ground", {0, 0}}}, {"j", {"rod", {-arm, 0}}}}});
  c.scene["forces"] = Json::array({{{"type", "contact"},
                                    {"i", "ground"},
                                    {"j", "rod.tip"},
                                    {"radius", radius},
                                    {"restitution", e},
                                    {"curve", {{"line", {{"point", {wall, 0}}, {"axis", {0, 1}}}}}}}});
  c.columns = {"rod.angle", "rod.omega"};
  c.until = random(0.5, 3) * std::sqrt(arm);
  const auto reach = Real(tip - arm) + arm;
  c.exact = [=](const std::vector<double>& instants) -> std::optional<std::vector<TouchingState>> {
    const Real square = Real(mass) * gravity_of_touching * arm / (Real(inertia) + Real(mass) * arm * arm);
    const auto slope = [square](Real, const Vector& y) {
      Vector rate(2);
      rate << y[1], -square * std::cos(y[0]);
      return rate;
    };
    Vector scale(2), y(2);
    scale << 1, std::sqrt(square);
    y << start, 0;
    const auto after = [&](const Vector& from, Real h) {
      Extrapolation motion(slope, from, scale, 0.02L, 1e-17L);
      return motion.go_to(h, 400) ? motion.y() : Vector::Constant(2, std::nan(""));
    };
    const auto gap = [&](const Vector& at) { return wall - radius - reach * std::cos(at[0]); };
    const Real pace = 0.05L / std::sqrt(square);
    Real t = 0;
    std::vector<TouchingState> states;
    for (const double end : instants) {
      while (t < end) {
        Real h = std::min(pace, end - t);
        Vector next = after(y, h);
        if (!(gap(next) < 0)) {
          t = h == end - t ? end : t + h;
          y = next;
          continue;
        }
        for (int k = 0; k < 12; ++k) {
          next = after(y, h);
          h -= gap(next) / (reach * std::sin(next[0]) * next[1]);
          if (!(h >= 0)) return std::nullopt;
        }
        y = after(y, h);
        if (!(std::abs(gap(y)) < 1e-16L) || std::abs(y[1]) < 1e-2L * std::sqrt(square)) return std::nullopt;
        y[1] *= -e;
        t += h;
        if (t > end) return std::nullopt;
      }
      if (!y.allFinite()) return std::nullopt;
      states.push_back({y[0], y[1]});
    }
    return states;
  };
  return c;
}

/// Adds the columns of one motion by a random method; how it went, in words.
inline std::string add_motion(TouchingCase c, RandomNumbers& random, const std::string& kind, unsigned seed,
                              ClaimedDigits& claims) {
  static const char* const methods[] = {"auto", "rk8", "rk5", "adams"};
  const int method = static_cast<int>(random(0, 3.999));
  const double tolerance = std::pow(10.0, random(-11, -4));
  c.scene["catena"] = 1;
  c.scene["gravity"] = {0, -gravity_of_touching};
  c.scene["outputs"] = c.columns;
  c.scene["analyses"] = Json::array({{{"type", "dynamics"},
                                      {"until", c.until},
                                      {"every", c.until / 9},
                                      {"method", methods[method]},
                                      {"tolerance", tolerance}}});
  keep_scene(kind, seed, c.scene.dump(1));
  const TextRun run = run_text(c.scene.dump());
  if (run.outcome.exit_code > 1) return "not valid: " + run.outcome.error_text;
  if (!run.analysis().report.ok()) return std::string(to_string(run.analysis().report.status));
  if (run.analysis().digits.empty()) return "no claim";
  const auto states = c.exact(run.column("t"));
  if (!states) return "not compared";
  for (std::size_t k = 0; k < c.columns.size(); ++k) {
    std::vector<long double> exact;
    for (const TouchingState& state : *states) exact.push_back(state[k]);
    claims.add(run, c.columns[k], exact,
               kind + " " + std::to_string(seed) + " " + text_of(tolerance) + " " + methods[method]);
  }
  return "compared";
}

inline std::string add_touching_digits(unsigned seed, ClaimedDigits& claims) {
  RandomNumbers random(seed);
  static TouchingCase (*const kinds[])(RandomNumbers&) = {bouncing_ball, rubbing_block, pendulum_at_wall};
  TouchingCase c = kinds[seed % 3](random);
  return add_motion(std::move(c), random, "touching", seed, claims);
}

}  // namespace catena::testing
