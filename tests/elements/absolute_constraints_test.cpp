// The absolute constraints against the published table (apps/manual/constraints.md#absolute-constraints), written out
// here in 50-digit arithmetic: Phi, Phi_q, nu, gamma.
#if __has_include(<boost/multiprecision/cpp_dec_float.hpp>)

#include <gtest/gtest.h>

#include <limits>

#include "catena/elements/all.hpp"
#include "elements/exact.hpp"

namespace catena {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

/// A body, its point P, its rates, and a value that moves: all numbers with no special relation to each other.
struct Given {
  double x, y, phi, px, py, vx, vy, omega;
  Taylor<double> c;
  Vec2<double> centre;
};

const Given cases[] = {
    {0.3, -1.2, 0.7, 0.25, -0.4, 1.1, -0.6, 2.3, {0.9, 0.4, -1.7}, {0.1, 0.35}},
    {-2.5, 0.8, -4.1, -1.3, 0.05, -0.2, 0.9, -7.7, {2.25, -3.1, 0.6}, {-1.0, 2.0}},
    {1e-3, 2e-3, 31.4, 5e-4, -7e-4, 0.04, 0.01, 120.0, {1.5e-3, 0.02, -3.0}, {-4e-3, 1e-3}},
    {800.0, -350.0, 1e-9, 120.0, 0.0, 3.0, -8.0, 0.01, {500.0, 2.0, 0.25}, {30.0, 40.0}},
};

struct Table {
  Exact phi, phi_q[3], nu, gamma;
};

/// What the library makes of one row.
struct Found {
  double phi, phi_q[3], nu, gamma;
};

template <class E>
Found evaluate(const E& element, const Given& g) {
  ConstraintBlock<E> block;
  block.entry = block.body_i = block.body_j = {0};
  for (int k = 0; k < varying_entries<E>(); ++k) block.slot.push_back(k);
  ConstraintData<E> data;
  data.element = {element};
  data.shift.resize(1);
  data.scale = {1};
  data.timed = {{0, 0}};
  Pose pose;
  pose.values = {g.c};
  pose.frames = {make_frame(g.x, g.y, g.phi)};
  const double qd[3] = {g.vx, g.vy, g.omega};
  Found found{};
  ConstraintOperations<E>::phi(block, data, pose, &found.phi);
  double varying[3];
  ConstraintOperations<E>::jacobian(block, data, pose, varying);
  constexpr auto pattern = jacobian_pattern<E>();
  for (std::size_t k = 0, next = 0; k < 3; ++k)
    found.phi_q[k] = pattern[k] == Entry::varying ? varying[next++] : pattern[k] == Entry::plus_one ? 1 : 0;
  ConstraintOperations<E>::nu(block, data, pose, &found.nu);
  ConstraintOperations<E>::gamma(block, data, pose, qd, &found.gamma);
  return found;
}

/// A few roundings of the largest terms: `length` is that of the positions in the row, `row` what multiplies it.
void expect_table(const Found& found, const Table& table, double row, double length, double rate) {
  const auto near = [](double value, const Exact& exact, double size, const char* what) {
    EXPECT_LE(std::abs(value_of(Exact(value) - exact)), 4 * eps * size) << what << ": " << value << " for " << exact;
  };
  near(found.phi, table.phi, row * length, "Phi");
  near(found.phi_q[0], table.phi_q[0], row, "dPhi/dx");
  near(found.phi_q[1], table.phi_q[1], row, "dPhi/dy");
  near(found.phi_q[2], table.phi_q[2], row * length, "dPhi/dphi");
  near(found.nu, table.nu, row * length * rate, "nu");
  near(found.gamma, table.gamma, row * length * rate * rate, "gamma");
}

double length_of(const Given& g) {
  return std::abs(g.x) + std::abs(g.y) + std::abs(g.px) + std::abs(g.py) + std::abs(g.c.f) + norm(g.centre);
}
double rate_of(const Given& g) {
  const double length = length_of(g);
  return (std::abs(g.vx) + std::abs(g.vy) + std::abs(g.c.d)) / length + std::abs(g.omega) +
         std::sqrt(std::abs(g.c.dd) / length);
}

TEST(AbsoluteConstraints, X) {
  for (const Given& g : cases) {
    const Exact phi = g.phi, c = cos(phi), s = sin(phi), px = g.px, py = g.py, omega = g.omega;
    const Table table{
        g.x + px * c - py * s - g.c.f, {1, 0, -px * s - py * c}, g.c.d, (px * c - py * s) * omega * omega + g.c.dd};
    expect_table(evaluate(AbsoluteX<double>{{g.px, g.py}}, g), table, 1, length_of(g), rate_of(g));
  }
}

TEST(AbsoluteConstraints, Y) {
  for (const Given& g : cases) {
    const Exact phi = g.phi, c = cos(phi), s = sin(phi), px = g.px, py = g.py, omega = g.omega;
    const Table table{
        g.y + px * s + py * c - g.c.f, {0, 1, px * c - py * s}, g.c.d, (px * s + py * c) * omega * omega + g.c.dd};
    expect_table(evaluate(AbsoluteY<double>{{g.px, g.py}}, g), table, 1, length_of(g), rate_of(g));
  }
}

TEST(AbsoluteConstraints, Angle) {
  for (const Given& g : cases) {
    const Table table{Exact(g.phi) - g.c.f, {0, 0, 1}, g.c.d, g.c.dd};
    expect_table(evaluate(AbsoluteAngle<double>{{g.px, g.py}}, g), table, 1, std::abs(g.phi) + std::abs(g.c.f) + 1,
                 rate_of(g));
  }
}

TEST(AbsoluteConstraints, Distance) {
  for (const Given& g : cases) {
    const Exact phi = g.phi, c = cos(phi), s = sin(phi), px = g.px, py = g.py, omega = g.omega;
    // A s'P, R A s'P, h, hd
    const Vec2<Exact> arm{px * c - py * s, px * s + py * c}, turned{-arm.y, arm.x};
    const Vec2<Exact> h{g.x + arm.x - g.centre.x, g.y + arm.y - g.centre.y};
    const Vec2<Exact> hd{g.vx + omega * turned.x, g.vy + omega * turned.y};
    const Exact cd = g.c.d, cdd = g.c.dd, value = g.c.f;
    const Table table{h.x * h.x + h.y * h.y - value * value,
                      {2 * h.x, 2 * h.y, 2 * (h.x * turned.x + h.y * turned.y)},
                      2 * value * cd,
                      -2 * (hd.x * hd.x + hd.y * hd.y) + 2 * (h.x * arm.x + h.y * arm.y) * omega * omega + 2 * cd * cd +
                          2 * value * cdd};
    const double length = length_of(g);
    expect_table(evaluate(AbsoluteDistance<double>{{g.px, g.py}, g.centre}, g), table, 2 * length, length, rate_of(g));
  }
}

}  // namespace
}  // namespace catena

#endif
