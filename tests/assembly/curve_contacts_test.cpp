// Contacts of curves as values of the state: what is evaluated at a configuration depends on it and on where the
// contacts were, bit for bit, and on nothing that was evaluated before, in this or in another thread.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>
#include <random>
#include <thread>
#include <vector>

#include "catena/assembly/evaluate.hpp"
#include "catena/elements/all.hpp"
#include "catena/model/model_add.hpp"

namespace catena {
namespace {

/// Two bodies, of which one may be the ground, with one element of every type that searches: contacts once with a row
/// and once without.
struct RandomContacts {
  std::mt19937 random;
  Model model;
  std::vector<int> released;
  EvaluationWork work;

  explicit RandomContacts(unsigned seed) : random(seed) {
    const int a = seed % 3 == 0 ? ground : add_body("a"), b = add_body("b");
    model.add("point", PointOnCurve<double>{.s_j = place(), .curve = rounded()}, a, b);
    model.add("flat", CamFlat<double>{.s_j = place(), .axis_j = {1, 0.3}, .curve = rounded()}, a, b);
    model.add("cams", CamCam<double>{.curve_i = rounded(), .curve_j = rounded()}, a, b);
    Contact<double> contact;
    contact.curve = rounded();
    contact.s_j = place();
    contact.radius = 0.01;
    model.add("touching", contact, a, b);
    contact.curve = rounded();
    released.push_back(model.add("open", contact, b, a));
  }

  double between(double low, double high) { return low + (high - low) * (random() / 4294967296.0); }
  Vec2<double> place() {
    const double x = between(-0.2, 0.2);
    return {x, between(-0.2, 0.2)};
  }
  int add_body(const char* name) {
    const double side = name[0] == 'a' ? -3 : 3, y = between(-1, 1);
    return model.add_body(name, {.position = {side, y}, .angle = between(-3, 3)});
  }
  /// A convex closed curve, at times a circle.
  Curve<double> rounded() {
    const double radius = between(0.4, 0.8), height = between(0.03, 0.08);
    if (random() % 4 == 0) return Curve<double>::circle(place(), radius);
    std::vector<Vec2<double>> points;
    for (int k = 0; k < 24; ++k) {
      const double angle = 2 * std::numbers::pi * k / 24, r = radius * (1 + height * std::cos(2 * angle));
      points.push_back({r * std::cos(angle), r * std::sin(angle)});
    }
    return Curve<double>::spline(points, SplineEnd::periodic);
  }
  Evaluator evaluator() {
    return Evaluator(Plan::make(model, {.released_elements = released, .one_sided = true}), model, work);
  }
  /// Bodies turned by up to `angle` and moved a little.
  std::vector<double> moved(const std::vector<double>& q, double angle) {
    std::vector<double> there = q;
    for (std::size_t c = 0; c + 3 < q.size(); ++c) there[c] += c % 3 == 2 ? between(-angle, angle) : between(-0.1, 0.1);
    return there;
  }
};

/// All that an evaluator says of contacts at its configuration.
struct Said {
  std::vector<double> numbers;

  explicit Said(Evaluator& e) {
    const Plan& plan = e.plan();
    std::vector<double> rows(static_cast<std::size_t>(plan.rows)),
        qd(static_cast<std::size_t>(plan.coordinates()), 0.7);
    std::vector<double> jacobian(static_cast<std::size_t>(plan.jacobian.entries()) + 1);
    e.gamma(qd, rows);
    add(rows);
    e.start_jacobian(jacobian);
    e.jacobian(jacobian);
    add(jacobian);
    e.phi(rows);
    add(rows);
    add(looked_at(e));
  }
  /// What a constant evaluator tells.
  static std::vector<double> looked_at(const Evaluator& e) {
    std::vector<double> numbers;
    const std::vector<double> qd(static_cast<std::size_t>(e.plan().coordinates()), 0.7);
    const std::vector<double> lambda(static_cast<std::size_t>(e.plan().rows), 1.3);
    e.visit_constraint_hessians(
        lambda, [&](int, int, const ElementMatrix& m) { numbers.insert(numbers.end(), m.begin(), m.end()); });
    for (int element = 0; element < static_cast<int>(e.model().elements.size()); ++element) {
      const Evaluator::ScalarMotion motion = e.scalar_motion(element, qd);
      numbers.insert(numbers.end(), {motion.value, motion.rate, motion.bend, e.measure(element, qd, {}).value});
      numbers.insert(numbers.end(), std::begin(motion.gradient), std::end(motion.gradient));
      const CurvePlace contact = e.contact(element);
      numbers.insert(numbers.end(), {contact.s_i, contact.s_j, e.trouble(element) ? 1.0 : 0.0});
    }
    return numbers;
  }
  void add(const std::vector<double>& more) { numbers.insert(numbers.end(), more.begin(), more.end()); }
};

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

constexpr unsigned seeds = 40;

// One evaluator tries other configurations before and goes back to the places it had; the other never left.
TEST(CurveContacts, RejectedTrialsLeaveNoTrace) {
  int moved = 0;
  for (unsigned seed = 0; seed < seeds; ++seed) {
    RandomContacts scene(seed);
    Evaluator tried = scene.evaluator();
    const std::vector<double> q = scene.moved(tried.given_configuration(), 0.2), next = scene.moved(q, 0.2);
    tried.set_configuration(q);
    Evaluator stayed(tried, scene.work);
    const std::vector<CurvePlace> places = tried.curve_places();
    for (int trial = 0; trial < 3; ++trial) {
      tried.set_configuration(scene.moved(q, 1.5));
      static_cast<void>(Said(tried));
      moved += tried.curve_places().front().s_i != places.front().s_i;
    }
    tried.go_to_curve_places(places);
    tried.set_configuration(next);
    stayed.set_configuration(next);
    EXPECT_TRUE(same_bits(Said(tried).numbers, Said(stayed).numbers)) << seed;
  }
  EXPECT_GT(moved, static_cast<int>(seeds));
}

// Told where to search from after a configuration was set, an evaluator says of it what it would have said before.
TEST(CurveContacts, PlacesHoldForTheConfigurationThatIsSet) {
  for (unsigned seed = 0; seed < seeds; ++seed) {
    RandomContacts scene(seed);
    Evaluator before = scene.evaluator(), away(before, scene.work);
    const std::vector<double> q = scene.moved(before.given_configuration(), 0.2);
    away.set_configuration(scene.moved(q, 1.5));
    const std::vector<CurvePlace> elsewhere = away.curve_places();
    before.go_to_curve_places(elsewhere);
    before.set_configuration(q);
    Evaluator after = scene.evaluator();
    after.set_configuration(q);
    after.go_to_curve_places(elsewhere);
    EXPECT_TRUE(same_bits(Said(before).numbers, Said(after).numbers)) << seed;
  }
}

TEST(CurveContacts, TheOrderOfEvaluationsDoesNotMatter) {
  for (unsigned seed = 0; seed < seeds; ++seed) {
    RandomContacts scene(seed);
    Evaluator first = scene.evaluator();
    first.set_configuration(scene.moved(first.given_configuration(), 0.3));
    Evaluator second(first, scene.work);
    const std::vector<double> once = Said(first).numbers, again = Said(first).numbers;
    const std::vector<double> alone = Said::looked_at(second);
    EXPECT_TRUE(same_bits(once, again)) << seed;
    EXPECT_TRUE(
        same_bits(alone, std::vector<double>(once.end() - static_cast<std::ptrdiff_t>(alone.size()), once.end())))
        << seed;
  }
}

// The gap of a point to a curve against the nearest of many points of it.
TEST(CurveContacts, AreWhereTheCurvesAreNearest) {
  for (unsigned seed = 0; seed < seeds; ++seed) {
    RandomContacts scene(seed);
    Evaluator e = scene.evaluator();
    e.set_configuration(scene.moved(e.given_configuration(), 0.3));
    const auto& entry =
        std::get<std::vector<ElementEntry<PointOnCurve<double>, double>>>(scene.model.constraints).front();
    const auto frame = [&](int body) {
      return e.ground_frame(body < 0 ? e.plan().bodies : e.plan().plan_body[static_cast<std::size_t>(body)]);
    };
    const Vec2<double> p = frame(entry.j).point(entry.element.s_j);
    const Curve<double>& shape = entry.element.curve.shape();
    double nearest = 1e9;
    for (int k = 0; k < 20000; ++k) {
      const double s = shape.first() + (shape.last() - shape.first()) * k / 20000;
      nearest = std::min(nearest, norm(frame(entry.i).point(shape.evaluate(s).p) - p));
    }
    // The square of half a step of the samples over the distance.
    EXPECT_NEAR(std::abs(e.scalar_motion(entry.id, {}).value), nearest, 1e-7) << seed;
  }
}

// Eight threads look at one constant evaluator; every second one has moved its own before, of the one model and plan.
TEST(CurveContacts, ThreadsShareModelPlanAndEvaluator) {
  for (unsigned seed = 0; seed < 6; ++seed) {
    RandomContacts scene(seed);
    const Evaluator given = scene.evaluator();
    Evaluator shared(given, scene.work);
    const std::vector<double> start = shared.given_configuration();
    std::vector<std::vector<double>> way;
    for (int k = 0; k < 30; ++k) way.push_back(scene.moved(start, 0.5));
    const auto travel = [&](const Evaluator& from) {
      EvaluationWork work;
      Evaluator own(from, work);
      std::vector<double> numbers;
      for (const std::vector<double>& q : way) {
        own.set_configuration(q);
        const std::vector<double> here = Said(own).numbers;
        numbers.insert(numbers.end(), here.begin(), here.end());
      }
      return numbers;
    };
    const std::vector<double> travelled = travel(given);
    shared.set_configuration(way.front());
    const std::vector<double> seen = Said::looked_at(shared);
    std::vector<char> right(8, 0);
    std::vector<std::thread> threads;
    for (std::size_t n = 0; n < right.size(); ++n) {
      threads.emplace_back([&, n] {
        right[n] = 1;
        if (n % 2 == 0) right[n] = same_bits(travel(given), travelled);
        for (int k = 0; k < 20; ++k) right[n] = right[n] && same_bits(Said::looked_at(shared), seen);
      });
    }
    for (std::thread& thread : threads) thread.join();
    for (std::size_t n = 0; n < right.size(); ++n) EXPECT_TRUE(right[n]) << seed << " " << n;
  }
}

}  // namespace
}  // namespace catena
