// Where shapes stand, against complex numbers: a pose is r + exp(i phi) s', a span the straight line between two
// points.
#include "catena/drawing/shapes/placement.hpp"

#include <gtest/gtest.h>

#include <complex>
#include <random>

namespace catena::testing {
namespace {

using Complex = std::complex<double>;

Complex complex_of(const Vec2<double>& v) { return {v.x, v.y}; }

class Placements : public ::testing::Test {
 protected:
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  Vec2<double> random_place() { return {uniform(-2, 2), uniform(-2, 2)}; }
  /// Two random bodies.
  std::vector<Frame<double>> random_frames() {
    std::vector<Frame<double>> frames;
    for (int k = 0; k < 2; ++k) {
      const double phi = uniform(-9, 9), y = uniform(-5, 5), x = uniform(-5, 5);
      frames.push_back(make_frame(x, y, phi));
    }
    return frames;
  }
  static Complex place_of(std::span<const Frame<double>> frames, int body, const Vec2<double>& local) {
    if (body < 0) return complex_of(local);
    const Frame<double>& f = frames[static_cast<std::size_t>(body)];
    return Complex(f.x, f.y) + std::polar(1.0, f.phi) * complex_of(local);
  }
  static void expect_near(const Vec2<double>& found, const Complex& wanted) {
    EXPECT_NEAR(std::abs(complex_of(found) - wanted), 0, 1e-13 * (10 + std::abs(wanted)));
  }

  std::mt19937 random_{15};
};

TEST_F(Placements, AreThoseOfTheBodies) {
  for (int trial = 0; trial < 300; ++trial) {
    const std::vector<Frame<double>> frames = random_frames();
    const int i = trial % 3 - 1, j = trial / 3 % 3 - 1;
    const Vec2<double> s_i = random_place(), s_j = random_place(), p = random_place();
    const double size = uniform(0.01, 1);
    const Complex at_i = place_of(frames, i, s_i), at_j = place_of(frames, j, s_j), uv = complex_of(p);
    const DrawnShape shape{.body_i = i, .body_j = j, .point_i = s_i, .point_j = s_j};
    const auto placed = [&](Anchor anchor) {
      DrawnShape anchored = shape;
      anchored.anchor = anchor;
      return place(anchored, frames, size)(p);
    };
    expect_near(placed(Anchor::body), place_of(frames, i, p));
    const Complex axis = place_of(frames, j, s_j) - place_of(frames, j, {0, 0});
    expect_near(placed(Anchor::point), at_i + size * axis * uv);
    const Complex h = at_j - at_i, direction = h / std::abs(h);
    expect_near(placed(Anchor::span), at_i + h * p.x + size * direction * Complex(0, 1) * p.y);
    expect_near(placed(Anchor::centres), at_i + direction * uv);
  }
}

TEST_F(Placements, OfASpanWithoutLengthStandUpright) {
  const std::vector<Frame<double>> frames = random_frames();
  const DrawnShape shape{
      .anchor = Anchor::span, .body_i = 0, .body_j = 0, .point_i = {0.1, 0.2}, .point_j = {0.1, 0.2}};
  const Placement placement = place(shape, frames, 0.5);
  EXPECT_EQ(norm(placement.e_u), 0);
  expect_near(placement({0.3, 2}), place_of(frames, 0, {0.1, 0.2}) + Complex(0, 1));
}

}  // namespace
}  // namespace catena::testing
