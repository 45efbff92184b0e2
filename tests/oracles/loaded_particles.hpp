// A particle on springs to fixed points, under a load that grows: its path of equilibria, followed here in small steps
// by the closed form alone, and what a path of the library must keep to.
//
//   F(r, p) = sum k_i (1 - l_i / |r - a_i|) (r - a_i) - p d = 0      N, r in m
//
// In lengths L and stiffnesses k0 over many orders of magnitude.
#pragma once

#include <array>
#include <cmath>
#include <memory>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "catena/analysis/stability/path.hpp"
#include "catena/elements/forces/point_force.hpp"
#include "catena/elements/forces/spring_damper.hpp"
#include "catena/model/model_add.hpp"

namespace catena::testing {

class LoadedParticle {
 public:
  using Point = std::array<double, 3>;  // x, y in L, p in k0 L

  explicit LoadedParticle(unsigned seed) {
    std::mt19937 random(seed);
    const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
    length_ = seed % 2 ? std::pow(10.0, uniform(-9, 9)) : 1;
    stiffness_ = seed % 2 ? std::pow(10.0, uniform(-9, 9)) : 1000;
    const int count = 2 + static_cast<int>(random() % 3);
    // Shallow ones snap, symmetric ones branch.
    const bool symmetric = seed % 3 == 0;
    const double height = uniform(0.15, 0.9);
    for (int k = 0; k < count; ++k) {
      const double side = k % 2 ? 1 : -1;
      springs_.push_back({side * (symmetric ? 1 : uniform(0.5, 1.5)), symmetric ? -0.3 * (k / 2) : uniform(-0.4, 0.1),
                          symmetric ? 1 : uniform(0.3, 3), 0});
    }
    start_ = {0, height, 0};
    for (Spring& s : springs_) s.rest = std::hypot(s.x - start_[0], s.y - start_[1]);
    const double slope = symmetric ? 0 : uniform(-0.4, 0.4);
    direction_ = {std::sin(slope), -std::cos(slope)};
    to_ = uniform(0.2, 3);
  }

  double to() const { return to_ * stiffness_ * length_; }
  std::shared_ptr<Model> model_at(double load) const {
    auto model = std::make_shared<Model>();
    model->add_body("p", {.mass = 1, .position = {start_[0] * length_, start_[1] * length_}, .particle = true});
    for (const Spring& s : springs_) {
      SpringDamper<double> spring;
      spring.s_i = {s.x * length_, s.y * length_};
      spring.k = s.k * stiffness_;
      spring.length = s.rest * length_;
      model->add_force("", spring, ground, 0);
    }
    model->add_force("", PointForce<double>{}, 0, ground, {load * direction_[0], load * direction_[1]});
    return model;
  }

  /// Follows the path with the library; what is wrong with it, in words, or nothing.
  std::string check() const {
    std::vector<Point> rows;
    Path path(model_at(0), [&](double load) { return model_at(load); }, {.from = 0, .to = to()});
    const PathReport report = path.run([&](double p, const Snapshot& snapshot) {
      const Frame<double> frame = snapshot.evaluator.ground_frame(0);
      rows.push_back({frame.x / length_, frame.y / length_, p / (stiffness_ * length_)});
      return true;
    });
    std::ostringstream what;
    what.precision(10);
    ended_ = report.ok();
    for (std::size_t k = 0; k < rows.size(); ++k) {
      const auto f = force(rows[k]);
      if (!(std::hypot(f[0], f[1]) <= 1e-9 + rounding(rows[k]))) {
        what << "row " << k << " does not balance by " << std::hypot(f[0], f[1]);
        return what.str();
      }
    }
    for (std::size_t k = 0; k + 1 < rows.size(); ++k) {
      if (is_tied(rows[k], rows[k + 1])) continue;
      what << "row " << k + 1 << " of " << rows.size() << " lies on another path: (" << rows[k][0] << ", " << rows[k][1]
           << ", " << rows[k][2] << ") to (" << rows[k + 1][0] << ", " << rows[k + 1][1] << ", " << rows[k + 1][2]
           << ")";
      return what.str();
    }
    return what.str();
  }
  /// Whether the path that was checked reached its end.
  bool ended() const { return ended_; }

 private:
  struct Spring {
    double x, y, k, rest;
  };

  std::array<double, 2> force(const Point& z) const {
    std::array<double, 2> f{-z[2] * direction_[0], -z[2] * direction_[1]};
    for (const Spring& s : springs_) {
      const double hx = z[0] - s.x, hy = z[1] - s.y, l = std::hypot(hx, hy);
      f[0] += s.k * (1 - s.rest / l) * hx;
      f[1] += s.k * (1 - s.rest / l) * hy;
    }
    return f;
  }
  // The direction of a short spring is known no better than its ends are.
  double rounding(const Point& z) const {
    double sum = 0;
    for (const Spring& s : springs_) sum += s.k * s.rest * 1e-15 / std::hypot(z[0] - s.x, z[1] - s.y);
    return sum;
  }
  // Rows of dF / d(x, y, p).
  std::array<Point, 2> gradient(const Point& z) const {
    std::array<Point, 2> g{Point{0, 0, -direction_[0]}, Point{0, 0, -direction_[1]}};
    for (const Spring& s : springs_) {
      const double hx = z[0] - s.x, hy = z[1] - s.y, l = std::hypot(hx, hy), t = s.rest / (l * l * l);
      g[0][0] += s.k * (1 - s.rest / l + t * hx * hx);
      g[0][1] += s.k * t * hx * hy;
      g[1][0] += s.k * t * hx * hy;
      g[1][1] += s.k * (1 - s.rest / l + t * hy * hy);
    }
    return g;
  }
  // The tangent is the cross product of the two gradients.
  Point tangent(const Point& z, const Point& before) const {
    const auto g = gradient(z);
    Point t{g[0][1] * g[1][2] - g[0][2] * g[1][1], g[0][2] * g[1][0] - g[0][0] * g[1][2],
            g[0][0] * g[1][1] - g[0][1] * g[1][0]};
    const double n = std::sqrt(t[0] * t[0] + t[1] * t[1] + t[2] * t[2]);
    const double side = t[0] * before[0] + t[1] * before[1] + t[2] * before[2] < 0 ? -1 : 1;
    for (double& v : t) v *= side / n;
    return t;
  }
  // Back onto the path in the plane across the tangent.
  void correct(Point& z, const Point& t) const {
    for (int k = 0; k < 4; ++k) {
      const auto f = force(z);
      const auto g = gradient(z);
      // Cramer's rule for [g0; g1; t] dz = [-f0; -f1; 0].
      const auto cross = [](const Point& a, const Point& b) {
        return Point{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
      };
      const Point b = cross(g[1], t), c = cross(t, g[0]);
      const double det = g[0][0] * b[0] + g[0][1] * b[1] + g[0][2] * b[2];
      for (std::size_t i = 0; i < 3; ++i) z[i] -= (f[0] * b[i] + f[1] * c[i]) / det;
    }
  }
  // Whether the path through one row comes by the next one within a few times their distance, by small steps. At a
  // branch point both ways out are as good.
  bool is_tied(const Point& from, const Point& to) const {
    const auto distance = [](const Point& a, const Point& b) {
      return std::sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]));
    };
    const double gap = distance(from, to);
    if (gap < 1e-7) return true;
    Point straight;
    for (std::size_t i = 0; i < 3; ++i) straight[i] = (to[i] - from[i]) / gap;
    constexpr int parts = 400;
    const double s = gap / parts;
    Point z = from, t = tangent(z, straight);
    double nearest = gap;
    for (int k = 0; k < 3 * parts; ++k) {
      Point next = z;
      for (std::size_t i = 0; i < 3; ++i) next[i] += s * t[i];
      correct(next, t);
      t = tangent(next, t);
      z = next;
      nearest = std::min(nearest, distance(z, to));
      if (nearest <= s) return true;
    }
    return false;
  }

  double length_, stiffness_, to_;
  std::vector<Spring> springs_;
  Point start_;
  std::array<double, 2> direction_;
  mutable bool ended_ = false;
};

}  // namespace catena::testing
