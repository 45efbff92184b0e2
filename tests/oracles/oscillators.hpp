// Random oscillators, each with its stiffness and mass as dense matrices written down here, from the geometry alone:
// rows, rings and grids of masses on springs, trolleys with hanging rods, rods on pins with springs between them.
//
//   K v = omega^2 M v over free coordinates y,   q' = B y   (B: what the constraints allow, by hand)
//
// in numbers without units; the model is the same in lengths, masses and stiffnesses over many orders of magnitude:
// omega^2 in rate() times these numbers.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "catena/elements/constraints/revolute.hpp"
#include "catena/elements/constraints/translational.hpp"
#include "catena/elements/forces/bushing.hpp"
#include "catena/elements/forces/spring_damper.hpp"
#include "catena/elements/forces/torsion_spring.hpp"
#include "catena/model/model_add.hpp"
#include "references/dense.hpp"

namespace catena::testing {

class Oscillator {
 public:
  using Matrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;

  std::shared_ptr<Model> model = std::make_shared<Model>();
  std::string kind;

  explicit Oscillator(unsigned seed) : random_(seed) {
    // Lengths of 1e-9 ... 1e9 m, masses and stiffnesses likewise.
    length_ = std::pow(10.0, uniform(-9, 9));
    mass_ = std::pow(10.0, uniform(-9, 9));
    stiffness_ = std::pow(10.0, uniform(-9, 9));
    switch (seed % 5) {
      case 0:
        row();
        break;
      case 1:
        ring();
        break;
      case 2:
        grid();
        break;
      case 3:
        trolley();
        break;
      default:
        rods();
    }
  }

  /// Unit of omega^2, 1/s^2.
  double rate() const { return stiffness_ / mass_; }
  /// In units of rate(), ascending.
  std::vector<long double> omega2() const {
    const Matrix k = allowed_.transpose() * k_ * allowed_, m = allowed_.transpose() * m_ * allowed_;
    return generalized_eigenvalues<long double>(k, m);
  }
  /// Whether the given place is an equilibrium: else there are no exact zeros.
  bool is_balanced() const { return balanced_; }

 private:
  double uniform(double a, double b) { return std::uniform_real_distribution<double>(a, b)(random_); }
  int whole(int a, int b) { return std::uniform_int_distribution<int>(a, b)(random_); }
  bool chance(double p) { return uniform(0, 1) < p; }
  // Equal in half of the scenes, else random; now and then over six orders of magnitude.
  double number() { return equal_ ? 1.0 : std::pow(10.0, spread_ * uniform(-1, 1)); }
  void choose_spread() {
    equal_ = chance(0.5);
    spread_ = chance(0.2) ? 3 : 0.5;
  }

  int body(double x, double y, double angle, double mass, double inertia, bool particle) {
    const int b = model->add_body("b" + std::to_string(x_.size()), {.mass = mass * mass_,
                                                                    .inertia = inertia * mass_ * length_ * length_,
                                                                    .position = {x * length_, y * length_},
                                                                    .angle = angle,
                                                                    .particle = particle});
    x_.push_back(x), y_.push_back(y), angle_.push_back(angle);
    masses_.push_back(mass), inertias_.push_back(inertia), particles_.push_back(particle);
    return b;
  }
  void start_matrices() {
    const auto n = static_cast<Eigen::Index>(3 * x_.size());
    k_ = Matrix::Zero(n, n);
    m_ = Matrix::Zero(n, n);
    for (Eigen::Index b = 0; b < n / 3; ++b) {
      const auto k = static_cast<std::size_t>(b);
      m_(3 * b, 3 * b) = m_(3 * b + 1, 3 * b + 1) = masses_[k];
      m_(3 * b + 2, 3 * b + 2) = inertias_[k];
    }
    // Without constraints everything moves but the angles of particles.
    std::vector<Eigen::Index> free;
    for (Eigen::Index c = 0; c < n; ++c) {
      if (c % 3 != 2 || !particles_[static_cast<std::size_t>(c / 3)]) free.push_back(c);
    }
    allowed_ = Matrix::Zero(n, static_cast<Eigen::Index>(free.size()));
    for (std::size_t c = 0; c < free.size(); ++c) allowed_(free[c], static_cast<Eigen::Index>(c)) = 1;
  }

  // A spring between points of two bodies (-1: the ground, there in ground axes), given in body axes; `stretch`: of its
  // length in parts of itself.
  void spring(int i, Vec2<double> s_i, int j, Vec2<double> s_j, double k, double stretch) {
    const auto arm = [&](int b, const Vec2<double>& s) {
      const long double c = b < 0 ? 1 : std::cos(static_cast<long double>(angle_[at(b)])),
                        d = b < 0 ? 0 : std::sin(static_cast<long double>(angle_[at(b)]));
      return Vec2<long double>{c * s.x - d * s.y, d * s.x + c * s.y};
    };
    const Vec2<long double> a_i = arm(i, s_i), a_j = arm(j, s_j);
    const long double hx = (j < 0 ? 0 : x_[at(j)]) + a_j.x - (i < 0 ? 0 : x_[at(i)]) - a_i.x;
    const long double hy = (j < 0 ? 0 : y_[at(j)]) + a_j.y - (i < 0 ? 0 : y_[at(i)]) - a_i.y;
    const long double l = std::sqrt(hx * hx + hy * hy), nx = hx / l, ny = hy / l;
    const double rest = static_cast<double>(l) * (1 - stretch);
    const long double tension = k * (l - rest);
    if (stretch != 0) balanced_ = false;
    SpringDamper<double> element;
    element.s_i = length_ * s_i;
    element.s_j = length_ * s_j;
    element.k = k * stiffness_;
    element.length = stretch == 0 ? -1.0 : rest * length_;  // -1: as it is
    model->add_force("", element, i, j);
    // d h = sum side (dr + R a dphi), d2 h = -side a dphi^2; V'' = k n n^T + f/l (1 - n n^T) + f n . d2 h.
    const auto column = [](const Vec2<long double>& a, int c) {
      return c == 0 ? Vec2<long double>{1, 0} : c == 1 ? Vec2<long double>{0, 1} : Vec2<long double>{-a.y, a.x};
    };
    struct End {
      int b;
      Vec2<long double> a;
      long double side;
    };
    const End ends[2] = {{i, a_i, -1}, {j, a_j, 1}};
    for (const End& e : ends) {
      for (const End& f : ends) {
        for (int c = 0; e.b >= 0 && f.b >= 0 && c < 3; ++c) {
          for (int d = 0; d < 3; ++d) {
            const Vec2<long double> u = column(e.a, c), v = column(f.a, d);
            const long double un = u.x * nx + u.y * ny, vn = v.x * nx + v.y * ny, uv = u.x * v.x + u.y * v.y;
            long double value = e.side * f.side * (k * un * vn + (stretch == 0 ? 0 : tension / l) * (uv - un * vn));
            if (&e == &f && c == 2 && d == 2 && stretch != 0) value -= e.side * tension * (e.a.x * nx + e.a.y * ny);
            k_(3 * e.b + c, 3 * f.b + d) += value;
          }
        }
      }
    }
  }
  void torsion(int i, int j, double k) {
    TorsionSpring<double> element;
    element.k = k * stiffness_ * length_ * length_;
    model->add_force("", element, i, j);
    for (int a : {i, j}) {
      for (int b : {i, j}) {
        if (a >= 0 && b >= 0) k_(3 * a + 2, 3 * b + 2) += a == b ? k : -k;
      }
    }
  }
  // To the ground at the body's origin.
  void bushing(int b, double kx, double ky, double kt) {
    Bushing<double> element;
    element.s_i = {x_[at(b)] * length_, y_[at(b)] * length_};
    element.kx = kx * stiffness_;
    element.ky = ky * stiffness_;
    element.kt = particles_[at(b)] ? 0 : kt * stiffness_ * length_ * length_;
    element.angle = angle_[at(b)];
    model->add_force("", element, ground, b);
    k_(3 * b, 3 * b) += kx;
    k_(3 * b + 1, 3 * b + 1) += ky;
    if (!particles_[at(b)]) k_(3 * b + 2, 3 * b + 2) += kt;
  }
  void hold_some() {
    const int count = whole(0, 2);
    for (int k = 0; k < count; ++k) {
      bushing(whole(0, static_cast<int>(x_.size()) - 1), number(), chance(0.5) ? number() : 0, 0.1 * number());
    }
  }

  void row() {
    kind = "row";
    choose_spread();
    const int n = whole(3, 12);
    const bool particles = chance(0.6);
    const double slope = chance(0.5) ? 0 : uniform(0, 6);
    for (int b = 0; b < n; ++b)
      body(b * std::cos(slope), b * std::sin(slope), particles || chance(0.5) ? 0 : uniform(-3, 3), number(), number(),
           particles);
    start_matrices();
    for (int b = 0; b + 1 < n; ++b) {
      const Vec2<double> out =
          particles || chance(0.5) ? Vec2<double>{} : Vec2<double>{uniform(-.3, .3), uniform(-.3, .3)};
      spring(b, out, b + 1, {}, number(), 0);
      if (!particles && chance(0.7)) torsion(b, b + 1, 0.3 * number());
    }
    if (chance(0.3)) spring(-1, {x_[0] - std::cos(slope), y_[0] - std::sin(slope)}, 0, {}, number(), 0);
    hold_some();
  }
  void ring() {
    kind = "ring";
    choose_spread();
    const int n = whole(3, 12);
    const bool particles = chance(0.3);
    // Stretched alike, a regular ring is not in balance without springs inside, but its K is as good as any.
    const double stretch = chance(0.25) ? uniform(-0.2, 0.5) : 0;
    for (int b = 0; b < n; ++b) {
      const double a = 2 * std::acos(-1.0) * b / n;
      body(std::cos(a), std::sin(a), particles ? 0 : a, number(), 0.3 * number(), particles);
    }
    start_matrices();
    for (int b = 0; b < n; ++b) {
      spring(b, {}, (b + 1) % n, {}, number(), stretch);
      if (!particles) torsion(b, (b + 1) % n, 0.3 * number());
    }
    hold_some();
  }
  void grid() {
    kind = "grid";
    choose_spread();
    const int a = whole(2, 4), c = whole(2, 3);
    const bool particles = chance(0.8), braced = chance(0.5);
    for (int k = 0; k < a * c; ++k) body(k % a, k / a, 0, number(), number(), particles);
    start_matrices();
    for (int k = 0; k < a * c; ++k) {
      if (k % a + 1 < a) spring(k, {}, k + 1, {}, number(), 0);
      if (k / a + 1 < c) spring(k, {}, k + a, {}, number(), 0);
      if (braced && k % a + 1 < a && k / a + 1 < c) spring(k, {}, k + a + 1, {}, number(), 0);
      if (!particles && k > 0) torsion(k - 1, k, number());
    }
    hold_some();
  }
  // A cart on a level rail with a chain of rods that hangs from it: x and the angles of the rods.
  void trolley() {
    kind = "trolley";
    choose_spread();
    const int n = whole(1, 5);
    std::vector<double> lengths;
    body(0, 0, 0, number(), number(), false);
    double depth = 0;
    for (int k = 0; k < n; ++k) {
      lengths.push_back(equal_ ? 1 : uniform(0.3, 2));
      const double m = number();
      body(0, -depth - lengths.back() / 2, 0, m, m * lengths.back() * lengths.back() / 12, false);
      depth += lengths.back();
    }
    start_matrices();
    const double g = uniform(0.1, 3);
    model->gravity = {0, -g * rate() * length_};
    Translational<double> rail;
    rail.axis_i = {1, 0};
    rail.axis_j = {1, 0};
    model->add("", rail, ground, 0);
    for (int k = 0; k < n; ++k) {
      model->add("",
                 Revolute<double>{.s_i = {0, k == 0 ? 0 : -length_ * lengths[at(k - 1)] / 2},
                                  .s_j = {0, length_ * lengths[at(k)] / 2}},
                 k, k + 1);
      if (chance(0.4)) torsion(k, k + 1, number());
    }
    if (chance(0.5)) bushing(0, number(), 0, 0);
    // Small angles: x of rod k is that of the cart + sum of lengths above times angles; V = sum w l theta^2 / 2.
    allowed_ = Matrix::Zero(3 * (n + 1), n + 1);
    for (int k = 0; k <= n; ++k) allowed_(3 * k, 0) = 1;
    for (int k = 1; k <= n; ++k) {
      allowed_(3 * k + 2, k) = 1;
      allowed_(3 * k, k) = lengths[at(k - 1)] / 2;
      for (int below = k + 1; below <= n; ++below) allowed_(3 * below, k) = lengths[at(k - 1)];
      long double weight = masses_[at(k)] / 2;
      for (int below = k + 1; below <= n; ++below) weight += masses_[at(below)];
      k_(3 * k + 2, 3 * k + 2) += weight * g * lengths[at(k - 1)];
    }
  }
  // Rods pinned end to end at random angles, free in the plane or on a pin, with torsion springs at some of the pins.
  void rods() {
    kind = "rods";
    choose_spread();
    const int n = whole(2, 8);
    const bool pinned = chance(0.5);
    std::vector<Vec2<double>> half;
    double x = uniform(-2, 2), y = uniform(-2, 2);
    const Vec2<double> foot{x, y};
    for (int k = 0; k < n; ++k) {
      const double l = equal_ ? 1 : uniform(0.3, 2), a = uniform(-3, 3), m = number();
      half.push_back({l / 2 * std::cos(a), l / 2 * std::sin(a)});
      body(x + half.back().x, y + half.back().y, a, m, m * l * l / 12, false);
      lengths_.push_back(l);
      x += 2 * half.back().x;
      y += 2 * half.back().y;
    }
    start_matrices();
    if (pinned)
      model->add("", Revolute<double>{.s_i = length_ * foot, .s_j = {-length_ * lengths_[0] / 2, 0}}, ground, 0);
    for (int k = 1; k < n; ++k) {
      model->add(
          "",
          Revolute<double>{.s_i = {length_ * lengths_[at(k - 1)] / 2, 0}, .s_j = {-length_ * lengths_[at(k)] / 2, 0}},
          k - 1, k);
      if (chance(0.7)) torsion(k - 1, k, number());
    }
    if (chance(0.3)) torsion(-1, whole(0, n - 1), number());
    const int places = pinned ? 0 : 2;
    allowed_ = Matrix::Zero(3 * n, n + places);
    for (int k = 0; k < n; ++k) {
      if (!pinned) allowed_(3 * k, 0) = allowed_(3 * k + 1, 1) = 1;
      for (int r = 0; r <= k; ++r) {
        const double part = r == k ? 1 : 2;
        allowed_(3 * k, places + r) = -part * half[at(r)].y;
        allowed_(3 * k + 1, places + r) = part * half[at(r)].x;
      }
      allowed_(3 * k + 2, places + k) = 1;
    }
  }

  static std::size_t at(int k) { return static_cast<std::size_t>(k); }

  std::mt19937 random_;
  double length_, mass_, stiffness_, spread_ = 0;
  bool equal_ = false, balanced_ = true;
  std::vector<double> x_, y_, angle_, masses_, inertias_, lengths_;
  std::vector<bool> particles_;
  Matrix k_, m_, allowed_;
};

}  // namespace catena::testing
