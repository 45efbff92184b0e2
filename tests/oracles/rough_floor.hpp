// A rod of half length 1 m and 1 kg whose ends bounce, slide, stick and leave a rough floor: an independent motion, by
// events in the few equations of one body.
//
//   at an end (r from the centre), N and T from    I phi'' = r_x N - r_y T,   m a = (T, N - m g)
//   slides: the end's a_y = 0, T = -mu s N         sticks: a_x = 0, too, while |T| <= mu_static N
//   lands: v+ = v- + D p, D in the metric of the masses, v_y+ = -e v_y- (0 below rest_speed); p_x stops the slip within
//   mu p_y, else equals that; where energy would grow, v_y = 0 first and then p_y once more e times as large
//
// Runge-Kutta 4 with steps of 0.2 ms, ends of phases by bisection: errors of 1e-11. It ends where both ends would
// touch, where friction wedges the rod, where rounding decides, and, as Newton's law leaves that open, where an impact
// would make energy grow.
#pragma once

#include <array>
#include <cmath>
#include <string>

#include "oracles/scene_text.hpp"

namespace catena::testing {

class RodOnRoughFloor {
 public:
  struct Problem {
    std::array<double, 6> start;  ///< x, y, angle, vx, vy, omega
    double mu, mu_static, restitution, rest_speed, until;
  };
  explicit RodOnRoughFloor(const Problem& problem) : of_(problem), y_(problem.start) {}

  static Problem random(unsigned seed) {
    RandomNumbers draw(seed);
    const auto one_of = [&](double share, double low, double high) {
      return draw(0, 1) < share ? draw(low, high) : 0.0;
    };
    Problem p{};
    const double angle = draw(-3.1, 3.1);
    p.start = {0,
               std::abs(std::sin(angle)) + draw(0.005, 0.4),
               angle,
               one_of(0.6, -4, 4),
               one_of(0.6, -3, 1),
               one_of(0.6, -5, 5)};
    p.mu = draw(0, 1) < 0.8 ? draw(0.05, draw(0, 1) < 0.5 ? 0.8 : 2.5) : 0;
    p.mu_static = p.mu * (draw(0, 1) < 0.3 ? 1.3 : 1);
    p.restitution = one_of(0.4, 0.1, 0.9);
    p.rest_speed = 0.05;
    p.until = draw(0.3, 1);
    if (seed % 5 == 0) {
      // Slips against its spin, so that friction turns it back: often with energy that Newton's law makes.
      const double turned = draw(2, 2.4);
      p.start = {0, std::sin(turned) + 0.01, turned, draw(1.5, 2.2), 0, draw(-5, -4)};
      p.mu = p.mu_static = draw(0.5, 0.7);
      p.restitution = draw(0.75, 0.95);
    }
    return p;
  }

  /// Goes on to `until`; the instant where it ends.
  double run(double until) {
    while (t_ < until - 1e-14 && !ended_) advance(std::min(step_size, until - t_));
    return t_;
  }
  const std::array<double, 6>& state() const { return y_; }
  int changes() const { return changes_; }
  /// Impacts by Poisson's law.
  int other_laws() const { return other_laws_; }

 private:
  using State = std::array<double, 6>;
  struct Motion {
    double ax, ay, alpha, N, T;
  };
  enum class Change { none, hit, release, slip, stick };
  static constexpr double g = 9.81, inertia = 1.0 / 3, step_size = 2e-4, wedge = 0.03;

  static std::array<double, 2> arm(const State& y, int end) { return {end * std::cos(y[2]), end * std::sin(y[2])}; }
  static double height(const State& y, int end) { return y[1] + arm(y, end)[1]; }
  static double slip(const State& y, int end) { return y[3] - arm(y, end)[1] * y[5]; }
  static double rise(const State& y, int end) { return y[4] + arm(y, end)[0] * y[5]; }

  Motion motion(const State& y) {
    if (end_ == 0) return {0, -g, 0, 0, 0};
    const auto [rx, ry] = arm(y, end_);
    const double w2 = y[5] * y[5];
    double N, T;
    if (slides_ == 0) {
      const double a = 1 + ry * ry / inertia, b = -ry * rx / inertia, c = 1 + rx * rx / inertia;
      const double along = w2 * rx, across = g + w2 * ry;
      T = (along * c - b * across) / (a * c - b * b);
      N = (a * across - b * along) / (a * c - b * b);
    } else {
      const double p = 1 + (rx * rx + of_.mu * slides_ * rx * ry) / inertia;
      ended_ |= p < wedge;
      N = (g + w2 * ry) / std::max(p, wedge);
      T = -of_.mu * slides_ * N;
    }
    return {T, N - g, (rx * N - ry * T) / inertia, N, T};
  }
  State slope(const State& y) {
    const Motion m = motion(y);
    return {y[3], y[4], y[5], m.ax, m.ay, m.alpha};
  }
  State stepped(const State& y, double h) {
    const auto moved = [&](const State& along, double by) {
      State z = y;
      for (std::size_t k = 0; k < 6; ++k) z[k] += by * along[k];
      return z;
    };
    const State a = slope(y), b = slope(moved(a, h / 2)), c = slope(moved(b, h / 2)), d = slope(moved(c, h));
    State z = y;
    for (std::size_t k = 0; k < 6; ++k) z[k] += h / 6 * (a[k] + 2 * b[k] + 2 * c[k] + d[k]);
    return z;
  }
  Change change(const State& y) {
    for (const int end : {-1, 1}) {
      if (end != end_ && height(y, end) < 0 && rise(y, end) < 0) {
        hit_ = end;
        return Change::hit;
      }
    }
    if (end_ == 0) return Change::none;
    const Motion m = motion(y);
    if (m.N < 0) return Change::release;
    if (slides_ == 0) return std::abs(m.T) > of_.mu_static * m.N ? Change::slip : Change::none;
    return slip(y, end_) * slides_ < 0 ? Change::stick : Change::none;
  }
  void advance(double h) {
    const State next = stepped(y_, h);
    if (ended_) return;
    if (change(next) == Change::none) {
      y_ = next;
      t_ += h;
      return;
    }
    double low = 0, high = h;
    for (int halving = 0; halving < 55; ++halving) {
      const double middle = (low + high) / 2;
      (change(stepped(y_, middle)) == Change::none ? low : high) = middle;
    }
    y_ = stepped(y_, high);
    t_ += high;
    ++changes_;
    switch (change(y_)) {
      case Change::none:
        break;
      case Change::hit:
        land();
        break;
      case Change::release:
        end_ = 0;
        break;
      case Change::slip:
        slide_off();
        break;
      case Change::stick:
        decide_at_rest();
        break;
    }
  }
  void slide_off() {
    slides_ = motion(y_).T > 0 ? -1 : 1;
    y_[3] -= slip(y_, end_) - 1e-15 * slides_;
  }
  void decide_at_rest() {
    y_[3] -= slip(y_, end_);
    slides_ = 0;
    const Motion m = motion(y_);
    if (m.N < 0) {
      end_ = 0;
    } else if (std::abs(m.T) > of_.mu_static * m.N) {
      slide_off();
    }
  }
  void land() {
    ended_ = end_ != 0 || height(y_, -hit_) < 1e-3;
    if (ended_) return;
    const auto [rx, ry] = arm(y_, hit_);
    const double nn = 1 + rx * rx / inertia, nt = -rx * ry / inertia, tt = 1 + ry * ry / inertia;
    double rebound = -of_.restitution * rise(y_, hit_);
    ended_ = std::abs(rebound - of_.rest_speed) < 0.3 * of_.rest_speed;
    if (rebound < of_.rest_speed) rebound = 0;
    const double before = energy();
    const State y = y_;
    press(rebound - rise(y_, hit_), nn, nt, tt);
    const double by_newton = energy();
    if (by_newton > before && !ended_) {
      // Newton's law would make energy grow: Poisson's, compression and release.
      y_ = y;
      const double P = rebound > 0 ? of_.restitution * press(-rise(y_, hit_), nn, nt, tt) : 0;
      const double free = slip(y_, hit_) + nt * P, stop = -free / tt;
      const double S = std::abs(stop) <= of_.mu * P ? stop : std::copysign(of_.mu * P, stop);
      ended_ |= std::abs(std::abs(stop) - of_.mu * P) < 1e-6 * P;
      push(P, S);
      ended_ |= rise(y_, hit_) < 0;
      ++other_laws_;
    }
    // Between both laws rounding decides.
    ended_ |= energy() > before * (1 - 1e-9) || std::abs(by_newton - before) < 1e-6 * before;
    if (rebound > 0 || ended_) return;
    end_ = hit_;
    slides_ = slip(y_, end_) > 0 ? 1 : -1;
    if (std::abs(slip(y_, end_)) < 1e-9) decide_at_rest();
    if (end_ != 0 && motion(y_).N < 0) end_ = 0;
  }
  void push(double P, double S) {
    const auto [rx, ry] = arm(y_, hit_);
    y_[3] += S;
    y_[4] += P;
    y_[5] += (rx * P - ry * S) / inertia;
  }
  /// Gives the end that is hit the change `n` of its rise, friction along; the impulse across.
  double press(double n, double nn, double nt, double tt) {
    const double t = -slip(y_, hit_), determinant = nn * tt - nt * nt;
    double P = (n * tt - nt * t) / determinant, S = (nn * t - nt * n) / determinant;
    if (!(P >= 0 && std::abs(S) <= of_.mu * P)) {
      for (const int s : {1, -1}) {
        const double resistance = nn - of_.mu * s * nt;
        ended_ |= resistance < wedge;
        P = n / resistance;
        S = -of_.mu * s * P;
        if ((slip(y_, hit_) + nt * P + tt * S) * s >= 0) break;
      }
    }
    push(P, S);
    return P;
  }
  double energy() const { return (y_[3] * y_[3] + y_[4] * y_[4] + inertia * y_[5] * y_[5]) / 2; }

  Problem of_;
  State y_;
  double t_ = 0;
  int end_ = 0;     // that touches: 1, -1, or 0
  int slides_ = 0;  // sign of its slip; 0: it sticks
  int hit_ = 0, changes_ = 0, other_laws_ = 0;
  bool ended_ = false;
};

}  // namespace catena::testing
