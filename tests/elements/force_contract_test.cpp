// Every force of the list against 50-digit arithmetic on its own force and potential: stiffness (closed and derived),
// damping, gradient of the potential, dissipated power; and what holds for forces between two bodies.
#if __has_include(<boost/multiprecision/cpp_dec_float.hpp>)

#include <gtest/gtest.h>

#include <numeric>
#include <string>

#include "catena/assembly/force_block.hpp"
#include "catena/assembly/hessian_slots.hpp"
#include "elements/exact.hpp"
#include "elements/random_element.hpp"

namespace catena {
namespace {

constexpr unsigned draws = 30;

template <class... Types>
struct ListOf {
  using type = ::testing::Types<Types...>;
};
template <class First, class... Types>
struct ListOf<First, Types...> {
  using type = ::testing::Types<Types...>;
};
#define CATENA_TYPE(Type) , Type<double>
using AllForces = ListOf<void CATENA_FORCES(CATENA_TYPE) CATENA_TYPE(ElasticCable) CATENA_TYPE(JointDamper)>::type;
#undef CATENA_TYPE

struct Names {
  template <class E>
  static std::string GetName(int) {
    return std::string(E::type);
  }
};

using Offsets = std::array<Exact, 6>;

/// One element at a random configuration, stored as the library stores it.
template <class E>
struct Case {
  Coordinates q{}, qd{};
  ForceBlock<E> block;
  ForceData<E> data;
  Pose pose;

  explicit Case(unsigned seed) {
    Random random(seed);
    for (std::size_t k = 0; k < 6; ++k) {
      q[k] = random.between(-2, 2);
      qd[k] = random.between(-2, 2);
    }
    pose.frames = {make_frame(q[0], q[1], q[2]), make_frame(q[3], q[4], q[5])};
    ParameterSource<double> source(seed + 1000);
    data.element = {random_element<E>(source, pose.frames[0], pose.frames[1])};
    data.shift.resize(1);
    if (E::bodies == 1) data.shift[0].i = random.place(2);
    for (int k = 0; k < E::functions; ++k) pose.loads.push_back(random.between(-3, 3));
    pose.load_rates.assign(pose.loads.size(), 0.0);
    block.entry = {0};
    block.body_i = {0};
    block.body_j = {1};
  }

  const E& element() const { return data.element[0]; }
  MovingPose moving() const { return {pose, qd.data()}; }
  MovingPose resting() const { return {pose}; }
  bool conservative() const { return is_conservative(element()); }

  /// Calls f(arguments) in 50 digits, coordinates and velocities moved by the offsets.
  template <class F>
  auto exactly(const Offsets& dq, const Offsets& dqd, bool at_rest, F&& f) const {
    const auto at = [&](std::size_t k) { return Exact(q[k]) + dq[k]; };
    const auto rate = [&](std::size_t k) { return Exact(at_rest ? 0 : qd[k]) + dqd[k]; };
    const Frame<Exact> i = make_frame<Exact>(at(0), at(1), at(2)), j = make_frame<Exact>(at(3), at(4), at(5));
    const Twist<Exact> u{rate(0), rate(1), rate(2)}, v{rate(3), rate(4), rate(5)};
    const std::vector<Exact> values(pose.loads.begin(), pose.loads.end());
    return f(ForceArguments<Exact>{i, j, u, v, values.data(), data.shift[0].i});
  }
  Offsets exact_force(const Offsets& dq, const Offsets& dqd, bool at_rest) const {
    return exactly(dq, dqd, at_rest, [&](const ForceArguments<Exact>& a) {
      Wrench<Exact> on_i, on_j;
      element().force(a, on_i, on_j);
      return Offsets{on_i.fx, on_i.fy, on_i.moment, on_j.fx, on_j.fy, on_j.moment};
    });
  }
  Exact exact_potential(const Offsets& dq) const {
    if constexpr (HasPotential<E>) {
      return exactly(dq, {}, true, [&](const ForceArguments<Exact>& a) { return element().potential(a); });
    } else {
      return 0;
    }
  }
};

Offsets along(std::size_t k, const Exact& step) {
  Offsets offset{};
  offset[k] = step;
  return offset;
}

template <class E>
class ForceContract : public ::testing::Test {
 protected:
  using Operations = ForceOperations<E>;

  template <class Test>
  void for_random_cases(const Test& test) {
    for (unsigned seed = 0; seed < draws; ++seed) {
      SCOPED_TRACE(::testing::Message() << "seed " << seed);
      test(Case<E>(seed));
    }
  }
  static void expect_near(double found, const Exact& exact, const char* what) {
    const double value = value_of(exact);
    EXPECT_NEAR(found, value, 1e-12 * (1 + std::abs(value))) << what;
  }
};

TYPED_TEST_SUITE(ForceContract, AllForces, Names);

TYPED_TEST(ForceContract, ForceIsMinusTheGradientOfThePotential) {
  int conservative = 0;
  this->for_random_cases([&](const Case<TypeParam>& x) {
    if (!x.conservative()) return;
    ++conservative;
    const Exact h = difference_step();
    const auto force = TestFixture::Operations::force(x.block, x.data, x.resting(), 0);
    for (std::size_t k = 0; k < 3 * TypeParam::bodies; ++k) {
      const Exact slope = (x.exact_potential(along(k, h)) - x.exact_potential(along(k, -h))) / (2 * h);
      this->expect_near(force[k], -slope, "force");
    }
    this->expect_near(TestFixture::Operations::potential(x.block, x.data, x.pose), x.exact_potential({}), "V");
  });
  EXPECT_GT(conservative, 0);
}

TYPED_TEST(ForceContract, ForceStiffnessAndDampingAreExact) {
  this->for_random_cases([&](const Case<TypeParam>& x) {
    const Exact h = difference_step();
    const auto force = TestFixture::Operations::force(x.block, x.data, x.moving(), 0);
    const auto stiffness = TestFixture::Operations::stiffness(x.block, x.data, x.moving(), 0);
    const auto damping = TestFixture::Operations::damping(x.block, x.data, x.moving(), 0);
    const Offsets exact = x.exact_force({}, {}, false);
    for (std::size_t k = 0; k < 3 * TypeParam::bodies; ++k) {
      const Offsets after = x.exact_force(along(k, h), {}, false), before = x.exact_force(along(k, -h), {}, false);
      const Offsets faster = x.exact_force({}, along(k, h), false), slower = x.exact_force({}, along(k, -h), false);
      this->expect_near(force[k], exact[k], "force");
      for (std::size_t r = 0; r < 3 * TypeParam::bodies; ++r) {
        this->expect_near(stiffness[6 * r + k], -(after[r] - before[r]) / (2 * h), "stiffness");
        this->expect_near(damping[6 * r + k], -(faster[r] - slower[r]) / (2 * h), "damping");
      }
    }
  });
}

// What equilibrium uses: closed forms where there are any, at the places that the pattern names, zero elsewhere.
TYPED_TEST(ForceContract, SecondDerivativesOfThePotentialAreExact) {
  constexpr auto written = written_stiffness<TypeParam>();
  std::vector<int> slots(written.size());
  std::iota(slots.begin(), slots.end(), 0);
  this->for_random_cases([&](const Case<TypeParam>& x) {
    if (!x.conservative()) return;
    std::vector<double> values(written.size() + 1, 0.0);
    TestFixture::Operations::add_stiffness(x.block, x.data, x.resting(), false, slots.data(), values.data());
    const Exact h = difference_step();
    for (std::size_t r = 0; r < 3 * TypeParam::bodies; ++r) {
      for (std::size_t c = 0; c <= r; ++c) {
        const Exact exact =
            -(x.exact_force(along(c, h), {}, true)[r] - x.exact_force(along(c, -h), {}, true)[r]) / (2 * h);
        double found = 0;
        for (std::size_t k = 0; k < written.size(); ++k) {
          if (static_cast<std::size_t>(written[k].row) == r && static_cast<std::size_t>(written[k].column) == c)
            found = values[k];
        }
        this->expect_near(found, exact, "second derivative");
      }
    }
  });
}

TYPED_TEST(ForceContract, DissipationIsThePowerThatDampingTakes) {
  this->for_random_cases([&](const Case<TypeParam>& x) {
    if (!x.conservative()) return;
    const Offsets moving = x.exact_force({}, {}, false), resting = x.exact_force({}, {}, true);
    Exact power = 0;
    for (std::size_t k = 0; k < 6; ++k) power += (resting[k] - moving[k]) * Exact(x.qd[k]);
    this->expect_near(TestFixture::Operations::dissipation(x.block, x.data, x.moving()), power, "dissipation");
  });
}

// Between two bodies forces are opposite, and so are their moments about any point: neither momentum nor angular
// momentum comes from nowhere.
TYPED_TEST(ForceContract, BodiesExertOppositeForces) {
  if (TypeParam::bodies == 1) GTEST_SKIP() << "acts from outside";
  this->for_random_cases([&](const Case<TypeParam>& x) {
    const auto Q = TestFixture::Operations::force(x.block, x.data, x.moving(), 0);
    this->expect_near(Q[0] + Q[3], 0, "sum of x");
    this->expect_near(Q[1] + Q[4], 0, "sum of y");
    const double about_origin = Q[2] + Q[5] + x.q[0] * Q[1] - x.q[1] * Q[0] + x.q[3] * Q[4] - x.q[4] * Q[3];
    this->expect_near(about_origin, 0, "moment");
  });
}

}  // namespace
}  // namespace catena

#endif
