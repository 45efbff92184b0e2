// Every constraint of the list against 50-digit arithmetic on its own phi: rows, Jacobian (closed and derived), nu,
// gamma (closed and derived), second and parameter derivatives, measured quantity; and what its pattern promises.
#if __has_include(<boost/multiprecision/cpp_dec_float.hpp>)

#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <string>
#include <vector>

#include "elements/exact.hpp"
#include "elements/random_element.hpp"

namespace catena {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr unsigned draws = 40;

template <class E, class S>
struct Over;
template <template <class> class E, class T, class S>
struct Over<E<T>, S> {
  using type = E<S>;
};

template <class... Types>
struct ListOf {
  using type = ::testing::Types<Types...>;
};
template <class First, class... Types>
struct ListOf<First, Types...> {
  using type = ::testing::Types<Types...>;
};
#define CATENA_TYPE(Type) , Type<double>
using AllConstraints = ListOf<void CATENA_CONSTRAINTS(CATENA_TYPE)>::type;
#undef CATENA_TYPE

struct Names {
  template <class E>
  static std::string GetName(int) {
    return std::string(E::type);
  }
};

/// A random case; lengths are of the order of `size`.
template <class E>
ConstraintCase<E> random_case(unsigned seed, double size) {
  Random random(seed);
  ConstraintCase<E> x;
  for (std::size_t k = 0; k < 6; ++k) {
    const bool angle = k % 3 == 2;
    const double unit = angle ? 1 : size;
    x.q[k] = unit * random.between(-3, 3);
    x.qd[k] = unit * random.between(-2, 2);
    x.qdd[k] = unit * random.between(-2, 2);
  }
  if constexpr (E::bodies == 1) x.ground = random.place(size);
  if constexpr (E::functions == 1) {
    const double unit = E::value_unit == UnitKind::angle ? 1 : size;
    x.c = {unit * random.between(0.2, 2), unit * random.between(-1, 1), unit * random.between(-1, 1)};
  }
  ParameterSource<double> source(seed + 1000, size);
  const Frame<double> i = make_frame(x.q[0], x.q[1], x.q[2]), j = make_frame(x.q[3], x.q[4], x.q[5]);
  x.element = random_element<E>(source, i, j);
  x.contact = found_contact(x.element, i, j);
  return x;
}

/// Whether the element itself says that its row means nothing here, as a contact does at the end of an open curve.
template <class E>
bool has_trouble(const ConstraintCase<E>& x) {
  if constexpr (HasTrouble<E>) {
    const Frame<double> i = make_frame(x.q[0], x.q[1], x.q[2]), j = make_frame(x.q[3], x.q[4], x.q[5]);
    const CurvePlace contact = found_contact(x.element, i, j);
    return x.element.trouble(Arguments<double>{i, j, x.c.f, x.ground, &contact}) != nullptr;
  } else {
    return false;
  }
}

/// One element as the library stores it, so that the tests run the code that the library runs.
template <class E>
struct Stored {
  ConstraintBlock<E> block;
  ConstraintData<E> data;
  Pose pose;

  explicit Stored(const ConstraintCase<E>& x) {
    block.entry = {0};
    block.body_i = {0};
    block.body_j = {1};
    for (int k = 0; k < varying_entries<E>(); ++k) block.slot.push_back(k);
    data.element = {x.element};
    data.shift.resize(1);
    data.shift[0].i = x.ground;
    if (E::functions == 1) pose.values = {x.c};
    data.scale = {1};
    if (E::functions == 1) data.timed = {{0, 0}};
    pose.frames = {make_frame(x.q[0], x.q[1], x.q[2]), make_frame(x.q[3], x.q[4], x.q[5])};
    pose.contacts = {found_contact(x.element, pose.frames[0], pose.frames[1])};
  }
};

/// What rounding in a row may be compared with: the change of the row when the bodies move by their own size.
template <class E, class Jacobian>
std::array<double, static_cast<std::size_t>(E::rows)> row_sizes(const Jacobian& jacobian, double size) {
  std::array<double, static_cast<std::size_t>(E::rows)> sizes{};
  for (std::size_t r = 0; r < sizes.size(); ++r) {
    for (std::size_t k = 0; k < 6; ++k) sizes[r] += std::abs(value_of(jacobian[r][k])) * (k % 3 == 2 ? 1 : size);
  }
  return sizes;
}

template <class E>
class ConstraintContract : public ::testing::Test {
 protected:
  using Rows = std::array<double, static_cast<std::size_t>(E::rows)>;

  /// Calls test(case, exact Jacobian, sizes of the rows, size) for random cases from a millimetre to a kilometre.
  template <class Test>
  void for_random_cases(const Test& test) {
    for (unsigned seed = 0; seed < draws; ++seed) {
      const double size = std::array{1e-3, 1.0, 1e3}[seed % 3];
      SCOPED_TRACE(::testing::Message() << "seed " << seed);
      const ConstraintCase<E> x = random_case<E>(seed, size);
      const auto jacobian = exact_jacobian(x);
      test(x, jacobian, row_sizes<E>(jacobian, size), size);
    }
  }

  /// `found` within rounding of `exact`, in units of `size`.
  void expect_exact(double found, const Exact& exact, double size, double roundings, const char* what) {
    const double error = value_of(Exact(found) - exact);
    EXPECT_LE(std::abs(error), roundings * eps * size) << what << ": " << found << " for " << exact;
    worst_[what] = std::max(worst_[what], std::abs(error) / size);
  }

  void TearDown() override {
    for (const auto& [what, error] : worst_)
      RecordProperty(std::string("error of ") + what, ::testing::PrintToString(error));
  }

  std::map<std::string, double> worst_;
};

TYPED_TEST_SUITE(ConstraintContract, AllConstraints, Names);

TYPED_TEST(ConstraintContract, RowsAndJacobian) {
  using E = TypeParam;
  this->for_random_cases([&](const ConstraintCase<E>& x, const auto& exact, const auto& row_size, double size) {
    const Stored<E> stored(x);
    typename TestFixture::Rows rows;
    ConstraintOperations<E>::phi(stored.block, stored.data, stored.pose, rows.data());
    const auto exact_phi = exact_rows(x);

    const auto derived = ConstraintOperations<E>::local_jacobian(stored.block, stored.data, stored.pose, 0);
    std::vector<double> closed(static_cast<std::size_t>(varying_entries<E>()));
    ConstraintOperations<E>::jacobian(stored.block, stored.data, stored.pose, closed.data());

    constexpr auto pattern = jacobian_pattern<E>();
    std::size_t varying = 0;
    for (std::size_t r = 0; r < rows.size(); ++r) {
      this->expect_exact(rows[r], exact_phi[r], row_size[r], 16, "phi");
      for (std::size_t k = 0; k < 3 * E::bodies; ++k) {
        SCOPED_TRACE(::testing::Message() << "row " << r << " column " << k);
        const double entry_size = row_size[r] / (k % 3 == 2 ? 1 : size);
        const double entry = derived.entries[r * 3 * E::bodies + k];
        this->expect_exact(entry, exact[r][k], entry_size, 16, "derived Jacobian");
        switch (pattern[r * 3 * E::bodies + k]) {
          case Entry::zero:
            EXPECT_EQ(entry, 0);
            break;
          case Entry::plus_one:
            EXPECT_EQ(entry, 1);
            break;
          case Entry::minus_one:
            EXPECT_EQ(entry, -1);
            break;
          case Entry::varying:
            this->expect_exact(closed[varying++], exact[r][k], entry_size, 16, "Jacobian");
        }
      }
    }
  });
}

TYPED_TEST(ConstraintContract, VelocityAndAccelerationRightHandSides) {
  using E = TypeParam;
  this->for_random_cases([&](const ConstraintCase<E>& x, const auto&, const auto& row_size, double) {
    const Stored<E> stored(x);
    typename TestFixture::Rows nu{}, gamma{};
    ConstraintOperations<E>::nu(stored.block, stored.data, stored.pose, nu.data());
    ConstraintOperations<E>::gamma(stored.block, stored.data, stored.pose, x.qd.data(), gamma.data());
    Taylor<double> derived[E::rows];
    const auto i = moving(stored.pose.frames[0], x.qd[0], x.qd[1], x.qd[2]);
    const auto j = moving(stored.pose.frames[1], x.qd[3], x.qd[4], x.qd[5]);
    x.element.phi(Arguments<Taylor<double>>{i, j, x.c, x.ground, &stored.pose.contacts[0]}, derived);
    const auto expected_nu = exact_nu(x), expected_gamma = exact_gamma(x);
    for (std::size_t r = 0; r < nu.size(); ++r) {
      // Rates are up to 2 a second, so gamma is up to 16 times what changes of the row by 1 are.
      this->expect_exact(nu[r], expected_nu[r], row_size[r], 16, "nu");
      this->expect_exact(gamma[r], expected_gamma[r], row_size[r], 256, "gamma");
      this->expect_exact(-derived[r].dd, expected_gamma[r], row_size[r], 256, "derived gamma");
    }
  });
}

TYPED_TEST(ConstraintContract, SecondDerivatives) {
  using E = TypeParam;
  this->for_random_cases([&](const ConstraintCase<E>& x, const auto&, const auto& row_size, double size) {
    const Stored<E> stored(x);
    double lambda[E::rows];
    for (std::size_t r = 0; r < row_size.size(); ++r) lambda[r] = (r % 2 ? -0.7 : 1.3) / row_size[r];
    const ElementMatrix found = ConstraintOperations<E>::hessian(stored.block, stored.data, stored.pose, lambda, 0);
    for (std::size_t a = 0; a < 3 * E::bodies; ++a) {
      for (std::size_t b = 0; b < 3 * E::bodies; ++b) {
        SCOPED_TRACE(::testing::Message() << "entry " << a << ", " << b);
        const double unit = (a % 3 == 2 ? 1 : size) * (b % 3 == 2 ? 1 : size);
        this->expect_exact(found[6 * a + b], exact_second_derivative(x, lambda, a, b), 1 / unit, 64, "Hessian");
      }
    }
    constexpr auto pattern = hessian_pattern<E>();
    double closed[pattern.size() + 1];
    if constexpr (HasClosedHessian<E>)
      x.element.hessian(Arguments<double>{stored.pose.frames[0], stored.pose.frames[1], x.c.f, x.ground}, lambda,
                        closed);
    for (std::size_t a = 0, next = 0; a < 3 * E::bodies; ++a) {
      for (std::size_t b = 0; b <= a; ++b) {
        SCOPED_TRACE(::testing::Message() << "entry " << a << ", " << b);
        const double unit = (a % 3 == 2 ? 1 : size) * (b % 3 == 2 ? 1 : size);
        const bool listed = next < pattern.size() && static_cast<std::size_t>(pattern[next].row) == a &&
                            static_cast<std::size_t>(pattern[next].column) == b;
        if (!listed) {
          EXPECT_EQ(found[6 * a + b], 0);
        } else if (HasClosedHessian<E>) {
          this->expect_exact(closed[next], exact_second_derivative(x, lambda, a, b), 1 / unit, 64, "closed Hessian");
        }
        next += listed;
      }
    }
  });
}

// What c prescribes: at c = measure the row vanishes; its time derivatives are those of the motion.
TYPED_TEST(ConstraintContract, MeasuredQuantity) {
  using E = TypeParam;
  if constexpr (E::functions == 0) {
    GTEST_SKIP() << "no value";
  } else {
    this->for_random_cases([&](const ConstraintCase<E>& x, const auto&, const auto& row_size, double) {
      Stored<E> stored(x);
      const Measured found =
          ConstraintOperations<E>::measure(stored.block, stored.data, stored.pose, x.qd.data(), x.qdd.data(), 0);
      ConstraintCase<E> met = x;
      met.c = {found.value, 0, 0};
      this->expect_exact(0, exact_rows(met)[0], row_size[0], 64, "row at the measured value");
      // Prescribed to move as it was measured to, the row stays zero along q + qd t + qdd t^2 / 2.
      met.c = {found.value, found.rate, found.second};
      const auto row = [&](const Exact& t) {
        std::array<Exact, 6> offset;
        for (std::size_t k = 0; k < 6; ++k) offset[k] = t * Exact(x.qd[k]) + t * t * Exact(x.qdd[k]) / 2;
        return exact_rows(met, offset, t * Exact(met.c.d) + t * t * Exact(met.c.dd) / 2)[0];
      };
      const Exact h = difference_step(), after = row(h), before = row(-h);
      this->expect_exact(0, (after - before) / (2 * h), row_size[0], 256, "rate");
      this->expect_exact(0, (after - 2 * row(Exact(0)) + before) / (h * h), row_size[0], 1024, "second rate");
      EXPECT_NE(found.value, 0);
    });
  }
}

// A squared form is solved for as a row that measures a length: its gradient then has the size 1.
TYPED_TEST(ConstraintContract, ScaleMultipliesEverything) {
  using E = TypeParam;
  if constexpr (!HasSquaredValue<E>) {
    GTEST_SKIP() << "not scaled";
  } else {
    const ConstraintCase<E> x = random_case<E>(7, 1);
    Stored<E> plain(x), scaled(x);
    scaled.data.scale = {0.25};
    constexpr int entries = varying_entries<E>();
    const auto evaluate = [&](const Stored<E>& s) {
      std::vector<double> values(static_cast<std::size_t>(entries + 3));
      ConstraintOperations<E>::jacobian(s.block, s.data, s.pose, values.data());
      ConstraintOperations<E>::phi(s.block, s.data, s.pose, values.data() + entries);
      ConstraintOperations<E>::nu(s.block, s.data, s.pose, values.data() + entries + 1);
      ConstraintOperations<E>::gamma(s.block, s.data, s.pose, x.qd.data(), values.data() + entries + 2);
      return values;
    };
    const std::vector<double> a = evaluate(plain), b = evaluate(scaled);
    for (std::size_t k = 0; k < a.size(); ++k) EXPECT_DOUBLE_EQ(b[k], 0.25 * a[k]) << k;
    const auto local = ConstraintOperations<E>::local_jacobian(scaled.block, scaled.data, scaled.pose, 0);
    EXPECT_EQ(local.scale, 0.25);
    EXPECT_EQ(local.entries, ConstraintOperations<E>::local_jacobian(plain.block, plain.data, plain.pose, 0).entries);
  }
}

// The same bodies seen from an origin 2^20 sizes away: the rows are those of the near origin to the last bits, because
// absolute elements take the distance out of their constants instead of adding it to the coordinates.
TYPED_TEST(ConstraintContract, FarFromTheOrigin) {
  using E = TypeParam;
  this->for_random_cases([&](const ConstraintCase<E>& x, const auto&, const auto& row_size, double size) {
    if constexpr (E::bodies == 1) {
      ConstraintCase<E> far = x;
      const Vec2<double> away{1048576 * size, -1048576 * size};
      far.ground = x.ground + away;
      // The constants move along, rounded; so does the exact reference, which sees the rounded ones.
      if constexpr (requires { far.element.ground; }) far.element.ground += away;
      if constexpr (E::functions == 1 && !HasSquaredValue<E> && E::value_unit == UnitKind::length) {
        far.c.f += E::type == "absolute_x" ? away.x : away.y;
      }
      const Stored<E> stored(far);
      typename TestFixture::Rows rows;
      ConstraintOperations<E>::phi(stored.block, stored.data, stored.pose, rows.data());
      const auto expected = exact_rows(far);
      for (std::size_t r = 0; r < rows.size(); ++r) this->expect_exact(rows[r], expected[r], row_size[r], 16, "phi");
    } else {
      // A common origin that is moved by an exactly represented distance changes differences only by rounding.
      ConstraintCase<E> moved = x;
      for (std::size_t k : {0u, 3u}) moved.q[k] += 4 * size, moved.q[k + 1] -= 2 * size;
      const Stored<E> a(x), b(moved);
      typename TestFixture::Rows rows_a, rows_b;
      ConstraintOperations<E>::phi(a.block, a.data, a.pose, rows_a.data());
      ConstraintOperations<E>::phi(b.block, b.data, b.pose, rows_b.data());
      for (std::size_t r = 0; r < rows_a.size(); ++r)
        EXPECT_NEAR(rows_a[r], rows_b[r], 64 * eps * row_size[r]) << "row " << r;
    }
  });
}

// Derivatives with respect to design parameters, through complete() as well: Dual parameters against differences of
// eighth order of the same element with its parameters moved (a short way: splines have but two smooth derivatives).
TYPED_TEST(ConstraintContract, ParameterDerivatives) {
  using E = TypeParam;
  using D = Dual<double, 4>;
  using ED = typename Over<E, D>::type;
  constexpr double step = 1e-4, weights[4] = {4.0 / 5, -1.0 / 5, 4.0 / 105, -1.0 / 280};
  for (unsigned seed = 0; seed < draws; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    ConstraintCase<E> x = random_case<E>(seed, 1);
    const auto frame = [&]<class T>(std::size_t k, T) { return make_frame(T(x.q[k]), T(x.q[k + 1]), T(x.q[k + 2])); };
    const auto rows_of = [&]<class Element, class T>(const Element& element, T, T* out) {
      const auto i = frame(0, T()), j = frame(3, T());
      const CurvePlace contact = found_contact(element, frame(0, 0.0), frame(3, 0.0));
      element.phi(Arguments<T>{i, j, T(x.c.f), x.ground, &contact}, out);
    };
    ParameterSource<double> plain_source(seed);
    x.element = random_element<E>(plain_source, frame(0, 0.0), frame(3, 0.0));
    if (has_trouble(x)) continue;
    ParameterSource<D> dual_source(seed);
    D rows[E::rows];
    rows_of(random_element<ED>(dual_source, frame(0, D()), frame(3, D())), D(), rows);
    for (std::size_t direction = 0; direction < 4; ++direction) {
      std::array<double, static_cast<std::size_t>(E::rows)> expected{};
      for (int m = 1; m <= 4; ++m) {
        for (int sign : {1, -1}) {
          ParameterSource<double> source(seed, 1, static_cast<int>(direction), sign * m * step);
          double moved[E::rows];
          rows_of(random_element<E>(source, frame(0, 0.0), frame(3, 0.0)), 0.0, moved);
          for (std::size_t r = 0; r < expected.size(); ++r) expected[r] += sign * weights[m - 1] * moved[r] / step;
        }
      }
      for (std::size_t r = 0; r < expected.size(); ++r)
        EXPECT_NEAR(rows[r].d[direction], expected[r], 1e-9 * (1 + std::abs(expected[r]))) << "row " << r;
    }
  }
}

}  // namespace
}  // namespace catena

#endif
