// Properties that every driven mechanism has, on random ones: trees of links whose loops are closed by joints that fit,
// of pins, slides, slots, couplers, gears, welds and drivers, with dimensions over six orders of magnitude and
// redundant joints added.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "catena/analysis/kinematics.hpp"
#include "catena/elements/constraints/coupler.hpp"
#include "catena/elements/constraints/gear.hpp"
#include "catena/elements/constraints/relative_angle.hpp"
#include "catena/elements/constraints/relative_distance.hpp"
#include "catena/elements/constraints/revolute.hpp"
#include "catena/elements/constraints/slot.hpp"
#include "catena/elements/constraints/translational.hpp"
#include "catena/elements/constraints/weld.hpp"
#include "catena/model/model_add.hpp"

namespace catena {
namespace {

using Vec = Vec2<double>;

// The same mechanisms at every run, unless RC_PARAMS asks for others ("seed=7 max_success=1000").
[[maybe_unused]] const int same_every_time = setenv("RC_PARAMS", "seed=1 max_success=200", 0);

/// A joint between two bodies (-1: ground) at places and with a direction in the given configuration.
struct Joint {
  enum class Kind { revolute, translational, slot, coupler, gear, weld, turning_driver, length_driver };
  Kind kind;
  int i, j;
  Vec at_i, at_j;
  double direction = 0, radius_i = 0, radius_j = 0;
  double amplitude = 0, omega = 0;
};

struct Recipe {
  std::vector<Vec> place;
  std::vector<double> angle;
  std::vector<Joint> joints;
};

/// How a recipe is built: turned, moved and scaled, its bodies and joints in another order.
struct Setting {
  double turn = 0, scale = 1;
  Vec shift{};
  unsigned order = 0;    // 0: as it is
  bool doubled = false;  // every joint that is no driver twice
};

class Generator {
 public:
  Generator(unsigned seed, int groups) : random_(seed) {
    size_ = std::pow(10.0, uniform(-3, 3));
    add_crank();
    for (int g = 0; g < groups; ++g) {
      switch (pick(8)) {
        case 0:
          add_crank();
          break;
        case 1:
        case 2:
          add_dyad();
          break;
        case 3:
          add_slider();
          break;
        case 4:
          add_slotted();
          break;
        case 5:
          add_coupled();
          break;
        case 6:
          add_geared();
          break;
        default:
          add_jack();
          break;
      }
      if (pick(5) == 0) add_welded();
    }
  }
  const Recipe& recipe() const { return recipe_; }

 private:
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  int pick(int count) { return std::uniform_int_distribution<int>(0, count - 1)(random_); }
  Vec somewhere() { return size_ * Vec{uniform(-1, 1), uniform(-1, 1)}; }
  double length() { return size_ * std::pow(10.0, uniform(-0.5, 0.5)); }
  int bodies() const { return static_cast<int>(recipe_.place.size()); }
  int any_body() { return pick(bodies() + 1) - 1; }
  Vec near(Vec place) { return place + length() * unit(uniform(0, 6.28)); }
  static Vec unit(double angle) { return {std::cos(angle), std::sin(angle)}; }
  int add_body(Vec place) {
    recipe_.place.push_back(place);
    recipe_.angle.push_back(uniform(-3, 3));
    return bodies() - 1;
  }
  Vec point_of(int body) { return body < 0 ? somewhere() : near(recipe_.place[static_cast<std::size_t>(body)]); }
  void pin(int i, int j, Vec at) { recipe_.joints.push_back({Joint::Kind::revolute, i, j, at, at}); }
  void drive(Joint joint, double amplitude) {
    joint.amplitude = amplitude;
    joint.omega = uniform(0.5, 2);
    recipe_.joints.push_back(joint);
  }

  // A body pinned to another and turned.
  void add_crank() {
    const int i = any_body();
    const Vec at = point_of(i);
    const int j = add_body(near(at));
    pin(i, j, at);
    drive({Joint::Kind::turning_driver, i, j, at, at}, uniform(-0.3, 0.3));
  }
  // Two bodies between two others, pinned.
  void add_dyad() {
    const int i = any_body(), j = any_body();
    const Vec a = point_of(i), b = point_of(j), middle = near(0.5 * (a + b));
    const int first = add_body(0.5 * (a + middle)), second = add_body(0.5 * (b + middle));
    pin(i, first, a);
    pin(first, second, middle);
    pin(j, second, b);
  }
  // A rod and a block that slides.
  void add_slider() {
    const int i = any_body(), j = any_body();
    const Vec a = point_of(i), b = point_of(j);
    const int rod = add_body(0.5 * (a + b)), block = add_body(b);
    pin(i, rod, a);
    pin(rod, block, b);
    recipe_.joints.push_back({Joint::Kind::translational, j, block, b, b, uniform(0, 6.28)});
  }
  // A pinned body with a slot on a pin of another.
  void add_slotted() {
    const int i = any_body(), j = any_body();
    const Vec a = point_of(i), b = point_of(j);
    const int body = add_body(near(a));
    pin(i, body, a);
    recipe_.joints.push_back({Joint::Kind::slot, body, j, b, b, uniform(0, 6.28)});
  }
  void add_coupled() {
    const int i = any_body(), j = any_body();
    const Vec a = point_of(i), b = point_of(j);
    const int body = add_body(near(a));
    pin(i, body, a);
    recipe_.joints.push_back({Joint::Kind::coupler, body, j, near(a), b});
  }
  // A wheel on a carrier that already carries another body, pinned.
  void add_geared() {
    std::vector<Joint> pins;
    for (const Joint& joint : recipe_.joints) {
      if (joint.kind == Joint::Kind::revolute) pins.push_back(joint);
    }
    const Joint other = pins[static_cast<std::size_t>(pick(static_cast<int>(pins.size())))];
    const Vec at = near(other.at_j);
    const int wheel = add_body(at);
    pin(other.i, wheel, at);
    Joint gear{Joint::Kind::gear, other.j, wheel, other.at_j, at};
    const double apart = norm(at - other.at_j), part = uniform(0.2, 0.8);
    gear.radius_i = part * apart;
    gear.radius_j = (1 - part) * apart;
    recipe_.joints.push_back(gear);
  }
  // A pinned body whose distance from a point is driven.
  void add_jack() {
    const int i = any_body(), j = any_body();
    const Vec a = point_of(i), b = point_of(j);
    const int body = add_body(near(a));
    pin(i, body, a);
    const Vec end = near(a);
    drive({Joint::Kind::length_driver, body, j, end, b}, 0.05 * norm(end - b));
  }
  void add_welded() {
    const int i = any_body();
    const Vec at = point_of(i);
    const int body = add_body(near(at));
    recipe_.joints.push_back({Joint::Kind::weld, i, body, at, at});
  }

  std::mt19937 random_;
  double size_ = 1;
  Recipe recipe_;
};

Vec turned(Vec v, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * v.x - s * v.y, s * v.x + c * v.y};
}

std::shared_ptr<Model> build(const Recipe& recipe, const Setting& setting) {
  auto model = std::make_shared<Model>();
  const auto map = [&](Vec v) { return setting.scale * turned(v, setting.turn) + setting.shift; };
  std::mt19937 random(setting.order);
  const auto order = [&](std::size_t count) {
    std::vector<std::size_t> places(count);
    std::iota(places.begin(), places.end(), std::size_t{0});
    if (setting.order != 0) std::shuffle(places.begin(), places.end(), random);
    return places;
  };
  std::vector<int> number(recipe.place.size());
  for (std::size_t k : order(recipe.place.size())) {
    number[k] = model->add_body(
        "b" + std::to_string(k),
        {.mass = 1, .inertia = 1, .position = map(recipe.place[k]), .angle = recipe.angle[k] + setting.turn});
  }
  const auto body = [&](int b) { return b < 0 ? ground : number[static_cast<std::size_t>(b)]; };
  for (std::size_t k : order(recipe.joints.size())) {
    const Joint& joint = recipe.joints[k];
    const int i = body(joint.i), j = body(joint.j);
    const Frame<double> frame_i = model->frame(i), frame_j = model->frame(j);
    const auto local = [](const Frame<double>& f, Vec p) { return f.to_local(p - f.origin()); };
    const Vec si = local(frame_i, map(joint.at_i)), sj = local(frame_j, map(joint.at_j));
    const Vec axis = frame_i.to_local(turned({std::cos(joint.direction), std::sin(joint.direction)}, setting.turn));
    const double s = setting.scale;
    for (int copy = 0; copy < (setting.doubled ? 2 : 1); ++copy) {
      const std::string name = "j" + std::to_string(k) + (copy ? "again" : "");
      const auto about = [&](double start, double unit) {
        const std::array<TimeFunction<double>, 2> terms = {
            TimeFunction<double>(start), TimeFunction<double>::harmonic(joint.amplitude * unit, joint.omega)};
        return TimeFunction<double>::sum({terms.begin(), terms.end()});
      };
      switch (joint.kind) {
        case Joint::Kind::revolute:
          model->add(name, Revolute<>{si, sj}, i, j);
          break;
        case Joint::Kind::translational:
          model->add(name, Translational<>{si, sj, axis, {}}, i, j);
          break;
        case Joint::Kind::slot:
          model->add(name, Slot<>{si, sj, axis}, i, j, 0.0);
          break;
        case Joint::Kind::coupler:
          model->add(name, Coupler<>{si, sj}, i, j);
          break;
        case Joint::Kind::gear:
          model->add(name, Gear<>{si, sj, s * joint.radius_i, s * joint.radius_j, false, 0}, i, j);
          break;
        case Joint::Kind::weld:
          model->add(name, Weld<>{si, sj, 0}, i, j);
          break;
        case Joint::Kind::turning_driver:
          if (copy == 0) model->add_driver(name, RelativeAngle<>{}, i, j, about(frame_j.phi - frame_i.phi, 1));
          break;
        case Joint::Kind::length_driver:
          if (copy == 0) {
            model->add_driver(name, RelativeDistance<>{si, sj}, i, j,
                              about(norm(map(joint.at_i) - map(joint.at_j)), s));
          }
          break;
      }
    }
  }
  return model;
}

struct Motion {
  AnalysisReport report;
  double rcond = 1;  // the least over the rows
  std::vector<double> t;
  std::vector<std::vector<double>> q, qd, qdd;  // per row: by body in the recipe's order, absolute
};

Motion follow(const Recipe& recipe, const Setting& setting, std::span<const double> times) {
  Motion motion;
  auto model = build(recipe, setting);
  Kinematics kinematics(model);
  RowFunction take([&](const Snapshot& s) {
    std::vector<double> q, qd, qdd;
    for (std::size_t k = 0; k < recipe.place.size(); ++k) {
      const int b = s.evaluator.plan().plan_body[static_cast<std::size_t>(model->find_body("b" + std::to_string(k)))];
      const auto place = static_cast<std::size_t>(3 * b);
      const Vec origin = s.evaluator.origin(b);
      q.insert(q.end(), {s.q[place] + origin.x, s.q[place + 1] + origin.y, s.q[place + 2]});
      qd.insert(qd.end(), {s.qd[place], s.qd[place + 1], s.qd[place + 2]});
      qdd.insert(qdd.end(), {s.qdd[place], s.qdd[place + 1], s.qdd[place + 2]});
    }
    motion.t.push_back(s.t);
    motion.q.push_back(std::move(q));
    motion.qd.push_back(std::move(qd));
    motion.qdd.push_back(std::move(qdd));
    motion.rcond = std::min(motion.rcond, kinematics.solver().rcond());
    return true;
  });
  motion.report =
      kinematics.run(TimeGrid::list({times.begin(), times.end()}), {.velocity = true, .acceleration = true}, take);
  return motion;
}

/// Largest entry, lengths divided by `length`.
double size_of(const std::vector<double>& x, double length) {
  double largest = 0;
  for (std::size_t k = 0; k < x.size(); ++k) largest = std::max(largest, std::abs(x[k]) / (k % 3 == 2 ? 1 : length));
  return largest;
}

std::vector<double> difference(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> x(a);
  for (std::size_t k = 0; k < x.size(); ++k) x[k] -= b[k];
  return x;
}

double extent(const Recipe& recipe) {
  double largest = 0;
  for (const Vec& place : recipe.place) largest = std::max({largest, std::abs(place.x), std::abs(place.y)});
  return largest;
}

/// A mechanism that moves all the way; many random ones reach a dead point.
bool moves(const Motion& motion) { return motion.report.ok() && motion.rcond > 1e-6; }

/// The outcomes of mechanisms that cannot move are statuses, never anything else.
void expect_a_reason(const Motion& motion) {
  if (motion.report.ok()) return;
  const Status status = motion.report.status;
  RC_ASSERT(status == Status::lock_up || status == Status::bifurcation || status == Status::singular ||
            status == Status::under_driven);
  RC_ASSERT(!motion.report.message.empty());
}

// Derivatives of positions and velocities by differences of order eight over nine rows.
TEST(KinematicsProperty, PositionsVelocitiesAndAccelerationsAreConsistent) {
  int moved = 0;
  const bool passed = rc::check([&moved] {
    const auto seed = *rc::gen::arbitrary<unsigned>();
    const int groups = *rc::gen::inRange(0, 8);
    const Recipe recipe = Generator(seed, groups).recipe();
    const double h = 0.004, middle = 0.1;
    std::vector<double> times;
    for (int k = 0; k < 9; ++k) times.push_back(middle + (k - 4) * h);
    const Motion motion = follow(recipe, {}, times);
    expect_a_reason(motion);
    if (!moves(motion)) return;
    ++moved;
    constexpr double weights[] = {4.0 / 5, -1.0 / 5, 4.0 / 105, -1.0 / 280};
    const double length = extent(recipe);
    const auto check = [&](const auto& value, const auto& rate) {
      std::vector<double> slope(value[4].size(), 0.0);
      double seen = 0, wildest = 0;
      for (std::size_t k = 1; k <= 4; ++k) {
        for (std::size_t n = 0; n < slope.size(); ++n) {
          slope[n] += weights[k - 1] * (value[4 + k][n] - value[4 - k][n]) / h;
        }
      }
      for (const auto& row : value) seen = std::max(seen, size_of(row, length));
      for (const auto& row : rate) wildest = std::max(wildest, size_of(row, length));
      // What the differences themselves miss: the change of the rate over the stretch, to the eighth power.
      const double change = size_of(difference(rate[8], rate[0]), length) / std::max(wildest, 1e-300);
      const double truncation = wildest * std::pow(std::max(change, 0.02), 8);
      const double allowed = 1e-9 * (wildest + 1e-6) / motion.rcond + 1e-15 * seen / h / motion.rcond + truncation;
      RC_ASSERT(size_of(difference(slope, rate[4]), length) <= allowed);
    };
    check(motion.q, motion.qd);
    check(motion.qd, motion.qdd);
  });
  EXPECT_TRUE(passed);
  EXPECT_GT(moved, 40) << "too few of the mechanisms move to say anything";
}

// The same mechanism in other axes, other units, another order, with joints doubled: the same motion.
TEST(KinematicsProperty, MotionDoesNotDependOnAxesUnitsOrderOrRepetition) {
  int moved = 0;
  const bool passed = rc::check([&moved] {
    const auto seed = *rc::gen::arbitrary<unsigned>();
    const int groups = *rc::gen::inRange(0, 6);
    const Recipe recipe = Generator(seed, groups).recipe();
    const std::array<double, 3> times = {0, 0.11, 0.3};
    const Motion reference = follow(recipe, {}, times);
    expect_a_reason(reference);
    if (!moves(reference) || reference.rcond < 1e-4) return;
    ++moved;
    const double length = extent(recipe);
    const Setting settings[] = {
        {.turn = 1.1},
        {.shift = {3 * length, -5 * length}},
        {.scale = 1e3},
        {.scale = 1e-3},
        {.order = seed | 1u},
        {.doubled = true},
        {.turn = -2.3, .scale = 0.0254, .shift = {length, length}, .order = seed | 1u, .doubled = true}};
    for (const Setting& setting : settings) {
      const Motion other = follow(recipe, setting, times);
      RC_LOG() << "turn " << setting.turn << " scale " << setting.scale << " order " << setting.order << " doubled "
               << setting.doubled << ": " << other.report.message << "\n";
      RC_ASSERT(other.report.ok());
      for (std::size_t row = 0; row < times.size(); ++row) {
        const auto compare = [&](const std::vector<double>& a, const std::vector<double>& b, bool position) {
          std::vector<double> expected(a);
          for (std::size_t k = 0; k < a.size(); k += 3) {
            const Vec v = setting.scale * turned({a[k], a[k + 1]}, setting.turn) + (position ? setting.shift : Vec{});
            expected[k] = v.x;
            expected[k + 1] = v.y;
            if (position) expected[k + 2] += setting.turn;
          }
          const double unit = setting.scale * length;
          const double allowed = 1e-11 * (1 + size_of(expected, unit)) / reference.rcond;
          RC_ASSERT(size_of(difference(expected, b), unit) <= allowed);
        };
        compare(reference.q[row], other.q[row], true);
        compare(reference.qd[row], other.qd[row], false);
        compare(reference.qdd[row], other.qdd[row], false);
      }
    }
  });
  EXPECT_TRUE(passed);
  EXPECT_GT(moved, 30) << "too few of the mechanisms move to say anything";
}

}  // namespace
}  // namespace catena
